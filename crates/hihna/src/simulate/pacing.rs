//! Steps that keep the energy balance.
//!
//! Prediction chooses steps by what velocities do, and that keeps the balance of most runs. Where it does not, shorter steps do, as long as
//! it is the steps that err: the residual has then been growing, and would be beyond the limit L once as much time has passed again. With
//! the residual R at the time t and its growth `g = c h²` by steps h of schemes of second order,
//!
//! ```text
//! finer     |R| > L/2,    g t > L/10    and    |R| + g t > L
//! hold      the same with steps twice as long, 4 g
//! L = 0.8 tolerance (turned over + held)
//! ```
//!
//! c is measured over fiftieths of the time that has passed, and what it was before fades by a tenth in each: belts beat.
//! A residual that stands where it is, or wavers with what Newton's method leaves over, asks for nothing: no step would mend it.

use ancf::dynamics::Pace;

/// Part of c that is left of what it was one look before.
const MEMORY: f64 = 0.9;
/// Steps between two looks, at least, and the part of the time that has passed: elements pass in between.
const STEPS: usize = 16;
const PART: f64 = 0.02;
/// Part of the tolerance that is aimed at: what grows by less than is asked for goes on growing.
const MARGIN: f64 = 0.8;

/// Looks at the residual now and then.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pacing {
    tolerance: f64,
    /// When it was looked at last [s], and what it was [J].
    time: f64,
    residual: f64,
    /// Steps since.
    steps: usize,
    /// c [W/s²].
    rate: f64,
    hold: bool,
}

impl Pacing {
    /// Of a run whose residual may be `tolerance` of what is turned over and held.
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            time: 0.0,
            residual: 0.0,
            steps: 0,
            rate: 0.0,
            hold: false,
        }
    }

    /// The pace after a step to `time` [s] with the energies `residual` and `held` [J], the latter with all that was turned over.
    pub fn pace(&mut self, time: f64, residual: f64, held: f64) -> Pace {
        self.steps += 1;
        let mut finer = false;
        if self.steps >= STEPS && time - self.time >= PART * time {
            let limit = MARGIN * self.tolerance * held;
            let size = residual.abs();
            let step = (time - self.time) / self.steps as f64;
            let grown = (size - self.residual.abs()).max(0.0) / (time - self.time);
            self.rate = (grown / (step * step)).max(MEMORY * self.rate);
            let growth = self.rate * step * step;
            let breaks = |to_come: f64| {
                size > 0.5 * limit && to_come > 0.1 * limit && size + to_come > limit
            };
            finer = breaks(growth * time);
            self.hold = breaks(4.0 * growth * time);
            self.time = time;
            self.residual = residual;
            self.steps = 0;
        }
        match (finer, self.hold) {
            (true, _) => Pace::Finer,
            (false, true) => Pace::Hold,
            (false, false) => Pace::Free,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is asked for in the last tenth of a run, where it matters most.
    fn last(residual: impl Fn(f64) -> f64) -> Pace {
        let mut pacing = Pacing::new(1.0e-4);
        let end = STEPS * 1000;
        let paces: Vec<Pace> = (1..=end)
            .map(|step| pacing.pace(step as f64, residual(step as f64), 1.0))
            .collect();
        let late = &paces[end * 9 / 10..];
        let asked = [Pace::Finer, Pace::Hold]
            .into_iter()
            .find(|pace| late.contains(pace));
        asked.unwrap_or(Pace::Free)
    }

    /// A residual that will leave its limit asks for shorter steps, one that would leave it with longer steps for no longer ones; one that
    /// stands beyond the limit, wavers, or is small for nothing.
    #[test]
    fn what_grows_beyond_the_limit_is_held_back() {
        let end = (STEPS * 1000) as f64;
        assert_eq!(last(|t| 0.7e-4 * t / end), Pace::Finer);
        assert_eq!(last(|t| 0.44e-4 + 0.08e-4 * t / end), Pace::Hold);
        assert_eq!(last(|_| -3.0e-4), Pace::Free);
        assert_eq!(last(|t| 0.6e-4 + 1.0e-8 * (t * 12.9898).sin()), Pace::Free);
        assert_eq!(last(|t| 1.0e-5 * t / end), Pace::Free);
    }
}
