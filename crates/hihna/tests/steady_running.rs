//! Steady running of the finite elements, solved directly.

use ancf::element::BeltBeam2;
use hihna::drive::Drive;
use hihna::input::NumberField;
use hihna::steady::drive_string::DriveString;
use hihna::steady::running::campbell::campbell;
use hihna::steady::running::map::{Axis, map};
use hihna::steady::running::summary::RunningSummary;
use hihna::steady::running::{
    Answer, Found, Most, Obstacle, Outcome, Running, RunningBelt, RunningError, force_and_moment,
    solve,
};
use hihna::steady::string::{self, Closure, Model};

const BASE: &str = include_str!("../../../examples/two_pulley.toml");
const THREE: &str = include_str!("../../../examples/three_pulleys.toml");
const IDLER: &str = include_str!("../../../examples/back_side_idler.toml");
const UNEQUAL: &str = include_str!("../../../examples/figure_3_21.toml");
const STRING: &str = include_str!("../../../examples/towards_the_string.toml");
const LOAD: &str = "pulley.driven.torque=-1";
const LOW_FRICTION: &str = "contact.friction.coefficient=0.3";
const LOADED: &str = include_str!("../../../examples/figures_3_10_to_3_20.toml");

fn drive(text: &str, changes: &[&str]) -> Drive {
    let overrides: Vec<_> = (changes.iter())
        .map(|change| change.parse().expect("an override"))
        .collect();
    hihna::input::parse("drive.toml", text, &overrides).expect("a valid drive")
}

fn outcome(text: &str, changes: &[&str]) -> Outcome {
    solve(&drive(text, changes)).unwrap_or_else(|error| panic!("{changes:?}: {error}"))
}

fn running(text: &str, changes: &[&str]) -> Running {
    match outcome(text, changes).answer {
        Answer::Running(running) => *running,
        other => panic!("{changes:?}: {other:?}"),
    }
}

/// What a drive that cannot run is told.
fn refusal(text: &str, changes: &[&str]) -> String {
    match solve(&drive(text, changes)) {
        Err(error) => error.to_string(),
        Ok(outcome) => panic!("{changes:?}: {:?}", outcome.answer),
    }
}

fn assert_near(name: &str, found: f64, wanted: f64, tolerance: f64) {
    assert!(
        (found - wanted).abs() <= tolerance,
        "{name}: {found}, not {wanted} within {tolerance:e}"
    );
}

/// Speeds, tensions and driver's torque of an independent implementation of the same equations (another contact
/// quadrature, dual numbers for the tangent): one unit of the last digit given.
#[test]
fn orientation_values() {
    let loaded = running(LOADED, &["belt.elements=120", "pulley.driven.torque=-10"]);
    assert_near("speed", loaded.pulleys[1].speed, 119.8322, 1.0e-4);
    assert_near("slack", loaded.spans[0].tension, 1545.75, 0.01);
    assert_near("tight", loaded.spans[1].tension, 1673.63, 0.01);
    assert_near("torque", loaded.pulleys[0].external_torque, 10.309, 1.0e-3);
    let base = running(BASE, &["belt.elements=120", LOAD, LOW_FRICTION]);
    assert_near("speed", base.pulleys[1].speed, 11.98242, 1.0e-5);
    assert_near("slack", base.spans[0].tension, 20.638, 1.0e-3);
    assert_near("tight", base.spans[1].tension, 32.951, 1.0e-3);
}

/// Hub forces and torques sum to nothing: uniform translations and rotations are motions that the elements can make, so that
/// their balance holds to the convergence of Newton's method, whatever the mesh. Round-off of 1e-12 m in contact stiffnesses of 1e6 N/m
/// is 1e-6 N at most, 1e-8 of the forces.
#[test]
fn laws_of_momentum() {
    for (text, changes) in [
        (BASE, &["belt.elements=20", LOAD, LOW_FRICTION][..]),
        (LOADED, &["belt.elements=30"]),
        (THREE, &["belt.elements=40"]),
        (IDLER, &["belt.elements=60"]),
        (BASE, &["belt.elements=30", LOAD, "belt.element=cubic-beam"]),
        (
            BASE,
            &["belt.elements=60", LOAD, "belt.element=linear-beam"],
        ),
        (BASE, &["belt.elements=30", LOAD, "contact.surface=face"]),
        (
            BASE,
            &[
                "belt.elements=30",
                "pulley.driven.torque=1",
                "pulley.driven.wrap=outside",
                "belt.length=1.24",
            ],
        ),
    ] {
        let drive = drive(text, changes);
        let found = running(text, changes);
        let centers: Vec<_> = drive.pulley.iter().map(|p| p.center).collect();
        let ([fx, fy], moment) = force_and_moment(&found, &centers);
        let scale: f64 = (found.pulleys.iter())
            .map(|p| p.hub_force[0].hypot(p.hub_force[1]))
            .sum();
        assert!(
            fx.hypot(fy) < 1.0e-8 * scale,
            "{changes:?}: {fx} {fy} N of {scale}"
        );
        assert!(moment.abs() < 1.0e-8 * scale, "{changes:?}: {moment} N m");
    }
}

