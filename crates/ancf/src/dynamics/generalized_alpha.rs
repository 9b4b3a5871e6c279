//! Generalized-alpha (Chung & Hulbert 1993, in the form of Arnold & Brüls 2007).
//!
//! The true acceleration `x` satisfies `M x = f` at the end of the step; the algorithmic one `a`
//! drives Newmark's formulas:
//!
//! ```text
//! (1 - am) a1 + am a0 = (1 - af) x1 + af x0
//! v1 = v0 + h [(1 - g) a0 + g a1]           q1 = q0 + h v0 + h² [(1/2 - b) a0 + b a1]
//! am = (2 rho - 1) / (rho + 1)   af = rho / (rho + 1)   g = 1/2 + af - am   b = (1/2 + g)² / 4
//! ```
//!
//! Second order; `rho` is the damping left for infinitely fast modes. Together the first two lines make
//!
//! ```text
//! v1 - v0 = h/2 (x0 + x1) + h (1/2 - af) [(x1 - a1) - (x0 - a0)]
//! ```

use super::stage::{NotConverged, Stage, StageBase};
use super::{Motion, Scheme, StepRule};
use crate::system::Mechanics;

/// The scheme with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneralizedAlpha {
    alpha_m: f64,
    alpha_f: f64,
    gamma: f64,
    beta: f64,
}

impl GeneralizedAlpha {
    /// The scheme with spectral radius `rho` in `[0, 1]` at infinite frequency.
    #[must_use]
    pub fn new(rho: f64) -> Self {
        let alpha_m = (2.0 * rho - 1.0) / (rho + 1.0);
        let alpha_f = rho / (rho + 1.0);
        let gamma = 0.5 + alpha_f - alpha_m;
        Self {
            alpha_m,
            alpha_f,
            gamma,
            beta: 0.25 * (0.5 + gamma).powi(2),
        }
    }
}

impl Scheme for GeneralizedAlpha {
    fn step(
        &mut self,
        system: &mut dyn Mechanics,
        stage: &mut Stage,
        from: &Motion,
        step: f64,
        to: &mut Motion,
    ) -> Result<(), NotConverged> {
        let Self {
            alpha_m,
            alpha_f,
            gamma,
            beta,
        } = *self;
        let new = (1.0 - alpha_f) / (1.0 - alpha_m);
        let size = from.q.len();
        let (q, v, a) = (&from.q[..size], &from.v[..size], &from.a[..size]);
        let algorithmic = &from.algorithmic[..size];
        let (to_q, to_v, to_a) = (
            &mut to.q[..size],
            &mut to.v[..size],
            &mut to.algorithmic[..size],
        );
        for i in 0..size {
            // Algorithmic acceleration without its part from the unknown.
            let known = (alpha_f * a[i] - alpha_m * algorithmic[i]) / (1.0 - alpha_m);
            let old = algorithmic[i];
            to_v[i] = v[i] + step * ((1.0 - gamma) * old + gamma * known);
            to_q[i] = q[i] + step * v[i] + step * step * ((0.5 - beta) * old + beta * known);
            to_a[i] = known;
        }
        to.a.copy_from_slice(a);
        to.time = from.time + step;
        stage.solve(
            system,
            to,
            StageBase {
                position_factor: step * step * beta * new,
                velocity_factor: step * gamma * new,
            },
        )?;
        for (algorithmic, a) in to.algorithmic.iter_mut().zip(&to.a) {
            *algorithmic += new * a;
        }
        Ok(())
    }

    fn rule(&self) -> StepRule<'_> {
        StepRule {
            lag: 0.5 - self.alpha_f,
            ..StepRule::TRAPEZOIDAL
        }
    }
}
