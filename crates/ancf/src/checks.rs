//! What every element must hold, as checks that tests call: derivatives, invariances, mass, lanes.
//!
//! One line in a test gives an element all of them, each as a test of its own:
//!
//! ```text
//! ancf::element_checks!(belt_beam: BeltBeam2::new(...), mass: 1.036);        // any element
//! ancf::line_element_checks!(belt_beam: BeltBeam2::new(...), mass: 1.036);   // and its centre line
//! ```
//!
//! Take a stubby element (height about half the length), so that no term is too small to be seen.
//!
//! # Scales
//! A position has the unit `L` (the largest distance between nodes), a slope the unit one, and energies
//! the unit [`Element::energy_scale`]. Forces and tangents are multiplied with the units of their
//! coordinates before they are compared, and errors are relative to the largest entry.
#![expect(
    clippy::missing_panics_doc,
    reason = "every check panics where the element fails it"
)]

mod lanes;
mod line;
mod states;

pub use lanes::lanes_equal_plain_numbers;
pub use line::centre_line_is_consistent;
pub use states::{deformed_state, reference};

use faer::{Mat, Side};
use num_dual::{Dual64, HyperDual64};

use crate::element::Element;
use crate::scalar::Scalar;
use states::{RigidMotion, length_scale, random_rate, units};

/// Agreement with dual numbers: both sides are exact but for round-off.
const DUAL_TOLERANCE: f64 = 1e-11;

/// Agreement with central differences of step 1e-5: truncation 1e-10, round-off 1e-16 / 1e-5, both
/// times the larger higher derivatives of a strongly deformed element.
const DIFFERENCE_TOLERANCE: f64 = 1e-6;

/// Random states that each check looks at.
const STATES: u64 = 6;

/// Declares a module of tests that hold [every check](crate::checks::all) against an element.
///
/// `element_checks!(name: expression, mass: total)` with the total mass [kg].
#[macro_export]
macro_rules! element_checks {
    ($name:ident: $element:expr, mass: $mass:expr) => {
        mod $name {
            use super::*;

            $crate::element_checks!(@tests $element;
                force_is_minus_the_energy_gradient tangent_is_the_hessian rigid_motion_stores_nothing
                energy_is_objective force_and_moment_sums_vanish only_rigid_modes_are_free
                lanes_equal_plain_numbers damping_is_consistent);

            #[test]
            fn mass_is_consistent() {
                $crate::checks::mass_is_consistent(&$element, $mass);
            }
        }
    };
    (@tests $element:expr; $($check:ident)*) => {
        $(#[test]
        fn $check() {
            $crate::checks::$check(&$element);
        })*
    };
}

/// [`element_checks!`](crate::element_checks) and the checks of the centre line of a beam.
#[macro_export]
macro_rules! line_element_checks {
    ($name:ident: $element:expr, mass: $mass:expr) => {
        $crate::element_checks!($name: $element, mass: $mass);

        #[test]
        fn $name() {
            $crate::checks::centre_line_is_consistent(&$element);
        }
    };
}

/// Every check of [`element_checks!`](crate::element_checks) at once, for property tests.
pub fn all<E: Element>(element: &E, mass: f64) {
    force_is_minus_the_energy_gradient(element);
    tangent_is_the_hessian(element);
    rigid_motion_stores_nothing(element);
    energy_is_objective(element);
    force_and_moment_sums_vanish(element);
    only_rigid_modes_are_free(element);
    lanes_equal_plain_numbers(element);
    damping_is_consistent(element);
    mass_is_consistent(element, mass);
}

/// The force is minus the gradient of the energy, by dual numbers and by central differences.
pub fn force_is_minus_the_energy_gradient<E: Element>(element: &E) {
    let units = units(element);
    for seed in 0..STATES {
        let e = deformed_state(element, seed);
        let force = scaled(&force(element, &e), &units);
        let mut dual = duals(&e);
        let mut by_dual = vec![0.0; E::DOF];
        let mut by_difference = vec![0.0; E::DOF];
        for i in 0..E::DOF {
            dual[i].eps = units[i];
            by_dual[i] = -element.energy(&dual).eps;
            dual[i].eps = 0.0;
            let step = 1e-5 * units[i];
            let energy = |change: f64| {
                let mut moved = e.clone();
                moved[i] += change;
                element.energy(&moved)
            };
            by_difference[i] = -(energy(step) - energy(-step)) / 2e-5;
        }
        assert_close("force by dual numbers", &force, &by_dual, DUAL_TOLERANCE);
        assert_close(
            "force by central differences",
            &force,
            &by_difference,
            DIFFERENCE_TOLERANCE,
        );
    }
}

