//! Statics of the planar beams of Kerkkänen (2006), chapter 2: Tables 2.1-2.4, closed form, turned mesh.
//!
//! A dense Newton iteration of its own, so that these numbers stand on the elements alone. Values are
//! compared as the tables print them: every digit. Two entries are known misprints; `computed` says what
//! an independent calculation finds instead (see the validation dossier).

use ancf::element::{CubicBeam2, Element, LinearBeam2};
use ancf::material::Isotropic;
use ancf::section::PlanarSection;
use faer::Mat;
use faer::linalg::solvers::Solve;

/// Length of every beam of the chapter [m].
const LENGTH: f64 = 2.0;
const YOUNGS: f64 = 2.07e11;
/// The meshes of the tables.
const ELEMENTS: [usize; 6] = [2, 4, 8, 16, 32, 64];

fn material(poisson_ratio: f64) -> Isotropic {
    Isotropic {
        youngs_modulus: YOUNGS,
        poisson_ratio,
        density: 7850.0,
    }
}

/// A straight beam of equal elements, drawn at `angle` from the origin, with fixed coordinates.
struct Beam<E> {
    element: E,
    nodes: usize,
    reference: Vec<f64>,
    fixed: Vec<usize>,
}

impl<E: Element> Beam<E> {
    fn new(element: E, elements: usize, angle: f64) -> Self {
        let mut local = vec![0.0; E::DOF];
        element.reference(&mut local);
        let (sine, cosine) = angle.sin_cos();
        let mut reference = Vec::new();
        for node in 0..=elements {
            for vector in 0..E::NODE_VECTORS {
                let mut x = local[2 * vector];
                let y = local[2 * vector + 1];
                if vector == 0 {
                    x = LENGTH * node as f64 / elements as f64;
                }
                reference.extend([cosine * x - sine * y, sine * x + cosine * y]);
            }
        }
        Self {
            element,
            nodes: elements + 1,
            reference,
            fixed: Vec::new(),
        }
    }

    /// First coordinate of a node.
    fn at(node: usize) -> usize {
        node * E::NODE_DOF
    }

    /// `load + internal force` and the tangent, with unit rows for fixed coordinates.
    fn residual(&self, e: &[f64], load: &[(usize, f64)], factor: f64) -> (Mat<f64>, Mat<f64>) {
        let n = e.len();
        let mut residual = Mat::zeros(n, 1);
        let mut tangent = Mat::zeros(n, n);
        let mut force = vec![0.0; E::DOF];
        let mut stiffness = vec![0.0; E::DOF * E::DOF];
        for first in (0..self.nodes - 1).map(|node| Self::at(node)) {
            let local = &e[first..first + E::DOF];
            self.element.force(local, &mut force);
            self.element.stiffness(local, &mut stiffness);
            for i in 0..E::DOF {
                residual[(first + i, 0)] += force[i];
                for j in 0..E::DOF {
                    tangent[(first + i, first + j)] += stiffness[i * E::DOF + j];
                }
            }
        }
        for (coordinate, value) in load {
            residual[(*coordinate, 0)] += factor * value;
        }
        for fixed in &self.fixed {
            residual[(*fixed, 0)] = 0.0;
            for j in 0..n {
                tangent[(*fixed, j)] = 0.0;
                tangent[(j, *fixed)] = 0.0;
            }
            tangent[(*fixed, *fixed)] = YOUNGS;
        }
        (residual, tangent)
    }

    /// Change of the coordinates by one linear step from the reference.
    fn linear(&self, load: &[(usize, f64)]) -> Mat<f64> {
        let (residual, tangent) = self.residual(&self.reference, load, 1.0);
        tangent.partial_piv_lu().solve(&residual)
    }

    /// Newton's method in `steps` equal load steps, to corrections below 1e-11 (m, or of a slope).
    fn solve(&self, load: &[(usize, f64)], steps: usize) -> Vec<f64> {
        let mut e = self.reference.clone();
        for step in 1..=steps {
            let factor = step as f64 / steps as f64;
            let mut converged = false;
            for _ in 0..60 {
                let (residual, tangent) = self.residual(&e, load, factor);
                let change = tangent.partial_piv_lu().solve(&residual);
                for (value, change) in e.iter_mut().zip(change.col(0).iter()) {
                    *value += change;
                }
                if change.norm_max() < 1e-11 {
                    converged = true;
                    break;
                }
            }
            assert!(converged, "load step {step} of {steps} does not converge");
        }
        e
    }
}

