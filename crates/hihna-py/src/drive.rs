//! Drives: loaded, changed, run.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use hihna::drive::Drive;
use hihna::input::{self, InputErrors, Override};
use hihna::layout::Layout;
use hihna::simulate::{Flow, RunError as LibraryRunError, simulate_with};
use hihna::steady::drive_string::{DriveString, SteadyError};
use hihna::steady::running::summary::RunningSummary;
use hihna::steady::running::{self, RunningError};
use hihna::steady::string::{Answer, Closure, Model};
use hihna::summary::Named;
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::errors::{InputError, RunError, input_error, problem};
use crate::results::NativeResults;
use crate::user_laws::{Functions, user_laws};
use crate::user_motion::{Raised, has_raised, take};

/// Between looks at signals and calls of the user's progress.
const INTERVAL: Duration = Duration::from_millis(100);

/// A checked drive.
#[pyclass(frozen, module = "hihna._native")]
pub struct NativeDrive {
    drive: Drive,
}

#[pymethods]
impl NativeDrive {
    /// Reads a drive file, with changes `(path, value as JSON)`.
    #[staticmethod]
    #[expect(
        clippy::needless_pass_by_value,
        reason = "Python's arguments are owned"
    )]
    fn load(py: Python<'_>, path: PathBuf, changes: Vec<(String, String)>) -> PyResult<Self> {
        let changes = overrides(py, &changes)?;
        Self::checked(py, input::load(&path, &changes))
    }

    /// The drive that the program runs without a file.
    #[staticmethod]
    fn built_in(py: Python<'_>) -> PyResult<Self> {
        let text = include_str!("../../../examples/two_pulley.toml");
        Self::checked(py, input::parse("two_pulley.toml", text, &[]))
    }

    /// Reads TOML text.
    #[staticmethod]
    #[expect(
        clippy::needless_pass_by_value,
        reason = "Python's arguments are owned"
    )]
    fn parse(
        py: Python<'_>,
        name: &str,
        text: &str,
        changes: Vec<(String, String)>,
    ) -> PyResult<Self> {
        let changes = overrides(py, &changes)?;
        Self::checked(py, input::parse(name, text, &changes))
    }

    /// Reads a drive as JSON, fields as in a drive file.
    #[staticmethod]
    fn from_json(py: Python<'_>, text: &str) -> PyResult<Self> {
        let value = json_value(text)?;
        let toml = to_toml(value)
            .and_then(|value| toml::to_string(&value).ok())
            .ok_or_else(|| InputError::new_err("a drive is a dictionary of its fields"))?;
        Self::checked(py, input::parse("<dictionary>", &toml, &[]))
    }

    /// This drive with changes.
    fn changed(&self, py: Python<'_>, changes: Vec<(String, String)>) -> PyResult<Self> {
        Self::parse(py, "<drive>", &input::to_toml(&self.drive), changes)
    }

    fn to_toml(&self) -> String {
        input::to_toml(&self.drive)
    }

    fn to_json(&self) -> PyResult<String> {
        serde_json::to_string(&self.drive).map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// The drive to scale, as SVG.
    fn svg(&self) -> PyResult<String> {
        let layout =
            Layout::of(&self.drive).map_err(|error| InputError::new_err(error.to_string()))?;
        Ok(hihna_report::drawing(&self.drive, &layout, &[], &[]))
    }

    /// Runs the drive; `progress` is called now and then with the time reached and the end time. `friction` and `load`
    /// take the place of what the pulleys have.
    #[pyo3(signature = (progress=None, friction=Vec::new(), load=Vec::new()))]
    #[expect(
        clippy::needless_pass_by_value,
        reason = "Python's arguments are owned"
    )]
    fn run(
        &self,
        py: Python<'_>,
        progress: Option<Py<PyAny>>,
        friction: Functions,
        load: Functions,
    ) -> PyResult<NativeResults> {
        let mut looked = Instant::now();
        let mut raised: Option<PyErr> = None;
        let raised_by_laws = Raised::default();
        let laws = user_laws(friction, load, &raised_by_laws);
        let outcome = py.detach(|| {
            simulate_with(&self.drive, &laws, &mut |state| {
                if has_raised(&raised_by_laws) {
                    return Flow::Stop;
                }
                if looked.elapsed() < INTERVAL {
                    return Flow::Continue;
                }
                looked = Instant::now();
                let told = Python::attach(|py| {
                    py.check_signals()?;
                    if let Some(progress) = &progress {
                        progress.call1(py, (state.time, state.end_time))?;
                    }
                    Ok(())
                });
                match told {
                    Ok(()) => Flow::Continue,
                    Err(error) => {
                        raised = Some(error);
                        Flow::Stop
                    }
                }
            })
        });
        match (outcome, take(&raised_by_laws).or(raised)) {
            (_, Some(error)) => Err(error),
            (Err(LibraryRunError::UserLaw(error)), None) => {
                Err(PyValueError::new_err(error.to_string()))
            }
            (Ok(outcome), None) => NativeResults::of_run(py, self.drive.clone(), outcome),
            (Err(LibraryRunError::Stopped { .. }), None) => Err(PyKeyboardInterrupt::new_err(())),
            (Err(LibraryRunError::Assembly(error)), None) => {
                Err(InputError::new_err(error.to_string()))
            }
            (Err(LibraryRunError::SteadyStart(refused)), None) => {
                Err(problem(py, &refused.problem(&self.drive)))
            }
            (Err(error), None) => Err(RunError::new_err(error.to_string())),
        }
    }

    /// Steady running by the theory of the extensible string or by finite elements, as JSON.
    fn steady(&self, py: Python<'_>, model: &str, closure: &str) -> PyResult<String> {
        if model == "fe" {
            if closure != "length" {
                return Err(PyValueError::new_err(
                    "finite elements keep the unstretched length: the closure is `length`",
                ));
            }
            return self.steady_elements(py);
        }
        let model = match model {
            "full" => Model::Full,
            "centrifugal" => Model::Centrifugal,
            "capstan" => Model::Capstan,
            other => {
                return Err(PyValueError::new_err(format!(
                    "there is no model `{other}`: the models are full, centrifugal, capstan and fe"
                )));
            }
        };
        let closure = match closure {
            "length" => Closure::UnstretchedLength,
            "tension-sum" => Closure::TensionSum,
            other => {
                return Err(PyValueError::new_err(format!(
                    "there is no closure `{other}`: the closures are length and tension-sum"
                )));
            }
        };
        let wrong = |error: SteadyError| problem(py, &error.problem(&self.drive));
        let string = DriveString::new(&self.drive, model, closure).map_err(wrong)?;
        let answer = py.detach(|| string.solve()).map_err(wrong)?;
        Ok(steady_summary(&string, &answer).to_string())
    }
}

