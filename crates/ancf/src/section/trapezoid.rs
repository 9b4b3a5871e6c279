//! The trapezoid: the cross-section of a V-belt.
//!
//! With `y` from the centroid towards the narrow side, `b` the width there, `t = tan(flank angle / 2)` and the
//! height `h`, the width is `w(y) = b - 2 t y`. The middle of the height lies at `y = m` with
//!
//! ```text
//! ∫ y w dy = h m (b - 2 t m) - t h³/6 = 0,     m = t h²/3 / (b + sqrt(b² - 4 t² h²/3))
//! ```

use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};

use super::SpatialSection;
use crate::quadrature::Rule;

/// Points that integrate the moments, of degree five in y, exactly.
const POINTS: usize = 3;

/// An isosceles trapezoid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trapezoid {
    /// Width at the height of the centroid [m].
    pub width: f64,
    /// Height [m].
    pub height: f64,
    /// Angle between a flank and the height [rad], half of that between the flanks.
    pub half_angle: f64,
    /// Height of the middle over the centroid, towards the narrow side [m].
    pub middle: f64,
}

impl Trapezoid {
    /// The trapezoid of these dimensions; `None` where its flanks would meet within it, or for numbers that are not
    /// positive (the angle may be zero).
    #[must_use]
    pub fn new(width: f64, height: f64, half_angle: f64) -> Option<Self> {
        let slope = half_angle.tan();
        let square = width * width - 4.0 * (slope * height).powi(2) / 3.0;
        if !(width > 0.0 && height > 0.0 && slope >= 0.0 && square > 0.0) {
            return None;
        }
        let trapezoid = Self {
            width,
            height,
            half_angle,
            middle: slope * height * height / 3.0 / (width + square.sqrt()),
        };
        (trapezoid.width_at(trapezoid.narrow()) > 0.0).then_some(trapezoid)
    }

    /// Width [m] at `y` [m] from the centroid towards the narrow side.
    pub fn width_at(&self, y: f64) -> f64 {
        self.width - 2.0 * self.half_angle.tan() * y
    }

    /// Place of the narrow face [m], positive.
    pub fn narrow(&self) -> f64 {
        self.middle + 0.5 * self.height
    }

    /// Place of the wide face [m], negative.
    pub fn wide(&self) -> f64 {
        self.middle - 0.5 * self.height
    }

    /// Area [m²].
    pub fn area(&self) -> f64 {
        self.height * self.width_at(self.middle)
    }

    /// Height of a flank along itself [m].
    pub fn flank(&self) -> f64 {
        self.height / self.half_angle.cos()
    }

    /// Its moments as those of a doubly symmetric section: `∫ y³ dA` and `∫ y z² dA`, which a trapezoid has, are left
    /// out. They couple stretch and curvature to second order in height over radius of bending.
    #[must_use]
    pub fn section(&self) -> SpatialSection {
        let rule = gauss(POINTS);
        let moment = |n: i32, m: i32, factor: f64| -> f64 {
            (rule.points.iter().zip(&rule.weights))
                .map(|(x, weight)| {
                    let y = self.wide() + self.height * x;
                    weight * self.height * y.powi(n) * self.width_at(y).powi(m) * factor
                })
                .sum()
        };
        SpatialSection {
            area: self.area(),
            second_moment_y: moment(2, 1, 1.0),
            second_moment_z: moment(0, 3, 1.0 / 12.0),
            fourth_moment_y: moment(4, 1, 1.0),
            fourth_moment_z: moment(0, 5, 1.0 / 80.0),
            mixed_fourth_moment: moment(2, 3, 1.0 / 12.0),
            torsion_constant: self.torsion_constant(),
        }
    }

    /// Saint-Venant's torsion constant [m⁴] by Ritz's method for Prandtl's stress function,
    /// `J = 2 ∫ phi dA`, `∫ grad phi . grad psi dA = 2 ∫ psi dA` for all `psi`. Trial functions are the product of the
    /// four sides' equations times `Y^i Z^2j`: each vanishes on the boundary. J comes from below.
    fn torsion_constant(&self) -> f64 {
        // In units of half of the height and of the half width: Y and Z in [-1, 1].
        let rule = gauss(2 * (ALONG + ACROSS) + 4);
        let (half, size) = (0.5 * self.height, ALONG * ACROSS);
        let mut stiffness = Mat::<f64>::zeros(size, size);
        let mut load = Mat::<f64>::zeros(size, 1);
        let mut trial = vec![[0.0; 3]; size];
        for (u, weight_y) in rule.points.iter().zip(&rule.weights) {
            for (v, weight_z) in rule.points.iter().zip(&rule.weights) {
                let y = 2.0 * u - 1.0;
                // Half width in units of half the height, and its slope by y.
                let slope = -self.half_angle.tan();
                let edge = 0.5 * self.width_at(self.middle) / half + slope * y;
                let z = edge * (2.0 * v - 1.0);
                let weight = weight_y * weight_z * 4.0 * edge;
                self.trials([y, z], [edge, slope], &mut trial);
                for (i, a) in trial.iter().enumerate() {
                    load[(i, 0)] += 2.0 * weight * a[0];
                    for (j, b) in trial.iter().enumerate() {
                        stiffness[(i, j)] += weight * (a[1] * b[1] + a[2] * b[2]);
                    }
                }
            }
        }
        let solution = PartialPivLu::new(stiffness.as_ref()).solve(&load);
        let twice: f64 = (0..size).map(|i| solution[(i, 0)] * load[(i, 0)]).sum();
        twice * half.powi(4)
    }