/// Simply supported: X and Y of the first node and Y of the last fixed, slopes free, 1 kN down at
/// mid-span.
fn simply_supported<E: Element>(element: E, elements: usize) -> (Beam<E>, Vec<(usize, f64)>) {
    let mut beam = Beam::new(element, elements, 0.0);
    beam.fixed = vec![0, 1, Beam::<E>::at(elements) + 1];
    let load = vec![(Beam::<E>::at(elements / 2) + 1, -1000.0)];
    (beam, load)
}

fn mid_deflection<E: Element>(element: E, elements: usize) -> f64 {
    let (beam, load) = simply_supported(element, elements);
    beam.solve(&load, 1)[load[0].0]
}

/// Tip of a cantilever with all coordinates of the root fixed.
fn tip<E: Element>(element: E, elements: usize, load: f64, angle: f64) -> [f64; 2] {
    let mut beam = Beam::new(element, elements, angle);
    beam.fixed = (0..E::NODE_DOF).collect();
    let tip = Beam::<E>::at(elements);
    let (sine, cosine) = angle.sin_cos();
    let e = beam.solve(&[(tip, load * sine), (tip + 1, -load * cosine)], 8);
    [e[tip], e[tip + 1]]
}

fn assert_printed(what: &str, value: f64, printed: &str) {
    let decimals = printed.split('.').nth(1).map_or(0, str::len);
    assert_eq!(format!("{value:.decimals$}"), printed, "{what} is {value}");
}

/// Millimetres; entry by mesh.
fn check_deflections(poisson_ratio: f64, linear: [&str; 6], cubic: [&str; 6]) {
    let section = PlanarSection::rectangle(0.1, 0.1);
    let material = material(poisson_ratio);
    for (i, n) in ELEMENTS.into_iter().enumerate() {
        let length = LENGTH / n as f64;
        let value = mid_deflection(LinearBeam2::new(length, &section, &material), n);
        assert_printed(&format!("linear, {n}"), 1e3 * value, linear[i]);
        let value = mid_deflection(CubicBeam2::new(length, &section, &material), n);
        assert_printed(&format!("cubic, {n}"), 1e3 * value, cubic[i]);
    }
}

/// Table 2.1. Printed for 32 and 64 cubic elements: -0.097005 and -0.097078.
#[test]
fn table_2_1_simply_supported_without_poisson() {
    check_deflections(
        0.0,
        [
            "-0.073043",
            "-0.091159",
            "-0.095688",
            "-0.096821",
            "-0.097104",
            "-0.097174",
        ],
        [
            "-0.072893",
            "-0.091034",
            "-0.095578",
            "-0.096717",
            "-0.0970035",
            "-0.0970761",
        ],
    );
}

/// Table 2.2.
#[test]
fn table_2_2_simply_supported_with_poisson() {
    check_deflections(
        0.3,
        [
            "-0.073217",
            "-0.091333",
            "-0.095862",
            "-0.096995",
            "-0.097278",
            "-0.097348",
        ],
        [
            "-0.054388",
            "-0.067879",
            "-0.071262",
            "-0.072112",
            "-0.072327",
            "-0.072382",
        ],
    );
}

fn check_tips(height: f64, poisson_ratio: f64, linear: [[&str; 2]; 6], cubic: [[&str; 2]; 6]) {
    let section = PlanarSection::rectangle(0.1, height);
    let material = material(poisson_ratio);
    let load = 5.0e8 * height.powi(3);
    for (i, n) in ELEMENTS.into_iter().enumerate() {
        let length = LENGTH / n as f64;
        let linear_tip = tip(LinearBeam2::new(length, &section, &material), n, load, 0.0);
        let cubic_tip = tip(CubicBeam2::new(length, &section, &material), n, load, 0.0);
        for axis in 0..2 {
            assert_printed(&format!("linear, {n}"), linear_tip[axis], linear[i][axis]);
            assert_printed(&format!("cubic, {n}"), cubic_tip[axis], cubic[i][axis]);
        }
    }
}

