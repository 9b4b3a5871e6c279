//! Over which part of a run its steady means are taken.

use std::f64::consts::TAU;

use serde::Serialize;

use crate::drive::Drive;
use crate::quantities::with_prefix;
use crate::simulate::{Outcome, last_kink};

/// Part of the run, at its end, over which means are taken at least.
const STEADY_PART: f64 = 0.1;

/// The times over which means are taken.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Averaged {
    /// Their beginning [s].
    pub from: f64,
    /// Their end [s].
    pub to: f64,
    /// Of a driver with an irregularity: how many periods of its slowest order they are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub periods: Option<usize>,
}

impl Averaged {
    /// The windows in which the run has settled, or else its last tenth. An irregularity swings the drive: then whole periods of
    /// the slowest order, a tenth of the run or more, as far as the run goes on with constant profiles.
    pub(super) fn new(drive: &Drive, outcome: &Outcome) -> Self {
        let end = outcome.end_time;
        match outcome.settling {
            Some(settling) if settling.reached => Self {
                from: settling.from,
                to: settling.to,
                periods: None,
            },
            _ => Self::whole_periods(drive, end).unwrap_or(Self {
                from: (1.0 - STEADY_PART) * end,
                to: end,
                periods: None,
            }),
        }
    }

    /// What part of the run it is, at its end, of a run that has not settled.
    pub fn in_words(&self) -> String {
        match self.periods {
            None => "tenth of the run".to_owned(),
            Some(count) => {
                let periods = match count {
                    1 => "period".to_owned(),
                    _ => format!("{count} periods"),
                };
                let duration = with_prefix(self.to - self.from, "s");
                format!("{periods} of the irregularity, {duration}")
            }
        }
    }

    /// As many periods as fit; none where there are none.
    fn whole_periods(drive: &Drive, end: f64) -> Option<Self> {
        let period = slowest_period(drive, end)?;
        let room = ((end - last_kink(drive)) / period * (1.0 + 1.0e-12)).floor();
        let count = (STEADY_PART * end / period).ceil().min(room);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count from one to the number of periods in a run"
        )]
        (count >= 1.0).then_some(Self {
            from: end - count * period,
            to: end,
            periods: Some(count as usize),
        })
    }
}

/// Period of the slowest order of all irregularities [s], by the mean speeds at `time`; none where nothing swings.
fn slowest_period(drive: &Drive, time: f64) -> Option<f64> {
    let frequencies = drive.pulley.iter().flat_map(|pulley| {
        let speed = pulley.speed.as_ref().map_or(0.0, |mean| mean.value(time));
        let swinging = pulley.irregularity.iter().filter(|h| h.amplitude > 0.0);
        swinging.map(move |harmonic| harmonic.order * speed.abs())
    });
    let slowest = frequencies.filter(|f| *f > 0.0).reduce(f64::min)?;
    Some(TAU / slowest)
}
