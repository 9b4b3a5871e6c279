//! Spatial beams against theory: Timoshenko's cantilever, the planar beams, a strip that buckles sideways.

use std::sync::Arc;

use ancf::constraint::Constant;
use ancf::element::{BeltBeam2, BeltBeam3, LineElement, LinearBeam2, LinearBeam3};
use ancf::material::Isotropic;
use ancf::section::{SHEAR_CORRECTION, SpatialSection};
use ancf::structure::{
    Coordinate, NodeDirection, NodeVector, PlanarStructure, SpatialStructure, StructureError,
};

use super::{CaseError, Quantities};

const STEEL: Isotropic = Isotropic {
    youngs_modulus: 2.07e11,
    poisson_ratio: 0.3,
    density: 7850.0,
};
const LENGTH: f64 = 1.0;
const AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const TIP: NodeDirection = NodeDirection::Position;

/// Width (along z) and height (along y) of the cantilevers.
fn section() -> SpatialSection {
    SpatialSection::rectangle(0.04, 0.1)
}

fn belt(count: usize) -> BeltBeam3 {
    BeltBeam3::new(LENGTH / count as f64, &section(), &STEEL, 1.0, 1.0)
}

fn linear(count: usize) -> LinearBeam3 {
    LinearBeam3::new(LENGTH / count as f64, &section(), &STEEL)
}

fn cantilever<E: LineElement>(element: E, count: usize) -> SpatialStructure<E> {
    let mut beam = SpatialStructure::straight(element, count, [0.0; 3], AXES);
    beam.clamp_section(0);
    beam
}

/// Linear deflection of the tip by a unit force along `axis` [m/N].
fn compliance<E: LineElement>(
    element: E,
    count: usize,
    axis: usize,
) -> Result<f64, StructureError> {
    let mut beam = cantilever(element, count);
    let mut force = [0.0; 3];
    force[axis] = 1.0;
    beam.force(count, TIP, force);
    Ok(beam.linear_displacements()?[beam.index(count, TIP, axis)?])
}

/// Cantilevers in both planes against `F L³/3 E I + F L/ks G A`.
pub(super) fn cantilevers() -> Result<Quantities, CaseError> {
    const ELEMENTS: usize = 4;
    let section = section();
    let shear = LENGTH / (SHEAR_CORRECTION * STEEL.shear_modulus() * section.area);
    let mut quantities = Quantities::new();
    for (axis, moment, plane) in [
        (1, section.second_moment_y, "height"),
        (2, section.second_moment_z, "width"),
    ] {
        let bending = LENGTH.powi(3) / (3.0 * STEEL.youngs_modulus * moment);
        let lack = bending + shear - compliance(linear(ELEMENTS), ELEMENTS, axis)?;
        quantities.extend([
            (
                format!("one belt beam over theory, bent over the {plane}"),
                compliance(belt(1), 1, axis)? / (bending + shear),
            ),
            (
                format!("4 linear beams, lack of the bending part times 4 n², over the {plane}"),
                lack / bending * 4.0 * (ELEMENTS as f64).powi(2),
            ),
        ]);
    }
    Ok(quantities)
}

/// Cantilevers bent far in the plane, against the planar elements.
pub(super) fn large_deflection() -> Result<Quantities, CaseError> {
    const ELEMENTS: usize = 8;
    const LOAD: f64 = 3.0e6;
    let down = [0.0, -LOAD, 0.0];
    let planar = section().planar();
    let length = LENGTH / ELEMENTS as f64;

    let element = BeltBeam2::new(length, &planar, &STEEL, 1.0, 1.0, 0.0);
    let mut plane = PlanarStructure::straight(element, ELEMENTS, [0.0; 2], 0.0);
    plane.pin(0).force(ELEMENTS, [0.0, -LOAD]);
    for (axis, value) in [0.0, 1.0].into_iter().enumerate() {
        let vector = NodeVector::Across;
        let slope = Coordinate::Node {
            node: 0,
            vector,
            axis,
        };
        plane.prescribe(slope, Arc::new(Constant(value)));
    }
    let of_plane = plane.position(&plane.equilibrium()?.q, ELEMENTS);
    let mut space = cantilever(belt(ELEMENTS), ELEMENTS);
    space.force(ELEMENTS, TIP, down);
    let belts = apart(
        of_plane,
        space.vector(&space.equilibrium()?.q, ELEMENTS, TIP),
    );

    let element = LinearBeam2::new(length, &planar, &STEEL);
    let mut plane = PlanarStructure::straight(element, ELEMENTS, [0.0; 2], 0.0);
    plane.clamp(0).force(ELEMENTS, [0.0, -LOAD]);
    let other = plane.position(&plane.equilibrium()?.q, ELEMENTS);
    let mut space = cantilever(linear(ELEMENTS), ELEMENTS);
    space.force(ELEMENTS, TIP, down);
    let linears = apart(other, space.vector(&space.equilibrium()?.q, ELEMENTS, TIP));
    Ok(vec![
        ("tip of the planar belt beams, y".to_owned(), of_plane[1]),
        (
            "belt beams, tip in space from that in the plane".to_owned(),
            belts,
        ),
        (
            "linear beams, tip in space from that in the plane".to_owned(),
            linears,
        ),
    ])
}

