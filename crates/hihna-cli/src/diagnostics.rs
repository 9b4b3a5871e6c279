//! What went wrong, for people (with the line of their file) and for programs (as JSON).

use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use hihna::input::{InputError, InputErrors};
use hihna::record::RecordError;
use hihna::simulate::RunError;
use hihna::steady::running::{Obstacle, RunningError};
use hihna::steady::string::StringError;
use hihna::validate::{CatalogueError, UnknownCase};
use hihna_report::ReportError;
use miette::{
    Diagnostic, LabeledSpan, MietteHandlerOpts, NamedSource, Report, Severity, SourceCode,
};
use serde_json::{Value, json};
use thiserror::Error;

/// Why the program did not do what it was asked.
#[derive(Debug, Error)]
pub enum Failure {
    /// The drive is wrong.
    #[error(transparent)]
    Input(#[from] InputErrors),
    /// An argument asks for something that the program does not have.
    #[error("{message}")]
    Argument {
        /// What is wrong.
        message: String,
        /// What to do.
        help: String,
    },
    /// The steady state was not found; not known to happen.
    #[error(transparent)]
    Steady(StringError),
    /// The steady state of the finite elements was not found.
    #[error(transparent)]
    Running(RunningError),
    /// The result folder cannot be made; nothing was run.
    #[error(transparent)]
    Folder(RecordError),
    /// The run failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The run was fine, but its result could not be written.
    #[error(transparent)]
    Record(RecordError),
    /// The result is written, but its balances do not close.
    #[error(
        "the audit failed: the energy residual is {energy:.1e} and the torque residual {torque:.1e}, more than {tolerance:.1e} allowed"
    )]
    Audit {
        /// Relative energy residual.
        energy: f64,
        /// Relative residual of the torque balances.
        torque: f64,
        /// What is allowed.
        tolerance: f64,
        /// Where the results are.
        folder: PathBuf,
    },
    /// A result folder could not be made a page.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// No validation case has this name.
    #[error(transparent)]
    UnknownCase(#[from] UnknownCase),
    /// The program's own validation data is broken.
    #[error(transparent)]
    Catalogue(#[from] CatalogueError),
    /// Values differ from the published ones; the answer is printed and says which.
    #[error("{failed} of the values differ from the published ones by more than their tolerance")]
    Validation {
        /// How many.
        failed: usize,
    },
    /// Standard output does not take the answer.
    #[error("cannot write to standard output: {0}")]
    Output(io::Error),
    /// Ctrl-C cannot be caught.
    #[error("cannot prepare for Ctrl-C: {0}")]
    Signal(io::Error),
}

impl Failure {
    /// Exit status of the program: 2 if the user's input is to blame, 1 otherwise.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::Input(_)
            | Self::Argument { .. }
            | Self::Folder(_)
            | Self::UnknownCase(_)
            | Self::Report(ReportError::Read(_) | ReportError::Axes { .. })
            | Self::Running(RunningError::Assembly(_) | RunningError::Field(_))
            | Self::Run(RunError::Assembly(_)) => ExitCode::from(2),
            _ => ExitCode::from(1),
        }
    }

    /// Prints the failure to standard error.
    pub fn print(&self) {
        match self {
            Self::Input(errors) => {
                for error in errors {
                    show(Message::of_input(error));
                }
            }
            failure => show(Message::new(
                Severity::Error,
                failure.to_string(),
                failure.help(),
            )),
        }
    }

    /// The failure as the one JSON object of the command; `None` where a summary is there already, and says so.
    pub fn json(&self) -> Option<Value> {
        let errors: Vec<Value> = match self {
            Self::Input(errors) => errors.iter().map(input_error_json).collect(),
            Self::Audit { .. } | Self::Validation { .. } | Self::Output(_) => return None,
            failure => vec![json!({ "message": failure.to_string(), "help": failure.help() })],
        };
        Some(json!({ "errors": errors }))
    }

    fn help(&self) -> Option<String> {
        let text = match self {
            Self::Run(RunError::Start { .. }) => {
                "check the length of the belt with `hihna check`; more `belt.elements` or a lower `contact.stiffness` make the start easier"
            }
            Self::Run(RunError::Step { .. }) => {
                "something is too steep there: try a lower `contact.friction.slope` (or a larger `velocity`), a lower `contact.stiffness` or `contact.damping`, more `belt.elements`, a smaller `run.accuracy` or fixed `run.step`, or a gentler speed; with `--set KEY=VALUE` the file can stay as it is"
            }
            Self::Run(RunError::TooManySteps { .. }) => {
                "steps follow the fastest driver's speed, the swings of light pulleys and `run.accuracy`: look for slips of the decimal point there, or shorten `run.end_time`"
            }
            Self::Run(RunError::Stopped { .. }) => "nothing was written",
            Self::Argument { help, .. } => help,
            Self::UnknownCase(UnknownCase {
                nearest: Some(nearest),
                ..
            }) => {
                return Some(format!(
                    "did you mean `{nearest}`? `hihna validate --list` prints all"
                ));
            }
            Self::UnknownCase(_) => "`hihna validate --list` prints the cases",
            Self::Report(ReportError::Read(_)) => {
                "name a folder that `hihna run` or `hihna steady --map` has written"
            }
            Self::Report(ReportError::Axes { .. }) => {
                "ask for a map of one or two fields, and set the others by `--set`"
            }
            Self::Steady(_) => {
                "check stiffness, tension and torques of the drive for slips of the decimal point"
            }
            Self::Running(RunningError::Lost { .. }) => {
                "try more `belt.elements`, lower torques or gentler bristles"
            }
            Self::Running(RunningError::NotFound(obstacle)) => match obstacle {
                Obstacle::LiftOff { .. } => "run slower or tighten the belt",
                Obstacle::BendingWaves { .. } => {
                    "take a larger `belt.bending_factor`, run slower, leave bending out with `--model full`, or run it in time with `hihna run --until steady`"
                }
                Obstacle::Drivers { .. } => {
                    "give the speed of one pulley and torques of the others: a belt that slips all along a pulley has no steady running"
                }
                Obstacle::Unknown => {
                    "try more `belt.elements`, a gentler friction law or less `contact.damping`"
                }
            },
            Self::Running(RunningError::Derivatives { .. }) => {
                "try more `belt.elements` or lower torques"
            }
            Self::Record(_) => {
                "nothing was kept; free some space or name another place with --out, then run again"
            }
            Self::Audit { folder, .. } => {
                return Some(format!(
                    "the results in {} are not to be trusted; try more `belt.elements` or `contact.points`, gentler changes of speed and load, or a short fixed `run.step`",
                    folder.display()
                ));
            }
            _ => return None,
        };
        Some(text.to_owned())
    }
}

