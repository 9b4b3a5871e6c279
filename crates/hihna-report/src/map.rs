//! A map of steady running, read from the folder of `hihna steady --map`.

mod charts;
pub mod page;

use std::fs;
use std::path::Path;

use hihna::drive::Drive;
use hihna::input::{self, NumberField};
use hihna::record::ReadError;

/// The file that makes a folder one of a map.
pub const FILE: &str = "map.csv";

/// First column behind those of the fields.
const FIRST_RESULT: &str = "speed_loss";

/// What a map found.
pub struct Map {
    pub drive: Drive,
    /// The fields that take several values, in the order of the map.
    pub axes: Vec<Axis>,
    /// The fields with a single value, and that.
    pub fixed: Vec<(Axis, f64)>,
    columns: Vec<String>,
    rows: Vec<Row>,
}

/// A field of the drive and its values.
pub struct Axis {
    pub key: String,
    /// SI unit, empty for ratios.
    pub unit: &'static str,
    column: usize,
    /// Rising.
    pub values: Vec<f64>,
}

struct Row {
    answer: String,
    /// By column; not a number where there is none.
    values: Vec<f64>,
}

impl Axis {
    /// Key and unit, as charts name it.
    pub fn title(&self) -> String {
        let unit = if self.unit.is_empty() {
            "–"
        } else {
            self.unit
        };
        format!("{} [{unit}]", self.key)
    }

    /// Which of its values a row has.
    fn place(&self, row: &Row) -> Option<usize> {
        let value = row.values[self.column];
        self.values
            .binary_search_by(|known| known.total_cmp(&value))
            .ok()
    }
}

impl Map {
    /// Reads the folder `dir`.
    pub fn read(dir: &Path) -> Result<Self, ReadError> {
        let path = dir.join("drive.toml");
        let text = fs::read_to_string(&path).map_err(|cause| ReadError::Io {
            path: path.clone(),
            cause,
        })?;
        let drive = input::parse(&path.display().to_string(), &text, &[]).map_err(|cause| {
            ReadError::Drive {
                path,
                cause: Box::new(cause),
            }
        })?;
        let path = dir.join(FILE);
        let content = |cause: String| ReadError::Content {
            path: path.clone(),
            cause,
        };
        let text = fs::read_to_string(&path).map_err(|cause| ReadError::Io {
            path: path.clone(),
            cause,
        })?;
        Self::parse(drive, &text).map_err(content)
    }

    fn parse(drive: Drive, text: &str) -> Result<Self, String> {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let header = reader.headers().map_err(|error| error.to_string())?;
        let columns: Vec<String> = header.iter().skip(1).map(str::to_owned).collect();
        let fields = (columns.iter().position(|name| name == FIRST_RESULT))
            .ok_or_else(|| format!("there is no column `{FIRST_RESULT}`"))?;
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|error| error.to_string())?;
            let number = |cell: &str| match cell {
                "" => Ok(f64::NAN),
                cell => cell
                    .parse()
                    .map_err(|_| format!("`{cell}` is not a number")),
            };
            rows.push(Row {
                answer: record[0].to_owned(),
                values: record
                    .iter()
                    .skip(1)
                    .map(number)
                    .collect::<Result<_, _>>()?,
            });
        }
        let (mut axes, mut fixed) = (Vec::new(), Vec::new());
        for (column, key) in columns.iter().take(fields).enumerate() {
            let mut values: Vec<f64> = rows.iter().map(|row| row.values[column]).collect();
            values.sort_by(f64::total_cmp);
            values.dedup_by(|a, b| a.to_bits() == b.to_bits());
            let axis = Axis {
                key: key.clone(),
                unit: NumberField::find(&drive, key).map_or("", |field| field.unit),
                column,
                values,
            };
            match axis.values[..] {
                [value] => fixed.push((axis, value)),
                _ => axes.push(axis),
            }
        }
        Ok(Self {
            drive,
            axes,
            fixed,
            columns,
            rows,
        })
    }

    /// Number of points with this answer.
    pub fn count(&self, answer: &str) -> usize {
        self.rows.iter().filter(|row| row.answer == answer).count()
    }

    fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drive() -> Drive {
        let text = include_str!("../../../examples/two_pulley.toml");
        input::parse("drive", text, &[]).unwrap()
    }

    #[test]
    fn axes_are_the_fields_that_vary() {
        let text = "answer,pulley.driven.torque,belt.width,belt.elements,speed_loss,overload\n\
                    running,-1,0.01,20,0.1,\n\
                    running,-1,0.02,20,0.2,\n\
                    gross-slip,-3,0.01,20,,1.5\n\
                    running,-3,0.02,20,0.4,\n";
        let map = Map::parse(drive(), text).unwrap();
        let titles: Vec<_> = map.axes.iter().map(Axis::title).collect();
        assert_eq!(titles, ["pulley.driven.torque [N m]", "belt.width [m]"]);
        assert_eq!(map.axes[0].values, [-3.0, -1.0]);
        assert_eq!(map.fixed.len(), 1);
        assert_eq!((map.count("running"), map.count("gross-slip")), (3, 1));
        assert_eq!(map.axes[0].place(&map.rows[2]), Some(0));
    }

    #[test]
    fn other_tables_are_refused() {
        assert!(Map::parse(drive(), "time,speed\n1,2\n").is_err());
        assert!(Map::parse(drive(), "answer,speed_loss\nrunning,much\n").is_err());
        assert!(Map::parse(drive(), "answer,speed_loss\nrunning\n").is_err());
    }
}
