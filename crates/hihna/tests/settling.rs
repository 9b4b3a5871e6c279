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
    let mut spread = [0.0; 3];
    for (spread, count) in spread.iter_mut().zip([30, 60, 120]) {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        let elements = format!("belt.elements={count}");
        for eighth in 0..8 {
            // The length of the path over the elements.
            let first = 1.2761 / f64::from(count) * f64::from(eighth) / 8.0;
            let first = format!("belt.first_node={first}");
            let outcome = settle(BASE, &[&elements, &first]);
            assert!(outcome.start.iterations <= 20, "{elements}, {first}");
            let tension = outcome.start.tension;
            range = [range[0].min(tension), range[1].max(tension)];
        }
        *spread = range[1] - range[0];
    }
    // What the phase of the mesh does to the tension is an error of the mesh: it falls at the first order at least.
    let [coarse, middle, fine] = spread;
    assert!(middle < 0.5 * coarse && fine < 0.5 * middle, "{spread:?}");
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
