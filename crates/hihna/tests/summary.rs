//! What the summary of a run says: over which times its means are, what puts power in, and what it warns of.

use std::f64::consts::PI;

use hihna::assemble::{Mounting, Rest, Warning, short_arcs};
use hihna::drive::Drive;
use hihna::layout::Layout;
use hihna::simulate::{Flow, simulate};
use hihna::steady::running::solve;
use hihna::steady::running::summary::RunningSummary;
use hihna::summary::Summary;

const BASE: &str = include_str!("../../../examples/two_pulley.toml");

fn drive(text: &str, changes: &[&str]) -> Drive {
    let changes: Vec<_> = (changes.iter())
        .map(|change| change.parse().expect("an override"))
        .collect();
    hihna::input::parse("drive.toml", text, &changes).expect("a valid drive")
}

fn run(changes: &[&str]) -> Summary {
    let drive = drive(BASE, changes);
    let outcome = simulate(&drive, &mut |_| Flow::Continue).expect("the drive runs");
    Summary::new(&drive, &outcome)
}

/// The command of the guide on cranks: order 2 of 12 rad/s is a period of pi/12 s, of which one fits behind the ramp's end at 0.6 s.
/// Over it the driver turns at its mean speed, which a tenth of the run, 0.4 periods, misses by up to 3 %. What is left is
/// interpolation between rows at one end, `A w (2 w dt)²/8 dt/T`, 1e-7 rad/s.
#[test]
fn means_are_over_whole_periods() {
    let uneven = "pulley.driver.irregularity=[{ order = 2, amplitude = 0.03 }, { order = 4, amplitude = 0.01 }]";
    let summary = run(&[uneven, "run.end_time=1"]);
    let averaged = summary.averaged;
    assert_eq!(averaged.periods, Some(1));
    assert!((averaged.to - averaged.from - PI / 12.0).abs() < 1.0e-12);
    let mean = summary.steady.pulley.0[0].1.speed;
    assert!((mean - 12.0).abs() < 1.0e-6, "{mean} rad/s");
    // On the ramp nothing repeats.
    let summary = run(&[uneven, "run.end_time=0.4"]);
    assert_eq!(summary.averaged.periods, None);
    assert!((summary.averaged.from - 0.36).abs() < 1.0e-12);
}

/// A torque with the motion puts power in, and the driver, which holds it back, takes it out: in a run that has settled as in steady
/// running. Both aim at 1e-3 of speeds and torques.
#[test]
fn power_is_put_in_by_what_acts_with_the_motion() {
    let changes = [
        "pulley.driven.torque=1.0",
        "belt.elements=40",
        "run.until=steady",
        "run.end_time=10",
    ];
    let timed = run(&changes).steady;
    let drive = drive(BASE, &changes);
    let found = RunningSummary::new(&drive, &solve(&drive).expect("it is solved"));
    let steady = found.steady.expect("it runs");
    for (timed, steady) in [
        (timed.power_in, steady.power_in),
        (timed.power_out, steady.power_out),
    ] {
        assert!(steady > 11.0, "{steady} W");
        assert!(
            (timed / steady - 1.0).abs() < 2.0e-3,
            "{timed} W, {steady} W"
        );
    }
}

/// Whoever pulls a hub away from a belt at rest puts power in: the rate of `energy.input`. Rows of a millisecond interpolate a power
/// that grows evenly.
#[test]
fn power_is_put_in_by_what_moves_a_hub() {
    let pulled = "pulley.driven.displacement={ x = { kind = \"ramp\", from = 0.0, to = 0.002, start = 0.0, end = 0.4 } }";
    let changes = [pulled, "pulley.driver.speed=0.0", "run.end_time=0.2"];
    let drive = drive(BASE, &changes);
    let outcome = simulate(&drive, &mut |_| Flow::Continue).expect("the drive runs");
    let summary = Summary::new(&drive, &outcome);
    let rate = |what: &str| {
        let name = format!("energy.{what}");
        outcome.history.mean_rate(&name, 0.18, 0.2).expect("rows")
    };
    let net = rate("input") + rate("load_work");
    let steady = &summary.steady;
    assert!(steady.power_in > 0.3, "{} W", steady.power_in);
    let apart = steady.power_in - steady.power_out - net;
    assert!(apart.abs() < 1.0e-3 * net, "{apart} of {net} W");
}

/// A small driver that its load holds slips on all of its arc: it is named, with what friction carries there; the driven pulley, which
/// sticks, is not, though it is the one that loses speed.
#[test]
fn a_driver_that_slips_is_told() {
    let summary = run(&[
        "pulley.driver.radius=0.03",
        "belt.tension=30",
        "pulley.driven.load={law=\"viscous\",torque=6,speed=\"30 rpm\"}",
        "contact.friction.coefficient=0.3",
    ]);
    assert!(summary.steady.pulley.0[1].1.speed_loss > 0.5);
    let told = summary.warnings.join("\n");
    assert!(told.contains("slips on pulley `driver`"), "{told}");
    assert!(told.contains("friction carries no more than"), "{told}");
    assert!(!told.contains("slips on pulley `driven`"), "{told}");
}

