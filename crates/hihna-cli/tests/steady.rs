//! `hihna steady` as users and scripts see it.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

const MODEL_2: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../examples/string_model_2.toml"
);

fn steady(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hihna"))
        .current_dir(folder)
        .env("NO_COLOR", "1")
        .arg("steady")
        .args(arguments)
        .output()
        .unwrap()
}

/// Standard output and standard error of a call that must end with `status`.
fn told(folder: &Path, arguments: &[&str], status: i32) -> (String, String) {
    let output = steady(folder, arguments);
    assert_eq!(output.status.code(), Some(status), "{output:?}");
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (text(output.stdout), text(output.stderr))
}

/// The object of a successful call with `--json`.
fn object(folder: &Path, arguments: &[&str]) -> Value {
    let (stdout, _) = told(folder, &[arguments, &["--json"]].concat(), 0);
    serde_json::from_str(&stdout).unwrap()
}

fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("no number: {value}"))
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// The speed losses of Kerkkänen (2006), Figs 4.11, 4.14 and (4.48), in the table and in JSON: half
/// of the last digit.
#[test]
fn published_speed_losses() {
    let folder = TempDir::new().unwrap();
    let stiff = ["--set", "belt.youngs_modulus=250 MPa"];
    let cases: [(&[&str], &str, f64); 3] = [
        (&[], "Speed loss: 15.16 %", 0.1516),
        (&["--model", "capstan"], "Speed loss: 14.71 %", 0.1471),
        (&stiff, "Speed loss: 0.1596 %", 0.001_596),
    ];
    for (arguments, line, loss) in cases {
        let arguments = [&[MODEL_2], arguments].concat();
        let (table, warnings) = told(folder.path(), &arguments, 0);
        assert!(table.contains(line), "{table}");
        assert_eq!(warnings, "");
        let answer = object(folder.path(), &arguments);
        let found = number(&answer["steady"]["speed_loss"]);
        assert!((found - loss).abs() < 0.5e-3 * loss, "{found}");
        assert_eq!(answer["steady"]["pulley"]["driven"]["speed_loss"], found);
    }
    assert!(names(folder.path()).is_empty(), "nothing is written");
}

#[test]
fn the_table_has_everything_with_units() {
    let folder = TempDir::new().unwrap();
    let (table, _) = told(folder.path(), &[MODEL_2], 0);
    // Power of the load: 2 N m at 0.8484 of 500 rad/s. Both pulleys: 500 rad/s are 4775 rpm.
    for part in [
        "Model 2 of Table 4.1",
        "full inertia",
        "Friction coefficient 0.6; the slope of law `creep-rate` plays no part",
        "Axial stiffness 200.0 N, 0.02000 kg/m per unstretched length, 50.00 N at rest",
        "external torque",
        "slip",
        "stick",
        "180.00°",
        "hub force",
        "500.0 rad/s",
        "4775 rpm",
        "-2.000 N m",
        "driver-driven",
        "driven-driver",
        "tension",
        "belt speed",
        "25.00 m/s",
        "strain",
        "848.4 W out",
        "Efficiency: 84.84 %",
        "Safety against gross slip: ",
        "times the torques",
        "Largest torque: ",
    ] {
        assert!(table.contains(part), "{part}:\n{table}");
    }
}