/// The tangent is the Hessian of the energy (hyper-dual numbers), the derivative of minus the force
/// (dual numbers), and symmetric.
pub fn tangent_is_the_hessian<E: Element>(element: &E) {
    let n = E::DOF;
    let units = units(element);
    let units_squared: Vec<f64> = (0..n * n).map(|k| units[k / n] * units[k % n]).collect();
    for seed in 0..STATES {
        let e = deformed_state(element, seed);
        let tangent = scaled(&stiffness(element, &e), &units_squared);
        let transposed: Vec<f64> = (0..n * n).map(|k| tangent[k % n * n + k / n]).collect();
        assert_close("symmetry of tangent", &tangent, &transposed, 1e-14);

        let mut dual = duals(&e);
        let mut of_force = vec![0.0; n * n];
        for column in 0..n {
            dual[column].eps = units[column];
            for (row, value) in force(element, &dual).iter().enumerate() {
                of_force[row * n + column] = -value.eps * units[row];
            }
            dual[column].eps = 0.0;
        }
        assert_close("tangent of force", &tangent, &of_force, DUAL_TOLERANCE);

        let mut dual: Vec<HyperDual64> = e.iter().map(|x| HyperDual64::from_re(*x)).collect();
        let mut of_energy = vec![0.0; n * n];
        for row in 0..n {
            for column in 0..=row {
                dual[row].eps1 = units[row];
                dual[column].eps2 = units[column];
                let value = element.energy(&dual).eps1eps2;
                of_energy[row * n + column] = value;
                of_energy[column * n + row] = value;
                dual[row].eps1 = 0.0;
                dual[column].eps2 = 0.0;
            }
        }
        assert_close("tangent of energy", &tangent, &of_energy, DUAL_TOLERANCE);
    }
}

/// The reference, translated and turned, stores less than 1e-12 of the energy scale and pushes on
/// nothing.
pub fn rigid_motion_stores_nothing<E: Element>(element: &E) {
    let units = units(element);
    for seed in 0..STATES {
        let motion = RigidMotion::random(E::DIMENSION, length_scale(element), seed);
        let e = motion.apply::<E>(&reference(element));
        let energy = element.energy(&e) / element.energy_scale();
        assert!(energy.abs() < 1e-12, "rigid motion stores {energy:e}");
        for value in scaled(&force(element, &e), &units) {
            let value = value / element.energy_scale();
            assert!(value.abs() < 1e-12, "rigid motion pushes with {value:e}");
        }
    }
}

/// A rigid motion of a deformed state keeps its energy and turns its force with it.
pub fn energy_is_objective<E: Element>(element: &E) {
    let units = units(element);
    for seed in 0..STATES {
        let e = deformed_state(element, seed);
        let motion = RigidMotion::random(E::DIMENSION, length_scale(element), seed + 100);
        let moved = motion.apply::<E>(&e);
        let (before, after) = (element.energy(&e), element.energy(&moved));
        assert!(
            (before - after).abs() <= 1e-12 * before.abs().max(element.energy_scale()),
            "energy {before:e} becomes {after:e} by rigid motion"
        );
        let turned = motion.turn(&force(element, &e));
        assert_close(
            "force of the moved state",
            &scaled(&force(element, &moved), &units),
            &scaled(&turned, &units),
            DUAL_TOLERANCE,
        );
    }
}

