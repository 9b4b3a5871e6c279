//! Cross-sections by their polynomial moments.

mod trapezoid;

use std::f64::consts::PI;

pub use trapezoid::Trapezoid;

use crate::unsound::{Unsound, positive, within};

/// Shear correction factor ks of the rectangle, used by every beam with shear, as published
/// (Kerkkänen 2006, 2.18 and 4.34).
pub const SHEAR_CORRECTION: f64 = 5.0 / 6.0;

/// A doubly symmetric cross-section of a planar beam, given by its moments in the height direction
/// `y`: all that the closed-form section integrals need.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarSection {
    /// A = ∫ dA [m²].
    pub area: f64,
    /// I2 = ∫ y² dA [m⁴].
    pub second_moment: f64,
    /// I4 = ∫ y⁴ dA [m⁶].
    pub fourth_moment: f64,
}

impl PlanarSection {
    /// Refuses moments that no area has: all are positive, and by the inequality of Cauchy and Schwarz
    /// `(∫ y² dA)² <= ∫ dA ∫ y⁴ dA`, with equality for two flanges without height.
    pub fn check(&self) -> Result<(), Unsound> {
        positive("the area of the section [m²]", self.area)?;
        positive("the second moment of the section [m⁴]", self.second_moment)?;
        let least = self.second_moment * self.second_moment / self.area;
        // The moments of two flanges may be rounded.
        let fits = self.fourth_moment >= least * (1.0 - 1.0e-9) && self.fourth_moment.is_finite();
        within(
            "the fourth moment of the section [m⁶]",
            self.fourth_moment,
            fits,
            "finite and at least the square of the second moment over the area",
        )
    }

    /// A rectangle of the given width (out of the plane) and height (in the plane) [m].
    #[must_use]
    pub fn rectangle(width: f64, height: f64) -> Self {
        Self {
            area: width * height,
            second_moment: width * height.powi(3) / 12.0,
            fourth_moment: width * height.powi(5) / 80.0,
        }
    }

    /// A full circle of the given radius [m].
    #[must_use]
    pub fn circle(radius: f64) -> Self {
        Self {
            area: PI * radius.powi(2),
            second_moment: PI * radius.powi(4) / 4.0,
            fourth_moment: PI * radius.powi(6) / 8.0,
        }
    }

    /// A circular tube of the given outer and inner radius [m].
    #[must_use]
    pub fn tube(outer_radius: f64, inner_radius: f64) -> Self {
        let (outer, inner) = (Self::circle(outer_radius), Self::circle(inner_radius));
        Self {
            area: outer.area - inner.area,
            second_moment: outer.second_moment - inner.second_moment,
            fourth_moment: outer.fourth_moment - inner.fourth_moment,
        }
    }
}

/// A doubly symmetric cross-section of a spatial beam, given by its moments in the height direction
/// `y` and the width direction `z`: all that the closed-form section integrals need.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpatialSection {
    /// A = ∫ dA [m²].
    pub area: f64,
    /// ∫ y² dA [m⁴]: bending in the plane of x and y.
    pub second_moment_y: f64,
    /// ∫ z² dA [m⁴]: bending in the plane of x and z.
    pub second_moment_z: f64,
    /// ∫ y⁴ dA [m⁶].
    pub fourth_moment_y: f64,
    /// ∫ z⁴ dA [m⁶].
    pub fourth_moment_z: f64,
    /// ∫ y² z² dA [m⁶].
    pub mixed_fourth_moment: f64,
    /// Saint-Venant's torsion constant J [m⁴]. Read by
    /// [`SpatialSection::saint_venant_torsion_factor`] alone.
    pub torsion_constant: f64,
}

impl SpatialSection {
    /// A rectangle of the given width (along z) and height (along y) [m].
    #[must_use]
    pub fn rectangle(width: f64, height: f64) -> Self {
        let (y, z) = (
            PlanarSection::rectangle(width, height),
            PlanarSection::rectangle(height, width),
        );
        Self {
            area: y.area,
            second_moment_y: y.second_moment,
            second_moment_z: z.second_moment,
            fourth_moment_y: y.fourth_moment,
            fourth_moment_z: z.fourth_moment,
            mixed_fourth_moment: (width * height).powi(3) / 144.0,
            torsion_constant: rectangle_torsion(width.max(height), width.min(height)),
        }
    }

    /// A full circle of the given radius [m].
    #[must_use]
    pub fn circle(radius: f64) -> Self {
        Self::round(&PlanarSection::circle(radius), PI * radius.powi(6) / 24.0)
    }

    /// A circular tube of the given outer and inner radius [m].
    #[must_use]
    pub fn tube(outer_radius: f64, inner_radius: f64) -> Self {
        let mixed = PI * (outer_radius.powi(6) - inner_radius.powi(6)) / 24.0;
        Self::round(&PlanarSection::tube(outer_radius, inner_radius), mixed)
    }