/// Keys as in the summary of a run, and the balances between the numbers.
#[test]
fn the_object_is_consistent() {
    let folder = TempDir::new().unwrap();
    let answer = object(folder.path(), &[MODEL_2]);
    assert_eq!(answer["answer"], "running");
    assert_eq!(answer["model"]["theory"], "string");
    assert_eq!(answer["model"]["inertia"], "full");
    assert_eq!(answer["model"]["closure"], "length");
    let steady = &answer["steady"];
    for key in [
        "speed",
        "torque",
        "external_torque",
        "power",
        "slip_speed",
        "wrap_angle",
        "slip_angle",
        "stick_angle",
        "speed_loss",
        "friction_loss",
    ] {
        assert!(steady["pulley"]["driver"][key].is_f64(), "{key}");
    }
    let (driver, driven) = (&steady["pulley"]["driver"], &steady["pulley"]["driven"]);
    assert!((number(&driven["external_torque"]) + 2.0).abs() < 1.0e-10);
    assert!((number(&driven["slip_angle"]) + number(&driven["stick_angle"]) - PI).abs() < 1.0e-10);
    assert!(number(&driver["power"]) < 0.0 && number(&driven["power"]) > 0.0);
    // The torque is R times the difference of axial force less momentum flow.
    let pressing = |span: &str| number(&steady["span"][span]["pressing_tension"]);
    let torque = 0.05 * (pressing("driven-driver") - pressing("driver-driven"));
    assert!((torque - 2.0).abs() < 1.0e-10);
    let power = |key: &str| number(&steady[key]);
    assert!((power("power_in") - power("power_out") - power("power_lost")).abs() < 1.0e-8);
    assert!((power("efficiency") - power("power_out") / power("power_in")).abs() < 1.0e-12);
    assert!(
        number(&steady["span"]["driven-driver"]["tension"])
            > number(&steady["span"]["driver-driven"]["tension"])
    );
    let capacity = &answer["capacity"];
    assert!(number(&capacity["factor"]) > 1.0);
    assert!(
        (number(&capacity["torque"]["driven"]) + number(&capacity["largest_torque"])).abs()
            < 1.0e-9
    );
    assert!(
        (number(&capacity["largest_torque"]) - 2.0 * number(&capacity["factor"])).abs() < 1.0e-9
    );
}

#[test]
fn the_closure_can_be_the_tension_sum() {
    let folder = TempDir::new().unwrap();
    let answer = object(folder.path(), &[MODEL_2, "--closure", "tension-sum"]);
    let span = &answer["steady"]["span"];
    let sum = number(&span["driver-driven"]["tension"]) + number(&span["driven-driver"]["tension"]);
    assert!((sum - 100.0).abs() < 1.0e-9);
    assert_eq!(answer["model"]["closure"], "tension-sum");
}

/// The built-in drive has no load: equal tensions, no power, and the largest load that it could have.
#[test]
fn the_built_in_drive_idles() {
    let folder = TempDir::new().unwrap();
    let answer = object(folder.path(), &[]);
    let steady = &answer["steady"];
    assert_eq!(answer["answer"], "running");
    assert_eq!(answer["capacity"], Value::Null);
    assert_eq!(steady["efficiency"], Value::Null);
    assert!(number(&steady["speed_loss"]).abs() < 1.0e-15);
    assert_eq!(
        steady["span"]["driver-driven"]["tension"],
        steady["span"]["driven-driver"]["tension"]
    );
    let largest = number(&answer["largest_load"]["driven"]);
    assert!(answer["largest_load"]["driver"].is_null());
    // Just below and just above it.
    for (factor, expected) in [(0.999, "running"), (1.001, "gross-slip")] {
        let torque = format!("pulley.driven.torque={}", -factor * largest);
        let answer = object(folder.path(), &["--set", &torque]);
        assert_eq!(answer["answer"], expected);
    }
    let (table, _) = told(folder.path(), &[], 0);
    for part in [
        "12.00 rad/s",
        "no torque is transmitted",
        " 0.00°",
        "as the only load",
        "Efficiency: none",
    ] {
        assert!(table.contains(part), "{part}:\n{table}");
    }
}

#[test]
fn gross_slip_is_an_answer() {
    let folder = TempDir::new().unwrap();
    let arguments = [MODEL_2, "--set", "pulley.driven.torque=-4"];
    let answer = object(folder.path(), &arguments);
    assert_eq!(answer["answer"], "gross-slip");
    assert!(answer["steady"].is_null());
    let slip = &answer["gross_slip"];
    assert!(["driver", "driven"].contains(&slip["pulley"].as_str().unwrap()));
    assert!((number(&slip["wrap_angle"]) - PI).abs() < 1.0e-12);
    let capacity = &answer["capacity"];
    assert!(number(&capacity["factor"]) < 1.0);
    assert!(
        (number(&capacity["largest_torque"]) - 4.0 * number(&capacity["factor"])).abs() < 1.0e-9
    );
    let (words, _) = told(folder.path(), &arguments, 0);
    for part in ["Gross slip on pulley", "Largest torque: ", "N m"] {
        assert!(words.contains(part), "{part}:\n{words}");
    }
    assert!(!words.contains("Efficiency"), "{words}");
    // A little too much torque: so and so many degrees beyond the wrap.
    let little = format!(
        "pulley.driven.torque={}",
        -1.001 * number(&capacity["largest_torque"])
    );
    let arguments = [MODEL_2, "--set", &little];
    let slip = &object(folder.path(), &arguments)["gross_slip"];
    assert!(number(&slip["slip_angle"]) > PI);
    assert!((number(&slip["excess_angle"]) + PI - number(&slip["slip_angle"])).abs() < 1.0e-12);
    let (words, _) = told(folder.path(), &arguments, 0);
    assert!(words.contains("degrees of slip"), "{words}");
}

