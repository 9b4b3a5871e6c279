//! Ways to a steady state that Newton's method does not find at once.
//!
//! *Easier friction.* Without a limit of friction and with a gentle rise the circulation speed may be wrong by half and
//! more. The rise is brought back first, then the limit, by factors that grow after a success and shrink after a
//! failure.
//!
//! *Given slip.* The load factor is an unknown, and the sum of the slips in the sense of the torques is given. This
//! passes where a given torque has no solution any more: the load factor rises with the slip to the capacity of the
//! drive and stays there.

use super::equations::Control;
use super::newton::{Converged, NotFound};
use super::prepare::set_laws;
use super::{Capacity, RunningBelt};
use crate::assemble::BeltElementType;
use crate::friction::{FrictionLaw, Law};
use crate::observe::PulleyState;

/// Newton iterations of one solution.
pub(super) const MAX_ITERATIONS: usize = 30;
/// Iterations of a stage of a continuation, which starts close.
const STAGE_ITERATIONS: usize = 12;
/// Stages of a continuation.
const MAX_STAGES: usize = 60;
/// Rise of friction to begin with [N s/m²].
const GENTLE: f64 = 1.0e3;
/// Friction that has no limit, in its own limits.
const UNLIMITED: f64 = 1.0e6;
/// Parts of a way below this are no progress.
const SMALLEST_PART: f64 = 1.0e-3;
/// First step of the slip, relative to the speed of the belt.
const FIRST_SLIP: f64 = 1.0e-4;
/// Smallest step of it.
const SMALLEST_SLIP: f64 = 1.0e-7;
/// Relative gain of the load factor by twice the slip that counts as none.
const GAIN: f64 = 1.0e-4;
/// Relative gain of the torques by twice the slip up to which a pulley slides as a whole: they still change, as the belt that it slows down
/// loses centrifugal force. More gain has a law so steep that what sticks is narrower than can be seen.
const GAIN_OF_SLIDING: f64 = 1.0e-2;
/// Part of an arc that slides where all of it does: at its ends, where the belt crosses the pulley's surface, slip may have another sign.
const SLIDING: f64 = 0.98;
/// Part of the most that is carried by which it has been narrowed down, and less than it that counts as round-off.
const NARROW: f64 = 1.0e-5;
const FLAT: f64 = 1.0e-8;
/// Gain below which nothing is missed where the solutions are lost.
const UNKNOWN_GAIN: f64 = 1.0e-3;

/// Where a continuation in the slip has ended.
#[derive(Debug)]
pub(super) enum Way {
    /// At the state in which the torques are those of the drive.
    Reached(Vec<f64>),
    /// More slip raises the load no further.
    Exhausted(Capacity),
    /// At this load factor the solutions were lost while it was still rising: nothing is known of those beyond.
    Lost(f64),
}

impl<E: BeltElementType> RunningBelt<E> {
    /// Newton's method from `z`.
    pub(super) fn newton(&mut self, z: &mut [f64]) -> Result<Converged, NotFound> {
        self.newton.solve(&mut self.equations, z, MAX_ITERATIONS)
    }

    /// Eases friction and brings it back.
    pub(super) fn by_easier_friction(&mut self, z: &mut [f64]) -> Result<Converged, NotFound> {
        let laws = self.laws.clone();
        // A belt that hangs on its rest tension presses with it over the radius.
        let smallest =
            (self.assembly.layout.arcs.iter()).fold(f64::INFINITY, |r, a| r.min(a.radius));
        let pressure = self.start.tension / smallest;
        let steepest = (laws.iter()).fold(0.0, |s: f64, law| s.max(law.steepest_damping(pressure)));
        let softness = (steepest / GENTLE).max(1.0);
        let found = self
            .ease(&laws, z, (UNLIMITED, softness), (UNLIMITED, 1.0))
            .and_then(|_| self.ease(&laws, z, (UNLIMITED, 1.0), (1.0, 1.0)));
        set_laws(&mut self.equations, &laws);
        found
    }

