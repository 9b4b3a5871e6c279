//! Bad input: each class of mistake is told with file, line, field, expectation and help; good input is
//! read in full, with units and overrides. Messages are compared as plain parts, so that wording can grow.

// Numbers that are read must be exact.
#![allow(clippy::float_cmp)]

mod fields;
mod overrides;
mod properties;
mod rules;
mod spatial;

use hihna::drive::{AutoStep, Drive, Step};
use hihna::input::{self, Override};
use hihna::profile::{Profile, Varying};

const EXAMPLE: &str = include_str!("../../../../examples/two_pulley.toml");

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
