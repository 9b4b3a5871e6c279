//! `hihna steady --model fe`: steady running of the finite elements.

use std::fmt::Write;

use hihna::drive::{Drive, SteadyMesh};
use hihna::input::{self, DriveFile, InputErrors, NumberField, UnknownNumber};
use hihna::record::{Folder, RecordError};
use hihna::steady::running::summary::{RunningSummary, Steady};
use hihna::steady::running::{self, Answer, Outcome, RunningError};
use serde::Serialize;

use super::Arguments;
use super::modes::{self, ModeSummary};
use super::sensitivity::{self, SensitivitySummary};
use super::words::{self, PulleyWords, RunningWords};
use crate::diagnostics::{Failure, print_warning};
use crate::loudness::Loudness;
use crate::quantities::with_prefix;
use crate::standard_output;

/// What `--json` prints: the summary and where the files are.
#[derive(Serialize)]
struct Told<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    folder: Option<String>,
    #[serde(flatten)]
    summary: &'a RunningSummary,
    /// By the fields of `--sensitivity`; left out without it and for a drive that does not run.
    #[serde(skip_serializing_if = "Option::is_none")]
    sensitivity: Option<&'a SensitivitySummary>,
    /// By rising frequency; left out without `--modes` and for a drive that does not run.
    #[serde(skip_serializing_if = "Option::is_none")]
    modes: Option<&'a [ModeSummary]>,
}

/// Solves, records and tells.
pub fn steady(arguments: &Arguments, loudness: Loudness) -> Result<(), Failure> {
    let file = arguments.source.open()?;
    let folder = arguments
        .out
        .as_deref()
        .map(|place| Folder::new(place, arguments.force))
        .transpose()
        .map_err(Failure::Folder)?;
    let fields = find_fields(&file.drive, &arguments.sensitivity)?;
    let study = running::study(&file.drive, &fields, arguments.modes.into())
        .map_err(|error| failure(error, &file))?;
    let outcome = study.outcome;
    let sensitivity = study.sensitivity.map(|found| sensitivity::by_field(&found));
    let names: Vec<_> = file.drive.pulley.iter().map(|p| p.name.as_str()).collect();
    let modes = study.modes.map(|found| modes::summary(&found, &names));
    let mut summary = RunningSummary::new(&file.drive, &outcome);
    let growth = modes.as_deref().and_then(modes::stability);
    summary.warnings.extend(growth);
    if let Some(folder) = folder {
        let told = Told {
            folder: None,
            summary: &summary,
            sensitivity: sensitivity.as_ref(),
            modes: modes.as_deref(),
        };
        write(folder, &file, &outcome, &told).map_err(Failure::Record)?;
    }
    let folder = arguments
        .out
        .as_ref()
        .map(|place| place.display().to_string());
    if arguments.json {
        standard_output::print_json(&Told {
            folder,
            summary: &summary,
            sensitivity: sensitivity.as_ref(),
            modes: modes.as_deref(),
        })?;
    } else if !loudness.quiet {
        let mut text = in_words(&summary, folder.as_deref());
        if let Some(fields) = &sensitivity {
            text.push('\n');
            text.push_str(&sensitivity::in_words(fields));
        }
        if let Some(modes) = &modes {
            text.push('\n');
            text.push_str(&modes::in_words(modes, arguments.modes.into()));
        }
        standard_output::print(&text)?;
    }
    for warning in &summary.warnings {
        print_warning(warning);
    }
    Ok(())
}

fn write(
    folder: Folder,
    file: &DriveFile,
    outcome: &Outcome,
    summary: &Told<'_>,
) -> Result<(), RecordError> {
    folder.text("drive.toml", &input::to_toml(&file.drive))?;
    folder.json("summary.json", summary)?;
    if let Answer::Running(running) = &outcome.answer {
        folder.rows("profile.csv", &running.profile)?;
    }
    folder.finish()
}

/// The fields of these keys.
pub(super) fn find_fields(drive: &Drive, keys: &[String]) -> Result<Vec<NumberField>, Failure> {
    let find = |key: &String| NumberField::find(drive, key).map_err(|error| unknown(&error));
    keys.iter().map(find).collect()
}

/// A key that is no number of the drive, as an argument that is wrong.
pub(super) fn unknown(error: &UnknownNumber) -> Failure {
    let near = error
        .nearest
        .as_ref()
        .map_or_else(String::new, |near| format!("did you mean `{near}`? "));
    Failure::Argument {
        message: error.to_string(),
        help: format!("{near}name a field as in `--set`, such as `pulley.driven.torque`"),
    }
}

/// What is wrong with the drive, at its field in the file where one is to blame.
pub(super) fn failure(error: RunningError, file: &DriveFile) -> Failure {
    match error {
        RunningError::Drive(error) => {
            Failure::Input(InputErrors::from(file.locate(error.problem(&file.drive))))
        }
        error => Failure::Running(error),
    }
}

fn in_words(summary: &RunningSummary, folder: Option<&str>) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{}", words::title(&summary.title));
    let model = &summary.model;
    let _ = writeln!(
        text,
        "Steady running of {} {} elements, {} unknowns; {} at rest\n",
        model.elements,
        match model.mesh {
            SteadyMesh::Graded => "graded",
            SteadyMesh::Uniform => "equal",
        },
        model.dofs,
        with_prefix(summary.start.tension, "N"),
    );
    match &summary.steady {
        Some(steady) => text.push_str(&running_in_words(steady)),
        None => {
            let _ = writeln!(text, "{}\n", words::capitalised(&summary.message));
        }
    }
    if let Some((audit, steady)) = summary.audit.as_ref().zip(summary.steady.as_ref()) {
        let _ = writeln!(text, "Power residual: {}", audit.in_words(steady.power_in));
    }
    if let Some(capacity) = &summary.capacity {
        text.push_str(&words::capacity_in_words(capacity));
    }
    if let Some(folder) = folder {
        let _ = writeln!(text, "Results: {folder}");
    }
    text
}

fn running_in_words(steady: &Steady) -> String {
    let pulleys = steady.pulley.0.iter().map(|(name, pulley)| {
        let report = &pulley.report;
        PulleyWords {
            name,
            speed: report.speed,
            external_torque: report.external_torque,
            slip_angle: report.slip_angle,
            stick_angle: pulley.stick_angle,
            arc: report.contact_angle,
            hub_force: report.hub_force,
            power: report.power,
            speed_loss: report.speed_loss,
        }
    });
    let spans = (steady.span.0.iter())
        .map(|(name, span)| (name.as_str(), span.tension, span.speed, span.strain));
    RunningWords {
        arc: "contact",
        pulleys: pulleys.collect(),
        spans: spans.collect(),
        speed_loss: steady.speed_loss,
        powers: [steady.power_in, steady.power_out, steady.power_lost],
        efficiency: steady.efficiency,
    }
    .in_words()
}