    /// From grip and softness `from` to those of `to` in geometric steps.
    fn ease(
        &mut self,
        laws: &[Law],
        z: &mut [f64],
        from: (f64, f64),
        to: (f64, f64),
    ) -> Result<Converged, NotFound> {
        let at = |part: f64| {
            let between = |a: f64, b: f64| a * (b / a).powf(part);
            (between(from.0, to.0), between(from.1, to.1))
        };
        let set = |belt: &mut Self, part: f64, z: &mut [f64]| {
            let (grip, softness) = at(part);
            let eased: Vec<Law> = laws.iter().map(|law| law.eased(grip, softness)).collect();
            set_laws(&mut belt.equations, &eased);
            let limit = if part == 0.0 {
                MAX_ITERATIONS
            } else {
                STAGE_ITERATIONS
            };
            belt.newton.solve(&mut belt.equations, z, limit)
        };
        let (mut done, mut step) = (0.0_f64, 0.25_f64);
        let mut found = set(self, 0.0, z)?;
        for _ in 0..MAX_STAGES {
            if done >= 1.0 {
                return Ok(found);
            }
            let next = (done + step).min(1.0);
            if let Ok(converged) = set(self, next, z) {
                found = converged;
                done = next;
                step *= 2.0;
            } else {
                step *= 0.25;
                if step < SMALLEST_PART {
                    break;
                }
            }
        }
        if done >= 1.0 {
            Ok(found)
        } else {
            Err(NotFound)
        }
    }

    /// The way from the drive without its torques; nothing where none act or that does not run.
    pub(super) fn raise_from_idling(&mut self) -> Option<Way> {
        let idle = self.idling()?;
        let none = self.equations.slip(&idle);
        self.by_slip(&idle, none, Some(1.0))
    }

    /// The slip without torques. Bristles that stick creep, too, where pulleys differ: their lever is the radius less the penetration.
    pub(super) fn idle_slip(&mut self) -> f64 {
        let idle = self.idling();
        self.equations.slip(idle.as_ref().unwrap_or(&self.guess))
    }

    /// The drive without its torques; nothing where that does not run.
    fn idling(&mut self) -> Option<Vec<f64>> {
        let mut idle = self.guess.clone();
        idle[self.equations.load()] = 0.0;
        self.equations.control = Control::Load(0.0);
        let mut found = self.newton(&mut idle);
        if found.is_err() {
            found = self.by_easier_friction(&mut idle);
        }
        self.equations.control = Control::Load(1.0);
        found.ok().map(|_| idle)
    }

    /// Raises the slip from that of the state `z` until the load factor is `wanted` or rises no further; `none` is the slip without
    /// torques. Nothing where no torque acts.
    pub(super) fn by_slip(&mut self, z: &[f64], none: f64, wanted: Option<f64>) -> Option<Way> {
        if self.equations.slip_weights.iter().all(|w| *w == 0.0) {
            return None;
        }
        let way = self.raise_slip(z.to_vec(), none, wanted);
        self.equations.control = Control::Load(1.0);
        Some(way)
    }