/// Where a driver's friction of a thousandth does not set a driven pulley in motion, on which no torque acts, no torque is to
/// blame: friction carries `mu T pi R` of the 26.6 N at rest.
#[test]
fn a_belt_without_grip_is_told() {
    let summary = run(&["contact.friction.coefficient=0.001", "run.end_time=0.8"]);
    let told = summary.warnings.join("\n");
    assert!(told.contains("slips on pulley `driver`"), "{told}");
    assert!(
        told.contains("friction carries no more than 6.790 mN m"),
        "{told}"
    );
}

/// Belts whose contact is softer and softer: the estimate `T = T_0/(1 + s)` is that of a first-order change of the path,
/// right to the depth by the radius, to the 1e-2 by which twenty elements miss the arcs' chords and to `E I/R² = 0.13 N`, by which bending
/// tightens a belt. `s` is 0.06 for 1e7 N/m2 and goes with its inverse; from 1 on the warning comes, with the tensions and what would do.
#[test]
fn a_soft_contact_is_told() {
    for (stiffness, soft) in [("1e7", false), ("1e6", false), ("1e5", true)] {
        let changes = [
            &*format!("contact.stiffness={stiffness}"),
            "run.end_time=0.002",
        ];
        let summary = run(&changes);
        let drive = drive(BASE, &changes);
        let layout = Layout::of(&drive).expect("a path");
        let mounting = Mounting::new(&drive, &layout).expect("it fits");
        let rest = Rest::estimate(&drive, &layout, &mounting).expect("no grooves");
        let start = summary.start;
        let allowed = (0.01 + start.penetration / 0.08125) * start.tension + 0.13;
        assert!(
            (rest.tension - start.tension).abs() < allowed,
            "{rest:?} {start:?}"
        );
        let estimated = rest.soft_contact(&drive, &layout, &mounting);
        assert_eq!(estimated.is_some(), soft, "{stiffness}");
        let told = summary.warnings.join("\n");
        assert_eq!(told.contains("the contact is soft"), soft, "{told}");
        if soft {
            for part in [
                "28.19 N on rigid pulleys",
                "raise `contact.stiffness`: 5.5e6 N/m2",
            ] {
                assert!(told.contains(part), "{told}");
            }
        }
    }
    let soft = drive(BASE, &["contact.stiffness=1e5"]);
    let found = RunningSummary::new(&soft, &solve(&soft).expect("it is solved"));
    let told = found.warnings.join("\n");
    assert!(told.contains("the contact is soft"), "{told}");
    // Deep in a belt that pushes rather than pulls.
    let told = run(&["contact.stiffness=1", "run.end_time=0.0011"])
        .warnings
        .join("\n");
    assert!(told.contains("the contact is soft"), "{told}");
}

/// Drives of the dissertation, which lose up to 37 % of their tension, and all other examples are stiff enough, and no pulley of theirs
/// is skipped by an element.
#[test]
fn the_examples_are_stiff_and_fine_enough() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).expect("the examples") {
        let path = entry.expect("an entry").path();
        let drive = hihna::input::load(&path, &[]).expect("a drive");
        let layout = Layout::of(&drive).expect("a path");
        let mounting = Mounting::new(&drive, &layout).expect("it fits");
        let soft = Rest::estimate(&drive, &layout, &mounting)
            .and_then(|rest| rest.soft_contact(&drive, &layout, &mounting));
        assert_eq!(soft, None, "{}", path.display());
        let short = short_arcs(&drive, &layout, &mounting);
        assert!(short.is_empty(), "{}: {short:?}", path.display());
        count += 1;
    }
    assert!(count > 10);
}

/// An idler that presses the belt in by 10 mm, on an arc of 5 mm: of 60 elements none lies on it; as many as the warning asks
/// for do.
#[test]
fn an_idler_shorter_than_an_element_is_told() {
    let idler = "[[pulley]]\nname = \"idler\"\ncenter = [0.0, 0.12125]\nradius = 0.05\nwrap = \"outside\"\ninertia = 0.01\n\n[run]";
    let text = BASE
        .replace("[run]", idler)
        .replace("length = \"1.2727 m\"", "tension = 50");
    let shorts = |elements: usize| {
        let drive = drive(&text, &[&format!("belt.elements={elements}")]);
        let layout = Layout::of(&drive).expect("a path");
        let mounting = Mounting::new(&drive, &layout).expect("it fits");
        short_arcs(&drive, &layout, &mounting)
    };
    let told = shorts(60);
    assert_eq!(told.len(), 1, "{told:?}");
    let Warning::ShortArc { elements, .. } = &told[0] else {
        panic!("{told:?}");
    };
    let words = told[0].to_string();
    assert!(
        words.contains("less than an element lies on pulley `idler`"),
        "{words}"
    );
    assert!(shorts(*elements).is_empty() && shorts(elements - 1).len() == 1);
}
