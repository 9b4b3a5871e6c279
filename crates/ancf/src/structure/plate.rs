//! A rectangular plate: mesh, supports of its edges, loads, and an answer.
//!
//! ```
//! use ancf::element::{BendingRigidity, ThinPlate};
//! use ancf::material::Isotropic;
//! use ancf::structure::{Edge, PlateStructure};
//!
//! # fn main() -> Result<(), ancf::structure::StructureError> {
//! let steel = Isotropic { youngs_modulus: 2e11, poisson_ratio: 0.3, density: 7800.0 };
//! let element = ThinPlate::new(0.125, 0.125, 0.01, &steel, BendingRigidity::Kirchhoff);
//! let mut plate = PlateStructure::rectangle(element, 8, 8);
//! plate.clamp(Edge::ALL).pressure(1000.0);
//! let bent = plate.equilibrium()?;
//! let [_, _, z] = plate.position(&bent.q, [4, 4]);
//! assert!((z - 7.12e-5).abs() < 0.01e-5); // 0.001304 p a⁴/D; 0.001265 of them with ever smaller elements
//! # Ok(())
//! # }
//! ```
//!
//! The plate is drawn in the plane of x and y from the origin; node `[i, j]` is the i-th along x, the j-th along y.

use faer::{Mat, Side};

use super::modes::natural_modes;
use super::{Mode, NodeVector, StructureError, start};
use crate::constraint::Constant;
use crate::dynamics::Motion;
use crate::element::{Element, SurfaceElement, ThinPlate};
use crate::loads::SurfaceLoads;
use crate::mesh::Mesh;
use crate::statics::{Equilibrium, LoadStepError, LoadSteps, Loaded, equilibrium, linear_response};
use crate::system::{Mechanics, System};

/// Correction at which statics ends, relative to the length of the plate; the error left is its square.
const TOLERANCE: f64 = 1.0e-9;
/// Iterations of a load step.
const MAX_ITERATIONS: usize = 40;
/// Halvings of a load step.
const HALVINGS: u32 = 12;

/// Squares of a held motion below this are what rounding left of zero.
const VANISHED: f64 = 1.0e-12;
/// The rigid motions of a plate, about its middle.
const MOTIONS: [&str; 6] = [
    "move along x",
    "move along y",
    "move along z",
    "turn about x",
    "turn about y",
    "turn about z",
];

/// An edge of a plate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// x = 0.
    Start,
    /// x at its largest.
    End,
    /// y = 0.
    Right,
    /// y at its largest.
    Left,
}

impl Edge {
    /// All four.
    pub const ALL: [Self; 4] = [Self::Start, Self::End, Self::Right, Self::Left];

    /// The slope along the edge.
    fn tangent(self) -> NodeVector {
        match self {
            Self::Start | Self::End => NodeVector::Across,
            Self::Right | Self::Left => NodeVector::Along,
        }
    }

    /// The slope that leads away from the edge, and the axis it lies along.
    fn inward(self) -> (NodeVector, usize) {
        match self {
            Self::Start | Self::End => (NodeVector::Along, 0),
            Self::Right | Self::Left => (NodeVector::Across, 1),
        }
    }
}

/// A rectangular plate of equal elements, its supports and loads.
#[derive(Clone, Debug)]
pub struct PlateStructure {
    element: ThinPlate,
    along: usize,
    across: usize,
    drawn: Vec<f64>,
    held: Vec<bool>,
    forces: Vec<(usize, f64)>,
    pressure: f64,
    end_moment: f64,
    gravity: [f64; 3],
    load_steps: Option<LoadSteps>,
    /// The first node asked for that does not exist.
    missing: Option<[usize; 2]>,
}

impl Loaded for System<ThinPlate, SurfaceLoads> {
    fn set_load_factor(&mut self, factor: f64) {
        self.law.factor = factor;
    }
}

