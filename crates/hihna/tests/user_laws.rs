//! Laws that the program running a drive states itself: laws of the library stated again give the same run.

use std::sync::Arc;

use ancf::scalar::Scalar;
use hihna::drive::Drive;
use hihna::friction::{ByDifferences, FrictionLaw, Law, Slip, Stated, StatedFriction};
use hihna::history::History;
use hihna::input;
use hihna::load::{self, TorqueLaw};
use hihna::simulate::{Flow, Outcome, RunError, nominal_speed, simulate, simulate_with};
use hihna::user_laws::{UserLawError, UserLaws};
use num_dual::Dual64;

const COEFFICIENT: f64 = 0.6;
const VELOCITY: f64 = 0.1;
const COULOMB: &str = "contact.friction={ law = \"coulomb\", coefficient = 0.6, velocity = 0.1 }";

/// The library's Coulomb law in plain numbers, its operations in the same order.
#[derive(Debug)]
struct Coulomb;

impl StatedFriction for Coulomb {
    fn develop(&self, slip_velocity: f64, normal: f64) -> (f64, [f64; 2]) {
        let ratio = slip_velocity * (1.0 / VELOCITY);
        let (part, slope) = if 1.0 - ratio.abs() > 0.0 {
            (ratio, normal * (COEFFICIENT / VELOCITY))
        } else {
            (ratio.signum(), 0.0)
        };
        (part * normal * COEFFICIENT, [slope, part * COEFFICIENT])
    }

    fn steepest_damping(&self, normal: f64) -> f64 {
        COEFFICIENT * normal / VELOCITY
    }
}

/// A fan of 0.2 N m at 10 rad/s.
#[derive(Debug)]
struct Fan;

impl TorqueLaw for Fan {
    fn at(&self, _: f64, speed: f64) -> (f64, f64) {
        let part = speed / 10.0;
        (-0.2 * part * part.abs(), -2.0 * 0.2 * part.abs() / 10.0)
    }
}

/// The law that knows no numbers.
#[derive(Debug)]
struct Nothing;

impl StatedFriction for Nothing {
    fn develop(&self, _: f64, _: f64) -> (f64, [f64; 2]) {
        (f64::NAN, [f64::NAN; 2])
    }
}

fn drive(text: &str, changes: &[&str]) -> Drive {
    let changes: Vec<_> = changes.iter().map(|c| c.parse().unwrap()).collect();
    input::parse("drive", text, &changes).unwrap()
}

/// The built-in drive, run up at once.
fn two_pulleys(changes: &[&str]) -> Drive {
    let mut all = vec![
        "belt.elements=12",
        "run.end_time=0.06",
        "pulley.driver.speed={ kind = \"ramp\", from = 0.0, to = 6.0, start = 0.0, end = 0.05 }",
    ];
    all.extend(changes);
    drive(include_str!("../../../examples/two_pulley.toml"), &all)
}

/// `law` on every pulley.
fn everywhere(drive: &Drive, law: &Arc<dyn StatedFriction>) -> UserLaws {
    (drive.pulley.iter()).fold(UserLaws::default(), |laws, pulley| {
        laws.with_friction(&pulley.name, Arc::clone(law))
    })
}

fn run(drive: &Drive) -> Outcome {
    simulate(drive, &mut |_| Flow::Continue).unwrap()
}

fn run_with(drive: &Drive, laws: &UserLaws) -> Result<Outcome, RunError> {
    simulate_with(drive, laws, &mut |_| Flow::Continue)
}

fn assert_same(ours: &History, theirs: &History) {
    assert_eq!(ours.columns(), theirs.columns());
    assert!(ours.len() > 1 && ours.len() == theirs.len());
    for (ours, theirs) in ours.rows().zip(theirs.rows()) {
        assert_eq!(ours, theirs);
    }
}

/// The same operations in the same order: the same run to the last bit, by the implicit and the explicit
/// integrator, which asks the law how steep it is. The stated law replaces another of the drive.
#[test]
fn a_library_law_stated_again_gives_the_same_run() {
    for integrator in ["run.integrator=\"auto\"", "run.integrator=\"runge-kutta\""] {
        let short = "run.end_time=0.02";
        let own = run(&two_pulleys(&[COULOMB, integrator, short]));
        let replaced = two_pulleys(&[integrator, short]);
        let stated = run_with(&replaced, &everywhere(&replaced, &(Arc::new(Coulomb) as _)));
        assert_same(&stated.unwrap().history, &own.history);
        let creep = run(&replaced);
        assert_ne!(
            creep.history.column("driven.torque"),
            own.history.column("driven.torque"),
            "the laws differ: the comparison says something"
        );
    }
}

/// The same in space, with friction in both directions of the surface.
#[test]
fn plates_take_stated_laws() {
    let text = include_str!("../../../examples/plate_model_1.toml");
    let short = ["run.end_time=0.002", "contact.friction_directions=\"both\""];
    let own = run(&drive(text, &[short[0], short[1], COULOMB]));
    let replaced = drive(text, &short);
    let laws = everywhere(&replaced, &(Arc::new(Coulomb) as _));
    assert_same(&run_with(&replaced, &laws).unwrap().history, &own.history);
}

