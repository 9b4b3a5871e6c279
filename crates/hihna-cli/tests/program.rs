//! The program as users and scripts see it: exit status, what goes to standard output and standard
//! error, and what is on the disk afterwards.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use hihna::drive::Drive;
use serde_json::Value;
use tempfile::TempDir;

const EXAMPLE: &str = include_str!("../../../examples/two_pulley.toml");
/// A run that is over in an instant.
const SHORT: [&str; 6] = [
    "--set",
    "run.end_time=0.004",
    "--set",
    "belt.elements=8",
    "--set",
    "contact.points=3",
];

fn program(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hihna"));
    command.current_dir(folder).env("NO_COLOR", "1");
    command
}

fn hihna(folder: &TempDir, arguments: &[&str]) -> Output {
    program(folder.path()).args(arguments).output().unwrap()
}

fn status(output: &Output) -> i32 {
    output
        .status
        .code()
        .unwrap_or_else(|| panic!("no exit status: {output:?}"))
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

/// Names of all that is in a folder.
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// The one JSON object on standard output.
fn answer(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {output:?}"))
}

/// The status says whether the audit passed, as `summary.json` does.
fn assert_status_follows_audit(output: &Output, summary: &Value) {
    let expected = i32::from(summary["audit"]["passed"] != true);
    assert_eq!(status(output), expected, "{output:?}");
}

#[test]
fn a_run_leaves_a_whole_folder_and_one_object() {
    let folder = TempDir::new().unwrap();
    let output = hihna(&folder, &[&["run", "--json"], SHORT.as_slice()].concat());
    let answer = answer(&output);
    assert_status_follows_audit(&output, &answer);
    assert_eq!(answer["folder"], "two_pulley-result");
    assert_eq!(
        names(folder.path()),
        ["two_pulley-result"],
        "nothing else is left"
    );
    let result = folder.path().join("two_pulley-result");
    assert_eq!(
        names(&result),
        ["drive.toml", "history.csv", "profile.csv", "summary.json"]
    );
    let written: Value =
        serde_json::from_str(&fs::read_to_string(result.join("summary.json")).unwrap()).unwrap();
    for key in ["title", "model", "start", "end", "steady", "audit"] {
        assert_eq!(written[key], answer[key], "{key}");
    }
    let drive: Drive = fs::read_to_string(result.join("drive.toml"))
        .unwrap()
        .parse()
        .unwrap();
    assert_eq!((drive.belt.elements, drive.run.end_time), (8, 0.004));
}

#[test]
fn the_summary_is_in_words() {
    let folder = TempDir::new().unwrap();
    let output = hihna(
        &folder,
        &[&["run", "--out", "here"], SHORT.as_slice()].concat(),
    );
    for part in [
        "Two-pulley drive of Table 3.1",
        "rad/s",
        "tension",
        "slip",
        "Power:",
        "Audit:",
        "Results: here",
    ] {
        assert!(text(&output.stdout).contains(part), "{part}: {output:?}");
    }
    // Eight elements are few, and the program says how many would do.
    assert!(
        text(&output.stderr).contains("use at least 15 elements"),
        "{output:?}"
    );
    let quiet = hihna(&folder, &[&["run", "--quiet"], SHORT.as_slice()].concat());
    assert_eq!(text(&quiet.stdout), "");
}

/// `--verbose` adds what the solver did; logs go to standard error, so that `--json` stays one object.
#[test]
fn the_solver_tells_what_it_does_if_asked() {
    let folder = TempDir::new().unwrap();
    let verbose = [&["run", "--verbose", "--out", "a"], SHORT.as_slice()].concat();
    let output = hihna(&folder, &verbose);
    for part in [
        "force evaluations",
        "factorizations",
        "processor, stepping alone",
    ] {
        assert!(text(&output.stdout).contains(part), "{part}: {output:?}");
    }
    for part in ["settled", "stepping", "done"] {
        assert!(text(&output.stderr).contains(part), "{part}: {output:?}");
    }
    let json = [&["run", "--json", "--out", "b"], SHORT.as_slice()].concat();
    let output = program(folder.path())
        .env("RUST_LOG", "hihna=info")
        .args(&json)
        .output()
        .unwrap();
    assert!(answer(&output)["solver"]["steps"].is_u64());
    assert!(text(&output.stderr).contains("settled"), "{output:?}");
    let both = hihna(&folder, &["run", "--quiet", "--verbose"]);
    assert_eq!(status(&both), 2);
}

/// The page and ParaView's files stand in the folder, and one more run may replace it all.
#[test]
fn reports_and_frames_are_part_of_the_folder() {
    let folder = TempDir::new().unwrap();
    let here = folder.path().join("two_pulley-result");
    for force in [&[][..], &["--force"]] {
        let arguments = [&["run", "--quiet", "--report", "--vtk"], &SHORT[..], force].concat();
        assert_eq!(status(&hihna(&folder, &arguments)), 0);
        let all = names(&here);
        for name in ["belt.pvd", "belt_00000.vtu", "frames.csv", "report.html"] {
            assert!(all.iter().any(|found| found == name), "{name}: {all:?}");
        }
    }
    let page = fs::read_to_string(here.join("report.html")).unwrap();
    assert!(page.contains("Two-pulley drive of Table 3.1"));
    fs::remove_file(here.join("report.html")).unwrap();
    let output = hihna(&folder, &["report", "two_pulley-result"]);
    assert_eq!(status(&output), 0);
    assert!(text(&output.stdout).contains("report.html"));
    assert_eq!(fs::read_to_string(here.join("report.html")).unwrap(), page);
}

#[test]
fn a_report_needs_results() {
    let folder = TempDir::new().unwrap();
    let output = hihna(&folder, &["report", "nowhere"]);
    assert_eq!(status(&output), 2);
    assert!(
        text(&output.stderr).contains("nowhere/drive.toml"),
        "{output:?}"
    );
    fs::create_dir(folder.path().join("odd")).unwrap();
    fs::write(folder.path().join("odd/drive.toml"), EXAMPLE).unwrap();
    fs::write(folder.path().join("odd/summary.json"), "{}").unwrap();
    fs::write(folder.path().join("odd/profile.csv"), "time\n").unwrap();
    fs::write(
        folder.path().join("odd/history.csv"),
        "time,driver.speed\n0.0,x\n",
    )
    .unwrap();
    let output = hihna(&folder, &["report", "odd"]);
    assert_eq!(status(&output), 2);
    assert!(text(&output.stderr).contains("history.csv"), "{output:?}");
    // Numbers that were not found and columns that are missing leave gaps, not failures.
    fs::write(
        folder.path().join("odd/history.csv"),
        "time,driver.speed\n0.0,\n",
    )
    .unwrap();
    assert_eq!(status(&hihna(&folder, &["report", "odd"])), 0);
}

#[test]
fn an_existing_folder_is_kept_unless_forced() {
    let folder = TempDir::new().unwrap();
    let result = folder.path().join("two_pulley-result");
    fs::create_dir(&result).unwrap();
    fs::write(result.join("mine"), "precious").unwrap();
    let output = hihna(&folder, &[&["run"], SHORT.as_slice()].concat());
    assert_eq!(status(&output), 2);
    assert!(text(&output.stderr).contains("--force"), "{output:?}");
    assert_eq!(names(&result), ["mine"]);
    let forced = [&["run", "--force", "--json"], SHORT.as_slice()].concat();
    let output = hihna(&folder, &forced);
    assert_eq!(status(&output), 2, "what is not a result is kept");
    assert_eq!(names(&result), ["mine"]);
    fs::rename(result.join("mine"), result.join("summary.json")).unwrap();
    let output = hihna(&folder, &forced);
    assert_status_follows_audit(&output, &answer(&output));
    assert!(names(&result).contains(&"history.csv".to_owned()));
    assert_eq!(
        names(folder.path()),
        ["two_pulley-result"],
        "nothing else is left"
    );
}

#[test]
fn a_folder_that_cannot_be_written_is_told_before_the_run() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    for place in ["file/result", "no/such/folder"] {
        // A run so long that only a check before it can end this test.
        let output = hihna(
            &folder,
            &[
                "run",
                "--out",
                place,
                "--set",
                "run.end_time=1e3",
                "--set",
                "run.output_interval=1",
            ],
        );
        assert_eq!(status(&output), 2, "{output:?}");
        assert!(text(&output.stderr).contains(place), "{output:?}");
    }
    assert_eq!(names(folder.path()), ["file"]);
}

