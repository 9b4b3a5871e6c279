//! Mistakes that involve several fields.

use super::*;

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

/// With its centre line on the pulley a belt of 0.17 m reaches beyond the axis of 0.08125 m; with its face there
/// is room, and the path is longer by 2 pi times half of the thickness.
#[test]
fn belts_too_thick_for_a_pulley() {
    let thick = |more: &str| {
        with("thickness = \"10 mm\"", "thickness = 0.17")
            .replace("points = 7", &format!("points = 7\n{more}"))
    };
    let errors = input::parse("bad.toml", &thick(""), &[])
        .unwrap_err()
        .to_string();
    assert_eq!(
        errors.matches("too thick for `pulley.").count(),
        2,
        "{errors}"
    );
    assert!(errors.contains("a radius above 0.085 m"), "{errors}");
    let fits = thick("surface = \"face\"").replace("\"1.2727 m\"", "\"1.8 m\"");
    assert!(input::parse("good.toml", &fits, &[]).is_ok());
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
    // Once for all that a short run leaves outside.
    let many = run("profile_times = [0.5, 2.0, 3.0, 4.0]");
    fails(
        &many,
        "profile_times",
        "run.profile_times.1",
        &["3 profile times are outside", "the first of them 2 s"],
    );
    let errors = input::parse("bad.toml", &many, &[])
        .unwrap_err()
        .to_string();
    assert_eq!(errors.matches("outside").count(), 1, "{errors}");
    fails(
        &run("step = 1e-15"),
        "step = 1e-15",
        "run.step",
        &["1.5e15 steps", "at least 1.5e-9 s"],
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