/// A law known by its force alone ends on the same motion: other tangents change what Newton's method leaves over,
/// at most its tolerance (2e-7 of the nominal speed, theory of time integration) in every step. The steps are the same.
#[test]
fn differences_only_change_the_way() {
    let step = "run.step=1e-4";
    let own = run(&two_pulleys(&[COULOMB, step]));
    let drive = two_pulleys(&[step]);
    let force = |v: f64, n: f64| COEFFICIENT * n * (v / VELOCITY).clamp(-1.0, 1.0);
    let laws = everywhere(&drive, &(Arc::new(ByDifferences(force)) as _));
    let stated = run_with(&drive, &laws).unwrap();
    let most = 2.0e-7 * nominal_speed(&drive) / drive.pulley[1].radius;
    let steps = stated.statistics.steps.max(own.statistics.steps);
    let speed = |outcome: &Outcome| outcome.history.column("driven.speed").unwrap();
    for (ours, theirs) in speed(&stated).iter().zip(speed(&own)) {
        assert!(
            (ours - theirs).abs() <= most * steps as f64,
            "{ours} {theirs}"
        );
    }
    assert_eq!(stated.audit.passed(), own.audit.passed());
}

/// A fan stated again, and one known by its torque alone: of second degree, so its difference is exact to rounding.
#[test]
fn a_load_stated_again_gives_the_same_run() {
    let own = run(&two_pulleys(&[
        "pulley.driven.load={ law = \"fan\", torque = 0.2, speed = 10.0 }",
    ]));
    let drive = two_pulleys(&["pulley.driven.torque=-3.0"]);
    let laws = UserLaws::default().with_torque("driven", Arc::new(Fan));
    assert_same(&run_with(&drive, &laws).unwrap().history, &own.history);

    let by_differences = load::ByDifferences(|_: f64, speed: f64| Fan.at(0.0, speed).0);
    for speed in [-20.0, -3.0, 0.5, 11.0] {
        let (torque, slope) = by_differences.at(0.3, speed);
        let (exact, exact_slope) = Fan.at(0.3, speed);
        assert_eq!(torque.to_bits(), exact.to_bits());
        assert!((slope - exact_slope).abs() < 1.0e-9 * exact_slope.abs());
    }
}

/// In registers, in dual numbers and by differences a stated law has the derivatives it says. Differences of a
/// function with derivatives of its own size are good to about the two-thirds power of the machine epsilon, 4e-11.
#[test]
fn derivatives_reach_the_contact() {
    let law = Law::Stated(Stated(Arc::new(Coulomb)));
    let smooth = |v: f64, n: f64| n * (v / VELOCITY).tanh() + 1.0e-3 * n * n * v;
    let by_differences = ByDifferences(smooth);
    let at = |v: Dual64, n: Dual64| {
        let slip = Slip {
            velocity: v,
            displacement: Dual64::zero(),
        };
        law.develop(slip, n)
    };
    for v in [-0.4, -0.02, 0.0, 3.0e-5, 0.07, 0.9] {
        for n in [0.3, 25.0, 4.0e3] {
            let (force, [by_velocity, by_normal]) = Coulomb.develop(v, n);
            let one = at(Dual64::new(v, 1.0), Dual64::constant(n));
            let other = at(Dual64::constant(v), Dual64::new(n, 1.0));
            assert_eq!(one.force.re.to_bits(), force.to_bits());
            assert_eq!(one.force.eps.to_bits(), by_velocity.to_bits());
            assert_eq!(one.by_velocity.re.to_bits(), by_velocity.to_bits());
            assert_eq!(other.force.eps.to_bits(), by_normal.to_bits());

            let (_, [by_velocity, by_normal]) = by_differences.develop(v, n);
            let bend = (v / VELOCITY).tanh();
            let exact = n * (1.0 - bend * bend) / VELOCITY + 1.0e-3 * n * n;
            assert!((by_velocity - exact).abs() < 1.0e-8 * (n / VELOCITY + n * n));
            let exact = bend + 2.0e-3 * n * v;
            assert!((by_normal - exact).abs() < 1.0e-8 * (1.0 + n));
        }
        // Outside of contact the law is not asked.
        let apart = at(Dual64::constant(v), Dual64::zero());
        assert_eq!(apart.force.re.to_bits(), 0.0_f64.to_bits());
    }
}

/// A law without a place, and one that knows no numbers, are told.
#[test]
fn mistakes_are_errors() {
    let drive = two_pulleys(&["run.end_time=0.01"]);
    let laws = UserLaws::default().with_friction("dirven", Arc::new(Coulomb));
    let error = run_with(&drive, &laws).unwrap_err();
    assert!(matches!(
        error,
        RunError::UserLaw(UserLawError::NoPulley { .. })
    ));
    assert!(error.to_string().contains("driver, driven"), "{error}");
    let laws = UserLaws::default().with_torque("driver", Arc::new(Fan));
    let error = run_with(&drive, &laws).unwrap_err();
    assert!(error.to_string().contains("prescribed"), "{error}");
    let running = two_pulleys(&["run.end_time=0.01", "run.start='steady'"]);
    let laws = UserLaws::default().with_torque("driven", Arc::new(Fan));
    let error = run_with(&running, &laws).unwrap_err();
    assert!(error.to_string().contains("run.start"), "{error}");
    let laws = UserLaws::default().with_friction("driven", Arc::new(Nothing));
    let error = run_with(&drive, &laws).unwrap_err();
    assert!(matches!(error, RunError::Step { .. }), "{error}");
}

/// Whoever reads the results learns that the drive file does not hold all.
#[test]
fn results_tell_of_stated_laws() {
    let drive = two_pulleys(&["run.end_time=0.005"]);
    let laws = UserLaws::default()
        .with_friction("driver", Arc::new(Coulomb))
        .with_torque("driven", Arc::new(Fan));
    let outcome = run_with(&drive, &laws).unwrap();
    let told = hihna::summary::Summary::new(&drive, &outcome)
        .warnings
        .join("\n");
    assert!(told.contains("friction on pulley `driver`"), "{told}");
    assert!(
        told.contains("external torque on pulley `driven`"),
        "{told}"
    );
}
