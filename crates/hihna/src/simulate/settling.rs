//! `run.until = "steady"`: whether the means of a run have settled.
//!
//! From the last kink of the profiles on, time is cut into windows of the length W: P whole passages of an element through a
//! place of the belt's path, at least one period of the slowest swing of a free pulley and of every prescribed irregularity,
//! and twenty rows of the history. With the mean `m_k` and the standard deviation `s_k` over window k of every pulley's speed and every
//! span's tension, by their nominal values, `d_k = |m_k - m_(k-1)|` and the accuracy of the run, the run has settled when for all of
//! them
//!
//! ```text
//! min [max(d_(k-1), d_k² / (d_(k-1) - d_k)), 10 max(d_(k-1), d_k)] <= a        (the first if d_k < d_(k-1))
//! a = accuracy; where the scatter no longer shrinks, s_k >= 0.8 s_(k-1), at least the standard error s_k / sqrt(P) of a mean
//! ```
//!
//! `d_k² / (d_(k-1) - d_k)` is left to come of changes that go on shrinking by the same factor; of others tenfold is taken. Coarse meshes
//! shake the belt as elements pass, so that means are known to their standard error only. Changes below a tenth are taken for scatter: a
//! mean that drifts more slowly than by that in a window is beyond this criterion.

use std::f64::consts::TAU;

use super::control::{fastest_and_slowest_harmonic, nominal_speed, slowest_swing};
use crate::assemble::Mounting;
use crate::drive::Drive;
use crate::history::History;

/// Least number of rows of the history in a window.
const ROWS: f64 = 20.0;
/// What is left to come of changes that do not shrink, by the larger of the last two: a tenth of the accuracy is scatter.
const NOT_SHRINKING: f64 = 10.0;
/// Least ratio of the standard deviations of windows whose scatter no longer shrinks.
const STATIONARY: f64 = 0.8;

/// Whether and when a run has settled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settling {
    /// Whether it has.
    pub reached: bool,
    /// Where the last two whole windows begin and end [s].
    pub from: f64,
    /// Their end [s].
    pub to: f64,
    /// Length of a window [s].
    pub window: f64,
    /// Change between the last two windows, relative to its nominal value [-], of the mean that has most left to come against what is
    /// allowed; not a number before there are three windows.
    pub change: f64,
    /// What its changes let expect to come [-]; not a number before there are three windows.
    pub left: f64,
    /// What is allowed of it [-].
    pub tolerance: f64,
}

/// A column of the history and its nominal value.
#[derive(Clone, Copy, Debug)]
struct Watched {
    column: usize,
    scale: f64,
}

/// Mean and standard deviation over a window.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    mean: f64,
    deviation: f64,
}

/// Reads the rows of a history as they come.
#[derive(Clone, Debug)]
pub(super) struct Watch {
    watched: Vec<Watched>,
    settling: Settling,
    /// Rows read.
    read: usize,
    /// Start of the open window [s], its sums and number of rows.
    begins: f64,
    sums: Vec<[f64; 2]>,
    rows: usize,
    /// Passages in a window, and the accuracy of the run.
    passages: f64,
    accuracy: f64,
    /// Of the windows before, latest last, three at most.
    windows: Vec<Vec<Moments>>,
}

impl Watch {
    /// A watch of the run of `drive` into `history`.
    pub fn new(drive: &Drive, mounting: &Mounting, history: &History) -> Self {
        let speed = nominal_speed(drive);
        let column = |name: String| history.columns().iter().position(|c| *c == name);
        let next = drive.pulley.iter().cycle().skip(1);
        let watched: Vec<Watched> = (drive.pulley.iter().zip(next))
            .flat_map(|(pulley, next)| {
                let span = format!("{}-{}.tension", pulley.name, next.name);
                [
                    (format!("{}.speed", pulley.name), speed / pulley.radius),
                    (span, mounting.tension),
                ]
            })
            .filter_map(|(name, scale)| column(name).map(|column| Watched { column, scale }))
            .collect();
        let begins = last_kink(drive);
        let passage = mounting.path / (drive.belt.elements as f64 * speed);
        let passages = (least_window(drive, mounting) / passage).ceil().max(1.0);
        Self {
            sums: vec![[0.0; 2]; watched.len()],
            watched,
            settling: Settling {
                reached: false,
                from: begins,
                to: begins,
                window: passages * passage,
                change: f64::NAN,
                left: f64::NAN,
                tolerance: drive.run.accuracy,
            },
            read: 0,
            begins,
            rows: 0,
            passages,
            accuracy: drive.run.accuracy,
            windows: Vec::new(),
        }
    }