/// Table 2.3: cantilever, height 0.1 m, nu = 0.3.
#[test]
fn table_2_3_cantilever_model_1() {
    check_tips(
        0.1,
        0.3,
        [
            ["1.88480", "-0.62126"],
            ["1.86351", "-0.66320"],
            ["1.85696", "-0.67691"],
            ["1.85537", "-0.68018"],
            ["1.85500", "-0.68091"],
            ["1.85491", "-0.68109"],
        ],
        [
            ["1.95536", "-0.37731"],
            ["1.91970", "-0.50932"],
            ["1.91344", "-0.53035"],
            ["1.91276", "-0.53267"],
            ["1.91264", "-0.53309"],
            ["1.91262", "-0.53319"],
        ],
    );
}

/// Table 2.4: cantilever, height 0.5 m, nu = 0.
#[test]
fn table_2_4_cantilever_model_2() {
    check_tips(
        0.5,
        0.0,
        [
            ["1.87307", "-0.65134"],
            ["1.85001", "-0.69591"],
            ["1.84412", "-0.70709"],
            ["1.84271", "-0.70970"],
            ["1.84237", "-0.71034"],
            ["1.84228", "-0.71050"],
        ],
        [
            ["1.86909", "-0.64098"],
            ["1.84841", "-0.69436"],
            ["1.84498", "-0.70341"],
            ["1.84407", "-0.70573"],
            ["1.84378", "-0.70643"],
            ["1.84367", "-0.70667"],
        ],
    );
}

/// Linearised, the linear beam's mid-span deflection is known in closed form:
/// `-[P L³ / (48 E I) (1 - 1/n²) + P L / (4 ks G A)]`. The tolerance is the round-off of a solution with
/// condition number 1e6.
#[test]
fn linear_beam_has_its_closed_form() {
    let section = PlanarSection::rectangle(0.1, 0.1);
    for poisson_ratio in [0.0, 0.3] {
        let material = material(poisson_ratio);
        let shear = 5.0 / 6.0 * material.shear_modulus() * section.area;
        for n in ELEMENTS {
            let element = LinearBeam2::new(LENGTH / n as f64, &section, &material);
            let (beam, load) = simply_supported(element, n);
            let value = beam.linear(&load)[(load[0].0, 0)];
            let bending = 1000.0 * LENGTH.powi(3) / (48.0 * YOUNGS * section.second_moment);
            let expected =
                -(bending * (1.0 - (n as f64).powi(-2)) + 1000.0 * LENGTH / (4.0 * shear));
            assert!(
                (value / expected - 1.0).abs() < 1e-9,
                "{n} elements: {value} {expected}"
            );
        }
    }
}

/// A cantilever drawn at an angle, its load turned with it, bends to the turned answer.
#[test]
fn a_turned_beam_gives_the_turned_answer() {
    let section = PlanarSection::rectangle(0.1, 0.1);
    let material = material(0.3);
    let linear = LinearBeam2::new(LENGTH / 4.0, &section, &material);
    let cubic = CubicBeam2::new(LENGTH / 4.0, &section, &material);
    let straight = [
        tip(linear.clone(), 4, 5e5, 0.0),
        tip(cubic.clone(), 4, 5e5, 0.0),
    ];
    for degrees in [30.0f64, 45.0, 90.0] {
        let angle = degrees.to_radians();
        let turned = [
            tip(linear.clone(), 4, 5e5, angle),
            tip(cubic.clone(), 4, 5e5, angle),
        ];
        for (straight, turned) in straight.iter().zip(&turned) {
            let (sine, cosine) = angle.sin_cos();
            let expected = [
                cosine * straight[0] - sine * straight[1],
                sine * straight[0] + cosine * straight[1],
            ];
            for axis in 0..2 {
                assert!((turned[axis] - expected[axis]).abs() < 1e-10);
            }
        }
    }
}
