//! From a drive to a mechanical system with its initial shape: the belt lies evenly stretched on the
//! path around the pulleys, the nodes `path / n` apart.

mod plates;
mod rest;
mod space_beams;

use std::num::NonZeroUsize;
use std::sync::Arc;

use ancf::constraint::{Constant, ConstraintError, ConstraintForm, ConstraintSet, LinearEquation};
use ancf::dynamics::Motion;
use ancf::element::{BeltBeam2, CubicBeam2, LineElement, LinearBeam2};
use ancf::material::Isotropic;
use ancf::mesh::Mesh;
use ancf::quadrature::Rule;
use ancf::section::PlanarSection;
use ancf::statics::Hold;
use ancf::system::{self, Mechanics, RigidCoordinate, System};
use thiserror::Error;

use crate::contact::{BeltContact, ContactPulley, Penalty};
use crate::drive::{Belt, BeltElement, Contact, Drive, Harmonic, Integration, Pulley, SlipAt};
use crate::friction::{Frictionless, Law};
use crate::layout::{self, Layout, LayoutError};
use crate::profile::Profile;
use crate::quantities::with_prefix;

pub use plates::PlateAssembly;
pub(crate) use plates::contraction;
pub use rest::{Rest, Stiffness};
pub(crate) use space_beams::is_guided;
pub use space_beams::{SpaceBeamAssembly, SpaceBeltElement};

/// Stretch beyond which a belt is taken to be the wrong one.
const LARGEST_STRETCH: f64 = 2.0;
/// Turning of the belt within one element beyond which contact is resolved poorly [rad]: of elements
/// that bend, and of straight ones.
const LARGEST_TURN: f64 = 1.05;
const LARGEST_TURN_STRAIGHT: f64 = 0.2;
/// Turning within one element that no loop can have: it would lie around more than half of the pulley.
const IMPOSSIBLE_TURN: f64 = std::f64::consts::PI;

/// A drive that cannot be put together.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum AssemblyError {
    /// The pulleys do not make a belt path.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// The belt's joint cannot be made.
    #[error(transparent)]
    Joint(#[from] ConstraintError),
    /// An element would lie around more than half of a pulley.
    #[error(
        "too few elements to close the loop: one would turn by {turn:.0} degrees around pulley `{pulley}`; use at least {elements}"
    )]
    TooFewElements {
        /// The smallest pulley.
        pulley: String,
        /// Turning of one element [degrees].
        turn: f64,
        /// Number of elements that resolves the contact.
        elements: usize,
    },
    /// The belt is longer than its path.
    #[error(
        "the belt is too long: unstretched {length:.6} m, but the path around the pulleys is only {path:.6} m ({excess:.6} m less); a length below {path:.6} m fits"
    )]
    TooLong {
        /// Unstretched length [m].
        length: f64,
        /// Path length [m].
        path: f64,
        /// Their difference [m].
        excess: f64,
    },
    /// A belt of plates would grow too narrow.
    #[error(
        "the belt is too tight: stretched {stretch:.2} times it would keep less than {part:.0} % of its width",
        part = 100.0 * least
    )]
    NoWidth {
        /// Path over length.
        stretch: f64,
        /// Least part of the width accepted.
        least: f64,
    },
    /// The flanks of a V-belt meet within it.
    #[error(
        "the flanks of the belt meet: at {angle:.1} degrees between them a belt {width:.6} m wide cannot be {thickness:.6} m high"
    )]
    NoSection {
        /// Width at the centre line [m].
        width: f64,
        /// Height [m].
        thickness: f64,
        /// Angle between the flanks [degrees].
        angle: f64,
    },
    /// The belt would have to stretch beyond reason.
    #[error(
        "the belt is too short: unstretched {length:.6} m on a path of {path:.6} m would be stretched {stretch:.2} times; a length above {shortest:.6} m fits"
    )]
    TooShort {
        /// Unstretched length [m].
        length: f64,
        /// Path length [m].
        path: f64,
        /// Path over length.
        stretch: f64,
        /// Shortest length accepted [m].
        shortest: f64,
    },
}

