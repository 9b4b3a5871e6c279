//! From the description of a structure to a mechanical system.

use std::num::NonZeroUsize;
use std::sync::Arc;

use super::finite::finite;
use super::{Coordinate, NodeVector, PlanarStructure, StructureError, start};
use crate::constraint::{
    BodyAttachment, Constant, ConstraintForm, ConstraintSet, LinearEquation, TurnedComponent,
};
use crate::dynamics::Motion;
use crate::element::LineElement;
use crate::linear::BorderedMatrix;
use crate::loads::{Loads, NodeMoment, RotatingFrame};
use crate::mesh::Mesh;
use crate::quadrature::Rule;
use crate::statics::{Equilibrium, LoadStepError, LoadSteps, Loaded, equilibrium, linear_response};
use crate::system::{Mechanics, RigidCoordinate, System};

/// Largest distance of ends, relative to an element's length, that still meet.
pub(super) const CLOSED: f64 = 1.0e-9;
/// Correction at which statics ends, relative to the length of the chain; the error left is its square.
pub(super) const TOLERANCE: f64 = 1.0e-9;
/// Iterations of a load step.
pub(super) const MAX_ITERATIONS: usize = 25;
/// Halvings of a load step: bending a beam far beyond its thickness at once may take many.
pub(super) const HALVINGS: u32 = 12;

impl<E: LineElement> Loaded for System<E, Loads> {
    fn set_load_factor(&mut self, factor: f64) {
        self.law.factor = factor;
    }
}

impl<E: LineElement> System<E, Loads> {
    /// Kinetic, strain and load energy [J] together; moments are left out. In a rotating frame the
    /// Jacobi integral.
    pub fn energy(&self, q: &[f64], v: &[f64]) -> f64 {
        self.kinetic_energy(v) + self.strain_energy(q) + self.law.potential(q)
    }
}

impl<E: LineElement> PlanarStructure<E> {
    /// Nodes that are a node of their own.
    fn nodes(&self) -> usize {
        self.elements.len() + usize::from(!self.shares_node())
    }

    /// Whether the last node is the first one.
    fn shares_node(&self) -> bool {
        self.joined && self.form == ConstraintForm::Elimination
    }

    fn chain(&self) -> usize {
        self.nodes() * E::NODE_DOF
    }

    /// Index of a coordinate in `q`.
    pub fn index(&self, coordinate: Coordinate) -> Result<usize, StructureError> {
        match coordinate {
            Coordinate::Node { node, vector, axis } => {
                if node > self.last() {
                    let last = self.last();
                    return Err(StructureError::NoNode { node, last });
                }
                let vector = match vector {
                    NodeVector::Position => 0,
                    NodeVector::Along if E::NODE_VECTORS > 2 => 1,
                    NodeVector::Along => return Err(StructureError::NoSlopeAlong),
                    NodeVector::Across => E::NODE_VECTORS - 1,
                };
                let node = if node == self.nodes() { 0 } else { node };
                component("a vector", axis, 1)?;
                Ok(node * E::NODE_DOF + 2 * vector + axis)
            }
            Coordinate::Body { body, index } => {
                let bodies = self.bodies.len();
                if body >= bodies {
                    return Err(StructureError::NoBody { body, bodies });
                }
                component("a rigid body", index, 2)?;
                Ok(self.chain() + 3 * body + index)
            }
        }
    }

    /// The drawn coordinates, without multipliers.
    pub fn drawn(&self) -> Vec<f64> {
        let mut q = self.coordinates[..self.chain().min(self.coordinates.len())].to_vec();
        for body in &self.bodies {
            q.extend([body.place[0], body.place[1], body.angle]);
        }
        q
    }

    /// The mechanical system, under the whole load.
    pub fn build(&self) -> Result<System<E, Loads>, StructureError> {
        self.check()?;
        let mesh = if self.shares_node() {
            Mesh::closed(self.elements.clone())
        } else {
            Mesh::open(self.elements.clone())
        };
        let length = self.length() / self.elements.len() as f64;
        let scales = mesh.scales(length, self.thickness());
        let rigid = |inertia: f64, scale: f64| RigidCoordinate {
            inertia,
            scale,
            motion: None,
        };
        let bodies = (self.bodies.iter())
            .flat_map(|body| {
                let gyration = (body.inertia / body.mass).sqrt();
                let mass = body.mass;
                [
                    rigid(mass, 1.0),
                    rigid(mass, 1.0),
                    rigid(body.inertia, gyration),
                ]
            })
            .collect();
        let mut system = System::new(mesh, scales, bodies, Loads::default());
        system.law = self.loads(system.mass())?;
        let constraints = self.constraints(system.structure())?;
        Ok(match constraints {
            Some(constraints) => system.constrained(constraints),
            None => system,
        })
    }

