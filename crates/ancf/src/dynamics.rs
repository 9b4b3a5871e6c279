//! Time integration of `M q'' = f(t, q, q')`.
//!
//! Every implicit scheme reduces to stages with one unknown per coordinate, the acceleration `x`:
//!
//! ```text
//! V = v_base + g_v x      Q = q_base + g_q x      M x = f(t, Q, V)
//! ```
//!
//! [`Stage`] solves one; a [`Scheme`] strings stages to a step; [`integrate`] chooses steps.

mod control;
mod generalized_alpha;
mod renewal;
mod runge_kutta;
mod stage;
mod tr_bdf2;

pub use control::{Control, IntegrationError, Method, Pace, Window, integrate};
pub use generalized_alpha::GeneralizedAlpha;
pub use runge_kutta::RungeKutta4;
pub use stage::{NotConverged, Stage, StageBase};
pub use tr_bdf2::TrBdf2;

use crate::system::Mechanics;

/// The state that is carried from step to step.
#[derive(Clone, Debug)]
pub struct Motion {
    /// Time [s].
    pub time: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Accelerations: they satisfy the equations of motion at `time`.
    pub a: Vec<f64>,
    /// The algorithmic acceleration of generalized-alpha.
    pub algorithmic: Vec<f64>,
}

impl Motion {
    /// A state of `size` coordinates, all zero.
    #[must_use]
    pub fn zero(size: usize) -> Self {
        Self {
            time: 0.0,
            q: vec![0.0; size],
            v: vec![0.0; size],
            a: vec![0.0; size],
            algorithmic: vec![0.0; size],
        }
    }

    /// The length of a vector that has not `wanted` values.
    fn wrong_size(&self, wanted: usize) -> Option<usize> {
        [&self.q, &self.v, &self.a, &self.algorithmic]
            .map(Vec::len)
            .into_iter()
            .find(|given| *given != wanted)
    }

    /// Copies `other` without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.time = other.time;
        self.q.copy_from_slice(&other.q);
        self.v.copy_from_slice(&other.v);
        self.a.copy_from_slice(&other.a);
        self.algorithmic.copy_from_slice(&other.algorithmic);
    }
}

/// What an integration cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Accepted steps.
    pub steps: usize,
    /// Steps given up and tried again with half the length.
    pub halved_steps: usize,
    /// Accepted steps made by the fall-back scheme.
    pub fallback_steps: usize,
    /// Evaluations of the force.
    pub force_evaluations: usize,
    /// Evaluations of the tangent.
    pub tangent_evaluations: usize,
    /// Factorisations.
    pub factorizations: usize,
}

/// A one-step scheme.
pub trait Scheme {
    /// Advances `from` by `step` [s] into `to`, or says that its equations could not be solved.
    fn step(
        &mut self,
        system: &mut dyn Mechanics,
        stage: &mut Stage,
        from: &Motion,
        step: f64,
        to: &mut Motion,
    ) -> Result<(), NotConverged>;
}
