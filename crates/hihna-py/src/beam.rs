//! Planar structures of one chain of beams: supports, loads, bodies, statics, modes, motion.

use std::sync::Arc;

use ancf::constraint::{ConstraintForm, SpinUp};
use ancf::dynamics::Motion;
use ancf::element::{BeltBeam2, CubicBeam2, Element, LineElement, LinearBeam2};
use ancf::loads::Loads;
use ancf::material::Isotropic;
use ancf::section::PlanarSection;
use ancf::statics::{Equilibrium, LoadSteps};
use ancf::structure::{
    Coordinate, Mode, NodeVector, PlanarStructure, RigidBody, StructureError as LibraryError,
};
use ancf::system::System;
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::structure::{
    Course, Numbers, Steps, Structure, drawn_coordinates, equilibrium, inner_forces,
    linear_displacements, modes, motion, wrong,
};
use crate::user_motion::{Raised, UserMotion};

/// Structures by the kind of their elements.
enum AnyStructure {
    Belt(PlanarStructure<BeltBeam2>),
    Cubic(PlanarStructure<CubicBeam2>),
    Linear(PlanarStructure<LinearBeam2>),
}

/// Does the same with whichever structure it is.
macro_rules! each {
    ($any:expr, $structure:ident => $call:expr) => {
        match $any {
            AnyStructure::Belt($structure) => $call,
            AnyStructure::Cubic($structure) => $call,
            AnyStructure::Linear($structure) => $call,
        }
    };
}

/// A chain of beams with its supports and loads.
#[pyclass(module = "hihna._native")]
pub struct NativeBeam {
    structure: AnyStructure,
    raised: Raised,
}

/// `(area, second moment, fourth moment)` and `(E, nu, rho)`.
type Triple = (f64, f64, f64);

