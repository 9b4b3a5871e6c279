//! A result folder read back.

use std::fs;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use thiserror::Error;

use crate::drive::Drive;
use crate::history::History;
use crate::input::{self, InputErrors};
use crate::observe::{EdgeRow, ProfileRow};

/// What a run left in its folder.
#[derive(Clone, Debug)]
pub struct Results {
    /// The drive as run.
    pub drive: Drive,
    /// `summary.json`, as it is: numbers that a run could not find are null.
    pub summary: serde_json::Value,
    /// One row per output time.
    pub history: History,
    /// The belt at the profile times.
    pub profile: Vec<ProfileRow>,
    /// The belt at the times of the frames; empty if the run kept none.
    pub frames: Vec<ProfileRow>,
    /// The edges of a belt of plates there; empty for other belts.
    pub edges: Vec<EdgeRow>,
}

/// A folder that holds no results of a run.
#[derive(Debug, Error)]
pub enum ReadError {
    /// A file is missing or not readable.
    #[error("cannot read {}: {cause}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: std::io::Error,
    },
    /// The drive of the folder is not valid.
    #[error("{} is not a valid drive file: {cause}", path.display())]
    Drive {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: Box<InputErrors>,
    },
    /// A file holds something else.
    #[error("{} does not hold what a run writes: {cause}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: String,
    },
}

impl Results {
    /// Reads the folder `dir` of `hihna run`.
    pub fn read(dir: &Path) -> Result<Self, ReadError> {
        let drive = dir.join("drive.toml");
        let text = read_text(&drive)?;
        let drive = input::parse(&drive.display().to_string(), &text, &[]).map_err(|cause| {
            ReadError::Drive {
                path: drive,
                cause: Box::new(cause),
            }
        })?;
        let summary = dir.join("summary.json");
        let summary = serde_json::from_str(&read_text(&summary)?)
            .map_err(|cause| content(&summary, &cause))?;
        Ok(Self {
            drive,
            summary,
            history: read_history(&dir.join("history.csv"))?,
            profile: read_rows(&dir.join("profile.csv"))?,
            frames: read_rows_if_there(&dir.join("frames.csv"))?,
            edges: read_rows_if_there(&dir.join("edges.csv"))?,
        })
    }

    /// The number of the summary at `path`, such as `["steady", "power_in"]`; NaN if there is none.
    #[must_use]
    pub fn number(&self, path: &[&str]) -> f64 {
        path.iter()
            .try_fold(&self.summary, |value, key| match value {
                serde_json::Value::Array(list) => list.get(key.parse::<usize>().ok()?),
                value => value.get(key),
            })
            .and_then(serde_json::Value::as_f64)
            .unwrap_or(f64::NAN)
    }
}

fn read_text(path: &Path) -> Result<String, ReadError> {
    fs::read_to_string(path).map_err(|cause| ReadError::Io {
        path: path.into(),
        cause,
    })
}

fn content(path: &Path, cause: &dyn std::fmt::Display) -> ReadError {
    ReadError::Content {
        path: path.into(),
        cause: cause.to_string(),
    }
}

fn open(path: &Path) -> Result<csv::Reader<fs::File>, ReadError> {
    let file = fs::File::open(path).map_err(|cause| ReadError::Io {
        path: path.into(),
        cause,
    })?;
    Ok(csv::Reader::from_reader(file))
}

fn read_rows<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, ReadError> {
    open(path)?
        .deserialize()
        .collect::<Result<_, _>>()
        .map_err(|cause| content(path, &cause))
}

fn read_rows_if_there<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, ReadError> {
    if path.exists() {
        read_rows(path)
    } else {
        Ok(Vec::new())
    }
}

fn read_history(path: &Path) -> Result<History, ReadError> {
    let mut reader = open(path)?;
    let header = reader.headers().map_err(|cause| content(path, &cause))?;
    let columns: Vec<String> = header.iter().map(str::to_owned).collect();
    let mut values = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|cause| content(path, &cause))?;
        for field in &record {
            // An empty field is a number that was not found.
            let number = if field.is_empty() {
                Ok(f64::NAN)
            } else {
                field.parse()
            };
            values.push(number.map_err(|cause| content(path, &cause))?);
        }
    }
    History::from_values(columns, values).ok_or_else(|| content(path, &"it has no columns"))
}
