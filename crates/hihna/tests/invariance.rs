//! Whole drives under changes whose effect is known: mirrored, rotated, without friction, with
//! other layouts and with the options on.
//!
//! Drives are the belt of `examples/two_pulley.toml` (Kerkkänen 2006, Table 3.1) over
//! 0.5 s with the driver reaching 12 rad/s in 0.4 s: long enough for belt and pulleys to turn, short
//! enough for a whole file of runs.

use std::fmt::Write as _;

use hihna::simulate::{Flow, Outcome, simulate};

/// A pulley of a test drive.
#[derive(Clone, Copy)]
struct Pulley {
    name: &'static str,
    center: [f64; 2],
    radius: f64,
    outside: bool,
    /// Speed at the end of the ramp [rad/s]; a driver if given.
    speed: Option<f64>,
}

const RADIUS: f64 = 0.08125;
const HALF: f64 = 0.191_441;
const DRIVER: Pulley = Pulley {
    name: "driver",
    center: [-HALF, 0.0],
    radius: RADIUS,
    outside: false,
    speed: Some(12.0),
};
const DRIVEN: Pulley = Pulley {
    name: "driven",
    center: [HALF, 0.0],
    radius: RADIUS,
    outside: false,
    speed: None,
};

/// A back-side idler below the belt.
const IDLER: Pulley = Pulley {
    name: "idler",
    center: [0.0, -0.11],
    radius: 0.06,
    outside: true,
    speed: None,
};

/// A drive of these pulleys; `belt` says how tight the belt is, `more` are overrides.
fn run(pulleys: &[Pulley], belt: &str, more: &[&str]) -> Outcome {
    let mut text = format!(
        "[belt]\nelements = 30\n{belt}\nwidth = 0.01\nthickness = 0.01\ndensity = 1036.0\n\
         youngs_modulus = 1e8\npoisson_ratio = 0.3\nbending_factor = 0.01\n\
         [contact]\nstiffness = 1e7\ndamping = 10.0\n\
         friction = {{ law = \"creep-rate\", coefficient = 1.2, slope = 1e5 }}\n\
         [run]\nend_time = 0.5\noutput_interval = 0.002\n"
    );
    for pulley in pulleys {
        let Pulley {
            name,
            center: [x, y],
            radius,
            outside,
            speed,
        } = pulley;
        let wrap = if *outside { "outside" } else { "inside" };
        let motion = speed.map_or("inertia = 0.02".to_owned(), |speed| {
            format!(
                "speed = {{ kind = \"ramp\", from = 0.0, to = {speed:?}, start = 0.01, end = 0.4 }}"
            )
        });
        write!(
            text,
            "[[pulley]]\nname = \"{name}\"\ncenter = [{x:?}, {y:?}]\nradius = {radius:?}\n\
             wrap = \"{wrap}\"\n{motion}\n"
        )
        .expect("text grows");
    }
    let overrides: Vec<_> = more
        .iter()
        .map(|change| change.parse().expect("an override"))
        .collect();
    let drive = match hihna::input::parse("a test", &text, &overrides) {
        Ok(drive) => drive,
        Err(errors) => panic!("{errors:?}\n{text}"),
    };
    simulate(&drive, &mut |_| Flow::Continue).expect("the drive runs")
}

const LENGTH: &str = "length = 1.2727";

fn column(outcome: &Outcome, name: &str) -> Vec<f64> {
    outcome.history.column(name).expect("a column of that name")
}

fn last(outcome: &Outcome, name: &str) -> f64 {
    *column(outcome, name).last().expect("rows")
}

/// Largest difference of `a` and `factor * b`, relative to the largest of `a`.
fn difference(a: &[f64], factor: f64, b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let pairs = a.iter().zip(b);
    pairs
        .map(|(a, b)| (a - factor * b).abs())
        .fold(0.0, f64::max)
        / largest
}

fn assert_audit(outcome: &Outcome) {
    assert!(outcome.audit.passed(), "{:?}", outcome.audit);
}

