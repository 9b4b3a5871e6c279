//! A mechanical system: one flexible body, rigid coordinates beside it, and a law of forces.
//!
//! Coordinates `q = [nodes of the body ..., rigid coordinates ...]`. The equations of motion are
//!
//! ```text
//! M q'' = f(t, q, q')          M constant
//! ```
//!
//! with prescribed rigid coordinates put in exactly. [`Mechanics`] is what integrators and statics
//! see of it. Constraints ([`crate::constraint`]) may add their multipliers as the last unknowns of the
//! border: in a vector of accelerations the value there is the multiplier, in coordinates and
//! velocities it is zero.

use crate::constraint::ConstraintSet;
use crate::element::Element;
use crate::linear::{BorderedMatrix, SectionPanels, Structure};
use crate::mesh::Mesh;

pub use crate::state::{Motion, State};

/// What integrators and statics need to know of a system.
pub trait Mechanics {
    /// Shape of its matrices.
    fn structure(&self) -> Structure;

    /// The constant mass matrix.
    fn mass(&self) -> &BorderedMatrix;

    /// Writes the generalised forces at `state` to `force`.
    fn force(&mut self, state: State<'_>, force: &mut [f64]);

    /// Adds `position_factor * K + velocity_factor * C` to `matrix`, `K = -df/dq`, `C = -df/dv`.
    fn add_tangent(
        &mut self,
        state: State<'_>,
        position_factor: f64,
        velocity_factor: f64,
        matrix: &mut BorderedMatrix,
    );

    /// Tells forces with memory that `state` ended a step.
    fn accept(&mut self, state: State<'_>) {
        let _ = state;
    }

    /// Coordinates whose motion is prescribed: index and motion.
    fn prescribed(&self) -> &[(usize, Box<dyn Motion>)];

    /// Scale [m per unit] of each coordinate in convergence norms; zero for multipliers.
    fn scales(&self) -> &[f64];

    /// Components of the vectors that the chain's coordinates are made of. Norms take the length of each
    /// vector, whose components share their scale, so that they do not depend on the axes.
    fn dimension(&self) -> usize {
        1
    }

    /// The constraints, if any.
    fn constraints(&self) -> Option<&ConstraintSet> {
        None
    }

    /// Puts the prescribed and the dependent coordinates, velocities and accelerations at `time` in.
    fn prescribe(&self, time: f64, q: &mut [f64], v: &mut [f64], a: &mut [f64]) {
        for (index, motion) in self.prescribed() {
            [q[*index], v[*index], a[*index]] = motion.at(time);
        }
        if let Some(constraints) = self.constraints() {
            constraints.enforce(time, q, v, a);
        }
    }
}

/// Forces beyond the body's own elasticity: contact, loads, springs.
pub trait ForceLaw {
    /// Adds its generalised forces at `state` to `force`.
    fn add_force(&mut self, state: State<'_>, force: &mut [f64]);

    /// Adds `position_factor * K + velocity_factor * C` of its forces to `matrix`.
    fn add_tangent(
        &mut self,
        state: State<'_>,
        position_factor: f64,
        velocity_factor: f64,
        matrix: &mut BorderedMatrix,
    );

    /// Called once for every accepted step: laws with memory take the new state in. Until then they
    /// answer from the last accepted one, so that a step may be tried again.
    fn accept(&mut self, state: State<'_>) {
        let _ = state;
    }
}

/// No further forces.
impl ForceLaw for () {
    fn add_force(&mut self, _: State<'_>, _: &mut [f64]) {}
    fn add_tangent(&mut self, _: State<'_>, _: f64, _: f64, _: &mut BorderedMatrix) {}
}

/// A coordinate of a rigid body whose mass matrix is diagonal: the angle of a rotor, a position.
#[derive(Debug)]
pub struct RigidCoordinate {
    /// Mass [kg] or moment of inertia [kg m²].
    pub inertia: f64,
    /// Scale [m per unit] in convergence norms: 1 for a position, a radius for an angle.
    pub scale: f64,
    /// Prescribed motion, if any.
    pub motion: Option<Box<dyn Motion>>,
}

/// A flexible body with rigid coordinates and a law of forces.
#[derive(Debug)]
pub struct System<E, L> {
    mesh: Mesh<E>,
    /// The law of forces.
    pub law: L,
    structure: Structure,
    mass: BorderedMatrix,
    mass_panels: SectionPanels,
    constant_force: Vec<f64>,
    prescribed: Vec<(usize, Box<dyn Motion>)>,
    scales: Vec<f64>,
    constraints: Option<ConstraintSet>,
}

impl<E: Element, L: ForceLaw> System<E, L> {
    /// Joins `mesh`, whose coordinates have the given `scales`, the rigid coordinates and `law`.
    #[must_use]
    pub fn new(mesh: Mesh<E>, mut scales: Vec<f64>, rigid: Vec<RigidCoordinate>, law: L) -> Self {
        let structure = Structure {
            sections: mesh.sections(),
            block: mesh.section_dof(),
            closed: mesh.is_closed(),
            border: rigid.len(),
        };
        let mut mass = BorderedMatrix::new(structure);
        mesh.add_mass(&mut mass);
        let mut prescribed = Vec::new();
        for (k, coordinate) in rigid.into_iter().enumerate() {
            mass.add_corner(k, k, coordinate.inertia);
            scales.push(coordinate.scale);
            if let Some(motion) = coordinate.motion {
                prescribed.push((structure.chain() + k, motion));
            }
        }
        Self {
            mesh,
            law,
            structure,
            mass_panels: SectionPanels::new(&mass),
            mass,
            constant_force: vec![0.0; structure.size()],
            prescribed,
            scales,
            constraints: None,
        }
    }

    /// The same system under constraints, whose multipliers follow the rigid coordinates.
    #[must_use]
    pub fn constrained(mut self, constraints: ConstraintSet) -> Self {
        self.structure.border += constraints.multipliers();
        let mut mass = BorderedMatrix::new(self.structure);
        for (row, column, value) in self.mass.triplets().filter(|(_, _, value)| *value != 0.0) {
            mass.add(row, column, value);
        }
        self.mass_panels = SectionPanels::new(&mass);
        self.mass = mass;
        self.constant_force.resize(self.structure.size(), 0.0);
        self.scales.resize(self.structure.size(), 0.0);
        self.constraints = Some(constraints);
        self
    }

    /// Adds gravity: a uniform acceleration field [m/s²] on the flexible body.
    pub fn add_gravity(&mut self, gravity: &[f64]) {
        let mut field = vec![0.0; self.structure.size()];
        for node in field[..self.structure.chain()].chunks_exact_mut(E::NODE_DOF) {
            node[..E::DIMENSION].copy_from_slice(&gravity[..E::DIMENSION]);
        }
        let mut force = vec![0.0; field.len()];
        self.mass.multiply(&field, &mut force);
        for (sum, value) in self.constant_force.iter_mut().zip(force) {
            *sum += value;
        }
    }

    /// Lets the coordinate `index`, of the body too, follow `motion`.
    #[must_use]
    pub fn following(mut self, index: usize, motion: Box<dyn Motion>) -> Self {
        self.prescribed.push((index, motion));
        self
    }

    /// The flexible body.
    pub fn mesh(&self) -> &Mesh<E> {
        &self.mesh
    }

    /// Kinetic energy [J].
    pub fn kinetic_energy(&self, v: &[f64]) -> f64 {
        0.5 * self.mass_panels.quadratic(v)
    }

    /// Strain energy [J] of the flexible body.
    pub fn strain_energy(&self, q: &[f64]) -> f64 {
        self.mesh.energy(q)
    }

    /// Potential energy [J] of constant forces (gravity), zero where `q` is zero.
    pub fn constant_potential(&self, q: &[f64]) -> f64 {
        -self
            .constant_force
            .iter()
            .zip(q)
            .map(|(f, x)| f * x)
            .sum::<f64>()
    }
}

impl<E: Element, L: ForceLaw> Mechanics for System<E, L> {
    fn structure(&self) -> Structure {
        self.structure
    }

    fn mass(&self) -> &BorderedMatrix {
        &self.mass
    }

    fn force(&mut self, state: State<'_>, force: &mut [f64]) {
        force.copy_from_slice(&self.constant_force);
        self.mesh.add_force(state.q, state.v, force);
        self.law.add_force(state, force);
    }

    fn add_tangent(
        &mut self,
        state: State<'_>,
        position_factor: f64,
        velocity_factor: f64,
        matrix: &mut BorderedMatrix,
    ) {
        self.mesh
            .add_tangent(state.q, state.v, position_factor, velocity_factor, matrix);
        self.law
            .add_tangent(state, position_factor, velocity_factor, matrix);
    }

    fn accept(&mut self, state: State<'_>) {
        self.law.accept(state);
    }

    fn prescribed(&self) -> &[(usize, Box<dyn Motion>)] {
        &self.prescribed
    }

    fn scales(&self) -> &[f64] {
        &self.scales
    }

    fn dimension(&self) -> usize {
        E::DIMENSION
    }

    fn constraints(&self) -> Option<&ConstraintSet> {
        self.constraints.as_ref()
    }
}