    fn raise_slip(&mut self, z: Vec<f64>, none: f64, wanted: Option<f64>) -> Way {
        let load = self.equations.load();
        let travel: f64 = (self.equations.slip_weights.iter().enumerate())
            .map(|(p, weight)| (weight * self.guess[self.equations.chain() + p]).abs())
            .fold(0.0, f64::max);
        let mut step = FIRST_SLIP * travel;
        let mut flat = 0;
        let mut gain = f64::INFINITY;
        let mut trial = z.clone();
        let mut way = Trail(vec![self.stage(z)]);
        for _ in 0..MAX_STAGES {
            way.predict(step, &mut trial);
            self.equations.control = Control::Slip(way.last().slip + step);
            let found = self
                .newton
                .solve(&mut self.equations, &mut trial, STAGE_ITERATIONS);
            if found.is_err() {
                step *= 0.25;
                if step < SMALLEST_SLIP * travel {
                    break;
                }
                continue;
            }
            let (before, next) = (way.last(), self.stage(trial.clone()));
            // Steps after a failure are short: what counts is the gain to come of twice the slip.
            let gained = if next.slip > none {
                (next.carried - before.carried) / step * (next.slip - none) / next.carried.abs()
            } else {
                f64::INFINITY
            };
            // A load that falls with the speed is met by slipping, too, without being carried.
            let shed = gained < GAIN
                && next.carried / before.carried < 0.999_999 * next.z[load] / before.z[load];
            let reached = wanted.filter(|wanted| next.z[load] >= *wanted && !shed);
            if let Some(wanted) = reached {
                if let Some(reached) = self.at_load(&before.z, &next.z, wanted) {
                    return Way::Reached(reached);
                }
                step *= 0.25;
                if step < SMALLEST_SLIP * travel {
                    break;
                }
                continue;
            }
            gain = gained;
            flat = if gain < GAIN { flat + 1 } else { 0 };
            let slides = gain < GAIN_OF_SLIDING && self.slides(&next.z);
            way.0.push(next);
            if flat >= 2 || slides {
                return Way::Exhausted(self.capacity_on(way));
            }
            step *= 2.0;
        }
        // Solutions are lost where the last points of an arc begin to slide, with the load all but exhausted. Anywhere else nothing is
        // known of those beyond.
        let sliding = gain < GAIN_OF_SLIDING && self.slides(&way.last().z);
        if gain < UNKNOWN_GAIN || sliding {
            Way::Exhausted(self.capacity_on(way))
        } else {
            let loads = way.0.iter().map(|stage| stage.z[load]);
            Way::Lost(loads.fold(0.0, f64::max))
        }
    }

    fn stage(&self, z: Vec<f64>) -> Stage {
        Stage {
            slip: self.equations.slip(&z),
            carried: self.carried(&z),
            z,
        }
    }

    /// The most that is carried on `way`. Where more slip carries less, as with friction that falls with the slip, it lies between the
    /// stages.
    fn capacity_on(&mut self, mut way: Trail) -> Capacity {
        for _ in 0..MAX_STAGES {
            let Some(middle) = way.falls_beside() else {
                break;
            };
            let [low, high] = [middle - 1, middle].map(|i| &way.0[i]);
            let mut z: Vec<f64> = (low.z.iter().zip(&high.z))
                .map(|(a, b)| 0.5 * (a + b))
                .collect();
            self.equations.control = Control::Slip(0.5 * (low.slip + high.slip));
            let found = self
                .newton
                .solve(&mut self.equations, &mut z, STAGE_ITERATIONS);
            if found.is_err() {
                break;
            }
            way.0.insert(middle, self.stage(z));
        }
        let most = &way.0[way.most()];
        // Loads that fall with the speed are multiplied as long as slip does not slow the pulleys down.
        let first = way
            .0
            .iter()
            .find(|stage| stage.carried >= (1.0 - GAIN) * most.carried);
        let first = first.unwrap_or(most);
        let load = self.equations.load();
        let factor = first.z[load] * most.carried / first.carried;
        let z = most.z.clone();
        self.capacity_at(factor, &z)
    }

    /// What the external torques in the state `z` come to, as forces on the belt [N].
    fn carried(&self, z: &[f64]) -> f64 {
        let speeds = self.equations.motion(z).speeds;
        let pulleys = self.equations.contact.pulleys.iter().zip(speeds);
        let forces = (pulleys.zip(&self.equations.slip_weights))
            .filter(|(_, weight)| **weight != 0.0)
            .map(|((pulley, speed), weight)| pulley.external.value(0.0, *speed) / weight);
        z[self.equations.load()] * forces.sum::<f64>()
    }

