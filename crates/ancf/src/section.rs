//! Cross-sections by their polynomial moments.

use std::f64::consts::PI;

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