/// The elastic force (and the damping force) sums to nothing, and so does its moment
/// `sum_k e_k x f_k` over all nodal vectors.
pub fn force_and_moment_sums_vanish<E: Element>(element: &E) {
    let d = E::DIMENSION;
    let units = units(element);
    for seed in 0..STATES {
        let e = deformed_state(element, seed);
        let rate = random_rate(element, seed);
        let mut forces = vec![("elastic", force(element, &e))];
        if element.is_damped() {
            forces.push(("damping", damping_force(element, &e, &rate)));
        }
        for (name, force) in forces {
            let largest = largest_magnitude(&scaled(&force, &units));
            let length = length_scale(element);
            for axis in 0..d {
                let sum: f64 = force
                    .chunks(E::NODE_DOF)
                    .map(|node| node[axis] * length)
                    .sum();
                assert!(
                    sum.abs() < 1e-12 * largest,
                    "{name} force sums to {sum:e} in axis {axis}"
                );
                for other in 0..axis {
                    let moment: f64 = e
                        .chunks(d)
                        .zip(force.chunks(d))
                        .map(|(e, f)| e[other] * f[axis] - e[axis] * f[other])
                        .sum();
                    assert!(
                        moment.abs() < 1e-11 * largest,
                        "{name} force has the moment {moment:e} in plane {other}{axis}"
                    );
                }
            }
        }
    }
}

/// The stiffness of the reference has the zero eigenvalues of rigid motion (3 or 6), no other, and
/// none below.
pub fn only_rigid_modes_are_free<E: Element>(element: &E) {
    let units = units(element);
    let reference = reference(element);
    let stiffness = stiffness(element, &reference);
    let eigenvalues = eigenvalues(E::DOF, |i, j| {
        stiffness[i * E::DOF + j] * units[i] * units[j]
    });
    let rigid = E::DIMENSION * (E::DIMENSION + 1) / 2;
    let largest = eigenvalues[E::DOF - 1];
    for (i, value) in eigenvalues.iter().enumerate() {
        if i < rigid {
            assert!(
                value.abs() < 1e-12 * largest,
                "rigid mode {i} has stiffness {value:e}"
            );
        } else {
            // The softest motion of a plausible test element is bending: (h/l)² / 12 of the largest.
            assert!(
                *value > 1e-9 * largest,
                "mode {i} with stiffness {value:e} of {largest:e} is free"
            );
        }
    }
}

/// The mass is symmetric and positive definite, and the mass that translates is `total` [kg].
pub fn mass_is_consistent<E: Element>(element: &E, total: f64) {
    let n = E::NODES * E::NODE_VECTORS;
    let mut mass = vec![f64::NAN; n * n];
    element.vector_mass(&mut mass);
    let transposed: Vec<f64> = (0..n * n).map(|k| mass[k % n * n + k / n]).collect();
    assert_close("symmetry of mass", &mass, &transposed, 1e-15);
    let units = units(element);
    let eigenvalues = eigenvalues(n, |i, j| {
        mass[i * n + j] * units[i * E::DIMENSION] * units[j * E::DIMENSION]
    });
    assert!(
        eigenvalues[0] > 1e-9 * eigenvalues[n - 1],
        "mass has the eigenvalue {:e} of {:e}",
        eigenvalues[0],
        eigenvalues[n - 1]
    );
    let mut sum = 0.0;
    for i in (0..n).step_by(E::NODE_VECTORS) {
        for j in (0..n).step_by(E::NODE_VECTORS) {
            sum += mass[i * n + j];
        }
    }
    assert!(
        (sum - total).abs() < 1e-13 * total,
        "mass {sum:e}, not {total:e}"
    );
}