/// `x -> -x` exchanges the senses of turning and the two spans. The pulleys stay in their order, so
/// node `i` of the one belt is node `-i` of the other, and sums are taken in another order: rounding
/// differs, step choices do not (they look at lengths of vectors).
#[test]
fn mirrored_drive_gives_the_mirrored_answer() {
    let mirrored = |pulley: Pulley| Pulley {
        center: [-pulley.center[0], pulley.center[1]],
        speed: pulley.speed.map(|speed| -speed),
        ..pulley
    };
    let small = Pulley {
        radius: 0.06,
        center: [0.18, 0.05],
        ..DRIVEN
    };
    let one = run(&[DRIVER, small], "strain = 0.005", &[]);
    let two = run(&[mirrored(DRIVER), mirrored(small)], "strain = 0.005", &[]);
    // the span that leaves the driver in belt order is the other one when mirrored
    for (a, factor, b) in [
        ("driven.speed", -1.0, "driven.speed"),
        ("driver-driven.tension", 1.0, "driven-driver.tension"),
        ("driven-driver.tension", 1.0, "driver-driven.tension"),
        ("driven.hub_force_x", -1.0, "driven.hub_force_x"),
        ("driven.hub_force_y", 1.0, "driven.hub_force_y"),
    ] {
        let off = difference(&column(&one, a), factor, &column(&two, b));
        assert!(off < TO_SOLVER_TOLERANCE, "{a}: {off:.1e}");
    }
    assert!(last(&one, "driven.speed") > 1.0);
}

/// Newton stops at 1e-6 of the belt's speed, and the damped contact forgets such errors: ten of them
/// are the most that may be left, relative to the largest value of a column.
const TO_SOLVER_TOLERANCE: f64 = 1.0e-5;

/// Nothing in the equations knows where the origin or the axes are. Step control does: it judges
/// each coordinate by itself, so that turned axes choose other steps (3e-4 of the speed, below the
/// accuracy of 1e-3). Fixed steps leave the solver's tolerance alone.
#[test]
fn rotated_and_shifted_drive_gives_the_rotated_answer() {
    let (s, c) = 37.0_f64.to_radians().sin_cos();
    let turned = |pulley: Pulley| {
        let [x, y] = pulley.center;
        Pulley {
            center: [c * x - s * y + 0.3, s * x + c * y - 0.2],
            ..pulley
        }
    };
    // Norms take the lengths of vectors, so that steps, too, are those of the drive before.
    let short = ["run.end_time=0.2"];
    let one = run(&[DRIVER, DRIVEN], LENGTH, &short);
    let two = run(&[turned(DRIVER), turned(DRIVEN)], LENGTH, &short);
    assert_eq!(one.statistics.steps, two.statistics.steps);
    for name in [
        "driven.speed",
        "driver-driven.tension",
        "driven-driver.tension",
    ] {
        let off = difference(&column(&one, name), 1.0, &column(&two, name));
        assert!(off < TO_SOLVER_TOLERANCE, "{name}: {off:.1e}");
    }
    for name in ["driver", "driven"] {
        let component =
            |outcome: &Outcome, axis: &str| column(outcome, &format!("{name}.hub_force_{axis}"));
        let (x, y) = (component(&two, "x"), component(&two, "y"));
        let back: Vec<f64> = x.iter().zip(&y).map(|(x, y)| c * x + s * y).collect();
        let off = difference(&component(&one, "x"), 1.0, &back);
        assert!(off < TO_SOLVER_TOLERANCE, "{name}: hub force {off:.1e}");
    }
}

/// The normal force has no lever about the pulley's axis: the torque is exactly zero.
#[test]
fn without_friction_the_driven_pulley_does_not_turn() {
    let outcome = run(
        &[DRIVER, DRIVEN],
        LENGTH,
        &["contact.friction.coefficient=0.0"],
    );
    let largest = column(&outcome, "driven.speed")
        .iter()
        .fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(largest < 1.0e-12, "{largest} rad/s");
    assert!(last(&outcome, "driver.speed") > 11.9);
}

/// A back-side idler turns the other way, at the ratio of the radii of the belt's surface speed.
/// Creep under the small torques that speed the pulleys up is far below 1 % here; the belt's swing
/// leaves a few percent.
#[test]
fn three_pulleys_with_an_outside_idler() {
    let outcome = run(
        &[DRIVER, IDLER, DRIVEN],
        "strain = 0.005",
        &["belt.elements=60", "pulley.idler.inertia=0.0005"],
    );
    assert_audit(&outcome);
    let (driven, turning) = (
        last(&outcome, "driven.speed"),
        last(&outcome, "idler.speed"),
    );
    assert!(driven > 9.0, "{driven} rad/s");
    let ratio = -turning * IDLER.radius / (driven * RADIUS);
    assert!((ratio - 1.0).abs() < 0.1, "ratio of surface speeds {ratio}");
}

/// A crossed belt reaches the driven pulley from the other side: it turns the other way.
#[test]
fn crossed_belt_turns_the_driven_pulley_the_other_way() {
    let crossed = Pulley {
        outside: true,
        ..DRIVEN
    };
    let outcome = run(&[DRIVER, crossed], "strain = 0.005", &[]);
    assert_audit(&outcome);
    let driven = last(&outcome, "driven.speed");
    assert!(driven < -9.0 && driven > -15.0, "{driven} rad/s");
}

