//! The page of a Campbell diagram: modes followed over one field, from the folder of `hihna steady --modes --map`.

use std::fs;
use std::path::Path;

use hihna::input;
use hihna::quantities::significant;
use hihna::record::ReadError;
use plotly::common::{Line, Mode};
use plotly::layout::HoverMode;
use plotly::{Plot, Scatter};
use serde_json::Value;

use crate::ReportError;
use crate::charts::{Chart, dash, layout};
use crate::drawing::escaped;
use crate::map::page::{MapPage, render};

/// The file that makes a folder one of a Campbell diagram.
pub const FILE: &str = "campbell.csv";

/// What is drawn of every mode: the end of its column, what it is, its unit.
const QUANTITIES: [(&str, &str, &str); 4] = [
    ("frequency", "Natural frequency", "Hz"),
    ("growth", "Rate of growth", "1/s"),
    ("damping_ratio", "Damping ratio", "–"),
    (
        "pulley_share",
        "Part of the motion that is the pulleys'",
        "–",
    ),
];

/// Modes over one field.
struct Campbell {
    title: String,
    key: String,
    unit: String,
    modes: usize,
    columns: Vec<String>,
    answers: Vec<String>,
    /// Row by row, not a number where there is none.
    values: Vec<Vec<f64>>,
}

/// The page of the folder `dir`.
pub fn page(dir: &Path) -> Result<String, ReportError> {
    let campbell = read(dir)?;
    let (charts, plots) = (QUANTITIES.iter())
        .filter_map(|quantity| campbell.chart(quantity))
        .map(|chart| (chart.title, chart.plot))
        .unzip();
    render(MapPage {
        title: campbell.title.clone(),
        kind: "Campbell diagram",
        text: "Modes about steady running, each followed from value to value; a curve ends where its mode is not found again. A positive rate of growth is unstable.",
        facts: campbell.facts(),
        charts,
        plots,
    })
}

fn read(dir: &Path) -> Result<Campbell, ReadError> {
    let text = |name: &str| {
        let path = dir.join(name);
        fs::read_to_string(&path).map_err(|cause| ReadError::Io { path, cause })
    };
    let wrong = |name: &str, cause: String| ReadError::Content {
        path: dir.join(name),
        cause,
    };
    let drive = text("drive.toml")?;
    let place = dir.join("drive.toml").display().to_string();
    let drive = input::parse(&place, &drive, &[]).map_err(|cause| ReadError::Drive {
        path: dir.join("drive.toml"),
        cause: Box::new(cause),
    })?;
    let summary: Value = serde_json::from_str(&text("summary.json")?)
        .map_err(|error| wrong("summary.json", error.to_string()))?;
    let unit = summary["campbell"]["unit"].as_str().unwrap_or_default();
    let title = if drive.title.is_empty() {
        "Belt drive"
    } else {
        &drive.title
    };
    parse(&text(FILE)?, title, unit).map_err(|cause| wrong(FILE, cause))
}

fn parse(text: &str, title: &str, unit: &str) -> Result<Campbell, String> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().map_err(|error| error.to_string())?;
    let columns: Vec<String> = header.iter().skip(1).map(str::to_owned).collect();
    let key = columns.first().ok_or("there is no field")?.clone();
    let of_modes = |name: &&String| name.starts_with("mode_") && name.ends_with(".frequency");
    let modes = columns.iter().filter(of_modes).count();
    if modes == 0 {
        return Err("there is no mode".to_owned());
    }
    let (mut answers, mut values) = (Vec::new(), Vec::new());
    for record in reader.records() {
        let record = record.map_err(|error| error.to_string())?;
        let number = |cell: &str| match cell {
            "" => Ok(f64::NAN),
            cell => cell
                .parse()
                .map_err(|_| format!("`{cell}` is not a number")),
        };
        answers.push(record[0].to_owned());
        values.push(
            (record.iter().skip(1))
                .map(number)
                .collect::<Result<_, _>>()?,
        );
    }
    Ok(Campbell {
        title: title.to_owned(),
        key,
        unit: unit.to_owned(),
        modes,
        columns,
        answers,
        values,
    })
}

impl Campbell {
    /// A curve for each mode; nothing if no mode has this quantity anywhere.
    fn chart(&self, (end, title, unit): &(&str, &str, &str)) -> Option<Chart> {
        let x: Vec<f64> = self.values.iter().map(|row| row[0]).collect();
        let mut plot = Plot::new();
        let mut found = false;
        for mode in 1..=self.modes {
            let name = format!("mode_{mode}.{end}");
            let Some(column) = self.columns.iter().position(|known| *known == name) else {
                continue;
            };
            let value = |row: &Vec<f64>| row.get(column).copied().filter(|value| value.is_finite());
            let y: Vec<Option<f64>> = self.values.iter().map(value).collect();
            found |= y.iter().any(Option::is_some);
            plot.add_trace(
                Scatter::new(x.clone(), y)
                    .name(format!("mode {mode}"))
                    .mode(Mode::LinesMarkers)
                    .line(Line::new().width(1.6).dash(dash(mode - 1))),
            );
        }
        let field_unit = if self.unit.is_empty() {
            "–"
        } else {
            &self.unit
        };
        let field = escaped(&format!("{} [{field_unit}]", self.key));
        let axis = format!("{title} [{unit}]");
        plot.set_layout(
            layout(&field, &escaped(&axis), self.modes > 1).hover_mode(HoverMode::Closest),
        );
        found.then_some(Chart {
            title: axis,
            plot,
            ranges: String::new(),
        })
    }

    fn facts(&self) -> Vec<[String; 2]> {
        let finite = || {
            self.values
                .iter()
                .map(|row| row[0])
                .filter(|x| x.is_finite())
        };
        let ends = [finite().reduce(f64::min), finite().reduce(f64::max)]
            .map(|end| significant(end.unwrap_or(f64::NAN)));
        let range = format!(
            "{} values from {} to {}",
            self.values.len(),
            ends[0],
            ends[1]
        );
        let running = self.answers.iter().filter(|answer| *answer == "running");
        vec![
            [
                self.key.clone(),
                format!("{range} {}", self.unit).trim_end().to_owned(),
            ],
            ["Modes followed".to_owned(), self.modes.to_string()],
            [
                "Values at which the drive runs".to_owned(),
                running.count().to_string(),
            ],
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "answer,pulley.driver.speed,mode_1.frequency,mode_1.growth,mode_2.frequency,mode_2.growth\n\
                         running,10,7.8,-0.1,31,-0.2\n\
                         gross-slip,20,,,,\n";

    #[test]
    fn every_mode_has_a_curve() {
        let campbell = parse(TABLE, "Drive", "rad/s").unwrap();
        assert_eq!(
            (campbell.modes, campbell.key.as_str()),
            (2, "pulley.driver.speed")
        );
        let chart = campbell.chart(&QUANTITIES[0]).unwrap();
        let told = chart.plot.to_json();
        assert!(
            told.contains("mode 2") && told.contains("[rad/s]"),
            "{told}"
        );
        assert!(
            campbell.chart(&QUANTITIES[2]).is_none(),
            "there is no such column"
        );
        assert_eq!(campbell.facts()[2][1], "1");
    }

    #[test]
    fn other_tables_are_refused() {
        assert!(parse("answer,x\nrunning,1\n", "", "").is_err());
        assert!(parse("answer,x,mode_1.frequency\nrunning,1,much\n", "", "").is_err());
        assert!(parse("", "", "").is_err());
    }
}