/// What is wrong but does not keep the drive from running.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum Warning {
    /// Elements bend too far around a pulley.
    #[error(
        "an element turns by {turn:.0} degrees around pulley `{pulley}`: contact is resolved poorly; use at least {elements} elements"
    )]
    CoarseMesh {
        /// The smallest pulley.
        pulley: String,
        /// Turning of one element [degrees].
        turn: f64,
        /// Number of elements that would do.
        elements: usize,
    },
    /// An element is longer than a pulley's arc.
    #[error(
        "less than an element lies on pulley `{pulley}`, {} of {}: contact is resolved poorly; use at least {elements} elements",
        with_prefix(*.arc, "m"),
        with_prefix(*.element, "m")
    )]
    ShortArc {
        /// The pulley.
        pulley: String,
        /// Length of its arc [m].
        arc: f64,
        /// Length of an element on the path [m].
        element: f64,
        /// Number of elements of which one would fit.
        elements: usize,
    },
    /// The belt sinks in so far that it is not mounted as was asked.
    #[error(
        "the contact is soft: at rest the belt has {} of tension, {} on rigid pulleys, and sinks {} into a radius of {} or more; {}",
        with_prefix(*.tension, "N"),
        with_prefix(*.path_tension, "N"),
        with_prefix(*.penetration, "m"),
        with_prefix(*.radius, "m"),
        Stiffness::remedy(*.enough)
    )]
    SoftContact {
        /// Mean true axial force at rest [N].
        tension: f64,
        /// The same on rigid pulleys [N].
        path_tension: f64,
        /// Largest penetration [m].
        penetration: f64,
        /// Smallest radius [m].
        radius: f64,
        /// What would do, where it is known.
        enough: Option<Stiffness>,
    },
    /// The program that ran the drive stated a law itself.
    #[error(
        "the {law} on pulley `{pulley}` was a function of the program that ran the drive: the drive file does not hold it"
    )]
    StatedLaw {
        /// What the law is of.
        law: &'static str,
        /// The pulley.
        pulley: String,
    },
    /// Steady running does not take the rule of integration that the drive names.
    #[error(
        "`contact.integration = \"trapezoidal\"` plays no part in steady running: elements are split where contact and friction have corners, with Gauss points on every piece"
    )]
    SplitIntegration,
}

/// How tight the belt is, worked out on its path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mounting {
    /// Unstretched length [m].
    pub length: f64,
    /// Path length [m].
    pub path: f64,
    /// Path over length.
    pub stretch: f64,
    /// True axial force at this stretch [N], before the pulleys' surfaces yield.
    pub tension: f64,
}

impl Mounting {
    /// The mounting of the belt of `drive` on the path of `layout`.
    pub fn new(drive: &Drive, layout: &Layout) -> Result<Self, AssemblyError> {
        let path = layout.length;
        let belt = &drive.belt;
        // alpha1 E A [N].
        let stiffness = belt.axial_factor * belt.youngs_modulus * drive.area();
        let length = if let Some(length) = belt.length {
            length
        } else if let Some(strain) = belt.strain {
            path / (1.0 + strain)
        } else {
            path / stretch_under(belt.tension.unwrap_or(0.0) / stiffness)
        };
        let stretch = path / length;
        if stretch < 1.0 - 1.0e-12 {
            return Err(AssemblyError::TooLong {
                length,
                path,
                excess: length - path,
            });
        }
        if stretch > LARGEST_STRETCH {
            return Err(AssemblyError::TooShort {
                length,
                path,
                stretch,
                shortest: path / LARGEST_STRETCH,
            });
        }
        Ok(Self {
            length,
            path,
            stretch,
            tension: 0.5 * stiffness * (stretch * stretch - 1.0) * stretch,
        })
    }
}