    /// The start of a motion of the `system` that this structure was built to: coordinates as drawn, at rest
    /// but for what prescribed motions say.
    ///
    /// # Panics
    /// If `system` is that of a structure with fewer coordinates.
    pub fn at_rest(&self, system: &System<E, Loads>) -> Motion {
        let mut motion = Motion::zero(system.structure().size());
        let drawn = self.drawn();
        assert!(
            drawn.len() <= motion.q.len(),
            "the system was built from another structure"
        );
        motion.q[..drawn.len()].copy_from_slice(&drawn);
        system.prescribe(0.0, &mut motion.q, &mut motion.v, &mut motion.a);
        motion
    }

    /// The start of a motion with the given coordinates and velocities, with or without places for
    /// multipliers; they must keep the constraints.
    pub fn start(
        &self,
        system: &System<E, Loads>,
        q: &[f64],
        v: &[f64],
    ) -> Result<Motion, StructureError> {
        start::consistent(system, self.chain() + 3 * self.bodies.len(), q, v)
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
        equilibrium(&mut system, 0.0, &self.drawn(), &options)
            .map_err(|error| self.explain(&system, error))
    }

    /// The displacements of linear theory, coordinate by coordinate: one step from the drawn shape.
    pub fn linear_displacements(&self) -> Result<Vec<f64>, StructureError> {
        let mut system = self.build()?;
        linear_response(&mut system, 0.0, &self.drawn())
            .map_err(|error| self.explain(&system, error))
    }

    /// A failure of statics, as a free motion where there is one.
    fn explain(&self, system: &System<E, Loads>, error: LoadStepError) -> StructureError {
        let motions = self.free_motions(system.constraints());
        if motions.is_empty() {
            StructureError::LoadStep(error)
        } else {
            StructureError::Unsupported { motions }
        }
    }

    /// Undeformed length of the chain [m].
    pub fn length(&self) -> f64 {
        self.elements.iter().map(LineElement::length).sum()
    }

    /// Height [m] of the rectangle that has the sections' radius of gyration.
    fn thickness(&self) -> f64 {
        let vectors = E::NODES * E::NODE_VECTORS;
        let mut mass = vec![0.0; vectors * vectors];
        self.elements[0].vector_mass(&mut mass);
        let across = E::NODE_VECTORS - 1;
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
        let positive = |what: String, value: f64| {
            if value > 0.0 && value.is_finite() {
                Ok(())
            } else {
                Err(StructureError::Value {
                    what,
                    value,
                    remedy: "positive and finite",
                })
            }
        };
        for element in &self.elements {
            element.check()?;
            // Numbers that are sound alone may still be too large or too small together.
            positive(
                "Young's modulus times the volume of an element [N m]".to_owned(),
                element.energy_scale(),
            )?;
        }
        positive(
            "the thickness by the inertia of an element [m]".to_owned(),
            self.thickness(),
        )?;
        for body in &self.bodies {
            positive(format!("the mass of {} [kg]", body.name), body.mass)?;
            positive(
                format!("the inertia of {} [kg m²]", body.name),
                body.inertia,
            )?;
        }
        finite("a coordinate", self.drawn().into_iter())?;
        finite("a load", self.forces.iter().map(|(_, force)| *force))?;
        finite("a moment", self.moments.iter().map(|(_, moment)| *moment))?;
        finite(
            "a field of loads",
            self.gravity
                .into_iter()
                .chain(self.line_load)
                .chain([self.frame_speed]),
        )?;
        let factors = self.equations.iter().flat_map(|equation| &equation.terms);
        finite("a direction", factors.map(|(_, factor)| *factor))?;
        for equation in &self.equations {
            let value = equation.value.as_ref().map(|motion| motion.at(0.0));
            let what = format!("at the start the {}", equation.name);
            finite(&what, value.into_iter().flatten())?;
        }
        for turned in &self.turned {
            let what = format!(
                "at the start the prescribed rotation of node {}",
                turned.node
            );
            finite(&what, turned.angle.at(0.0).into_iter())?;
        }
        if self.joined {
            let first = &self.coordinates[..E::NODE_DOF];
            let last = &self.coordinates[wanted - E::NODE_DOF..];
            let gap = first
                .iter()
                .zip(last)
                .fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
            if gap > CLOSED * self.elements[0].length() || self.elements.len() < 3 {
                return Err(StructureError::Gap { gap });
            }
        }
        Ok(())
    }

    fn loads(&self, mass: &BorderedMatrix) -> Result<Loads, StructureError> {
        let size = self.chain() + 3 * self.bodies.len();
        let mut field = vec![0.0; size];
        for node in field[..self.chain()].chunks_exact_mut(E::NODE_DOF) {
            node[..2].copy_from_slice(&self.gravity);
        }
        for body in field[self.chain()..].chunks_exact_mut(3) {
            body[..2].copy_from_slice(&self.gravity);
        }
        let mut dead = vec![0.0; size];
        mass.multiply(&field, &mut dead);
        for (coordinate, value) in &self.forces {
            dead[self.index(*coordinate)?] += value;
        }
        self.add_line_load(&mut dead);
        let moments = (self.moments.iter())
            .map(|(node, moment)| {
                let coordinate = Coordinate::Node {
                    node: *node,
                    vector: NodeVector::Across,
                    axis: 0,
                };
                Ok(NodeMoment {
                    slope: self.index(coordinate)?,
                    moment: *moment,
                })
            })
            .collect::<Result<_, StructureError>>()?;
        let frame = (self.frame_speed != 0.0)
            .then(|| RotatingFrame::new(self.frame_speed, mass, self.bodies.len()));
        Ok(Loads {
            factor: 1.0,
            dead,
            moments,
            frame,
        })
    }

