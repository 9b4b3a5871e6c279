//! From a drive to a belt of plates: the same path, drawn in space with the belt's width along z.

use ancf::dynamics::Motion;
use ancf::element::{BendingRigidity, Element, ThinPlate};
use ancf::mesh::Mesh;
use ancf::statics::Hold;
use ancf::system::System;

use super::{
    Assembly, AssemblyError, Mounting, closable, coarse_elements, hold_along, hold_stiffness,
    material, penalty, rotor, rule,
};
use crate::contact::surface::{SurfaceContact, SurfacePulley};
use crate::drive::{Belt, Drive, PlateBending, Pulley};
use crate::friction::{Frictionless, Law};
use crate::layout::Layout;
use crate::profile::Profile;

/// A drive whose belt is a strip of plates.
pub type PlateAssembly = Assembly<ThinPlate, SurfaceContact>;

impl PlateAssembly {
    /// Puts `drive` together. While the belt settles, the first section is held along the path by the node in its middle, or
    /// by the mean of the two beside it. On pulleys that are not cylinders about z in the plane of the drive, all sections
    /// are held in the plane of their middles so, too: without friction such a belt would slip off. Their width contracts
    /// freely, alike to both sides.
    pub fn of_plates(drive: &Drive) -> Result<Self, AssemblyError> {
        let layout = Layout::of(drive)?;
        let mounting = Mounting::new(drive, &layout)?;
        closable(drive, &mounting)?;
        let contraction = contraction(&drive.belt, &mounting)?;
        let count = drive.belt.elements;
        let length = mounting.length / count as f64;
        let mut system = system(drive, length);
        for (contact, pulley) in system.law.pulleys.iter_mut().zip(&drive.pulley) {
            contact.center = pulley.middle(0.0);
            contact.displacement = None;
        }
        let across = drive.belt.elements_across;
        let middle = [across / 2, across.div_ceil(2)].map(|node| node * ThinPlate::NODE_DOF);
        let mut holds = vec![hold_along(drive, &layout, middle)];
        if drive.pulley.iter().any(Pulley::is_misaligned) {
            let row = system.mesh().section_dof();
            let stiffness = hold_stiffness(drive, &layout);
            holds.extend((0..count).map(|section| Hold {
                vectors: middle.map(|node| section * row + node),
                direction: [0.0, 0.0, 1.0],
                stiffness,
            }));
        }
        Ok(Self {
            motion: on_path(drive, &layout, &mounting, contraction),
            system,
            warnings: coarse_elements(drive, &layout, &mounting),
            layout,
            mounting,
            element_start: (0..count).map(|i| i as f64 * length).collect(),
            holds,
        })
    }

    /// Lets the friction of `drive` and the external torques act, and the hubs move.
    pub fn release_plates(&mut self, drive: &Drive) {
        let laws = drive.pulley.iter();
        let law = &mut self.system.law;
        law.set_friction(laws.map(|pulley| Law::new(drive.friction_on(pulley), pulley.grip())));
        for (contact, pulley) in law.pulleys.iter_mut().zip(&drive.pulley) {
            contact.external = pulley.external_torque();
            let [x, y] = pulley.center;
            contact.center = [x, y, pulley.offset];
            contact.displacement.clone_from(&pulley.displacement);
        }
    }
}

/// Part of its width that a belt keeps between free edges on its path: `eyy = -nu exx` in the plane stress of
/// the plates' energy. Fails where nothing would be left.
pub(crate) fn contraction(belt: &Belt, mounting: &Mounting) -> Result<f64, AssemblyError> {
    let stretch = mounting.stretch;
    let square = 1.0 - belt.poisson_ratio * (stretch * stretch - 1.0);
    if square > LEAST_WIDTH * LEAST_WIDTH {
        Ok(square.sqrt())
    } else {
        Err(AssemblyError::NoWidth {
            stretch,
            least: LEAST_WIDTH,
        })
    }
}

/// Part of its width that a belt must keep.
const LEAST_WIDTH: f64 = 0.5;

/// The mechanical system of a belt of plates of the given undeformed length, all pulleys frictionless.
fn system(drive: &Drive, length: f64) -> System<ThinPlate, SurfaceContact> {
    let belt = &drive.belt;
    let plate = plate(belt, length);
    let elements = vec![plate; belt.elements * belt.elements_across];
    let mesh = Mesh::closed_strip(elements, belt.elements_across);
    let mut contact = SurfaceContact::new(
        &mesh,
        drive.pulley.iter().map(surface_pulley).collect(),
        penalty(&drive.contact),
        drive.contact.friction_directions,
        rule(&drive.contact),
    );
    contact.line = drive.run.profile_line;
    let across = belt.width / belt.elements_across as f64;
    let scales = mesh.scales(length, 0.25 * across);
    let rotors = drive.pulley.iter().map(rotor).collect();
    let mut system = System::new(mesh, scales, rotors, contact);
    if drive.gravity != [0.0, 0.0] {
        system.add_gravity(&[drive.gravity[0], drive.gravity[1], 0.0]);
    }
    system
}

fn plate(belt: &Belt, length: f64) -> ThinPlate {
    let rigidity = match belt.bending {
        PlateBending::Standard => BendingRigidity::Kirchhoff,
        PlateBending::Printed => BendingRigidity::Printed,
        PlateBending::None => BendingRigidity::None,
    };
    let across = belt.width / belt.elements_across as f64;
    ThinPlate::new(length, across, belt.thickness, &material(belt), rigidity)
}

/// A pulley without a groove and friction.
pub(super) fn surface_pulley(pulley: &Pulley) -> SurfacePulley {
    let [x, y] = pulley.center;
    let [slope, curvature] = pulley.shape();
    SurfacePulley {
        center: [x, y, pulley.offset],
        displacement: pulley.displacement.clone(),
        axis: pulley.axis(),
        radius: pulley.radius,
        slope,
        curvature,
        groove: None,
        friction: Law::Frictionless(Frictionless),
        external: Profile::Constant(0.0).into(),
    }
}

/// The belt evenly stretched on its path and contracted across, at rest, its middle in the plane of the drive.
fn on_path(drive: &Drive, layout: &Layout, mounting: &Mounting, contraction: f64) -> Motion {
    let belt = &drive.belt;
    let row = (belt.elements_across + 1) * ThinPlate::NODE_DOF;
    let chain = belt.elements * row;
    let mut motion = Motion::zero(chain + drive.pulley.len());
    for (i, section) in motion.q[..chain].chunks_exact_mut(row).enumerate() {
        let s = belt.first_node + mounting.path * i as f64 / belt.elements as f64;
        let place = layout.point(s);
        for (j, node) in section.chunks_exact_mut(ThinPlate::NODE_DOF).enumerate() {
            let across = belt.width * (j as f64 / belt.elements_across as f64 - 0.5);
            node[..2].copy_from_slice(&place.position);
            node[2] = contraction * across;
            for axis in 0..2 {
                node[3 + axis] = mounting.stretch * place.tangent[axis];
            }
            node[8] = contraction;
        }
    }
    motion
}