#[pymethods]
impl NativeBeam {
    /// A chain of `kind`, straight from `start` in the direction `angle`, or with the nodal coordinates `nodes`: cubic
    /// beams are undeformed there, the others drawn so.
    #[new]
    #[pyo3(signature = (kind, length, elements, section, material, start, angle, factors, nodes=None))]
    #[expect(
        clippy::too_many_arguments,
        reason = "the Python side gathers them in objects"
    )]
    fn new(
        kind: &str,
        length: f64,
        elements: usize,
        section: Triple,
        material: Triple,
        start: [f64; 2],
        angle: f64,
        factors: Triple,
        nodes: Option<Numbers<'_>>,
    ) -> PyResult<Self> {
        if elements == 0 {
            return Err(wrong(&"a beam has at least one element"));
        }
        let section = PlanarSection {
            area: section.0,
            second_moment: section.1,
            fourth_moment: section.2,
        };
        let material = Isotropic {
            youngs_modulus: material.0,
            poisson_ratio: material.1,
            density: material.2,
        };
        let part = length / elements as f64;
        let line = Line {
            elements,
            start,
            angle,
            nodes,
        };
        let structure = match kind {
            "belt-beam" => {
                let (axial, bending, damping) = factors;
                let element = BeltBeam2::new(part, &section, &material, axial, bending, damping);
                AnyStructure::Belt(line.of(element)?)
            }
            "cubic-beam" => AnyStructure::Cubic(match &line.nodes {
                None => line.of(CubicBeam2::new(part, &section, &material))?,
                Some(nodes) => curved(nodes, part, elements, &section, &material)?,
            }),
            "linear-beam" => {
                AnyStructure::Linear(line.of(LinearBeam2::new(part, &section, &material))?)
            }
            other => {
                return Err(PyValueError::new_err(format!(
                    "there is no element `{other}`: the elements are belt-beam, cubic-beam and linear-beam"
                )));
            }
        };
        Ok(Self {
            structure,
            raised: Raised::default(),
        })
    }

    fn pin(&mut self, node: usize) {
        each!(&mut self.structure, s => { s.pin(node); });
    }

    fn clamp(&mut self, node: usize) {
        each!(&mut self.structure, s => { s.clamp(node); });
    }

    fn roller(&mut self, node: usize, normal: [f64; 2]) {
        each!(&mut self.structure, s => { s.roller(node, normal); });
    }

    fn join_ends(&mut self) {
        each!(&mut self.structure, s => { s.join_ends(); });
    }

    fn body(
        &mut self,
        name: String,
        mass: f64,
        inertia: f64,
        place: [f64; 2],
        angle: f64,
    ) -> usize {
        let body = RigidBody {
            name,
            mass,
            inertia,
            place,
            angle,
        };
        each!(&mut self.structure, s => s.body(body))
    }

    fn hinge(&mut self, node: usize, body: usize) {
        each!(&mut self.structure, s => { s.hinge(node, body); });
    }

    fn fasten(&mut self, node: usize, body: usize) {
        each!(&mut self.structure, s => { s.fasten(node, body); });
    }

    fn force(&mut self, node: usize, force: [f64; 2]) {
        each!(&mut self.structure, s => { s.force(node, force); });
    }

    fn moment(&mut self, node: usize, moment: f64) {
        each!(&mut self.structure, s => { s.moment(node, moment); });
    }

    fn body_load(&mut self, body: usize, force: [f64; 2], moment: f64) {
        each!(&mut self.structure, s => { s.body_load(body, force, moment); });
    }

    fn gravity(&mut self, field: [f64; 2]) {
        each!(&mut self.structure, s => { s.gravity(field); });
    }

    fn line_load(&mut self, load: [f64; 2]) {
        each!(&mut self.structure, s => { s.line_load(load); });
    }

    fn rotating_frame(&mut self, speed: f64) {
        each!(&mut self.structure, s => { s.rotating_frame(speed); });
    }

    fn eliminate(&mut self, eliminate: bool) {
        let form = if eliminate {
            ConstraintForm::Elimination
        } else {
            ConstraintForm::Multipliers
        };
        each!(&mut self.structure, s => { s.constraint_form(form); });
    }

    /// Turns a node by a function of time.
    fn turn(&mut self, node: usize, function: Py<PyAny>) {
        let motion = Arc::new(UserMotion {
            function,
            raised: Arc::clone(&self.raised),
        });
        each!(&mut self.structure, s => { s.turn(node, motion); });
    }

    /// Turns a node by a smooth spin-up.
    fn spin_up(&mut self, node: usize, speed: f64, rise_time: f64) {
        let motion = Arc::new(SpinUp { speed, rise_time });
        each!(&mut self.structure, s => { s.turn(node, motion); });
    }

    /// Moves a component of a vector of a node by a function of time.
    fn prescribe(
        &mut self,
        node: usize,
        vector: &str,
        axis: usize,
        function: Py<PyAny>,
    ) -> PyResult<()> {
        let vector = match vector {
            "position" => NodeVector::Position,
            "along" => NodeVector::Along,
            "across" => NodeVector::Across,
            other => {
                return Err(PyValueError::new_err(format!(
                    "there is no vector `{other}`: they are position, along and across"
                )));
            }
        };
        if axis > 1 {
            return Err(wrong(&"the axes are 0 for x and 1 for y"));
        }
        self.follow(Coordinate::Node { node, vector, axis }, function);
        Ok(())
    }

    /// Moves a coordinate of a body by a function of time: 0 x, 1 y, 2 its angle.
    fn prescribe_body(&mut self, body: usize, index: usize, function: Py<PyAny>) -> PyResult<()> {
        if index > 2 {
            return Err(wrong(
                &"the coordinates of a body are 0 for x, 1 for y and 2 for its angle",
            ));
        }
        self.follow(Coordinate::Body { body, index }, function);
        Ok(())
    }

    /// The drawn coordinates: nodes that are nodes of their own, then bodies.
    fn drawn<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, each!(&self.structure, s => s.drawn()))
    }

    fn equilibrium<'py>(&mut self, py: Python<'py>, steps: Steps) -> PyResult<Bound<'py, PyDict>> {
        each!(&mut self.structure, s => equilibrium(py, s, steps, &self.raised))
    }

    fn linear_displacements<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        each!(&self.structure, s => linear_displacements(py, s, &self.raised))
    }

    #[expect(
        clippy::needless_pass_by_value,
        reason = "Python's arguments are owned"
    )]
    fn axial_forces<'py>(
        &self,
        py: Python<'py>,
        coordinates: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        each!(&self.structure, s => inner_forces(py, s, &coordinates))
    }

    fn modes<'py>(
        &self,
        py: Python<'py>,
        about: Option<(Numbers<'py>, Numbers<'py>)>,
    ) -> PyResult<Bound<'py, PyDict>> {
        each!(&self.structure, s => modes(py, s, about, &self.raised))
    }

    #[expect(
        clippy::needless_pass_by_value,
        reason = "Python's arguments are owned"
    )]
    fn integrate<'py>(&self, py: Python<'py>, course: Course<'py>) -> PyResult<Bound<'py, PyDict>> {
        each!(&self.structure, s => motion(py, s, &course, &self.raised))
    }
}

