//! The thin plate: the checks of every element, its energy and shape functions against their
//! definition, patch tests, and its assembly in strips.
//!
//! The fixed elements are stubby (thickness about half the length), so that membrane and bending
//! energy are of the same order.

use ancf::checks::{self, deformed_state};
use ancf::element::{BendingRigidity, Element, PlateQuadrature, SurfaceElement, ThinPlate};
use ancf::linear::{BorderedMatrix, CyclicSolver, Solver, Structure};
use ancf::material::Isotropic;
use ancf::mesh::Mesh;
use ancf::quadrature::Rule;
use faer::Mat;
use proptest::prelude::*;

const MATERIAL: Isotropic = Isotropic {
    youngs_modulus: 1e8,
    poisson_ratio: 0.3,
    density: 1036.0,
};

const LENGTH: f64 = 0.05;
const WIDTH: f64 = 0.04;
const THICKNESS: f64 = 0.02;

/// Density times volume.
const MASS: f64 = 1036.0 * 0.05 * 0.04 * 0.02;

fn plate(rigidity: BendingRigidity) -> ThinPlate {
    ThinPlate::new(LENGTH, WIDTH, THICKNESS, &MATERIAL, rigidity)
}

ancf::element_checks!(thin_plate: plate(BendingRigidity::Kirchhoff), mass: MASS);
ancf::element_checks!(thin_plate_with_printed_rigidity: plate(BendingRigidity::Printed), mass: MASS);

/// A membrane has free motions beside the rigid ones; all else holds.
#[test]
fn membrane_passes_the_checks_but_for_free_modes() {
    let membrane = plate(BendingRigidity::None);
    checks::force_is_minus_the_energy_gradient(&membrane);
    checks::tangent_is_the_hessian(&membrane);
    checks::rigid_motion_stores_nothing(&membrane);
    checks::energy_is_objective(&membrane);
    checks::force_and_moment_sums_vanish(&membrane);
    checks::lanes_equal_plain_numbers(&membrane);
    checks::mass_is_consistent(&membrane, MASS);
}

/// Exponents of x and y of the 12 terms.
const TERMS: [[i32; 2]; 12] = [
    [0, 0],
    [1, 0],
    [0, 1],
    [2, 0],
    [1, 1],
    [0, 2],
    [3, 0],
    [2, 1],
    [1, 2],
    [0, 3],
    [3, 1],
    [1, 3],
];

/// A surface by the coefficients of its terms, in units of the length.
struct Surface([[f64; 3]; 12]);

impl Surface {
    /// The flat reference, bent, stretched and sheared by every term.
    fn bent(amplitude: f64) -> Self {
        let mut coefficients = [[0.0; 3]; 12];
        coefficients[1][0] = 1.0;
        coefficients[2][1] = 1.0;
        for (k, vector) in coefficients.iter_mut().enumerate() {
            for (i, value) in vector.iter_mut().enumerate() {
                *value += amplitude * (1.7 * k as f64 + 2.3 * i as f64).sin();
            }
        }
        Self(coefficients)
    }

    /// The derivative of the given orders.
    fn derivative(&self, orders: [i32; 2], at: [f64; 2]) -> [f64; 3] {
        std::array::from_fn(|i| {
            let mut sum = 0.0;
            for (term, coefficient) in TERMS.iter().zip(&self.0) {
                let mut value = coefficient[i] * LENGTH;
                for axis in 0..2 {
                    let (exponent, order) = (term[axis], orders[axis]);
                    let factor: i32 = (0..order).map(|k| exponent - k).product();
                    if exponent < order {
                        value = 0.0;
                        break;
                    }
                    value *= f64::from(factor)
                        * (at[axis] / LENGTH).powi(exponent - order)
                        * LENGTH.powi(-order);
                }
                sum += value;
            }
            sum
        })
    }