/// At 3000 rad/s a belt of 0.02 kg/m would need far more than 50 N to stay on the pulleys.
#[test]
fn slack_is_an_answer() {
    let folder = TempDir::new().unwrap();
    let arguments = [
        MODEL_2,
        "--set",
        "belt.youngs_modulus=250 MPa",
        "--set",
        "pulley.driver.speed=3000",
        "--set",
        "pulley.driven.torque=0",
    ];
    let answer = object(folder.path(), &arguments);
    assert_eq!(answer["answer"], "slack");
    let slack = &answer["slack"];
    assert!(number(&slack["needed_tension"]) > number(&slack["tension"]));
    let (words, _) = told(folder.path(), &arguments, 0);
    assert!(words.contains("The belt is slack"), "{words}");
}

#[test]
fn out_writes_a_whole_folder() {
    let folder = TempDir::new().unwrap();
    let (table, _) = told(folder.path(), &[MODEL_2, "--out", "here"], 0);
    assert!(table.contains("Results: here"), "{table}");
    assert_eq!(names(folder.path()), ["here"], "nothing else is left");
    let here = folder.path().join("here");
    assert_eq!(names(&here), ["drive.toml", "profile.csv", "summary.json"]);
    let profile = fs::read_to_string(here.join("profile.csv")).unwrap();
    assert_eq!(
        profile.lines().next().unwrap(),
        "time,material_coordinate,x,y,z,tension,element_tension,strain_green,strain_engineering,strain_true,\
         strain_almansi,jacobian,speed,normal_force,friction_force,slip_speed,pulley"
    );
    assert!(profile.lines().count() > 400);
    // The drive as written gives the same answer.
    let written: Value =
        serde_json::from_str(&fs::read_to_string(here.join("summary.json")).unwrap()).unwrap();
    assert_eq!(object(folder.path(), &["here/drive.toml"]), written);
    // Kept unless forced; a drive that slips has no profile.
    let again = [
        MODEL_2,
        "--out",
        "here",
        "--set",
        "pulley.driven.torque=-40",
    ];
    let (_, message) = told(folder.path(), &again, 2);
    assert!(message.contains("--force"), "{message}");
    assert_eq!(names(&here).len(), 3);
    told(folder.path(), &[&again[..], &["--force"]].concat(), 0);
    assert_eq!(names(&here), ["drive.toml", "summary.json"]);
    assert_eq!(names(folder.path()), ["here"], "nothing else is left");
}

