//! Structures of beams and plates: mesh, section, material, supports, loads, and an answer.
//!
//! ```
//! use ancf::element::LinearBeam2;
//! use ancf::material::Isotropic;
//! use ancf::section::PlanarSection;
//! use ancf::structure::PlanarStructure;
//!
//! # fn main() -> Result<(), ancf::structure::StructureError> {
//! let section = PlanarSection::rectangle(0.1, 0.1);
//! let steel = Isotropic { youngs_modulus: 2.07e11, poisson_ratio: 0.3, density: 7850.0 };
//! let mut beam = PlanarStructure::straight(LinearBeam2::new(0.5, &section, &steel), 4, [0.0, 0.0], 0.0);
//! beam.clamp(0);
//! beam.force(beam.last(), [0.0, -1000.0]);
//! let bent = beam.equilibrium()?;
//! let [_, y] = beam.position(&bent.q, beam.last());
//! assert!((y + 1.5e-3).abs() < 1e-4);      // P L³ / 3 E I = 1.546 mm, less with 4 elements
//! # Ok(())
//! # }
//! ```
//!
//! A structure describes; [`PlanarStructure::build`] turns it into a [`System`] that the integrators of
//! [`crate::dynamics`] run. Nodes are numbered from 0 along the body. Everything is in SI units and in
//! global axes, however the beam is drawn.

mod build;
mod finite;
mod free_motion;
mod modes;
mod plate;
mod spatial;
mod start;

pub use free_motion::{FreeMotion, RigidMotion};
pub use modes::Mode;
pub use plate::{Edge, PlateStructure};
pub use spatial::{NodeDirection, SpatialStructure};

use std::fmt;
use std::sync::Arc;

use thiserror::Error;

use crate::constraint::{ConstraintError, ConstraintForm};
use crate::element::LineElement;
use crate::statics::{Equilibrium, LoadStepError, LoadSteps};
use crate::system::Motion;
use crate::unsound::Unsound;

/// A vector of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeVector {
    /// Its place r [m].
    Position,
    /// The slope along the body r_x, where the element has one.
    Along,
    /// The slope across the body r_y, the fibre of the cross-section.
    Across,
}

/// A coordinate of a structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinate {
    /// A component (0: x, 1: y) of a vector of a node.
    Node {
        /// Number of the node.
        node: usize,
        /// Which of its vectors.
        vector: NodeVector,
        /// 0 for x, 1 for y.
        axis: usize,
    },
    /// A coordinate of a rigid body: 0 for x, 1 for y of its centre of mass, 2 for its angle.
    Body {
        /// Number of the body, as [`PlanarStructure::body`] returned it.
        body: usize,
        /// 0, 1 or 2.
        index: usize,
    },
}

impl fmt::Display for Coordinate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let axis = |k: usize| ["x", "y"].get(k).copied().unwrap_or("?");
        match *self {
            Self::Node {
                node,
                vector,
                axis: k,
            } => {
                let of = match vector {
                    NodeVector::Position => "",
                    NodeVector::Along => " of the slope along the body",
                    NodeVector::Across => " of the slope across the body",
                };
                write!(f, "{}{of} of node {node}", axis(k))
            }
            Self::Body { body, index: 2 } => write!(f, "the angle of rigid body {body}"),
            Self::Body { body, index } => write!(f, "{} of rigid body {body}", axis(index)),
        }
    }
}

/// A planar rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidBody {
    /// What messages call it.
    pub name: String,
    /// Mass [kg].
    pub mass: f64,
    /// Moment of inertia about the centre of mass [kg m²].
    pub inertia: f64,
    /// Place of the centre of mass at the start [m].
    pub place: [f64; 2],
    /// Angle at the start [rad].
    pub angle: f64,
}