/// The stretch `f` at which `(f² - 1) f / 2` equals `load`, by Newton from the right.
fn stretch_under(load: f64) -> f64 {
    let mut f = 1.0 + load;
    for _ in 0..50 {
        let step = (0.5 * (f * f - 1.0) * f - load) / (1.5 * f * f - 0.5);
        f -= step;
        if step.abs() < 1.0e-15 * f {
            break;
        }
    }
    f
}

/// A drive ready to settle and run. Its pulleys have neither friction nor external torques, and their hubs
/// stand still, until [`Assembly::release`].
#[derive(Debug)]
pub struct Assembly<E, L = BeltContact> {
    /// The mechanical system.
    pub system: System<E, L>,
    /// The initial state: belt on the path, everything at rest.
    pub motion: Motion,
    /// The belt's path.
    pub layout: Layout,
    /// How tight the belt is.
    pub mounting: Mounting,
    /// Things to tell the user.
    pub warnings: Vec<Warning>,
    /// Material coordinate of the first node of each element [m].
    pub element_start: Vec<f64>,
    /// What holds the belt while it settles: without friction nothing but the places of the contact points says
    /// where it rests along itself.
    pub holds: Vec<Hold>,
}

/// Belt elements that a drive file can ask for.
pub trait BeltElementType: LineElement {
    /// An element of the given undeformed length [m] for `belt`.
    fn for_belt(belt: &Belt, length: f64) -> Self;
}

impl BeltElementType for BeltBeam2 {
    fn for_belt(belt: &Belt, length: f64) -> Self {
        Self::new(
            length,
            &PlanarSection::rectangle(belt.width, belt.thickness),
            &material(belt),
            belt.axial_factor,
            belt.bending_factor,
            belt.damping_time,
        )
    }
}

impl BeltElementType for CubicBeam2 {
    fn for_belt(belt: &Belt, length: f64) -> Self {
        Self::new(length, &softened_section(belt), &material(belt))
    }
}

impl BeltElementType for LinearBeam2 {
    fn for_belt(belt: &Belt, length: f64) -> Self {
        Self::new(length, &softened_section(belt), &material(belt))
    }
}

fn material(belt: &Belt) -> Isotropic {
    Isotropic {
        youngs_modulus: belt.youngs_modulus,
        poisson_ratio: belt.poisson_ratio,
        density: belt.density,
    }
}

/// The section of elements that have no factors of their own: the bending factor acts on its higher
/// moments.
fn softened_section(belt: &Belt) -> PlanarSection {
    let section = PlanarSection::rectangle(belt.width, belt.thickness);
    PlanarSection {
        second_moment: belt.bending_factor * section.second_moment,
        fourth_moment: belt.bending_factor * section.fourth_moment,
        ..section
    }
}

impl<E: BeltElementType> Assembly<E> {
    /// Puts `drive` together, with the belt's ends in one node.
    pub fn new(drive: &Drive) -> Result<Self, AssemblyError> {
        let belt = &drive.belt;
        let layout = Layout::of(drive)?;
        let mounting = Mounting::new(drive, &layout)?;
        closable(drive, &mounting)?;
        let count = belt.elements;
        let length = mounting.length / count as f64;
        let mesh = Mesh::closed(vec![E::for_belt(belt, length); count]);
        let starts: Vec<f64> = (0..count).map(|i| i as f64 / count as f64).collect();
        Ok(Self {
            system: system(drive, &layout, mesh),
            motion: on_path::<E>(drive, &layout, &mounting, &starts),
            warnings: coarse_elements(drive, &layout, &mounting),
            holds: vec![hold_along(drive, &layout, [0; 2])],
            layout,
            mounting,
            element_start: (0..count).map(|i| i as f64 * length).collect(),
        })
    }

