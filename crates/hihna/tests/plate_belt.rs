//! Whole drives with belts of plates, and pulleys that move.

use hihna::simulate::{Flow, Outcome, simulate};

fn run(text: &str, changes: &[&str]) -> Outcome {
    let changes: Vec<_> = changes
        .iter()
        .map(|change| change.parse().expect("an override"))
        .collect();
    let drive = match hihna::input::parse("a test", text, &changes) {
        Ok(drive) => drive,
        Err(errors) => panic!("{errors}\n{text}"),
    };
    let outcome = simulate(&drive, &mut |_| Flow::Continue).expect("the drive runs");
    assert!(outcome.audit.passed(), "{:?}", outcome.audit);
    outcome
}

fn column(outcome: &Outcome, name: &str) -> Vec<f64> {
    outcome.history.column(name).expect("a column of that name")
}

/// Largest difference of two columns.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    (a.iter().zip(b)).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

/// The two-pulley drive of Table 3.1 with a belt of the same E A and line density, 2 mm thick, that bends
/// by its own E I.
const NARROW: &str = r#"
[belt]
elements = 30
length = 1.2727
width = 0.01
thickness = 0.002
density = 5180.0
youngs_modulus = 5e8

[[pulley]]
name = "driver"
center = [-0.191441, 0.0]
radius = 0.08125
speed = { kind = "ramp", from = 0.0, to = 12.0, start = 0.05, end = 0.60 }

[[pulley]]
name = "driven"
center = [0.191441, 0.0]
radius = 0.08125
inertia = 0.1

[run]
end_time = 1.0
"#;
const PER_LENGTH: &str = r#"
[contact]
stiffness = 1.0e7
damping = 10.0
friction = { law = "creep-rate", coefficient = 1.2, slope = 1.0e5 }
"#;
const PER_AREA: &str = r#"
[contact]
stiffness = 1.0e9
damping = 1000.0
friction = { law = "creep-rate", coefficient = 1.2, slope = 1.0e7 }
"#;

/// A narrow belt of plates with nu = 0 is a planar belt: the driven speed is within 0.5 % of 12 rad/s of that of
/// belt beams at all times. Both have cubic centre lines, but bending and stretch couple: the plate's curvature
/// is that of the deformed surface, which relieves it of E I k²/2 of tension, the beam's energy knows the fibres'
/// stretch and takes up as much. Tensions differ by no more than E I/R².
#[test]
fn a_narrow_belt_of_plates_is_a_planar_belt() {
    let beams = run(&format!("{PER_LENGTH}{NARROW}"), &[]);
    let plates = run(&format!("{PER_AREA}{NARROW}"), &["belt.element=plate"]);
    let speed = |outcome: &Outcome| column(outcome, "driven.speed");
    let apart = difference(&speed(&plates), &speed(&beams));
    assert!(apart < 0.005 * 12.0, "{apart} rad/s");
    let tension = |outcome: &Outcome| {
        let mean = outcome.history.mean("driven-driver.tension", 0.3, 0.6);
        mean.expect("rows")
    };
    let (plate, beam) = (tension(&plates), tension(&beams));
    let coupling = 5e8 * 0.01 * 0.002_f64.powi(3) / 12.0 / 0.08125_f64.powi(2);
    assert!((plate - beam).abs() < coupling, "{plate} N and {beam} N");
}

/// A small plate drive, run shortly.
const SMALL: &str = r#"
[belt]
element = "plate"
elements = 16
elements_across = 2
strain = 0.02
width = 0.04
thickness = 0.002
density = 1000.0
youngs_modulus = 5e7
poisson_ratio = 0.3

[contact]
stiffness = 1.0e8
damping = 2000.0
friction = { law = "creep-rate", coefficient = 0.8, slope = 1.0e5 }
friction_directions = "both"
points = 6

[[pulley]]
name = "driver"
center = [-0.1, 0.0]
radius = 0.05
speed = { kind = "ramp", from = 0.0, to = 20.0, start = 0.0, end = 0.2 }

[[pulley]]
name = "driven"
center = [0.1, 0.0]
radius = 0.05
inertia = 0.002
torque = -0.2

[run]
end_time = 0.25
output_interval = 0.005
"#;

/// The drive turned by 90 degrees runs the same; gravity is off. Rounding alone differs: steps that are chosen by
/// lengths of vectors are the same, and 1e-7 is far below the Newton tolerance, 2e-7 of the speed a step.
#[test]
fn a_turned_drive_gives_the_same_answer() {
    let level = run(SMALL, &[]);
    let turned = run(
        SMALL,
        &[
            "pulley.driver.center=[0.0, -0.1]",
            "pulley.driven.center=[0.0, 0.1]",
        ],
    );
    for name in ["driven.speed", "driver-driven.tension", "driver.torque"] {
        let (a, b) = (column(&level, name), column(&turned, name));
        let scale = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let apart = difference(&a, &b);
        assert!(apart < 1.0e-5 * scale, "{name}: {apart} of {scale}");
    }
}

