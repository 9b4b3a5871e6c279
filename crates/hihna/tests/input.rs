//! Bad input: each class of mistake is told with file, line, field, expectation and help; good input is
//! read in full, with units and overrides. Messages are compared as plain parts, so that wording can grow.

// Numbers that are read must be exact.
#![allow(clippy::float_cmp)]

use hihna::drive::{AutoStep, Drive, Step};
use hihna::input::{self, Override};
use hihna::profile::{Profile, Varying};

const EXAMPLE: &str = include_str!("../../../examples/two_pulley.toml");

/// The example with one stretch of text replaced, which must be there.
fn with(old: &str, new: &str) -> String {
    assert!(EXAMPLE.contains(old), "{old}");
    EXAMPLE.replacen(old, new, 1)
}

/// The line, from 1, on which a text last stands.
fn line_of(text: &str, part: &str) -> usize {
    let before = text.rfind(part).unwrap_or_else(|| panic!("{part}"));
    text[..before].lines().count().max(1) + usize::from(text[..before].ends_with('\n'))
}

/// Reads `text`, which must fail with exactly one error, at the line that holds `marker`; its field and
/// all `parts` must be in the message.
fn fails(text: &str, marker: &str, field: &str, parts: &[&str]) {
    let errors: Vec<_> = input::parse("bad.toml", text, &[])
        .expect_err(marker)
        .into_iter()
        .collect();
    assert_eq!(errors.len(), 1, "{errors:#?}");
    let error = &errors[0];
    let shown = error.to_string();
    assert_eq!(error.problem.path.to_string(), field, "{shown}");
    let place = error
        .place
        .as_ref()
        .unwrap_or_else(|| panic!("no place: {shown}"));
    assert_eq!(place.line(), line_of(text, marker), "{shown}");
    assert!(
        shown.starts_with(&format!("bad.toml:{}:", place.line())),
        "{shown}"
    );
    for part in parts {
        assert!(shown.contains(part), "no {part:?} in: {shown}");
    }
}

/// The example with overrides, which must be fine.
fn with_overrides(overrides: &[&str]) -> Drive {
    let overrides: Vec<Override> = overrides.iter().map(|text| text.parse().unwrap()).collect();
    input::parse("good.toml", EXAMPLE, &overrides).unwrap_or_else(|errors| panic!("{errors}"))
}

/// The example with an override that must fail with exactly one error; its text.
fn override_fails(text: &str, parts: &[&str]) {
    let errors = match text.parse::<Override>() {
        Ok(change) => input::parse("bad.toml", EXAMPLE, &[change]).expect_err(text),
        Err(errors) => errors,
    };
    assert_eq!(errors.iter().count(), 1, "{errors}");
    let shown = errors.to_string();
    assert!(shown.starts_with("--set "), "{shown}");
    for part in parts {
        assert!(shown.contains(part), "no {part:?} in: {shown}");
    }
}

#[test]
fn example_is_read_in_si() {
    let drive: Drive = EXAMPLE.parse().unwrap();
    assert_eq!(drive.belt.length, Some(1.2727));
    assert_eq!(drive.belt.width, 0.01);
    assert_eq!(drive.belt.youngs_modulus, 1e8);
    assert_eq!(drive.pulley[1].torque, Profile::Constant(0.0));
    assert_eq!(drive.run.step, Step::Named(AutoStep::Auto));
    assert_eq!(drive.gravity, [0.0, 0.0]);
    assert!(drive.validate().is_empty());
}

#[test]
fn units_work_in_lists_profiles_and_tables() {
    let text = with("center = [0.191441, 0.0]", "center = [\"191.441 mm\", 0]")
        .replacen(
            "to = 12.0, start = 0.05",
            "to = \"180 deg/s\", start = \"50 ms\"",
            1,
        )
        .replacen(
            "torque = 0.0",
            "torque = { kind = \"table\", time = [0, \"500 ms\"], value = [0, \"-2 N m\"] }",
            1,
        )
        .replacen(
            "[run]",
            "[run]\nstep = \"0.1 ms\"\nprofile_times = [\"500 ms\", 1]",
            1,
        );
    let drive: Drive = text.parse().unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(drive.pulley[1].center, [0.191_441, 0.0]);
    let ramp = Varying::Ramp {
        from: 0.0,
        to: std::f64::consts::PI,
        start: 0.05,
        end: 0.60,
    };
    assert_eq!(drive.pulley[0].speed, Some(Profile::Varying(ramp)));
    let table = Varying::Table {
        time: vec![0.0, 0.5],
        value: vec![0.0, -2.0],
    };
    assert_eq!(drive.pulley[1].torque, Profile::Varying(table));
    assert_eq!(drive.run.step, Step::Fixed(1e-4));
    assert_eq!(drive.run.profile_times, [0.5, 1.0]);
}