    fn coordinates(&self) -> Vec<f64> {
        let mut e = Vec::new();
        for place in ThinPlate::NODE_PLACES {
            let at = [LENGTH * place[0] as f64, WIDTH * place[1] as f64];
            for orders in [[0, 0], [1, 0], [0, 1]] {
                e.extend(self.derivative(orders, at));
            }
        }
        e
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The shape functions reproduce every surface of the 12 terms and its slopes. Round-off.
#[test]
fn shape_functions_span_the_twelve_terms() {
    let plate = plate(BendingRigidity::Kirchhoff);
    let surface = Surface::bent(0.2);
    let e = surface.coordinates();
    for place in [[0.0, 0.0], [1.0, 0.3], [0.2, 0.9], [0.55, 0.4]] {
        let at = [LENGTH * place[0], WIDTH * place[1]];
        let mut weights = [0.0; 12];
        plate.surface(place, &mut weights);
        let position: [f64; 3] =
            std::array::from_fn(|i| (0..12).map(|k| weights[k] * e[3 * k + i]).sum());
        let gradient = plate.surface_gradient(&e, place);
        for (value, orders) in [
            (position, [0, 0]),
            (gradient.x, [1, 0]),
            (gradient.y, [0, 1]),
        ] {
            let expected = surface.derivative(orders, at);
            for i in 0..3 {
                assert!(
                    (value[i] - expected[i]).abs() < 1e-14,
                    "{orders:?} at {place:?}"
                );
            }
        }
        let stress = plate.membrane_forces(&plate.surface_gradient(&e, place));
        let [xx, yy, xy] = gradient.green();
        let stiffness = 1e8 * THICKNESS / (1.0 - 0.09);
        for (value, expected) in stress.into_iter().zip([
            stiffness * (xx + 0.3 * yy),
            stiffness * (yy + 0.3 * xx),
            stiffness * 0.7 * xy,
        ]) {
            assert!((value - expected).abs() < 1e-12 * stiffness);
        }
    }
}

/// Kerkkänen (2006) 4.16-4.18 as printed on surfaces of the 12 terms, whose derivatives are known in
/// closed form, with the element's Gauss points; the two rigidities differ by 1 - nu². Round-off.
#[test]
fn energy_is_the_integral_of_its_strains() {
    let nu = MATERIAL.poisson_ratio;
    let plane = MATERIAL.youngs_modulus / (1.0 - nu * nu);
    let form =
        |xx: f64, yy: f64, xy: f64| (xx + yy).powi(2) - 2.0 * (1.0 - nu) * (xx * yy - xy * xy);
    let integrate = |count: usize, density: &dyn Fn([f64; 2]) -> f64| {
        let rule = Rule::gauss(count.try_into().unwrap());
        let mut sum = 0.0;
        for (xi, a) in rule.points.iter().zip(&rule.weights) {
            for (eta, b) in rule.points.iter().zip(&rule.weights) {
                sum += a * b * LENGTH * WIDTH * density([xi * LENGTH, eta * WIDTH]);
            }
        }
        sum
    };
    let quadrature = PlateQuadrature::default();
    for amplitude in [0.02, 0.2] {
        let surface = Surface::bent(amplitude);
        let slopes = |at: [f64; 2]| [[1, 0], [0, 1]].map(|orders| surface.derivative(orders, at));
        let membrane = integrate(quadrature.membrane, &|at| {
            let [a, b] = slopes(at);
            let strains = (0.5 * (dot(a, a) - 1.0), 0.5 * (dot(b, b) - 1.0));
            0.5 * plane * THICKNESS * form(strains.0, strains.1, 0.5 * dot(a, b))
        });
        let bending = integrate(quadrature.bending, &|at| {
            let [a, b] = slopes(at);
            let cross = [
                a[1] * b[2] - a[2] * b[1],
                a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0],
            ];
            let area = dot(cross, cross).sqrt();
            let curvature = |orders: [i32; 2], scale: f64| {
                dot(surface.derivative(orders, at), cross) / (area * scale)
            };
            0.5 * plane * THICKNESS.powi(3) / 12.0
                * form(
                    curvature([2, 0], dot(a, a)),
                    curvature([0, 2], dot(b, b)),
                    curvature([1, 1], (dot(a, a) * dot(b, b)).sqrt()),
                )
        });
        let e = surface.coordinates();
        for (rigidity, expected) in [
            (BendingRigidity::Kirchhoff, membrane + bending),
            (
                BendingRigidity::Printed,
                membrane + bending * (1.0 - nu * nu),
            ),
            (BendingRigidity::None, membrane),
        ] {
            let energy = plate(rigidity).energy(&e);
            assert!(
                (energy / expected - 1.0).abs() < 1e-12,
                "{rigidity:?}: {energy} {expected}"
            );
        }
    }
}

/// A patch of 2 x 2 unequal rectangles whose middle node is inside.
struct Patch {
    elements: [ThinPlate; 4],
    /// Position of each of the nine nodes, row by row.
    nodes: [[f64; 2]; 9],
}

impl Patch {
    fn new() -> Self {
        let (x, y) = ([0.0, 0.03, 0.08], [0.0, 0.05, 0.07]);
        let element = |i: usize, j: usize| {
            ThinPlate::new(
                x[i + 1] - x[i],
                y[j + 1] - y[j],
                THICKNESS,
                &MATERIAL,
                BendingRigidity::Kirchhoff,
            )
        };
        Self {
            elements: [element(0, 0), element(0, 1), element(1, 0), element(1, 1)],
            nodes: std::array::from_fn(|k| [x[k / 3], y[k % 3]]),
        }
    }

    /// Coordinates of the patch from r, r_x, r_y as functions of the place.
    fn coordinates(&self, vectors: impl Fn([f64; 2]) -> [[f64; 3]; 3]) -> Vec<f64> {
        self.nodes
            .iter()
            .flat_map(|at| vectors(*at).into_iter().flatten())
            .collect()
    }

