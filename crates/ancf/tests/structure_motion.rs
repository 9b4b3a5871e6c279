//! Structures in motion: constraints over long runs, conservation, pendulum and spin-up of the dissertation.

use std::ops::ControlFlow;
use std::sync::Arc;

use ancf::constraint::{ConstraintForm, SpinUp};
use ancf::dynamics::{Control, Method, Motion, integrate};
use ancf::element::{CubicBeam2, LineElement, LinearBeam2};
use ancf::loads::Loads;
use ancf::material::Isotropic;
use ancf::section::PlanarSection;
use ancf::structure::{Coordinate, NodeVector, PlanarStructure, RigidBody};
use ancf::system::{Mechanics, Motion as Prescribed, State, System};

const METHODS: [Method; 3] = [Method::GeneralizedAlpha, Method::TrBdf2, Method::RungeKutta];

/// The dissertation's pendulum (Kerkkänen 2006, Figs 2.5-2.8).
const RUBBER: Isotropic = Isotropic {
    youngs_modulus: 2.07e7,
    poisson_ratio: 0.0,
    density: 7850.0,
};
const LENGTH: f64 = 2.0;

fn section() -> PlanarSection {
    PlanarSection::rectangle(0.1, 0.1)
}

fn linear(count: usize) -> LinearBeam2 {
    LinearBeam2::new(LENGTH / count as f64, &section(), &RUBBER)
}

fn pendulum<E: LineElement>(element: E, count: usize) -> PlanarStructure<E> {
    let mut pendulum = PlanarStructure::straight(element, count, [0.0; 2], 0.0);
    pendulum.pin(0).gravity([0.0, -9.81]);
    pendulum
}

/// Runs to `end`, with a look at every state.
fn run<E: LineElement>(
    system: &mut System<E, Loads>,
    motion: &mut Motion,
    end: f64,
    control: &Control,
    mut look: impl FnMut(&System<E, Loads>, &Motion),
) {
    integrate(system, motion, end, control, |system, window| {
        look(system, window.to);
        ControlFlow::Continue(())
    })
    .unwrap_or_else(|error| panic!("{error}"));
}

/// The places of the tip at every `interval` s, from steps that hit those times.
fn tips<E: LineElement>(
    structure: &PlanarStructure<E>,
    end: f64,
    steps_per_interval: usize,
    interval: f64,
) -> Vec<[f64; 2]> {
    let mut system = structure.build().expect("it is sound");
    let mut motion = structure.at_rest(&system);
    let control = Control::fixed(Method::RungeKutta, interval / steps_per_interval as f64);
    let mut tips = Vec::new();
    let mut step = 0;
    run(&mut system, &mut motion, end, &control, |_, state| {
        step += 1;
        if step % steps_per_interval == 0 {
            tips.push(structure.position(&state.q, structure.last()));
        }
    });
    tips
}

fn largest_distance(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]))
        .fold(0.0, f64::max)
}

/// Largest violation of the constraints' positions and velocities.
fn violation<E: LineElement>(system: &System<E, Loads>, state: &Motion) -> f64 {
    let constraints = system.constraints().expect("it is constrained");
    let at = State {
        time: state.time,
        q: &state.q,
        v: &state.v,
    };
    constraints
        .violation(at)
        .iter()
        .map(|(amount, _)| *amount)
        .fold(0.0, f64::max)
}

