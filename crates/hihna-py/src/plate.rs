//! Rectangular plates: supports of their edges, loads, statics, modes.

use ancf::dynamics::Motion;
use ancf::element::{BendingRigidity, SurfaceElement, ThinPlate};
use ancf::loads::SurfaceLoads;
use ancf::material::Isotropic;
use ancf::statics::{Equilibrium, LoadSteps};
use ancf::structure::{Edge, Mode, NodeVector, PlateStructure, StructureError as LibraryError};
use ancf::system::System;
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::structure::{
    Course, Numbers, Steps, Structure, equilibrium, inner_forces, linear_displacements, modes,
    motion, wrong,
};
use crate::user_motion::Raised;

/// A plate with its supports and loads.
#[pyclass(module = "hihna._native")]
pub struct NativePlate {
    structure: PlateStructure,
}

fn edges(names: &[String]) -> PyResult<Vec<Edge>> {
    let edge = |name: &String| match name.as_str() {
        "start" => Ok(Edge::Start),
        "end" => Ok(Edge::End),
        "right" => Ok(Edge::Right),
        "left" => Ok(Edge::Left),
        other => Err(PyValueError::new_err(format!(
            "there is no edge `{other}`: the edges are start, end, right and left"
        ))),
    };
    names.iter().map(edge).collect()
}

#[pymethods]
impl NativePlate {
    /// `size` is length, width and thickness [m]; `material` is `(E, nu, rho)`.
    #[new]
    fn new(
        size: [f64; 3],
        elements: [usize; 2],
        material: [f64; 3],
        bending: &str,
    ) -> PyResult<Self> {
        let [length, width, thickness] = size;
        if !size.iter().all(|side| *side > 0.0 && side.is_finite()) {
            return Err(wrong(&"length, width and thickness must be positive"));
        }
        if elements.contains(&0) {
            return Err(wrong(&"a plate has at least one element each way"));
        }
        let [youngs_modulus, poisson_ratio, density] = material;
        let material = Isotropic {
            youngs_modulus,
            poisson_ratio,
            density,
        };
        let rigidity = match bending {
            "standard" => BendingRigidity::Kirchhoff,
            "printed" => BendingRigidity::Printed,
            "none" => BendingRigidity::None,
            other => {
                return Err(PyValueError::new_err(format!(
                    "there is no bending `{other}`: it is standard, printed or none"
                )));
            }
        };
        let [along, across] = elements;
        let element = ThinPlate::new(
            length / along as f64,
            width / across as f64,
            thickness,
            &material,
            rigidity,
        );
        Ok(Self {
            structure: PlateStructure::rectangle(element, along, across),
        })
    }

    #[expect(
        clippy::needless_pass_by_value,
        reason = "Python's arguments are owned"
    )]
    fn clamp(&mut self, names: Vec<String>) -> PyResult<()> {
        self.structure.clamp(edges(&names)?);
        Ok(())
    }

    #[expect(
        clippy::needless_pass_by_value,
        reason = "Python's arguments are owned"
    )]
    fn support(&mut self, names: Vec<String>) -> PyResult<()> {
        self.structure.support(edges(&names)?);
        Ok(())
    }

    fn bending_only(&mut self) {
        self.structure.bending_only();
    }

    /// Holds a component of a vector of a node as drawn.
    fn hold(&mut self, node: [usize; 2], vector: &str, axis: usize) -> PyResult<()> {
        self.structure.hold(node, vector_of(vector)?, axis);
        Ok(())
    }

    /// Adds a dead generalised force on a vector of a node.
    fn force(&mut self, node: [usize; 2], vector: &str, force: [f64; 3]) -> PyResult<()> {
        let vector = vector_of(vector)?;
        for (axis, value) in force.into_iter().enumerate() {
            self.structure.slope_force(node, vector, axis, value);
        }
        Ok(())
    }

    fn pressure(&mut self, pressure: f64) {
        self.structure.pressure(pressure);
    }

    fn end_moment(&mut self, moment: f64) {
        self.structure.end_moment(moment);
    }

    fn gravity(&mut self, field: [f64; 3]) {
        self.structure.gravity(field);
    }

    /// The drawn coordinates.
    fn drawn<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.structure.drawn().to_vec())
    }

    fn equilibrium<'py>(&mut self, py: Python<'py>, steps: Steps) -> PyResult<Bound<'py, PyDict>> {
        equilibrium(py, &mut self.structure, steps, &Raised::default())
    }

    fn linear_displacements<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        linear_displacements(py, &self.structure, &Raised::default())
    }

    #[expect(
        clippy::needless_pass_by_value,
        reason = "Python's arguments are owned"
    )]
    fn membrane_forces<'py>(
        &self,
        py: Python<'py>,
        coordinates: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        inner_forces(py, &self.structure, &coordinates)
    }

    fn modes<'py>(
        &self,
        py: Python<'py>,
        about: Option<(Numbers<'py>, Numbers<'py>)>,
    ) -> PyResult<Bound<'py, PyDict>> {
        modes(py, &self.structure, about, &Raised::default())
    }

    #[expect(
        clippy::needless_pass_by_value,
        reason = "Python's arguments are owned"
    )]
    fn integrate<'py>(&self, py: Python<'py>, course: Course<'py>) -> PyResult<Bound<'py, PyDict>> {
        motion(py, &self.structure, &course, &Raised::default())
    }
}

fn vector_of(name: &str) -> PyResult<NodeVector> {
    match name {
        "position" => Ok(NodeVector::Position),
        "along" => Ok(NodeVector::Along),
        "across" => Ok(NodeVector::Across),
        other => Err(PyValueError::new_err(format!(
            "there is no vector `{other}`: they are position, along and across"
        ))),
    }
}

impl Structure for PlateStructure {
    type Element = ThinPlate;
    type Law = SurfaceLoads;

    fn size(&self) -> f64 {
        let [along, _] = self.last();
        self.position(self.drawn(), [along, 0])[0]
    }

    fn drawn(&self) -> Vec<f64> {
        self.drawn().to_vec()
    }

    fn system(&self) -> Result<System<ThinPlate, SurfaceLoads>, LibraryError> {
        self.build()
    }

    fn start(
        &self,
        system: &System<ThinPlate, SurfaceLoads>,
        q: &[f64],
        v: &[f64],
    ) -> Result<Motion, LibraryError> {
        self.start(system, q, v)
    }

    fn at_rest(&self, _: &System<ThinPlate, SurfaceLoads>) -> Motion {
        // Held coordinates are held where they are drawn.
        let mut motion = Motion::zero(self.drawn().len());
        motion.q.copy_from_slice(self.drawn());
        motion
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

    fn energy(system: &System<ThinPlate, SurfaceLoads>, q: &[f64], v: &[f64]) -> f64 {
        system.energy(q, v)
    }

    fn inner_forces(element: &ThinPlate, e: &[f64]) -> Vec<f64> {
        let gradient = element.surface_gradient(e, [0.5; 2]);
        element.membrane_forces(&gradient).to_vec()
    }
}