/// The weight of the belt hangs on the hubs.
#[test]
fn gravity_is_carried_by_the_hubs() {
    let found = running(BASE, &["belt.elements=30", LOAD, "gravity=[0, -9.81]"]);
    let ([fx, fy], _) = force_and_moment(&found, &[[0.0; 2]; 2]);
    let weight = 1036.0 * 1.0e-4 * 1.2727 * 9.81;
    assert_near("across", fx, 0.0, 1.0e-8);
    assert_near("down", fy, -weight, 1.0e-8);
}

/// The drive and its mirror image, which runs the other way: to the convergence of Newton's method.
#[test]
fn mirrored_drive() {
    let changes = ["belt.elements=60", LOAD, LOW_FRICTION];
    let one = running(BASE, &changes);
    let mirrored = [
        "belt.elements=60",
        "pulley.driven.torque=1",
        "pulley.driver.speed=-12",
        LOW_FRICTION,
    ];
    let other = running(BASE, &mirrored);
    for p in 0..2 {
        assert_near(
            "speed",
            other.pulleys[p].speed,
            -one.pulleys[p].speed,
            1.2e-8,
        );
        let (a, b) = (one.pulleys[p].hub_force, other.pulleys[p].hub_force);
        assert_near("hub x", b[0], a[0], 1.0e-9 * a[0].abs());
        assert_near("hub y", b[1], -a[1], 1.0e-9 * a[0].abs());
    }
    for (a, b) in [(0, 1), (1, 0)] {
        let (a, b) = (one.spans[a].tension, other.spans[b].tension);
        assert_near("tension", b, a, 1.0e-9 * a);
    }
}

/// From a belt that does not slip straight to any speed and torque.
#[test]
fn few_iterations() {
    for (text, changes) in [
        (BASE, &["belt.elements=60"][..]),
        (BASE, &["belt.elements=60", LOAD, LOW_FRICTION]),
        (BASE, &["belt.elements=60", LOAD, "contact.damping=1000"]),
        (LOADED, &["belt.elements=60"]),
        (LOADED, &["belt.elements=60", "contact.friction.slope=1e4"]),
        (THREE, &["belt.elements=60"]),
        (IDLER, &["belt.elements=60"]),
        (UNEQUAL, &["belt.elements=60"]),
    ] {
        let found = running(text, changes);
        assert_eq!(found.found, Found::Directly, "{changes:?}");
        assert!(found.iterations <= 8, "{changes:?}: {}", found.iterations);
    }
}

/// The power residual is what the elements do not resolve: below 1e-3 with 60 of them, and falling with their number.
#[test]
fn powers_balance() {
    let residual = |text: &str, n: usize, more: &[&str]| {
        let n = format!("belt.elements={n}");
        running(text, &[&[n.as_str()], more].concat())
            .power_residual
            .abs()
    };
    for (text, more) in [(LOADED, &[][..]), (BASE, &[LOAD, LOW_FRICTION])] {
        let [coarse, middle, fine] = [30, 60, 120].map(|n| residual(text, n, more));
        assert!(
            middle < 1.0e-3 && middle < coarse && fine < middle.max(1.0e-5),
            "{coarse:e} {middle:e} {fine:e}"
        );
    }
}

/// The slopes across the section are linear along an element: a face that touches, and the thickness strain of the cubic beam, jump in their
/// derivatives from element to element, and `c R'` with them. Less is resolved than on the centre line of belt beams, but the balance closes
/// with the mesh, at an order of 1.5 at least.
#[test]
fn powers_balance_in_the_limit() {
    for (change, few, many) in [
        ("contact.surface=face", 60, 480),
        ("belt.element=cubic-beam", 60, 240),
    ] {
        let residual = |n: usize| {
            let n = format!("belt.elements={n}");
            let found = running(BASE, &[&n, LOAD, LOW_FRICTION, change]);
            found.power_residual.abs()
        };
        let (coarse, fine) = (residual(few), residual(many));
        let order = (coarse / fine).ln() / (many as f64 / few as f64).ln();
        assert!(order > 1.5, "{change}: {coarse:e} {fine:e}");
    }
}

/// 30 graded elements find what 80 equal ones do, as 480 graded ones say: tensions and speed loss, with half as much again; below 0.1 %, to
/// which speed losses are compared with the string's, neither matters.
#[test]
fn grading() {
    let low = [LOAD, LOW_FRICTION];
    let loaded = ["pulley.driven.torque=-10"];
    let found = |text: &str, changes: &[&str], n: usize, mesh: &str| {
        let (n, mesh) = (format!("belt.elements={n}"), format!("steady.mesh={mesh}"));
        let found = running(text, &[&[n.as_str(), &mesh], changes].concat());
        let loss = 1.0 - found.pulleys[1].speed / found.pulleys[0].speed;
        [found.spans[0].tension, found.spans[1].tension, loss]
    };
    for (text, changes) in [(BASE, &[LOAD][..]), (BASE, &low), (LOADED, &loaded)] {
        let exact = found(text, changes, 480, "graded");
        let many = found(text, changes, 80, "uniform");
        let few = found(text, changes, 30, "graded");
        for what in 0..3 {
            let [few, many] = [few, many].map(|found| (found[what] / exact[what] - 1.0).abs());
            assert!(
                few < (1.5 * many).max(1.0e-3),
                "{changes:?}, {what}: {few:e} {many:e}"
            );
        }
    }
}