impl System<ThinPlate, SurfaceLoads> {
    /// Kinetic and strain energy and the potential of dead forces [J] together; pressure and moments, which follow the
    /// surface, are left out.
    pub fn energy(&self, q: &[f64], v: &[f64]) -> f64 {
        let dead: f64 = (self.law.dead.iter().zip(q)).map(|(f, x)| -f * x).sum();
        self.kinetic_energy(v) + self.strain_energy(q) + self.law.factor * dead
    }
}

impl PlateStructure {
    /// A plate of `along` x `across` (at least 1 x 1) elements like `element`.
    #[must_use]
    pub fn rectangle(element: ThinPlate, along: usize, across: usize) -> Self {
        let (along, across) = (along.max(1), across.max(1));
        let mut drawn = Vec::with_capacity((along + 1) * (across + 1) * ThinPlate::NODE_DOF);
        for i in 0..=along {
            for j in 0..=across {
                let (x, y) = (element.length() * i as f64, element.width() * j as f64);
                drawn.extend([x, y, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
            }
        }
        Self {
            element,
            along,
            across,
            held: vec![false; drawn.len()],
            drawn,
            forces: Vec::new(),
            pressure: 0.0,
            end_moment: 0.0,
            gravity: [0.0; 3],
            load_steps: None,
            missing: None,
        }
    }

    /// The last node `[i, j]`; the first is `[0, 0]`.
    pub fn last(&self) -> [usize; 2] {
        [self.along, self.across]
    }

    /// All nodes, row by row across.
    pub fn nodes(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let row = self.across + 1;
        (0..(self.along + 1) * row).map(move |k| [k / row, k % row])
    }

    /// Nodes of an edge.
    pub fn edge(&self, edge: Edge) -> impl Iterator<Item = [usize; 2]> + use<> {
        let [along, across] = self.last();
        self.nodes().filter(move |[i, j]| match edge {
            Edge::Start => *i == 0,
            Edge::End => *i == along,
            Edge::Right => *j == 0,
            Edge::Left => *j == across,
        })
    }

    /// Holds a component (0: x, 1: y, 2: z) of a vector of a node as drawn.
    pub fn hold(&mut self, node: [usize; 2], vector: NodeVector, axis: usize) -> &mut Self {
        if let Some(index) = self.index(node, vector, axis) {
            self.held[index] = true;
        } else {
            self.missing.get_or_insert(node);
        }
        self
    }

    /// Clamps edges: neither places nor the direction of the surface change there. The plate may stretch away
    /// from the edge.
    pub fn clamp(&mut self, edges: impl IntoIterator<Item = Edge>) -> &mut Self {
        for edge in edges {
            let (inward, stretch) = edge.inward();
            for node in self.edge(edge) {
                for axis in 0..3 {
                    self.hold(node, NodeVector::Position, axis);
                    self.hold(node, edge.tangent(), axis);
                    if axis != stretch {
                        self.hold(node, inward, axis);
                    }
                }
            }
        }
        self
    }

    /// Supports edges from below and above: they do not leave the plane of the plate, but turn and slide in it.
    pub fn support(&mut self, edges: impl IntoIterator<Item = Edge>) -> &mut Self {
        for edge in edges {
            for node in self.edge(edge) {
                self.hold(node, NodeVector::Position, 2);
                self.hold(node, edge.tangent(), 2);
            }
        }
        self
    }

    /// Holds everything in the plane of the plate: what is left is the linear theory of bending.
    pub fn bending_only(&mut self) -> &mut Self {
        for node in self.nodes() {
            for vector in VECTORS {
                self.hold(node, vector, 0).hold(node, vector, 1);
            }
        }
        self
    }

    /// Adds a dead force [N] on a node.
    pub fn force(&mut self, node: [usize; 2], force: [f64; 3]) -> &mut Self {
        for (axis, value) in force.into_iter().enumerate() {
            self.slope_force(node, NodeVector::Position, axis, value);
        }
        self
    }

    /// Adds a dead generalised force on a component of a vector of a node: [N] on a place, [N m] on a slope.
    pub fn slope_force(
        &mut self,
        node: [usize; 2],
        vector: NodeVector,
        axis: usize,
        force: f64,
    ) -> &mut Self {
        if let Some(index) = self.index(node, vector, axis) {
            self.forces.push((index, force));
        } else {
            self.missing.get_or_insert(node);
        }
        self
    }

    /// Adds a pressure [N/m²] that follows the surface, along `r_x x r_y` (z as drawn).
    pub fn pressure(&mut self, pressure: f64) -> &mut Self {
        self.pressure += pressure;
        self
    }

    /// Adds a moment per width [N m/m] on [`Edge::End`] that turns it from x towards z.
    pub fn end_moment(&mut self, moment: f64) -> &mut Self {
        self.end_moment += moment;
        self
    }

    /// Adds a uniform acceleration field [m/s²].
    pub fn gravity(&mut self, field: [f64; 3]) -> &mut Self {
        self.gravity = std::array::from_fn(|axis| self.gravity[axis] + field[axis]);
        self
    }

    /// Chooses how statics applies the loads; the default is one step to 1e-9 of the length.
    pub fn load_steps(&mut self, options: LoadSteps) -> &mut Self {
        self.load_steps = Some(options);
        self
    }

    /// Place [m] of a node in the coordinates `q`; not a number for a node that does not exist.
    pub fn position(&self, q: &[f64], node: [usize; 2]) -> [f64; 3] {
        self.vector(q, node, NodeVector::Position)
    }

    /// A vector of a node in the coordinates `q`; not a number for one that does not exist.
    pub fn vector(&self, q: &[f64], node: [usize; 2], vector: NodeVector) -> [f64; 3] {
        std::array::from_fn(|axis| {
            let index = self.index(node, vector, axis);
            index.and_then(|i| q.get(i)).copied().unwrap_or(f64::NAN)
        })
    }

    /// Index of a coordinate in `q`, if there is such a node and axis.
    pub fn index(&self, [i, j]: [usize; 2], vector: NodeVector, axis: usize) -> Option<usize> {
        let exists = i <= self.along && j <= self.across && axis < 3;
        let vector = match vector {
            NodeVector::Position => 0,
            NodeVector::Along => 1,
            NodeVector::Across => 2,
        };
        let node = i * (self.across + 1) + j;
        exists.then_some(node * ThinPlate::NODE_DOF + 3 * vector + axis)
    }

    /// The drawn coordinates.
    pub fn drawn(&self) -> &[f64] {
        &self.drawn
    }

    /// The mechanical system, under the whole load.
    pub fn build(&self) -> Result<System<ThinPlate, SurfaceLoads>, StructureError> {
        self.check()?;
        let elements = vec![self.element.clone(); self.along * self.across];
        let mesh = Mesh::open_strip(elements, self.across);
        let mut loads = SurfaceLoads::new(&mesh, self.across);
        for (index, force) in &self.forces {
            loads.dead[*index] += force;
        }
        loads.pressure = self.pressure;
        loads.end_moment = self.end_moment;
        let scales = mesh.scales(self.element.length(), 0.25 * self.element.width());
        let mut system = System::new(mesh, scales, Vec::new(), loads);
        let mut field = vec![0.0; self.drawn.len()];
        for node in field.chunks_exact_mut(ThinPlate::NODE_DOF) {
            node[..3].copy_from_slice(&self.gravity);
        }
        let mut weight = vec![0.0; field.len()];
        system.mass().multiply(&field, &mut weight);
        for (sum, value) in system.law.dead.iter_mut().zip(&weight) {
            *sum += value;
        }
        for (index, _) in self.held.iter().enumerate().filter(|(_, held)| **held) {
            system = system.following(index, Box::new(Constant(self.drawn[index])));
        }
        Ok(system)
    }

    /// The start of a motion with the given coordinates and velocities; held ones must be as drawn and at rest.
    pub fn start(
        &self,
        system: &System<ThinPlate, SurfaceLoads>,
        q: &[f64],
        v: &[f64],
    ) -> Result<Motion, StructureError> {
        start::consistent(system, self.drawn.len(), q, v)
    }

    /// The static equilibrium under all loads.
    pub fn equilibrium(&self) -> Result<Equilibrium, StructureError> {
        let mut system = self.build()?;
        let options = self.load_steps.unwrap_or(LoadSteps {
            steps: 1,
            halvings: HALVINGS,
            tolerance: TOLERANCE * self.element.length() * self.along as f64,
            max_iterations: MAX_ITERATIONS,
        });
        equilibrium(&mut system, 0.0, &self.drawn, &options).map_err(|error| self.explain(error))
    }

    /// The displacements of linear theory, coordinate by coordinate: one step from the drawn shape.
    pub fn linear_displacements(&self) -> Result<Vec<f64>, StructureError> {
        let mut system = self.build()?;
        linear_response(&mut system, 0.0, &self.drawn).map_err(|error| self.explain(error))
    }

    /// All modes about an equilibrium, by rising frequency.
    pub fn modes(&self, equilibrium: &Equilibrium) -> Result<Vec<Mode>, StructureError> {
        natural_modes(&mut self.build()?, equilibrium, false)
    }

    /// A failure of statics, as free motions where there are some.
    fn explain(&self, error: LoadStepError) -> StructureError {
        let motions = self.free_motions();
        if motions.is_empty() {
            StructureError::LoadStep(error)
        } else {
            StructureError::FreePlate { motions }
        }
    }

    /// Rigid motions about the middle of the plate that the supports leave free.
    fn free_motions(&self) -> Vec<&'static str> {
        let size = [
            self.element.length() * self.along as f64,
            self.element.width() * self.across as f64,
        ];
        let radius = size[0].hypot(size[1]);
        // Rows of held coordinates by the six motions, angles times the size of the plate.
        let mut gram = Mat::<f64>::zeros(6, 6);
        for (k, vector) in self.drawn.chunks_exact(3).enumerate() {
            let is_place = k % 3 == 0;
            let arm: [f64; 3] = std::array::from_fn(|axis| {
                let middle = if is_place && axis < 2 {
                    0.5 * size[axis]
                } else {
                    0.0
                };
                let unit = if is_place { radius } else { 1.0 };
                (vector[axis] - middle) / unit
            });
            for axis in (0..3).filter(|axis| self.held[3 * k + axis]) {
                let mut row = [0.0; 6];
                row[axis] = if is_place { 1.0 } else { 0.0 };
                let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
                // (w x a)_axis = w_next a_last - w_last a_next
                row[3 + next] = arm[last];
                row[3 + last] = -arm[next];
                for i in 0..6 {
                    for j in 0..6 {
                        gram[(i, j)] += row[i] * row[j];
                    }
                }
            }
        }
        let Ok(eigen) = gram.self_adjoint_eigen(Side::Lower) else {
            return Vec::new();
        };
        let free: Vec<usize> = (0..6).filter(|k| eigen.S()[*k] < VANISHED).collect();
        (MOTIONS.into_iter().enumerate())
            .filter(|(i, _)| free.iter().any(|k| eigen.U()[(*i, *k)].abs() > 0.1))
            .map(|(_, name)| name)
            .collect()
    }

    fn check(&self) -> Result<(), StructureError> {
        if let Some(node) = self.missing {
            return Err(StructureError::NoPlateNode {
                node,
                last: self.last(),
            });
        }
        let sizes = [
            ("the length of an element [m]", self.element.length()),
            ("the width of an element [m]", self.element.width()),
            (
                "Young's modulus times the volume of an element [N m]",
                self.element.energy_scale(),
            ),
        ];
        for (what, value) in sizes {
            if !(value > 0.0 && value.is_finite()) {
                return Err(StructureError::Value {
                    what: what.to_owned(),
                    value,
                    remedy: "positive and finite",
                });
            }
        }
        let loads = [self.pressure, self.end_moment].into_iter();
        let loads = loads.chain(self.gravity);
        for value in loads.chain(self.forces.iter().map(|(_, force)| *force)) {
            if !value.is_finite() {
                return Err(StructureError::Value {
                    what: "a load".to_owned(),
                    value,
                    remedy: "finite",
                });
            }
        }
        Ok(())
    }
}

const VECTORS: [NodeVector; 3] = [NodeVector::Position, NodeVector::Along, NodeVector::Across];
