//! Thin plates as structures: square plates and strips against series, tables and elliptic integrals.

use std::f64::consts::{PI, TAU};

use ancf::element::{BendingRigidity, ThinPlate};
use ancf::material::Isotropic;
use ancf::statics::LoadSteps;
use ancf::structure::{Edge, NodeVector, PlateStructure, StructureError};

use super::{CaseError, Quantities};

/// Side of the square plates and length of the strips [m].
const SIDE: f64 = 1.0;
/// Width of the strips [m].
const WIDTH: f64 = 0.1;

fn steel(poisson_ratio: f64) -> Isotropic {
    Isotropic {
        youngs_modulus: 2.0e11,
        poisson_ratio,
        density: 7800.0,
    }
}

/// Thickness of the square plates [m].
const THICKNESS: f64 = 0.01;

/// A square plate in linear bending, nu = 0.3, and its bending stiffness D [N m].
fn square(count: usize) -> (PlateStructure, f64) {
    let material = steel(0.3);
    let side = SIDE / count as f64;
    let element = ThinPlate::new(side, side, THICKNESS, &material, BendingRigidity::Kirchhoff);
    let mut plate = PlateStructure::rectangle(element, count, count);
    plate.bending_only();
    let square = 1.0 - material.poisson_ratio.powi(2);
    let rigidity = material.youngs_modulus * THICKNESS.powi(3) / (12.0 * square);
    (plate, rigidity)
}

/// Deflection of the middle under an even pressure [q a⁴ / 1000 D].
fn deflection(count: usize, hold: impl Fn(&mut PlateStructure)) -> Result<f64, StructureError> {
    let (mut plate, rigidity) = square(count);
    hold(&mut plate);
    plate.pressure(1.0);
    let displacements = plate.linear_displacements()?;
    let middle = plate.position(&displacements, [count / 2, count / 2]);
    Ok(1.0e3 * middle[2] * rigidity / SIDE.powi(4))
}

/// Holds a plate.
type Support = fn(&mut PlateStructure);

fn supported(plate: &mut PlateStructure) {
    plate.support(Edge::ALL);
}

fn clamped(plate: &mut PlateStructure) {
    plate.clamp(Edge::ALL);
}

fn cantilever(plate: &mut PlateStructure) {
    plate.clamp([Edge::Start]);
}

/// A square plate under an even pressure, supported and clamped, on three meshes.
pub(super) fn square_plate() -> Result<Quantities, CaseError> {
    let mut quantities = Quantities::new();
    let supports: [(&str, Support); 2] = [("simply supported", supported), ("clamped", clamped)];
    for (support, hold) in supports {
        let mut on_mesh = [0.0; 3];
        for (value, count) in on_mesh.iter_mut().zip([8, 16, 32]) {
            *value = deflection(count, hold)?;
            quantities.push((format!("{support}, {count} elements a side"), *value));
        }
        let [coarse, middle, fine] = on_mesh;
        quantities.extend([
            (
                format!("{support}, extrapolated with the square of the size"),
                fine + (fine - middle) / 3.0,
            ),
            (
                format!("{support}, ratio of differences"),
                (coarse - middle) / (middle - fine),
            ),
        ]);
    }
    Ok(quantities)
}

/// Natural frequencies of square plates of 12 x 12 elements [sqrt(D/(rho h a⁴))].
pub(super) fn frequencies() -> Result<Quantities, CaseError> {
    let mut quantities = Quantities::new();
    let supports: [(&str, Support, usize); 3] = [
        ("simply supported", supported, 3),
        ("clamped", clamped, 3),
        ("cantilever", cantilever, 5),
    ];
    for (support, hold, count) in supports {
        let (mut plate, rigidity) = square(12);
        hold(&mut plate);
        let modes = plate.modes(&plate.equilibrium()?)?;
        let scale = SIDE.powi(2) * (steel(0.3).density * THICKNESS / rigidity).sqrt();
        for (k, mode) in modes.iter().take(count).enumerate() {
            let name = format!("{support}, frequency {}", k + 1);
            quantities.push((name, mode.frequency * scale));
        }
    }
    Ok(quantities)
}

/// A strip, nu = 0, clamped at its start, and its E I.
fn strip(thickness: f64) -> (PlateStructure, f64) {
    let count = 64;
    let material = steel(0.0);
    let length = SIDE / count as f64;
    let element = ThinPlate::new(
        length,
        WIDTH,
        thickness,
        &material,
        BendingRigidity::Kirchhoff,
    );
    let mut plate = PlateStructure::rectangle(element, count, 1);
    plate.clamp([Edge::Start]).load_steps(LoadSteps {
        steps: 10,
        halvings: 8,
        tolerance: 1.0e-9 * SIDE,
        max_iterations: 60,
    });
    let rigidity = material.youngs_modulus * WIDTH * thickness.powi(3) / 12.0;
    (plate, rigidity)
}

/// Strips that bend far: one rolled up by a moment, one under a tip force.
pub(super) fn strips() -> Result<Quantities, CaseError> {
    let (mut rolled, rigidity) = strip(0.01);
    for node in rolled.nodes() {
        for axis in 0..3 {
            rolled.hold(node, NodeVector::Across, axis);
        }
        for vector in [NodeVector::Position, NodeVector::Along] {
            rolled.hold(node, vector, 1);
        }
    }
    rolled.end_moment(TAU * rigidity / (SIDE * WIDTH));
    let bent = rolled.equilibrium()?;
    let tip = rolled.last();
    let slope = rolled.vector(&bent.q, tip, NodeVector::Along);
    let [x, _, z] = rolled.position(&bent.q, tip);
    let stretch = 1.0 + 2.0 * (PI * 0.01).powi(2) / 3.0;
    let beyond = slope[2].atan2(slope[0]);

    let (mut pulled, rigidity) = strip(0.002);
    let force = 10.0 * rigidity / SIDE.powi(2);
    for (node, sign) in pulled.edge(Edge::End).zip([1.0, -1.0]) {
        // The end's deflection is cubic in y: the work of an even load on places and slopes.
        let moment = sign * force * WIDTH / 12.0;
        pulled.force(node, [0.0, 0.0, 0.5 * force]).slope_force(
            node,
            NodeVector::Across,
            2,
            moment,
        );
    }
    let bent = pulled.equilibrium()?;
    let end = pulled.position(&bent.q, pulled.last());
    Ok(vec![
        ("rolled up, turn of the tip".to_owned(), TAU + beyond),
        (
            "rolled up, turn by the closed form".to_owned(),
            TAU * stretch,
        ),
        ("rolled up, distance of the ends".to_owned(), x.hypot(z)),
        ("tip force, shortening".to_owned(), 1.0 - end[0] / SIDE),
        ("tip force, deflection".to_owned(), end[2] / SIDE),
    ])
}