    /// Value and derivatives by Y and Z of the trial functions at `(y, z)`, in units of half of the height, where the
    /// half width is `edge` with the derivative `slope` by y.
    fn trials(&self, [y, z]: [f64; 2], [edge, slope]: [f64; 2], trial: &mut [[f64; 3]]) {
        let widest = 0.5 * self.width / (0.5 * self.height);
        let (ends, sides) = (1.0 - y * y, edge * edge - z * z);
        let bubble = ends * sides;
        let by_y = -2.0 * y * sides + ends * 2.0 * edge * slope;
        let by_z = -2.0 * z * ends;
        let mut k = 0;
        for i in 0..ALONG {
            let (p, dp) = legendre(i, y);
            for j in 0..ACROSS {
                let (q, dq) = legendre(2 * j, z / widest);
                let value = p * q;
                trial[k] = [
                    bubble * value,
                    by_y * value + bubble * dp * q,
                    by_z * value + bubble * p * dq / widest,
                ];
                k += 1;
            }
        }
    }
}

/// Trial functions in y and, even ones, in z.
const ALONG: usize = 8;
const ACROSS: usize = 6;

/// Legendre's polynomial of degree `n` at `x` and its derivative.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut p, mut last, mut dp, mut dlast) = (1.0, 0.0, 0.0, 0.0);
    for k in 1..=n {
        let (a, b) = ((2 * k - 1) as f64, (k - 1) as f64);
        let next = (a * x * p - b * last) / k as f64;
        let dnext = (a * (p + x * dp) - b * dlast) / k as f64;
        (last, p, dlast, dp) = (p, next, dp, dnext);
    }
    (p, dp)
}

fn gauss(count: usize) -> Rule {
    Rule::gauss(std::num::NonZeroUsize::new(count).unwrap_or(std::num::NonZeroUsize::MIN))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A trapezoid of angle zero is the rectangle: moments to round-off. The torsion constant comes from below; the
    /// corners' r² ln r keeps polynomials from it by 1e-5 at these degrees.
    #[test]
    fn without_an_angle_it_is_the_rectangle() {
        for (width, height) in [(0.02, 0.02), (0.03, 0.012), (0.011, 0.02)] {
            let section = Trapezoid::new(width, height, 0.0).unwrap().section();
            let known = SpatialSection::rectangle(width, height);
            let pairs = [
                (section.area, known.area),
                (section.second_moment_y, known.second_moment_y),
                (section.second_moment_z, known.second_moment_z),
                (section.fourth_moment_y, known.fourth_moment_y),
                (section.fourth_moment_z, known.fourth_moment_z),
                (section.mixed_fourth_moment, known.mixed_fourth_moment),
            ];
            for (value, expected) in pairs {
                assert!((value / expected - 1.0).abs() < 1e-13, "{value} {expected}");
            }
            let short = 1.0 - section.torsion_constant / known.torsion_constant;
            assert!((0.0..1.0e-5).contains(&short), "{short}");
        }
    }

    /// The area, the first moment and `∫ y² dA` of textbook formulas: with the parallel sides a and c,
    /// `h (a + c)/2`, zero, and `h³ (a² + 4 a c + c²)/(36 (a + c))`.
    #[test]
    fn moments_of_a_trapezoid() {
        let trapezoid = Trapezoid::new(0.011, 0.009, 0.3).unwrap();
        let (a, c) = (
            trapezoid.width_at(trapezoid.wide()),
            trapezoid.width_at(trapezoid.narrow()),
        );
        let h = trapezoid.height;
        let section = trapezoid.section();
        // Place of the centroid over the wide side.
        let centroid = h * (a + 2.0 * c) / (3.0 * (a + c));
        for (value, expected) in [
            (section.area, 0.5 * h * (a + c)),
            (-trapezoid.wide(), centroid),
            (
                section.second_moment_y,
                h.powi(3) * (a * a + 4.0 * a * c + c * c) / (36.0 * (a + c)),
            ),
            (
                section.second_moment_z,
                h * (a + c) * (a * a + c * c) / 48.0,
            ),
        ] {
            assert!((value / expected - 1.0).abs() < 1e-13, "{value} {expected}");
        }
    }

    /// A trapezoid that is all but an equilateral triangle of height h: `J = h⁴/(15 sqrt(3))` (Timoshenko & Goodier
    /// 1970, article 108). Flanks moved out by 3.3e-4 of h, a thousandth of the radius inscribed, add some 3e-3 to J.
    #[test]
    fn torsion_constant_of_a_triangle() {
        let h = 0.01;
        let half_angle = std::f64::consts::FRAC_PI_6;
        // The centroid of a triangle is a third of its height over the base.
        let width = 4.0 / 3.0 * h * half_angle.tan() * 1.001;
        let trapezoid = Trapezoid::new(width, h, half_angle).unwrap();
        let expected = h.powi(4) / (15.0 * 3.0_f64.sqrt());
        let ratio = trapezoid.section().torsion_constant / expected;
        assert!((0.995..1.01).contains(&ratio), "{ratio}");
    }

    #[test]
    fn flanks_that_meet_make_no_section() {
        assert!(Trapezoid::new(0.01, 0.03, 0.3).is_none());
        assert!(Trapezoid::new(0.01, -0.01, 0.3).is_none());
        assert!(Trapezoid::new(0.01, f64::NAN, 0.3).is_none());
        assert!(Trapezoid::new(0.011, 0.009, 0.3).is_some());
    }
}
