//! The integrators and statics on a short chain of belt beams.
//!
//! The problem: a belt of 0.2 m in four elements (Kerkkänen 2006, Table 3.1: 10 mm square,
//! 1036 kg/m³, 100 MPa, bending factor 0.01) thrown into free flight, turning and swinging in its
//! bending modes. No force acts from outside, so momentum, angular momentum and energy stay, and the
//! motion is smooth: each scheme must show its order.

use std::ops::ControlFlow;

use ancf::dynamics::{Control, Method, Motion, Pace, Scheme, Stage, integrate};
use ancf::dynamics::{GeneralizedAlpha, RungeKutta4, TrBdf2};
use ancf::element::BeltBeam2;
use ancf::linear::BorderedMatrix;
use ancf::material::Isotropic;
use ancf::mesh::Mesh;
use ancf::section::PlanarSection;
use ancf::statics::{Settle, StaticsError, settle};
use ancf::system::{ForceLaw, Mechanics, State, System};

const SPAN: f64 = 0.2;
const THICKNESS: f64 = 0.01;
const NODE: usize = 6;
/// Line density times length: 1036 kg/m³ · 1e-4 m² · 0.2 m.
const MASS: f64 = 0.02072;

fn chain<L: ForceLaw>(elements: usize, law: L) -> System<BeltBeam2, L> {
    let length = SPAN / elements as f64;
    let element = BeltBeam2::new(
        length,
        &PlanarSection::rectangle(0.01, THICKNESS),
        &Isotropic {
            youngs_modulus: 1.0e8,
            poisson_ratio: 0.3,
            density: 1036.0,
        },
        1.0,
        0.01,
        0.0,
    );
    let mesh = Mesh::open(vec![element; elements]);
    let scales = mesh.scales(length, THICKNESS);
    System::new(mesh, scales, Vec::new(), law)
}

/// The straight belt along x.
fn straight(elements: usize) -> Vec<f64> {
    (0..=elements)
        .flat_map(|i| [SPAN * i as f64 / elements as f64, 0.0, 1.0, 0.0, 0.0, 1.0])
        .collect()
}

/// Straight, thrown with (3, 2) m/s, turning at 20 rad/s and bending: transverse velocities
/// `0.5 sin(3 pi x / 2 L)` m/s with the slopes that belong to them.
fn thrown(elements: usize) -> Motion {
    let q = straight(elements);
    let mut motion = Motion::zero(q.len());
    for (i, v) in motion.v.chunks_exact_mut(NODE).enumerate() {
        let x = q[NODE * i];
        let k = 1.5 * std::f64::consts::PI / SPAN;
        let turn = 20.0;
        let bend = 0.5 * k * (k * x).cos();
        v.copy_from_slice(&[
            3.0,
            2.0 + turn * (x - 0.5 * SPAN) + 0.5 * (k * x).sin(),
            0.0,
            turn + bend,
            -turn - bend,
            0.0,
        ]);
    }
    motion.q = q;
    motion
}

const ELEMENTS: usize = 4;
/// Flight time [s].
const FLIGHT: f64 = 0.004;

/// The thrown chain, ready for a first step.
fn begun() -> (System<BeltBeam2, ()>, Stage, Motion) {
    let mut system = chain(ELEMENTS, ());
    let mut motion = thrown(ELEMENTS);
    let mut stage = Stage::new(&system, 1.0e-12);
    stage.accelerations(&mut system, &mut motion);
    motion.algorithmic.copy_from_slice(&motion.a);
    (system, stage, motion)
}

/// Velocities change by what the scheme says of its integration, to what Newton's method leaves over of accelerations of 1e5 m/s² in steps of
/// 1e-4 s: also right after another scheme has made a step, with the algorithmic accelerations that it leaves.
#[test]
fn steps_add_up_by_their_rule() {
    let (mut system, mut stage, mut from) = begun();
    let mut to = from.clone();
    let mut alpha = GeneralizedAlpha::new(0.8);
    let mut bdf = TrBdf2::new(from.q.len());
    let h = 1.0e-4;
    for step in 0..40 {
        let scheme: &mut dyn Scheme = if step % 7 < 4 { &mut alpha } else { &mut bdf };
        scheme
            .step(&mut system, &mut stage, &from, h, &mut to)
            .expect("the step converges");
        let rule = scheme.rule();
        let [start, between, end] = rule.weights;
        for i in 0..from.q.len() {
            let middle = rule.middle.map_or(0.0, |middle| middle.a[i]);
            let ahead = (to.a[i] - to.algorithmic[i]) - (from.a[i] - from.algorithmic[i]);
            let wanted =
                h * (start * from.a[i] + between * middle + end * to.a[i] + rule.lag * ahead);
            let found = to.v[i] - from.v[i];
            let scale = from.v.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            assert!(
                (found - wanted).abs() < 1.0e-9 * scale,
                "{step}, {i}: {found} {wanted}"
            );
        }
        std::mem::swap(&mut from, &mut to);
    }
}