#[test]
fn syntax() {
    fails(
        &with("width = \"10 mm\"", "width = 10 mm"),
        "width = 10 mm",
        "",
        &["not valid TOML", "quotes"],
    );
    fails(
        &with("points = 7", "points = 7\npoints = 8"),
        "points = 8",
        "",
        &["not valid TOML", "duplicate"],
    );
}

#[test]
fn unknown_fields_name_the_nearest() {
    fails(
        &with("thickness =", "thicknes ="),
        "thicknes ",
        "belt.thicknes",
        &["did you mean `thickness`?"],
    );
    fails(
        &with("points = 7", "pointz = 3"),
        "pointz",
        "contact.pointz",
        &["did you mean `points`?", "`stiffness`"],
    );
    fails(
        &with("inertia = 0.1", "inertia = 0.1\nmass = 3"),
        "mass",
        "pulley.driven.mass",
        &["one of `name`"],
    );
    fails(
        &with("end = 0.60 }", "end = 0.60, kid = 1 }"),
        "kid",
        "pulley.driver.speed.kid",
        &["`kind`"],
    );
    fails(
        &with("slope = 1.0e5", "slope = 1.0e5, velocity = 1"),
        "velocity",
        "contact.friction.velocity",
        &["`slope`"],
    );
    fails(
        &with("[run]", "[runs]"),
        "[runs]",
        "runs",
        &["did you mean `run`?"],
    );
}

#[test]
fn missing_fields_and_tables() {
    let text = with("radius = 0.08125\ninertia", "inertia");
    fails(
        &text,
        "[[pulley]]",
        "pulley.driven.radius",
        &["is missing", "a length", "81.25 mm"],
    );
    fails(
        &with("density", "# density"),
        "[belt]",
        "belt.density",
        &["`belt.density` is missing", "kg/m3"],
    );
    fails(
        &with("kind = \"ramp\", ", ""),
        "speed =",
        "pulley.driver.speed",
        &["does not say its `kind`", "half-cosine"],
    );
    fails(
        &with("to = 12.0, ", ""),
        "speed =",
        "pulley.driver.speed.to",
        &["is missing", "angular velocity"],
    );
    let errors = input::parse("bad.toml", "title = \"nothing\"", &[])
        .unwrap_err()
        .to_string();
    for part in [
        "the table `[belt]` is missing",
        "the table `[contact]` is missing",
        "there is no table `[[pulley]]`",
    ] {
        assert!(errors.contains(part), "{errors}");
    }
}