#[test]
fn bad_input_points_at_the_line() {
    let folder = TempDir::new().unwrap();
    let bad = EXAMPLE
        .replacen("width = \"10 mm\"", "width = \"10 kg\"", 1)
        .replacen("points", "pionts", 1);
    fs::write(folder.path().join("bad.toml"), bad).unwrap();
    for command in ["run", "check"] {
        let output = hihna(&folder, &[command, "bad.toml"]);
        assert_eq!(status(&output), 2);
        assert_eq!(text(&output.stdout), "");
        for part in [
            "bad.toml:8:9",
            "`belt.width`",
            "unknown unit `kg`",
            "81.25 mm",
            "bad.toml:20:1",
            "did you mean `points`?",
        ] {
            assert!(text(&output.stderr).contains(part), "{part}: {output:?}");
        }
        let output = hihna(&folder, &[command, "bad.toml", "--json"]);
        assert_eq!(status(&output), 2);
        let errors = &answer(&output)["errors"];
        assert_eq!(errors.as_array().map(Vec::len), Some(2));
        assert_eq!(errors[0]["field"], "belt.width");
        assert_eq!(errors[0]["line"], 8);
        assert_eq!(errors[1]["field"], "contact.pionts");
    }
    assert_eq!(names(folder.path()), ["bad.toml"]);
}

