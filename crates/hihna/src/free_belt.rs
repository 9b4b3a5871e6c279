//! The belt off its pulleys: from the pulleys' path, where it would be put on, it springs to a circle
//! (Kerkkänen 2006, Figs 3.4 and 3.5).
//!
//! The belt is drawn on its path as at the start of a run, without contact. Its first node A is pinned, the
//! node B opposite may move along x only. Newton's method with a shrinking shift ([`ancf::statics`]) finds the
//! unloaded ring: a circle of radius L/(2 pi), whose energy is `alpha2 E I/(2 R²) L`.

use std::ops::ControlFlow;

use ancf::constraint::Constant;
use ancf::element::{BeltBeam2, Element, LineElement};
use ancf::mesh::Mesh;
use ancf::statics::{Settle, StaticsError, settle_watched};
use ancf::system::System;
use thiserror::Error;

use crate::assemble::{Assembly, AssemblyError};
use crate::drive::Drive;

/// Points of the centre line shown of each element.
const POINTS: usize = 8;

/// A belt that springs free.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeBelt {
    /// The centre line before each iteration and at the end: points around the belt [m].
    pub shapes: Vec<Vec<[f64; 2]>>,
    /// Strain energy at the end [J].
    pub energy: f64,
}

/// A belt that finds no rest.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum FreeBeltError {
    /// The drive cannot be put together.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// The iteration fails.
    #[error(transparent)]
    Statics(#[from] StaticsError),
}

/// Lets the belt of `drive`, taken as belt beams, spring free.
pub fn spring_free(drive: &Drive) -> Result<FreeBelt, FreeBeltError> {
    let assembly = Assembly::<BeltBeam2>::new(drive)?;
    let mesh = assembly.system.mesh().clone();
    let mut q = assembly.motion.q;
    q.truncate(mesh.dof());
    let opposite = drive.belt.elements / 2 * BeltBeam2::NODE_DOF;
    let radius = assembly.mounting.length / std::f64::consts::TAU;
    let element = assembly.mounting.length / drive.belt.elements as f64;
    let scales = mesh.scales(element, drive.belt.thickness);
    let mut belt = System::new(mesh, scales, Vec::new(), ());
    for index in [0, 1, opposite + 1] {
        belt = belt.following(index, Box::new(Constant(q[index])));
    }
    let mut shapes = Vec::new();
    // The shift starts at the square of an element's own axial frequency, sqrt(E/rho)/l.
    let settle = Settle {
        shift: drive.belt.youngs_modulus / (drive.belt.density * element * element),
        shrink: 0.1,
        step_limit: 0.2 * radius,
        tolerance: 1.0e-11 * radius,
        max_iterations: 500,
    };
    let mesh = belt.mesh().clone();
    settle_watched(&mut belt, 0.0, &mut q, &[], settle, &mut |_, q| {
        shapes.push(shape(&mesh, q));
        ControlFlow::Continue(())
    })?;
    shapes.push(shape(&mesh, &q));
    Ok(FreeBelt {
        shapes,
        energy: mesh.energy(&q),
    })
}

/// Points of the centre line, evenly along the unstretched belt.
fn shape(mesh: &Mesh<BeltBeam2>, q: &[f64]) -> Vec<[f64; 2]> {
    let mut coordinates = [0.0; BeltBeam2::DOF];
    let mut weights = [0.0; BeltBeam2::NODES * BeltBeam2::NODE_VECTORS];
    let mut points = Vec::with_capacity(mesh.elements().len() * POINTS);
    for (i, element) in mesh.elements().iter().enumerate() {
        mesh.gather(i, q, &mut coordinates);
        for k in 0..POINTS {
            element.centre_line(k as f64 / POINTS as f64, &mut weights);
            points.push([0, 1].map(|axis| {
                BeltBeam2::CENTRE_VECTORS
                    .iter()
                    .map(|vector| weights[*vector] * coordinates[2 * vector + axis])
                    .sum()
            }));
        }
    }
    points
}