/// What is wrong with a structure, or what it cannot do.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StructureError {
    /// A node that the structure does not have.
    #[error("there is no node {node}: the nodes are 0 to {last}")]
    NoNode {
        /// The number given.
        node: usize,
        /// The last node.
        last: usize,
    },
    /// A node that the plate does not have.
    #[error("there is no node {node:?}: the nodes are [0, 0] to {last:?}, with axes 0 to 2")]
    NoPlateNode {
        /// The node given.
        node: [usize; 2],
        /// The last node.
        last: [usize; 2],
    },
    /// A component that vectors of nodes or rigid bodies do not have.
    #[error("there is no component {component} of {what}: the components are 0 to {last}")]
    NoComponent {
        /// What has components.
        what: &'static str,
        /// The number given.
        component: usize,
        /// The last component.
        last: usize,
    },
    /// A structure without elements.
    #[error("a structure needs at least one element")]
    NoElements,
    /// A state or an equilibrium of another structure.
    #[error("{what} has {given} values, this structure has {wanted}: it is that of another one")]
    Foreign {
        /// What was given.
        what: &'static str,
        /// Its length.
        given: usize,
        /// The length that it must have.
        wanted: usize,
    },
    /// A body that the structure does not have.
    #[error("there is no rigid body {body}: {bodies} were added")]
    NoBody {
        /// The number given.
        body: usize,
        /// How many there are.
        bodies: usize,
    },
    /// A slope that the element does not have.
    #[error("the nodes of this element have no slope along the body")]
    NoSlopeAlong,
    /// A number that is no number, or a quantity that must be positive.
    #[error("{what} is {value}; it must be {remedy}")]
    Value {
        /// What the number is.
        what: String,
        /// The number.
        value: f64,
        /// What it must be.
        remedy: &'static str,
    },
    /// Coordinates that do not fit the elements.
    #[error("{given} nodal coordinates were given, the elements have {wanted}")]
    CoordinateCount {
        /// Coordinates given.
        given: usize,
        /// Coordinates that the elements have.
        wanted: usize,
    },
    /// Ends that do not meet cannot be joined.
    #[error("the ends to be joined are {gap:.3e} m apart")]
    Gap {
        /// Distance of the ends, or difference of their slopes.
        gap: f64,
    },
    /// Supports contradict or repeat each other.
    #[error(transparent)]
    Constraint(#[from] ConstraintError),
    /// The structure can move without resistance.
    #[error("nothing holds the structure: it is free {}", join(motions))]
    Unsupported {
        /// Its free motions.
        motions: Vec<FreeMotion>,
    },
    /// A plate can move without resistance.
    #[error("nothing holds the plate: it is free to {}", motions.join(", to "))]
    FreePlate {
        /// Its free motions, about its middle.
        motions: Vec<&'static str>,
    },
    /// No equilibrium was found.
    #[error(transparent)]
    LoadStep(#[from] LoadStepError),
    /// A start that breaks the constraints.
    #[error("the start breaks the constraint {name} by {amount:.3e} {unit}")]
    Start {
        /// Name of the constraint.
        name: String,
        /// By how much.
        amount: f64,
        /// m or m/s.
        unit: &'static str,
    },
    /// The natural frequencies could not be computed.
    #[error("the eigenvalues do not converge, or the mass of a coordinate is not positive")]
    Modes,
}

impl From<Unsound> for StructureError {
    fn from(
        Unsound {
            what,
            value,
            remedy,
        }: Unsound,
    ) -> Self {
        let what = what.to_owned();
        Self::Value {
            what,
            value,
            remedy,
        }
    }
}

fn join(motions: &[FreeMotion]) -> String {
    let texts: Vec<String> = motions.iter().map(ToString::to_string).collect();
    texts.join(", and ")
}

/// An equation between coordinates: coefficients and the right-hand side, `None` for the drawn value.
#[derive(Clone, Debug)]
struct Equation {
    name: String,
    terms: Vec<(Coordinate, f64)>,
    value: Option<Arc<dyn Motion>>,
}

/// A node held by a rigid body.
#[derive(Clone, Debug)]
struct Attached {
    node: usize,
    body: usize,
    /// Whether the slopes turn with the body too.
    fastened: bool,
}

/// A vector of a node that turns with a prescribed angle from how it is drawn.
#[derive(Clone, Debug)]
struct Turned {
    node: usize,
    angle: Arc<dyn Motion>,
}

/// A planar structure: one chain of beams, rigid bodies, supports and loads.
#[derive(Clone, Debug)]
pub struct PlanarStructure<E> {
    elements: Vec<E>,
    coordinates: Vec<f64>,
    joined: bool,
    bodies: Vec<RigidBody>,
    equations: Vec<Equation>,
    turned: Vec<Turned>,
    attached: Vec<Attached>,
    forces: Vec<(Coordinate, f64)>,
    moments: Vec<(usize, f64)>,
    gravity: [f64; 2],
    line_load: [f64; 2],
    frame_speed: f64,
    form: ConstraintForm,
    load_steps: Option<LoadSteps>,
}

impl<E: LineElement> PlanarStructure<E> {
    /// A straight beam of `count` elements like `element`, drawn from `start` [m] in the direction
    /// `angle` [rad].
    #[must_use]
    pub fn straight(element: E, count: usize, start: [f64; 2], angle: f64) -> Self {
        let mut local = vec![0.0; E::DOF];
        element.reference(&mut local);
        let (sine, cosine) = angle.sin_cos();
        let mut coordinates = Vec::with_capacity((count + 1) * E::NODE_DOF);
        for node in 0..=count {
            for (k, vector) in local[..E::NODE_DOF].chunks_exact(2).enumerate() {
                let along = if k == 0 {
                    node as f64 * element.length()
                } else {
                    vector[0]
                };
                let place = if k == 0 { start } else { [0.0; 2] };
                coordinates.push(place[0] + cosine * along - sine * vector[1]);
                coordinates.push(place[1] + sine * along + cosine * vector[1]);
            }
        }
        Self::with_nodes(vec![element; count], coordinates)
    }

    /// A chain of elements with the given undeformed nodal coordinates, node by node.
    #[must_use]
    pub fn with_nodes(elements: Vec<E>, coordinates: Vec<f64>) -> Self {
        const {
            assert!(
                E::DIMENSION == 2 && E::NODES == 2,
                "a planar structure takes planar beams"
            );
        }
        Self {
            elements,
            coordinates,
            joined: false,
            bodies: Vec::new(),
            equations: Vec::new(),
            turned: Vec::new(),
            attached: Vec::new(),
            forces: Vec::new(),
            moments: Vec::new(),
            gravity: [0.0; 2],
            line_load: [0.0; 2],
            frame_speed: 0.0,
            form: ConstraintForm::default(),
            load_steps: None,
        }
    }

    /// Number of the last node; the first is 0.
    pub fn last(&self) -> usize {
        self.elements.len()
    }

    /// Adds a rigid body and returns its number.
    pub fn body(&mut self, body: RigidBody) -> usize {
        self.bodies.push(body);
        self.bodies.len() - 1
    }

    /// Holds a node where it is drawn; it may turn.
    pub fn pin(&mut self, node: usize) -> &mut Self {
        let name = format!("pin of node {node}");
        for axis in 0..2 {
            self.fix(&name, node, NodeVector::Position, axis);
        }
        self
    }

    /// Holds a node and all its slopes as they are drawn.
    pub fn clamp(&mut self, node: usize) -> &mut Self {
        let name = format!("clamp of node {node}");
        for vector in Self::vectors() {
            for axis in 0..2 {
                self.fix(&name, node, vector, axis);
            }
        }
        self
    }

    /// Lets a node slide along a line only: no motion along `normal`.
    pub fn roller(&mut self, node: usize, normal: [f64; 2]) -> &mut Self {
        let length = normal[0].hypot(normal[1]);
        let terms = (0..2)
            .map(|axis| (Self::place(node, axis), normal[axis] / length))
            .filter(|(_, factor)| *factor != 0.0)
            .collect();
        self.equations.push(Equation {
            name: format!("roller of node {node}"),
            terms,
            value: None,
        });
        self
    }

    /// Moves a coordinate as prescribed in time.
    pub fn prescribe(&mut self, coordinate: Coordinate, motion: Arc<dyn Motion>) -> &mut Self {
        self.equations.push(Equation {
            name: format!("prescribed motion of {coordinate}"),
            terms: vec![(coordinate, 1.0)],
            value: Some(motion),
        });
        self
    }

    /// Holds a node where it is drawn and turns its slopes by the angle [rad] prescribed in time
    /// (Kerkkänen 2006, 2.35).
    pub fn turn(&mut self, node: usize, angle: Arc<dyn Motion>) -> &mut Self {
        self.pin(node);
        self.turned.push(Turned { node, angle });
        self
    }

    /// Hinges a node to a rigid body, at the place where both are drawn.
    pub fn hinge(&mut self, node: usize, body: usize) -> &mut Self {
        self.attached.push(Attached {
            node,
            body,
            fastened: false,
        });
        self
    }

    /// Fastens a node to a rigid body: its place and its slopes move with it.
    pub fn fasten(&mut self, node: usize, body: usize) -> &mut Self {
        self.attached.push(Attached {
            node,
            body,
            fastened: true,
        });
        self
    }

    /// Joins the last node to the first, which must lie in one place with equal slopes. With
    /// multipliers by equations; by elimination the two become one node.
    pub fn join_ends(&mut self) -> &mut Self {
        self.joined = true;
        self
    }

    /// Adds a dead force [N] on a node.
    pub fn force(&mut self, node: usize, force: [f64; 2]) -> &mut Self {
        for (axis, value) in force.into_iter().enumerate() {
            self.forces.push((Self::place(node, axis), value));
        }
        self
    }

    /// Adds a moment [N m], counter-clockwise, that turns the fibre of a node's cross-section.
    pub fn moment(&mut self, node: usize, moment: f64) -> &mut Self {
        self.moments.push((node, moment));
        self
    }

    /// Adds a dead force [N] on a body's centre of mass and a moment [N m] on the body.
    pub fn body_load(&mut self, body: usize, force: [f64; 2], moment: f64) -> &mut Self {
        for (index, value) in [force[0], force[1], moment].into_iter().enumerate() {
            self.forces.push((Coordinate::Body { body, index }, value));
        }
        self
    }

    /// Adds a uniform acceleration field [m/s²] on all masses.
    pub fn gravity(&mut self, field: [f64; 2]) -> &mut Self {
        self.gravity = std::array::from_fn(|axis| self.gravity[axis] + field[axis]);
        self
    }

    /// Adds a dead force per undeformed length [N/m] on the whole centre line.
    pub fn line_load(&mut self, load: [f64; 2]) -> &mut Self {
        self.line_load = std::array::from_fn(|axis| self.line_load[axis] + load[axis]);
        self
    }

    /// Describes the structure in a frame that turns about the origin with this speed [rad/s]: supports
    /// are at rest in it, gravity and dead loads turn with it.
    pub fn rotating_frame(&mut self, speed: f64) -> &mut Self {
        self.frame_speed = speed;
        self
    }

    /// Chooses how constraints enter the equations.
    pub fn constraint_form(&mut self, form: ConstraintForm) -> &mut Self {
        self.form = form;
        self
    }

    /// Chooses how statics applies the loads; the default is one step to 1e-9 of the length.
    pub fn load_steps(&mut self, options: LoadSteps) -> &mut Self {
        self.load_steps = Some(options);
        self
    }

    /// Place [m] of a node in the coordinates `q`; not a number for a node that does not exist.
    pub fn position(&self, q: &[f64], node: usize) -> [f64; 2] {
        self.vector(q, node, NodeVector::Position)
    }

    /// A vector of a node in the coordinates `q`; not a number for one that does not exist.
    pub fn vector(&self, q: &[f64], node: usize, vector: NodeVector) -> [f64; 2] {
        let index = |axis| self.index(Coordinate::Node { node, vector, axis });
        std::array::from_fn(|axis| {
            index(axis).map_or(f64::NAN, |i| q.get(i).copied().unwrap_or(f64::NAN))
        })
    }

    /// Force [N] of the supports on a node in an equilibrium.
    pub fn reaction(&self, equilibrium: &Equilibrium, node: usize) -> [f64; 2] {
        self.position(&equilibrium.reactions, node)
    }

    fn place(node: usize, axis: usize) -> Coordinate {
        Coordinate::Node {
            node,
            vector: NodeVector::Position,
            axis,
        }
    }

    /// The vectors that the nodes of the element have.
    fn vectors() -> Vec<NodeVector> {
        let mut vectors = vec![NodeVector::Position];
        if E::NODE_VECTORS > 2 {
            vectors.push(NodeVector::Along);
        }
        vectors.push(NodeVector::Across);
        vectors
    }

    fn fix(&mut self, name: &str, node: usize, vector: NodeVector, axis: usize) {
        self.equations.push(Equation {
            name: name.to_owned(),
            terms: vec![(Coordinate::Node { node, vector, axis }, 1.0)],
            value: None,
        });
    }
}
