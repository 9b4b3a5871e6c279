//! Planar structures of one chain of beams: supports, loads, statics, modes, motion.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::{Duration, Instant};

use ancf::constraint::{ConstraintForm, SpinUp};
use ancf::dynamics::{Control, Method, Motion, integrate};
use ancf::element::{BeltBeam2, CubicBeam2, LineElement, LinearBeam2};
use ancf::material::Isotropic;
use ancf::section::PlanarSection;
use ancf::statics::Equilibrium;
use ancf::structure::{Coordinate, NodeVector, PlanarStructure, RigidBody};
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::StructureError;
use crate::user_motion::{Raised, UserMotion, has_raised, take};

/// Between looks at signals.
const INTERVAL: Duration = Duration::from_millis(100);

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

fn wrong(error: &impl ToString) -> PyErr {
    StructureError::new_err(error.to_string())
}

/// `(area, second moment, fourth moment)` and `(E, nu, rho)`.
type Triple = (f64, f64, f64);

#[pymethods]
impl NativeBeam {
    #[new]
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
    ) -> PyResult<Self> {
        if elements == 0 {
            return Err(StructureError::new_err("a beam has at least one element"));
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
        let structure = match kind {
            "belt-beam" => {
                let (axial, bending, damping) = factors;
                let element = BeltBeam2::new(part, &section, &material, axial, bending, damping);
                AnyStructure::Belt(PlanarStructure::straight(element, elements, start, angle))
            }
            "cubic-beam" => {
                let element = CubicBeam2::new(part, &section, &material);
                AnyStructure::Cubic(PlanarStructure::straight(element, elements, start, angle))
            }
            "linear-beam" => {
                let element = LinearBeam2::new(part, &section, &material);
                AnyStructure::Linear(PlanarStructure::straight(element, elements, start, angle))
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

    /// Moves a component of a node's place by a function of time.
    fn prescribe(&mut self, node: usize, axis: usize, function: Py<PyAny>) {
        let motion = Arc::new(UserMotion {
            function,
            raised: Arc::clone(&self.raised),
        });
        let coordinate = Coordinate::Node {
            node,
            vector: NodeVector::Position,
            axis,
        };
        each!(&mut self.structure, s => { s.prescribe(coordinate, motion); });
    }

    /// The equilibrium: coordinates, places of the nodes, reactions on them, iterations.
    fn equilibrium<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let answer = PyDict::new(py);
        each!(&self.structure, s => {
            let found = py.detach(|| s.equilibrium());
            self.tell()?;
            let found = found.map_err(|error| wrong(&error))?;
            answer.set_item("positions", flat(py, (0..=s.last()).map(|n| s.position(&found.q, n))))?;
            answer.set_item("reactions", flat(py, (0..=s.last()).map(|n| s.reaction(&found, n))))?;
            answer.set_item("iterations", found.iterations())?;
            answer.set_item("multipliers", PyArray1::from_vec(py, found.multipliers))?;
            answer.set_item("coordinates", PyArray1::from_vec(py, found.q))?;
        });
        Ok(answer)
    }

    /// Natural motions about the equilibrium with these coordinates and multipliers, or about the drawn shape: pairs
    /// of frequency and growth, and the motion of the nodes, real parts.
    fn modes<'py>(
        &self,
        py: Python<'py>,
        about: Option<(Vec<f64>, Vec<f64>)>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let answer = PyDict::new(py);
        each!(&self.structure, s => {
            let about = if let Some((q, multipliers)) = about {
                equilibrium_at(q, multipliers)
            } else {
                let system = s.build().map_err(|error| wrong(&error))?;
                let drawn = s.at_rest(&system).q;
                let multipliers = vec![0.0; drawn.len()];
                equilibrium_at(drawn, multipliers)
            };
            let modes = py.detach(|| s.modes(&about));
            self.tell()?;
            let modes = modes.map_err(|error| wrong(&error))?;
            let pairs = modes.iter().map(|mode| [mode.frequency, mode.growth]);
            answer.set_item("modes", flat(py, pairs))?;
            let shapes = modes.iter().flat_map(|mode| {
                let real: Vec<f64> = mode.shape.iter().map(|[real, _]| *real).collect();
                (0..=s.last()).map(move |n| s.position(&real, n))
            });
            answer.set_item("shapes", flat(py, shapes))?;
        });
        Ok(answer)
    }

    /// Motion from rest as drawn: times, places and velocities of the nodes, energy.
    fn integrate<'py>(
        &self,
        py: Python<'py>,
        end: f64,
        step: f64,
        method: &str,
        interval: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let method = match method {
            "auto" => Method::Auto,
            "generalized-alpha" => Method::GeneralizedAlpha,
            "tr-bdf2" => Method::TrBdf2,
            "runge-kutta" => Method::RungeKutta,
            other => {
                return Err(PyValueError::new_err(format!(
                    "there is no integrator `{other}`: they are auto, generalized-alpha, tr-bdf2 and runge-kutta"
                )));
            }
        };
        if !(end > 0.0 && step > 0.0 && interval > 0.0) {
            return Err(PyValueError::new_err(
                "end, step and interval must be positive",
            ));
        }
        let control = Control::fixed(method, step);
        let found = each!(&self.structure, s => py.detach(|| film(s, end, interval, &control, &self.raised)));
        self.tell()?;
        let film = found?;
        let answer = PyDict::new(py);
        answer.set_item("time", PyArray1::from_vec(py, film.time))?;
        answer.set_item("positions", PyArray1::from_vec(py, film.positions))?;
        answer.set_item("velocities", PyArray1::from_vec(py, film.velocities))?;
        answer.set_item("energy", PyArray1::from_vec(py, film.energy))?;
        Ok(answer)
    }
}

