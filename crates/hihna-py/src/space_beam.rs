//! Structures of one chain of beams in space: supports, loads, statics, modes, motion.

use std::sync::Arc;

use ancf::constraint::ConstraintForm;
use ancf::dynamics::Motion;
use ancf::element::{BeltBeam3, LineElement, LinearBeam3};
use ancf::loads::Loads;
use ancf::material::Isotropic;
use ancf::section::{SpatialSection, Trapezoid};
use ancf::statics::{Equilibrium, LoadSteps};
use ancf::structure::{Mode, NodeDirection, SpatialStructure, StructureError as LibraryError};
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
    Belt(SpatialStructure<BeltBeam3>),
    Linear(SpatialStructure<LinearBeam3>),
}

/// Does the same with whichever structure it is.
macro_rules! each {
    ($any:expr, $structure:ident => $call:expr) => {
        match $any {
            AnyStructure::Belt($structure) => $call,
            AnyStructure::Linear($structure) => $call,
        }
    };
}

/// A chain of spatial beams with its supports and loads.
#[pyclass(module = "hihna._native")]
pub struct NativeSpaceBeam {
    structure: AnyStructure,
    raised: Raised,
}

/// Area; second moments of y and z; fourth moments of y, z and mixed; torsion constant.
type Moments = [f64; 7];

fn section_of(moments: Moments) -> SpatialSection {
    let [
        area,
        second_moment_y,
        second_moment_z,
        fourth_moment_y,
        fourth_moment_z,
        mixed_fourth_moment,
        torsion_constant,
    ] = moments;
    SpatialSection {
        area,
        second_moment_y,
        second_moment_z,
        fourth_moment_y,
        fourth_moment_z,
        mixed_fourth_moment,
        torsion_constant,
    }
}

fn moments_of(section: &SpatialSection) -> Moments {
    [
        section.area,
        section.second_moment_y,
        section.second_moment_z,
        section.fourth_moment_y,
        section.fourth_moment_z,
        section.mixed_fourth_moment,
        section.torsion_constant,
    ]
}

/// Moments of a rectangle by its width and height [m].
#[pyfunction]
pub fn rectangle(width: f64, height: f64) -> Moments {
    moments_of(&SpatialSection::rectangle(width, height))
}

/// Moments of a circular tube by its outer and inner radius [m].
#[pyfunction]
pub fn tube(outer_radius: f64, inner_radius: f64) -> Moments {
    moments_of(&SpatialSection::tube(outer_radius, inner_radius))
}

/// Moments of a trapezoid by its width at the centroid, its height [m] and the angle between its flanks [rad].
#[pyfunction]
pub fn trapezoid(width: f64, height: f64, flank_angle: f64) -> PyResult<Moments> {
    Trapezoid::new(width, height, 0.5 * flank_angle)
        .map(|trapezoid| moments_of(&trapezoid.section()))
        .ok_or_else(|| {
            wrong(&"the flanks of the trapezoid meet within it, or a size is not positive")
        })
}

fn vector_of(name: &str) -> PyResult<NodeDirection> {
    match name {
        "position" => Ok(NodeDirection::Position),
        "along" => Ok(NodeDirection::Along),
        "height" => Ok(NodeDirection::Height),
        "width" => Ok(NodeDirection::Width),
        other => Err(PyValueError::new_err(format!(
            "there is no vector `{other}`: they are position, along, height and width"
        ))),
    }
}

