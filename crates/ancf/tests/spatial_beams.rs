//! The spatial beams: the checks of every element, their energy against its definition, the plane
//! case against the planar beams, torsion and the linear cantilever against closed forms.
//!
//! The fixed elements are stubby (height and width about half the length), so that every term of the
//! energy is of an order that the tolerances see.

use ancf::checks::deformed_state;
use ancf::element::{BeltBeam2, BeltBeam3, Element, LinearBeam2, LinearBeam3};
use ancf::material::Isotropic;
use ancf::quadrature::Rule;
use ancf::section::{SHEAR_CORRECTION, SpatialSection};
use faer::Mat;
use faer::linalg::solvers::Solve;
use num_dual::{Dual64, DualNum};
use proptest::prelude::*;

const MATERIAL: Isotropic = Isotropic {
    youngs_modulus: 1e8,
    poisson_ratio: 0.3,
    density: 1036.0,
};

const LENGTH: f64 = 0.05;
const WIDTH: f64 = 0.018;
const HEIGHT: f64 = 0.025;

/// Density times volume.
const MASS: f64 = 1036.0 * 0.018 * 0.025 * 0.05;

/// alpha1 and alpha2 of the belt beam in most tests.
const FACTORS: [f64; 2] = [0.7, 0.4];

fn section() -> SpatialSection {
    SpatialSection::rectangle(WIDTH, HEIGHT)
}

fn linear() -> LinearBeam3 {
    LinearBeam3::new(LENGTH, &section(), &MATERIAL)
}

fn belt([axial_factor, bending_factor]: [f64; 2]) -> BeltBeam3 {
    BeltBeam3::new(LENGTH, &section(), &MATERIAL, axial_factor, bending_factor)
}

ancf::line_element_checks!(linear_beam: linear(), mass: MASS);
ancf::line_element_checks!(linear_beam_with_torsion_factor: linear().with_torsion_factor(0.6), mass: MASS);
ancf::line_element_checks!(belt_beam: belt([1.0, 1.0]), mass: MASS);
ancf::line_element_checks!(belt_beam_with_factors: belt(FACTORS).with_torsion_factor(0.6), mass: MASS);

/// A position by (x, y, z); derivatives by dual numbers.
fn gradient(position: impl Fn([Dual64; 3]) -> [Dual64; 3], at: [f64; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|axis| {
        let mut at = at.map(Dual64::from_re);
        at[axis].eps = 1.0;
        position(at).map(|value| value.eps)
    })
}

