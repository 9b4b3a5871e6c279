//! `hihna run`: simulate a drive and write its results.

use std::path::PathBuf;
use std::sync::atomic::Ordering;

use clap::{Args, ValueEnum};
use hihna::drive::Until;
use hihna::frames;
use hihna::input::InputErrors;
use hihna::record;
use hihna::simulate::{Flow, RunError, simulate};
use hihna::summary::Summary;
use serde::Serialize;

use crate::diagnostics::{Failure, print_warning};
use crate::drive_source::DriveSource;
use crate::loudness::Loudness;
use crate::progress::Bar;
use crate::{signals, standard_output, summary};

/// Simulate a drive, write a result folder and print a summary.
#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of its own")]
pub struct Arguments {
    #[command(flatten)]
    source: DriveSource,

    /// Folder for the results [default: the drive file's name with `-result`]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Overwrite an existing result folder
    #[arg(long)]
    force: bool,

    /// Add `report.html`: drawing, tables, charts and the belt in motion
    #[arg(long)]
    report: bool,

    /// Add the belt in motion for ParaView, `belt.pvd`
    #[arg(long)]
    vtk: bool,

    /// End the run when the means of speeds and tensions have settled, at `run.end_time` at the latest
    /// [default: `run.until` of the drive file]
    #[arg(long, value_name = "STATE", hide_possible_values = true)]
    until: Option<UntilName>,

    /// Print one JSON object, as in `summary.json`, to standard output
    #[arg(long)]
    pub json: bool,
}

/// Ends of a run by the names that users give.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum UntilName {
    /// At `run.end_time`.
    End,
    /// When the means have settled.
    Steady,
}

/// What `--json` prints: the summary and where the files are.
#[derive(Serialize)]
struct Answer<'a> {
    folder: String,
    #[serde(flatten)]
    summary: &'a Summary,
}

/// Runs, records and tells.
pub fn run(arguments: &Arguments, loudness: Loudness) -> Result<(), Failure> {
    let file = arguments.source.open()?;
    let mut drive = file.drive.clone();
    if let Some(until) = arguments.until {
        drive.run.until = match until {
            UntilName::End => Until::End,
            UntilName::Steady => Until::Steady,
        };
    }
    if arguments.report || arguments.vtk {
        frames::choose(&mut drive);
    }
    let folder = arguments
        .out
        .clone()
        .unwrap_or_else(|| arguments.source.default_folder());
    record::check(&folder, arguments.force).map_err(Failure::Folder)?;

    let interrupted = signals::interrupted()?;
    let mut bar = Bar::new(loudness.shows_progress());
    let outcome = simulate(&drive, &mut |progress| {
        bar.update(progress);
        if interrupted.load(Ordering::Relaxed) {
            Flow::Stop
        } else {
            Flow::Continue
        }
    });
    bar.finish();
    let outcome = outcome.map_err(|error| match error {
        RunError::SteadyStart(refused) => {
            Failure::Input(InputErrors::from(file.locate(refused.problem(&drive))))
        }
        error => Failure::Run(error),
    })?;

    let options = record::Options {
        overwrite: arguments.force,
        vtk: arguments.vtk,
    };
    record::write(&folder, &drive, &outcome, options).map_err(Failure::Record)?;
    if arguments.report {
        hihna_report::write(&folder)?;
    }
    let found = Summary::new(&drive, &outcome);
    for warning in &found.warnings {
        print_warning(warning);
    }
    if arguments.json {
        standard_output::print_json(&Answer {
            folder: folder.display().to_string(),
            summary: &found,
        })?;
    } else if !loudness.quiet {
        standard_output::print(&summary::in_words(&found, &folder))?;
        if loudness.verbose {
            standard_output::print(&summary::solver_in_words(&found))?;
        }
    }
    if found.audit.passed {
        return Ok(());
    }
    Err(Failure::Audit {
        energy: found.audit.energy_residual,
        torque: found.audit.torque_residual,
        tolerance: found.audit.tolerance,
        folder,
    })
}