    /// Integrals of the centre line's shape functions times the load.
    fn add_line_load(&self, dead: &mut [f64]) {
        // Two points integrate cubics.
        let rule = Rule::gauss(NonZeroUsize::MIN.saturating_add(1));
        let mut weights = vec![0.0; E::NODES * E::NODE_VECTORS];
        for (i, element) in self.elements.iter().enumerate() {
            for (xi, weight) in rule.points.iter().zip(&rule.weights) {
                weights.fill(0.0);
                element.centre_line(*xi, &mut weights);
                for vector in E::CENTRE_VECTORS {
                    let shared = (i * E::NODE_DOF + 2 * vector) % self.chain();
                    for axis in 0..2 {
                        dead[shared + axis] +=
                            self.line_load[axis] * weights[*vector] * weight * element.length();
                    }
                }
            }
        }
    }

    fn constraints(
        &self,
        coordinates: crate::linear::Structure,
    ) -> Result<Option<ConstraintSet>, StructureError> {
        let drawn = self.drawn();
        let mut equations = Vec::new();
        for equation in &self.equations {
            let mut terms = Vec::with_capacity(equation.terms.len());
            for (coordinate, factor) in &equation.terms {
                terms.push((self.index(*coordinate)?, *factor));
            }
            let as_drawn = terms.iter().map(|(i, factor)| factor * drawn[*i]).sum();
            equations.push(LinearEquation {
                name: equation.name.clone(),
                terms,
                value: (equation.value.clone()).unwrap_or_else(|| Arc::new(Constant(as_drawn))),
            });
        }
        for turned in &self.turned {
            for first in self.slopes(turned.node)? {
                let vector = [drawn[first], drawn[first + 1]];
                for axis in 0..2 {
                    equations.push(LinearEquation {
                        name: format!("prescribed rotation of node {}", turned.node),
                        terms: vec![(first + axis, 1.0)],
                        value: Arc::new(TurnedComponent {
                            angle: Arc::clone(&turned.angle),
                            vector,
                            axis,
                        }),
                    });
                }
            }
        }
        if self.joined && !self.shares_node() {
            let last = self.last() * E::NODE_DOF;
            equations.extend((0..E::NODE_DOF).map(|i| LinearEquation {
                name: "joint of the ends".to_owned(),
                terms: vec![(last + i, 1.0), (i, -1.0)],
                value: Arc::new(Constant(0.0)),
            }));
        }
        let attachments = self.attachments(&drawn)?;
        if equations.is_empty() && attachments.is_empty() {
            return Ok(None);
        }
        let set = ConstraintSet::new(coordinates, &[], equations, attachments, self.form)?;
        Ok(Some(set))
    }

    /// First coordinates of the slopes of a node.
    fn slopes(&self, node: usize) -> Result<Vec<usize>, StructureError> {
        let axis = 0;
        (Self::vectors().into_iter().skip(1))
            .map(|vector| self.index(Coordinate::Node { node, vector, axis }))
            .collect()
    }

    fn attachments(&self, drawn: &[f64]) -> Result<Vec<BodyAttachment>, StructureError> {
        let mut attachments = Vec::new();
        for attached in &self.attached {
            let body = self.index(Coordinate::Body {
                body: attached.body,
                index: 0,
            })?;
            let node = attached.node;
            let kind = if attached.fastened {
                "fastening"
            } else {
                "hinge"
            };
            let name = format!(
                "{kind} of node {node} to {}",
                self.bodies[attached.body].name
            );
            let (sine, cosine) = drawn[body + 2].sin_cos();
            let mut add = |vector: usize, is_place: bool| {
                let from = if is_place {
                    [drawn[body], drawn[body + 1]]
                } else {
                    [0.0; 2]
                };
                let [x, y] = [drawn[vector] - from[0], drawn[vector + 1] - from[1]];
                attachments.push(BodyAttachment {
                    name: name.clone(),
                    vector,
                    body,
                    arm: [cosine * x + sine * y, cosine * y - sine * x],
                    is_place,
                });
            };
            add(self.index(Self::place(node, 0))?, true);
            if attached.fastened {
                for slope in self.slopes(node)? {
                    add(slope, false);
                }
            }
        }
        Ok(attachments)
    }
}

fn component(what: &'static str, component: usize, last: usize) -> Result<(), StructureError> {
    if component > last {
        return Err(StructureError::NoComponent {
            what,
            component,
            last,
        });
    }
    Ok(())
}
