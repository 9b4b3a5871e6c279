//! Errors of the library as Python exceptions.

use hihna::input::{InputError as LibraryInputError, InputErrors, Problem};
use pyo3::create_exception;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple, PyType};

create_exception!(
    hihna,
    InputError,
    PyValueError,
    "A drive that cannot be run. `field` is the path of the first field to blame, `errors` all that is wrong: a list \
     of dictionaries with `field`, `message`, `expected`, `help`, `line`."
);
create_exception!(
    hihna,
    RunError,
    PyRuntimeError,
    "A run that failed; the message says when, where and why."
);
create_exception!(
    hihna,
    ReadError,
    PyOSError,
    "A folder that holds no results, or a place that cannot be written."
);
create_exception!(
    hihna,
    StructureError,
    PyValueError,
    "A structure that cannot be built, held or solved."
);

/// The type of errors of the input: those that have no field to blame say so.
pub fn input_error_type(py: Python<'_>) -> PyResult<Bound<'_, PyType>> {
    let kind = py.get_type::<InputError>();
    kind.setattr("field", py.None())?;
    kind.setattr("errors", PyTuple::empty(py))?;
    Ok(kind)
}

/// All that is wrong with an input, as one exception.
pub fn input_error(py: Python<'_>, errors: &InputErrors) -> PyErr {
    let line = |error: &LibraryInputError| error.place.as_ref().map(hihna::input::Place::line);
    let problems = errors.iter().map(|error| (&error.problem, line(error)));
    described(py, errors.to_string(), problems)
}

/// A single problem.
pub fn problem(py: Python<'_>, problem: &Problem) -> PyErr {
    described(py, problem.to_string(), std::iter::once((problem, None)))
}

fn described<'a>(
    py: Python<'_>,
    message: String,
    problems: impl Iterator<Item = (&'a Problem, Option<usize>)>,
) -> PyErr {
    let error = InputError::new_err(message);
    let describe = || -> PyResult<()> {
        let list = PyList::empty(py);
        let mut first = None;
        for (problem, line) in problems {
            let entry = PyDict::new(py);
            let field = problem.path.to_string();
            entry.set_item("field", &field)?;
            entry.set_item("message", &problem.message)?;
            entry.set_item("expected", &problem.expected)?;
            entry.set_item("help", &problem.help)?;
            entry.set_item("line", line)?;
            list.append(entry)?;
            if !field.is_empty() {
                first.get_or_insert(field);
            }
        }
        let value = error.value(py);
        value.setattr("field", first)?;
        value.setattr("errors", list)
    };
    // What went wrong in describing is worse than what is described.
    describe().err().unwrap_or(error)
}
