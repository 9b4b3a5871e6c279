//! Structures of spatial beams: closed forms in both planes, equality with the planar structures, bending with torsion,
//! modes, motion, and what they refuse.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use ancf::constraint::ConstraintForm;
use ancf::dynamics::{Control, Method, Pace, integrate};
use ancf::element::{BeltBeam2, BeltBeam3, LineElement, LinearBeam2, LinearBeam3};
use ancf::material::Isotropic;
use ancf::section::{SHEAR_CORRECTION, SpatialSection};
use ancf::structure::{NodeDirection, PlanarStructure, SpatialStructure, StructureError};

const STEEL: Isotropic = Isotropic {
    youngs_modulus: 2.07e11,
    poisson_ratio: 0.3,
    density: 7850.0,
};
const LENGTH: f64 = 1.0;
const AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn section() -> SpatialSection {
    SpatialSection::rectangle(0.04, 0.1)
}

fn cantilever<E: LineElement>(
    element: E,
    count: usize,
    axes: [[f64; 3]; 3],
) -> SpatialStructure<E> {
    let mut beam = SpatialStructure::straight(element, count, [0.1, -0.2, 0.3], axes);
    beam.clamp_section(0);
    beam
}

fn belt(count: usize) -> BeltBeam3 {
    BeltBeam3::new(LENGTH / count as f64, &section(), &STEEL, 1.0, 1.0)
}

fn linear(count: usize) -> LinearBeam3 {
    LinearBeam3::new(LENGTH / count as f64, &section(), &STEEL)
}

/// Timoshenko's cantilever, `F L³ / 3 E I + F L / ks G A`, in both planes of a beam drawn askew. A belt beam is exact;
/// n linear beams lack `1 / 4 n²` of the bending part. Round-off of a solution with condition number 1e6.
#[test]
fn cantilevers_have_their_closed_forms() {
    let (sine, cosine) = 0.7_f64.sin_cos();
    let axes = [[cosine, sine, 0.0], [0.0, 0.0, 1.0], [sine, -cosine, 0.0]];
    let section = section();
    let shear = LENGTH / (SHEAR_CORRECTION * STEEL.shear_modulus() * section.area);
    let tip = |displacements: Vec<f64>, at: usize, axis: [f64; 3]| -> f64 {
        (0..3).map(|i| displacements[at + i] * axis[i]).sum()
    };
    for (k, moment) in [(1, section.second_moment_y), (2, section.second_moment_z)] {
        let bending = LENGTH.powi(3) / (3.0 * STEEL.youngs_modulus * moment);
        for n in [1, 3, 8] {
            let mut one = cantilever(belt(n), n, axes);
            one.force(n, NodeDirection::Position, axes[k]);
            let found = tip(one.linear_displacements().unwrap(), 12 * n, axes[k]);
            let expected = bending + shear;
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
            let mut other = cantilever(linear(n), n, axes);
            other.force(n, NodeDirection::Position, axes[k]);
            let found = tip(other.linear_displacements().unwrap(), 9 * n, axes[k]);
            let expected = bending * (1.0 - 0.25 / (n as f64).powi(2)) + shear;
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        }
    }
}

/// Bent far in one plane, tip at 0.6 of the length below the root, spatial beams are the planar ones: elements are equal,
/// so that Newton's method takes the same steps, and 1e-12 of the length is a hundred times round-off.
#[test]
fn large_deflections_in_the_plane_are_those_of_the_planar_beams() {
    const LOAD: f64 = 3.0e6;
    let n = 8;
    let planar = section().planar();
    let of_planar = {
        let element = BeltBeam2::new(LENGTH / n as f64, &planar, &STEEL, 1.0, 1.0, 0.0);
        let mut beam = PlanarStructure::straight(element, n, [0.0; 2], 0.0);
        for (vector, axis) in [(0, 0), (0, 1), (2, 0), (2, 1)] {
            let vector = match vector {
                0 => ancf::structure::NodeVector::Position,
                _ => ancf::structure::NodeVector::Across,
            };
            let node = 0;
            let at = ancf::structure::Coordinate::Node { node, vector, axis };
            let drawn = [[0.0, 0.0], [0.0, 0.0], [0.0, 1.0]];
            let value = match vector {
                ancf::structure::NodeVector::Position => drawn[0][axis],
                _ => drawn[2][axis],
            };
            beam.prescribe(at, std::sync::Arc::new(ancf::constraint::Constant(value)));
        }
        beam.force(n, [0.0, -LOAD]);
        let bent = beam.equilibrium().unwrap();
        beam.position(&bent.q, n)
    };
    let mut beam = SpatialStructure::straight(belt(n), n, [0.0; 3], AXES);
    beam.clamp_section(0)
        .force(n, NodeDirection::Position, [0.0, -LOAD, 0.0]);
    let bent = beam.equilibrium().unwrap();
    let tip = beam.vector(&bent.q, n, NodeDirection::Position);
    assert!(tip[1] < -0.3, "bent far: {tip:?}");
    assert!((tip[0] - of_planar[0]).abs() < 1e-12 && (tip[1] - of_planar[1]).abs() < 1e-12);
    assert!(tip[2].abs() < 1e-12);
    let reaction = beam.reaction(&bent, 0);
    assert!((reaction[1] / LOAD - 1.0).abs() < 1e-6, "{reaction:?}");

    let element = LinearBeam2::new(LENGTH / n as f64, &planar, &STEEL);
    let mut beam = PlanarStructure::straight(element, n, [0.0; 2], 0.0);
    beam.clamp(0).force(n, [0.0, -LOAD]);
    let bent = beam.equilibrium().unwrap();
    let of_planar = beam.position(&bent.q, n);
    let mut beam = SpatialStructure::straight(linear(n), n, [0.0; 3], AXES);
    beam.clamp(0)
        .force(n, NodeDirection::Position, [0.0, -LOAD, 0.0]);
    let bent = beam.equilibrium().unwrap();
    let tip = beam.vector(&bent.q, n, NodeDirection::Position);
    assert!((tip[0] - of_planar[0]).abs() < 1e-12 && (tip[1] - of_planar[1]).abs() < 1e-12);
}

