//! What structures of beams and plates have in common: statics, modes and motion, as arrays by coordinate. Python cuts
//! them into nodes and vectors.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use ancf::dynamics::{Control, Method, Motion, integrate};
use ancf::element::Element;
use ancf::statics::{Equilibrium, LoadSteps};
use ancf::structure::{Mode, StructureError as LibraryError};
use ancf::system::{ForceLaw, System};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::StructureError;
use crate::user_motion::{Raised, has_raised, take};

/// Between looks at signals.
const INTERVAL: Duration = Duration::from_millis(100);

/// An array of numbers of the user's.
pub type Numbers<'py> = PyReadonlyArray1<'py, f64>;

/// A structure of the library.
pub trait Structure: Send + Sync {
    type Element: Element;
    type Law: ForceLaw + Send;

    /// Length [m] that Newton's tolerance is relative to.
    fn size(&self) -> f64;
    /// The drawn coordinates, without multipliers.
    fn drawn(&self) -> Vec<f64>;
    fn system(&self) -> Result<System<Self::Element, Self::Law>, LibraryError>;
    fn start(
        &self,
        system: &System<Self::Element, Self::Law>,
        q: &[f64],
        v: &[f64],
    ) -> Result<Motion, LibraryError>;
    /// The start as drawn, at rest but for what is prescribed.
    fn at_rest(&self, system: &System<Self::Element, Self::Law>) -> Motion;
    fn apply_in_steps(&mut self, steps: LoadSteps);
    fn settled(&self) -> Result<Equilibrium, LibraryError>;
    fn linear(&self) -> Result<Vec<f64>, LibraryError>;
    fn natural(&self, about: &Equilibrium) -> Result<Vec<Mode>, LibraryError>;
    fn energy(system: &System<Self::Element, Self::Law>, q: &[f64], v: &[f64]) -> f64;
    /// Forces in the middle of an element with the coordinates `e`: axial [N] of beams, membrane [N/m] of plates.
    fn inner_forces(element: &Self::Element, e: &[f64]) -> Vec<f64>;
}

/// A library's error as Python's.
pub fn wrong(error: &impl ToString) -> PyErr {
    StructureError::new_err(error.to_string())
}

/// What a function of the user's raised comes before what the solver made of it.
fn tell(raised: &Raised) -> PyResult<()> {
    take(raised).map_or(Ok(()), Err)
}

/// Vectors of a user's array as many as `wanted`.
pub fn drawn_coordinates(given: &Numbers<'_>, wanted: usize) -> PyResult<Vec<f64>> {
    let given = given.as_array().to_vec();
    if given.len() == wanted {
        return Ok(given);
    }
    Err(wrong(&format!(
        "the nodes have {} numbers, the elements need {wanted}",
        given.len()
    )))
}

/// How statics applies the loads: equal steps, halvings, tolerance by the structure's length, iterations.
pub type Steps = (usize, u32, f64, usize);

/// The equilibrium: coordinates, multipliers, reactions, sizes of Newton's corrections.
pub fn equilibrium<'py, S: Structure>(
    py: Python<'py>,
    structure: &mut S,
    (steps, halvings, tolerance, max_iterations): Steps,
    raised: &Raised,
) -> PyResult<Bound<'py, PyDict>> {
    if steps == 0 || max_iterations == 0 || !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(PyValueError::new_err(
            "load_steps, max_iterations and tolerance must be positive",
        ));
    }
    structure.apply_in_steps(LoadSteps {
        steps,
        halvings,
        tolerance: tolerance * structure.size(),
        max_iterations,
    });
    let found = py.detach(|| structure.settled());
    tell(raised)?;
    let found = found.map_err(|error| wrong(&error))?;
    let answer = PyDict::new(py);
    answer.set_item("iterations", found.iterations())?;
    answer.set_item("corrections", found.corrections)?;
    answer.set_item("reactions", PyArray1::from_vec(py, found.reactions))?;
    answer.set_item("multipliers", PyArray1::from_vec(py, found.multipliers))?;
    answer.set_item("coordinates", PyArray1::from_vec(py, found.q))?;
    Ok(answer)
}