#[pymethods]
impl NativeSpaceBeam {
    /// A chain of `kind`, straight from `start` with the `axes` of its length, height and width, or drawn with the nodal
    /// coordinates `nodes`; `factors` are of axial, bending and torsion stiffness.
    #[new]
    #[pyo3(signature = (kind, length, elements, section, material, start, axes, factors, nodes=None))]
    #[expect(
        clippy::too_many_arguments,
        reason = "the Python side gathers them in objects"
    )]
    fn new(
        kind: &str,
        length: f64,
        elements: usize,
        section: Moments,
        material: [f64; 3],
        start: [f64; 3],
        axes: [[f64; 3]; 3],
        factors: [f64; 3],
        nodes: Option<Numbers<'_>>,
    ) -> PyResult<Self> {
        if elements == 0 {
            return Err(wrong(&"a beam has at least one element"));
        }
        let section = section_of(section);
        let [youngs_modulus, poisson_ratio, density] = material;
        let material = Isotropic {
            youngs_modulus,
            poisson_ratio,
            density,
        };
        let part = length / elements as f64;
        let [axial, bending, torsion] = factors;
        let line = Line {
            elements,
            start,
            axes,
            nodes,
        };
        let structure = match kind {
            "belt-beam-3d" => {
                let element = BeltBeam3::new(part, &section, &material, axial, bending);
                AnyStructure::Belt(line.of(element.with_torsion_factor(torsion))?)
            }
            "linear-beam-3d" => {
                let element = LinearBeam3::new(part, &section, &material);
                AnyStructure::Linear(line.of(element.with_torsion_factor(torsion))?)
            }
            other => {
                return Err(PyValueError::new_err(format!(
                    "there is no element `{other}`: the elements are belt-beam-3d and linear-beam-3d"
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

    fn clamp_section(&mut self, node: usize) {
        each!(&mut self.structure, s => { s.clamp_section(node); });
    }

    fn fix(&mut self, node: usize, vector: &str, axis: usize) -> PyResult<()> {
        let vector = vector_of(vector)?;
        within_space(axis)?;
        each!(&mut self.structure, s => { s.fix(node, vector, axis); });
        Ok(())
    }

    /// Moves a component of a vector of a node by a function of time.
    fn prescribe(
        &mut self,
        node: usize,
        vector: &str,
        axis: usize,
        function: Py<PyAny>,
    ) -> PyResult<()> {
        let vector = vector_of(vector)?;
        within_space(axis)?;
        let motion = Arc::new(UserMotion {
            function,
            raised: Arc::clone(&self.raised),
        });
        each!(&mut self.structure, s => { s.prescribe(node, vector, axis, motion); });
        Ok(())
    }

    fn join_ends(&mut self) {
        each!(&mut self.structure, s => { s.join_ends(); });
    }

    fn force(&mut self, node: usize, vector: &str, force: [f64; 3]) -> PyResult<()> {
        let vector = vector_of(vector)?;
        each!(&mut self.structure, s => { s.force(node, vector, force); });
        Ok(())
    }

    fn gravity(&mut self, field: [f64; 3]) {
        each!(&mut self.structure, s => { s.gravity(field); });
    }

    fn line_load(&mut self, load: [f64; 3]) {
        each!(&mut self.structure, s => { s.line_load(load); });
    }

    fn eliminate(&mut self, eliminate: bool) {
        let form = if eliminate {
            ConstraintForm::Elimination
        } else {
            ConstraintForm::Multipliers
        };
        each!(&mut self.structure, s => { s.constraint_form(form); });
    }

    /// The drawn coordinates of nodes that are nodes of their own.
    fn drawn<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, each!(&self.structure, s => s.drawn().to_vec()))
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

fn within_space(axis: usize) -> PyResult<()> {
    if axis > 2 {
        return Err(wrong(&"the axes are 0 for x, 1 for y and 2 for z"));
    }
    Ok(())
}

/// How a chain is drawn.
struct Line<'py> {
    elements: usize,
    start: [f64; 3],
    axes: [[f64; 3]; 3],
    nodes: Option<Numbers<'py>>,
}

impl Line<'_> {
    fn of<E: LineElement>(&self, element: E) -> PyResult<SpatialStructure<E>> {
        let count = self.elements;
        let Some(nodes) = &self.nodes else {
            return Ok(SpatialStructure::straight(
                element, count, self.start, self.axes,
            ));
        };
        let nodes = drawn_coordinates(nodes, (count + 1) * E::NODE_DOF)?;
        Ok(SpatialStructure::with_nodes(vec![element; count], nodes))
    }
}

impl<E: LineElement> Structure for SpatialStructure<E> {
    type Element = E;
    type Law = Loads;

    fn size(&self) -> f64 {
        self.length()
    }

    fn drawn(&self) -> Vec<f64> {
        self.drawn().to_vec()
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
