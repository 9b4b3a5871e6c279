//! `hihna steady --model fe --modes`: modes about the running state.

use std::f64::consts::TAU;
use std::fmt::Write;

use hihna::steady::running::modes::Mode;
use hihna::summary::Named;
use serde::Serialize;

use crate::quantities::{percent, plain};
use crate::tables::columns;

/// A mode as `--json` prints it.
#[derive(Debug, Serialize)]
pub struct ModeSummary {
    /// Frequency [Hz].
    frequency: f64,
    /// Rate of growth [1/s].
    growth: f64,
    damping_ratio: f64,
    /// Part of the pulleys in the kinetic energy.
    pulley_share: f64,
    /// Real and imaginary part of x and y of every node, the largest of magnitude one.
    shape: Vec<[[f64; 2]; 2]>,
    /// Real and imaginary part of every pulley's angular velocity on the same scale.
    pulley: Named<[f64; 2]>,
}

/// The modes of a drive with these pulleys.
pub fn summary(modes: &[Mode], names: &[&str]) -> Vec<ModeSummary> {
    let of = |mode: &Mode| ModeSummary {
        frequency: mode.frequency / TAU,
        growth: mode.growth,
        damping_ratio: mode.damping_ratio(),
        pulley_share: mode.pulley_share,
        shape: mode.shape.clone(),
        pulley: Named(
            (names.iter().zip(&mode.pulleys))
                .map(|(name, speed)| ((*name).to_owned(), *speed))
                .collect(),
        ),
    };
    modes.iter().map(of).collect()
}

/// A table, and a word on those of `wanted` that were not found, or that none grows.
pub fn in_words(modes: &[ModeSummary], wanted: usize) -> String {
    let header = ["mode", "frequency", "growth", "damping", "pulleys' energy"];
    let mut table = columns(&header, &[0, 1, 2, 3, 4]);
    for (i, mode) in modes.iter().enumerate() {
        table.add_row([
            (i + 1).to_string(),
            plain(mode.frequency, "Hz"),
            plain(mode.growth, "1/s"),
            percent(mode.damping_ratio),
            percent(mode.pulley_share),
        ]);
    }
    let mut text = format!("{}\n\n", table.trim_fmt());
    if modes.len() < wanted {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{} of {wanted} modes were found: more `belt.elements` have more.",
            modes.len()
        );
    }
    if stability(modes).is_none() {
        text.push_str("None of these modes grows.\n");
    }
    text
}

/// What growing modes mean, if any grows.
pub fn stability(modes: &[ModeSummary]) -> Option<String> {
    let growing = modes.iter().filter(|mode| mode.growth > 0.0);
    let (swing, leave): (Vec<_>, Vec<_>) = growing.partition(|mode| mode.frequency > 0.0);
    let fastest = |modes: &[&ModeSummary]| {
        let growth = modes
            .iter()
            .fold(0.0, |most: f64, mode| most.max(mode.growth));
        plain(growth, "1/s")
    };
    match (swing.as_slice(), leave.as_slice()) {
        ([], []) => None,
        (swing, []) => Some(format!(
            "{} of the modes grow, the fastest by {}. In this linear picture partial slip makes weak growth that changes with the mesh, so confirm it with more `belt.elements`",
            swing.len(),
            fastest(swing)
        )),
        (_, leave) => Some(format!(
            "a motion without swing grows by {}, as where a torque that drives rises with the speed: if more `belt.elements` confirm it, the drive does not stay in this state",
            fastest(leave)
        )),
    }
}
