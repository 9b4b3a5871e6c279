//! From a drive to a belt of spatial beams: flat on its faces, or a V-belt whose flanks lie in grooves.

use ancf::dynamics::Motion;
use ancf::element::{BeltBeam3, LineElement, LinearBeam3};
use ancf::mesh::Mesh;
use ancf::quadrature::Rule;
use ancf::section::{SpatialSection, Trapezoid};
use ancf::statics::Hold;
use ancf::system::System;

use super::plates::surface_pulley;
use super::{
    Assembly, AssemblyError, Mounting, closable, coarse_elements, hold_along, hold_stiffness,
    material, penalty, points_of, rotor, rule,
};
use crate::contact::surface::{Face, Groove, SurfaceContact, SurfacePulley};
use crate::drive::{Belt, Drive, Pulley};
use crate::friction::Law;
use crate::layout::{Arc, Layout, PathPoint, Place};

/// A drive whose belt is a chain of spatial beams.
pub type SpaceBeamAssembly<E> = Assembly<E, SurfaceContact>;

/// Spatial belt elements that a drive file can ask for.
pub trait SpaceBeltElement: LineElement {
    /// An element of the given section and undeformed length [m] for `belt`.
    fn for_belt(belt: &Belt, section: &SpatialSection, length: f64) -> Self;
}

impl SpaceBeltElement for BeltBeam3 {
    fn for_belt(belt: &Belt, section: &SpatialSection, length: f64) -> Self {
        let factors = [belt.axial_factor, belt.bending_factor];
        Self::new(length, section, &material(belt), factors[0], factors[1])
            .with_torsion_factor(belt.torsion_factor)
    }
}

impl SpaceBeltElement for LinearBeam3 {
    fn for_belt(belt: &Belt, section: &SpatialSection, length: f64) -> Self {
        Self::new(
            length,
            &softened(section, belt.bending_factor),
            &material(belt),
        )
        .with_torsion_factor(belt.torsion_factor)
    }
}

/// The section of elements without factors of their own: the bending factor acts on its higher moments.
fn softened(section: &SpatialSection, factor: f64) -> SpatialSection {
    SpatialSection {
        area: section.area,
        second_moment_y: factor * section.second_moment_y,
        second_moment_z: factor * section.second_moment_z,
        fourth_moment_y: factor * section.fourth_moment_y,
        fourth_moment_z: factor * section.fourth_moment_z,
        mixed_fourth_moment: factor * section.mixed_fourth_moment,
        torsion_constant: factor * section.torsion_constant,
    }
}

impl<E: SpaceBeltElement> SpaceBeamAssembly<E> {
    /// Puts `drive` together. While the belt settles, its first node is held along the path. Where no groove guides it
    /// and a pulley is not a cylinder about z in the plane of the drive, all nodes are held in their plane, too:
    /// without friction such a belt would slip off.
    pub fn of_beams(drive: &Drive) -> Result<Self, AssemblyError> {
        let layout = Layout::of(drive)?;
        let mounting = Mounting::new(drive, &layout)?;
        closable(drive, &mounting)?;
        let count = drive.belt.elements;
        let length = mounting.length / count as f64;
        let mut system = system(drive, &layout, length)?;
        for (contact, pulley) in system.law.pulleys.iter_mut().zip(&drive.pulley) {
            contact.center = pulley.middle(0.0);
            contact.displacement = None;
        }
        let mut holds = vec![hold_along(drive, &layout, [0; 2])];
        if drive.pulley.iter().any(Pulley::is_misaligned) && !is_guided(drive) {
            let stiffness = hold_stiffness(drive, &layout);
            holds.extend((0..count).map(|node| Hold {
                vectors: [node * E::NODE_DOF; 2],
                direction: [0.0, 0.0, 1.0],
                stiffness,
            }));
        }
        Ok(Self {
            system,
            motion: on_path::<E>(drive, &layout, &mounting),
            holds,
            warnings: coarse_elements(drive, &layout, &mounting),
            layout,
            mounting,
            element_start: (0..count).map(|i| i as f64 * length).collect(),
        })
    }

