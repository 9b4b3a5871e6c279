//! Rectangular plates: supports of their edges, loads, statics, modes.

use ancf::element::{BendingRigidity, ThinPlate};
use ancf::material::Isotropic;
use ancf::statics::Equilibrium;
use ancf::structure::{Edge, PlateStructure};
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::StructureError;

/// A plate with its supports and loads.
#[pyclass(module = "hihna._native")]
pub struct NativePlate {
    structure: PlateStructure,
}

fn wrong(error: &impl ToString) -> PyErr {
    StructureError::new_err(error.to_string())
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

    fn force(&mut self, node: [usize; 2], force: [f64; 3]) {
        self.structure.force(node, force);
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

    /// The equilibrium: coordinates, places of the nodes, iterations.
    fn equilibrium<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = py
            .detach(|| self.structure.equilibrium())
            .map_err(|error| wrong(&error))?;
        let answer = PyDict::new(py);
        answer.set_item("positions", self.places(py, &found.q))?;
        answer.set_item("iterations", found.iterations())?;
        answer.set_item("coordinates", PyArray1::from_vec(py, found.q))?;
        Ok(answer)
    }

    /// Modes about the coordinates `about`, or about the drawn shape: frequencies, and the motion of the nodes.
    fn modes<'py>(&self, py: Python<'py>, about: Option<Vec<f64>>) -> PyResult<Bound<'py, PyDict>> {
        let drawn = self.structure.drawn();
        let q = about.unwrap_or_else(|| drawn.to_vec());
        if q.len() != drawn.len() {
            return Err(wrong(&"the equilibrium is of another plate"));
        }
        let about = Equilibrium {
            multipliers: vec![0.0; q.len()],
            reactions: vec![0.0; q.len()],
            q,
            corrections: Vec::new(),
        };
        let modes = py
            .detach(|| self.structure.modes(&about))
            .map_err(|error| wrong(&error))?;
        let answer = PyDict::new(py);
        let frequencies = modes.iter().map(|mode| mode.frequency).collect();
        answer.set_item("frequencies", PyArray1::from_vec(py, frequencies))?;
        let growths = modes.iter().map(|mode| mode.growth).collect();
        answer.set_item("growths", PyArray1::from_vec(py, growths))?;
        let shapes = modes.iter().flat_map(|mode| {
            let real: Vec<f64> = mode.shape.iter().map(|[real, _]| *real).collect();
            self.of_nodes(&real)
        });
        answer.set_item("shapes", PyArray1::from_vec(py, shapes.collect()))?;
        Ok(answer)
    }
}

impl NativePlate {
    /// Places of the nodes, or their motion, one after another.
    fn of_nodes(&self, q: &[f64]) -> Vec<f64> {
        let nodes = self.structure.nodes();
        nodes
            .flat_map(|node| self.structure.position(q, node))
            .collect()
    }

    fn places<'py>(&self, py: Python<'py>, q: &[f64]) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.of_nodes(q))
    }
}