fn dot<T: Copy + std::ops::Mul<Output = T> + std::ops::Add<Output = T>>(a: [T; 3], b: [T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Points (y, z, area) of a section rule that is exact for the energy: it is of degree 4 in y and z.
fn section_points() -> Vec<[f64; 3]> {
    let rule = Rule::gauss(3.try_into().unwrap());
    let mut points = Vec::new();
    for (eta, a) in rule.points.iter().zip(&rule.weights) {
        for (zeta, b) in rule.points.iter().zip(&rule.weights) {
            let (y, z) = (HEIGHT * (eta - 0.5), WIDTH * (zeta - 0.5));
            points.push([y, z, HEIGHT * WIDTH * a * b]);
        }
    }
    points
}

/// Kerkkänen (2006) 4.20-4.22 and 4.34 as printed: positions differentiated by dual numbers, the
/// section by quadrature, one point along x. Round-off alone is left.
#[test]
fn linear_beam_energy_is_the_integral_of_its_strains() {
    let (youngs, shear) = (MATERIAL.youngs_modulus, MATERIAL.shear_modulus());
    for seed in 0..6 {
        let e = deformed_state(&linear(), seed);
        let position = |[x, y, z]: [Dual64; 3]| -> [Dual64; 3] {
            let xi = x / LENGTH;
            std::array::from_fn(|i| {
                let node = |k: usize| y * e[9 * k + 3 + i] + z * e[9 * k + 6 + i] + e[9 * k + i];
                node(0) * (-xi + 1.0) + node(1) * xi
            })
        };
        let mut expected = 0.0;
        for [y, z, area] in section_points() {
            let [rx, ry, rz] = gradient(position, [0.5 * LENGTH, y, z]);
            let normal = |r: [f64; 3]| 0.5 * (dot(r, r) - 1.0);
            let squares = normal(rx).powi(2) + normal(ry).powi(2) + normal(rz).powi(2);
            let sheared = SHEAR_CORRECTION * (dot(rx, ry).powi(2) + dot(rx, rz).powi(2))
                + dot(ry, rz).powi(2);
            expected += 0.5 * (youngs * squares + shear * sheared) * area * LENGTH;
        }
        let energy = linear().energy(&e);
        assert!(
            (energy - expected).abs() < 1e-13 * expected,
            "{energy} {expected}"
        );
    }
}

fn norm(a: [Dual64; 3]) -> Dual64 {
    dot(a, a).sqrt()
}

fn unit(a: [Dual64; 3]) -> [Dual64; 3] {
    let length = norm(a);
    a.map(|value| value / length)
}

fn cross(a: [Dual64; 3], b: [Dual64; 3]) -> [Dual64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Kerkkänen (2006) 4.23-4.42 as printed, frames by cross products: vectors differentiated by dual
/// numbers, the section by quadrature, alpha1 on the squared axial term and alpha2 on all else.
#[test]
fn belt_beam_energy_is_the_integral_of_its_strains() {
    let element = belt(FACTORS);
    let [axial_factor, bending_factor] = FACTORS;
    let (youngs, shear) = (MATERIAL.youngs_modulus, MATERIAL.shear_modulus());
    let along = Rule::gauss(5.try_into().unwrap());
    for seed in 0..6 {
        let e = deformed_state(&element, seed);
        let vector = |k: usize| -> [Dual64; 3] { std::array::from_fn(|i| e[3 * k + i].into()) };
        let strain = |k: usize| norm(vector(k)).re - 1.0;
        let shear_of =
            |node: usize, k: usize| dot(unit(vector(4 * node + 1)), unit(vector(4 * node + k))).re;
        let mut expected = 0.0;
        for (xi, weight) in along.points.iter().zip(&along.weights) {
            let linear = |first: f64, second: f64| first * (1.0 - xi) + second * xi;
            let x = Dual64::new(xi * LENGTH, 1.0);
            let z = x / LENGTH;
            let slopes = [
                (z * z - z) * 6.0 / LENGTH,
                -(z * 4.0) + z * z * 3.0 + 1.0,
                (z - z * z) * 6.0 / LENGTH,
                z * z * 3.0 - z * 2.0,
            ];
            let c: [Dual64; 3] = std::array::from_fn(|i| {
                let hermite = [0, 1, 4, 5].map(|k: usize| vector(k)[i]);
                (0..4).map(|k| slopes[k] * hermite[k]).sum::<Dual64>()
            });
            let t = unit(c);
            let across = |k: usize| -> [Dual64; 3] {
                std::array::from_fn(|i| vector(k)[i] * (-z + 1.0) + vector(4 + k)[i] * z)
            };
            let n_y = cross(unit(cross(t, across(2))), t);
            let b_z = cross(t, unit(cross(across(3), t)));
            let sheared = |normal: [Dual64; 3], k: usize| -> [Dual64; 3] {
                let tau = (-z + 1.0) * shear_of(0, k) + z * shear_of(1, k);
                std::array::from_fn(|i| normal[i] + tau * t[i])
            };
            let (s_y, s_z) = (sheared(n_y, 2), sheared(b_z, 3));
            let (c, u, v) = (c.map(|a| a.re), s_y.map(|a| a.re), s_z.map(|a| a.re));
            let (du, dv) = (s_y.map(|a| a.eps), s_z.map(|a| a.eps));
            let eyy = linear(strain(2), strain(6));
            let ezz = linear(strain(3), strain(7));
            let eyz = 0.5 * linear(dot(vector(2), vector(3)).re, dot(vector(6), vector(7)).re);
            for [y, z, area] in section_points() {
                let axial = 0.5 * (dot(c, c) - 1.0);
                let rx: [f64; 3] = std::array::from_fn(|i| c[i] + y * du[i] + z * dv[i]);
                let exx = 0.5 * (dot(rx, rx) - 1.0);
                let (exy, exz) = (0.5 * dot(rx, u), 0.5 * dot(rx, v));
                let density = 0.5
                    * youngs
                    * (axial_factor * axial.powi(2)
                        + bending_factor * (exx.powi(2) - axial.powi(2))
                        + eyy.powi(2)
                        + ezz.powi(2))
                    + 2.0
                        * shear
                        * (bending_factor * SHEAR_CORRECTION * (exy.powi(2) + exz.powi(2))
                            + eyz.powi(2));
                expected += density * area * weight * LENGTH;
            }
        }
        let energy = element.energy(&e);
        assert!(
            (energy - expected).abs() < 1e-13 * expected,
            "{energy} {expected}"
        );
    }
}

/// The planar element's state as a spatial one: r_z along the global z, out of the plane.
fn lifted<P: Element, E: Element>(planar: &[f64]) -> Vec<f64> {
    let mut e = Vec::new();
    for node in planar.chunks(P::NODE_DOF) {
        for vector in node.chunks(2) {
            e.extend([vector[0], vector[1], 0.0]);
        }
        e.extend([0.0, 0.0, 1.0]);
    }
    assert_eq!(e.len(), E::DOF);
    e
}

/// Energy, force and tangent in the plane equal the planar element's, and nothing pushes out of the
/// plane: 1e-12 of the largest entry, round-off of a few hundred operations.
fn assert_planar<P: Element, E: Element>(planar: &P, spatial: &E) {
    let in_plane: Vec<usize> = (0..E::DOF)
        .filter(|i| i % E::NODE_DOF < 3 * (E::NODE_VECTORS - 1) && i % 3 < 2)
        .collect();
    for seed in 0..6 {
        let e = deformed_state(planar, seed);
        let lifted = lifted::<P, E>(&e);
        let (a, b) = (planar.energy(&e), spatial.energy(&lifted));
        assert!((a - b).abs() < 1e-12 * a, "energy {a} {b}");
        let (mut a, mut b) = (vec![0.0; P::DOF], vec![0.0; E::DOF]);
        planar.force(&e, &mut a);
        spatial.force(&lifted, &mut b);
        let largest = a.iter().fold(0.0f64, |most, f| most.max(f.abs()));
        for (i, k) in in_plane.iter().enumerate() {
            assert!((a[i] - b[*k]).abs() < 1e-12 * largest, "force {i}");
            b[*k] = 0.0;
        }
        assert!(b.iter().all(|f| f.abs() < 1e-12 * largest), "{b:?}");
        let (mut a, mut b) = (vec![0.0; P::DOF * P::DOF], vec![0.0; E::DOF * E::DOF]);
        planar.stiffness(&e, &mut a);
        spatial.stiffness(&lifted, &mut b);
        let largest = a.iter().fold(0.0f64, |most, k| most.max(k.abs()));
        for (i, row) in in_plane.iter().enumerate() {
            for (j, column) in in_plane.iter().enumerate() {
                let (a, b) = (a[i * P::DOF + j], b[row * E::DOF + column]);
                assert!((a - b).abs() < 1e-12 * largest, "tangent {i} {j}: {a} {b}");
            }
        }
    }
}

#[test]
fn in_the_plane_they_are_the_planar_beams() {
    let planar = section().planar();
    assert_planar(&LinearBeam2::new(LENGTH, &planar, &MATERIAL), &linear());
    let [axial_factor, bending_factor] = FACTORS;
    let planar = BeltBeam2::new(
        LENGTH,
        &planar,
        &MATERIAL,
        axial_factor,
        bending_factor,
        0.0,
    );
    assert_planar(&planar, &belt(FACTORS));
}

/// Stiffness against the linearised twist that turns the second node's r_y and r_z by one radian.
fn torsion_stiffness<E: Element>(element: &E) -> f64 {
    let mut reference = vec![0.0; E::DOF];
    element.reference(&mut reference);
    let mut stiffness = vec![0.0; E::DOF * E::DOF];
    element.stiffness(&reference, &mut stiffness);
    let mut twist = vec![0.0; E::DOF];
    // r_y = e_y + phi e_z, r_z = e_z - phi e_y, the last two vectors of the second node.
    twist[E::DOF - 4] = 1.0;
    twist[E::DOF - 2] = -1.0;
    let mut sum = 0.0;
    for i in 0..E::DOF {
        for j in 0..E::DOF {
            sum += twist[i] * stiffness[i * E::DOF + j] * twist[j];
        }
    }
    sum
}

/// `ks G (Iy + Iz) / l` with plane sections, `G J / l` with the factor for Saint-Venant's. Round-off.
#[test]
fn torsion_stiffness_is_that_of_plane_sections_or_saint_venants() {
    for section in [
        section(),
        SpatialSection::rectangle(0.05, 0.002),
        SpatialSection::circle(0.01),
        SpatialSection::tube(0.01, 0.008),
    ] {
        let polar = section.second_moment_y + section.second_moment_z;
        let plane = SHEAR_CORRECTION * MATERIAL.shear_modulus() * polar / LENGTH;
        let warped = MATERIAL.shear_modulus() * section.torsion_constant / LENGTH;
        let linear = LinearBeam3::new(LENGTH, &section, &MATERIAL);
        let belt = BeltBeam3::new(LENGTH, &section, &MATERIAL, 1.0, 1.0);
        let factor = section.saint_venant_torsion_factor();
        for (value, expected) in [
            (torsion_stiffness(&linear), plane),
            (torsion_stiffness(&belt), plane),
            (
                torsion_stiffness(&linear.with_torsion_factor(factor)),
                warped,
            ),
            (torsion_stiffness(&belt.with_torsion_factor(factor)), warped),
        ] {
            assert!((value / expected - 1.0).abs() < 1e-12, "{value} {expected}");
        }
    }
}

/// Tip deflection by a unit force along y (axis 1) or z (axis 2) of a cantilever of equal elements,
/// linearised, with r and the slopes across fixed at the root, r_x free.
fn cantilever<E: Element>(element: &E, elements: usize, axis: usize) -> f64 {
    let size = (elements + 1) * E::NODE_DOF;
    let mut reference = vec![0.0; E::DOF];
    element.reference(&mut reference);
    let mut local = vec![0.0; E::DOF * E::DOF];
    element.stiffness(&reference, &mut local);
    let mut stiffness = Mat::<f64>::zeros(size, size);
    for first in (0..elements).map(|i| i * E::NODE_DOF) {
        for i in 0..E::DOF {
            for j in 0..E::DOF {
                stiffness[(first + i, first + j)] += local[i * E::DOF + j];
            }
        }
    }
    let across = E::NODE_DOF - 6;
    for fixed in (0..3).chain(across..E::NODE_DOF) {
        for other in 0..size {
            stiffness[(fixed, other)] = 0.0;
            stiffness[(other, fixed)] = 0.0;
        }
        stiffness[(fixed, fixed)] = 1.0;
    }
    let mut load = Mat::<f64>::zeros(size, 1);
    let tip = elements * E::NODE_DOF + axis;
    load[(tip, 0)] = 1.0;
    stiffness.partial_piv_lu().solve(&load)[(tip, 0)]
}

/// Timoshenko's cantilever, `F L³ / 3 E I + F L / ks G A`, in both planes. One belt beam is exact (a
/// cubic line, a constant shear); n linear beams lack `1 / 4 n²` of the bending part. The tolerance is
/// the round-off of a solution with condition number 1e5.
#[test]
fn cantilevers_have_their_closed_forms() {
    let section = section();
    let total = 4.0 * LENGTH;
    let shear = total / (SHEAR_CORRECTION * MATERIAL.shear_modulus() * section.area);
    for (axis, moment) in [(1, section.second_moment_y), (2, section.second_moment_z)] {
        let bending = total.powi(3) / (3.0 * MATERIAL.youngs_modulus * moment);
        for n in [1, 2, 5, 16] {
            let length = total / n as f64;
            let value = cantilever(&LinearBeam3::new(length, &section, &MATERIAL), n, axis);
            let expected = bending * (1.0 - 0.25 / (n as f64).powi(2)) + shear;
            assert!((value / expected - 1.0).abs() < 1e-10, "{value} {expected}");
        }
        let one = BeltBeam3::new(total, &section, &MATERIAL, 1.0, 1.0);
        let value = cantilever(&one, 1, axis);
        assert!(
            (value / (bending + shear) - 1.0).abs() < 1e-10,
            "{value} {}",
            bending + shear
        );
    }
}

/// Any plausible material, section and length: heights from a tenth of the length to the length.
fn any_beam() -> impl Strategy<Value = (Isotropic, SpatialSection, f64)> {
    let section = (0usize..3, 0.1..1.0f64, 0.3..3.0f64);
    (
        3.0..12.0f64,
        -0.5..0.45f64,
        1.0..2e4f64,
        1e-3..1e2f64,
        section,
    )
        .prop_map(
            |(exponent, poisson_ratio, density, length, (shape, slenderness, aspect))| {
                let height = slenderness * length;
                let section = match shape {
                    0 => SpatialSection::rectangle(aspect * height, height),
                    1 => SpatialSection::circle(height / 2.0),
                    _ => SpatialSection::tube(height / 2.0, height / 3.0),
                };
                let material = Isotropic {
                    youngs_modulus: 10f64.powf(exponent),
                    poisson_ratio,
                    density,
                };
                (material, section, length)
            },
        )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, ..ProptestConfig::default() })]

    #[test]
    fn any_spatial_beam_passes(
        (material, section, length) in any_beam(),
        axial_factor in 0.1..2.0f64,
        bending_factor in 0.01..2.0f64,
        torsion_factor in 0.1..1.5f64,
    ) {
        let mass = material.density * section.area * length;
        let linear = LinearBeam3::new(length, &section, &material);
        ancf::checks::all(&linear.with_torsion_factor(torsion_factor), mass);
        let belt = BeltBeam3::new(length, &section, &material, axial_factor, bending_factor);
        ancf::checks::all(&belt.with_torsion_factor(torsion_factor), mass);
    }
}