fn fly(mut scheme: impl Scheme, steps: usize) -> Motion {
    let (mut system, mut stage, mut from) = begun();
    let mut to = from.clone();
    for _ in 0..steps {
        scheme
            .step(
                &mut system,
                &mut stage,
                &from,
                FLIGHT / steps as f64,
                &mut to,
            )
            .expect("the step converges");
        std::mem::swap(&mut from, &mut to);
    }
    from
}

fn difference(a: &Motion, b: &Motion) -> f64 {
    let positions = a.q.iter().zip(&b.q).enumerate();
    positions
        .filter(|(i, _)| i % NODE < 2)
        .map(|(_, (x, y))| (x - y).abs())
        .fold(0.0, f64::max)
}

/// Momentum, angular momentum about the origin, energy. All are exact in the coordinates: the mass
/// matrix acts on whole vectors, and the shape functions reproduce translation and rotation.
fn invariants(motion: &Motion) -> ([f64; 2], f64, f64) {
    let system = chain(ELEMENTS, ());
    let mut momentum = vec![0.0; motion.v.len()];
    system.mass().multiply(&motion.v, &mut momentum);
    let mut linear = [0.0; 2];
    let mut angular = 0.0;
    for (k, p) in momentum.chunks_exact(2).enumerate() {
        let r = &motion.q[2 * k..2 * k + 2];
        angular += r[0] * p[1] - r[1] * p[0];
        if k % 3 == 0 {
            linear[0] += p[0];
            linear[1] += p[1];
        }
    }
    let energy = system.kinetic_energy(&motion.v) + system.strain_energy(&motion.q);
    (linear, angular, energy)
}

/// Orders from errors at `steps` and twice as many, against Runge-Kutta with 40,000 steps, whose own
/// error is round-off. Steps are short enough for the stiff axial and thickness modes to be
/// resolved; half a percent of the ratio remains from terms of higher order: orders to 0.1.
fn assert_order(run: impl Fn(usize) -> Motion, steps: usize, order: f64) {
    let reference = fly(RungeKutta4::new(NODE * (ELEMENTS + 1)), 40_000);
    let coarse = difference(&run(steps), &reference);
    let fine = difference(&run(2 * steps), &reference);
    let found = (coarse / fine).log2();
    assert!(
        (found - order).abs() < 0.1,
        "errors {coarse:.2e} m and {fine:.2e} m: order {found:.2}"
    );
}

#[test]
fn generalized_alpha_is_of_second_order() {
    assert_order(|steps| fly(GeneralizedAlpha::new(0.8), steps), 2000, 2.0);
}

#[test]
fn tr_bdf2_is_of_second_order() {
    assert_order(
        |steps| fly(TrBdf2::new(NODE * (ELEMENTS + 1)), steps),
        2000,
        2.0,
    );
}

#[test]
fn runge_kutta_is_of_fourth_order() {
    assert_order(
        |steps| fly(RungeKutta4::new(NODE * (ELEMENTS + 1)), steps),
        1000,
        4.0,
    );
}

