//! Steady running solved directly against the means of the time run, both on 60 equal elements.
//!
//! The elements of a time run pass the places where the belt runs on and off, those of the direct solution stay: its mean over
//! four phases of the mesh is what the mean in time is compared with. They are equal within the standard deviation of the time run, or
//! within what the phase of the mesh changes in the direct solution, half of its range: that decides where the scatter is a millionth
//! of the speed, as with the gentle slope at 120 rad/s. Speeds that are prescribed are equal to rounding.

use hihna::drive::Drive;
use hihna::layout::Layout;
use hihna::simulate::{Flow, simulate};
use hihna::steady::running::{Answer, Running, solve};
use hihna::summary::Summary;

const BASE: &str = include_str!("../../../examples/two_pulley.toml");
const LOADED: &str = include_str!("../../../examples/figures_3_10_to_3_20.toml");
const ELEMENTS: [&str; 2] = ["belt.elements=60", "steady.mesh=uniform"];
const PHASES: usize = 4;

fn drive(text: &str, changes: &[&str]) -> Drive {
    let overrides: Vec<_> = (ELEMENTS.iter().chain(changes))
        .map(|change| change.parse().expect("an override"))
        .collect();
    hihna::input::parse("drive.toml", text, &overrides).expect("a valid drive")
}

fn at_phase(drive: &Drive, path: f64, phase: usize) -> Running {
    let mut shifted = drive.clone();
    shifted.belt.first_node = path / drive.belt.elements as f64 * phase as f64 / PHASES as f64;
    match solve(&shifted).expect("it is solved").answer {
        Answer::Running(running) => *running,
        other => panic!("{other:?}"),
    }
}

fn assert_equal(text: &str, changes: &[&str]) {
    let drive = drive(text, changes);
    let outcome = simulate(&drive, &mut |_| Flow::Continue).expect("the drive runs");
    let run = Summary::new(&drive, &outcome);
    let path = Layout::of(&drive).expect("a path").length;
    let found: Vec<_> = (0..PHASES).map(|k| at_phase(&drive, path, k)).collect();
    let near = |name: &str, mean_in_time: f64, scatter: f64, what: &dyn Fn(&Running) -> f64| {
        let values: Vec<f64> = found.iter().map(what).collect();
        let mean = values.iter().sum::<f64>() / PHASES as f64;
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (off, phase) = ((mean - mean_in_time).abs(), 0.5 * (most - least));
        assert!(
            off <= scatter.max(phase).max(1.0e-12 * mean.abs()),
            "{changes:?}: {name} off by {off:.1e}, scatter {scatter:.1e}, by phase {phase:.1e}"
        );
    };
    for (p, (name, in_time)) in run.steady.pulley.0.iter().enumerate() {
        let scatter = run.scatter.pulley.0[p].1.speed;
        near(name, in_time.speed, scatter, &|running| {
            running.pulleys[p].speed
        });
    }
    for (s, (name, in_time)) in run.steady.span.0.iter().enumerate() {
        let scatter = run.scatter.span.0[s].1.tension;
        near(name, in_time.tension, scatter, &|running| {
            running.spans[s].tension
        });
    }
}

#[test]
fn base() {
    assert_equal(BASE, &[]);
}

#[test]
fn base_under_load() {
    assert_equal(
        BASE,
        &[
            "pulley.driven.torque={kind=\"half-cosine\", from=0.0, to=-1.0, start=0.05, end=0.6}",
            "contact.friction.coefficient=0.3",
            "run.end_time=2.0",
        ],
    );
}

#[test]
fn loaded_at_high_speed() {
    assert_equal(LOADED, &[]);
    assert_equal(LOADED, &["contact.friction.slope=1e4"]);
}

#[test]
fn three_pulleys() {
    assert_equal(include_str!("../../../examples/three_pulleys.toml"), &[]);
}

#[test]
fn unequal_radii() {
    assert_equal(include_str!("../../../examples/figure_3_21.toml"), &[]);
}

/// Bristles that are transported through the mesh and those that travel with the belt's points are bent by the same.
#[test]
fn on_bristles() {
    assert_equal(
        BASE,
        &[
            "pulley.driven.torque={kind=\"half-cosine\", from=0.0, to=-1.0, start=0.05, end=0.6}",
            "contact.friction={law=\"elastic-plastic\", coefficient=0.3, stiffness=1e7, damping=1e2}",
            "run.end_time=3.0",
        ],
    );
}