    /// Puts `drive` together from elements that begin at the parts `starts` of the belt, rising from 0.
    pub fn graded(drive: &Drive, starts: &[f64]) -> Result<Self, AssemblyError> {
        let belt = &drive.belt;
        let layout = Layout::of(drive)?;
        let mounting = Mounting::new(drive, &layout)?;
        closable(drive, &mounting)?;
        let ends = starts.iter().skip(1).chain(std::iter::once(&1.0));
        let elements = (starts.iter().zip(ends))
            .map(|(from, to)| E::for_belt(belt, (to - from) * mounting.length))
            .collect();
        Ok(Self {
            system: system(drive, &layout, Mesh::closed(elements)),
            motion: on_path::<E>(drive, &layout, &mounting, starts),
            warnings: Vec::new(),
            holds: vec![hold_along(drive, &layout, [0; 2])],
            element_start: starts.iter().map(|s| s * mounting.length).collect(),
            layout,
            mounting,
        })
    }

    /// Gives the last element an end of its own, tied to the first node by multipliers.
    pub fn open_joint(&mut self, drive: &Drive) -> Result<(), AssemblyError> {
        let elements = self.system.mesh().elements().to_vec();
        let open = system(drive, &self.layout, Mesh::open(elements));
        let structure = open.structure();
        let end = structure.chain() - E::NODE_DOF;
        let joint = (0..E::NODE_DOF)
            .map(|i| LinearEquation {
                name: "joint of the belt's ends".to_owned(),
                terms: vec![(end + i, 1.0), (i, -1.0)],
                value: Arc::new(Constant(0.0)),
            })
            .collect();
        let driven: Vec<usize> = open.prescribed().iter().map(|(i, _)| *i).collect();
        let form = ConstraintForm::Multipliers;
        let joint = ConstraintSet::new(structure, &driven, joint, Vec::new(), form)?;
        self.system = open.constrained(joint);
        let mut motion = Motion::zero(self.system.structure().size());
        let (belt, rigid) = self.motion.q.split_at(end);
        motion.q[..end].copy_from_slice(belt);
        motion.q[end..end + E::NODE_DOF].copy_from_slice(&belt[..E::NODE_DOF]);
        let rotors = end + E::NODE_DOF;
        motion.q[rotors..rotors + rigid.len()].copy_from_slice(rigid);
        self.motion = motion;
        Ok(())
    }

    /// Lets the friction of `drive` and the external torques act, and the hubs move.
    pub fn release(&mut self, drive: &Drive) {
        let laws = drive
            .pulley
            .iter()
            .map(|pulley| Law::new(drive.friction_on(pulley), pulley.grip()));
        self.system.law.set_friction(laws);
        for (contact, pulley) in self.system.law.pulleys.iter_mut().zip(&drive.pulley) {
            contact.external = pulley.external_torque();
            contact.center = pulley.center;
            contact.displacement.clone_from(&pulley.displacement);
        }
    }
}

/// The mechanical system of a belt of the given mesh, all pulleys frictionless.
fn system<E: BeltElementType>(
    drive: &Drive,
    layout: &Layout,
    mesh: Mesh<E>,
) -> System<E, BeltContact> {
    let belt = &drive.belt;
    let pulleys = (drive.pulley.iter().zip(&layout.arcs))
        .map(|(pulley, arc)| contact_pulley(drive, pulley, arc))
        .collect();
    let penalty = penalty(&drive.contact);
    let contact = BeltContact::new(&mesh, pulleys, penalty, rule(&drive.contact));
    let length = mesh.elements().first().map_or(0.0, LineElement::length);
    let scales = mesh.scales(length, belt.thickness);
    let rotors = drive.pulley.iter().map(rotor).collect();
    let mut system = System::new(mesh, scales, rotors, contact);
    if drive.gravity != [0.0, 0.0] {
        system.add_gravity(&drive.gravity);
    }
    system
}

pub(crate) fn penalty(contact: &Contact) -> Penalty {
    Penalty {
        stiffness: contact.stiffness,
        damping: contact.damping,
        clamp: contact.clamp_normal_force,
        slip_lever_part: match contact.slip_at {
            SlipAt::Surface => 1.0,
            SlipAt::Depth => 0.0,
        },
    }
}

