//! The surface of a pulley that a point of the belt meets: a surface of revolution about the pulley's axis.

use ancf::scalar::Scalar;

/// On which part of the belt's section a point lies: a flat face, or the flank towards the end of the axis or the
/// other. A face meets the rim of a pulley, a flank the wall of its groove on the same side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Face,
    Flank(Flank),
}

/// One of the two flanks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flank {
    /// Towards negative places along the axis.
    Lower,
    /// Towards positive ones.
    Upper,
}

impl Flank {
    pub const BOTH: [Self; 2] = [Self::Lower, Self::Upper];

    /// The sign of places along the axis on this side.
    pub fn sign(self) -> f64 {
        match self {
            Self::Lower => -1.0,
            Self::Upper => 1.0,
        }
    }
}

/// The groove of a pulley, whose flanks are cones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groove {
    /// Width at the pulley's radius [m].
    pub width: f64,
    /// Slope of the radius along the axis on a flank, the cotangent of half of the groove's angle [-].
    pub slope: f64,
    /// Sine of half of the groove's angle: `1 / sqrt(1 + slope²)`.
    pub sine: f64,
}

impl Groove {
    /// A groove of this `width` [m] with the angle `2 half_angle` [rad] between its flanks.
    #[must_use]
    pub fn new(width: f64, half_angle: f64) -> Self {
        let (sine, cosine) = half_angle.sin_cos();
        Self {
            width,
            slope: cosine / sine,
            sine,
        }
    }

    /// The wall on one side: at a half of the width from the middle the radius is that of the pulley.
    #[inline(always)]
    pub(super) fn wall(&self, radius: f64, flank: Flank) -> Meridian {
        Meridian {
            radius: radius - 0.5 * self.width * self.slope,
            slope: flank.sign() * self.slope,
            curvature: 0.0,
            unit: self.sine,
            lever_part: 0.0,
        }
    }
}

/// Radius along the axis, `R(s) = radius + slope s - curvature s²/2`, and how depth and slip are measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Meridian {
    /// Radius at the pulley's middle [m].
    pub radius: f64,
    /// Slope R' there [-].
    pub slope: f64,
    /// -R'' [1/m].
    pub curvature: f64,
    /// Factor c of depth and directions: 1 where the depth is measured at right angles to the axis,
    /// `1 / sqrt(1 + R'²)` where at right angles to the surface, a cone.
    pub unit: f64,
    /// Part of the depth `R - rho` by which the lever of the slip exceeds that of the force.
    pub lever_part: f64,
}

impl Meridian {
    /// R at a place along the axis.
    #[inline(always)]
    pub fn radius_at<S: Scalar>(&self, along: S) -> S {
        along * (along * (-0.5 * self.curvature) + self.slope) + self.radius
    }

    /// R' there.
    #[inline(always)]
    pub fn slope_at<S: Scalar>(&self, along: S) -> S {
        along * -self.curvature + self.slope
    }
}