/// The mirror image in z of a drive runs as its mirror image, whether a node lies in the middle of the belt or not: of a
/// crowned driver beside the belt and a tilted, tapered driven pulley. The belt leaves the middle and the hub feels a force
/// and a moment out of the plane by much more than rounding, 1e-16 of positions of 0.1 m, which contact of 1e8 N/m3 and the
/// Newton iterations of 0.05 s make a millionth of these at most.
#[test]
fn a_mirrored_drive_runs_mirrored() {
    let placed = |across: usize, sign: f64| {
        let signed = |field: &str, value: f64| format!("pulley.{field}={}", sign * value);
        let tilt = format!("pulley.driven.tilt=[{}, {}]", sign * 0.02, sign * 0.01);
        let changes = [
            format!("belt.elements_across={across}"),
            "pulley.driver.crown={ height = 0.0005, width = 0.05 }".to_owned(),
            signed("driver.offset", 0.002),
            signed("driven.taper", 0.01),
            tilt,
            "run.end_time=0.05".to_owned(),
        ];
        run(SMALL, &changes.each_ref().map(String::as_str))
    };
    for across in [1, 2, 3] {
        let (one, other) = (placed(across, 1.0), placed(across, -1.0));
        for (name, sign) in [
            ("driven.speed", 1.0),
            ("driven.torque", 1.0),
            ("driver.belt_offset", -1.0),
            ("driven.belt_offset", -1.0),
            ("driven.hub_force_z", -1.0),
            ("driven.hub_moment_x", -1.0),
        ] {
            let a = column(&one, name);
            let b: Vec<f64> = column(&other, name).iter().map(|x| sign * x).collect();
            let scale = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            assert!(scale > 1.0e-5, "{name} is zero");
            let apart = difference(&a, &b);
            assert!(
                apart < 1.0e-6 * scale,
                "{across} across, {name}: {apart} of {scale}"
            );
        }
    }
}

/// On cylinders the belt does not care where along their axes it lies: beside the middle of wide pulleys it stays where it is
/// and nothing pushes the hubs, even though it contracts across, by nu times its strain, while it settles.
#[test]
fn a_belt_beside_the_middle_contracts_about_its_own() {
    let model_1 = include_str!("../../../examples/plate_model_1.toml");
    let beside = run(
        model_1,
        &[
            "contact.friction_directions=both",
            "pulley.driver.offset=0.002",
            "pulley.driven.offset=0.002",
            "run.end_time=0.02",
        ],
    );
    for name in ["driver", "driven"] {
        let force = column(&beside, &format!("{name}.hub_force_z"));
        let force = force.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        assert!(force < 1.0e-8, "{force} N");
        for offset in column(&beside, &format!("{name}.belt_offset")) {
            assert!((offset + 0.002).abs() < 1.0e-10, "{offset} m");
        }
    }
}

/// A hub that has been moved slowly by 2 mm leaves the belt as tight as if it had been mounted there: in the
/// plane and in space. Creep-rate friction is no force at rest: it lets the belt even out within v_s w L²/(E A),
/// 0.03 s for a span. The motion takes 0.3 s and ends smoothly, 0.1 s before the belt is looked at: e^-3 of a
/// difference between spans is left, of which the mean of both spans sees none but by the pulleys' arcs.
#[test]
fn a_moved_hub_stretches_the_belt() {
    let moved = "pulley.driven.displacement={ x = { kind = \"half-cosine\", from = 0.0, to = 0.002, \
                 start = 0.0, end = 0.3 } }";
    let rest = [
        "pulley.driver.speed=0.0",
        "pulley.driven.torque=0.0",
        "run.end_time=0.5",
    ];
    for element in ["plate", "belt-beam"] {
        let (text, kind) = if element == "plate" {
            (SMALL.to_owned(), "belt.element=plate")
        } else {
            let planar = SMALL
                .replace("elements_across = 2\n", "")
                .replace("friction_directions = \"both\"\n", "");
            (planar, "belt.element=belt-beam")
        };
        let length = "belt.strain=0.02";
        let before = run(&text, &[&rest[..], &[kind, length]].concat());
        let after = run(&text, &[&rest[..], &[kind, length, moved]].concat());
        let mean = |outcome: &Outcome| {
            let mean = outcome.history.mean("driver-driven.tension", 0.4, 0.5);
            mean.expect("rows")
        };
        // The path grows by 4 mm: the strain on the rigid path by 4 mm over the unstretched length.
        let path = before.mounting.path;
        let strain = (path + 0.004) / (path / 1.02) - 1.0;
        let strain = format!("belt.strain={strain:?}");
        let mounted = run(
            &text,
            &[
                &rest[..],
                &[kind, &strain, "pulley.driven.center=[0.102, 0.0]"],
            ]
            .concat(),
        );
        let (moved, mounted) = (mean(&after), mean(&mounted));
        assert!(moved > 1.2 * mean(&before), "the belt is tighter");
        assert!(
            (moved / mounted - 1.0).abs() < 2.0e-3,
            "{element}: {moved} N moved there, {mounted} N mounted there"
        );
    }
}