    /// Lets the friction of `drive` and the external torques act, and the hubs move.
    pub fn release_beams(&mut self, drive: &Drive) {
        let law = &mut self.system.law;
        // The flanks press as hard as they do: no groove multiplies friction here.
        law.set_friction((drive.pulley.iter()).map(|p| Law::new(drive.friction_on(p), 1.0)));
        for (contact, pulley) in law.pulleys.iter_mut().zip(&drive.pulley) {
            contact.external = pulley.external_torque();
            let [x, y] = pulley.center;
            contact.center = [x, y, pulley.offset];
            contact.displacement.clone_from(&pulley.displacement);
        }
    }
}

/// Whether grooves hold the belt sideways.
pub(crate) fn is_guided(drive: &Drive) -> bool {
    drive.pulley.iter().any(|p| p.groove_angle.is_some())
}

/// The mechanical system of a belt of beams of the given undeformed length, all pulleys frictionless.
fn system<E: SpaceBeltElement>(
    drive: &Drive,
    layout: &Layout,
    length: f64,
) -> Result<System<E, SurfaceContact>, AssemblyError> {
    let belt = &drive.belt;
    let trapezoid = trapezoid(drive)?;
    let section = trapezoid.map_or_else(
        || SpatialSection::rectangle(belt.width, belt.thickness),
        |trapezoid| trapezoid.section(),
    );
    let mesh = Mesh::closed(vec![E::for_belt(belt, &section, length); belt.elements]);
    let across = points_of(&drive.contact, drive.contact.points_across);
    let pulleys = (drive.pulley.iter().zip(&layout.arcs))
        .map(|(pulley, arc)| {
            let groove = (pulley.groove_angle).map(|angle| Groove::new(belt.width, 0.5 * angle));
            let surface = SurfacePulley {
                groove,
                ..surface_pulley(pulley)
            };
            (
                surface,
                face(drive, trapezoid.as_ref(), (pulley, arc), &across),
            )
        })
        .collect();
    let mut contact = SurfaceContact::of_beams(
        &mesh,
        pulleys,
        penalty(&drive.contact),
        drive.contact.friction_directions,
        rule(&drive.contact),
    );
    contact.line = drive.run.profile_line;
    contact.width = belt.width;
    let scales = mesh.scales(length, belt.thickness);
    let rotors = drive.pulley.iter().map(rotor).collect();
    let mut system = System::new(mesh, scales, rotors, contact);
    if drive.gravity != [0.0, 0.0] {
        system.add_gravity(&[drive.gravity[0], drive.gravity[1], 0.0]);
    }
    Ok(system)
}

/// The section of a V-belt, none of a flat one.
fn trapezoid(drive: &Drive) -> Result<Option<Trapezoid>, AssemblyError> {
    match (drive.flank_angle(), drive.trapezoid()) {
        (Some(angle), None) => Err(AssemblyError::NoSection {
            width: drive.belt.width,
            thickness: drive.belt.thickness,
            angle: angle.to_degrees(),
        }),
        (_, trapezoid) => Ok(trapezoid),
    }
}

/// What of the belt touches a pulley. The section's height points to the left of the path: to the centre of a pulley
/// that the path turns about counter-clockwise, and so does the narrow side of a V-belt on pulleys inside the loop.
fn face(
    drive: &Drive,
    trapezoid: Option<&Trapezoid>,
    (pulley, arc): (&Pulley, &Arc),
    across: &Rule,
) -> Face {
    let inwards = arc.sweep.signum();
    let offset = drive.pitch_offset_on(pulley);
    match (trapezoid, pulley.groove_angle) {
        (Some(trapezoid), Some(_)) => Face::flanks(trapezoid, inwards, across),
        (Some(trapezoid), None) => {
            let towards_narrow = match pulley.wrap {
                crate::drive::Wrap::Inside => offset,
                crate::drive::Wrap::Outside => -offset,
            };
            let width = trapezoid.width_at(towards_narrow);
            Face::flat(inwards * offset, width, across)
        }
        (None, _) => Face::flat(inwards * offset, drive.belt.width, across),
    }
}