    /// Takes the new rows of `history` in; whether the run has settled.
    pub fn settled(&mut self, history: &History) -> bool {
        for row in history.rows().skip(self.read) {
            self.read += 1;
            if row[0] < self.begins {
                continue;
            }
            if row[0] >= self.begins + self.settling.window {
                self.close();
                if self.settling.reached {
                    return true;
                }
            }
            for (sum, watched) in self.sums.iter_mut().zip(&self.watched) {
                let value = row[watched.column] / watched.scale;
                sum[0] += value;
                sum[1] += value * value;
            }
            self.rows += 1;
        }
        false
    }

    /// What was seen.
    pub fn settling(&self) -> Settling {
        self.settling
    }

    /// Ends the open window and judges.
    fn close(&mut self) {
        let rows = self.rows as f64;
        let moments = self.sums.iter().map(|[sum, squares]| {
            let mean = sum / rows;
            Moments {
                mean,
                deviation: (squares / rows - mean * mean).max(0.0).sqrt(),
            }
        });
        self.windows.push(moments.collect());
        self.sums.fill([0.0; 2]);
        self.rows = 0;
        self.begins += self.settling.window;
        if self.windows.len() > 3 {
            self.windows.remove(0);
        }
        self.settling.to = self.begins;
        self.settling.from = self.begins - 2.0 * self.settling.window;
        let [earlier, before, last] = self.windows.as_slice() else {
            return;
        };
        let mut worst = 0.0;
        for ((earlier, before), last) in earlier.iter().zip(before).zip(last) {
            let stationary = last.deviation >= STATIONARY * before.deviation;
            let error = last.deviation / self.passages.sqrt();
            let allowed = if stationary {
                self.accuracy.max(error)
            } else {
                self.accuracy
            };
            let change = (last.mean - before.mean).abs();
            let left = left_to_come((before.mean - earlier.mean).abs(), change);
            // Not a number is worse than any.
            if left.is_nan() || left / allowed >= worst {
                worst = if left.is_nan() {
                    f64::INFINITY
                } else {
                    left / allowed
                };
                self.settling.change = change;
                self.settling.left = left;
                self.settling.tolerance = allowed;
            }
        }
        self.settling.reached = worst <= 1.0;
    }
}

/// What two changes, one after the other, let expect to come.
fn left_to_come(before: f64, last: f64) -> f64 {
    if before.is_nan() || last.is_nan() {
        return f64::NAN;
    }
    let steady = NOT_SHRINKING * before.max(last);
    if last < before {
        before.max(last * last / (before - last)).min(steady)
    } else {
        steady
    }
}

/// When the profiles of `drive` have come to their last values [s].
pub(crate) fn last_kink(drive: &Drive) -> f64 {
    let hubs = (drive.pulley.iter())
        .filter_map(|pulley| pulley.displacement.as_ref())
        .flat_map(|hub| [&hub.x, &hub.y, &hub.z]);
    (drive.pulley.iter())
        .flat_map(|p| [Some(&p.torque), p.speed.as_ref(), p.angle.as_ref()])
        .flatten()
        .chain(hubs)
        .flat_map(crate::profile::Profile::kinks)
        .fold(0.0, f64::max)
}

/// Least length of a window [s].
fn least_window(drive: &Drive, mounting: &Mounting) -> f64 {
    let period = |frequency: f64| {
        if frequency > 0.0 {
            TAU / frequency
        } else {
            0.0
        }
    };
    let (_, slowest) = fastest_and_slowest_harmonic(drive);
    period(slowest_swing(drive, mounting))
        .max(period(slowest))
        .max(ROWS * drive.run.output_interval)
}

#[cfg(test)]
mod tests {
    use super::left_to_come;

    /// Means that come to rest by the factor q a window, `m_k = q^k`: after the changes `d`, `q d`, what is left is `q² d/(1 - q)` exactly,
    /// however slow.
    #[test]
    fn slow_decays_are_seen_to_their_end() {
        for q in [0.2_f64, 0.5, 0.9, 0.99] {
            for k in 0..200 {
                let error = q.powi(k + 2);
                let before = q.powi(k) - q.powi(k + 1);
                let last = q.powi(k + 1) - error;
                let expected = left_to_come(before, last);
                let wanted = before.max(error).min(10.0 * before);
                assert!((expected - wanted).abs() <= 1.0e-9 * wanted, "{q}: {error}");
            }
        }
    }

    /// Scatter may grow, larger changes may not.
    #[test]
    fn scatter_and_growth() {
        assert!(left_to_come(1.0e-5, 9.0e-5) <= 1.0e-3);
        assert!(left_to_come(1.0e-4, 5.0e-4) > 1.0e-3);
        assert!(left_to_come(f64::NAN, 0.0).is_nan() && left_to_come(0.0, f64::NAN).is_nan());
        assert!(left_to_come(2.0e-3, 1.0e-5) > 1.0e-3);
    }
}