/// In the limit the extensible string: thin belt, stiff pulleys, steep creep, to 0.1 % of the speed and 0.5 % of the tensions. Bending
/// of length `sqrt(E I / T)` at four points lengthens the path by micrometres, which the stiff belt feels in its tension: less of it
/// than in the example. The creep layers are short, so that it takes many elements.
#[test]
fn string_limit() {
    let changes = [
        "belt.damping_time=0",
        "belt.elements=480",
        "belt.bending_factor=1e-4",
        "contact.friction.slope=1e6",
    ];
    let drive = drive(STRING, &changes);
    let found = running(STRING, &changes);
    let string = DriveString::new(&drive, Model::Full, Closure::UnstretchedLength)
        .expect("a drive for the string");
    let Ok(string::Answer::Running(theory)) = string.solve() else {
        panic!("the string does not run");
    };
    for (pulley, state) in string.pulleys(&theory).iter().zip(&found.pulleys) {
        assert_near(
            &pulley.name,
            state.speed,
            pulley.speed,
            1.0e-3 * pulley.speed,
        );
    }
    for (span, state) in string.spans(&theory).iter().zip(&found.spans) {
        assert_near(
            &span.name,
            state.tension,
            span.tension,
            5.0e-3 * span.tension,
        );
    }
}

/// Beyond the capacity there is no steady running, and the answer says by how much. The capacity is the same from below and
/// from above; with equal pulleys Euler's formula, with what the belt needs for its own motion taken off, gives it within the effect of
/// the penetration and the bending, a few percent.
#[test]
fn gross_slip() {
    let near = |torque: &str| outcome(BASE, &["belt.elements=60", torque, LOW_FRICTION]);
    let below = near("pulley.driven.torque=-1.9").capacity;
    let Some(Most::Known(below)) = below else {
        panic!("{below:?}");
    };
    let carried = -1.9 * below.factor;
    let Answer::GrossSlip(slip) = near("pulley.driven.torque=-3").answer else {
        panic!("it runs");
    };
    // Both searches end where the load rises by less than 1e-4 while the slip doubles.
    assert_near(
        "capacity",
        slip.capacity.torques[1],
        carried,
        1.0e-3 * carried.abs(),
    );
    assert_near("overload", slip.overload(), -3.0 / carried, 2.0e-3);
    let exhausted = near(&format!("pulley.driven.torque={}", 0.999 * carried));
    let Answer::Running(found) = &exhausted.answer else {
        panic!("{:?}", exhausted.answer);
    };
    let v = found.spans[0].speed.abs();
    let centrifugal = 1036.0 * 1.0e-4 * v * v;
    let ratio = (found.spans[1].tension - centrifugal) / (found.spans[0].tension - centrifugal);
    let euler = (0.3 * std::f64::consts::PI).exp();
    assert_near("tension ratio", ratio, euler, 0.03 * euler);
}

/// The capacity does not depend on the state in which the search for it begins. At 60 rad/s the load goes on rising with the slip when all of
/// the driver slides: the belt slows down and presses more. That is gross slip.
#[test]
fn capacity_from_anywhere() {
    let at = |torque: &str| {
        let torque = format!("pulley.driven.torque={torque}");
        outcome(
            BASE,
            &["belt.elements=60", "pulley.driver.speed=60", &torque],
        )
    };
    let most = |torque: &str| {
        let capacity = at(torque).capacity;
        let Some(Most::Known(capacity)) = capacity else {
            panic!("{torque}: {capacity:?}");
        };
        capacity.torques[1]
    };
    let usual = most("-1");
    for torque in ["-0.2", "-3", "-5"] {
        // 98 % of an arc that slides are gross slip; the steps towards it differ.
        assert_near(torque, most(torque), usual, 1.0e-2 * usual.abs());
    }
    let Answer::GrossSlip(slip) = at("-5.6").answer else {
        panic!("it runs");
    };
    assert_near("overload", slip.overload(), 5.6 / usual.abs(), 2.0e-2);
}