#[test]
fn wrong_types() {
    fails(
        &with("elements = 20", "elements = 20.5"),
        "20.5",
        "belt.elements",
        &["the number 20.5", "a whole number of at least 3"],
    );
    fails(
        &with("elements = 20", "elements = \"20\""),
        "\"20\"",
        "belt.elements",
        &["without quotes"],
    );
    fails(
        &with("width = \"10 mm\"", "width = true"),
        "width",
        "belt.width",
        &["cannot be true", "a length"],
    );
    fails(
        &with("width = \"10 mm\"", "width = 2024-01-01"),
        "width",
        "belt.width",
        &["a date", "a length"],
    );
    fails(
        &with("center = [0.191441, 0.0]", "center = [0.191441]"),
        "[0.191441]",
        "pulley.driven.center",
        &["a list of 2"],
    );
    fails(
        &with("name = \"driven\"", "name = 7"),
        "name = 7",
        "pulley.1.name",
        &["text in quotes"],
    );
    fails(
        &with("\"belt-beam\"", "\"belt-baem\""),
        "belt-baem",
        "belt.element",
        &["\"belt-beam\"", "did you mean"],
    );
    fails(
        &with("\"creep-rate\"", "\"coulom\""),
        "coulom",
        "contact.friction.law",
        &["did you mean \"coulomb\"?"],
    );
    fails(
        &with("[run]", "[run]\nstep = \"fast\""),
        "fast",
        "run.step",
        &["\"auto\"", "a time"],
    );
    fails(
        &with("torque = 0.0", "torque = [1.0]"),
        "[1.0]",
        "pulley.driven.torque",
        &["N m", "half-cosine"],
    );
    let text = "[pulley]\nname = \"one\"\n[belt]\n[contact]";
    let errors = input::parse("bad.toml", text, &[]).unwrap_err().to_string();
    assert!(
        errors.contains("bad.toml:1:1: `pulley` cannot be a table"),
        "{errors}"
    );
    assert!(errors.contains("write `[[pulley]]`"), "{errors}");
}

#[test]
fn wrong_or_missing_units() {
    let wrong = |unit: &str| with("width = \"10 mm\"", &format!("width = \"10 {unit}\""));
    fails(
        &wrong("N"),
        "10 N",
        "belt.width",
        &["a length", "`N` is a unit of force", "81.25 mm", "mm, µm"],
    );
    fails(
        &wrong("kg"),
        "10 kg",
        "belt.width",
        &["unknown unit `kg`", "units of length"],
    );
    fails(
        &wrong(""),
        "\"10 \"",
        "belt.width",
        &["without a unit", "write 10 without quotes for m", "cm"],
    );
    fails(
        &with("\"10 mm\"", "\"ten mm\""),
        "ten mm",
        "belt.width",
        &["start with a number"],
    );
    fails(
        &with("\"100 MPa\"", "\"100 mpa\""),
        "mpa",
        "belt.youngs_modulus",
        &["did you mean `MPa`?"],
    );
    fails(
        &with("to = 12.0", "to = \"12 rad\""),
        "12 rad\"",
        "pulley.driver.speed.to",
        &["`rad` is a unit of angle", "rpm"],
    );
    fails(
        &with("start = 0.05", "start = \"1 m\""),
        "1 m\"",
        "pulley.driver.speed.start",
        &["`m` is a unit of length"],
    );
    fails(
        &with("torque = 0.0", "torque = \"5 N\""),
        "5 N",
        "pulley.driven.torque",
        &["`N` is a unit of force"],
    );
    fails(
        &with("poisson_ratio = 0.3", "poisson_ratio = \"0.3\""),
        "poisson",
        "belt.poisson_ratio",
        &["a plain number"],
    );
}

#[test]
fn not_finite() {
    for number in ["nan", "inf", "-inf", "1e999", "\"1e999 m\""] {
        let text = with("thickness = \"10 mm\"", &format!("thickness = {number}"));
        let errors = input::parse("bad.toml", &text, &[]).unwrap_err();
        assert_eq!(errors.iter().count(), 1, "{errors}");
        let shown = errors.to_string();
        assert!(
            shown.starts_with("bad.toml:9:13: `belt.thickness`"),
            "{shown}"
        );
        assert!(
            shown.contains("finite") || shown.contains("too large"),
            "{shown}"
        );
    }
}

