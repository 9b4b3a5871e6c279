//! The classical explicit Runge-Kutta scheme of fourth order on the constant mass matrix: the
//! dissertation's form, here the cross-check of the implicit path.

use super::stage::{NotConverged, Stage};
use super::{Motion, Scheme, StepRule};
use crate::system::Mechanics;

/// The scheme and its stages.
#[derive(Clone, Debug)]
pub struct RungeKutta4 {
    trial: Motion,
    velocity_sum: Vec<f64>,
    acceleration_sum: Vec<f64>,
}

impl RungeKutta4 {
    /// The scheme for systems of `size` coordinates.
    #[must_use]
    pub fn new(size: usize) -> Self {
        Self {
            trial: Motion::zero(size),
            velocity_sum: vec![0.0; size],
            acceleration_sum: vec![0.0; size],
        }
    }
}

impl Scheme for RungeKutta4 {
    fn step(
        &mut self,
        system: &mut dyn Mechanics,
        stage: &mut Stage,
        from: &Motion,
        step: f64,
        to: &mut Motion,
    ) -> Result<(), NotConverged> {
        let trial = &mut self.trial;
        trial.copy_from(from);
        self.velocity_sum.copy_from_slice(&trial.v);
        self.acceleration_sum.copy_from_slice(&trial.a);
        for (fraction, weight) in [(0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            let h = fraction * step;
            // trial.v and trial.a are still those of the stage before
            advance(&mut trial.q, &from.q, h, &trial.v);
            advance(&mut trial.v, &from.v, h, &trial.a);
            trial.time = from.time + h;
            stage.accelerations(system, trial);
            add(&mut self.velocity_sum, weight, &trial.v);
            add(&mut self.acceleration_sum, weight, &trial.a);
        }
        to.time = from.time + step;
        advance(&mut to.q, &from.q, step / 6.0, &self.velocity_sum);
        advance(&mut to.v, &from.v, step / 6.0, &self.acceleration_sum);
        stage.accelerations(system, to);
        to.algorithmic.copy_from_slice(&to.a);
        if to.a.iter().all(|x| x.is_finite()) {
            Ok(())
        } else {
            Err(NotConverged::diverged(to.time))
        }
    }

    /// A sum of second order: steps are far shorter than what is summed changes in.
    fn rule(&self) -> StepRule<'_> {
        StepRule::TRAPEZOIDAL
    }
}

/// `to = from + h rate`.
fn advance(to: &mut [f64], from: &[f64], h: f64, rate: &[f64]) {
    for ((to, from), rate) in to.iter_mut().zip(from).zip(rate) {
        *to = from + h * rate;
    }
}

/// `sum += weight x`.
fn add(sum: &mut [f64], weight: f64, x: &[f64]) {
    for (sum, x) in sum.iter_mut().zip(x) {
        *sum += weight * x;
    }
}
