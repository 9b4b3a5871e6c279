//! Elastic-plastic friction: bristles that stick, bend and slide.

use ancf::scalar::Scalar;

use super::{Developed, FrictionLaw, Slip};

/// Bristles of stiffness k_t between belt and pulley (Dahl 1968 in its elastic-plastic form):
///
/// ```text
/// f_t = k_t z + c_t v      within mu |f_n|, at that limit beyond
/// |z| <= mu |f_n| / k_t    at the end of every step: what exceeds it has slid
/// ```
///
/// z is the displacement of the belt's point against the place of the pulley's surface where its bristle
/// stands. It belongs to the material point and travels with the belt, so sticking is real: a drive at
/// rest carries its load without creep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticPlastic {
    /// Coefficient of friction mu [-].
    pub coefficient: f64,
    /// Stiffness k_t of the bristles per length of belt [N/m²].
    pub stiffness: f64,
    /// Damping c_t of the bristles per length of belt [N s/m²].
    pub damping: f64,
}

impl FrictionLaw for ElasticPlastic {
    #[inline(always)]
    fn develop<S: Scalar>(&self, slip: Slip<S>, normal: S) -> Developed<S> {
        let limit = normal * self.coefficient;
        let stuck = slip.displacement * self.stiffness + slip.velocity * self.damping;
        let within = limit - stuck.abs();
        let sign = stuck.select_positive(S::constant(1.0), S::constant(-1.0));
        let zero = S::zero();
        Developed {
            force: within.select_positive(stuck, sign * limit),
            by_velocity: within.select_positive(S::constant(self.damping), zero),
            by_displacement: within.select_positive(S::constant(self.stiffness), zero),
            by_normal: within.select_positive(zero, sign * self.coefficient),
        }
    }

    fn elastic_limit(&self, normal: f64) -> Option<f64> {
        Some(self.coefficient * normal / self.stiffness)
    }

    fn reserve(&self, slip: Slip<f64>, normal: f64) -> Option<f64> {
        let stuck = self.stiffness * slip.displacement + self.damping * slip.velocity;
        Some(self.coefficient * normal - stuck.abs())
    }

    fn steepest_damping(&self, _: f64) -> f64 {
        self.damping
    }

    fn steepest_stiffness(&self) -> f64 {
        self.stiffness
    }
}