/// Elastic forces sum to zero over the belt to round-off and every scheme adds them linearly, so
/// momentum stays to round-off at any step: 1e-16 per step, 1000 steps, 1e-13 at the most. Angular
/// momentum and energy are quadratic: they drift by the scheme's error, which falls with its order
/// (a quarter per halving for the second-order schemes, to 10 % at these steps).
#[test]
fn free_flight_keeps_momentum_and_to_the_order_of_the_scheme_energy() {
    let (linear, angular, energy) = invariants(&thrown(ELEMENTS));
    assert!((linear[0] - 3.0 * MASS).abs() < 1.0e-12 * MASS);
    let drift = |motion: &Motion| {
        let (l, h, e) = invariants(motion);
        for axis in 0..2 {
            assert!((l[axis] - linear[axis]).abs() < 1.0e-13 * linear[0]);
        }
        [(h / angular - 1.0).abs(), (e / energy - 1.0).abs()]
    };
    let alpha = |steps| drift(&fly(GeneralizedAlpha::new(0.8), steps));
    let bdf = |steps| drift(&fly(TrBdf2::new(NODE * (ELEMENTS + 1)), steps));
    for (coarse, fine) in [(alpha(1000), alpha(2000)), (bdf(1000), bdf(2000))] {
        for (coarse, fine) in coarse.into_iter().zip(fine) {
            assert!(fine < 1.0e-10, "drift {fine:.1e}");
            let ratio = coarse / fine;
            assert!((3.6..4.4).contains(&ratio), "drift falls by {ratio:.2}");
        }
    }
    // Fourth order: at 2000 steps nothing is left but round-off of the sums.
    for drift in drift(&fly(RungeKutta4::new(NODE * (ELEMENTS + 1)), 2000)) {
        assert!(drift < 1.0e-12, "drift {drift:.1e}");
    }
}

/// The driver of steps: every kink is the end of a step, to the last digit; with step control the energy of
/// the free flight stays within the tolerance asked for (1e-4 of a speed of 3.6 m/s, twice in the
/// square: 1e-4 relative with room for the accumulation over the flight).
#[test]
fn integrate_hits_kinks_and_keeps_energy() {
    let kinks = vec![0.001, 0.001_7, 0.003_3];
    let (_, _, energy) = invariants(&thrown(ELEMENTS));
    for method in [Method::Auto, Method::GeneralizedAlpha, Method::TrBdf2] {
        let mut system = chain(ELEMENTS, ());
        let mut motion = thrown(ELEMENTS);
        let control = Control {
            method,
            step: 1.0e-4,
            error_tolerance: Some(1.0e-4),
            tightened: Vec::new(),
            newton_tolerance: 1.0e-9,
            kinks: kinks.clone(),
            jumps: Vec::new(),
        };
        let mut times = Vec::new();
        let statistics = integrate(&mut system, &mut motion, FLIGHT, &control, |_, window| {
            times.push(window.to.time);
            ControlFlow::Continue(())
        })
        .expect("the flight is smooth");
        assert_eq!(statistics.steps, times.len());
        for kink in &kinks {
            let nearest = times
                .iter()
                .fold(f64::INFINITY, |d, t| d.min((t - kink).abs()));
            assert!(
                nearest < 1.0e-16,
                "{method:?} misses {kink} by {nearest:.1e}"
            );
        }
        assert!(motion.time == FLIGHT);
        let (_, _, now) = invariants(&motion);
        let drift = (now / energy - 1.0).abs();
        assert!(drift < 1.0e-4, "{method:?}: energy drifts by {drift:.1e}");
    }
}

/// An observer that asks for finer steps gets six halvings, at its word `Hold` they stay, and fixed steps
/// stay as they are.
#[test]
fn steps_follow_the_pace_of_the_observer() {
    let steps = |error_tolerance, pace: fn(usize) -> Pace| {
        let mut control = Control::fixed(Method::Auto, 1.0e-4);
        control.error_tolerance = error_tolerance;
        let mut lengths = Vec::new();
        let (mut system, mut motion) = (chain(ELEMENTS, ()), thrown(ELEMENTS));
        integrate(&mut system, &mut motion, 0.002, &control, |_, window| {
            lengths.push(window.to.time - window.from.time);
            ControlFlow::Continue(pace(lengths.len()))
        })
        .expect("the flight is smooth");
        lengths
    };
    let shortest = |lengths: &[f64]| lengths.iter().copied().fold(f64::INFINITY, f64::min);
    let loose = Some(1.0e3);
    let finer = steps(loose, |_| Pace::Finer);
    assert!((shortest(&finer) * 64.0 - 1.0e-4).abs() < 1.0e-12);
    let free = steps(loose, |_| Pace::Free);
    assert_eq!(free.len(), 20);
    let held = steps(loose, |step| match step {
        ..=4 => Pace::Finer,
        _ => Pace::Hold,
    });
    assert_eq!(held.len(), 4 + 32);
    assert_eq!(steps(None, |_| Pace::Finer).len(), 20);
}

