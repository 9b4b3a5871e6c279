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

    /// How the last step integrated accelerations.
    fn rule(&self) -> StepRule<'_>;
}

/// How a scheme integrates the true accelerations x over a step of length h, its algorithmic ones being a:
///
/// ```text
/// v1 - v0 = h (w0 x0 + w1 x_middle + w2 x1) + lag h [(x1 - a1) - (x0 - a0)]
/// ```
///
/// exactly for the implicit schemes, so that sums of works and impulses by the same rule have no error of their own.
#[derive(Clone, Copy, Debug)]
pub struct StepRule<'a> {
    /// The weights of start, middle and end.
    pub weights: [f64; 3],
    /// The state between the ends at which the equations of motion were solved, if any was.
    pub middle: Option<&'a Motion>,
    /// `1/2 - af` of generalized-alpha; zero where there is but one acceleration.
    pub lag: f64,
}

impl StepRule<'_> {
    /// The mean of both ends: that of generalized-alpha but for its lag, and a second-order sum for any scheme.
    pub const TRAPEZOIDAL: Self = Self {
        weights: [0.5, 0.0, 0.5],
        middle: None,
        lag: 0.0,
    };
}