/// A fan asks for less the slower it turns, so that the drive finds a state in which the driver slides as a whole. That is no running.
#[test]
fn sliding_is_gross_slip() {
    let with = |torque: &str| {
        let load = format!("pulley.driven.load={{law=\"fan\", torque={torque}, speed=12}}");
        outcome(BASE, &["belt.elements=60", LOW_FRICTION, &load]).answer
    };
    assert!(matches!(with("1.9"), Answer::Running(_)));
    let Answer::GrossSlip(slip) = with("4") else {
        panic!("it runs");
    };
    assert!(slip.overload() > 1.0);
    // Bristles grip as other laws do. What the drive carries more of as slip slows the fan down is not its capacity.
    let bristles = "contact.friction={law=\"elastic-plastic\", coefficient=0.3, stiffness=1e6}";
    for torque in ["1", "1.9"] {
        let load = format!("pulley.driven.load={{law=\"fan\", torque={torque}, speed=12}}");
        let [usual, most] = [LOW_FRICTION, bristles].map(|law| {
            let capacity = outcome(BASE, &["belt.elements=60", law, &load]).capacity;
            let Some(Most::Known(capacity)) = capacity else {
                panic!("{torque}: {capacity:?}");
            };
            -capacity.torques[1]
        });
        assert_near(torque, most, usual, 0.01 * usual);
    }
}

/// Friction that falls with the slip carries most at some slip, which the search has to find between its steps, wherever it begins.
#[test]
fn capacity_of_falling_friction() {
    let law = "contact.friction={law=\"stribeck\", static_coefficient=0.4, sliding_coefficient=0.1, stribeck_velocity=2e-3, velocity=1e-4}";
    let most = |torque: f64| {
        let torque = format!("pulley.driven.torque={}", -torque);
        let found = outcome(BASE, &["belt.elements=60", law, &torque]).capacity;
        let Some(Most::Known(capacity)) = found else {
            panic!("{torque}: {found:?}");
        };
        -capacity.torques[1]
    };
    let usual = most(0.5);
    for torque in [0.1, 0.8 * usual, 0.98 * usual] {
        assert_near("capacity", most(torque), usual, 1.0e-3 * usual);
    }
    for (part, runs) in [(0.995, true), (1.005, false)] {
        let torque = format!("pulley.driven.torque={}", -part * usual);
        let answer = outcome(BASE, &["belt.elements=60", law, &torque]).answer;
        assert_eq!(matches!(answer, Answer::Running(_)), runs, "{part}");
    }
}

/// The search goes on until more slip carries no more, however much slip a gentle law or a slow belt needs for that: the capacity is what
/// friction carries, not how fast it comes about. Where it ends before, no capacity is told.
#[test]
fn capacity_needs_enough_slip() {
    let most = |changes: &[&str]| {
        let changes = [&["belt.elements=60", LOAD], changes].concat();
        outcome(BASE, &changes).capacity.expect("torques act")
    };
    let known = |changes: &[&str]| most(changes).known().expect("a capacity").factor;
    let usual = known(&[]);
    for changes in ["contact.friction.slope=1e3", "pulley.driver.speed=0.01"] {
        // 98 % of an arc that slides are gross slip; the steps towards it differ.
        assert_near(changes, known(&[changes]), usual, 1.0e-2 * usual);
    }
    // So steep a law is not solved from every torque; from this one it is, and carries what the others do.
    match most(&["contact.friction.slope=1e8"]) {
        Most::Known(capacity) => assert_near("slope 1e8", capacity.factor, usual, 1.0e-2 * usual),
        Most::AtLeast(factor) => assert!(factor < 1.01 * usual, "slope 1e8: {factor}"),
    }
    // Stiff belts and grips beyond those of belts are hard to follow: what is told holds all the same.
    for hard in [
        "belt.youngs_modulus=2e11",
        "contact.friction.coefficient=10",
    ] {
        let runs = |factor: f64| {
            let torque = format!("pulley.driven.torque={}", -factor);
            let found = solve(&drive(BASE, &["belt.elements=60", hard, &torque]));
            matches!(found.map(|found| found.answer), Ok(Answer::Running(_)))
        };
        match most(&[hard]) {
            Most::Known(capacity) => {
                assert!(runs(0.99 * capacity.factor), "{hard}: {capacity:?}");
                assert!(!runs(1.02 * capacity.factor), "{hard}: {capacity:?}");
            }
            Most::AtLeast(factor) => assert!(runs(0.99 * factor), "{hard}: {factor}"),
        }
    }
}

/// A load that a slow belt cannot hold drags its pulley backwards, and loses more than all of the speed; a torque that drives puts power in,
/// and the driver takes it out.
#[test]
fn signs_of_losses_and_powers() {
    let summary = |changes: &[&str]| {
        let changes = [&["belt.elements=60"], changes].concat();
        let found = RunningSummary::new(&drive(BASE, &changes), &outcome(BASE, &changes));
        found.steady.expect("it runs")
    };
    let dragged = summary(&[LOAD, "pulley.driver.speed=0.01"]);
    let driven = &dragged.pulley.0[1].1.report;
    assert!(driven.speed < 0.0 && dragged.speed_loss > 1.0);
    assert_near(
        "loss",
        dragged.speed_loss,
        1.0 - driven.speed / 0.01,
        1.0e-12,
    );
    assert_eq!(dragged.efficiency, None);
    let pushed = summary(&["pulley.driven.torque=1"]);
    let [driver, driven] = [0, 1].map(|p| pushed.pulley.0[p].1.report.power);
    assert_near("in", pushed.power_in, -driven, 1.0e-9);
    assert_near("out", pushed.power_out, driver, 1.0e-9);
    assert!(pushed.efficiency.expect("power flows") < 1.0);
}

