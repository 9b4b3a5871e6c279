//! TR-BDF2 (Bank et al. 1985; Hosea & Shampine 1996): a trapezoidal stage to `t + c h`,
//! `c = 2 - sqrt(2)`, then BDF2 to `t + h`. L-stable, second order, one factor for both stages.
//!
//! ```text
//! v1 = v0 + g (x0 + x1)                      g = c h / 2
//! v2 = w v1 + (1 - w) v0 + g x2              w = 1 / (c (2 - c))
//! ```
//!
//! and the same for `q` with `v` in the place of `x`. Put together, the step integrates by
//!
//! ```text
//! v2 - v0 = h [sqrt(2)/4 x0 + sqrt(2)/4 x1 + (1 - sqrt(2)/2) x2]
//! ```

use super::stage::{NotConverged, Stage, StageBase};
use super::{Motion, Scheme, StepRule};
use crate::system::Mechanics;

/// The scheme and its middle stage.
#[derive(Clone, Debug)]
pub struct TrBdf2 {
    middle: Motion,
}

impl TrBdf2 {
    /// The scheme for systems of `size` coordinates.
    #[must_use]
    pub fn new(size: usize) -> Self {
        Self {
            middle: Motion::zero(size),
        }
    }
}

impl Scheme for TrBdf2 {
    fn step(
        &mut self,
        system: &mut dyn Mechanics,
        stage: &mut Stage,
        from: &Motion,
        step: f64,
        to: &mut Motion,
    ) -> Result<(), NotConverged> {
        let fraction = 2.0 - std::f64::consts::SQRT_2;
        let g = 0.5 * fraction * step;
        let base = StageBase {
            position_factor: g * g,
            velocity_factor: g,
        };
        let middle = &mut self.middle;
        middle.time = from.time + fraction * step;
        for i in 0..from.q.len() {
            middle.v[i] = from.v[i] + g * from.a[i];
            middle.q[i] = from.q[i] + g * (from.v[i] + middle.v[i]);
            middle.a[i] = from.a[i];
        }
        stage.solve(system, middle, base)?;

        let w = 1.0 / (fraction * (2.0 - fraction));
        to.time = from.time + step;
        for i in 0..from.q.len() {
            to.v[i] = w * middle.v[i] + (1.0 - w) * from.v[i];
            to.q[i] = w * middle.q[i] + (1.0 - w) * from.q[i] + g * to.v[i];
            to.a[i] = middle.a[i];
        }
        stage.solve(system, to, base)?;
        to.algorithmic.copy_from_slice(&to.a);
        Ok(())
    }

    fn rule(&self) -> StepRule<'_> {
        let quarter = 0.25 * std::f64::consts::SQRT_2;
        StepRule {
            weights: [quarter, quarter, 1.0 - 2.0 * quarter],
            middle: Some(&self.middle),
            lag: 0.0,
        }
    }
}