/// The points of contact along an element.
fn rule(contact: &Contact) -> Rule {
    points_of(contact, contact.points)
}

/// So many points of the rule of `contact`.
fn points_of(contact: &Contact, count: usize) -> Rule {
    let points = NonZeroUsize::new(count).unwrap_or(NonZeroUsize::MIN);
    match contact.integration {
        Integration::Gauss => Rule::gauss(points),
        Integration::Trapezoidal => Rule::trapezoidal(points),
    }
}

/// Holds the mean of the vectors that begin at these coordinates along the path at the first node, by the axial stiffness
/// of an element: what is left to hold, the difference that the mesh makes, moves it by next to nothing.
fn hold_along(drive: &Drive, layout: &Layout, vectors: [usize; 2]) -> Hold {
    let [x, y] = layout.point(drive.belt.first_node).tangent;
    Hold {
        vectors,
        direction: [x, y, 0.0],
        stiffness: hold_stiffness(drive, layout),
    }
}

/// Axial stiffness of an element of the belt [N/m].
fn hold_stiffness(drive: &Drive, layout: &Layout) -> f64 {
    let belt = &drive.belt;
    belt.youngs_modulus * belt.width * belt.thickness * belt.elements as f64 / layout.length
}

/// The belt evenly stretched on its path, at rest, its nodes at the parts `starts` of it.
fn on_path<E: LineElement>(
    drive: &Drive,
    layout: &Layout,
    mounting: &Mounting,
    starts: &[f64],
) -> Motion {
    let chain = starts.len() * E::NODE_DOF;
    let mut motion = Motion::zero(chain + drive.pulley.len());
    let across = 2 * E::SECTION_VECTORS[0];
    for (start, node) in starts.iter().zip(motion.q.chunks_exact_mut(E::NODE_DOF)) {
        let place = layout.point(drive.belt.first_node + mounting.path * start);
        let [tx, ty] = place.tangent;
        node[0..2].copy_from_slice(&place.position);
        if E::CENTRE_VECTORS.len() == 4 {
            node[2] = mounting.stretch * tx;
            node[3] = mounting.stretch * ty;
        }
        node[across] = -ty;
        node[across + 1] = tx;
    }
    motion
}

fn contact_pulley(drive: &Drive, pulley: &Pulley, arc: &layout::Arc) -> ContactPulley {
    let [x, y, _] = pulley.middle(0.0);
    ContactPulley {
        center: [x, y],
        displacement: None,
        radius: pulley.radius,
        friction: Law::Frictionless(Frictionless),
        // The section's slope points to the left of the path: to the centre of a pulley that the path
        // turns about counter-clockwise.
        height: drive.pitch_offset_on(pulley) * arc.sweep.signum(),
        external: Profile::Constant(0.0).into(),
    }
}

fn rotor(pulley: &Pulley) -> RigidCoordinate {
    let motion: Option<Box<dyn system::Motion>> = match (&pulley.speed, &pulley.angle) {
        (Some(speed), _) => Some(Box::new(BySpeed {
            mean: speed.clone(),
            harmonics: pulley.irregularity.clone(),
        })),
        (None, Some(angle)) => Some(Box::new(ByAngle(angle.clone()))),
        (None, None) => None,
    };
    RigidCoordinate {
        inertia: pulley.inertia,
        scale: pulley.radius,
        motion,
    }
}

/// A rotor driven at a prescribed speed from angle zero. With the mean speed `w` and its angle `a`,
///
/// ```text
/// angle = a + sum (A_k / k) [sin(k a + phi_k) - sin phi_k]
/// speed = w [1 + sum A_k cos(k a + phi_k)]
/// ```
#[derive(Debug)]
struct BySpeed {
    mean: Profile,
    harmonics: Vec<Harmonic>,
}