/// A drive without a load puts in next to nothing: what its balance is relative to is said, in the text and in the warning, and so is
/// that of a drive that does.
#[test]
fn a_residual_says_what_it_is_relative_to() {
    let told = |changes: &[&str]| {
        let summary = RunningSummary::new(&drive(BASE, changes), &outcome(BASE, changes));
        let audit = summary.audit.expect("it runs");
        let put_in = summary.steady.expect("it runs").power_in;
        (audit, audit.in_words(put_in), summary.warnings.join("\n"))
    };
    let (audit, words, warnings) = told(&["belt.elements=20", "steady.mesh=uniform"]);
    assert!(
        words.contains("1 % of tension on rigid pulleys times belt speed"),
        "{words}"
    );
    // 28.19 N at 12 rad/s on 81.25 mm are 27.5 W on rigid pulleys.
    assert!((audit.power_scale - 0.275).abs() < 0.002, "{audit:?}");
    assert_eq!(
        audit.passed,
        !warnings.contains("1 % of tension on rigid pulleys"),
        "{warnings}"
    );
    let (_, words, _) = told(&["belt.elements=60", LOAD]);
    assert!(words.ends_with("of the power put in"), "{words}");
}

/// A creep without limit of friction loses `T / (v_s R L)` on each pulley beyond the strain of the belt; the other laws
/// run, too.
#[test]
fn other_laws_and_directions() {
    let coulomb = "contact.friction={law=\"coulomb\", coefficient=0.6, velocity=0.005}";
    let stribeck = "contact.friction={law=\"stribeck\", static_coefficient=0.6, sliding_coefficient=0.6, stribeck_velocity=0.05, velocity=0.005}";
    let with = |law: &str, torque: &str| running(BASE, &["belt.elements=40", torque, law]);
    let (one, other) = (with(coulomb, LOAD), with(stribeck, LOAD));
    // Without a difference of the coefficients the laws are one.
    assert_near(
        "speed",
        one.pulleys[1].speed,
        other.pulleys[1].speed,
        1.0e-8,
    );
    // A pulley that pushes runs faster.
    assert!(with(coulomb, "pulley.driven.torque=1").pulleys[1].speed > 12.0);
    // Loads that depend on the speed are taken at the speed found.
    let fan = running(
        BASE,
        &[
            "belt.elements=40",
            "pulley.driven.load={law=\"fan\", torque=1, speed=12}",
        ],
    );
    let part = fan.pulleys[1].speed / 12.0;
    assert_near(
        "torque",
        fan.pulleys[1].external_torque,
        -part * part,
        1.0e-9,
    );
}

/// What cannot run steadily is told so, with the number that matters.
#[test]
fn refusals() {
    for (changes, part) in [
        (&["pulley.driver.speed=0"][..], "ends with 0 rad/s"),
        (&["belt.damping_time=1e-3"], "`damping_time` of 0.001 s"),
        (
            &["pulley.driver.irregularity=[{order=2, amplitude=0.01}]"],
            "needs an even speed",
        ),
        (&["pulley.driver.angle=1"], "driven by its `angle`"),
        (&["pulley.driver.speed=300"], "centrifugal forces take 61.2"),
        (&["contact.friction.coefficient=0"], "no friction on pulley"),
    ] {
        let told = refusal(BASE, changes);
        assert!(told.contains(part), "{changes:?}: {told}");
    }
}

/// Derivatives by implicit differentiation against central differences of whole solutions on the same parts of the belt. Those
/// have an error of h² (3e-6 with a relative h of 1e-4: a length changed by that changes the tension by a tenth) and of round-off over h.
#[test]
fn derivatives() {
    let changes = [
        "belt.elements=40",
        "pulley.driven.torque=-5",
        "contact.friction.slope=1e4",
    ];
    derivatives_agree(LOADED, &changes, 1.0e-5, 1.0e-6);
}

/// The same with bristles a third of which slide, whose tangent is not exact. Longer steps than 3e-6 of the length meet points that begin to
/// slide; what Newton's method leaves over is 1e-5 of the differences then.
#[test]
fn derivatives_by_bristles() {
    let changes = [
        "belt.elements=60",
        "pulley.driven.torque=-4",
        "contact.friction={law=\"elastic-plastic\", coefficient=1.2, stiffness=1e6}",
    ];
    derivatives_agree(BASE, &changes, 1.0e-6, 1.0e-5);
}

