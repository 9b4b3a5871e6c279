//! Belts settle on their pulleys wherever their nodes lie and whatever the elements are.
//!
//! Newton's method on frictionless pulleys ends in a dozen iterations; twenty leave room for other round-off.
//! A belt that could slide along itself would take hundreds, along a potential that the places of the contact points
//! make, or balance on top of it.

use hihna::simulate::{Flow, Outcome, simulate};

const BASE: &str = include_str!("../../../examples/two_pulley.toml");
const PLATE: &str = include_str!("../../../examples/plate_model_1.toml");
const AT_ONCE: [&str; 2] = ["run.end_time=1e-6", "run.output_interval=1e-6"];

fn settle(drive: &str, changes: &[&str]) -> Outcome {
    let overrides: Vec<_> = (changes.iter().chain(&AT_ONCE))
        .map(|change| change.parse().expect("an override"))
        .collect();
    let drive = hihna::input::parse("drive.toml", drive, &overrides).expect("a drive");
    simulate(&drive, &mut |_| Flow::Continue).unwrap_or_else(|error| panic!("{changes:?}: {error}"))
}

#[test]
fn a_belt_settles_wherever_its_nodes_lie() {
    for eighth in 0..8 {
        // Path over elements is 0.02127 m.
        let first = format!("belt.first_node={}", 0.02127 * f64::from(eighth) / 8.0);
        let outcome = settle(BASE, &["belt.elements=60", &first]);
        assert!(outcome.start.iterations <= 20, "{first}");
        // 26.62 N with 20 elements, 26.59 N with 60: the phase of the finer mesh matters less than that.
        let tension = outcome.start.tension;
        assert!((tension - 26.59).abs() < 0.03, "{first}: {tension} N");
    }
}

#[test]
fn belts_of_linear_beams_settle_on_nodes() {
    for count in [
        "belt.elements=190",
        "belt.elements=200",
        "belt.elements=210",
    ] {
        let nodes = [
            "belt.element=\"linear-beam\"",
            "contact.integration=\"trapezoidal\"",
            "contact.points=2",
            count,
        ];
        assert!(settle(BASE, &nodes).start.iterations <= 20, "{count}");
    }
}

/// The driver of Model 1 moves from time zero on; a belt at rest must not feel its speed.
#[test]
fn a_belt_settles_on_hubs_at_rest() {
    for points in ["contact.points=9", "contact.points=17"] {
        assert!(settle(PLATE, &[points]).start.iterations <= 20, "{points}");
    }
}