/// Every range, each broken from below or above.
#[test]
#[allow(clippy::too_many_lines)] // a table
fn out_of_range() {
    let cases = [
        (
            "elements = 20",
            "elements = 2",
            "belt.elements",
            "at least 3",
        ),
        (
            "elements = 20",
            "elements = -2",
            "belt.elements",
            "at least 3",
        ),
        (
            "elements = 20",
            "elements = 2000000",
            "belt.elements",
            "at most 100000",
        ),
        (
            "length = \"1.2727 m\"",
            "length = 0",
            "belt.length",
            "must be positive",
        ),
        (
            "length = \"1.2727 m\"",
            "length = \"-1 m\"",
            "belt.length",
            "must be positive, but is -1 m",
        ),
        (
            "length = \"1.2727 m\"",
            "tension = 0",
            "belt.tension",
            "must be positive",
        ),
        (
            "length = \"1.2727 m\"",
            "strain = \"-1 %\"",
            "belt.strain",
            "must be positive, but is -0.01",
        ),
        (
            "width = \"10 mm\"",
            "width = 0.0",
            "belt.width",
            "must be positive",
        ),
        (
            "thickness = \"10 mm\"",
            "thickness = -1",
            "belt.thickness",
            "must be positive",
        ),
        (
            "density = 1036.0",
            "density = 0",
            "belt.density",
            "must be positive",
        ),
        (
            "youngs_modulus = \"100 MPa\"",
            "youngs_modulus = 0",
            "belt.youngs_modulus",
            "must be positive",
        ),
        (
            "poisson_ratio = 0.3",
            "poisson_ratio = 0.5",
            "belt.poisson_ratio",
            "less than 0.5",
        ),
        (
            "poisson_ratio = 0.3",
            "poisson_ratio = -1",
            "belt.poisson_ratio",
            "greater than -1",
        ),
        (
            "axial_factor = 1.0",
            "axial_factor = 0",
            "belt.axial_factor",
            "must be positive",
        ),
        (
            "bending_factor = 0.01",
            "bending_factor = 0",
            "belt.bending_factor",
            "must be positive",
        ),
        (
            "poisson_ratio = 0.3",
            "damping_time = -1",
            "belt.damping_time",
            "must not be negative",
        ),
        (
            "stiffness = 1.0e7",
            "stiffness = 0",
            "contact.stiffness",
            "must be positive",
        ),
        (
            "damping = 10.0",
            "damping = -1",
            "contact.damping",
            "must not be negative",
        ),
        (
            "coefficient = 1.2",
            "coefficient = -1",
            "contact.friction.coefficient",
            "must not be negative",
        ),
        (
            "slope = 1.0e5",
            "slope = 0",
            "contact.friction.slope",
            "must be positive",
        ),
        ("points = 7", "points = 0", "contact.points", "at least 1"),
        (
            "radius = 0.08125\nspeed",
            "radius = 0\nspeed",
            "pulley.driver.radius",
            "must be positive",
        ),
        (
            "inertia = 0.1",
            "inertia = -0.1",
            "pulley.driven.inertia",
            "must not be negative",
        ),
        (
            "end_time = 1.5",
            "end_time = 0",
            "run.end_time",
            "must be positive",
        ),
        (
            "output_interval = 0.001",
            "output_interval = 0",
            "run.output_interval",
            "must be positive",
        ),
        (
            "accuracy = 1.0e-3",
            "accuracy = 0",
            "run.accuracy",
            "must be positive",
        ),
        (
            "accuracy = 1.0e-3",
            "accuracy = 0.2",
            "run.accuracy",
            "at most 0.1",
        ),
        (
            "accuracy = 1.0e-3",
            "step = 0",
            "run.step",
            "must be positive",
        ),
    ];
    for (old, new, field, part) in cases {
        let text = with(old, new);
        let errors = input::parse("bad.toml", &text, &[]).unwrap_err();
        let shown = errors.to_string();
        let at_line = format!("bad.toml:{}:", line_of(EXAMPLE, old));
        let found = errors.iter().any(|error| {
            error.problem.path.to_string() == field
                && error.to_string().starts_with(&at_line)
                && error.to_string().contains(part)
        });
        assert!(found, "{new}: {shown}");
    }
}

#[test]
fn tightness_is_said_once() {
    let text = with("width =", "tension = \"50 N\"\nwidth =");
    fails(
        &text,
        "tension = \"50 N\"\n".trim(),
        "belt.tension",
        &["`length`, `tension` are all given", "exactly one"],
    );
    fails(
        &with("length =", "# length ="),
        "[belt]",
        "belt",
        &["how tight", "`strain = 0.01`"],
    );
}

