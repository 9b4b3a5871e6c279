//! A serpentine of five pulleys (`examples/serpentine.toml`) in steady means: balances, kinematics, and what it costs.

use hihna::simulate::{Flow, Outcome, simulate};

const SERPENTINE: &str = include_str!("../../../examples/serpentine.toml");
const NAMES: [&str; 5] = ["crank", "compressor", "generator", "idler", "pump"];
const RADII: [f64; 5] = [0.075, 0.055, 0.030, 0.035, 0.060];
const IDLER: usize = 3;
/// Long after the last change of speed and load, at 0.25 s.
const STEADY: [f64; 2] = [0.6, 0.8];

fn mean(outcome: &Outcome, column: &str) -> f64 {
    let [from, to] = STEADY;
    let mean = outcome.history.mean(column, from, to);
    mean.unwrap_or_else(|| panic!("no column {column}"))
}

/// The span that leaves pulley `p`.
fn span(p: usize) -> String {
    format!("{}-{}", NAMES[p], NAMES[(p + 1) % 5])
}

#[test]
fn a_serpentine_balances() {
    let overrides = ["run.end_time=0.8".parse().expect("an override")];
    let drive = hihna::input::parse("serpentine.toml", SERPENTINE, &overrides).expect("a drive");
    let outcome = simulate(&drive, &mut |_| Flow::Continue).expect("the drive runs");
    assert!(outcome.audit.passed(), "{:?}", outcome.audit);

    // Torques are the differences of the spans' tensions times the radius: on the crank within the 0.3 mm of 75 by
    // which the belt sinks in, twice. On small pulleys bending and seating of the belt take their part, 2 % of the
    // generator's torque with 120 elements as with 240, and with 60 the means of short spans err by another 3 % of
    // the differences.
    for p in 0..5 {
        let tension = |p: usize| mean(&outcome, &format!("{}.tension", span(p)));
        let sense = if p == IDLER { -1.0 } else { 1.0 };
        // Counter-clockwise the belt pulls with the span that leaves the pulley.
        let expected = sense * (tension(p) - tension((p + 4) % 5)) * RADII[p];
        let torque = mean(&outcome, &format!("{}.torque", NAMES[p]));
        let part = if p == 0 { 0.01 } else { 0.05 };
        assert!(
            (torque - expected).abs() < part * torque.abs().max(1.0),
            "{}: {torque} N m, of the tensions {expected}",
            NAMES[p],
        );
    }

    // An idler without load creeps on its own strains only, and turns the other way.
    let speed = -mean(&outcome, "idler.speed") * RADII[IDLER];
    let belt = mean(&outcome, &format!("{}.speed", span(IDLER)));
    assert!((speed / belt - 1.0).abs() < 2.0e-3, "{speed} {belt}");
}

/// Contact comes and goes twice a step here: the nonlinear solver must not spend itself on factors that no longer
/// fit. A tangent with its factor costs as much as five evaluations; the limit leaves a quarter more than the 7.5 that
/// it takes.
#[test]
fn a_step_needs_few_evaluations() {
    let overrides = ["run.end_time=0.3".parse().expect("an override")];
    let drive = hihna::input::parse("serpentine.toml", SERPENTINE, &overrides).expect("a drive");
    let outcome = simulate(&drive, &mut |_| Flow::Continue).expect("the drive runs");
    let cost = outcome.statistics;
    let steps = (cost.steps + cost.halved_steps) as f64;
    let evaluations = (cost.force_evaluations + 5 * cost.tangent_evaluations) as f64 / steps;
    assert!(evaluations < 9.4, "{evaluations} evaluations a step");
}
