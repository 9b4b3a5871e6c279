//! Structures of spatial beams: mesh, supports, loads, and an answer.
//!
//! ```
//! use ancf::element::BeltBeam3;
//! use ancf::material::Isotropic;
//! use ancf::section::SpatialSection;
//! use ancf::structure::{NodeDirection, SpatialStructure};
//!
//! # fn main() -> Result<(), ancf::structure::StructureError> {
//! let section = SpatialSection::rectangle(0.01, 0.02);
//! let steel = Isotropic { youngs_modulus: 2.07e11, poisson_ratio: 0.3, density: 7850.0 };
//! let element = BeltBeam3::new(0.25, &section, &steel, 1.0, 1.0);
//! let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let mut beam = SpatialStructure::straight(element, 4, [0.0; 3], axes);
//! beam.clamp_section(0);
//! beam.force(beam.last(), NodeDirection::Position, [0.0, -10.0, 5.0]);
//! let bent = beam.equilibrium()?;
//! let [_, y, z] = beam.vector(&bent.q, beam.last(), NodeDirection::Position);
//! assert!((y + 2.417e-3).abs() < 1e-5);    // P L³ / 3 E Iy + P L / ks G A
//! assert!((z - 4.830e-3).abs() < 2e-5);    // and in the plane of the width
//! # Ok(())
//! # }
//! ```
//!
//! The chain may be open or a loop. Rigid bodies beside it, prescribed rotations and rotating frames are those of
//! [`PlanarStructure`](super::PlanarStructure) alone.

use std::num::NonZeroUsize;
use std::sync::Arc;

use super::build::{HALVINGS, MAX_ITERATIONS, TOLERANCE};
use super::finite::finite;
use super::modes::natural_modes;
use super::{Mode, StructureError, start};
use crate::constraint::{Constant, ConstraintForm, ConstraintSet, LinearEquation};
use crate::dynamics;
use crate::element::LineElement;
use crate::linear::BorderedMatrix;
use crate::loads::Loads;
use crate::mesh::Mesh;
use crate::quadrature::Rule;
use crate::statics::{Equilibrium, LoadSteps, equilibrium, linear_response};
use crate::system::{Mechanics, Motion, System};

/// A vector of a node of a spatial beam.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeDirection {
    /// Its place r [m].
    Position,
    /// The slope along the body r_x, where the element has one.
    Along,
    /// The slope over the height r_y.
    Height,
    /// The slope across the width r_z.
    Width,
}

/// An equation for one coordinate: its motion, `None` for the drawn value.
#[derive(Clone, Debug)]
struct Held {
    name: String,
    node: usize,
    vector: NodeDirection,
    axis: usize,
    value: Option<Arc<dyn Motion>>,
}

/// One chain of spatial beams with supports and loads.
#[derive(Clone, Debug)]
pub struct SpatialStructure<E> {
    elements: Vec<E>,
    coordinates: Vec<f64>,
    closed: bool,
    held: Vec<Held>,
    forces: Vec<(usize, NodeDirection, [f64; 3])>,
    gravity: [f64; 3],
    line_load: [f64; 3],
    form: ConstraintForm,
    load_steps: Option<LoadSteps>,
}

impl<E: LineElement> SpatialStructure<E> {
    /// A straight beam of `count` elements like `element`, drawn from `start` [m]: `axes` are the unit
    /// vectors of its length, height and width, at right angles to each other.
    #[must_use]
    pub fn straight(element: E, count: usize, start: [f64; 3], axes: [[f64; 3]; 3]) -> Self {
        let mut local = vec![0.0; E::DOF];
        element.reference(&mut local);
        let mut coordinates = Vec::with_capacity((count + 1) * E::NODE_DOF);
        for node in 0..=count {
            for (k, vector) in local[..E::NODE_DOF].chunks_exact(3).enumerate() {
                let along = if k == 0 {
                    node as f64 * element.length()
                } else {
                    vector[0]
                };
                let place = if k == 0 { start } else { [0.0; 3] };
                coordinates.extend((0..3).map(|i| {
                    place[i] + along * axes[0][i] + vector[1] * axes[1][i] + vector[2] * axes[2][i]
                }));
            }
        }
        Self::with_nodes(vec![element; count], coordinates)
    }

