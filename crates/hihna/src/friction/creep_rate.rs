//! The creep-rate law.

use ancf::scalar::Scalar;

use super::{Developed, FrictionLaw, Slip};

/// Tri-linear creep-rate law (Leamy & Wasfy 2002; Kerkkänen 2006, 3.23):
/// `f_t = sign(v) min(v_s |v|, mu |f_n|)`, the slope a force per length and velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CreepRate {
    /// Coefficient of friction mu [-].
    pub coefficient: f64,
    /// Creep slope v_s [N s/m²].
    pub slope: f64,
}

impl FrictionLaw for CreepRate {
    #[inline(always)]
    fn develop<S: Scalar>(&self, slip: Slip<S>, normal: S) -> Developed<S> {
        let limit = normal * self.coefficient;
        let creep = slip.velocity * self.slope;
        let within = limit - creep.abs();
        let sign = slip
            .velocity
            .select_positive(S::constant(1.0), S::constant(-1.0));
        Developed {
            force: within.select_positive(creep, sign * limit),
            by_velocity: within.select_positive(S::constant(self.slope), S::zero()),
            by_displacement: S::zero(),
            by_normal: within.select_positive(S::zero(), sign * self.coefficient),
        }
    }

    fn reserve(&self, slip: Slip<f64>, normal: f64) -> Option<f64> {
        Some(self.coefficient * normal - self.slope * slip.velocity.abs())
    }

    fn steepest_damping(&self, _: f64) -> f64 {
        self.slope
    }
}