fn derivatives_agree(text: &str, changes: &[&str], step: f64, tolerance: f64) {
    let drive = drive(text, changes);
    let mut belt = RunningBelt::<BeltBeam2>::new(&drive).expect("a drive");
    let solved =
        |belt: &mut RunningBelt<BeltBeam2>, drive: &Drive| match belt.solve().expect("solved") {
            Answer::Running(running) => {
                let found = belt.sensitivity(drive, &running, &[]).expect("results");
                (running, found.outputs)
            }
            other => panic!("{other:?}"),
        };
    let (running, _) = solved(&mut belt, &drive);
    let keys = [
        "belt.youngs_modulus",
        "belt.length",
        "belt.density",
        if text == BASE {
            "contact.friction.stiffness"
        } else {
            "contact.friction.slope"
        },
        "pulley.driver.speed",
        "pulley.driven.torque",
        "pulley.driven.radius",
    ];
    let fields: Vec<_> = (keys.iter())
        .map(|key| NumberField::find(&drive, key).expect("a field"))
        .collect();
    let found = belt
        .sensitivity(&drive, &running, &fields)
        .expect("derivatives");
    for (field, input) in fields.iter().zip(&found.inputs) {
        let h = step * input.value.abs();
        let [up, down] = [h, -h].map(|h| {
            let moved = field.with(&drive, input.value + h).expect("a drive");
            let mut other =
                RunningBelt::<BeltBeam2>::on_mesh(&moved, &belt.starts).expect("a drive");
            solved(&mut other, &moved).1
        });
        for (i, output) in found.outputs.iter().enumerate() {
            let difference = (up[i].value - down[i].value) / (2.0 * h);
            let scale = (output.value / input.value).abs().max(difference.abs());
            // Hub forces of thousands of newtons carry the round-off of the small ones across.
            let round_off = 1.0e-8 / h;
            let error = (input.derivatives[i] - difference).abs();
            assert!(
                error < tolerance * scale + round_off,
                "{} by {}: {} and {difference}",
                output.name,
                input.key,
                input.derivatives[i]
            );
        }
    }
}

/// A torque that is given does not change with lengths, and power is torque times speed, whatever the field: on the coarsest meshes, too,
/// whose corners of contact lie close together. A corner within the steps of a derivative would show as a change of the torque. Forces are
/// known to 1e-12 of E A, some thousands of roundings, which steps of 1e-7 of the field turn into 1e-5 of E A over the field.
#[test]
fn derivatives_keep_the_torque() {
    for (text, changes) in [
        (BASE, &[LOAD][..]),
        (
            BASE,
            &[
                "belt.elements=30",
                "steady.mesh=\"uniform\"",
                "pulley.driven.torque=-3",
            ],
        ),
    ] {
        let drive = drive(text, changes);
        let mut belt = RunningBelt::<BeltBeam2>::new(&drive).expect("a drive");
        let Answer::Running(running) = belt.solve().expect("solved") else {
            panic!("it does not run");
        };
        let torque = running.pulleys[1].torque;
        for key in [
            "belt.length",
            "pulley.driven.radius",
            "pulley.driven.center.0",
        ] {
            let field = NumberField::find(&drive, key).expect("a field");
            let found = belt
                .sensitivity(&drive, &running, &[field])
                .expect("derivatives");
            let input = &found.inputs[0];
            let by = |name: &str| {
                let place = found.outputs.iter().position(|output| output.name == name);
                input.derivatives[place.expect("a result")]
            };
            let part = 1.0e-5 * 1.0e4 * drive.pulley[1].radius / input.value;
            assert_near(key, by("pulley.driven.torque"), 0.0, part);
            let speed = by("pulley.driven.speed");
            let power = torque * speed;
            assert_near(
                key,
                by("pulley.driven.power"),
                power,
                part * running.pulleys[1].speed,
            );
        }
    }
}

/// The lowest mode of a span against the string of tension T that travels with the speed v between its tangent points, `f = (w² - v²)/(2 L w)`
/// with the wave speed `w² = T lambda / (rho A)` of the belt stretched by lambda: 0.5 %, which bending and the compliance of the pulleys
/// leave. Both spans have it where no torque makes their tensions differ. Friction damps: nothing grows.
#[test]
fn modes_of_the_spans() {
    for (text, changes, youngs_modulus) in [
        (BASE, &["belt.elements=60"][..], 1.0e8),
        (
            LOADED,
            &["belt.elements=60", "pulley.driven.torque=0"],
            1.0e9,
        ),
    ] {
        let drive = drive(text, changes);
        let mut belt = RunningBelt::<BeltBeam2>::new(&drive).expect("a drive");
        let Answer::Running(running) = belt.solve().expect("solved") else {
            panic!("it does not run");
        };
        let modes = belt.modes(&running, 6).expect("modes");
        let span = &running.spans[0];
        let (area, length) = (1.0e-4, belt.layout().spans[0].length);
        let stretch = 1.0 + span.strain;
        assert_near(
            "tension",
            span.tension,
            0.5 * youngs_modulus * area * (stretch * stretch - 1.0) * stretch,
            0.01 * span.tension,
        );
        let wave = (span.tension * stretch / (1036.0 * area)).sqrt();
        let string =
            std::f64::consts::PI * (wave * wave - span.speed * span.speed) / (length * wave);
        let spans: Vec<_> = modes
            .iter()
            .filter(|mode| mode.pulley_share < 0.01)
            .collect();
        for mode in &spans[..2] {
            assert_near("span", mode.frequency, string, 5.0e-3 * string);
        }
        assert_eq!(
            modes.iter().filter(|mode| mode.pulley_share > 0.9).count(),
            1
        );
        assert!(modes.iter().all(|mode| mode.growth < 0.0), "{modes:?}");
    }
}