impl NativeDrive {
    /// What `hihna steady --model fe` writes to summary.json.
    fn steady_elements(&self, py: Python<'_>) -> PyResult<String> {
        let outcome = py
            .detach(|| running::solve(&self.drive))
            .map_err(|error| match error {
                RunningError::Drive(error) => problem(py, &error.problem(&self.drive)),
                RunningError::Assembly(error) => InputError::new_err(error.to_string()),
                error => RunError::new_err(error.to_string()),
            })?;
        serde_json::to_string(&RunningSummary::new(&self.drive, &outcome))
            .map_err(|error| PyValueError::new_err(error.to_string()))
    }

    pub(crate) fn new(drive: Drive) -> Self {
        Self { drive }
    }

    fn checked(py: Python<'_>, drive: Result<Drive, InputErrors>) -> PyResult<Self> {
        drive
            .map(|drive| Self { drive })
            .map_err(|errors| input_error(py, &errors))
    }
}

fn steady_summary(string: &DriveString, answer: &Answer) -> Value {
    match answer {
        Answer::Running(running) => {
            let pulleys = string.pulleys(running).into_iter();
            let spans = string.spans(running).into_iter();
            let capacity = running.capacity.as_ref().map(|capacity| {
                json!({
                    "factor": capacity.factor,
                    "pulley": string.names[string.order[capacity.pulley]],
                    "largest_torque": capacity.torque.abs(),
                })
            });
            json!({
                "answer": "running",
                "message": "the drive runs: every pulley sticks somewhere",
                "pulley": Named(pulleys.map(|p| (p.name.clone(), p)).collect()),
                "span": Named(spans.map(|s| (s.name.clone(), s)).collect()),
                "power_in": running.power_in,
                "power_out": running.power_out,
                "power_lost": running.friction_loss,
                "efficiency": running.efficiency,
                "capacity": capacity,
            })
        }
        Answer::GrossSlip(slip) => json!({
            "answer": "gross-slip",
            "message": string.explain_gross_slip(slip),
        }),
        Answer::Slack(slack) => json!({
            "answer": "slack",
            "message": string.explain_slack(slack),
            "tension": slack.tension,
            "needed_tension": slack.needed_tension,
        }),
    }
}

fn json_value(text: &str) -> PyResult<Value> {
    serde_json::from_str(text).map_err(|error| PyValueError::new_err(error.to_string()))
}

fn overrides(py: Python<'_>, changes: &[(String, String)]) -> PyResult<Vec<Override>> {
    let parsed = changes.iter().map(|(path, value)| {
        let value = to_toml(json_value(value)?)
            .ok_or_else(|| PyValueError::new_err(format!("`{path}` cannot become None")))?;
        format!("{path}={value}")
            .parse::<Override>()
            .map_err(|errors| input_error(py, &errors))
    });
    parsed.collect()
}

/// JSON as TOML; fields that are null are left out.
fn to_toml(value: Value) -> Option<toml::Value> {
    Some(match value {
        Value::Null => return None,
        Value::Bool(value) => value.into(),
        Value::Number(number) => match (number.as_i64(), number.as_f64()) {
            (Some(integer), _) => integer.into(),
            (None, Some(float)) => float.into(),
            (None, None) => return None,
        },
        Value::String(text) => text.into(),
        Value::Array(list) => list
            .into_iter()
            .filter_map(to_toml)
            .collect::<Vec<_>>()
            .into(),
        Value::Object(fields) => {
            let fields = fields.into_iter();
            let table: toml::Table = fields
                .filter_map(|(name, value)| Some((name, to_toml(value)?)))
                .collect();
            table.into()
        }
    })
}