/// The displacements of linear theory, by coordinate.
pub fn linear_displacements<'py, S: Structure>(
    py: Python<'py>,
    structure: &S,
    raised: &Raised,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let found = py.detach(|| structure.linear());
    tell(raised)?;
    Ok(PyArray1::from_vec(
        py,
        found.map_err(|error| wrong(&error))?,
    ))
}

/// Natural motions about the equilibrium with these coordinates and multipliers, or about the drawn shape: frequencies,
/// growths, and shapes by coordinate, real and imaginary parts.
pub fn modes<'py, S: Structure>(
    py: Python<'py>,
    structure: &S,
    about: Option<(Numbers<'py>, Numbers<'py>)>,
    raised: &Raised,
) -> PyResult<Bound<'py, PyDict>> {
    let system = structure.system();
    tell(raised)?;
    let system = system.map_err(|error| wrong(&error))?;
    let drawn = structure.at_rest(&system).q;
    let (q, multipliers) = match about {
        None => (drawn.clone(), vec![0.0; drawn.len()]),
        Some((q, multipliers)) => (q.as_array().to_vec(), multipliers.as_array().to_vec()),
    };
    if q.len() != drawn.len() || multipliers.len() != drawn.len() {
        return Err(wrong(&"the equilibrium is of another structure"));
    }
    let about = Equilibrium {
        reactions: vec![0.0; q.len()],
        q,
        multipliers,
        corrections: Vec::new(),
    };
    let modes = py.detach(|| structure.natural(&about));
    tell(raised)?;
    let modes = modes.map_err(|error| wrong(&error))?;
    let answer = PyDict::new(py);
    let of = |part: fn(&Mode) -> f64| PyArray1::from_vec(py, modes.iter().map(part).collect());
    answer.set_item("frequencies", of(|mode| mode.frequency))?;
    answer.set_item("growths", of(|mode| mode.growth))?;
    let shapes = |part: usize| {
        let values = modes.iter().flat_map(|mode| &mode.shape);
        PyArray1::from_vec(py, values.map(|value| value[part]).collect())
    };
    answer.set_item("shapes", shapes(0))?;
    answer.set_item("imaginary_shapes", shapes(1))?;
    Ok(answer)
}

/// Forces in the middle of all elements, with these coordinates.
pub fn inner_forces<'py, S: Structure>(
    py: Python<'py>,
    structure: &S,
    coordinates: &Numbers<'py>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let q = coordinates.as_array().to_vec();
    let system = structure.system().map_err(|error| wrong(&error))?;
    let mesh = system.mesh();
    if q.len() < structure.drawn().len() {
        return Err(wrong(&"the coordinates are of another structure"));
    }
    let mut own = vec![0.0; S::Element::DOF];
    let mut forces = Vec::new();
    for (i, element) in mesh.elements().iter().enumerate() {
        mesh.gather(i, &q, &mut own);
        forces.extend(S::inner_forces(element, &own));
    }
    Ok(PyArray1::from_vec(py, forces))
}

/// How a motion is computed.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Course<'py> {
    end: f64,
    step: f64,
    interval: f64,
    method: String,
    /// Accepted difference of predicted and found velocities; `None`: steps are fixed.
    error_tolerance: Option<f64>,
    newton_tolerance: f64,
    /// Times that steps must hit [s].
    kinks: Vec<f64>,
    /// Coordinates at the start; `None`: as drawn.
    coordinates: Option<Numbers<'py>>,
    /// Velocities at the start; `None`: at rest.
    velocities: Option<Numbers<'py>>,
}

