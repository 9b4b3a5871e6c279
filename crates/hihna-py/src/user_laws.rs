//! Friction and torques given by functions of the user's. Every call takes the interpreter's lock.

use std::sync::Arc;

use hihna::friction::{StatedFriction, differences};
use hihna::load::{TorqueLaw, difference};
use hihna::user_laws::UserLaws;
use pyo3::exceptions::{PyException, PyValueError};
use pyo3::prelude::*;

use crate::errors::RunError;
use crate::user_motion::{Raised, has_raised, keep};

/// Functions by the names of their pulleys.
pub type Functions = Vec<(String, Py<PyAny>)>;

/// The laws of these functions; what one of them raises is left in `raised`.
pub fn user_laws(friction: Functions, load: Functions, raised: &Raised) -> UserLaws {
    let function = |pulley: &str, what, function| UserFunction {
        function,
        name: format!("the {what} of pulley `{pulley}`"),
        raised: Arc::clone(raised),
    };
    let mut laws = UserLaws::default();
    for (pulley, given) in friction {
        let law = UserFriction(function(&pulley, "friction law", given));
        laws = laws.with_friction(&pulley, Arc::new(law));
    }
    for (pulley, given) in load {
        let law = UserTorque(function(&pulley, "load", given));
        laws = laws.with_torque(&pulley, Arc::new(law));
    }
    laws
}

/// A function, and what messages call it.
#[derive(Debug)]
struct UserFunction {
    function: Py<PyAny>,
    name: String,
    raised: Raised,
}

impl UserFunction {
    /// What `ask` finds, or `None` now and ever after it has raised: the run stops at what is no number, and the
    /// error is told then.
    fn answer<T>(&self, ask: impl FnOnce(Python<'_>) -> PyResult<T>) -> Option<T> {
        if has_raised(&self.raised) {
            return None;
        }
        Python::attach(|py| {
            ask(py)
                .map_err(|error| keep(&self.raised, self.named(py, error)))
                .ok()
        })
    }

    /// An exception that names the law; what is none, such as an interrupt, stays as it is.
    fn named(&self, py: Python<'_>, error: PyErr) -> PyErr {
        if !error.is_instance_of::<PyException>(py) {
            return error;
        }
        let named = RunError::new_err(format!("{} raised {error}", self.name));
        named.set_cause(py, Some(error));
        named
    }

    fn call<'py>(&self, py: Python<'py>, arguments: (f64, f64)) -> PyResult<Bound<'py, PyAny>> {
        self.function.bind(py).call1(arguments)
    }
}

/// A number from `answer` to `arguments`.
fn number(answer: &Bound<'_, PyAny>, arguments: (f64, f64)) -> PyResult<f64> {
    finite(answer.extract()?, arguments)
}

fn finite(value: f64, (first, second): (f64, f64)) -> PyResult<f64> {
    if value.is_finite() {
        Ok(value)
    } else {
        let message = format!("it gave {value} at ({first}, {second})");
        Err(PyValueError::new_err(message))
    }
}

/// slip velocity [m/s], normal force [N/m] -> force per length [N/m], alone or with its two derivatives.
#[derive(Debug)]
struct UserFriction(UserFunction);

impl StatedFriction for UserFriction {
    fn develop(&self, slip_velocity: f64, normal_force: f64) -> (f64, [f64; 2]) {
        let found = self.0.answer(|py| {
            let at = (slip_velocity, normal_force);
            let answer = self.0.call(py, at)?;
            if let Ok((force, by_slip, by_normal)) = answer.extract::<(f64, f64, f64)>() {
                let force = finite(force, at)?;
                return Ok((force, [finite(by_slip, at)?, finite(by_normal, at)?]));
            }
            let mut first = Some(number(&answer, at)?);
            let mut wrong = None;
            let mut force = |v, n| {
                first.take().or_else(|| {
                    let answer = self.0.call(py, (v, n));
                    let force = answer.and_then(|answer| number(&answer, (v, n)));
                    force.map_err(|error| wrong = Some(error)).ok()
                })
            };
            let found = differences(slip_velocity, normal_force, &mut force);
            // Differences are missing only where a call failed.
            found.ok_or_else(|| wrong.unwrap_or_else(|| PyValueError::new_err("no answer")))
        });
        found.unwrap_or((f64::NAN, [f64::NAN; 2]))
    }
}

/// time [s], speed [rad/s] -> torque [N m], alone or with its derivative by the speed.
#[derive(Debug)]
struct UserTorque(UserFunction);

impl TorqueLaw for UserTorque {
    fn at(&self, time: f64, speed: f64) -> (f64, f64) {
        let found = self.0.answer(|py| {
            let at = (time, speed);
            let answer = self.0.call(py, at)?;
            if let Ok((torque, by_speed)) = answer.extract::<(f64, f64)>() {
                return Ok((finite(torque, at)?, finite(by_speed, at)?));
            }
            let mut first = Some(number(&answer, at)?);
            let mut wrong = None;
            let mut torque = |speed| {
                first.take().or_else(|| {
                    let answer = self.0.call(py, (time, speed));
                    let torque = answer.and_then(|answer| number(&answer, (time, speed)));
                    torque.map_err(|error| wrong = Some(error)).ok()
                })
            };
            let found = difference(speed, &mut torque);
            found.ok_or_else(|| wrong.unwrap_or_else(|| PyValueError::new_err("no answer")))
        });
        found.unwrap_or((f64::NAN, f64::NAN))
    }
}