/// Unequal radii: angular momentum given to the driven pulley per surface speed; the belt at
/// 12 rad/s · 0.05 m turns a pulley of 0.1 m at 6 rad/s, within the swing of the belt (10 %).
#[test]
fn unequal_radii_give_their_ratio() {
    let small = Pulley {
        radius: 0.05,
        ..DRIVER
    };
    let large = Pulley {
        radius: 0.1,
        ..DRIVEN
    };
    let outcome = run(&[small, large], "strain = 0.005", &["run.end_time=0.8"]);
    assert_audit(&outcome);
    let mean = outcome
        .history
        .mean("driven.speed", 0.4, 0.8)
        .expect("rows");
    assert!((mean / 6.0 - 1.0).abs() < 0.1, "{mean} rad/s");
}

/// The same tightness by tension, by strain and by length gives the same belt. Length and tension
/// come from the mounting of the run by strain; what remains is rounding, which the solver's
/// tolerance bounds as above.
#[test]
fn belt_by_tension_by_strain_and_by_length_are_one() {
    let short = ["run.end_time=0.05"];
    let strained = run(&[DRIVER, DRIVEN], "strain = 0.004", &short);
    let tension = format!("tension = {:?}", strained.mounting.tension);
    let length = format!("length = {:?}", strained.mounting.length);
    for belt in [tension, length] {
        let other = run(&[DRIVER, DRIVEN], &belt, &short);
        assert!((other.mounting.length / strained.mounting.length - 1.0).abs() < 1.0e-13);
        assert!((other.mounting.stretch / 1.004 - 1.0).abs() < 1.0e-13);
        for name in ["driven.speed", "driver-driven.tension"] {
            let off = difference(&column(&strained, name), 1.0, &column(&other, name));
            assert!(off < TO_SOLVER_TOLERANCE, "{belt}: {name} {off:.1e}");
        }
    }
}

/// The balance closes with every way to store and take energy at work.
#[test]
fn audit_closes_with_gravity_and_belt_damping() {
    for friction in [
        "contact.friction={ law = \"creep-rate\", coefficient = 1.2, slope = 1e5 }",
        "contact.friction={ law = \"coulomb\", coefficient = 0.8, velocity = 0.01 }",
    ] {
        let outcome = run(
            &[DRIVER, DRIVEN],
            LENGTH,
            &[
                "gravity=[0.0, -9.81]",
                "belt.damping_time=1e-4",
                "contact.clamp_normal_force=true",
                friction,
            ],
        );
        assert_audit(&outcome);
        assert!(last(&outcome, "energy.damping_loss") > 0.0);
        assert!(last(&outcome, "driven.speed") > 1.0);
    }
}

/// Slow drives of light pulleys swing fast against their speed, and a short run turns little energy
/// over: both must close their balances at the default accuracy as well.
#[test]
fn audits_close_in_slow_drives_and_short_runs() {
    let slow = Pulley {
        speed: Some(4.0),
        ..DRIVER
    };
    let crossed = Pulley {
        outside: true,
        ..DRIVEN
    };
    let small = Pulley {
        radius: 0.05,
        ..DRIVER
    };
    let large = Pulley {
        radius: 0.1,
        ..DRIVEN
    };
    for inertia in [0.1, 0.02, 0.005] {
        let light = format!("pulley.driven.inertia={inertia}");
        assert_audit(&run(&[slow, crossed], "strain = 0.005", &[&light]));
        assert_audit(&run(&[small, large], "strain = 0.005", &[&light]));
        let options = [&light[..], "gravity=[0.0, -9.81]", "belt.damping_time=1e-4"];
        assert_audit(&run(&[slow, DRIVEN], LENGTH, &options));
        let loose = [
            &light[..],
            "belt.elements=60",
            "pulley.idler.inertia=0.0005",
        ];
        assert_audit(&run(&[slow, IDLER, DRIVEN], "strain = 0.005", &loose));
    }
    assert_audit(&run(&[DRIVER, DRIVEN], LENGTH, &["run.end_time=0.15"]));
}

/// A driver that has its full speed at once slips under the belt, which swings and beats: errors of
/// prediction do not see what that costs, the energy balance does.
#[test]
fn audits_close_when_the_driver_starts_with_a_jump() {
    let outcome = run(
        &[DRIVER, DRIVEN],
        LENGTH,
        &["pulley.driver.speed=12.0", "run.end_time=0.1"],
    );
    assert_audit(&outcome);
    let lost = last(&outcome, "energy.friction_loss") / last(&outcome, "energy.input");
    assert!(lost > 0.5, "friction takes {lost} of the input");
}

