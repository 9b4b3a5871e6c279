//! The drive that ramps up to 12 rad/s, Table 3.1: Figs 3.7-3.9 and 3.21, and its ring-down.

use std::f64::consts::PI;

use super::ring_down::RingDown;
use super::time_run::{Extremum, TimeRun};
use super::{CaseError, Quantities};

const FIGURE_3_7: &str = include_str!("../../../../examples/figure_3_7.toml");
const FIGURE_3_8: &str = include_str!("../../../../examples/figure_3_8.toml");
const FIGURE_3_9: &str = include_str!("../../../../examples/figure_3_9.toml");
const FIGURE_3_21: &str = include_str!("../../../../examples/figure_3_21.toml");

/// A mesh that is converged.
const CONVERGED: &str = "belt.elements=80";
/// The steady speed of the driver [rad/s].
const SPEED: f64 = 12.0;
/// The ramp after its first swing [s].
const LATE_RAMP: [f64; 2] = [0.2, 0.6];
/// The driven pulley has come up; the text compares overshoots up to about here [s].
const OVERSHOOT_OVER: f64 = 0.8;
/// The whole run.
const ALWAYS: f64 = f64::INFINITY;

fn run(text: &str, changes: &[&str]) -> Result<TimeRun, CaseError> {
    TimeRun::new(text, changes)
}

/// Largest difference of the driven speed up to a time, in percent of 12 rad/s.
fn difference(a: &TimeRun, b: &TimeRun, until: f64) -> Result<f64, CaseError> {
    let window = [0.0, until];
    let (a, b) = (
        a.window("driven.speed", window)?,
        b.window("driven.speed", window)?,
    );
    let largest = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
    Ok(100.0 * largest.fold(0.0, f64::max) / SPEED)
}

/// 20, 25 and 30 elements against 80; 5, 7 and 11 integration points.
pub(super) fn figure_3_7() -> Result<Quantities, CaseError> {
    let with = |elements: &str, points: &str| run(FIGURE_3_7, &[elements, points]);
    let [twenty, thirty] = ["belt.elements=20", "belt.elements=30"];
    let seven = "contact.points=7";
    let converged = with(CONVERGED, seven)?;
    let coarse = with(twenty, seven)?;
    let fine = with(thirty, seven)?;
    let coarse_error = difference(&coarse, &converged, ALWAYS)?;
    let middle_error = difference(&with("belt.elements=25", seven)?, &converged, ALWAYS)?;
    let fine_error = difference(&fine, &converged, ALWAYS)?;
    let peak = converged.peak("driven.speed")?;
    let mut quantities = vec![
        ("20 elements from 80".to_owned(), coarse_error),
        ("25 elements from 80".to_owned(), middle_error),
        ("30 elements from 80".to_owned(), fine_error),
        (
            "error with 30 elements over that with 20".to_owned(),
            fine_error / coarse_error,
        ),
        ("largest speed".to_owned(), peak.value),
        ("time of the largest speed".to_owned(), peak.time),
    ];
    for (points, name) in [("contact.points=5", "5"), ("contact.points=11", "11")] {
        let other = with(twenty, points)?;
        let until = difference(&coarse, &other, OVERSHOOT_OVER)?;
        quantities.push((
            format!("7 from {name} points, 20 elements, to 0.8 s"),
            until,
        ));
        let whole = difference(&coarse, &other, ALWAYS)?;
        quantities.push((
            format!("7 from {name} points, 20 elements, to 1.5 s"),
            whole,
        ));
        let whole = difference(&fine, &with(thirty, points)?, ALWAYS)?;
        quantities.push((
            format!("7 from {name} points, 30 elements, to 1.5 s"),
            whole,
        ));
    }
    Ok(quantities)
}

/// Half a period [s] and rate of decay [1/s] of a ring-down, from the first and the last of the extrema
/// within `window`.
fn ring_down(run: &TimeRun, window: [f64; 2], apart: f64) -> Result<(f64, f64), CaseError> {
    let extrema = run.extrema("driven.speed", window, apart)?;
    let swing = |pair: &[Extremum]| (pair[1].value - pair[0].value).abs();
    let mut pairs = extrema.windows(2);
    let (Some(first), Some(last)) = (pairs.next(), pairs.next_back()) else {
        return Err(CaseError::DoesNotRun);
    };
    let time = last[0].time - first[0].time;
    let half_periods = (extrema.len() - 2) as f64;
    Ok((
        time / half_periods,
        (swing(first) / swing(last)).ln() / time,
    ))
}