/// The damping force (of a damped element) is zero in rigid motion, takes energy out of any other, and
/// its tangents by position and rate are its derivatives by dual numbers. Both methods add.
pub fn damping_is_consistent<E: Element>(element: &E) {
    if !element.is_damped() {
        return;
    }
    let n = E::DOF;
    let units = units(element);
    for seed in 0..STATES {
        let e = deformed_state(element, seed);
        let rate = random_rate(element, seed);
        let force = damping_force(element, &e, &rate);
        let largest = largest_magnitude(&scaled(&force, &units));

        let rigid = RigidMotion::random(E::DIMENSION, length_scale(element), seed).rate::<E>(&e);
        for value in scaled(&damping_force(element, &e, &rigid), &units) {
            assert!(
                value.abs() < 1e-12 * largest,
                "rigid motion is damped with {value:e}"
            );
        }
        let power: f64 = force.iter().zip(&rate).map(|(f, v)| f * v).sum();
        assert!(power < 0.0, "damping gives the power {power:e}");

        let mut twice = force.clone();
        element.add_damping_force(&e, &rate, &mut twice);
        let doubled: Vec<f64> = force.iter().map(|f| 2.0 * f).collect();
        assert_close("added damping force", &twice, &doubled, 1e-13);
        let mut both = vec![0.0; E::DOF];
        element.damped_force(&e, &rate, &mut both);
        let mut sum = self::force(element, &e);
        element.add_damping_force(&e, &rate, &mut sum);
        assert_close("elastic and damping force together", &both, &sum, 1e-13);

        for (by_position, by_rate) in [(1.0, 0.0), (0.0, 1.0), (0.7, 1.3)] {
            let mut expected = vec![0.0; n * n];
            let (mut e, mut rate) = (duals(&e), duals(&rate));
            for column in 0..n {
                e[column].eps = units[column] * by_position;
                rate[column].eps = units[column] * by_rate;
                let force = damping_force(element, &e, &rate);
                for (row, value) in force.iter().enumerate() {
                    expected[row * n + column] = -value.eps * units[row];
                }
                e[column].eps = 0.0;
                rate[column].eps = 0.0;
            }
            let (e, rate): (Vec<f64>, Vec<f64>) =
                e.iter().zip(&rate).map(|(e, rate)| (e.re, rate.re)).unzip();
            let mut tangent = damping_tangent(element, &e, &rate, by_position, by_rate);
            for (k, value) in tangent.iter_mut().enumerate() {
                *value *= units[k / n] * units[k % n];
            }
            assert_close("damping tangent", &tangent, &expected, DUAL_TOLERANCE);
        }
    }
}

fn scaled(values: &[f64], units: &[f64]) -> Vec<f64> {
    values.iter().zip(units).map(|(v, u)| v * u).collect()
}

fn duals(values: &[f64]) -> Vec<Dual64> {
    values.iter().map(|x| Dual64::from_re(*x)).collect()
}

fn force<E: Element, S: Scalar>(element: &E, e: &[S]) -> Vec<S> {
    let mut force = vec![S::constant(f64::NAN); E::DOF];
    element.force(e, &mut force);
    force
}

fn stiffness<E: Element, S: Scalar>(element: &E, e: &[S]) -> Vec<S> {
    let mut stiffness = vec![S::constant(f64::NAN); E::DOF * E::DOF];
    element.stiffness(e, &mut stiffness);
    stiffness
}

fn damping_force<E: Element, S: Scalar>(element: &E, e: &[S], rate: &[S]) -> Vec<S> {
    let mut force = vec![S::zero(); E::DOF];
    element.add_damping_force(e, rate, &mut force);
    force
}

fn damping_tangent<E: Element, S: Scalar>(
    element: &E,
    e: &[S],
    rate: &[S],
    position_factor: f64,
    rate_factor: f64,
) -> Vec<S> {
    let mut tangent = vec![S::zero(); E::DOF * E::DOF];
    element.add_damping_tangent(e, rate, position_factor, rate_factor, &mut tangent);
    tangent
}

/// Eigenvalues of a symmetric matrix, increasing.
fn eigenvalues(n: usize, entry: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    Mat::from_fn(n, n, entry)
        .self_adjoint_eigenvalues(Side::Lower)
        .expect("the eigenvalues of a finite symmetric matrix converge")
}

fn largest_magnitude(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |largest, value| largest.max(value.abs()))
}

fn assert_close(what: &str, actual: &[f64], expected: &[f64], tolerance: f64) {
    let largest = largest_magnitude(expected);
    for (i, (a, b)) in actual.iter().zip(expected).enumerate() {
        let error = (a - b).abs() / largest;
        // Written so that NaN fails.
        assert!(
            error <= tolerance,
            "{what}: entry {i} is {a:e}, not {b:e}: error {error:e} of the largest entry"
        );
    }
}
