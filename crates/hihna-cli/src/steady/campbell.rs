//! `hihna steady --model fe --modes K --map KEY=FROM:TO:COUNT`: a Campbell diagram as a table.

use std::f64::consts::TAU;
use std::fmt::Write;

use hihna::input;
use hihna::record::Folder;
use hihna::steady::running::campbell::{Campbell, CampbellPoint, campbell};
use serde::Serialize;

use super::Arguments;
use super::elements::failure;
use super::map::axes;
use crate::diagnostics::Failure;
use crate::loudness::Loudness;
use crate::progress::CountBar;
use crate::standard_output;

/// What is told of every mode.
const PARTS: [&str; 5] = [
    "frequency",
    "growth",
    "damping_ratio",
    "pulley_share",
    "similarity",
];

/// What `--json` prints and, without the rows, `summary.json` holds.
#[derive(Serialize)]
struct Told<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    folder: Option<String>,
    title: &'a str,
    campbell: Diagram<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rows: Option<Vec<ToldRow>>,
}

#[derive(Clone, Serialize)]
struct Diagram<'a> {
    /// The field over which the modes are followed.
    key: &'a str,
    unit: &'a str,
    modes: u16,
    /// Names of the values of a row.
    columns: Vec<String>,
}

#[derive(Serialize)]
struct ToldRow {
    answer: &'static str,
    /// Null where there is none.
    values: Vec<Option<f64>>,
}

/// Solves, records and tells.
pub fn steady(arguments: &Arguments, loudness: Loudness) -> Result<(), Failure> {
    let file = arguments.source.open()?;
    let axes = axes(&file.drive, &arguments.map)?;
    let [axis] = axes.as_slice() else {
        return Err(Failure::Argument {
            message: format!("`--modes` follows modes over one field, not {}", axes.len()),
            help: "give one `--map`, such as `pulley.driver.speed=10:120:12`".into(),
        });
    };
    let folder = arguments
        .out
        .as_deref()
        .map(|place| Folder::new(place, arguments.force))
        .transpose()
        .map_err(Failure::Folder)?;
    let bar = CountBar::new(axis.values.len(), loudness.shows_progress());
    let found = campbell(&file.drive, axis, arguments.modes.into(), || {
        bar.done("values");
    });
    bar.finish();
    let found = found.map_err(|error| failure(error, &file))?;
    let columns = columns(&found, arguments.modes);
    let csv = csv(&found, &columns);
    let diagram = Diagram {
        key: &found.key,
        unit: found.unit,
        modes: arguments.modes,
        columns,
    };
    let told = |folder, rows| Told {
        folder,
        title: &file.drive.title,
        campbell: diagram.clone(),
        rows,
    };
    if let Some(folder) = folder {
        let written = folder
            .text("drive.toml", &input::to_toml(&file.drive))
            .and_then(|()| folder.json("summary.json", &told(None, None)))
            .and_then(|()| folder.text("campbell.csv", &csv))
            .and_then(|()| folder.finish());
        written.map_err(Failure::Record)?;
    }
    let folder = (arguments.out.as_ref()).map(|place| place.display().to_string());
    if arguments.json {
        let rows = found.points.iter().map(|point| ToldRow {
            answer: point.answer,
            values: values(point),
        });
        return standard_output::print_json(&told(folder, Some(rows.collect())));
    }
    match folder {
        None => standard_output::print(&csv),
        Some(_) if loudness.quiet => Ok(()),
        Some(folder) => standard_output::print(&format!(
            "{} modes at {} values of {}\nResults: {folder}\n",
            arguments.modes,
            found.points.len(),
            found.key
        )),
    }
}

fn columns(found: &Campbell, modes: u16) -> Vec<String> {
    let modes = (1..=modes).flat_map(|k| PARTS.map(|part| format!("mode_{k}.{part}")));
    std::iter::once(found.key.clone()).chain(modes).collect()
}

/// In the order of [`columns`]; frequencies in Hz.
fn values(point: &CampbellPoint) -> Vec<Option<f64>> {
    let modes = point.modes.iter().flat_map(|mode| match mode {
        Some(mode) => [
            mode.frequency / TAU,
            mode.growth,
            mode.damping_ratio,
            mode.pulley_share,
            mode.similarity,
        ]
        .map(Some),
        None => [None; PARTS.len()],
    });
    std::iter::once(Some(point.value)).chain(modes).collect()
}

/// Comma-separated values: `answer`, then the columns; empty where there is no number.
fn csv(found: &Campbell, columns: &[String]) -> String {
    let mut text = format!("answer,{}\n", columns.join(","));
    for point in &found.points {
        text.push_str(point.answer);
        for value in values(point) {
            text.push(',');
            if let Some(value) = value {
                // Writing to a string cannot fail.
                let _ = write!(text, "{value}");
            }
        }
        text.push('\n');
    }
    text
}