/// A root turned as prescribed and an inclined roller on the tip of a second span: both forms give the same
/// motion with every scheme. Newton stops at 1e-9 m/s, a hundred steps add up to 1e-7 at most; the explicit
/// scheme, which iterates nothing, agrees to round-off.
#[test]
fn both_forms_give_the_same_motion() {
    for method in METHODS {
        let ends = [ConstraintForm::Multipliers, ConstraintForm::Elimination].map(|form| {
            let mut beam = PlanarStructure::straight(linear(4), 4, [0.0; 2], 0.3);
            let angle = SpinUp {
                speed: 2.0,
                rise_time: 0.05,
            };
            beam.turn(0, Arc::new(angle))
                .roller(4, [0.6, 0.8])
                .constraint_form(form);
            let mut system = beam.build().expect("it is sound");
            let mut motion = beam.at_rest(&system);
            let control = Control::fixed(method, 2.0e-4);
            run(&mut system, &mut motion, 0.02, &control, |_, _| {});
            motion
        });
        let tolerance = if method == Method::RungeKutta {
            1e-12
        } else {
            1e-7
        };
        for i in 0..20 {
            let difference = (ends[0].q[i] - ends[1].q[i]).abs();
            assert!(
                difference < tolerance,
                "{method:?}, coordinate {i}: {difference}"
            );
            let difference = (ends[0].v[i] - ends[1].v[i]).abs();
            assert!(
                difference < 1e3 * tolerance,
                "{method:?}, velocity {i}: {difference}"
            );
        }
    }
}

/// A disc that turns about a fixed centre with a beam fastened to its rim, thrown into rotation, with a
/// weight hinged to the beam's tip.
fn rotor() -> (PlanarStructure<LinearBeam2>, usize) {
    let mut rotor = PlanarStructure::straight(linear(4), 4, [0.5, 0.0], 0.0);
    let disc = rotor.body(RigidBody {
        name: "disc".to_owned(),
        mass: 100.0,
        inertia: 60.0,
        place: [0.0, 0.0],
        angle: 0.2,
    });
    let weight = rotor.body(RigidBody {
        name: "weight".to_owned(),
        mass: 5.0,
        inertia: 0.4,
        place: [2.7, 0.1],
        angle: 0.0,
    });
    for index in 0..2 {
        let coordinate = Coordinate::Body { body: disc, index };
        rotor.prescribe(coordinate, Arc::new(ancf::constraint::Constant(0.0)));
    }
    rotor.fasten(0, disc).hinge(4, weight);
    (rotor, disc)
}

/// Turning as one rigid body at `speed` about the origin.
fn turning(structure: &PlanarStructure<LinearBeam2>, speed: f64, bodies: usize) -> [Vec<f64>; 2] {
    let q = structure.drawn();
    let chain = q.len() - 3 * bodies;
    let mut v = vec![0.0; q.len()];
    for i in (0..chain).step_by(2) {
        [v[i], v[i + 1]] = [-speed * q[i + 1], speed * q[i]];
    }
    for i in (chain..q.len()).step_by(3) {
        [v[i], v[i + 1], v[i + 2]] = [-speed * q[i + 1], speed * q[i], speed];
    }
    [q, v]
}

/// Nothing drifts: over 5 s and some ten turns, with nodes on turning bodies, every scheme keeps positions
/// and velocities to round-off.
#[test]
fn constraints_do_not_drift() {
    for method in METHODS {
        let (rotor, _) = rotor();
        let mut system = rotor.build().expect("it is sound");
        let [q, v] = turning(&rotor, 3.0, 2);
        let mut motion = rotor.start(&system, &q, &v).expect("it turns as one");
        let control = Control::fixed(method, 5.0e-4);
        let mut worst: f64 = 0.0;
        run(&mut system, &mut motion, 5.0, &control, |system, state| {
            worst = worst.max(violation(system, state));
        });
        assert!(worst < 1e-12, "{method:?}: {worst}");
    }
}

/// Nor do prescribed motions: a root turned as prescribed, a tip driven along x and an inclined roller between, over
/// 5 s, in both forms: what is left is rounding.
#[test]
fn prescribed_motions_do_not_drift() {
    for form in [ConstraintForm::Multipliers, ConstraintForm::Elimination] {
        for method in METHODS {
            let mut beam = PlanarStructure::straight(linear(4), 4, [0.0; 2], 0.0);
            let turned = SpinUp {
                speed: 0.2,
                rise_time: 2.0,
            };
            let driven = SpinUp {
                speed: -0.1,
                rise_time: 5.0,
            };
            let from_drawn = Shifted {
                motion: driven,
                from: LENGTH,
            };
            let tip = Coordinate::Node {
                node: 4,
                vector: NodeVector::Position,
                axis: 0,
            };
            beam.turn(0, Arc::new(turned))
                .roller(2, [0.6, 0.8])
                .prescribe(tip, Arc::new(from_drawn))
                .constraint_form(form);
            let mut system = beam.build().expect("it is sound");
            let mut motion = beam.at_rest(&system);
            let control = Control::fixed(method, 5.0e-4);
            let mut worst: f64 = 0.0;
            run(&mut system, &mut motion, 5.0, &control, |system, state| {
                worst = worst.max(violation(system, state));
            });
            assert!(worst < 1e-12, "{form:?}, {method:?}: {worst}");
        }
    }
}

