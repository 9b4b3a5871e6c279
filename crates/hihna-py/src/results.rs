//! What a run found, as NumPy arrays.

use std::path::PathBuf;

use hihna::drive::Drive;
use hihna::observe::{EdgeRow, ProfileRow};
use hihna::record::{self, Options, RecordError, Results};
use hihna::simulate::Outcome;
use hihna::summary::Summary;
use numpy::PyArray1;
use pyo3::exceptions::{PyFileExistsError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::drive::NativeDrive;
use crate::errors::{InputError, ReadError};

/// Results of a run, just made or read from a folder.
#[pyclass(frozen, module = "hihna._native")]
pub struct NativeResults {
    results: Results,
    /// What writes a folder; `None` for results that come from one.
    outcome: Option<Outcome>,
    /// Rows of the history one after another; columns are views of it.
    history: Py<PyArray1<f64>>,
}

impl NativeResults {
    pub(crate) fn of_run(py: Python<'_>, drive: Drive, outcome: Outcome) -> PyResult<Self> {
        let summary = serde_json::to_value(Summary::new(&drive, &outcome))
            .map_err(|error| PyValueError::new_err(error.to_string()))?;
        let results = Results {
            drive,
            summary,
            history: outcome.history.clone(),
            profile: outcome.profile.clone(),
            frames: outcome.frames.clone(),
            edges: outcome.edges.clone(),
        };
        Ok(Self::new(py, results, Some(outcome)))
    }

    fn new(py: Python<'_>, results: Results, outcome: Option<Outcome>) -> Self {
        let values = results.history.rows().flatten().copied().collect();
        Self {
            history: PyArray1::from_vec(py, values).unbind(),
            results,
            outcome,
        }
    }
}

#[pymethods]
impl NativeResults {
    /// Reads a result folder.
    #[staticmethod]
    #[expect(
        clippy::needless_pass_by_value,
        reason = "Python's arguments are owned"
    )]
    fn load(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        let results =
            Results::read(&folder).map_err(|error| ReadError::new_err(error.to_string()))?;
        Ok(Self::new(py, results, None))
    }

    fn drive(&self) -> NativeDrive {
        NativeDrive::new(self.results.drive.clone())
    }

    fn summary(&self) -> String {
        self.results.summary.to_string()
    }

    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        PyList::new(py, self.results.history.columns())
    }

    fn history<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.history.bind(py).clone()
    }

    fn profile<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        table(py, &self.results.profile)
    }

    fn frames<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        table(py, &self.results.frames)
    }

    /// Both edges of a belt in space, row by row beside the frames.
    fn edges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let columns: [EdgeColumn; 8] = [
            ("time", |row| row.time),
            ("material_coordinate", |row| row.material_coordinate),
            ("x0", |row| row.x0),
            ("y0", |row| row.y0),
            ("z0", |row| row.z0),
            ("x1", |row| row.x1),
            ("y1", |row| row.y1),
            ("z1", |row| row.z1),
        ];
        let table = PyDict::new(py);
        for (name, value) in columns {
            let values = self.results.edges.iter().map(value).collect();
            table.set_item(name, PyArray1::from_vec(py, values))?;
        }
        Ok(table)
    }

    /// The drive to scale, slip at the end marked, as SVG.
    fn svg(&self) -> PyResult<String> {
        hihna_report::result_drawing(&self.results)
            .map_err(|error| InputError::new_err(error.to_string()))
    }

    /// Tables of the means: caption, heads and rows of text.
    fn tables(&self) -> Vec<(String, Vec<String>, Vec<Vec<String>>)> {
        hihna_report::result_tables(&self.results)
            .into_iter()
            .map(|table| (table.caption, table.header, table.rows))
            .collect()
    }

    /// The report as one HTML page.
    fn report(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| hihna_report::html(&self.results))
            .map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// Writes a result folder.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "Python's arguments are owned"
    )]
    fn save(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        overwrite: bool,
        vtk: bool,
        report: bool,
    ) -> PyResult<()> {
        let Some(outcome) = &self.outcome else {
            return Err(PyValueError::new_err(
                "these results were read from a folder: copy that",
            ));
        };
        let options = Options { overwrite, vtk };
        py.detach(|| record::write(&folder, &self.results.drive, outcome, options))
            .map_err(|error| match error {
                RecordError::Exists { .. } => PyFileExistsError::new_err(format!(
                    "{} exists already; save with overwrite=True to replace it",
                    folder.display()
                )),
                error => ReadError::new_err(error.to_string()),
            })?;
        if report {
            hihna_report::write(&folder).map_err(|error| ReadError::new_err(error.to_string()))?;
        }
        Ok(())
    }
}

/// Name of a column of the edges and its number in a row.
type EdgeColumn = (&'static str, fn(&EdgeRow) -> f64);

/// Name of a column and its number in a row.
type Column = (&'static str, fn(&ProfileRow) -> f64);

/// Columns of a profile as arrays, `pulley` as a list of names.
fn table<'py>(py: Python<'py>, rows: &[ProfileRow]) -> PyResult<Bound<'py, PyDict>> {
    let columns: [Column; 16] = [
        ("time", |row| row.time),
        ("material_coordinate", |row| row.material_coordinate),
        ("x", |row| row.x),
        ("y", |row| row.y),
        ("z", |row| row.z),
        ("tension", |row| row.tension),
        ("element_tension", |row| row.element_tension),
        ("strain_green", |row| row.strain_green),
        ("strain_engineering", |row| row.strain_engineering),
        ("strain_true", |row| row.strain_true),
        ("strain_almansi", |row| row.strain_almansi),
        ("jacobian", |row| row.jacobian),
        ("speed", |row| row.speed),
        ("normal_force", |row| row.normal_force),
        ("friction_force", |row| row.friction_force),
        ("slip_speed", |row| row.slip_speed),
    ];
    let table = PyDict::new(py);
    for (name, value) in columns {
        table.set_item(
            name,
            PyArray1::from_vec(py, rows.iter().map(value).collect()),
        )?;
    }
    table.set_item(
        "pulley",
        PyList::new(py, rows.iter().map(|row| &row.pulley))?,
    )?;
    Ok(table)
}