#[test]
fn pulleys() {
    let driven = &EXAMPLE[EXAMPLE.rfind("[[pulley]]").unwrap()..EXAMPLE.find("[run]").unwrap()];
    fails(
        &with(driven, ""),
        "# in the order",
        "pulley.0",
        &["`driver` is the only pulley", "at least two"],
    );
    let none = format!(
        "pulley = []\n{}",
        &EXAMPLE[..EXAMPLE.find("[[pulley]]").unwrap()]
    );
    fails(&none, "pulley = []", "pulley", &["the drive has no pulley"]);
    let closer = with("center = [0.191441, 0.0]", "center = [-0.05, 0.0]");
    fails(
        &closer,
        "[-0.05, 0.0]",
        "pulley.driven.center",
        &["`driver` and `driven` overlap", "0.1625 m apart"],
    );
    let undriven = with("speed = {", "inertia = 1.0\n#");
    fails(
        &undriven,
        "# in the order",
        "pulley",
        &["no pulley drives the belt", "720 rpm"],
    );
}

#[test]
fn belts_that_cannot_be_mounted() {
    // Path: twice the distance of the centres and once the circumference, 0.765764 + 0.510509 m.
    let length = |value: &str| with("\"1.2727 m\"", value);
    fails(
        &length("1.3"),
        "length = 1.3",
        "belt.length",
        &["too long", "0.023727 m less", "below 1.276273 m fits"],
    );
    fails(
        &length("0.5"),
        "length = 0.5",
        "belt.length",
        &["too short", "2.55 times", "above 0.638136 m fits"],
    );
    let strained = with("length = \"1.2727 m\"", "strain = \"150 %\"");
    fails(
        &strained,
        "strain = \"150 %\"",
        "belt.strain",
        &["too short", "2.50 times"],
    );
}

#[test]
fn paths_that_do_not_close() {
    let idler =
        "[[pulley]]\nname = \"idler\"\ncenter = [0.0, 0.0]\nradius = 0.05\ninertia = 1\n\n[run]";
    let within = with("[run]", idler);
    fails(
        &within,
        "[[pulley]]",
        "pulley.idler",
        &["does not touch", "wrap = \"inside\""],
    );
    let all_outside = EXAMPLE.replace("radius", "wrap = \"outside\"\nradius");
    fails(
        &all_outside,
        "# in the order",
        "pulley",
        &["every pulley has wrap = \"outside\""],
    );
}

#[test]
fn names() {
    let named = |name: &str| with("name = \"driven\"", &format!("name = {name:?}"));
    fails(
        &named("driver"),
        "name = \"driver\"",
        "pulley.1.name",
        &["two pulleys have the name \"driver\""],
    );
    for name in ["", "a.b", "a b", "a,b", "a\"b", "a\nb", "energy"] {
        let errors = input::parse("bad.toml", &named(name), &[])
            .unwrap_err()
            .to_string();
        assert!(
            errors.contains("cannot be the name of a pulley"),
            "{errors}"
        );
        assert!(errors.starts_with("bad.toml:29:8: "), "{errors}");
    }
    let mut drive: Drive = EXAMPLE.parse().unwrap();
    drive.pulley.extend(drive.pulley.clone());
    for (i, (pulley, name)) in drive
        .pulley
        .iter_mut()
        .zip(["a", "b-c", "a-b", "c"])
        .enumerate()
    {
        pulley.name = name.to_owned();
        pulley.center[1] = i as f64;
    }
    let problems = drive.validate();
    assert_eq!(problems.len(), 1, "{problems:#?}");
    assert!(problems[0].message.contains("\"a-b-c\""), "{}", problems[0]);
}

#[test]
fn motion_and_torque() {
    let both = with("speed =", "angle = 0.0\nspeed =");
    fails(
        &both,
        "angle = 0.0",
        "pulley.driver.angle",
        &["both a speed and an angle"],
    );
    let torque = with("speed =", "torque = \"1 N m\"\nspeed =");
    fails(
        &torque,
        "torque = \"1 N m\"",
        "pulley.driver.torque",
        &["a result"],
    );
    let light = with("inertia = 0.1", "");
    fails(
        &light,
        "[[pulley]]",
        "pulley.driven.inertia",
        &["no inertia", "a solid disc"],
    );
}