impl system::Motion for BySpeed {
    fn at(&self, time: f64) -> [f64; 3] {
        let (a, w) = (self.mean.integral(time), self.mean.value(time));
        let (mut angle, mut factor, mut slope) = (a, 1.0, 0.0);
        for Harmonic {
            order,
            amplitude,
            phase,
        } in &self.harmonics
        {
            let (sine, cosine) = (order * a + phase).sin_cos();
            angle += amplitude / order * (sine - phase.sin());
            factor += amplitude * cosine;
            slope -= amplitude * order * sine;
        }
        [
            angle,
            w * factor,
            self.mean.derivative(time) * factor + w * w * slope,
        ]
    }
}

/// A rotor driven along a prescribed angle.
#[derive(Debug)]
struct ByAngle(Profile);

impl system::Motion for ByAngle {
    fn at(&self, time: f64) -> [f64; 3] {
        [
            self.0.value(time),
            self.0.derivative(time),
            self.0.second_derivative(time),
        ]
    }
}

/// Warns of elements that are long against the smallest pulley.
pub fn coarse_mesh(drive: &Drive, mounting: &Mounting) -> Option<Warning> {
    let (pulley, turn, elements) = largest_turn(drive, mounting)?;
    (turn > allowed_turn(drive)).then(|| Warning::CoarseMesh {
        pulley: pulley.name.clone(),
        turn: turn.to_degrees(),
        elements,
    })
}

/// Warns of pulleys on whose arcs less than one of equal elements lies.
pub fn short_arcs(drive: &Drive, layout: &Layout, mounting: &Mounting) -> Vec<Warning> {
    let element = mounting.path / drive.belt.elements as f64;
    let short = layout.arcs.iter().filter(|arc| arc.length < element);
    short
        .map(|arc| Warning::ShortArc {
            pulley: drive.pulley[arc.pulley].name.clone(),
            arc: arc.length,
            element,
            elements: whole(mounting.path / arc.length),
        })
        .collect()
}

/// What there is to say of equal elements.
pub fn coarse_elements(drive: &Drive, layout: &Layout, mounting: &Mounting) -> Vec<Warning> {
    let mut warnings = short_arcs(drive, layout, mounting);
    warnings.extend(coarse_mesh(drive, mounting));
    warnings
}

/// Refuses elements so long that they cannot make a loop around the smallest pulley.
pub fn closable(drive: &Drive, mounting: &Mounting) -> Result<(), AssemblyError> {
    match largest_turn(drive, mounting) {
        Some((pulley, turn, elements)) if turn > IMPOSSIBLE_TURN => {
            Err(AssemblyError::TooFewElements {
                pulley: pulley.name.clone(),
                turn: turn.to_degrees(),
                elements,
            })
        }
        _ => Ok(()),
    }
}

fn allowed_turn(drive: &Drive) -> f64 {
    match drive.belt.element {
        BeltElement::BeltBeam
        | BeltElement::CubicBeam
        | BeltElement::Plate
        | BeltElement::BeltBeam3d => LARGEST_TURN,
        BeltElement::LinearBeam | BeltElement::LinearBeam3d => LARGEST_TURN_STRAIGHT,
    }
}

/// The smallest pulley, how far an element turns around it [rad], and how many elements would turn no
/// further than allowed.
fn largest_turn<'a>(drive: &'a Drive, mounting: &Mounting) -> Option<(&'a Pulley, f64, usize)> {
    let smallest = (drive.pulley.iter()).min_by(|a, b| a.radius.total_cmp(&b.radius))?;
    let turn = mounting.path / drive.belt.elements as f64 / smallest.radius;
    let elements = whole(mounting.path / (smallest.radius * allowed_turn(drive)));
    Some((smallest, turn, elements))
}

/// The least whole number of elements that is no less than `number`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a positive count of elements"
)]
fn whole(number: f64) -> usize {
    number.ceil() as usize
}
