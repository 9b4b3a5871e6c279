//! The classical explicit Runge-Kutta scheme of fourth order on the constant mass matrix: the
//! dissertation's form, here the cross-check of the implicit path.

use super::stage::{NotConverged, Stage};
use super::{Motion, Scheme};
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
        let size = from.q.len();
        let trial = &mut self.trial;
        trial.copy_from(from);
        self.velocity_sum.copy_from_slice(&trial.v);
        self.acceleration_sum.copy_from_slice(&trial.a);
        for (fraction, weight) in [(0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            let h = fraction * step;
            for i in 0..size {
                // trial.v and trial.a are still those of the stage before
                trial.q[i] = from.q[i] + h * trial.v[i];
                trial.v[i] = from.v[i] + h * trial.a[i];
            }
            trial.time = from.time + h;
            stage.accelerations(system, trial);
            for i in 0..size {
                self.velocity_sum[i] += weight * trial.v[i];
                self.acceleration_sum[i] += weight * trial.a[i];
            }
        }
        to.time = from.time + step;
        for i in 0..size {
            to.q[i] = from.q[i] + step / 6.0 * self.velocity_sum[i];
            to.v[i] = from.v[i] + step / 6.0 * self.acceleration_sum[i];
        }
        stage.accelerations(system, to);
        to.algorithmic.copy_from_slice(&to.a);
        if to.a.iter().all(|x| x.is_finite()) {
            Ok(())
        } else {
            Err(NotConverged::diverged(to.time))
        }
    }
}