impl Course<'_> {
    fn control(&self) -> PyResult<Control> {
        let method = match self.method.as_str() {
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
        let tolerance = self.error_tolerance.unwrap_or(1.0);
        let positive = [
            self.end,
            self.step,
            self.interval,
            self.newton_tolerance,
            tolerance,
        ];
        if !positive
            .iter()
            .all(|value| *value > 0.0 && value.is_finite())
        {
            return Err(PyValueError::new_err(
                "end, step, interval and tolerances must be positive",
            ));
        }
        let mut kinks = self.kinks.clone();
        kinks.sort_by(f64::total_cmp);
        Ok(Control {
            error_tolerance: self.error_tolerance,
            newton_tolerance: self.newton_tolerance,
            kinks,
            ..Control::fixed(method, self.step)
        })
    }

    /// The state at time zero.
    fn start<S: Structure>(
        &self,
        structure: &S,
        system: &System<S::Element, S::Law>,
    ) -> PyResult<Motion> {
        let drawn = structure.at_rest(system);
        if self.coordinates.is_none() && self.velocities.is_none() {
            return Ok(drawn);
        }
        let given = |numbers: &Option<Numbers<'_>>, otherwise: &[f64]| match numbers {
            None => Ok(otherwise.to_vec()),
            Some(numbers) => {
                let found = numbers.as_array().to_vec();
                // With or without places for multipliers.
                if found.len() == drawn.q.len() || found.len() == structure.drawn().len() {
                    return Ok(found);
                }
                Err(wrong(&"the start is one of another structure"))
            }
        };
        let q = given(&self.coordinates, &drawn.q)?;
        let v = given(&self.velocities, &drawn.v)?;
        structure
            .start(system, &q, &v)
            .map_err(|error| wrong(&error))
    }
}

/// States at equal intervals, all coordinates of one after those of another.
#[derive(Default)]
struct Film {
    time: Vec<f64>,
    coordinates: Vec<f64>,
    velocities: Vec<f64>,
    energy: Vec<f64>,
    steps: usize,
}

/// A motion: times, coordinates, velocities, energy, number of steps.
pub fn motion<'py, S: Structure>(
    py: Python<'py>,
    structure: &S,
    course: &Course<'py>,
    raised: &Raised,
) -> PyResult<Bound<'py, PyDict>> {
    let control = course.control()?;
    let system = structure.system();
    // What a function raised comes before what is wrong with its answer.
    tell(raised)?;
    let mut system = system.map_err(|error| wrong(&error))?;
    let start = course.start(structure, &system);
    tell(raised)?;
    let start = start?;
    let (end, interval) = (course.end, course.interval);
    let found = py.detach(|| film::<S>(&mut system, start, (end, interval), &control, raised));
    tell(raised)?;
    let film = found?;
    let answer = PyDict::new(py);
    answer.set_item("steps", film.steps)?;
    for (name, values) in [
        ("time", film.time),
        ("coordinates", film.coordinates),
        ("velocities", film.velocities),
        ("energy", film.energy),
    ] {
        answer.set_item(name, PyArray1::from_vec(py, values))?;
    }
    Ok(answer)
}

#[expect(
    clippy::redundant_closure_for_method_calls,
    reason = "the method is not general in its lifetime"
)]
fn film<S: Structure>(
    system: &mut System<S::Element, S::Law>,
    mut motion: Motion,
    (end, interval): (f64, f64),
    control: &Control,
    raised: &Raised,
) -> PyResult<Film> {
    let mut film = Film::default();
    let mut state = Motion::zero(motion.q.len());
    let mut signal = None;
    let mut looked = Instant::now();
    let done = integrate(system, &mut motion, end, control, |system, window| {
        loop {
            let due = interval * film.time.len() as f64;
            if due > window.to.time + 1.0e-9 * interval {
                break;
            }
            window.interpolate(due.min(window.to.time), &mut state);
            film.time.push(state.time);
            film.coordinates.extend(&state.q);
            film.velocities.extend(&state.v);
            film.energy.push(S::energy(system, &state.q, &state.v));
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
    film.steps = done.map_err(|error| wrong(&error))?.steps;
    Ok(film)
}