/// Where the ring-down is measured, after its first two swings [s], and the least time between extrema.
const COMPLIANT: ([f64; 2], f64) = ([0.68, 1.06], 0.04);
const STIFF: ([f64; 2], f64) = ([0.625, 0.71], 0.014);

/// The stiff belt overshoots less and rings down faster.
pub(super) fn figure_3_8() -> Result<Quantities, CaseError> {
    let stiff = run(FIGURE_3_8, &[CONVERGED])?;
    let compliant = run(FIGURE_3_7, &[CONVERGED])?;
    let (_, stiff_decay) = ring_down(&stiff, STIFF.0, STIFF.1)?;
    let (_, compliant_decay) = ring_down(&compliant, COMPLIANT.0, COMPLIANT.1)?;
    Ok(vec![
        (
            "largest speed, 30 elements".to_owned(),
            run(FIGURE_3_8, &[])?.peak("driven.speed")?.value,
        ),
        (
            "largest speed, 80 elements".to_owned(),
            stiff.peak("driven.speed")?.value,
        ),
        (
            "decay of the ring-down over that of the compliant belt".to_owned(),
            stiff_decay / compliant_decay,
        ),
    ])
}

/// Creep makes the driven pulley lag.
pub(super) fn figure_3_9() -> Result<Quantities, CaseError> {
    let lag = |slope: &str| -> Result<(f64, TimeRun), CaseError> {
        let run = run(FIGURE_3_9, &[slope])?;
        let speed = |name: &str| run.mean(name, LATE_RAMP);
        Ok((speed("driver.speed")? - speed("driven.speed")?, run))
    };
    let (large, run) = lag("contact.friction.slope=1e4")?;
    let (small, _) = lag("contact.friction.slope=1e5")?;
    // Even friction along both arcs carries the torque I alpha: slip (I alpha/R)/(v_s pi R) on each.
    let driven = &run.drive.pulley[1];
    let torque = driven.inertia * SPEED / 0.55;
    let even = 2.0 * torque / (driven.radius.powi(3) * PI * 1.0e4);
    Ok(vec![
        ("mean lag in the ramp, slope 1e4".to_owned(), large),
        (
            "mean lag with slope 1e4 over that with 1e5".to_owned(),
            large / small,
        ),
        (
            "mean lag, slope 1e4, over that of even friction".to_owned(),
            large / even,
        ),
    ])
}

/// The ratio of speeds tends to the inverse ratio of radii.
pub(super) fn figure_3_21() -> Result<Quantities, CaseError> {
    let run = run(FIGURE_3_21, &[])?;
    let last = [1.2, 1.5];
    let ratio = run.mean("driven.speed", last)? / run.mean("driver.speed", last)?;
    Ok(vec![(
        "driven over driver, mean of the last 0.3 s".to_owned(),
        ratio,
    )])
}

/// Half period and decay against the linear model of the theory manual.
pub(super) fn ring_downs() -> Result<Quantities, CaseError> {
    let mut quantities = Quantities::new();
    for (belt, text, (window, apart)) in [
        ("E = 1e8", FIGURE_3_7, COMPLIANT),
        ("E = 1e9", FIGURE_3_8, STIFF),
    ] {
        let run = run(text, &[CONVERGED])?;
        let (half_period, decay) = ring_down(&run, window, apart)?;
        let (start, layout) = (run.outcome.start, &run.outcome.layout);
        let root = RingDown::new(&run.drive, start.tension, layout)
            .and_then(|model| model.root(-decay, PI / half_period))
            .ok_or(CaseError::DoesNotRun)?;
        quantities.extend([
            (format!("half period, {belt}"), half_period),
            (format!("decay, {belt}"), decay),
            (
                format!("half period over the linear model's, {belt}"),
                half_period * root.im / PI,
            ),
            (
                format!("decay over the linear model's, {belt}"),
                -decay / root.re,
            ),
        ]);
    }
    Ok(quantities)
}