/// A cantilever on an elastic clamp: springs hold position and section of node 0, a dead force pulls
/// at the other end.
#[derive(Clone, Copy, Debug)]
struct Cantilever {
    /// Spring of both positions [N/m].
    position: f64,
    /// Spring of the section's rotation [N m], acting on the x component of r_y.
    rotation: f64,
    /// Force on the last node [N].
    force: [f64; 2],
    /// First coordinate of the last node.
    last: usize,
}

impl Cantilever {
    fn springs(&self) -> [(usize, f64); 3] {
        [(0, self.position), (1, self.position), (4, self.rotation)]
    }
}

impl ForceLaw for Cantilever {
    fn add_force(&mut self, state: State<'_>, force: &mut [f64]) {
        for (i, stiffness) in self.springs() {
            force[i] -= stiffness * state.q[i];
        }
        for axis in 0..2 {
            force[self.last + axis] += self.force[axis];
        }
    }

    fn add_tangent(&mut self, _: State<'_>, factor: f64, _: f64, matrix: &mut BorderedMatrix) {
        for (i, stiffness) in self.springs() {
            matrix.add(i, i, factor * stiffness);
        }
    }
}

/// The tip of the cantilever with `elements` elements under `F L² / E I = 1`: a deflection of more
/// than a quarter of the span.
fn tip(elements: usize, held: bool) -> Result<[f64; 2], StaticsError> {
    let law = Cantilever {
        position: if held { 100.0 } else { 0.0 },
        rotation: if held { 0.05 } else { 0.0 },
        force: [0.0, 0.02],
        last: NODE * elements,
    };
    let mut system = chain(elements, law);
    let mut q = straight(elements);
    let settled = settle(&mut system, 0.0, &mut q, SETTLE)?;
    assert!(settled.correction < SETTLE.tolerance);
    // an equilibrium indeed: no generalised force is left, to round-off of E A (10 kN) times 1e-16
    let rest = vec![0.0; q.len()];
    let mut force = vec![0.0; q.len()];
    system.force(
        State {
            time: 0.0,
            q: &q,
            v: &rest,
        },
        &mut force,
    );
    assert!(force.iter().all(|f| f.abs() < 1.0e-9), "{force:?}");
    Ok([q[NODE * elements], q[NODE * elements + 1]])
}

const SETTLE: Settle = Settle {
    shift: 1.0e6,
    shrink: 0.3,
    step_limit: 0.02,
    tolerance: 1.0e-12,
    max_iterations: 200,
};

/// Smooth, so the cubic centre line must give fourth order: errors at the tip against 64 elements
/// (whose own error is 16^-2 of that with 16) fall by 2^4 per halving; to half an order at four and
/// eight elements, which resolve the belt's thickness scale poorly.
#[test]
fn statics_of_the_belt_beam_is_of_fourth_order() {
    let exact = tip(64, true).expect("it is held");
    assert!(exact[1] > 0.05, "the deflection is large: {exact:?}");
    let error = |elements| {
        let at = tip(elements, true).expect("it is held");
        (at[0] - exact[0]).hypot(at[1] - exact[1])
    };
    let errors = [error(4), error(8), error(16)];
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!(
            (3.5..5.0).contains(&order),
            "errors {errors:?}: order {order:.2}"
        );
    }
}

#[test]
fn a_belt_that_nothing_holds_is_reported() {
    let error = tip(4, false).expect_err("it flies off");
    assert!(
        matches!(
            error,
            StaticsError::NotConverged { .. } | StaticsError::Singular { .. }
        ),
        "{error}"
    );
}

/// Without a shift the straight belt with no springs has a tangent with three free motions.
#[test]
fn a_singular_tangent_is_reported() {
    let mut system = chain(4, ());
    let mut q = straight(4);
    let options = Settle {
        shift: 0.0,
        ..SETTLE
    };
    let error = settle(&mut system, 0.0, &mut q, options).expect_err("nothing holds it");
    assert!(matches!(error, StaticsError::Singular { .. }), "{error}");
}