#[test]
fn bad_arguments_have_status_two() {
    let folder = TempDir::new().unwrap();
    let cases: [&[&str]; 7] = [
        &[],
        &["rum"],
        &["run", "--sett", "a=b"],
        &["run", "--set", "belt.elements"],
        &["run", "--set", "belt.elemnts=30"],
        &["run", "no-such-file.toml"],
        &["completions", "no-such-shell"],
    ];
    for arguments in cases {
        let output = hihna(&folder, arguments);
        assert_eq!(status(&output), 2, "{arguments:?}: {output:?}");
        assert!(!output.stderr.is_empty(), "{arguments:?}");
    }
    assert!(names(folder.path()).is_empty());
}

/// Numbers: path = 2 * 0.382882 m + 2 pi * 0.08125 m; the tension by E A (f² - 1) f / 2 at f = path / length.
#[test]
fn check_prints_the_layout() {
    let folder = TempDir::new().unwrap();
    let output = hihna(&folder, &["check"]);
    assert_eq!(status(&output), 0);
    for part in [
        "1.276273 m",
        "0.2807 %",
        "28.19 N",
        "180.00°",
        "255.3 mm",
        "382.9 mm",
        "prescribed speed",
    ] {
        assert!(text(&output.stdout).contains(part), "{part}: {output:?}");
    }
    assert_eq!(text(&output.stderr), "");
    // The centre line lies half of the thickness further out: pi times 10 mm more path.
    let output = hihna(&folder, &["check", "--set", "contact.surface=face"]);
    assert!(text(&output.stdout).contains("1.307689 m"), "{output:?}");
    // A hundredth of the stiffness leaves a seventh of the tension.
    let output = hihna(&folder, &["check", "--set", "contact.stiffness=1e5"]);
    let warned = text(&output.stderr);
    assert!(
        warned.contains("3.955 N of tension, 28.19 N on rigid pulleys"),
        "{output:?}"
    );
    let fan = "pulley.driven.load={ law = \"fan\", torque = 1.0, speed = 12.0 }";
    let output = hihna(&folder, &["check", "--set", fan]);
    assert!(
        text(&output.stdout).contains("free, with torque"),
        "{output:?}"
    );
    let output = hihna(&folder, &["check", "--json", "--set", "belt.strain=1 %"]);
    assert_eq!(status(&output), 0);
    let answer = answer(&output);
    assert!((answer["strain"].as_f64().unwrap() - 0.01).abs() < 1e-12);
    assert!(
        (answer["span"]["driver-driven"]["length"].as_f64().unwrap() - 0.382_882).abs() < 1e-12
    );
    assert!(
        (answer["pulley"]["driven"]["wrap_angle"].as_f64().unwrap() - std::f64::consts::PI).abs()
            < 1e-12
    );
    assert!(names(folder.path()).is_empty());
}