    /// The coordinates of an element and where they lie.
    fn places(element: usize) -> Vec<usize> {
        let (i, j) = (element / 2, element % 2);
        ThinPlate::NODE_PLACES
            .iter()
            .flat_map(|place| {
                let node = 3 * (i + place[0]) + j + place[1];
                9 * node..9 * node + 9
            })
            .collect()
    }
}

/// Homogeneous deformation of unequal rectangles: no force on the inner node, finite strain. Round-off
/// beside the largest nodal force.
#[test]
fn membrane_patch_test() {
    let patch = Patch::new();
    let (f_x, f_y) = ([1.2, 0.1, -0.3], [-0.2, 0.9, 0.25]);
    let q =
        patch.coordinates(|[x, y]| [std::array::from_fn(|i| f_x[i] * x + f_y[i] * y), f_x, f_y]);
    let mut total = [0.0; 81];
    let mut largest = 0.0f64;
    for (k, element) in patch.elements.iter().enumerate() {
        let places = Patch::places(k);
        let e: Vec<f64> = places.iter().map(|place| q[*place]).collect();
        let mut force = [0.0; 36];
        element.force(&e[..], &mut force);
        for (place, value) in places.into_iter().zip(force) {
            total[place] += value;
            largest = largest.max(value.abs());
        }
    }
    for i in 36..45 {
        assert!(
            total[i].abs() < 1e-13 * largest,
            "{} of {largest}",
            total[i]
        );
    }
}

/// Constant curvature and twist, linearised: no force on the inner node, and the energy is exact
/// although the elements do not conform. Round-off beside the largest term of a nodal force.
#[test]
fn bending_patch_test() {
    let patch = Patch::new();
    let nu = MATERIAL.poisson_ratio;
    let rigidity = MATERIAL.youngs_modulus * THICKNESS.powi(3) / (12.0 * (1.0 - nu * nu));
    for [xx, yy, xy] in [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.4, -0.7, 0.9],
    ] {
        let change = patch.coordinates(|[x, y]| {
            [
                [0.0, 0.0, 0.5 * (xx * x * x + yy * y * y) + xy * x * y],
                [0.0, 0.0, xx * x + xy * y],
                [0.0, 0.0, yy * y + xy * x],
            ]
        });
        let mut total = [0.0; 81];
        let (mut largest, mut energy) = (0.0f64, 0.0);
        for (k, element) in patch.elements.iter().enumerate() {
            let mut stiffness = vec![0.0; 36 * 36];
            element.stiffness(&checks::reference(element), &mut stiffness);
            let places = Patch::places(k);
            for (i, row) in places.iter().enumerate() {
                let mut force = 0.0;
                for j in 0..36 {
                    let product: f64 = stiffness[36 * i + j] * change[places[j]];
                    force += product;
                    largest = largest.max(product.abs());
                }
                total[*row] += force;
                energy += 0.5 * force * change[*row];
            }
        }
        for i in 36..45 {
            assert!(
                total[i].abs() < 1e-12 * largest,
                "{} of {largest}",
                total[i]
            );
        }
        let form = (xx + yy).powi(2) - 2.0 * (1.0 - nu) * (xx * yy - xy * xy);
        let expected = 0.5 * rigidity * form * 0.08 * 0.07;
        assert!(
            (energy / expected - 1.0).abs() < 1e-11,
            "{energy} {expected}"
        );
    }
}

/// A strip assembled by hand.
struct ByHand {
    /// Any state, all nodes off the plane.
    q: Vec<f64>,
    energy: f64,
    force: Vec<f64>,
    tangent: Mat<f64>,
    mass: Mat<f64>,
}

impl ByHand {
    fn new(elements: &[ThinPlate], across: usize, sections: usize) -> Self {
        let places = |element: usize| -> Vec<usize> {
            let (i, j) = (element / across, element % across);
            ThinPlate::NODE_PLACES
                .iter()
                .flat_map(|place| {
                    let node = (i + place[0]) % sections * (across + 1) + j + place[1];
                    9 * node..9 * node + 9
                })
                .collect()
        };
        let size = 9 * sections * (across + 1);
        let mut by_hand = Self {
            q: vec![0.0; size],
            energy: 0.0,
            force: vec![0.0; size],
            tangent: Mat::zeros(size, size),
            mass: Mat::zeros(size, size),
        };
        for (k, element) in elements.iter().enumerate() {
            let state = deformed_state(element, k as u64);
            for (place, value) in places(k).into_iter().zip(state) {
                by_hand.q[place] = value;
            }
        }
        for (k, element) in elements.iter().enumerate() {
            by_hand.add(element, &places(k));
        }
        by_hand
    }