#[test]
fn bad_input_is_named_with_what_to_change() {
    let folder = TempDir::new().unwrap();
    let example = fs::read_to_string(MODEL_2).unwrap();
    let speed = "speed = { kind = \"ramp\", from = 0.0, to = 500.0, start = 0.0, end = 0.5 }";
    assert!(example.contains(speed));
    let none = example.replacen(speed, "inertia = 0.1", 1);
    let angle = example.replacen(
        speed,
        "angle = { kind = \"ramp\", to = 500.0, end = 1.0 }",
        1,
    );
    let angle = angle.replacen("ramp\", to", "ramp\", from = 0.0, start = 0.0, to", 1);
    fs::write(folder.path().join("none.toml"), none).unwrap();
    fs::write(folder.path().join("angle.toml"), angle).unwrap();
    let cases: [(&[&str], &str, &[&str]); 7] = [
        (
            &["none.toml"],
            "pulley",
            &["no pulley drives the belt", "speed"],
        ),
        (
            &["angle.toml"],
            "pulley.driver.angle",
            &["\"driver\"", "driven by its `angle`", "give its `speed`"],
        ),
        (
            &[
                MODEL_2,
                "--set",
                "pulley.driven.speed=400",
                "--set",
                "pulley.driven.torque=0",
            ],
            "pulley.driven.speed",
            &["\"driver\" and \"driven\"", "exactly one"],
        ),
        (
            &[MODEL_2, "--set", "pulley.driver.torque=1"],
            "pulley.driver.torque",
            &["prescribed motion and a torque", "remove `torque`"],
        ),
        (
            &[MODEL_2, "--set", "pulley.driver.speed=0"],
            "pulley.driver.speed",
            &["0 rad/s", "one that turns"],
        ),
        (
            &[MODEL_2, "--set", "belt.tension=-5"],
            "belt.tension",
            &["belt.tension"],
        ),
        (
            &[MODEL_2, "--set", "contact.friction.coefficient=-0.6"],
            "contact.friction.coefficient",
            &["coefficient"],
        ),
    ];
    for (arguments, field, parts) in cases {
        let (stdout, message) = told(folder.path(), arguments, 2);
        assert_eq!(stdout, "");
        for part in parts {
            assert!(message.contains(part), "{part}:\n{message}");
        }
        let (stdout, _) = told(folder.path(), &[arguments, &["--json"]].concat(), 2);
        let errors: Value = serde_json::from_str(&stdout).unwrap();
        assert_eq!(errors["errors"][0]["field"], field);
        let place = &errors["errors"][0];
        let known = place["file"].is_string() && number(&place["line"]) >= 1.0;
        assert!(known || field == "pulley", "{place}");
    }
}

/// What only the theory finds wrong is shown at its line of the file, as other errors are.
#[test]
fn what_the_theory_refuses_is_shown_at_its_line() {
    let folder = TempDir::new().unwrap();
    let example = fs::read_to_string(MODEL_2).unwrap();
    let speed = "speed = { kind = \"ramp\", from = 0.0, to = 500.0, start = 0.0, end = 0.5 }";
    let cases = [
        (speed, "speed = 0.0", "speed = 0.0", "one that turns"),
        (
            speed,
            "angle = { kind = \"ramp\", from = 0.0, to = 9.0, start = 0.0, end = 1.0 }",
            "angle = ",
            "give its `speed`",
        ),
        // Finite numbers whose product is not.
        (
            "youngs_modulus = \"2 MPa\"",
            "youngs_modulus = 1.0e308\naxial_factor = 1.0e9",
            "youngs_modulus = 1.0e308",
            "axial stiffness",
        ),
    ];
    for (old, new, at, message) in cases {
        assert!(example.contains(old));
        let text = example.replacen(old, new, 1);
        let file = folder.path().join("drive.toml");
        fs::write(&file, &text).unwrap();
        let line = text.lines().position(|line| line.contains(at)).unwrap() + 1;
        let (_, shown) = told(folder.path(), &["drive.toml"], 2);
        assert!(shown.contains(&format!("drive.toml:{line}:")), "{shown}");
        assert!(shown.contains(at) && shown.contains(message), "{shown}");
        let (stdout, _) = told(folder.path(), &["drive.toml", "--json"], 2);
        let errors: Value = serde_json::from_str(&stdout).unwrap();
        assert_eq!(errors["errors"][0]["line"], line);
    }
}