    /// A section with circular symmetry, whose torsion constant is its polar moment.
    fn round(planar: &PlanarSection, mixed_fourth_moment: f64) -> Self {
        Self {
            area: planar.area,
            second_moment_y: planar.second_moment,
            second_moment_z: planar.second_moment,
            fourth_moment_y: planar.fourth_moment,
            fourth_moment_z: planar.fourth_moment,
            mixed_fourth_moment,
            torsion_constant: 2.0 * planar.second_moment,
        }
    }

    /// The section of a beam that stays in the plane of x and y.
    #[must_use]
    pub fn planar(&self) -> PlanarSection {
        PlanarSection {
            area: self.area,
            second_moment: self.second_moment_y,
            fourth_moment: self.fourth_moment_y,
        }
    }

    /// The torsion factor [-] that gives a spatial beam Saint-Venant's stiffness `G J`: its own is
    /// `ks G (∫ y² dA + ∫ z² dA)`, because its sections stay plane in twist.
    #[must_use]
    pub fn saint_venant_torsion_factor(&self) -> f64 {
        self.torsion_constant / (SHEAR_CORRECTION * (self.second_moment_y + self.second_moment_z))
    }
}

/// Saint-Venant's torsion constant of a rectangle with sides `a >= b` (Timoshenko & Goodier 1970, 109):
/// `J = a b³/3 [1 - 192/π⁵ b/a sum over odd n of tanh(n π a / 2 b) / n⁵]`. The part of the sum with
/// tanh = 1 is 31 ζ(5) / 32; the rest falls like exp(-n π a / b).
fn rectangle_torsion(a: f64, b: f64) -> f64 {
    const WITH_TANH_ONE: f64 = 1.004_523_762_795_139_6;
    let rest: f64 = (1u32..14)
        .step_by(2)
        .map(f64::from)
        .map(|n| 2.0 / (n.powi(5) * ((n * PI * a / b).exp() + 1.0)))
        .sum();
    a * b.powi(3) / 3.0 * (1.0 - 192.0 / PI.powi(5) * b / a * (WITH_TANH_ONE - rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Timoshenko & Goodier (1970, table 1 of article 109): J / (a b³) to the digits printed, and for
    /// a thin strip 1/3 (1 - 0.630 b/a). The round-off of the series is 1e-16.
    #[test]
    fn torsion_constant_of_rectangles() {
        for (ratio, printed, digits) in [
            (1.0, 0.1406, 5e-5),
            (1.5, 0.196, 5e-4),
            (2.0, 0.229, 5e-4),
            (3.0, 0.263, 5e-4),
            (10.0, 0.312, 5e-4),
        ] {
            let section = SpatialSection::rectangle(ratio * 0.02, 0.02);
            let value = section.torsion_constant / (ratio * 0.02f64.powi(4));
            assert!((value - printed).abs() < digits, "{ratio}: {value}");
        }
        let turned = SpatialSection::rectangle(0.02, 0.05).torsion_constant
            / SpatialSection::rectangle(0.05, 0.02).torsion_constant;
        assert!((turned - 1.0).abs() < 1e-15);
        let thin = SpatialSection::rectangle(1.0, 1e-3).torsion_constant / 1e-9;
        assert!((3.0 * thin - (1.0 - 0.630_25e-3)).abs() < 1e-8, "{thin}");
    }

    /// Moments of a rectangle and of a tube against quadrature: Gauss for polynomials on the rectangle;
    /// on the circle the mean of y² z² over the angle is 1/8 of r⁴, that of y⁴ is 3/8.
    #[test]
    fn moments_of_sections() {
        let section = SpatialSection::rectangle(0.03, 0.02);
        let rule = crate::quadrature::Rule::gauss(4.try_into().unwrap());
        let moment = |m: i32, n: i32| {
            let mut sum = 0.0;
            for (y, wy) in rule.points.iter().zip(&rule.weights) {
                for (z, wz) in rule.points.iter().zip(&rule.weights) {
                    sum += (0.02 * (y - 0.5)).powi(m) * (0.03 * (z - 0.5)).powi(n) * wy * wz * 6e-4;
                }
            }
            sum
        };
        let pairs = [
            (section.area, moment(0, 0)),
            (section.second_moment_y, moment(2, 0)),
            (section.second_moment_z, moment(0, 2)),
            (section.fourth_moment_y, moment(4, 0)),
            (section.fourth_moment_z, moment(0, 4)),
            (section.mixed_fourth_moment, moment(2, 2)),
        ];
        for (value, expected) in pairs {
            assert!((value / expected - 1.0).abs() < 1e-14, "{value} {expected}");
        }
        let tube = SpatialSection::tube(0.02, 0.015);
        assert!((tube.mixed_fourth_moment * 3.0 / tube.fourth_moment_y - 1.0).abs() < 1e-14);
    }
}