    /// The state of the load factor `wanted` between `low` and `high`.
    fn at_load(&mut self, low: &[f64], high: &[f64], wanted: f64) -> Option<Vec<f64>> {
        let load = self.equations.load();
        let part = (wanted - low[load]) / (high[load] - low[load]);
        let mut z: Vec<f64> = (low.iter().zip(high))
            .map(|(a, b)| a + part * (b - a))
            .collect();
        self.equations.control = Control::Load(wanted);
        self.newton
            .solve(&mut self.equations, &mut z, STAGE_ITERATIONS)
            .ok()?;
        Some(z)
    }

    /// Whether friction is exhausted all along a pulley that transmits a torque in the state `z`: gross slip.
    pub(super) fn slides(&mut self, z: &[f64]) -> bool {
        let found = self.observe(z);
        let transmits = (self.equations.prescribed.iter())
            .zip(&self.equations.slip_weights)
            .map(|(speed, weight)| speed.is_some() || *weight != 0.0);
        (found.pulleys.iter().zip(transmits))
            .any(|(p, transmits)| transmits && sliding_part(p) > SLIDING)
    }

    /// The state `z` read as the most that the drive carries, `factor` times its torques.
    fn capacity_at(&mut self, factor: f64, z: &[f64]) -> Capacity {
        let found = self.observe(z);
        let pulley = (0..found.pulleys.len()).fold(0, |most, p| {
            if sliding_part(&found.pulleys[p]) > sliding_part(&found.pulleys[most]) {
                p
            } else {
                most
            }
        });
        let torques = found.pulleys.iter().map(|p| p.external_torque).collect();
        Capacity {
            factor,
            pulley,
            torques,
            slack_tension: found
                .spans
                .iter()
                .fold(f64::INFINITY, |t, s| t.min(s.tension)),
        }
    }
}

/// A solution on the way of rising slip.
struct Stage {
    slip: f64,
    /// What the torques come to, as forces on the belt [N].
    carried: f64,
    z: Vec<f64>,
}

/// The solutions on the way, by rising slip; one at least.
struct Trail(Vec<Stage>);

impl Trail {
    fn last(&self) -> &Stage {
        &self.0[self.0.len() - 1]
    }

    /// Writes where the line through the last two solutions is after `step` more slip; the last, where there is no other.
    fn predict(&self, step: f64, z: &mut [f64]) {
        let now = self.last();
        z.copy_from_slice(&now.z);
        if let [.., before, _] = self.0.as_slice() {
            let part = step / (now.slip - before.slip);
            for ((z, now), before) in z.iter_mut().zip(&now.z).zip(&before.z) {
                *z += part * (now - before);
            }
        }
    }

    /// The stage that carries most.
    fn most(&self) -> usize {
        (0..self.0.len()).fold(0, |most, i| {
            if self.0[i].carried > self.0[most].carried {
                i
            } else {
                most
            }
        })
    }

    /// The stage before which one more narrows the maximum down: the wider side of the one that carries most, as long as a neighbour
    /// carries clearly less and so much more may be found between.
    fn falls_beside(&self) -> Option<usize> {
        let most = self.most();
        let [before, at, after] = [most.checked_sub(1)?, most, most + 1].map(|i| self.0.get(i));
        let (before, at, after) = (before?, at?, after?);
        let falls = (at.carried - before.carried).max(at.carried - after.carried);
        let ends = at.carried - after.carried > FLAT * at.carried;
        if !ends || falls <= NARROW * at.carried {
            return None;
        }
        let wider = after.slip - at.slip > at.slip - before.slip;
        Some(if wider { most + 1 } else { most })
    }
}

/// Part of a pulley's contact where friction is exhausted; all of none.
fn sliding_part(pulley: &PulleyState) -> f64 {
    if pulley.contact_angle > 0.0 {
        pulley.slip_angle / pulley.contact_angle
    } else {
        1.0
    }
}