/// A motion that starts elsewhere.
#[derive(Debug)]
struct Shifted {
    motion: SpinUp,
    from: f64,
}

impl Prescribed for Shifted {
    fn at(&self, time: f64) -> [f64; 3] {
        let [value, rate, acceleration] = self.motion.at(time);
        [self.from + value, rate, acceleration]
    }
}

/// The rotor's support exerts no moment about its centre and does no work: angular momentum and energy stay.
/// The explicit scheme of fourth order keeps them to 1e-8 at 1e-4 s (the fastest mode, some 3000 1/s, has an
/// amplitude far below that), the implicit ones converge to that with the square of the step.
#[test]
fn a_rotor_keeps_angular_momentum_and_energy() {
    let (rotor, _) = rotor();
    let change = |method: Method, step: f64| -> [f64; 2] {
        let mut system = rotor.build().expect("it is sound");
        let [q, v] = turning(&rotor, 3.0, 2);
        let mut motion = rotor.start(&system, &q, &v).expect("it turns as one");
        let chain = q.len() - 6;
        let invariants = |system: &System<LinearBeam2, Loads>, state: &Motion| {
            let mut momentum = vec![0.0; state.q.len()];
            system.mass().multiply(&state.v, &mut momentum);
            let pairs = (0..chain).step_by(2).chain([chain, chain + 3]);
            let orbital: f64 = pairs
                .map(|i| state.q[i] * momentum[i + 1] - state.q[i + 1] * momentum[i])
                .sum();
            let spin = momentum[chain + 2] + momentum[chain + 5];
            [orbital + spin, system.energy(&state.q, &state.v)]
        };
        let before = invariants(&system, &motion);
        let control = Control::fixed(method, step);
        run(&mut system, &mut motion, 0.5, &control, |_, _| {});
        let after = invariants(&system, &motion);
        std::array::from_fn(|k| (after[k] / before[k] - 1.0).abs())
    };
    let explicit = change(Method::RungeKutta, 1.0e-4);
    assert!(explicit.iter().all(|change| *change < 1e-8), "{explicit:?}");
    for method in [Method::GeneralizedAlpha, Method::TrBdf2] {
        let (coarse, fine) = (change(method, 1.0e-3), change(method, 2.5e-4));
        for k in 0..2 {
            let allowed = (coarse[k] / 8.0).max(1e-8);
            assert!(fine[k] < allowed, "{method:?}: {coarse:?} {fine:?}");
        }
    }
}

/// A start that breaks a constraint is refused by name, not mended in silence.
#[test]
fn a_start_that_breaks_a_constraint_is_refused() {
    let pendulum = pendulum(linear(4), 4);
    let system = pendulum.build().expect("it is sound");
    let q = pendulum.drawn();
    let mut v = vec![0.0; q.len()];
    v[1] = 0.5;
    let text = pendulum
        .start(&system, &q, &v)
        .expect_err("the pin moves")
        .to_string();
    assert!(
        text.contains("pin of node 0") && text.contains("m/s"),
        "{text}"
    );
}

