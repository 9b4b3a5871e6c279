//! Whole drives with flat belts of spatial beams.

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

/// Largest difference of two columns, and the largest value.
fn apart(a: &[f64], b: &[f64]) -> (f64, f64) {
    assert_eq!(a.len(), b.len());
    let difference = (a.iter().zip(b)).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
    (difference, a.iter().fold(0.0, |m, x| m.max(x.abs())))
}

/// The two-pulley drive of Table 3.1, shorter.
const PLANE: &str = r#"
[belt]
elements = 20
length = 1.2727
width = 0.01
thickness = 0.01
density = 1036.0
youngs_modulus = 1e8
poisson_ratio = 0.3
bending_factor = 0.01

[[pulley]]
name = "driver"
center = [-0.191441, 0.0]
radius = 0.08125
speed = { kind = "ramp", from = 0.0, to = 12.0, start = 0.05, end = 0.30 }

[[pulley]]
name = "driven"
center = [0.191441, 0.0]
radius = 0.08125
inertia = 0.1

[run]
end_time = 0.4
step = 2e-4
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

/// On pulleys in line a belt of spatial beams is the planar belt: the elements agree to 1e-12 (tests of `ancf`), the
/// contact law is the same, points across the width see the same. Steps are fixed, so what differs is what Newton's
/// method leaves, 2e-7 of the speed a step, and rounding.
#[test]
fn in_the_plane_it_is_the_planar_belt() {
    for (planar, spatial, surface) in [
        ("belt-beam", "belt-beam-3d", "centre-line"),
        ("belt-beam", "belt-beam-3d", "face"),
        ("linear-beam", "linear-beam-3d", "centre-line"),
    ] {
        let surface = format!("contact.surface={surface}");
        let count = if planar == "linear-beam" {
            "belt.elements=60"
        } else {
            "belt.elements=20"
        };
        let change = |element: &str| format!("belt.element={element}");
        let plane = run(
            &format!("{PER_LENGTH}{PLANE}"),
            &[&change(planar), &surface, count],
        );
        let space = run(
            &format!("{PER_AREA}{PLANE}"),
            &[&change(spatial), &surface, count],
        );
        for name in ["driven.speed", "driver-driven.tension", "driven.torque"] {
            let (difference, scale) = apart(&column(&plane, name), &column(&space, name));
            assert!(
                difference < 1.0e-6 * scale,
                "{spatial}, {surface}, {name}: {difference} of {scale}"
            );
        }
        let offset = column(&space, "driven.belt_offset");
        let largest = offset.iter().fold(0.0, |m: f64, z| m.max(z.abs()));
        // Nothing holds it sideways, so rounding adds up; a ten-thousandth of its width is far above that.
        assert!(largest < 1.0e-6, "stays in its plane: {largest}");
    }
}

/// A small flat belt 40 mm wide, run shortly.
const SMALL: &str = r#"
[belt]
element = "belt-beam-3d"
elements = 24
strain = 0.02
width = 0.04
thickness = 0.002
density = 1000.0
youngs_modulus = 5e7
poisson_ratio = 0.3

[contact]
stiffness = 1.0e8
damping = 2000.0
friction = { law = "creep-rate", coefficient = 0.8, slope = 1.0e6 }
friction_directions = "both"
points = 5
points_across = 4

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

/// A pulley tilted the other way makes the belt run to the other side; all else is the same. The belt leaves the
/// middle by much more than rounding, and the tilted hub feels a moment across its axis.
#[test]
fn opposite_tilt_mirrors_the_belt() {
    let tilted = |tilt: &str| run(SMALL, &[&format!("pulley.driven.tilt=[{tilt}, 0.0]")]);
    let (one, other) = (tilted("0.02"), tilted("-0.02"));
    for (name, sign) in [
        ("driven.speed", 1.0),
        ("driven.torque", 1.0),
        ("driven.belt_offset", -1.0),
        ("driven.hub_force_z", -1.0),
        ("driven.hub_moment_x", -1.0),
    ] {
        let a = column(&one, name);
        let b: Vec<f64> = column(&other, name).iter().map(|x| sign * x).collect();
        let (difference, scale) = apart(&a, &b);
        assert!(scale > 1.0e-6, "{name} is zero");
        assert!(
            difference < 1.0e-3 * scale,
            "{name}: {difference} of {scale}"
        );
    }
}

/// The drive turned by 90 degrees runs the same; gravity is off. Rounding alone differs, and what Newton's method
/// leaves of 2e-7 of the speed a step.
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
        let (difference, scale) = apart(&column(&level, name), &column(&turned, name));
        assert!(
            difference < 1.0e-5 * scale,
            "{name}: {difference} of {scale}"
        );
    }
}

/// A flat belt beside the middle of crowned pulleys climbs to it; on cylinders nothing steers it, and it stays where it
/// is to a millionth of its distance.
#[test]
fn a_belt_climbs_to_the_crown() {
    let offsets = |crown: &[&str]| {
        let all = [
            "pulley.driver.offset=0.003",
            "pulley.driven.offset=0.003",
            "pulley.driver.speed=40.0",
            "run.end_time=0.3",
            "run.output_interval=0.1",
        ];
        column(
            &run(SMALL, &[&all[..], crown].concat()),
            "driver.belt_offset",
        )
    };
    let crown = "crown={ height = 5e-4, width = 0.05 }";
    let climbing = offsets(&[
        &format!("pulley.driver.{crown}"),
        &format!("pulley.driven.{crown}"),
    ]);
    assert!(
        climbing.windows(2).all(|pair| pair[1] > pair[0]),
        "{climbing:?}"
    );
    for offset in offsets(&[]) {
        assert!((offset + 0.003).abs() < 3.0e-9, "{offset}");
    }
}

/// A back-side idler and three pulleys, listed either way round: the belt runs in space as it does in the plane.
#[test]
fn idlers_and_more_pulleys() {
    let text = include_str!("../../../examples/back_side_idler.toml");
    let drive: hihna::drive::Drive = text.parse().expect("the example");
    let width = drive.belt.width;
    let per_area = |value: f64| format!("{:e}", value / width);
    let changes = [
        "belt.element=belt-beam-3d".to_owned(),
        format!("contact.stiffness={}", per_area(drive.contact.stiffness)),
        format!("contact.damping={}", per_area(drive.contact.damping)),
        "contact.friction.slope=5e6".to_owned(),
        "run.end_time=0.1".to_owned(),
    ];
    let changes: Vec<&str> = changes.iter().map(String::as_str).collect();
    let space = run(text, &changes);
    let plane = run(text, &["run.end_time=0.1"]);
    let ratio = space.start.tension / plane.start.tension;
    assert!((ratio - 1.0).abs() < 1.0e-3, "{ratio}");
}

/// Equal bytes from equal input.
#[test]
fn runs_are_reproducible() {
    let short = ["run.end_time=0.05", "pulley.driven.tilt=[0.01, 0.0]"];
    let (a, b) = (run(SMALL, &short), run(SMALL, &short));
    assert_eq!(a.history, b.history);
    assert_eq!(a.profile, b.profile);
}
