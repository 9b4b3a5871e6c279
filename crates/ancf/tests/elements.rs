//! Every element against the checks of `ancf::checks`: derivatives, invariances, mass, lanes.
//!
//! The fixed elements are stubby (height half the length) so that every term of the energy is of an
//! order that the tolerances see; the property tests vary material, section and length.

use ancf::checks::deformed_state;
use ancf::element::{BeltBeam2, Element};
use ancf::material::Isotropic;
use ancf::quadrature::Rule;
use ancf::section::PlanarSection;
use num_dual::Dual64;
use proptest::prelude::*;

const MATERIAL: Isotropic = Isotropic {
    youngs_modulus: 1e8,
    poisson_ratio: 0.3,
    density: 1036.0,
};

const LENGTH: f64 = 0.05;
const WIDTH: f64 = 0.01;
const HEIGHT: f64 = 0.025;

/// 1036 kg/m³ times 0.01 x 0.025 m² times 0.05 m.
const MASS: f64 = 0.01295;

fn section() -> PlanarSection {
    PlanarSection::rectangle(WIDTH, HEIGHT)
}

fn belt(axial_factor: f64, bending_factor: f64, damping_time: f64) -> BeltBeam2 {
    BeltBeam2::new(
        LENGTH,
        &section(),
        &MATERIAL,
        axial_factor,
        bending_factor,
        damping_time,
    )
}

ancf::line_element_checks!(belt_beam: belt(1.0, 1.0, 0.0), mass: MASS);
ancf::line_element_checks!(belt_beam_with_factors: belt(0.7, 0.4, 0.0), mass: MASS);
ancf::line_element_checks!(damped_belt_beam: belt(0.7, 0.4, 3e-4), mass: MASS);

/// Kerkkänen (2006) 3.8-3.19 as printed: vectors, their derivatives by dual numbers, and the section
/// by quadrature. Even powers of y alone carry energy; the constant term of exx is the one with alpha1.
#[test]
fn belt_beam_energy_is_the_integral_of_its_strains() {
    let (axial_factor, bending_factor) = (0.7, 0.4);
    let element = belt(axial_factor, bending_factor, 0.0);
    let (youngs, shear) = (
        MATERIAL.youngs_modulus,
        5.0 / 6.0 * MATERIAL.shear_modulus(),
    );
    let along = Rule::gauss(5.try_into().unwrap());
    let across = Rule::gauss(3.try_into().unwrap());
    for seed in 0..6 {
        let e = deformed_state(&element, seed);
        let vector = |k: usize| [e[2 * k], e[2 * k + 1]];
        let norm = |v: [f64; 2]| v[0].hypot(v[1]);
        let nodal_sine = |node: usize| {
            let (rx, ry) = (vector(3 * node + 1), vector(3 * node + 2));
            -(rx[0] * ry[0] + rx[1] * ry[1]) / (norm(rx) * norm(ry))
        };
        let mut expected = 0.0;
        for (xi, weight) in along.points.iter().zip(&along.weights) {
            // c and s as functions of x: value and derivative.
            let x = Dual64::new(xi * LENGTH, 1.0);
            let z = x / LENGTH;
            let slopes = [
                (z * z - z) * 6.0 / LENGTH,
                -(z * 4.0) + z * z * 3.0 + 1.0,
                (z - z * z) * 6.0 / LENGTH,
                z * z * 3.0 - z * 2.0,
            ];
            let c: [Dual64; 2] = std::array::from_fn(|axis| {
                slopes[0] * vector(0)[axis]
                    + slopes[1] * vector(1)[axis]
                    + slopes[2] * vector(3)[axis]
                    + slopes[3] * vector(4)[axis]
            });
            let f = num_dual::DualNum::sqrt(&(c[0] * c[0] + c[1] * c[1]));
            let t = [c[0] / f, c[1] / f];
            let sine = -(z - 1.0) * nodal_sine(0) + z * nodal_sine(1);
            let s = [-t[1] - sine * t[0], t[0] - sine * t[1]];
            let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
            let (c, ds, s) = (c.map(|v| v.re), s.map(|v| v.eps), s.map(|v| v.re));
            let eyy = (norm(vector(2)) - 1.0) * (1.0 - xi) + (norm(vector(5)) - 1.0) * xi;
            for (eta, share) in across.points.iter().zip(&across.weights) {
                let y = (eta - 0.5) * HEIGHT;
                let exx = [
                    0.5 * (dot(c, c) - 1.0),
                    dot(c, ds) * y,
                    0.5 * dot(ds, ds) * y * y,
                ];
                let bending = (exx[0] + exx[2]).powi(2) - exx[0].powi(2) + exx[1].powi(2);
                let exy = [0.5 * dot(c, s), 0.5 * dot(ds, s) * y];
                let density =
                    0.5 * youngs * (axial_factor * exx[0].powi(2) + bending_factor * bending)
                        + 2.0 * shear * bending_factor * (exy[0].powi(2) + exy[1].powi(2))
                        + 0.5 * youngs * eyy * eyy;
                expected += density * weight * share * LENGTH * WIDTH * HEIGHT;
            }
        }
        let energy = element.energy(&e);
        assert!(
            (energy - expected).abs() < 1e-13 * expected,
            "{energy} {expected}"
        );
    }
}

/// Any plausible material, section and length: heights from a tenth of the length to the length.
fn any_beam() -> impl Strategy<Value = (Isotropic, PlanarSection, f64)> {
    let section = (0usize..3, 0.1..1.0f64, 0.1..10.0f64);
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
                    0 => PlanarSection::rectangle(aspect * height, height),
                    1 => PlanarSection::circle(height / 2.0),
                    _ => PlanarSection::tube(height / 2.0, height / 3.0),
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
    #![proptest_config(ProptestConfig { cases: 32, ..ProptestConfig::default() })]

    #[test]
    fn any_belt_beam_passes(
        (material, section, length) in any_beam(),
        axial_factor in 0.1..2.0f64,
        bending_factor in 0.01..2.0f64,
        damping_time in prop_oneof![Just(0.0), 1e-6..1.0f64],
    ) {
        let element = BeltBeam2::new(
            length, &section, &material, axial_factor, bending_factor, damping_time,
        );
        ancf::checks::all(&element, material.density * section.area * length);
    }
}
