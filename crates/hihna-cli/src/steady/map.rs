//! `hihna steady --model fe --map`: a drive at many combinations of its numbers.

use std::fmt::Write;

use hihna::drive::Drive;
use hihna::input;
use hihna::record::Folder;
use hihna::steady::running::map::{Axis, Map, Row, map};
use hihna::summary::Named;
use serde::Serialize;

use super::Arguments;
use super::elements::{failure, find_fields};
use crate::diagnostics::{Failure, print_warning};
use crate::loudness::Loudness;
use crate::progress::CountBar;
use crate::standard_output;

mod table;

/// Most points of a map.
const MOST_POINTS: usize = 1_000_000;

/// What `--json` prints and, without the rows, `summary.json` holds.
#[derive(Serialize)]
struct Told<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    folder: Option<String>,
    title: &'a str,
    map: ToldMap<'a>,
    /// Names of the values of a row.
    columns: &'a [String],
    #[serde(skip_serializing_if = "Option::is_none")]
    rows: Option<Vec<ToldRow>>,
}

/// What the rows run over.
#[derive(Clone, Serialize)]
struct ToldMap<'a> {
    /// The last one fastest.
    axes: Vec<ToldAxis<'a>>,
    /// Number of points by answer.
    answers: Named<usize>,
}

#[derive(Clone, Serialize)]
struct ToldAxis<'a> {
    /// Path of the field, which is the name of its column.
    key: &'a str,
    unit: &'a str,
    /// SI.
    values: &'a [f64],
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
    let folder = arguments
        .out
        .as_deref()
        .map(|place| Folder::new(place, arguments.force))
        .transpose()
        .map_err(Failure::Folder)?;
    let points = axes.iter().map(|axis| axis.values.len()).product();
    let bar = CountBar::new(points, loudness.shows_progress());
    let found = map(&file.drive, &axes, || bar.done("points"));
    bar.finish();
    let answers = answers(&found);
    let mut without = found.rows.iter().filter(|row| row.error.is_some());
    let count = without.clone().count();
    if let Some(Row {
        values,
        error: Some(error),
        ..
    }) = without.next()
    {
        if count == found.rows.len() {
            return Err(failure(error.clone(), &file));
        }
        let place: Vec<_> = (axes.iter().zip(values))
            .map(|(axis, value)| format!("{} = {value} {}", axis.field.key, axis.field.unit))
            .collect();
        print_warning(&format!(
            "{count} of {} points have no answer; the first, {}: {error}",
            found.rows.len(),
            place.join(", ").trim_end(),
        ));
    }
    let told = |folder, rows| Told {
        folder,
        title: &file.drive.title,
        map: ToldMap {
            axes: (axes.iter())
                .map(|axis| ToldAxis {
                    key: &axis.field.key,
                    unit: axis.field.unit,
                    values: &axis.values,
                })
                .collect(),
            answers: answers.clone(),
        },
        columns: &found.columns,
        rows,
    };
    if let Some(folder) = folder {
        let written = folder
            .text("drive.toml", &input::to_toml(&file.drive))
            .and_then(|()| folder.json("summary.json", &told(None, None)))
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
        return standard_output::print_json(&told(folder, Some(rows(&found))));
    }
    match folder {
        Some(_) if loudness.quiet => Ok(()),
        Some(folder) => standard_output::print(&in_words(found.rows.len(), &answers, &folder)),
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

/// How many points have which answer, of the answers that there are.
fn answers(found: &Map) -> Named<usize> {
    let count = |answer| found.rows.iter().filter(|row| row.answer == answer).count();
    let all =
        ["running", "gross-slip", "slack", "none"].map(|answer| (answer.to_owned(), count(answer)));
    Named(all.into_iter().filter(|(_, count)| *count > 0).collect())
}

fn in_words(points: usize, answers: &Named<usize>, folder: &str) -> String {
    let mut text = format!("{points} points");
    for (answer, count) in &answers.0 {
        // Writing to a string cannot fail.
        let _ = write!(text, ", {count} {answer}");
    }
    let _ = writeln!(text, "\nResults: {folder}");
    text
}

/// The axes that the user gives.
pub(super) fn axes(drive: &Drive, given: &[String]) -> Result<Vec<Axis>, Failure> {
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
        return Err(too_many(points));
    }
    for (i, axis) in axes.iter().enumerate() {
        if axes[..i].iter().any(|other| other.field == axis.field) {
            return Err(Failure::Argument {
                message: format!("`{}` has two ranges", axis.field.key),
                help: "give every field once".into(),
            });
        }
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
        .ok_or_else(|| wrong("there is no `=`; a drive file goes before `--map`"))?;
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
    if count > MOST_POINTS {
        return Err(too_many(count));
    }
    let last = count.max(2) - 1;
    let values = (0..count).map(|i| from + (to - from) * i as f64 / last as f64);
    let mut fields = find_fields(drive, &[full_key(drive, key.trim())?])?;
    let field = fields.pop().ok_or_else(|| wrong("the field is missing"))?;
    let values: Vec<f64> = values.collect();
    // Bounds are intervals: what the ends may be, all between may.
    for end in [values.first(), values.last()].into_iter().flatten() {
        field
            .check(*end)
            .map_err(|error| wrong(&error.to_string()))?;
    }
    Ok(Axis { field, values })
}

fn too_many(points: usize) -> Failure {
    Failure::Argument {
        message: format!("the map has {points} points, more than {MOST_POINTS}"),
        help: "ask for fewer values".into(),
    }
}

/// `speed` is that of the driver, `torque` that of the pulley that is none, where there is but one.
fn full_key(drive: &Drive, key: &str) -> Result<String, Failure> {
    let driver = match key {
        "speed" => true,
        "torque" => false,
        _ => return Ok(key.to_owned()),
    };
    let names: Vec<&str> = (drive.pulley.iter())
        .filter(|pulley| pulley.is_driver() == driver)
        .map(|pulley| pulley.name.as_str())
        .collect();
    match names[..] {
        [name] => Ok(format!("pulley.{name}.{key}")),
        _ => Err(Failure::Argument {
            message: format!("`{key}` could be that of {} pulleys", names.len()),
            help: format!(
                "name one: {}",
                (names.iter())
                    .map(|name| format!("`pulley.{name}.{key}`"))
                    .collect::<Vec<_>>()
                    .join(", ")
            ),
        }),
    }
}