#[test]
fn profiles() {
    let table = |time: &str, value: &str| {
        with(
            "torque = 0.0",
            &format!("torque = {{ kind = \"table\", time = {time}, value = {value} }}"),
        )
    };
    fails(
        &table("[0, 2, 1]", "[0, 1, 2]"),
        "torque =",
        "pulley.driven.torque.time.2",
        &["1 s after 2 s", "increase"],
    );
    fails(
        &table("[0, 1, 1]", "[0, 1, 2]"),
        "torque =",
        "pulley.driven.torque.time.2",
        &["takes time"],
    );
    fails(
        &table("[0, 1]", "[0, 1, 2]"),
        "torque =",
        "pulley.driven.torque.value",
        &["2 times but 3 values"],
    );
    fails(
        &table("[]", "[]"),
        "torque =",
        "pulley.driven.torque.time",
        &["is empty"],
    );
    fails(
        &with("end = 0.60", "end = 0.05"),
        "end = 0.05",
        "pulley.driver.speed.end",
        &["after the `start`", "jump"],
    );
    fails(
        &with("end = 0.60", "end = 0.01"),
        "end = 0.01",
        "pulley.driver.speed.end",
        &["after the `start`"],
    );
}

#[test]
fn run_times() {
    let run = |line: &str| with("[run]", &format!("[run]\n{line}"));
    fails(
        &run("profile_times = [0.5, 9.0]"),
        "profile_times",
        "run.profile_times.1",
        &["9 s is outside", "1.5 s"],
    );
    fails(
        &run("step = 2.0"),
        "step = 2.0",
        "run.step",
        &["longer than the run"],
    );
    let interval = |value: &str| {
        with(
            "output_interval = 0.001",
            &format!("output_interval = {value}"),
        )
    };
    fails(
        &interval("2.0"),
        "output_interval",
        "run.output_interval",
        &["longer than the run"],
    );
    fails(
        &interval("1e-9"),
        "output_interval",
        "run.output_interval",
        &["1.5e9 rows"],
    );
}

#[test]
fn all_problems_at_once_in_the_order_of_the_file() {
    let text = with("width = \"10 mm\"", "width = \"10 kg\"")
        .replacen("slope = 1.0e5", "slop = -1", 1)
        .replacen("end_time = 1.5", "end_time = -1", 1);
    let errors = input::parse("bad.toml", &text, &[]).unwrap_err();
    let fields: Vec<_> = errors
        .iter()
        .map(|error| error.problem.path.to_string())
        .collect();
    assert_eq!(
        fields,
        ["belt.width", "contact.friction.slop", "run.end_time"]
    );
    let text = with("density = 1036.0", "density = -1")
        .replacen("inertia = 0.1", "", 1)
        .replacen("end = 0.60", "end = 0", 1);
    let errors = input::parse("bad.toml", &text, &[]).unwrap_err();
    let fields: Vec<_> = errors
        .iter()
        .map(|error| error.problem.path.to_string())
        .collect();
    assert_eq!(
        fields,
        [
            "belt.density",
            "pulley.driver.speed.end",
            "pulley.driven.inertia"
        ]
    );
}

#[test]
fn overrides() {
    let drive = with_overrides(&[
        "belt.elements=30",
        "belt.length=1.275 m",
        "pulley.driven.inertia = 0.2",
        "pulley.0.speed.to=\"720 rpm\"",
        "pulley.1.center.0=200 mm",
        "contact.friction={law=\"coulomb\", coefficient=0.5, velocity=\"1 mm/s\"}",
        "run.step=1e-4",
        "run.profile_times=[0.1, 0.2]",
        "title=A shorter one",
        "gravity=[0, \"-1 g0\"]",
    ]);
    assert_eq!(drive.belt.elements, 30);
    assert_eq!(drive.belt.length, Some(1.275));
    assert_eq!(drive.pulley[1].inertia, 0.2);
    assert!(
        (drive.pulley[0].speed.as_ref().unwrap().bound() - 24.0 * std::f64::consts::PI).abs()
            < 1e-12
    );
    assert_eq!(drive.pulley[1].center[0], 0.2);
    assert_eq!(drive.run.step, Step::Fixed(1e-4));
    assert_eq!(drive.run.profile_times, [0.1, 0.2]);
    assert_eq!(drive.title, "A shorter one");
    assert_eq!(drive.gravity, [0.0, -9.806_65]);
}

