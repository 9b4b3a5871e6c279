//! Motions prescribed by a function of the user's.

use std::sync::{Arc, Mutex, PoisonError};

use ancf::system::Motion;
use pyo3::prelude::*;

/// What a user's function raised, to be told when the solver has come back.
pub type Raised = Arc<Mutex<Option<PyErr>>>;

/// Takes what was raised out.
pub fn take(raised: &Raised) -> Option<PyErr> {
    raised.lock().unwrap_or_else(PoisonError::into_inner).take()
}

/// Whether a function of the user's has raised; it stays raised.
pub fn has_raised(raised: &Raised) -> bool {
    let raised = raised.lock().unwrap_or_else(PoisonError::into_inner);
    raised.is_some()
}

/// Keeps the first error.
pub fn keep(raised: &Raised, error: PyErr) {
    let mut raised = raised.lock().unwrap_or_else(PoisonError::into_inner);
    raised.get_or_insert(error);
}

/// A function of the user's: time [s] -> value and its first and second derivative by time. Every call takes the
/// interpreter's lock.
#[derive(Debug)]
pub struct UserMotion {
    pub function: Py<PyAny>,
    pub raised: Raised,
}

impl Motion for UserMotion {
    fn at(&self, time: f64) -> [f64; 3] {
        let answer = Python::attach(|py| {
            self.function
                .call1(py, (time,))?
                .extract::<(f64, f64, f64)>(py)
        });
        match answer {
            Ok((value, velocity, acceleration)) => [value, velocity, acceleration],
            Err(error) => {
                keep(&self.raised, error);
                // The solver stops at what is no number, and the error is told then.
                [f64::NAN; 3]
            }
        }
    }
}