/// A hub that starts and stops at once, (4.46): damping and friction jump with its velocity. Forces of one side and
/// motion of the other within a step of h would miss the work F v h/2 of F v T, 2e-3 for steps of 0.4 ms in 0.1 s;
/// the audit allows 1e-4.
#[test]
fn a_hub_may_start_and_stop_at_once() {
    let displacement = "pulley.driven.displacement={ x = { kind = \"ramp\", from = 0.0, to = 0.002, \
                        start = 0.05, end = 0.15 } }";
    let changes = [
        displacement,
        "pulley.driver.speed=0.0",
        "pulley.driven.torque=0.0",
    ];
    let outcome = run(SMALL, &changes);
    assert!(outcome.audit.energy_input > 0.01, "the hub does work");
}

/// What a driver draws that is far slower than the drive will be is in balance too, whenever the run ends: on the
/// way, as it stops, at once after. Steps fit for the drive's 1.2 m/s missed 2 % of the work of a hub at 0.05 m/s.
#[test]
fn the_work_of_a_tensioner_balances() {
    let model_1 = include_str!("../../../examples/plate_model_1.toml");
    for end in ["0.02", "0.05", "0.06", "0.1"] {
        run(model_1, &[&format!("run.end_time={end}")]);
    }
    run(model_1, &["run.end_time=0.05", "run.accuracy=5e-4"]);
    run(model_1, &["pulley.driver.speed=0.0", "run.end_time=0.2"]);
    let smooth = "pulley.driver.displacement.x={ kind = \"half-cosine\", from = 0.0, to = -0.0025, start = 0.0, \
                  end = 0.05 }";
    run(model_1, &[smooth, "run.end_time=0.08"]);
}

/// A belt beside the middle of crowned pulleys climbs to it, row by row, by more than a tenth of its distance in
/// 0.3 s (seven turns; it is a quarter at this slope). On cylinders nothing steers it: it stays where it is, to a
/// millionth of its distance. The sign is that of every flat-belt drive: belts run to the crown.
#[test]
fn a_belt_climbs_to_the_crown() {
    let crowned = include_str!("../../../examples/crowned_pulleys.toml");
    let flat: String = (crowned.lines())
        .filter(|line| !line.starts_with("crown ="))
        .flat_map(|line| [line, "\n"])
        .collect();
    let offsets = |text: &str| {
        let outcome = run(text, &["run.end_time=0.4", "run.output_interval=0.1"]);
        column(&outcome, "driver.belt_offset")
    };
    let climbing = offsets(crowned);
    assert!(
        climbing.windows(2).all(|pair| pair[1] > pair[0]),
        "{climbing:?}"
    );
    assert!(climbing[4] > 0.9 * climbing[1], "{climbing:?}");
    for offset in offsets(&flat) {
        assert!((offset + 0.003).abs() < 3.0e-9, "{offset}");
    }
}

/// A belt 40 mm wide, 3 mm beside the middle, hangs 3 mm over the edge of a pulley 40 mm wide, which the summary says; on
/// the example's, 50 mm wide, it does not. It climbs by less than a tenth of a millimetre in 10 ms.
#[test]
fn a_belt_over_the_edge_of_a_crowned_pulley_is_told() {
    let crowned = include_str!("../../../examples/crowned_pulleys.toml");
    let warnings = |change: &str| {
        let text = crowned.replacen("crown = { height", &format!("{change}crown = {{ height"), 1);
        let drive: hihna::drive::Drive = text.parse().expect("the example");
        let outcome = run(&text, &["run.end_time=0.01"]);
        hihna::summary::Summary::new(&drive, &outcome).warnings
    };
    assert!(warnings("").is_empty(), "{:?}", warnings(""));
    let narrow = "crown = { height = \"0.5 mm\", width = \"40 mm\" }\n#";
    let told = warnings(narrow);
    assert!(
        told.len() == 1 && told[0].contains("3.0 mm beyond the edge of pulley `driver`"),
        "{told:?}"
    );
}

/// Equal bytes from equal input.
#[test]
fn runs_are_reproducible() {
    let short = ["run.end_time=0.05"];
    let (a, b) = (run(SMALL, &short), run(SMALL, &short));
    assert_eq!(a.history, b.history);
    assert_eq!(a.profile, b.profile);
}