/// Where next to no friction holds the belt, what the mesh does to its shift along itself is no motion of the drive: nothing grows, and no mode
/// below the spans' swings. With a slope of 1 N s/m² creep on 0.26 m holds 15 kg of the pulley with 1/60 1/s.
#[test]
fn modes_without_grip() {
    for elements in [40, 60, 120] {
        for law in [
            "contact.friction.slope=10",
            "contact.friction.slope=1",
            "contact.friction={law=\"creep-rate\", coefficient=1e-6, slope=100}",
        ] {
            let count = format!("belt.elements={elements}");
            let drive = drive(BASE, &[&count, law]);
            let mut belt = RunningBelt::<BeltBeam2>::new(&drive).expect("a drive");
            let Answer::Running(running) = belt.solve().expect("solved") else {
                panic!("it does not run");
            };
            let modes = belt.modes(&running, 4).expect("modes");
            // The spans' first swing has 21 Hz, 130 rad/s.
            for mode in &modes {
                let what = format!("{elements}, {law}: {} {}", mode.frequency, mode.growth);
                assert!(mode.growth < 0.0 && mode.frequency > 100.0, "{what}");
            }
        }
    }
}

/// A torque that drives and rises with the speed, by S = 100 N m s/rad, faster than the creep of the belt can hold it: the pulley of inertia I
/// runs away at S/I, less `k/S` and `k/D` = 8 1/s of 1000 for the belt as a spring and a damper in series. That is no swing, and it is told.
#[test]
fn growth_without_swing() {
    let law = "pulley.driven.load={law=\"table\", speed=[11.8, 12.2], torque=[-20, 20]}";
    let drive = drive(BASE, &["belt.elements=60", law]);
    let mut belt = RunningBelt::<BeltBeam2>::new(&drive).expect("a drive");
    let Answer::Running(running) = belt.solve().expect("solved") else {
        panic!("it does not run");
    };
    let modes = belt.modes(&running, 5).expect("modes");
    assert_eq!(modes.len(), 5);
    let growing: Vec<_> = modes.iter().filter(|mode| mode.growth > 0.0).collect();
    let [runs_away] = growing[..] else {
        panic!("{modes:?}");
    };
    assert_eq!(runs_away.frequency.to_bits(), 0);
    assert!(runs_away.pulley_share > 0.9);
    assert_near("growth", runs_away.growth, 1000.0, 10.0);
}

/// A Campbell diagram over the speed: every mode keeps its kind, the torsional one and those of the two spans, whose frequency falls
/// with the speed as that of the travelling string does, to 0.5 % as above.
#[test]
fn campbell_diagram() {
    let drive = drive(LOADED, &["belt.elements=60", "pulley.driven.torque=0"]);
    let axis = Axis {
        field: NumberField::find(&drive, "pulley.driver.speed").expect("a field"),
        values: vec![30.0, 120.0, 210.0, 300.0],
    };
    let found = campbell(&drive, &axis, 3, || ()).expect("a diagram");
    let mut last = f64::INFINITY;
    for point in &found.points {
        assert_eq!(point.answer, "running");
        let there = axis.field.with(&drive, point.value).expect("a drive");
        let Answer::Running(running) = solve(&there).expect("solved").answer else {
            panic!("it does not run");
        };
        let length = hihna::layout::Layout::of(&there).expect("a path").spans[0].length;
        let span = &running.spans[0];
        let wave = (span.tension * (1.0 + span.strain) / (1036.0 * 1.0e-4)).sqrt();
        let string =
            std::f64::consts::PI * (wave * wave - span.speed * span.speed) / (length * wave);
        let modes: Vec<_> = point.modes.iter().map(|m| m.expect("followed")).collect();
        assert!(modes[0].pulley_share > 0.9, "{modes:?}");
        for mode in &modes[1..] {
            assert!(mode.pulley_share < 0.01, "{modes:?}");
            assert_near("span", mode.frequency, string, 5.0e-3 * string);
        }
        assert!(string < last);
        last = string;
    }
}

/// Where no torque is among the axes the capacity is found point by point: a faster belt has less tension to grip with.
#[test]
fn capacity_along_a_map_of_speeds() {
    let changes = ["belt.elements=30", LOW_FRICTION, LOAD];
    let drive = drive(BASE, &changes);
    let speed = Axis {
        field: NumberField::find(&drive, "pulley.driver.speed").expect("a field"),
        values: vec![12.0, 60.0],
    };
    let found = map(&drive, &[speed], || ());
    let margin = found
        .columns
        .iter()
        .position(|c| c == "margin")
        .expect("a column");
    for (row, speed) in found.rows.iter().zip(["12", "60"]) {
        let speed = format!("pulley.driver.speed={speed}");
        let alone = outcome(BASE, &[&changes[..], &[&speed]].concat());
        let alone = alone.capacity.as_ref().and_then(Most::known);
        let alone = alone.expect("a capacity").factor;
        // The search ends where the load rises by less than 1e-4 while the slip doubles; the phase of the mesh differs.
        assert_near("capacity", row.values[margin], alone, 5.0e-3 * alone);
    }
    assert!(found.rows[1].values[margin] < 0.99 * found.rows[0].values[margin]);
}