fn apart(plane: [f64; 2], space: [f64; 3]) -> f64 {
    let [x, y] = plane;
    [space[0] - x, space[1] - y, space[2]]
        .iter()
        .fold(0.0, |m, d| f64::max(m, d.abs()))
}

/// A strip on edge that buckles sideways under its tip load, and the stiffnesses in torsion.
pub(super) fn bending_and_torsion() -> Result<Quantities, CaseError> {
    let strip = SpatialSection::rectangle(0.001, 0.02);
    let (bending, torsion, stiff) = (
        STEEL.youngs_modulus * strip.second_moment_z,
        STEEL.shear_modulus() * strip.torsion_constant,
        STEEL.youngs_modulus * strip.second_moment_y,
    );
    let bent_before = ((1.0 - bending / stiff) * (1.0 - torsion / stiff)).sqrt();
    let theory = 4.0126 * (bending * torsion).sqrt() / LENGTH.powi(2) / bent_before;
    let [coarse, fine] = [
        buckling_load(&strip, 4, theory)? / theory,
        buckling_load(&strip, 8, theory)? / theory,
    ];
    let mut quantities = vec![
        (
            "load at which a strip of 8 elements buckles sideways, over theory".to_owned(),
            fine,
        ),
        (
            "the same, extrapolated from 4 and 8 elements".to_owned(),
            (4.0 * fine - coarse) / 3.0,
        ),
    ];
    let section = section();
    let factor = section.saint_venant_torsion_factor();
    let polar = section.second_moment_y + section.second_moment_z;
    for (name, factor, constant) in [
        ("plane sections", 1.0, SHEAR_CORRECTION * polar),
        ("Saint-Venant's factor", factor, section.torsion_constant),
    ] {
        let expected = LENGTH / (STEEL.shear_modulus() * constant);
        quantities.extend([
            (
                format!("twist of a belt beam over theory, {name}"),
                twist(belt(1).with_torsion_factor(factor))? / expected,
            ),
            (
                format!("twist of a linear beam over theory, {name}"),
                twist(linear(1).with_torsion_factor(factor))? / expected,
            ),
        ]);
    }
    Ok(quantities)
}

/// Turn of the tip by a unit moment [rad/(N m)], on r_y and r_z in the parts of Iy and Iz that resist them, so that the
/// section keeps its right angle.
fn twist<E: LineElement>(element: E) -> Result<f64, StructureError> {
    let section = section();
    let part = section.second_moment_y / (section.second_moment_y + section.second_moment_z);
    let mut beam = cantilever(element, 1);
    beam.force(1, NodeDirection::Height, [0.0, 0.0, part])
        .force(1, NodeDirection::Width, [0.0, part - 1.0, 0.0]);
    Ok(beam.linear_displacements()?[beam.index(1, NodeDirection::Height, 2)?])
}

/// The load above which a small motion of the loaded strip grows, by halving from 0.9 to 1.1 of `guess` [N].
fn buckling_load(
    section: &SpatialSection,
    count: usize,
    guess: f64,
) -> Result<f64, StructureError> {
    let element = BeltBeam3::new(LENGTH / count as f64, section, &STEEL, 1.0, 1.0)
        .with_torsion_factor(section.saint_venant_torsion_factor());
    let [mut low, mut high] = [0.9 * guess, 1.1 * guess];
    while high - low > 1.0e-5 * guess {
        let load = 0.5 * (low + high);
        let mut strip = cantilever(element.clone(), count);
        strip.force(count, TIP, [0.0, -load, 0.0]);
        let bent = strip.equilibrium()?;
        let grows = strip.modes(&bent)?.iter().any(|mode| mode.growth > 0.0);
        if grows {
            high = load;
        } else {
            low = load;
        }
    }
    Ok(0.5 * (low + high))
}
