//! Mistakes in single fields: syntax, names, kinds, units and ranges.

use super::*;

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
    assert_eq!(errors.matches("bad.toml:1:1").count(), 3, "{errors}");
}

#[test]
fn wrong_types() {
    fails(
        &with("elements = 20", "elements = 20.5"),
        "20.5",
        "belt.elements",
        &["the number 20.5", "a whole number from 3 to 100000"],
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
        // Three per cent was meant.
        (
            "name = \"driver\"",
            "irregularity = [{ order = 2, amplitude = 3 }]\nname = \"driver\"",
            "pulley.driver.irregularity.0.amplitude",
            "must be less than 1, but is 3",
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