    /// A chain of elements with the given undeformed nodal coordinates, node by node.
    #[must_use]
    pub fn with_nodes(elements: Vec<E>, coordinates: Vec<f64>) -> Self {
        const {
            assert!(
                E::DIMENSION == 3 && E::NODES == 2,
                "a spatial structure takes spatial beams"
            );
        }
        Self {
            elements,
            coordinates,
            closed: false,
            held: Vec::new(),
            forces: Vec::new(),
            gravity: [0.0; 3],
            line_load: [0.0; 3],
            form: ConstraintForm::default(),
            load_steps: None,
        }
    }

    /// Number of the last node; the first is 0.
    pub fn last(&self) -> usize {
        self.elements.len()
    }

    /// Holds a node where it is drawn; it may turn.
    pub fn pin(&mut self, node: usize) -> &mut Self {
        self.hold(
            &format!("pin of node {node}"),
            node,
            NodeDirection::Position,
        )
    }

    /// Holds a node and its cross-section as they are drawn: r, r_y and r_z. A slope r_x stays free, so that the section
    /// may shear against the centre line: the clamp of Timoshenko's beam.
    pub fn clamp_section(&mut self, node: usize) -> &mut Self {
        let name = format!("clamp of node {node}");
        for vector in [
            NodeDirection::Position,
            NodeDirection::Height,
            NodeDirection::Width,
        ] {
            self.hold(&name, node, vector);
        }
        self
    }

    /// Holds a node and all its slopes as they are drawn.
    pub fn clamp(&mut self, node: usize) -> &mut Self {
        self.clamp_section(node);
        if E::NODE_VECTORS > 3 {
            self.hold(&format!("clamp of node {node}"), node, NodeDirection::Along);
        }
        self
    }

    /// Moves a component (0: x, 1: y, 2: z) of a vector of a node as prescribed in time.
    pub fn prescribe(
        &mut self,
        node: usize,
        vector: NodeDirection,
        axis: usize,
        motion: Arc<dyn Motion>,
    ) -> &mut Self {
        self.held.push(Held {
            name: format!("prescribed motion of {vector:?} {axis} of node {node}"),
            node,
            vector,
            axis,
            value: Some(motion),
        });
        self
    }

    /// Holds a component of a vector of a node as it is drawn.
    pub fn fix(&mut self, node: usize, vector: NodeDirection, axis: usize) -> &mut Self {
        self.held.push(Held {
            name: format!("{vector:?} {axis} of node {node}"),
            node,
            vector,
            axis,
            value: None,
        });
        self
    }

    /// Joins the last node to the first, which must lie in one place with equal slopes: a loop of at least three.
    pub fn join_ends(&mut self) -> &mut Self {
        self.closed = true;
        self
    }

    /// Adds a dead generalised force on a vector of a node: [N] on its place, [N m] on a slope, where a pair such as
    /// `(0, 0, m/2)` on r_y and `(0, -m/2, 0)` on r_z is a moment m about x of the section as drawn.
    pub fn force(&mut self, node: usize, vector: NodeDirection, force: [f64; 3]) -> &mut Self {
        self.forces.push((node, vector, force));
        self
    }

    /// Adds a uniform acceleration field [m/s²] on all masses.
    pub fn gravity(&mut self, field: [f64; 3]) -> &mut Self {
        self.gravity = std::array::from_fn(|axis| self.gravity[axis] + field[axis]);
        self
    }

