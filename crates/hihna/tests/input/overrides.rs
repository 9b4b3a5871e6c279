//! Overrides from the command line.

use super::*;

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
        "gravity.1=-9.81",
        &["no `gravity`", "a list of 2", "--set 'gravity=[...]'"],
    );
    override_fails(
        "run.profile_times=[9]",
        &["run.profile_times", "outside the run"],
    );
}