/// Of length, tension and strain one replaces the others of the file; so do speed and angle.
#[test]
fn overrides_replace_alternatives() {
    let drive = with_overrides(&["belt.tension=50 N", "pulley.driver.angle=0"]);
    assert_eq!((drive.belt.length, drive.belt.tension), (None, Some(50.0)));
    assert_eq!(
        (&drive.pulley[0].speed, &drive.pulley[0].angle),
        (&None, &Some(Profile::Constant(0.0)))
    );
    let both: Vec<Override> = ["belt.tension=50 N", "belt.strain=0.01"]
        .iter()
        .map(|text| text.parse().unwrap())
        .collect();
    let errors = input::parse("bad.toml", EXAMPLE, &both)
        .unwrap_err()
        .to_string();
    assert!(
        errors.starts_with("--set belt.strain=0.01: `tension`, `strain` are all given"),
        "{errors}"
    );
}

#[test]
fn overrides_that_fail() {
    override_fails("belt.elements", &["has no `=`", "KEY=VALUE"]);
    override_fails(
        "belt.elemnts=30",
        &[
            "there is no field `belt.elemnts`",
            "did you mean `elements`?",
        ],
    );
    override_fails(
        "bellt.elements=30",
        &["there is no field `bellt`", "did you mean `belt`?"],
    );
    override_fails(
        "pulley.drivn.inertia=1",
        &["there is no `pulley.drivn`", "did you mean `driven`?"],
    );
    override_fails(
        "pulley.2.inertia=1",
        &["there is no `pulley.2`", "`driver`, `driven`"],
    );
    override_fails(
        "pulley.driven.torque.to=1",
        &["`pulley.driven.torque` is the number 0", "as a whole"],
    );
    override_fails("belt.length.mm=1", &["there is no field `belt.length.mm`"]);
    override_fails(
        "belt.length=5 kg",
        &["--set belt.length=5 kg: `belt.length` has the unknown unit `kg`"],
    );
    override_fails("belt.length=-1", &["must be positive"]);
    override_fails("belt.elements=two", &["whole number"]);
    override_fails("=1", &["there is no field"]);
    override_fails(
        "run.profile_times=[9]",
        &["run.profile_times", "outside the run"],
    );
}

#[test]
fn programs_are_told_the_same() {
    let mut drive: Drive = EXAMPLE.parse().unwrap();
    drive.belt.width = f64::NAN;
    drive.pulley[1].radius = -1.0;
    drive.pulley[1].torque = Profile::Varying(Varying::Table {
        time: vec![0.0, 0.0],
        value: vec![1.0],
    });
    drive.belt.elements = usize::MAX;
    let problems = drive.validate();
    let fields: Vec<_> = problems
        .iter()
        .map(|problem| problem.path.to_string())
        .collect();
    for field in [
        "belt.width",
        "belt.elements",
        "pulley.driven.radius",
        "pulley.driven.torque.value",
        "pulley.driven.torque.time.1",
    ] {
        assert!(
            fields.iter().any(|found| found == field),
            "{field}: {problems:#?}"
        );
    }
}

#[test]
fn a_file_that_is_not_there() {
    let errors = input::load("no/such.toml".as_ref(), &[])
        .unwrap_err()
        .to_string();
    assert!(errors.contains("cannot read `no/such.toml`"), "{errors}");
}

#[test]
fn schema_documents_dimensions_and_defaults() {
    let schema = input::schema();
    let length = &schema["properties"]["belt"]["properties"]["length"];
    assert_eq!(length["x-quantity"], "length");
    assert_eq!(length["x-unit"], "m");
    assert_eq!(length["type"], serde_json::json!(["number", "string"]));
    assert_eq!(
        schema["properties"]["contact"]["properties"]["points"]["default"],
        7
    );
    let pulley = &schema["properties"]["pulley"]["items"];
    assert_eq!(
        pulley["required"],
        serde_json::json!(["name", "center", "radius"])
    );
    assert_eq!(pulley["properties"]["speed"]["anyOf"][0]["x-unit"], "rad/s");
}
