//! Runs that begin in steady running (`run.start = "steady"`) and runs that end in it (`run.until = "steady"`).

use hihna::drive::Drive;
use hihna::layout::Layout;
use hihna::simulate::{Flow, NoSteadyStart, Outcome, RunError, simulate};
use hihna::steady::running::{Answer, Running, solve};
use hihna::summary::Summary;

const BASE: &str = include_str!("../../../examples/two_pulley.toml");
const LOADED: &str = include_str!("../../../examples/figures_3_10_to_3_20.toml");
const PHASES: usize = 8;

fn drive(text: &str, changes: &[&str]) -> Drive {
    let overrides: Vec<_> = (changes.iter())
        .map(|change| change.parse().expect("an override"))
        .collect();
    hihna::input::parse("drive.toml", text, &overrides).expect("a valid drive")
}

fn run(drive: &Drive) -> Outcome {
    simulate(drive, &mut |_| Flow::Continue).expect("the drive runs")
}

/// Steady running of a mesh of equal elements, shifted along the path by parts of an element.
fn at_phases(drive: &Drive) -> Vec<Running> {
    let path = Layout::of(drive).expect("a path").length;
    let element = path / drive.belt.elements as f64;
    (0..PHASES)
        .map(|phase| {
            let mut shifted = drive.clone();
            shifted.belt.first_node = element * phase as f64 / PHASES as f64;
            match solve(&shifted).expect("it is solved").answer {
                Answer::Running(running) => *running,
                other => panic!("{other:?}"),
            }
        })
        .collect()
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}

/// Without a run-up the drive stays where it begins. Tensions swing as the elements pass the ends of the arcs, by the range that steady
/// running has over the phases of the mesh and, being driven, by half of it beyond; speeds keep a tenth of the run's accuracy (from
/// rest they would swing by 0.4 rad/s). The balances close from the first step on.
#[test]
fn stays_in_steady_running() {
    let still = [
        "run.start=\"steady\"",
        "steady.mesh=uniform",
        "belt.elements=60",
        "run.profile_times=[]",
    ];
    for (text, changes) in [
        (
            BASE,
            &[
                "pulley.driver.speed=12",
                "pulley.driven.torque=-1",
                "contact.friction.coefficient=0.3",
                "run.end_time=0.3",
            ][..],
        ),
        (
            LOADED,
            &[
                "pulley.driver.speed=120",
                "pulley.driven.torque=-10",
                "run.end_time=0.1",
            ],
        ),
    ] {
        let drive = drive(text, &[&still[..], changes].concat());
        let outcome = run(&drive);
        assert!(outcome.audit.passed(), "{:?}", outcome.audit);
        let phases = at_phases(&drive);
        let column = |name: &str| outcome.history.column(name).expect("a column");
        for (s, name) in ["driver-driven", "driven-driver"].iter().enumerate() {
            let (low, high) = range(phases.iter().map(|running| running.spans[s].tension));
            let beyond = 0.5 * (high - low);
            let (least, most) = range(column(&format!("{name}.tension")).into_iter());
            assert!(
                least > low - beyond && most < high + beyond,
                "{changes:?}: {name} {least}..{most} N beside {low}..{high} N"
            );
        }
        let mean = phases.iter().map(|r| r.pulleys[1].speed).sum::<f64>() / PHASES as f64;
        let (slowest, fastest) = range(column("driven.speed").into_iter());
        let allowed = 0.1 * drive.run.accuracy * mean;
        assert!(
            slowest > mean - allowed && fastest < mean + allowed,
            "{changes:?}: {slowest}..{fastest} beside {mean} rad/s"
        );
    }
}

