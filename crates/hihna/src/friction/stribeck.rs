//! Coulomb's law with a coefficient that falls with the slip velocity.

use ancf::scalar::Scalar;

use super::{Developed, FrictionLaw, Slip};

/// Coulomb friction with a Stribeck curve, regularised by a velocity:
///
/// ```text
/// f_t = mu(v) |f_n| sign(v) min(|v| / v_r, 1)
/// mu(v) = mu_k + (mu_s - mu_k) / (1 + (v / v_st)²)
/// ```
///
/// the rational form of the curve (Hess & Soom 1990). Where the coefficient falls faster than the belt
/// is damped, the drive stick-slips: that is the mechanism of belt noise, not a defect of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stribeck {
    /// Coefficient of friction at the onset of slip mu_s [-].
    pub static_coefficient: f64,
    /// Coefficient of friction of fast slip mu_k [-].
    pub sliding_coefficient: f64,
    /// Slip velocity v_st at which half of the difference is gone [m/s].
    pub stribeck_velocity: f64,
    /// Slip velocity v_r at which friction is fully developed [m/s].
    pub velocity: f64,
}

impl FrictionLaw for Stribeck {
    #[inline(always)]
    fn develop<S: Scalar>(&self, slip: Slip<S>, normal: S) -> Developed<S> {
        let v = slip.velocity;
        let ratio = v * (1.0 / self.velocity);
        let within = -ratio.abs() + 1.0;
        let sign = v.select_positive(S::constant(1.0), S::constant(-1.0));
        let part = within.select_positive(ratio, sign);
        let part_slope = within.select_positive(S::constant(1.0 / self.velocity), S::zero());

        let drop = self.static_coefficient - self.sliding_coefficient;
        let fast = v * (1.0 / self.stribeck_velocity);
        let share = (fast * fast + 1.0).recip();
        let coefficient = share * drop + self.sliding_coefficient;
        let coefficient_slope = share * share * fast * (-2.0 * drop / self.stribeck_velocity);
        Developed {
            force: part * coefficient * normal,
            by_velocity: (part_slope * coefficient + part * coefficient_slope) * normal,
            by_displacement: S::zero(),
            by_normal: part * coefficient,
        }
    }

    fn reserve(&self, slip: Slip<f64>, _: f64) -> Option<f64> {
        Some(self.velocity - slip.velocity.abs())
    }

    fn steepest_damping(&self, normal: f64) -> f64 {
        self.static_coefficient.max(self.sliding_coefficient) * normal / self.velocity
    }
}