    /// Adds a dead force per undeformed length [N/m] on the whole centre line.
    pub fn line_load(&mut self, load: [f64; 3]) -> &mut Self {
        self.line_load = std::array::from_fn(|axis| self.line_load[axis] + load[axis]);
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

    /// A vector of a node in the coordinates `q`; not a number for one that does not exist.
    pub fn vector(&self, q: &[f64], node: usize, vector: NodeDirection) -> [f64; 3] {
        std::array::from_fn(|axis| {
            self.index(node, vector, axis)
                .map_or(f64::NAN, |i| q.get(i).copied().unwrap_or(f64::NAN))
        })
    }

    /// Force [N] of the supports on a node in an equilibrium.
    pub fn reaction(&self, equilibrium: &Equilibrium, node: usize) -> [f64; 3] {
        self.vector(&equilibrium.reactions, node, NodeDirection::Position)
    }

    /// Index of a component of a vector of a node in `q`.
    pub fn index(
        &self,
        node: usize,
        vector: NodeDirection,
        axis: usize,
    ) -> Result<usize, StructureError> {
        if node > self.last() {
            let last = self.last();
            return Err(StructureError::NoNode { node, last });
        }
        let across = E::NODE_VECTORS - 2;
        let vector = match vector {
            NodeDirection::Position => 0,
            NodeDirection::Along if across > 1 => 1,
            NodeDirection::Along => return Err(StructureError::NoSlopeAlong),
            NodeDirection::Height => across,
            NodeDirection::Width => across + 1,
        };
        if axis > 2 {
            return Err(StructureError::NoComponent {
                what: "a vector",
                component: axis,
                last: 2,
            });
        }
        let node = node % self.nodes();
        Ok(node * E::NODE_DOF + 3 * vector + axis)
    }

    /// The mechanical system, under the whole load.
    pub fn build(&self) -> Result<System<E, Loads>, StructureError> {
        self.check()?;
        let mesh = if self.closed {
            Mesh::closed(self.elements.clone())
        } else {
            Mesh::open(self.elements.clone())
        };
        let scales = mesh.scales(self.length() / self.elements.len() as f64, self.thickness());
        let mut system = System::new(mesh, scales, Vec::new(), Loads::default());
        system.law = self.loads(system.mass())?;
        let drawn = self.drawn();
        let mut equations = Vec::with_capacity(self.held.len());
        for held in &self.held {
            let index = self.index(held.node, held.vector, held.axis)?;
            let value = held.value.clone();
            equations.push(LinearEquation {
                name: held.name.clone(),
                terms: vec![(index, 1.0)],
                value: value.unwrap_or_else(|| Arc::new(Constant(drawn[index]))),
            });
        }
        if equations.is_empty() {
            return Ok(system);
        }
        let structure = system.structure();
        let set = ConstraintSet::new(structure, &[], equations, Vec::new(), self.form)?;
        Ok(system.constrained(set))
    }

    /// The start of a motion: coordinates as drawn, at rest but for what prescribed motions say.
    ///
    /// # Panics
    /// If `system` is that of a structure with fewer coordinates.
    pub fn at_rest(&self, system: &System<E, Loads>) -> dynamics::Motion {
        let mut motion = dynamics::Motion::zero(system.structure().size());
        let drawn = self.drawn();
        motion.q[..drawn.len()].copy_from_slice(drawn);
        system.prescribe(0.0, &mut motion.q, &mut motion.v, &mut motion.a);
        motion
    }

    /// The start of a motion with the given coordinates and velocities, with or without places for multipliers; they
    /// must keep the constraints.
    pub fn start(
        &self,
        system: &System<E, Loads>,
        q: &[f64],
        v: &[f64],
    ) -> Result<dynamics::Motion, StructureError> {
        start::consistent(system, self.nodes() * E::NODE_DOF, q, v)
    }

    /// The static equilibrium under all loads, with prescribed motions as at time zero.
    pub fn equilibrium(&self) -> Result<Equilibrium, StructureError> {
        let mut system = self.build()?;
        let options = self.load_steps.unwrap_or(LoadSteps {
            steps: 1,
            halvings: HALVINGS,
            tolerance: TOLERANCE * self.length(),
            max_iterations: MAX_ITERATIONS,
        });
        Ok(equilibrium(&mut system, 0.0, self.drawn(), &options)?)
    }

    /// The displacements of linear theory, coordinate by coordinate: one step from the drawn shape.
    pub fn linear_displacements(&self) -> Result<Vec<f64>, StructureError> {
        let mut system = self.build()?;
        Ok(linear_response(&mut system, 0.0, self.drawn())?)
    }

    /// All modes about an equilibrium, by rising frequency. A free structure has six with frequencies that are
    /// rounding errors.
    pub fn modes(&self, equilibrium: &Equilibrium) -> Result<Vec<Mode>, StructureError> {
        natural_modes(&mut self.build()?, equilibrium, false)
    }

    fn hold(&mut self, name: &str, node: usize, vector: NodeDirection) -> &mut Self {
        self.held.extend((0..3).map(|axis| Held {
            name: name.to_owned(),
            node,
            vector,
            axis,
            value: None,
        }));
        self
    }

    fn nodes(&self) -> usize {
        self.elements.len() + usize::from(!self.closed)
    }

    /// The drawn coordinates, without multipliers.
    pub fn drawn(&self) -> &[f64] {
        let count = (self.nodes() * E::NODE_DOF).min(self.coordinates.len());
        &self.coordinates[..count]
    }

    /// Undeformed length of the chain [m].
    pub fn length(&self) -> f64 {
        self.elements.iter().map(LineElement::length).sum()
    }

    /// Height [m] of the rectangle that has the sections' radius of gyration over the height.
    fn thickness(&self) -> f64 {
        let vectors = E::NODES * E::NODE_VECTORS;
        let mut mass = vec![0.0; vectors * vectors];
        self.elements[0].vector_mass(&mut mass);
        let across = E::NODE_VECTORS - 2;
        (12.0 * mass[across * (vectors + 1)] / mass[0]).sqrt()
    }

    fn check(&self) -> Result<(), StructureError> {
        if self.elements.is_empty() {
            return Err(StructureError::NoElements);
        }
        let wanted = (self.elements.len() + 1) * E::NODE_DOF;
        if self.coordinates.len() != wanted {
            return Err(StructureError::CoordinateCount {
                given: self.coordinates.len(),
                wanted,
            });
        }
        for element in &self.elements {
            element.check()?;
            for (what, value) in [
                ("the length of an element [m]", element.length()),
                (
                    "Young's modulus times the volume of an element [N m]",
                    element.energy_scale(),
                ),
                (
                    "the thickness by the inertia of an element",
                    self.thickness(),
                ),
            ] {
                if !(value > 0.0 && value.is_finite()) {
                    let what = what.to_owned();
                    let remedy = "positive and finite";
                    return Err(StructureError::Value {
                        what,
                        value,
                        remedy,
                    });
                }
            }
        }
        finite("a coordinate", self.coordinates.iter().copied())?;
        finite(
            "a load",
            self.forces.iter().flat_map(|(_, _, force)| *force),
        )?;
        finite(
            "a field of loads",
            self.gravity.into_iter().chain(self.line_load),
        )?;
        if self.closed {
            let first = &self.coordinates[..E::NODE_DOF];
            let last = &self.coordinates[wanted - E::NODE_DOF..];
            let gap = (first.iter().zip(last)).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
            if gap > super::build::CLOSED * self.elements[0].length() || self.elements.len() < 3 {
                return Err(StructureError::Gap { gap });
            }
        }
        Ok(())
    }

    fn loads(&self, mass: &BorderedMatrix) -> Result<Loads, StructureError> {
        let size = self.nodes() * E::NODE_DOF;
        let mut field = vec![0.0; size];
        for node in field.chunks_exact_mut(E::NODE_DOF) {
            node[..3].copy_from_slice(&self.gravity);
        }
        let mut dead = vec![0.0; size];
        mass.multiply(&field, &mut dead);
        for (node, vector, force) in &self.forces {
            for (axis, value) in force.iter().enumerate() {
                dead[self.index(*node, *vector, axis)?] += value;
            }
        }
        // Two points integrate the cubic shape functions of the centre line.
        let rule = Rule::gauss(NonZeroUsize::MIN.saturating_add(1));
        let mut weights = vec![0.0; E::NODES * E::NODE_VECTORS];
        for (i, element) in self.elements.iter().enumerate() {
            for (xi, weight) in rule.points.iter().zip(&rule.weights) {
                weights.fill(0.0);
                element.centre_line(*xi, &mut weights);
                for vector in E::CENTRE_VECTORS {
                    let first = (i * E::NODE_DOF + 3 * vector) % size;
                    for axis in 0..3 {
                        dead[first + axis] +=
                            self.line_load[axis] * weights[*vector] * weight * element.length();
                    }
                }
            }
        }
        Ok(Loads {
            factor: 1.0,
            dead,
            ..Loads::default()
        })
    }
}