/// A moment at the tip twists by `M L / k ks G (Iy + Iz)`: linear in x, so any number of elements is exact. It acts on
/// r_y and r_z in the parts of Iy and Iz that resist them, so that the section keeps its right angle.
#[test]
fn a_moment_twists() {
    let section = section();
    let factor = section.saint_venant_torsion_factor();
    let moment = 1.0;
    let expected = moment * LENGTH / (STEEL.shear_modulus() * section.torsion_constant);
    let polar = section.second_moment_y + section.second_moment_z;
    let [on_height, on_width] =
        [section.second_moment_y, section.second_moment_z].map(|part| moment * part / polar);
    let turn = |q: Vec<f64>, at: usize| q[at];
    for n in [1, 5] {
        let mut one = cantilever(belt(n).with_torsion_factor(factor), n, AXES);
        one.force(n, NodeDirection::Height, [0.0, 0.0, on_height])
            .force(n, NodeDirection::Width, [0.0, -on_width, 0.0]);
        let found = turn(one.linear_displacements().unwrap(), 12 * n + 8);
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        let mut other = cantilever(linear(n).with_torsion_factor(factor), n, AXES);
        other
            .force(n, NodeDirection::Height, [0.0, 0.0, on_height])
            .force(n, NodeDirection::Width, [0.0, -on_width, 0.0]);
        let found = turn(other.linear_displacements().unwrap(), 9 * n + 5);
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    }
}

/// Bending and torsion together: a strip on edge, clamped and loaded at its tip, buckles sideways at
/// `F = 4.0126 sqrt(E Iz G J)/L²` (Timoshenko & Gere 1961, article 6.3). That it bends beforehand raises this by
/// `1/sqrt((1 - Iz/Iy)(1 - G J/E Iy))`, 0.3 % for a strip twenty times as high as wide. Eight cubic elements; the
/// lowest mode about the loaded strip grows above that load and not below it: within 1 %.
#[test]
fn a_strip_buckles_sideways_by_bending_and_torsion() {
    let section = SpatialSection::rectangle(0.001, 0.02);
    let n = 8;
    let length = 0.5;
    let element = BeltBeam3::new(length / n as f64, &section, &STEEL, 1.0, 1.0)
        .with_torsion_factor(section.saint_venant_torsion_factor());
    let (bending, torsion) = (
        STEEL.youngs_modulus * section.second_moment_z,
        STEEL.shear_modulus() * section.torsion_constant,
    );
    let stiff = STEEL.youngs_modulus * section.second_moment_y;
    let bent_before = ((1.0 - bending / stiff) * (1.0 - torsion / stiff)).sqrt();
    let critical = 4.0126 * (bending * torsion).sqrt() / length.powi(2) / bent_before;
    let growth = |load: f64| {
        let mut strip = SpatialStructure::straight(element.clone(), n, [0.0; 3], AXES);
        strip
            .clamp_section(0)
            .force(n, NodeDirection::Position, [0.0, -load, 0.0]);
        let bent = strip.equilibrium().unwrap();
        let modes = strip.modes(&bent).unwrap();
        modes
            .iter()
            .fold(0.0, |most: f64, mode| most.max(mode.growth))
    };
    assert!(growth(0.99 * critical) == 0.0);
    assert!(growth(1.01 * critical) > 0.1);
}