/// Profiles count by their values at time zero, a driving angle by its rate; a belt with a joint of its own starts as one without.
#[test]
fn values_of_time_zero() {
    let common = [
        "run.start=\"steady\"",
        "run.end_time=0.002",
        "belt.elements=30",
        "pulley.driven.torque={kind=\"ramp\", from=-0.5, to=-1.0, start=0.001, end=0.1}",
    ];
    let first = |more: &[&str]| {
        let outcome = run(&drive(BASE, &[&common[..], more].concat()));
        ["driven.speed", "driven-driver.tension", "driver.speed"]
            .map(|name| outcome.history.column(name).expect("a column")[0])
    };
    let constant = first(&["pulley.driver.speed=12"]);
    let ramp = "pulley.driver.speed={kind=\"ramp\", from=12, to=20, start=0.001, end=0.5}";
    assert_eq!(first(&[ramp]).map(f64::to_bits), constant.map(f64::to_bits));
    let joined = first(&["pulley.driver.speed=12", "belt.joint=multipliers"]);
    for (a, b) in joined.iter().zip(constant) {
        assert!((a - b).abs() < 1.0e-9 * b, "{a} {b}");
    }
    let by_angle = BASE.replace(
        "speed = { kind = \"ramp\", from = 0.0, to = 12.0, start = 0.05, end = 0.60 }",
        "angle = { kind = \"table\", time = [0.0, 10.0], value = [0.0, 120.0] }",
    );
    let outcome = run(&drive(&by_angle, &common));
    let speed = outcome.history.column("driven.speed").expect("a column")[0];
    assert!((speed - constant[0]).abs() < 1.0e-9 * speed, "{speed}");
}

/// What a drive whose run cannot begin in steady running is told.
fn refusal(changes: &[&str]) -> NoSteadyStart {
    let changes = [changes, &["run.start=\"steady\"", "run.end_time=0.01"]].concat();
    match simulate(&drive(BASE, &changes), &mut |_| Flow::Continue) {
        Err(RunError::SteadyStart(refused)) => *refused,
        other => panic!("{changes:?}: {:?}", other.map(|_| "it ran")),
    }
}

#[test]
fn refusals() {
    assert_eq!(
        refusal(&[]),
        NoSteadyStart::AtRest {
            pulley: "driver".into()
        }
    );
    let running = "pulley.driver.speed=12";
    let NoSteadyStart::GrossSlip { overload } = refusal(&[
        running,
        "pulley.driven.torque=-3",
        "contact.friction.coefficient=0.3",
        "belt.elements=40",
    ]) else {
        panic!("it grips");
    };
    assert!(overload > 1.0);
    let bristles = "contact.friction={law=\"elastic-plastic\", coefficient=0.5, stiffness=1e8}";
    assert!(matches!(
        refusal(&[running, bristles]),
        NoSteadyStart::Remembers { .. }
    ));
    let damped = refusal(&[running, "belt.damping_time=1e-3"]).to_string();
    assert!(damped.contains("`damping_time` of 0.001 s"), "{damped}");
}

/// A run that may last ends when its means have settled, with what it settles to: the steady state of the same mesh, within twice its own
/// scatter. One that has no time for that says so.
#[test]
fn ends_when_settled() {
    let changes = [
        "run.until=\"steady\"",
        "run.end_time=10",
        "belt.elements=60",
    ];
    let drive = drive(BASE, &[&changes[..], &["steady.mesh=uniform"]].concat());
    let outcome = run(&drive);
    let summary = Summary::new(&drive, &outcome);
    let settling = summary.settling.expect("watched");
    assert!(settling.reached && settling.time < 5.0, "{settling:?}");
    assert!(settling.change.expect("two windows") <= settling.tolerance);
    let last = outcome.history.rows().next_back().expect("a row")[0];
    assert!((settling.time - last).abs() < 0.01 && outcome.profile[0].time >= last);
    let phases = at_phases(&drive);
    let mean = |of: &dyn Fn(&Running) -> f64| phases.iter().map(of).sum::<f64>() / PHASES as f64;
    let pulley = (
        &summary.steady.pulley.0[1].1,
        &summary.scatter.pulley.0[1].1,
    );
    let off = pulley.0.speed - mean(&|r| r.pulleys[1].speed);
    assert!(off.abs() <= 2.0 * pulley.1.speed, "{off} rad/s");
    let span = (&summary.steady.span.0[0].1, &summary.scatter.span.0[0].1);
    let off = span.0.tension - mean(&|r| r.spans[0].tension);
    assert!(off.abs() <= 2.0 * span.1.tension, "{off} N");

    let short = self::drive(BASE, &["run.until=\"steady\"", "run.end_time=0.7"]);
    let summary = Summary::new(&short, &run(&short));
    assert!(!summary.settling.expect("watched").reached);
    let warned = summary
        .warnings
        .iter()
        .any(|w| w.contains("before its means settled"));
    assert!(warned, "{:?}", summary.warnings);
}
