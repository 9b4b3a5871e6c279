//! Coulomb's law, regularised.

use ancf::scalar::Scalar;

use super::{Developed, FrictionLaw, Slip};

/// Coulomb's law regularised by a velocity: `f_t = mu |f_n| v / v_r` for `|v| < v_r`, `mu |f_n|`
/// beyond. Unlike creep, the slope grows with the normal force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb {
    /// Coefficient of friction mu [-].
    pub coefficient: f64,
    /// Slip velocity v_r at which friction is fully developed [m/s].
    pub velocity: f64,
}

impl FrictionLaw for Coulomb {
    #[inline(always)]
    fn develop<S: Scalar>(&self, slip: Slip<S>, normal: S) -> Developed<S> {
        let ratio = slip.velocity * (1.0 / self.velocity);
        let within = -ratio.abs() + 1.0;
        let sign = slip
            .velocity
            .select_positive(S::constant(1.0), S::constant(-1.0));
        let part = within.select_positive(ratio, sign);
        Developed {
            force: part * normal * self.coefficient,
            by_velocity: within
                .select_positive(normal * (self.coefficient / self.velocity), S::zero()),
            by_displacement: S::zero(),
            by_normal: part * self.coefficient,
        }
    }

    fn reserve(&self, slip: Slip<f64>, _: f64) -> Option<f64> {
        Some(self.velocity - slip.velocity.abs())
    }

    fn steepest_damping(&self, normal: f64) -> f64 {
        self.coefficient * normal / self.velocity
    }
}