/// Half of a percent more load against the derivative by the load: the second-order term is below a
/// percent of the change. Elasticities are derivatives times value by result.
#[test]
fn sensitivities_predict_a_changed_drive() {
    let folder = TempDir::new().unwrap();
    let arguments = [
        MODEL_2,
        "--sensitivity",
        "pulley.driven.torque,belt.tension",
    ];
    let answer = object(folder.path(), &arguments);
    let fields = &answer["sensitivity"];
    assert_eq!(fields.as_object().unwrap().len(), 2);
    let load = &fields["pulley.driven.torque"];
    assert_eq!(
        (number(&load["value"]), &load["unit"]),
        (-2.0, &"N m".into())
    );
    let moved = object(
        folder.path(),
        &[MODEL_2, "--set", "pulley.driven.torque=-2.01"],
    );
    for (name, path) in [
        ("pulley.driven.speed", ["pulley", "driven", "speed"]),
        (
            "span.driven-driver.tension",
            ["span", "driven-driver", "tension"],
        ),
    ] {
        let result = &load["results"][name];
        let at = |answer: &Value| {
            path.iter()
                .fold(answer["steady"].clone(), |v, key| v[key].clone())
        };
        let (before, after) = (number(&at(&answer)), number(&at(&moved)));
        assert_eq!(result["value"], at(&answer));
        let predicted = -0.01 * number(&result["derivative"]);
        assert!(
            (after - before - predicted).abs() < 0.01 * predicted.abs(),
            "{name}"
        );
        let elasticity = -2.0 * number(&result["derivative"]) / before;
        assert!((number(&result["elasticity"]) / elasticity - 1.0).abs() < 1.0e-12);
    }
    let (table, _) = told(folder.path(), &arguments, 0);
    for part in [
        "by pulley.driven.torque = -2.000 N m",
        "by belt.tension = 50.00 N",
        "elasticity",
        "efficiency",
    ] {
        assert!(table.contains(part), "{part}:\n{table}");
    }
    // A drive that slips has none, and says so; a key that plays no part is named.
    let slips = [&arguments[..], &["--set", "pulley.driven.torque=-40"]].concat();
    let (_, warning) = told(folder.path(), &slips, 0);
    assert!(warning.contains("no sensitivities"), "{warning}");
    let (_, message) = told(
        folder.path(),
        &[MODEL_2, "--sensitivity", "belt.tensoin"],
        2,
    );
    assert!(
        message.contains("did you mean `belt.tension`?"),
        "{message}"
    );
}

#[test]
fn bad_arguments_have_status_two() {
    let folder = TempDir::new().unwrap();
    let cases: [&[&str]; 5] = [
        &["--model", "fem"],
        &["--closure", "none"],
        &["--force"],
        &["no-such-file.toml"],
        &["--out", "no/such/folder"],
    ];
    for arguments in cases {
        let (_, message) = told(folder.path(), arguments, 2);
        assert!(!message.is_empty(), "{arguments:?}");
    }
    assert!(names(folder.path()).is_empty());
}

#[test]
fn gravity_is_said_to_play_no_part() {
    let folder = TempDir::new().unwrap();
    let (_, message) = told(folder.path(), &["--set", "gravity=[0.0, -9.81]"], 0);
    assert!(message.contains("gravity plays no part"), "{message}");
}

/// The finite elements: the same answers as a time run writes, and the capacity.
#[test]
fn finite_elements() {
    let folder = TempDir::new().unwrap();
    let load = [
        "--set",
        "pulley.driven.torque=-1",
        "--set",
        "contact.friction.coefficient=0.3",
    ];
    let fe = ["--model", "fe", "--set", "belt.elements=120"];
    let found = object(
        folder.path(),
        &[&fe[..], &load, &["--out", "result"]].concat(),
    );
    assert_eq!(found["answer"], "running");
    let speed = number(&found["steady"]["pulley"]["driven"]["speed"]);
    assert!((speed - 11.98242).abs() < 1.0e-5, "{speed}");
    let safety = number(&found["capacity"]["factor"]);
    assert!(safety > 1.9 && safety < 2.0, "{safety}");
    assert_eq!(found["audit"]["passed"], true);
    assert_eq!(
        names(&folder.path().join("result")),
        ["drive.toml", "profile.csv", "summary.json"]
    );
    let (table, _) = told(folder.path(), &[&fe[..], &load].concat(), 0);
    for part in [
        "120 graded elements",
        "Power residual",
        "Safety against gross slip",
    ] {
        assert!(table.contains(part), "{part}: {table}");
    }
    let slips = object(
        folder.path(),
        &[&fe[..], &["--set", "pulley.driven.torque=-20"]].concat(),
    );
    assert_eq!(slips["answer"], "gross-slip");
    assert!(slips["steady"].is_null());
    assert!(number(&slips["gross_slip"]["overload"]) > 1.0);
    let (_, message) = told(
        folder.path(),
        &[&fe[..], &["--set", "pulley.driver.speed=0"]].concat(),
        2,
    );
    assert!(message.contains("needs one that turns"), "{message}");
}

