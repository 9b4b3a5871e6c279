//! How far a run has come: bars on standard error, with simulated time and estimated time left, or
//! with a count.

use std::time::{Duration, Instant};

use hihna::simulate::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Parts into which the bar divides a run.
const PARTS: f64 = 10_000.0;
/// Time between updates: steps are far quicker than eyes.
const INTERVAL: Duration = Duration::from_millis(50);

/// A bar, drawn if standard error is a terminal.
pub struct Bar {
    bar: ProgressBar,
    updated: Option<Instant>,
}

impl Bar {
    /// An empty bar, drawn if `visible`.
    pub fn new(visible: bool) -> Self {
        let target = target(visible);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small positive constant"
        )]
        let bar = ProgressBar::with_draw_target(Some(PARTS as u64), target);
        // The template is fixed and tested; without it there is a plain bar.
        if let Ok(style) =
            ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}  {eta} left")
        {
            bar.set_style(style);
        }
        bar.set_message("settling on the pulleys");
        bar.tick();
        Self { bar, updated: None }
    }

    /// Shows how far the run is, now and then.
    pub fn update(&mut self, progress: &Progress) {
        if self
            .updated
            .is_some_and(|updated| updated.elapsed() < INTERVAL)
        {
            return;
        }
        self.updated = Some(Instant::now());
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a part of the run, from 0 to 1, times parts"
        )]
        let parts = (progress.time / progress.end_time * PARTS) as u64;
        self.bar.set_position(parts);
        self.bar.set_message(format!(
            "{:.3} of {:.3} s simulated in {} steps",
            progress.time, progress.end_time, progress.steps
        ));
    }

    /// Removes the bar.
    pub fn finish(self) {
        self.bar.finish_and_clear();
    }
}

/// A bar of things that are done or not, drawn if standard error is a terminal; threads may share it.
pub struct CountBar {
    bar: ProgressBar,
}

impl CountBar {
    /// An empty bar for `count` things, drawn if `visible`.
    pub fn new(count: usize, visible: bool) -> Self {
        let bar = ProgressBar::with_draw_target(Some(count as u64), target(visible));
        // The template is fixed; without it there is a plain bar.
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos} of {len}  {elapsed}  {msg}")
        {
            bar.set_style(style);
        }
        bar.tick();
        Self { bar }
    }

    /// One more is done.
    pub fn done(&self, name: &str) {
        self.bar.set_message(name.to_owned());
        self.bar.inc(1);
    }

    /// Removes the bar.
    pub fn finish(self) {
        self.bar.finish_and_clear();
    }
}

fn target(visible: bool) -> ProgressDrawTarget {
    if visible {
        ProgressDrawTarget::stderr()
    } else {
        ProgressDrawTarget::hidden()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bar takes any progress, also of a run of no length.
    #[test]
    fn any_progress_can_be_shown() {
        let mut bar = Bar::new(false);
        for (time, end_time) in [
            (0.0, 1.0),
            (0.5, 1.0),
            (2.0, 1.0),
            (0.0, 0.0),
            (f64::NAN, 1.0),
        ] {
            bar.updated = None;
            bar.update(&Progress {
                time,
                end_time,
                steps: 1,
            });
        }
        bar.finish();
    }
}