/// Prints something to know that stops nothing.
pub fn print_warning(text: &str) {
    show(Message::new(Severity::Warning, text.to_owned(), None));
}

fn show(message: Message) {
    prepare_reports();
    // If standard error does not take it, there is no place left to say so.
    let _ = write!(io::stderr(), "{:?}", Report::new(message));
}

/// Lines wrap on a terminal; in a file or a pipe they stay whole.
fn prepare_reports() {
    // Only the first hook is kept, and all are equal.
    let _ = miette::set_hook(Box::new(|_| {
        let wrap = io::stderr().is_terminal();
        Box::new(
            MietteHandlerOpts::new()
                .wrap_lines(wrap)
                .context_lines(1)
                .build(),
        )
    }));
}

fn input_error_json(error: &InputError) -> Value {
    let problem = &error.problem;
    let place = error.place.as_ref();
    json!({
        "message": problem.message,
        "field": problem.path.to_string(),
        "file": place.map(|place| &place.source.name),
        "line": place.map(hihna::input::Place::line),
        "column": place.map(hihna::input::Place::column),
        "expected": problem.expected,
        "help": problem.help,
    })
}

/// A message as miette shows it.
#[derive(Debug)]
struct Message {
    severity: Severity,
    text: String,
    help: Option<String>,
    source: Option<NamedSource<String>>,
    label: Option<LabeledSpan>,
}

impl Message {
    fn new(severity: Severity, text: String, help: Option<String>) -> Self {
        Self {
            severity,
            text,
            help,
            source: None,
            label: None,
        }
    }

    fn of_input(error: &InputError) -> Self {
        let problem = &error.problem;
        let expected = problem
            .expected
            .as_ref()
            .map(|expected| format!("expected {expected}"));
        let help: Vec<_> = expected.into_iter().chain(problem.help.clone()).collect();
        let help = (!help.is_empty()).then(|| help.join("\n"));
        let mut message = Self::new(Severity::Error, problem.message.clone(), help);
        if let Some(place) = &error.place {
            message.source = Some(NamedSource::new(
                &place.source.name,
                place.source.text.clone(),
            ));
            message.label = Some(LabeledSpan::underline(place.span.clone()));
        }
        message
    }
}

impl fmt::Display for Message {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.text)
    }
}

impl std::error::Error for Message {}

impl Diagnostic for Message {
    fn severity(&self) -> Option<Severity> {
        Some(self.severity)
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.help
            .as_ref()
            .map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.source.as_ref().map(|source| source as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.label
            .clone()
            .map(|label| Box::new(std::iter::once(label)) as Box<dyn Iterator<Item = LabeledSpan>>)
    }
}