/// A map: rows in the order of the axes, the same numbers in CSV and JSON, a Parquet file beside them; elasticities and modes of a
/// running drive.
#[test]
fn maps_sensitivities_and_modes_of_finite_elements() {
    let folder = TempDir::new().unwrap();
    let fe = [
        "--model",
        "fe",
        "--set",
        "belt.elements=30",
        "--set",
        "contact.friction.coefficient=0.3",
    ];
    let map = [
        "--map",
        "pulley.driven.torque=-0.5:-3:3",
        "--map",
        "pulley.driver.speed=6:12:2",
    ];
    let found = object(folder.path(), &[&fe[..], &map, &["--out", "map"]].concat());
    let answers: Vec<_> = (found["rows"].as_array().unwrap().iter())
        .map(|row| row["answer"].as_str().unwrap())
        .collect();
    assert_eq!(answers[..4], ["running"; 4]);
    assert_eq!(answers[4..], ["gross-slip"; 2]);
    assert_eq!(
        names(&folder.path().join("map")),
        ["drive.toml", "map.csv", "map.parquet", "summary.json"]
    );
    let summary = fs::read_to_string(folder.path().join("map/summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    let axes = &summary["map"]["axes"];
    assert_eq!(axes[0]["key"], "pulley.driven.torque");
    assert_eq!(axes[0]["unit"], "N m");
    assert_eq!(axes[1]["values"], serde_json::json!([6.0, 12.0]));
    assert_eq!(summary["map"]["answers"]["gross-slip"], 2);
    assert_eq!(summary["columns"], found["columns"]);
    let csv = fs::read_to_string(folder.path().join("map/map.csv")).unwrap();
    let mut lines = csv.lines();
    let header: Vec<_> = lines.next().unwrap().split(',').collect();
    assert_eq!(
        header[..3],
        ["answer", "pulley.driven.torque", "pulley.driver.speed"]
    );
    let second: Vec<_> = lines.nth(1).unwrap().split(',').collect();
    assert_eq!(second[..3], ["running", "-0.5", "12"]);
    let parquet = fs::read(folder.path().join("map/map.parquet")).unwrap();
    assert!(parquet.starts_with(b"PAR1") && parquet.ends_with(b"PAR1"));

    let load = ["--set", "pulley.driven.torque=-1"];
    let asked = ["--sensitivity", "belt.youngs_modulus", "--modes", "3"];
    let found = object(folder.path(), &[&fe[..], &load, &asked].concat());
    let results = &found["sensitivity"]["belt.youngs_modulus"]["results"];
    let elasticity = number(&results["span.driver-driven.tension"]["elasticity"]);
    assert!(elasticity > 0.5 && elasticity < 1.5, "{elasticity}");
    let modes = found["modes"].as_array().unwrap();
    let frequencies: Vec<_> = modes
        .iter()
        .map(|mode| number(&mode["frequency"]))
        .collect();
    assert_eq!(frequencies.len(), 3);
    assert!(frequencies.is_sorted(), "{frequencies:?}");

    for wrong in [
        &["--map", "pulley.driven.torque=0:1"][..],
        &["--map", "pulley.driven.torqe=0:1:2"],
        &["--map", "pulley.driven.torque=0:1:0"],
        &["--sensitivity", "belt.element"],
    ] {
        let (_, message) = told(folder.path(), &[&fe[..], wrong].concat(), 2);
        assert!(message.contains("help"), "{wrong:?}: {message}");
    }
    told(folder.path(), &["--modes", "3"], 2);
}

/// A Campbell diagram: one row a speed, the modes in the order of the first; `--quiet` keeps words back and data not.
#[test]
fn campbell_diagrams_and_quiet_answers() {
    let folder = TempDir::new().unwrap();
    let fe = ["--model", "fe", "--set", "belt.elements=30"];
    let asked = ["--modes", "2", "--map", "pulley.driver.speed=12:24:3"];
    let (csv, _) = told(folder.path(), &[&fe[..], &asked].concat(), 0);
    let rows: Vec<Vec<_>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(
        rows[0][..3],
        ["answer", "pulley.driver.speed", "mode_1.frequency"]
    );
    assert_eq!((rows.len(), rows[0].len()), (4, 12));
    for (row, speed) in rows[1..].iter().zip(["12", "18", "24"]) {
        assert_eq!(row[..2], ["running", speed]);
        let first: f64 = row[2].parse().unwrap();
        assert!(first > 1.0 && first < 100.0, "{first} Hz");
    }
    // A value without an answer does not spoil the others.
    let from_rest = ["--modes", "1", "--map", "speed=0:12:2"];
    let (csv, _) = told(folder.path(), &[&fe[..], &from_rest].concat(), 0);
    let answers: Vec<_> = csv.lines().skip(1).map(|row| &row[..7]).collect();
    assert_eq!(answers, ["none,0,", "running"]);
    let at_rest = ["--modes", "1", "--map", "speed=0:0:1"];
    told(folder.path(), &[&fe[..], &at_rest].concat(), 2);
    let quiet = [&fe[..], &asked, &["--quiet", "--out", "here"]].concat();
    assert_eq!(told(folder.path(), &quiet, 0).0, "");
    assert_eq!(
        names(&folder.path().join("here")),
        ["campbell.csv", "drive.toml", "summary.json"]
    );
    assert_eq!(
        told(folder.path(), &[&fe[..], &["--quiet"]].concat(), 0).0,
        ""
    );
    assert_eq!(told(folder.path(), &["--quiet"], 0).0, "");

    let two = ["--map", "belt.width=0.01:0.02:2"];
    let (_, message) = told(folder.path(), &[&fe[..], &asked, &two].concat(), 2);
    assert!(message.contains("help"), "{message}");
    let frictionless = ["--set", "contact.friction.coefficient=0"];
    let (_, message) = told(folder.path(), &[&fe[..], &frictionless].concat(), 2);
    assert!(message.contains("no friction on pulley"), "{message}");
    let trapezoidal = ["--set", "contact.integration=trapezoidal"];
    let (_, message) = told(folder.path(), &[&fe[..], &trapezoidal].concat(), 0);
    assert!(
        message.contains("plays no part in steady running"),
        "{message}"
    );
}

/// Values that a drive cannot have and maps that are too large are told before anything is solved; points without an answer, and
/// drives without any, with the reason.
#[test]
fn what_maps_refuse() {
    let folder = TempDir::new().unwrap();
    let fe = ["--model", "fe", "--set", "belt.elements=30", "--map"];
    let cases: [(&[&str], &str); 6] = [
        (&["torque=0:1:1000000000000"], "more than 1000000"),
        (&["torque=-1:-2:1001", "speed=6:12:1001"], "1002001 points"),
        (&["belt.width=-0.01:0.01:3"], "must be positive"),
        (&["belt.poisson_ratio=0.3:0.7:3"], "must be less than 0.5"),
        (
            &["torque=-1:-2:2", "pulley.driven.torque=-3:-4:2"],
            "two ranges",
        ),
        (&["belt.width"], "no `=`; a drive file goes before"),
    ];
    for (map, part) in cases {
        let (_, message) = told(folder.path(), &[&fe[..], map].concat(), 2);
        assert!(message.contains(part), "{map:?}: {message}");
    }
    let overlapping = ["torque=-1:-2:2", "pulley.driven.radius=0.08125:0.4:2"];
    let (csv, warning) = told(folder.path(), &[&fe[..], &overlapping].concat(), 0);
    let answers: Vec<_> = (csv.lines().skip(1))
        .map(|row| row.split(',').next().unwrap())
        .collect();
    assert_eq!(answers, ["running", "none", "running", "none"]);
    for part in ["2 of 4 points", "pulley.driven.radius = 0.4 m", "overlap"] {
        assert!(warning.contains(part), "{part}: {warning}");
    }
    let spatial = ["speed=6:12:2", "--set", "belt.element=belt-beam-3d"];
    let (_, message) = told(folder.path(), &[&fe[..], &spatial].concat(), 2);
    assert!(message.contains("planar elements only"), "{message}");
    let example = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../examples/three_pulleys.toml"
    );
    let two = [&[example], &fe[..], &["torque=-1:-2:2"]].concat();
    let (_, message) = told(folder.path(), &two, 2);
    assert!(message.contains("`pulley.idler.torque`"), "{message}");
}