/// Statement on Fig 2.7: the sum of kinetic, strain and potential energy stays within 0.62e-4 J over 2 s with
/// four elements. A matter of the step alone: that of the explicit scheme falls with the fifth power.
#[test]
fn the_pendulum_keeps_its_energy() {
    let worst = |step: f64| {
        let pendulum = pendulum(linear(4), 4);
        let mut system = pendulum.build().expect("it is sound");
        let mut motion = pendulum.at_rest(&system);
        let mut worst: f64 = 0.0;
        let control = Control::fixed(Method::RungeKutta, step);
        run(&mut system, &mut motion, 2.0, &control, |system, state| {
            worst = worst.max(system.energy(&state.q, &state.v).abs());
        });
        worst
    };
    let fine = worst(1.0e-4);
    assert!(fine <= 0.62e-4, "{fine}");
    let coarse = worst(4.0e-4);
    assert!(fine < coarse / 100.0 || fine < 1e-9, "{coarse} {fine}");
}

/// Statements on Figs 2.6 and 2.8 over 1.2 s: 8 and 16 linear elements nearly identical (within the width of
/// a line, 1 % of the 4 m that the tip swings), 4 close, 2 visibly off, each halving at least halving the
/// distance. Linear and cubic with 8 elements agree well: the linear beam's error is of second order, so 4/3 of its
/// distance to twice as many elements, and the cubic beam lies no farther away than that.
#[test]
fn the_pendulum_converges_as_published() {
    let linear = [2, 4, 8, 16].map(|n| tips(&pendulum(linear(n), n), 1.2, 100, 0.02));
    let to_finest: Vec<f64> = linear[..3]
        .iter()
        .map(|tips| largest_distance(tips, &linear[3]))
        .collect();
    assert!(to_finest[0] > 2.0 * to_finest[1], "{to_finest:?}");
    assert!(to_finest[1] > 2.0 * to_finest[2], "{to_finest:?}");
    assert!(to_finest[2] < 0.01 * 2.0 * LENGTH, "{to_finest:?}");
    let cubic = CubicBeam2::new(LENGTH / 8.0, &section(), &RUBBER);
    let cubic = tips(&pendulum(cubic, 8), 1.2, 400, 0.02);
    let apart = largest_distance(&linear[2], &cubic);
    assert!(apart < 4.0 / 3.0 * to_finest[2], "{apart} {to_finest:?}");
}

/// Spin-up with three linear elements (Figs 2.9-2.11): the lag behind the turning root's direction peaks
/// with 0.527 m near 6.8 s; after 15 s the beam is stretched to about 1.068e-4 m on the mean, its envelope
/// ends near 1.097e-4 m, a little above the steady 1.0957e-4 m.
#[test]
fn the_spin_up_goes_as_published() {
    let length = 8.0;
    let aluminium = Isotropic {
        youngs_modulus: 6.895e10,
        poisson_ratio: 0.0,
        density: 2766.67,
    };
    let spin_up = Arc::new(SpinUp {
        speed: 4.0,
        rise_time: 15.0,
    });
    let section = PlanarSection::rectangle(1.986e-3, 3.675e-2);
    let element = LinearBeam2::new(length / 3.0, &section, &aluminium);
    let mut beam = PlanarStructure::straight(element, 3, [0.0; 2], 0.0);
    beam.turn(0, spin_up.clone());
    let mut system = beam.build().expect("it is sound");
    let mut motion = beam.at_rest(&system);
    let mut peak = (0.0, 0.0);
    let mut range = [0.0_f64; 2];
    let mut late = Vec::new();
    let control = Control::fixed(Method::Auto, 2.0e-3);
    run(&mut system, &mut motion, 20.0, &control, |_, state| {
        let (sine, cosine) = spin_up.at(state.time)[0].sin_cos();
        let [x, y] = beam.position(&state.q, beam.last());
        let lag = sine * x - cosine * y;
        if lag > peak.0 {
            peak = (lag, state.time);
        }
        let across = y - length * sine;
        range = [range[0].min(across), range[1].max(across)];
        if state.time > 15.0 {
            late.push(cosine * x + sine * y - length);
        }
    });
    assert!(
        (peak.0 - 0.527).abs() < 0.001 && (peak.1 - 6.8).abs() < 0.1,
        "{peak:?}"
    );
    assert!(
        (range[0] + 0.49).abs() < 0.01 && (range[1] - 0.53).abs() < 0.01,
        "{range:?}"
    );
    let mean = late.iter().sum::<f64>() / late.len() as f64;
    let highest = late.iter().copied().fold(0.0, f64::max);
    assert!((mean - 1.068e-4).abs() < 0.01e-4, "mean {mean}");
    assert!((highest - 1.097e-4).abs() < 0.01e-4, "highest {highest}");
}