impl NativeBeam {
    fn follow(&mut self, coordinate: Coordinate, function: Py<PyAny>) {
        let motion = Arc::new(UserMotion {
            function,
            raised: Arc::clone(&self.raised),
        });
        each!(&mut self.structure, s => { s.prescribe(coordinate, motion); });
    }
}

/// How a chain is drawn.
struct Line<'py> {
    elements: usize,
    start: [f64; 2],
    angle: f64,
    nodes: Option<Numbers<'py>>,
}

impl Line<'_> {
    fn of<E: LineElement>(&self, element: E) -> PyResult<PlanarStructure<E>> {
        let count = self.elements;
        let Some(nodes) = &self.nodes else {
            return Ok(PlanarStructure::straight(
                element, count, self.start, self.angle,
            ));
        };
        let nodes = drawn_coordinates(nodes, (count + 1) * E::NODE_DOF)?;
        Ok(PlanarStructure::with_nodes(vec![element; count], nodes))
    }
}

/// Cubic beams that are undeformed with these nodal coordinates.
fn curved(
    nodes: &Numbers<'_>,
    part: f64,
    count: usize,
    section: &PlanarSection,
    material: &Isotropic,
) -> PyResult<PlanarStructure<CubicBeam2>> {
    const NODE: usize = CubicBeam2::NODE_DOF;
    let nodes = drawn_coordinates(nodes, (count + 1) * NODE)?;
    let elements = nodes.windows(2 * NODE).step_by(NODE).map(|reference| {
        let mut own = [0.0; 2 * NODE];
        own.copy_from_slice(reference);
        CubicBeam2::curved(&own, part, section, material).map_err(|error| wrong(&error))
    });
    let elements = elements.collect::<PyResult<_>>()?;
    Ok(PlanarStructure::with_nodes(elements, nodes))
}

impl<E: LineElement> Structure for PlanarStructure<E> {
    type Element = E;
    type Law = Loads;

    fn size(&self) -> f64 {
        self.length()
    }

    fn drawn(&self) -> Vec<f64> {
        self.drawn()
    }

    fn system(&self) -> Result<System<E, Loads>, LibraryError> {
        self.build()
    }

    fn start(
        &self,
        system: &System<E, Loads>,
        q: &[f64],
        v: &[f64],
    ) -> Result<Motion, LibraryError> {
        self.start(system, q, v)
    }

    fn at_rest(&self, system: &System<E, Loads>) -> Motion {
        self.at_rest(system)
    }

    fn apply_in_steps(&mut self, steps: LoadSteps) {
        self.load_steps(steps);
    }

    fn settled(&self) -> Result<Equilibrium, LibraryError> {
        self.equilibrium()
    }

    fn linear(&self) -> Result<Vec<f64>, LibraryError> {
        self.linear_displacements()
    }

    fn natural(&self, about: &Equilibrium) -> Result<Vec<Mode>, LibraryError> {
        self.modes(about)
    }

    fn energy(system: &System<E, Loads>, q: &[f64], v: &[f64]) -> f64 {
        system.energy(q, v)
    }

    fn inner_forces(element: &E, e: &[f64]) -> Vec<f64> {
        vec![element.axial_force(e, 0.5)]
    }
}
