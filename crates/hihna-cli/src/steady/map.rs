//! `hihna steady --model fe --map`: a drive at many combinations of its numbers.

use std::fmt::Write;

use hihna::drive::Drive;
use hihna::input;
use hihna::record::Folder;
use hihna::steady::running::map::{Axis, Map, map};
use serde::Serialize;

use super::Arguments;
use super::elements::find_fields;
use crate::diagnostics::Failure;
use crate::standard_output;

mod table;

/// Most points of a map.
const MOST_POINTS: usize = 1_000_000;

/// What `--json` prints.
#[derive(Serialize)]
struct Told<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    folder: Option<String>,
    title: &'a str,
    /// Names of the values of a row.
    columns: &'a [String],
    rows: Vec<ToldRow>,
}

#[derive(Serialize)]
struct ToldRow {
    answer: &'static str,
    /// Null where there is none.
    values: Vec<Option<f64>>,
}

/// Solves, records and tells.
pub fn steady(arguments: &Arguments) -> Result<(), Failure> {
    let file = arguments.source.open()?;
    let axes = axes(&file.drive, &arguments.map)?;
    let folder = arguments
        .out
        .as_deref()
        .map(|place| Folder::new(place, arguments.force))
        .transpose()
        .map_err(Failure::Folder)?;
    let found = map(&file.drive, &axes);
    if let Some(folder) = folder {
        let written = folder
            .text("drive.toml", &input::to_toml(&file.drive))
            .and_then(|()| folder.text("map.csv", &table::csv(&found)))
            .and_then(|()| folder.bytes("map.parquet", &table::parquet(&found)?))
            .and_then(|()| folder.finish());
        written.map_err(Failure::Record)?;
    }
    let folder = arguments
        .out
        .as_ref()
        .map(|place| place.display().to_string());
    if arguments.json {
        return standard_output::print_json(&Told {
            folder,
            title: &file.drive.title,
            columns: &found.columns,
            rows: rows(&found),
        });
    }
    match folder {
        Some(folder) => standard_output::print(&in_words(&found, &folder)),
        None => standard_output::print(&table::csv(&found)),
    }
}

fn rows(found: &Map) -> Vec<ToldRow> {
    let told = found.rows.iter().map(|row| ToldRow {
        answer: row.answer,
        values: (row.values.iter())
            .map(|value| value.is_finite().then_some(*value))
            .collect(),
    });
    told.collect()
}

fn in_words(found: &Map, folder: &str) -> String {
    let mut text = format!("{} points", found.rows.len());
    for answer in ["running", "gross-slip", "slack", "none"] {
        let count = found.rows.iter().filter(|row| row.answer == answer).count();
        if count > 0 {
            // Writing to a string cannot fail.
            let _ = write!(text, ", {count} {answer}");
        }
    }
    let _ = writeln!(text, "\nResults: {folder}");
    text
}

fn axes(drive: &Drive, given: &[String]) -> Result<Vec<Axis>, Failure> {
    let mut points = 1_usize;
    let axes = given
        .iter()
        .map(|text| {
            let axis = axis(drive, text)?;
            points = points.saturating_mul(axis.values.len());
            Ok(axis)
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    if points > MOST_POINTS {
        return Err(Failure::Argument {
            message: format!("the map has {points} points, more than {MOST_POINTS}"),
            help: "ask for fewer values".into(),
        });
    }
    Ok(axes)
}

fn axis(drive: &Drive, text: &str) -> Result<Axis, Failure> {
    let wrong = |what: &str| Failure::Argument {
        message: format!("`--map {text}`: {what}"),
        help: "give KEY=FROM:TO:COUNT in SI units, such as `pulley.driven.torque=-1:-20:20`".into(),
    };
    let (key, range) = text
        .split_once('=')
        .ok_or_else(|| wrong("there is no `=`"))?;
    let parts: Vec<_> = range.split(':').map(str::trim).collect();
    let [from, to, count] = parts[..] else {
        return Err(wrong("three parts between colons are needed"));
    };
    let number = |text: &str| {
        let value: Option<f64> = text.parse().ok();
        value
            .filter(|value| value.is_finite())
            .ok_or_else(|| wrong("FROM and TO must be numbers"))
    };
    let (from, to) = (number(from)?, number(to)?);
    let count: usize = count
        .parse()
        .map_err(|_| wrong("COUNT must be a whole number"))?;
    if count == 0 {
        return Err(wrong("COUNT must be at least 1"));
    }
    let last = count.max(2) - 1;
    let values = (0..count).map(|i| from + (to - from) * i as f64 / last as f64);
    let mut fields = find_fields(drive, &[key.trim().to_owned()])?;
    let field = fields.pop().ok_or_else(|| wrong("the field is missing"))?;
    Ok(Axis {
        field,
        values: values.collect(),
    })
}
