//! `hihna steady`: what a drive settles to, by the extensible string with inertia or by finite elements.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use hihna::drive::Drive;
use hihna::input::{self, DriveFile, InputErrors};
use hihna::record::Folder;
use hihna::steady::drive_string::{DriveString, SteadyError};
use hihna::steady::string::{Answer, Closure, Model, StringError};
use serde::Serialize;

use crate::diagnostics::{Failure, print_warning};
use crate::drive_source::DriveSource;
use crate::loudness::Loudness;
use crate::standard_output;

mod campbell;
mod elements;
mod map;
mod modes;
mod sensitivity;
mod summary;
mod words;

use summary::Summary;

/// Rows of `profile.csv`, about.
const PROFILE_ROWS: usize = 500;

/// Find what a drive settles to, by the theory of the extensible string or by finite elements, and
/// print speeds, torques, tensions, slip and efficiency.
///
/// Speeds and torques are those that the profiles of the drive file end with. For the string bending,
/// contact stiffness and gravity play no part, and of the friction law only the coefficient. A drive
/// that slips as a whole or goes slack is an answer, too: the exit status is 0.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    source: DriveSource,

    /// Which theory: the string with some of the belt's inertia, or finite elements
    #[arg(long, value_enum, default_value_t = ModelName::Full)]
    model: ModelName,

    /// Of the string, what stays as it is when the belt starts to run
    #[arg(long, value_enum, default_value_t = ClosureName::Length)]
    closure: ClosureName,

    /// Print derivatives and elasticities of the results by fields of the drive file, such as
    /// `belt.length,pulley.driven.radius`
    #[arg(long, value_name = "KEY", value_delimiter = ',')]
    sensitivity: Vec<String>,

    /// With `--model fe`: print the first K modes of spans and drive about the running state; with one `--map`,
    /// follow them over its values and print a Campbell diagram as CSV
    #[arg(long, value_name = "K", default_value_t = 0, hide_default_value = true, value_parser = clap::value_parser!(u16).range(..=100))]
    modes: u16,

    /// With `--model fe`: solve the drive at every combination of values of one or more fields, such as
    /// `pulley.driven.torque=-1:-20:20 pulley.driver.speed=6:120:20`; `torque` and `speed` are those of the
    /// one driven pulley and the one driver. The drive file goes before it
    #[arg(long, value_name = "KEY=FROM:TO:COUNT", num_args = 1.., conflicts_with = "sensitivity")]
    map: Vec<String>,

    /// Folder for drive.toml, summary.json and, of a drive that runs, profile.csv [default: no files]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Overwrite an existing result folder
    #[arg(long, requires = "out")]
    force: bool,

    /// Print one JSON object, as in `summary.json`, to standard output
    #[arg(long)]
    pub json: bool,
}

/// Models by the names that users give.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
enum ModelName {
    /// Centrifugal force and acceleration by stretching
    Full,
    /// Centrifugal force only
    Centrifugal,
    /// None: the classical capstan equation with a creeping belt
    Capstan,
    /// The finite elements of `hihna run`, without stepping through time
    Fe,
}

/// Closures by the names that users give.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
enum ClosureName {
    /// The unstretched length of the belt
    Length,
    /// The mean of the spans' tensions
    TensionSum,
}

/// Solves, records and tells.
pub fn steady(arguments: &Arguments, loudness: Loudness) -> Result<(), Failure> {
    let Some(model) = arguments.model.string() else {
        return match (arguments.map.is_empty(), arguments.modes) {
            (true, _) => elements::steady(arguments, loudness),
            (false, 0) => map::steady(arguments, loudness),
            (false, _) => campbell::steady(arguments, loudness),
        };
    };
    let closure = match arguments.closure {
        ClosureName::Length => Closure::UnstretchedLength,
        ClosureName::TensionSum => Closure::TensionSum,
    };
    if !arguments.map.is_empty() || arguments.modes > 0 {
        return Err(Failure::Argument {
            message: "`--map` and `--modes` are there for the finite elements only".into(),
            help: "add `--model fe`".into(),
        });
    }
    let file = arguments.source.open()?;
    let drive = &file.drive;
    let wrong = |error: SteadyError| failure(&error, &file);
    let string = DriveString::new(drive, model, closure).map_err(wrong)?;
    let fields = string
        .find_inputs(&arguments.sensitivity)
        .map_err(|error| sensitivity::unknown(&error))?;
    let folder = arguments
        .out
        .as_deref()
        .map(|place| Folder::new(place, arguments.force))
        .transpose()
        .map_err(Failure::Folder)?;

    let answer = string.solve().map_err(wrong)?;
    let mut summary = Summary::new(arguments, drive, &string, &answer).map_err(wrong)?;
    if !fields.is_empty() {
        summary.sensitivity = sensitivity::summary(&string, &fields).map_err(wrong)?;
        if summary.sensitivity.is_none() {
            let warning = "no sensitivities: the drive does not run";
            summary.warnings.push(warning.into());
        }
    }

    if let Some(folder) = folder {
        write(folder, drive, &string, &answer, &summary).map_err(Failure::Record)?;
    }
    summary.folder = arguments
        .out
        .as_ref()
        .map(|place| place.display().to_string());
    if arguments.json {
        standard_output::print_json(&summary)?;
    } else if !loudness.quiet {
        standard_output::print(&summary.in_words(drive))?;
    }
    for warning in &summary.warnings {
        print_warning(warning);
    }
    Ok(())
}

fn write(
    folder: Folder,
    drive: &Drive,
    string: &DriveString,
    answer: &Answer,
    summary: &Summary,
) -> Result<(), hihna::record::RecordError> {
    folder.text("drive.toml", &input::to_toml(drive))?;
    folder.json("summary.json", summary)?;
    if let Answer::Running(running) = answer {
        folder.rows("profile.csv", &string.profile(running, PROFILE_ROWS))?;
    }
    folder.finish()
}

/// What is wrong with the drive, at its field in the file.
fn failure(error: &SteadyError, file: &DriveFile) -> Failure {
    match error {
        SteadyError::String(error @ StringError::NotConverged { .. }) => {
            Failure::Steady(error.clone())
        }
        error => Failure::Input(InputErrors::from(file.locate(error.problem(&file.drive)))),
    }
}

impl ModelName {
    /// The string's model of this name.
    fn string(self) -> Option<Model> {
        match self {
            Self::Full => Some(Model::Full),
            Self::Centrifugal => Some(Model::Centrifugal),
            Self::Capstan => Some(Model::Capstan),
            Self::Fe => None,
        }
    }

    fn in_words(self) -> &'static str {
        match self {
            Self::Full => "full inertia",
            Self::Centrifugal => "centrifugal force only",
            Self::Capstan => "no inertia (capstan)",
            Self::Fe => "finite elements",
        }
    }
}