#[test]
fn schema_and_completions() {
    let folder = TempDir::new().unwrap();
    let schema = answer(&hihna(&folder, &["schema"]));
    assert_eq!(
        schema["properties"]["belt"]["properties"]["width"]["x-unit"],
        "m"
    );
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let output = hihna(&folder, &["completions", shell]);
        assert_eq!(status(&output), 0);
        assert!(text(&output.stdout).contains("hihna"), "{shell}");
    }
}

/// `hihna schema | head -1` is no failure.
#[test]
fn a_reader_may_leave_early() {
    let folder = TempDir::new().unwrap();
    let mut child = program(folder.path())
        .arg("schema")
        .stdout(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    assert!(child.wait().unwrap().success());
}

/// Signals that a process catches, as Linux tells.
#[cfg(target_os = "linux")]
fn caught(process: u32) -> u64 {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
    u64::from_str_radix(caught.unwrap_or("0").trim(), 16).unwrap_or(0)
}

/// Ctrl-C or a request to terminate while a long run steps: status 1, a word about it, and nothing on the disk. The test
/// waits until Linux says that the program catches the signal.
#[test]
#[cfg(target_os = "linux")]
fn ctrl_c_stops_cleanly() {
    for (name, number) in [("-INT", 2), ("-TERM", 15)] {
        let folder = TempDir::new().unwrap();
        let child = program(folder.path())
            .args([
                "run",
                "--json",
                "--set",
                "run.end_time=1e4",
                "--set",
                "run.output_interval=1",
            ])
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        while caught(child.id()) & (1 << (number - 1)) == 0 {
            std::thread::yield_now();
        }
        assert!(
            Command::new("kill")
                .args([name, &child.id().to_string()])
                .status()
                .unwrap()
                .success()
        );
        let output = child.wait_with_output().unwrap();
        assert_eq!(status(&output), 1, "{output:?}");
        assert!(
            text(&output.stderr).contains("nothing was written"),
            "{output:?}"
        );
        let message = answer(&output)["errors"][0]["message"].to_string();
        assert!(message.contains("stopped at t ="), "{message}");
        assert!(names(folder.path()).is_empty());
    }
}

/// A map of steady running that is interrupted leaves nothing: its folder is begun when there is something to write.
#[test]
#[cfg(target_os = "linux")]
fn an_interrupted_map_leaves_nothing() {
    let folder = TempDir::new().unwrap();
    let mut child = program(folder.path())
        .args([
            "steady",
            "--model",
            "fe",
            "--map",
            "pulley.driven.torque=-0.5:-3:100000",
            "--out",
            "map",
        ])
        .spawn()
        .unwrap();
    // It has begun to compute when it has used the processor for a tenth of a second: fourteenth field of its statistics.
    let used = || {
        let fields = fs::read_to_string(format!("/proc/{}/stat", child.id())).unwrap();
        let after_name = fields.rsplit(')').next().unwrap();
        after_name
            .split_whitespace()
            .nth(11)
            .unwrap()
            .parse::<u64>()
            .unwrap()
    };
    while used() < 10 {
        std::thread::yield_now();
    }
    let killed = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(killed.unwrap().success());
    assert!(!child.wait().unwrap().success());
    assert!(
        names(folder.path()).is_empty(),
        "{:?}",
        names(folder.path())
    );
}

/// Where a file may not grow, or the disk is full, the run fails with a word about it, and neither a folder nor half of one
/// is left; nor is half a page left by `report`. The shell's limit is in blocks of at most 1 KiB.
#[test]
#[cfg(unix)]
fn files_that_may_not_grow_leave_nothing() {
    let folder = TempDir::new().unwrap();
    let limited = |blocks: u32, arguments: &str| {
        let script = format!(
            "ulimit -f {blocks}; exec {} {arguments}",
            env!("CARGO_BIN_EXE_hihna")
        );
        let mut shell = Command::new("sh");
        shell.current_dir(folder.path()).args(["-c", &script]);
        shell.output().unwrap()
    };
    let short = SHORT.join(" ");
    // profile.csv of 24 points takes some kilobytes.
    let output = limited(2, &format!("run --out here {short}"));
    assert_eq!(status(&output), 1, "{output:?}");
    assert!(text(&output.stderr).contains("cannot write"), "{output:?}");
    assert!(
        names(folder.path()).is_empty(),
        "{:?}",
        names(folder.path())
    );
    let whole = hihna(
        &folder,
        &[&["run", "--quiet", "--out", "here"], &SHORT[..]].concat(),
    );
    assert!(status(&whole) < 2, "{whole:?}");
    let before = names(&folder.path().join("here"));
    // The page takes some megabytes.
    let output = limited(100, "report here");
    assert_eq!(status(&output), 1, "{output:?}");
    assert!(text(&output.stderr).contains("report.html"), "{output:?}");
    assert_eq!(names(&folder.path().join("here")), before);
}

/// A Campbell diagram's folder is one of results: `--force` replaces it.
#[test]
fn a_campbell_diagram_may_be_replaced() {
    let folder = TempDir::new().unwrap();
    let arguments = [
        "steady",
        "--model",
        "fe",
        "--set",
        "pulley.driven.torque=-1",
        "--modes",
        "1",
        "--map",
        "pulley.driver.speed=10:12:2",
        "--out",
        "modes",
    ];
    assert_eq!(status(&hihna(&folder, &arguments)), 0);
    let again = hihna(&folder, &[&arguments[..], &["--force"]].concat());
    assert_eq!(status(&again), 0, "{again:?}");
    assert_eq!(names(folder.path()), ["modes"]);
}

/// `--until steady` ends a run before its time, and the drive written says so; what no run can start from is an error at its line.
#[test]
fn runs_from_and_to_steady_running() {
    let folder = TempDir::new().unwrap();
    let running = [
        "--set",
        "pulley.driver.speed=12",
        "--set",
        "run.start=steady",
    ];
    let short = [
        "run",
        "--json",
        "--out",
        "here",
        "--until",
        "steady",
        "--set",
        "belt.elements=20",
    ];
    let output = hihna(&folder, &[&short[..], &running].concat());
    assert!(output.status.success(), "{output:?}");
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found["settling"]["reached"], true, "{found}");
    let end = found["end"]["time"].as_f64().unwrap();
    assert!(end < 1.5, "{end}");
    let drive: Drive = fs::read_to_string(folder.path().join("here/drive.toml"))
        .unwrap()
        .parse()
        .unwrap();
    assert_eq!(drive.run.until, hihna::drive::Until::Steady);

    let output = hihna(
        &folder,
        &["run", "--out", "there", "--set", "run.start=steady"],
    );
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    let told = text(&output.stderr);
    assert!(told.contains("is at rest at time zero"), "{told}");
}
