//! A result folder holds what the run found, and gives it back.

// What is read is to be what was written.
#![allow(clippy::float_cmp)]

use hihna::frames;
use hihna::input;
use hihna::record::{self, Options, Results};
use hihna::simulate::{Flow, simulate};
use hihna::summary::Summary;

const BASE: &str = include_str!("../../../examples/two_pulley.toml");

fn drive(changes: &[&str]) -> hihna::drive::Drive {
    let changes: Vec<_> = changes.iter().map(|c| c.parse().unwrap()).collect();
    input::parse("two_pulley.toml", BASE, &changes).unwrap()
}

/// What is read is what was written, number by number; frames come at their times, the last one at the end.
#[test]
fn a_folder_is_read_back() {
    let drive = drive(&[
        "run.end_time=0.1",
        "run.frame_start=0.02",
        "run.frame_interval=0.03",
        "belt.elements=12",
    ]);
    let outcome = simulate(&drive, &mut |_| Flow::Continue).unwrap();
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("result");
    record::write(&folder, &drive, &outcome, Options::default()).unwrap();

    let results = Results::read(&folder).unwrap();
    assert_eq!(results.drive, drive);
    assert_eq!(results.history, outcome.history);
    assert_eq!(results.profile, outcome.profile);
    assert_eq!(results.frames, outcome.frames);
    let summary = serde_json::to_value(Summary::new(&drive, &outcome)).unwrap();
    assert_eq!(results.summary, summary);
    let tension = results.number(&["steady", "span", "driver-driven", "tension"]);
    assert_eq!(
        Some(tension),
        summary["steady"]["span"]["driver-driven"]["tension"].as_f64()
    );
    assert!(
        results
            .number(&["steady", "span", "nowhere", "tension"])
            .is_nan()
    );

    let mut times: Vec<f64> = results.frames.iter().map(|row| row.time).collect();
    times.dedup();
    let expected = [0.02, 0.05, 0.08, 0.1];
    assert_eq!(times.len(), expected.len());
    for (time, expected) in times.iter().zip(expected) {
        assert!((time - expected).abs() < 1e-15, "{time}");
    }
    // The last frame is the profile, which is taken at the end.
    assert!(results.frames.ends_with(&results.profile));
}

/// ParaView's files come with the frames, and a folder that holds them is one of results: it may be overwritten.
#[test]
fn frames_for_paraview_are_results() {
    let drive = drive(&[
        "run.end_time=0.01",
        "run.frame_interval=0.005",
        "belt.elements=12",
    ]);
    let outcome = simulate(&drive, &mut |_| Flow::Continue).unwrap();
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("result");
    for _ in 0..2 {
        let options = Options {
            overwrite: true,
            vtk: true,
        };
        record::write(&folder, &drive, &outcome, options).unwrap();
        for name in ["belt.pvd", "belt_00000.vtu", "pulleys_00002.vtu"] {
            assert!(folder.join(name).exists(), "{name}");
        }
    }
}

#[test]
fn between_rows_the_history_is_linear() {
    let drive = drive(&["run.end_time=0.2", "belt.elements=12"]);
    let outcome = simulate(&drive, &mut |_| Flow::Continue).unwrap();
    let at = |time: f64| outcome.history.at("driver.speed", time).unwrap();
    // The driver's ramp is 12 rad/s in 0.55 s from 0.05 s on: linear itself.
    for time in [0.06, 0.0755, 0.1999] {
        assert!(
            (at(time) - 12.0 * (time - 0.05) / 0.55).abs() < 1e-9,
            "{time}"
        );
    }
    assert_eq!(at(-1.0), 0.0);
    assert_eq!(at(9.0), at(0.2));
    assert_eq!(outcome.history.at("nothing", 0.1), None);
}

/// A slow drive is shown whole; of a fast one the end, at a turn of a quarter of a radian between frames.
#[test]
fn frames_are_chosen_so_that_the_eye_can_follow() {
    let mut slow = drive(&[]);
    frames::choose(&mut slow);
    assert_eq!(slow.run.frame_start, 0.0);
    assert!((slow.run.frame_interval.unwrap() - 1.5 / 240.0).abs() < 1e-12);

    let mut fast = drive(&["pulley.driver.speed.to=600"]);
    frames::choose(&mut fast);
    let interval = fast.run.frame_interval.unwrap();
    assert!((interval * 600.0 - 0.25).abs() < 1e-12);
    assert!((fast.run.end_time - fast.run.frame_start - 240.0 * interval).abs() < 1e-12);

    let mut stated = drive(&["run.frame_interval=0.1"]);
    let before = stated.clone();
    frames::choose(&mut stated);
    assert_eq!(stated, before);
}

#[test]
fn too_many_frames_are_refused() {
    for (change, field) in [
        ("run.frame_interval=1e-9", "frame_interval"),
        ("run.frame_interval=0", "frame_interval"),
        ("run.frame_start=2", "frame_start"),
        ("run.frame_start=-1", "frame_start"),
    ] {
        let errors = input::parse("two_pulley.toml", BASE, &[change.parse().unwrap()]).unwrap_err();
        assert!(errors.to_string().contains(field), "{change}: {errors}");
    }
}