/// A map by whole solutions: rows in the order of the axes, capacity in proportion to the torque, points beyond it marked, and the same for one
/// thread as for many.
#[test]
fn maps() {
    let drive = drive(BASE, &["belt.elements=30", LOW_FRICTION]);
    let axis = |key: &str, values: &[f64]| Axis {
        field: NumberField::find(&drive, key).expect("a field"),
        values: values.to_vec(),
    };
    let axes = [
        axis("pulley.driven.torque", &[-0.5, -1.0, -1.5, -3.0]),
        axis("pulley.driver.speed", &[6.0, 12.0]),
    ];
    let found = map(&drive, &axes, || ());
    let column = |name: &str| {
        found
            .columns
            .iter()
            .position(|c| c == name)
            .expect("a column")
    };
    assert_eq!(found.rows.len(), 8);
    for (i, row) in found.rows.iter().enumerate() {
        let (torque, speed) = (axes[0].values[i / 2], axes[1].values[i % 2]);
        assert_near("torque", row.values[0], torque, 0.0);
        assert_near("speed", row.values[1], speed, 0.0);
        let runs = torque > -2.0;
        assert_eq!(row.answer, if runs { "running" } else { "gross-slip" });
        if runs {
            let changes = [
                format!("pulley.driven.torque={torque}"),
                format!("pulley.driver.speed={speed}"),
            ];
            let changes = ["belt.elements=30", LOW_FRICTION, &changes[0], &changes[1]];
            let alone = running(BASE, &changes);
            // The phase of the mesh is that of the neighbour: a part of the mesh's own error.
            let tight = row.values[column("driven-driver.tension")];
            assert_near("tension", tight, alone.spans[1].tension, 5.0e-3 * tight);
            assert_near(
                "loss",
                row.values[column("driven.speed")],
                alone.pulleys[1].speed,
                1.0e-4 * speed,
            );
        } else {
            assert!(row.values[column("overload")] > 1.4);
        }
    }
    let one = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("a thread");
    let alone = one.install(|| map(&drive, &axes, || ()));
    assert_eq!(format!("{alone:?}"), format!("{found:?}"));
}

/// Slip measured at the surface, torque at the depth of the belt: unequal pulleys seem to win power, beyond what the mesh misses. Both at the
/// depth, as friction has it, nothing wins, whichever pulley drives. Ten times what the mesh misses cannot be the mesh's.
#[test]
fn friction_at_the_depth_takes_power_only() {
    let laws = [
        "contact.friction={law=\"creep-rate\", coefficient=0.6, slope=1e5}",
        "contact.friction={law=\"coulomb\", coefficient=0.6, velocity=1e-3}",
    ];
    let radii = [[0.05, 0.12], [0.12, 0.05]];
    for law in laws {
        let mut won = false;
        for [driver, driven] in radii {
            for (place, torque) in [("surface", -1.0), ("depth", -1.0), ("depth", 0.5)] {
                let found = running(
                    BASE,
                    &[
                        law,
                        "belt.elements=60",
                        "belt.tension=60",
                        "contact.stiffness=2e6",
                        "pulley.driver.speed=60",
                        &format!("pulley.driver.radius={driver}"),
                        &format!("pulley.driven.radius={driven}"),
                        &format!("pulley.driven.torque={torque}"),
                        &format!("contact.slip_at=\"{place}\""),
                    ],
                );
                let missed = found.power_residual.abs() * found.power_scale;
                if place == "surface" {
                    won |= found.powers.friction < -10.0 * missed;
                } else {
                    for pulley in &found.pulleys {
                        assert!(pulley.friction_loss >= 0.0, "{law}, {driver}: {pulley:?}");
                    }
                }
            }
        }
        assert!(won, "{law}");
    }
}

/// What stands in the way is told: a belt that centrifugal forces lift off, one that outruns waves of its bending, drivers of different speeds.
#[test]
fn obstacles() {
    let found = |changes: &[&str]| {
        let changes = [&["belt.elements=60"], changes].concat();
        match solve(&drive(BASE, &changes)) {
            Err(RunningError::NotFound(obstacle)) => obstacle,
            other => panic!("{changes:?}: {other:?}"),
        }
    };
    assert!(matches!(
        found(&["pulley.driver.speed=400"]),
        Obstacle::LiftOff { .. }
    ));
    assert!(matches!(
        found(&["belt.bending_factor=1e-4", "pulley.driver.speed=60", LOAD]),
        Obstacle::BendingWaves { .. }
    ));
}