/// The belt evenly stretched on its path, at rest: in the plane of the drive, or through the middles of grooves.
fn on_path<E: LineElement>(drive: &Drive, layout: &Layout, mounting: &Mounting) -> Motion {
    let belt = &drive.belt;
    let chain = belt.elements * E::NODE_DOF;
    let mut motion = Motion::zero(chain + drive.pulley.len());
    let guided = is_guided(drive);
    let across = 3 * E::SECTION_VECTORS[0];
    for (i, node) in motion.q[..chain].chunks_exact_mut(E::NODE_DOF).enumerate() {
        let s = belt.first_node + mounting.path * i as f64 / belt.elements as f64;
        let place = layout.point(s);
        let lie = if guided {
            Lie::in_grooves(drive, layout, &place)
        } else {
            Lie::IN_PLANE
        };
        let [x, y] = place.tangent;
        let tangent = unit([x, y, lie.slope]);
        let along: f64 = dot(lie.axis, tangent);
        let width = unit(std::array::from_fn(|k| lie.axis[k] - along * tangent[k]));
        node[..2].copy_from_slice(&place.position);
        node[2] = lie.height;
        if E::CENTRE_VECTORS.len() == 4 {
            for k in 0..3 {
                node[3 + k] = mounting.stretch * tangent[k];
            }
        }
        node[across..across + 3].copy_from_slice(&cross(width, tangent));
        node[across + 3..across + 6].copy_from_slice(&width);
    }
    motion
}

/// How a point of the path lies out of the plane.
#[derive(Clone, Copy)]
struct Lie {
    /// z [m].
    height: f64,
    /// Its derivative along the path.
    slope: f64,
    /// Where the belt's width points, not of unit length.
    axis: [f64; 3],
}

impl Lie {
    const IN_PLANE: Self = Self {
        height: 0.0,
        slope: 0.0,
        axis: [0.0, 0.0, 1.0],
    };

    /// In the middle plane of the pulley; on a span on the straight line between those of its pulleys.
    fn in_grooves(drive: &Drive, layout: &Layout, place: &PathPoint) -> Self {
        match place.on {
            Place::Pulley(p) => Self::on_pulley(
                &drive.pulley[layout.arcs[p].pulley],
                place.position,
                place.tangent,
            ),
            Place::Span(i) => {
                let span = &layout.spans[i];
                let direction = [0, 1].map(|k| (span.end[k] - span.start[k]) / span.length);
                let from = Self::on_pulley(&drive.pulley[span.from], span.start, direction);
                let to = Self::on_pulley(&drive.pulley[span.to], span.end, direction);
                let part: f64 = (0..2)
                    .map(|k| (place.position[k] - span.start[k]) * direction[k] / span.length)
                    .sum();
                let between = |a: f64, b: f64| a + part * (b - a);
                Self {
                    height: between(from.height, to.height),
                    slope: (to.height - from.height) / span.length,
                    axis: std::array::from_fn(|k| between(from.axis[k], to.axis[k])),
                }
            }
        }
    }

    fn on_pulley(pulley: &Pulley, [x, y]: [f64; 2], tangent: [f64; 2]) -> Self {
        let axis = pulley.axis();
        let [ox, oy] = pulley.center;
        Self {
            height: pulley.offset - (axis[0] * (x - ox) + axis[1] * (y - oy)) / axis[2],
            slope: -(axis[0] * tangent[0] + axis[1] * tangent[1]) / axis[2],
            axis,
        }
    }
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