/// Momentum, angular momentum and energy of a beam in flight. Translation moves positions alone, rotation turns
/// every vector.
fn invariants<E: LineElement>(system: &System<E, Loads>, state: &Motion) -> [f64; 4] {
    let mut momentum = vec![0.0; state.q.len()];
    system.mass().multiply(&state.v, &mut momentum);
    let of_nodes = |axis: usize| momentum.iter().skip(axis).step_by(E::NODE_DOF).sum::<f64>();
    let turning = (0..momentum.len())
        .step_by(2)
        .map(|i| state.q[i] * momentum[i + 1] - state.q[i + 1] * momentum[i]);
    [
        of_nodes(0),
        of_nodes(1),
        turning.sum(),
        system.energy(&state.q, &state.v),
    ]
}

/// A beam of four elements, thrown with (3, 2) m/s, turning at 3 rad/s and beaten out of shape, over 0.05 s: what
/// its invariants change by, relative to m v, m v L and the energy at the start.
fn flight<E: LineElement>(element: E, method: Method, step: f64) -> [f64; 4] {
    let beam = PlanarStructure::straight(element, 4, [0.0; 2], 0.3);
    let mut system = beam.build().expect("a beam in flight");
    let q = beam.drawn();
    let mut v = vec![0.0; q.len()];
    for i in (0..q.len()).step_by(2) {
        [v[i], v[i + 1]] = [-3.0 * q[i + 1], 3.0 * q[i]];
        if i % E::NODE_DOF == 0 {
            v[i] += 3.0;
            v[i + 1] += 2.0 + 0.5 * (i as f64).sin();
        }
    }
    let mut motion = beam.start(&system, &q, &v).expect("nothing holds it");
    let before = invariants(&system, &motion);
    let control = Control::fixed(method, step);
    run(&mut system, &mut motion, 0.05, &control, |_, _| {});
    let after = invariants(&system, &motion);
    let mass = RUBBER.density * 0.01 * LENGTH;
    let speed = 3.0_f64.hypot(2.0);
    let scale = [mass * speed, mass * speed, mass * speed * LENGTH, before[3]];
    std::array::from_fn(|k| (after[k] - before[k]).abs() / scale[k])
}

/// No force acts on a beam in flight. Internal forces sum to zero at every state, so each scheme keeps momentum
/// to what Newton leaves (1e-9 m/s a step); angular momentum and energy to its order: a quarter of the
/// step brings the second-order schemes sixteen times closer (eight are asked for), the explicit one is
/// there to 1e-8 at 5e-6 s, a hundredth of the period of its fastest mode.
#[test]
fn a_beam_in_flight_keeps_momentum_angular_momentum_and_energy() {
    fn check<E: LineElement>(element: impl Fn() -> E, name: &str) {
        let explicit = flight(element(), Method::RungeKutta, 5.0e-6);
        assert!(
            explicit.iter().all(|change| *change < 1e-8),
            "{name}: {explicit:?}"
        );
        for method in [Method::GeneralizedAlpha, Method::TrBdf2] {
            let coarse = flight(element(), method, 1.0e-4);
            let fine = flight(element(), method, 2.5e-5);
            assert!(
                coarse[0].max(coarse[1]) < 1e-7,
                "{name}, {method:?}: {coarse:?}"
            );
            for k in 2..4 {
                let allowed = (coarse[k] / 8.0).max(1e-7);
                assert!(fine[k] < allowed, "{name}, {method:?}: {coarse:?} {fine:?}");
            }
        }
    }
    check(|| linear(4), "linear");
    check(
        || CubicBeam2::new(LENGTH / 4.0, &section(), &RUBBER),
        "cubic",
    );
}