impl NativeBeam {
    /// What a function of the user's raised comes before what the solver made of it.
    fn tell(&self) -> PyResult<()> {
        take(&self.raised).map_or(Ok(()), Err)
    }
}

fn equilibrium_at(q: Vec<f64>, multipliers: Vec<f64>) -> Equilibrium {
    Equilibrium {
        reactions: vec![0.0; q.len()],
        q,
        multipliers,
        corrections: Vec::new(),
    }
}

fn flat(py: Python<'_>, pairs: impl Iterator<Item = [f64; 2]>) -> Bound<'_, PyArray1<f64>> {
    PyArray1::from_vec(py, pairs.flatten().collect())
}

/// States at equal intervals.
#[derive(Default)]
struct Film {
    time: Vec<f64>,
    positions: Vec<f64>,
    velocities: Vec<f64>,
    energy: Vec<f64>,
}

#[expect(
    clippy::redundant_closure_for_method_calls,
    reason = "the method is not general in its lifetime"
)]
fn film<E: LineElement>(
    structure: &PlanarStructure<E>,
    end: f64,
    interval: f64,
    control: &Control,
    raised: &Raised,
) -> PyResult<Film> {
    let mut system = structure.build().map_err(|error| wrong(&error))?;
    let mut motion = structure.at_rest(&system);
    let mut film = Film::default();
    let mut state = Motion::zero(motion.q.len());
    let mut signal = None;
    let mut looked = Instant::now();
    let done = integrate(&mut system, &mut motion, end, control, |system, window| {
        loop {
            let due = interval * film.time.len() as f64;
            if due > window.to.time + 1.0e-9 * interval {
                break;
            }
            window.interpolate(due.min(window.to.time), &mut state);
            film.time.push(state.time);
            for node in 0..=structure.last() {
                film.positions.extend(structure.position(&state.q, node));
                film.velocities.extend(structure.position(&state.v, node));
            }
            film.energy.push(system.energy(&state.q, &state.v));
        }
        if looked.elapsed() > INTERVAL {
            looked = Instant::now();
            signal = Python::attach(|py| py.check_signals()).err();
        }
        if signal.is_some() || has_raised(raised) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    if let Some(error) = signal {
        return Err(error);
    }
    done.map_err(|error| wrong(&error))?;
    Ok(film)
}