/// A small idler that presses far into the belt's path: the start is hard to settle.
#[test]
fn a_small_idler_deep_in_the_path_settles() {
    let idler = Pulley {
        center: [0.0, -0.09],
        radius: 0.04,
        ..IDLER
    };
    let changes = ["belt.elements=40", "pulley.idler.inertia=0.0005"];
    assert_audit(&run(&[DRIVER, idler, DRIVEN], "strain = 0.005", &changes));
}

/// Every friction law, belt element and contact line closes its balances and drives the driven pulley
/// at the ratio of pitch radii, within the swing and the lag of the ramp (10 %).
#[test]
fn audits_close_with_every_law_element_and_surface() {
    let variants: [&[&str]; 7] = [
        &[
            "contact.friction={ law = \"stribeck\", static_coefficient = 0.9, sliding_coefficient = 0.5, stribeck_velocity = 0.2, velocity = 0.01 }",
        ],
        &["contact.friction={ law = \"elastic-plastic\", coefficient = 1.2, stiffness = 1e7 }"],
        &[
            "contact.friction={ law = \"elastic-plastic\", coefficient = 1.2, stiffness = 1e7, damping = 1e3 }",
        ],
        &["contact.surface=\"face\""],
        &["belt.element=\"cubic-beam\""],
        &["belt.element=\"linear-beam\"", "belt.elements=120"],
        &[
            "pulley.driven.load={ law = \"fan\", torque = 0.2, speed = 12.0 }",
            "pulley.driver.irregularity=[{ order = 2.0, amplitude = 0.02 }]",
        ],
    ];
    for changes in variants {
        let outcome = run(&[DRIVER, DRIVEN], "strain = 0.005", changes);
        assert_audit(&outcome);
        let speed = last(&outcome, "driven.speed");
        assert!(
            (speed / 12.0 - 1.0).abs() < 0.1,
            "{changes:?}: {speed} rad/s"
        );
    }
}

/// A joint by multipliers closes the same loop: the same equations, other unknowns, so that only what
/// Newton leaves differs.
#[test]
fn joint_by_multipliers_gives_the_motion_of_the_shared_node() {
    let short = ["run.end_time=0.2"];
    let shared = run(&[DRIVER, DRIVEN], LENGTH, &short);
    let tied = run(
        &[DRIVER, DRIVEN],
        LENGTH,
        &[short[0], "belt.joint=\"multipliers\""],
    );
    assert_audit(&tied);
    assert_eq!(tied.dofs, shared.dofs + 12);
    for name in [
        "driven.speed",
        "driver-driven.tension",
        "driven-driver.tension",
        "driver.hub_force_x",
    ] {
        let off = difference(&column(&shared, name), 1.0, &column(&tied, name));
        assert!(off < TO_SOLVER_TOLERANCE, "{name}: {off:.1e}");
    }
}

/// A load beyond what friction carries drags the driven pulley backwards: the summary says that it slips, and
/// its loss of speed is more than all of it.
#[test]
fn a_pulley_dragged_backwards_is_told() {
    let load = "pulley.driven.torque={kind=\"half-cosine\",from=0.0,to=-8.0,start=0.1,end=0.4}";
    let text = include_str!("../../../examples/two_pulley.toml");
    let changes = [load, "run.end_time=0.7"].map(|change| change.parse().expect("an override"));
    let drive = hihna::input::parse("two_pulley.toml", text, &changes).expect("a drive");
    let outcome = simulate(&drive, &mut |_| Flow::Continue).expect("the drive runs");
    let summary = hihna::summary::Summary::new(&drive, &outcome);
    let (_, driven) = &summary.steady.pulley.0[1];
    assert!(driven.speed < 0.0 && driven.speed_loss > 1.0, "{driven:?}");
    let warnings = summary.warnings.join("\n");
    assert!(warnings.contains("slips on pulley `driven`"), "{warnings}");
    assert_audit(&outcome);
}

/// Rows lie within steps, and the ramp's acceleration jumps at the ends of some: the driver's speed is prescribed
/// in every row all the same.
#[test]
fn the_driver_turns_as_prescribed_in_every_row() {
    let outcome = run(&[DRIVER, DRIVEN], LENGTH, &["run.output_interval=0.0007"]);
    let speeds = column(&outcome, "driver.speed");
    let times = column(&outcome, "time");
    for (time, speed) in times.iter().zip(speeds) {
        let ramp = ((time - 0.01) / 0.39).clamp(0.0, 1.0) * 12.0;
        assert!((speed - ramp).abs() < 1e-12, "{speed} rad/s at {time} s");
    }
}