/// A cantilever's lowest frequencies: bending in both planes by Euler and Bernoulli, `1.8751² sqrt(E I/rho A)/L²`,
/// and torsion `pi/2 sqrt(G J_plane / rho (Iy + Iz))/L`. A beam 1/100 as high as long bends 1e-4 times lower by shear
/// and rotary inertia, and linear twist over 8 elements is `(pi/16)²/24`, 1.6e-3, too high. A free beam has six motions
/// without stiffness.
#[test]
fn natural_frequencies() {
    let section = SpatialSection::rectangle(0.006, 0.01);
    let n = 8;
    let element = BeltBeam3::new(LENGTH / n as f64, &section, &STEEL, 1.0, 1.0);
    let mut beam = cantilever(element.clone(), n, AXES);
    let rest = beam.equilibrium().unwrap();
    let modes = beam.modes(&rest).unwrap();
    let bending = |moment: f64| {
        1.875_104_f64.powi(2)
            * (STEEL.youngs_modulus * moment / (STEEL.density * section.area)).sqrt()
            / LENGTH.powi(2)
    };
    let plane = (SHEAR_CORRECTION * STEEL.shear_modulus() / STEEL.density).sqrt();
    for (expected, tolerance) in [
        (bending(section.second_moment_z), 3e-4),
        (bending(section.second_moment_y), 3e-4),
        (0.5 * PI * plane / LENGTH, 2e-3),
    ] {
        let nearest = (modes.iter())
            .map(|mode| (mode.frequency / expected - 1.0).abs())
            .fold(f64::INFINITY, f64::min);
        assert!(nearest < tolerance, "{expected}: {nearest}");
    }
    let mut free = SpatialStructure::straight(element, n, [0.0; 3], AXES);
    free.fix(0, NodeDirection::Position, 0);
    let rest = free.equilibrium();
    assert!(matches!(rest, Err(StructureError::LoadStep(_))), "{rest:?}");
    beam.gravity([0.0, -9.81, 0.0]);
    let sagging = beam.equilibrium().unwrap();
    let weight = 9.81 * STEEL.density * section.area * LENGTH;
    let carried = beam.reaction(&sagging, 0)[1];
    assert!((carried / weight - 1.0).abs() < 1e-6, "{carried} {weight}");
}

/// A pinned beam swings freely in space with its energy kept: multipliers and elimination agree.
#[test]
fn a_swing_in_space_keeps_its_energy() {
    let material = Isotropic {
        youngs_modulus: 2.07e8,
        ..STEEL
    };
    let mut places = Vec::new();
    for form in [ConstraintForm::Multipliers, ConstraintForm::Elimination] {
        let element = BeltBeam3::new(0.25, &section(), &material, 1.0, 1.0);
        let mut beam = SpatialStructure::straight(element, 4, [0.0; 3], AXES);
        beam.pin(0).gravity([0.0, -9.81, 3.0]).constraint_form(form);
        let mut system = beam.build().unwrap();
        let mut motion = beam.at_rest(&system);
        let control = Control {
            method: Method::GeneralizedAlpha,
            step: 1.0e-3,
            error_tolerance: None,
            tightened: Vec::new(),
            newton_tolerance: 1.0e-9,
            kinks: Vec::new(),
            jumps: Vec::new(),
        };
        let weight = 9.81 * material.density * section().area;
        integrate(&mut system, &mut motion, 0.3, &control, |_, _| {
            ControlFlow::Continue(Pace::Free)
        })
        .unwrap();
        let energy = system.energy(&motion.q, &motion.v);
        let start = beam.at_rest(&system);
        let missing = (energy - system.energy(&start.q, &start.v)).abs();
        // Half a turn of a metre: the work of the weight; generalized-alpha takes some of the section's vibration.
        assert!(missing < 2.0e-3 * weight, "{missing} J of {weight} J");
        places.push(beam.vector(&motion.q, 4, NodeDirection::Position));
    }
    assert!(places[0][1] < -0.2, "{places:?}");
    for axis in 0..3 {
        assert!(
            (places[0][axis] - places[1][axis]).abs() < 1e-5,
            "{places:?}"
        );
    }
}

#[test]
fn what_structures_refuse() {
    let mut beam = cantilever(linear(2), 2, AXES);
    assert_eq!(
        beam.index(3, NodeDirection::Position, 0),
        Err(StructureError::NoNode { node: 3, last: 2 })
    );
    assert_eq!(
        beam.index(1, NodeDirection::Along, 0),
        Err(StructureError::NoSlopeAlong)
    );
    assert_eq!(
        beam.index(1, NodeDirection::Width, 3),
        Err(StructureError::NoComponent {
            what: "a vector",
            component: 3,
            last: 2
        })
    );
    beam.force(1, NodeDirection::Position, [f64::NAN, 0.0, 0.0]);
    assert!(matches!(
        beam.equilibrium(),
        Err(StructureError::Value { .. })
    ));
    let mut loop_ = SpatialStructure::straight(linear(3), 3, [0.0; 3], AXES);
    loop_.join_ends();
    assert!(matches!(loop_.build(), Err(StructureError::Gap { .. })));
    let short = SpatialStructure::with_nodes(vec![linear(1)], vec![0.0; 9]);
    assert!(matches!(
        short.build(),
        Err(StructureError::CoordinateCount {
            given: 9,
            wanted: 18
        })
    ));
}