    fn add(&mut self, element: &ThinPlate, places: &[usize]) {
        let e: Vec<f64> = places.iter().map(|place| self.q[*place]).collect();
        let mut force = [0.0; 36];
        let (mut stiffness, mut mass) = (vec![0.0; 36 * 36], vec![0.0; 144]);
        element.force(&e[..], &mut force);
        element.stiffness(&e[..], &mut stiffness);
        element.vector_mass(&mut mass);
        self.energy += element.energy(&e[..]);
        for (i, row) in places.iter().enumerate() {
            self.force[*row] += force[i];
            for (j, column) in places.iter().enumerate() {
                self.tangent[(*row, *column)] += stiffness[36 * i + j];
                if i % 3 == j % 3 {
                    self.mass[(*row, *column)] += mass[12 * (i / 3) + j / 3];
                }
            }
        }
    }
}

fn assert_close(what: &str, value: f64, expected: f64, scale: f64) {
    assert!(
        (value - expected).abs() < 1e-13 * scale,
        "{what}: {value} {expected}"
    );
}

/// A strip of plates assembled in lanes and by hand, open and closed, one to three elements across:
/// forces, energy, mass and tangent; and the cyclic solver inverts the tangent. Round-off.
#[test]
fn strips_assemble_like_their_elements() {
    for (along, across, closed, equal) in [
        (4, 1, false, true),
        (5, 3, false, true),
        (4, 1, true, true),
        (3, 2, true, false),
    ] {
        let element = |k: usize| {
            let wider = if equal { 0.0 } else { (k % across) as f64 };
            let width = WIDTH * (1.0 + 0.1 * wider);
            let rigidity = BendingRigidity::Kirchhoff;
            ThinPlate::new(LENGTH, width, THICKNESS, &MATERIAL, rigidity)
        };
        let elements: Vec<ThinPlate> = (0..along * across).map(element).collect();
        let mesh = if closed {
            Mesh::closed_strip(elements.clone(), across)
        } else {
            Mesh::open_strip(elements.clone(), across)
        };
        let sections = if closed { along } else { along + 1 };
        assert_eq!(mesh.sections(), sections);
        assert_eq!(mesh.section_dof(), 9 * (across + 1));
        assert_eq!(mesh.nodes(), sections * (across + 1));
        let size = mesh.dof();
        assert_eq!(mesh.scales(LENGTH, WIDTH).len(), size);

        let by_hand = ByHand::new(&elements, across, sections);
        let q = &by_hand.q;
        assert_close("energy", mesh.energy(q), by_hand.energy, by_hand.energy);
        let mut force = vec![0.0; size];
        mesh.add_force(q, q, &mut force);
        let largest = force.iter().fold(0.0f64, |most, f| most.max(f.abs()));
        for (value, expected) in force.iter().zip(&by_hand.force) {
            assert_close("force", *value, *expected, largest);
        }
        let structure = Structure {
            sections,
            block: mesh.section_dof(),
            closed,
            border: 0,
        };
        let mut tangent = BorderedMatrix::new(structure);
        let mut mass = BorderedMatrix::new(structure);
        mesh.add_tangent(q, q, 1.0, 0.0, &mut tangent);
        mesh.add_mass(&mut mass);
        let stiffest = by_hand.tangent.norm_max();
        let heaviest = by_hand.mass.norm_max();
        for (row, column, value) in tangent.triplets() {
            let expected = by_hand.tangent[(row, column)];
            assert_close("tangent", value, expected, stiffest);
        }
        for (row, column, value) in mass.triplets() {
            assert_close("mass", value, by_hand.mass[(row, column)], heaviest);
        }
        // Held to the ground by a multiple of the mass, the tangent has an inverse.
        tangent.add_scaled(1e3 * stiffest / heaviest, &mass);
        let mut solver = CyclicSolver::new(structure);
        solver.factor(&tangent).unwrap();
        let mut x = force.clone();
        solver.solve(&mut x);
        let mut back = vec![0.0; size];
        tangent.multiply(&x, &mut back);
        for (value, expected) in back.iter().zip(&force) {
            assert_close("solution", *value, *expected, 1e2 * largest);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, ..ProptestConfig::default() })]

    #[test]
    fn any_plate_passes(
        exponent in 3.0..12.0f64,
        poisson_ratio in -0.5..0.49f64,
        length in 1e-3..1e2f64,
        aspect in 0.3..3.0f64,
        slenderness in 0.1..1.0f64,
    ) {
        let material = Isotropic {
            youngs_modulus: 10f64.powf(exponent),
            poisson_ratio,
            density: 1036.0,
        };
        let (width, thickness) = (aspect * length, slenderness * length);
        let plate =
            ThinPlate::new(length, width, thickness, &material, BendingRigidity::Kirchhoff);
        checks::all(&plate, 1036.0 * length * width * thickness);
    }
}
