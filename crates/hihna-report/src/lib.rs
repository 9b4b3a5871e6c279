//! A folder of results as one self-contained HTML page: drawing, tables, charts and an animation that
//! open without network; of a map of steady running, or a Campbell diagram, its charts. The heavy crates of the project live here, away from its core.

mod animation;
mod campbell;
mod charts;
mod distribution;
mod drawing;
mod headline;
mod inputs;
mod map;
mod packed;
mod page;
mod path;
mod series;
mod strip;
mod tables;

use std::fs;
use std::path::{Path, PathBuf};

use hihna::layout::{Layout, LayoutError};
use hihna::record::{ReadError, Results};
use thiserror::Error;

pub use drawing::drawing;
pub use tables::{Table, result_tables};

/// A report that could not be made.
#[derive(Debug, Error)]
pub enum ReportError {
    /// The folder holds no results of a run.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The drive of the folder has no path for its belt.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// The map has more dimensions than paper.
    #[error("a map over {count} fields with several values cannot be drawn: one or two can")]
    Axes {
        /// How many it has.
        count: usize,
    },
    /// The page could not be put together.
    #[error("cannot put the report together: {0}")]
    Template(#[from] askama::Error),
    /// A chart could not be encoded.
    #[error("cannot encode a chart: {0}")]
    Encode(#[from] serde_json::Error),
    /// The file system refused.
    #[error("cannot write {}: {cause}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: std::io::Error,
    },
}

/// The page of `results`.
pub fn html(results: &Results) -> Result<String, ReportError> {
    let layout = Layout::of(&results.drive)?;
    page::render(results, &layout)
}

/// The drive of `results` to scale, slip at the last profile time marked, as SVG.
pub fn result_drawing(results: &Results) -> Result<String, ReportError> {
    let layout = Layout::of(&results.drive)?;
    let speeds = page::speeds(results);
    let belt = page::last_profile(results);
    Ok(drawing(&results.drive, &layout, belt, &speeds))
}

/// Reads the folder `dir` of a run, of a map of steady running or of a Campbell diagram, and writes its `report.html`; returns where that is.
pub fn write(dir: &Path) -> Result<PathBuf, ReportError> {
    let page = if dir.join(campbell::FILE).exists() {
        campbell::page(dir)?
    } else if dir.join(map::FILE).exists() {
        map::page::map_page(&map::Map::read(dir)?)?
    } else {
        html(&Results::read(dir)?)?
    };
    let path = dir.join("report.html");
    // Whole or not at all: written beside its place, then renamed.
    let draft = dir.join(".report.html");
    fs::write(&draft, page)
        .and_then(|()| fs::rename(&draft, &path))
        .map_err(|cause| {
            // Half a page is nobody's; if it cannot be removed, the error says where it is.
            let _ = fs::remove_file(&draft);
            ReportError::Write {
                path: path.clone(),
                cause,
            }
        })?;
    Ok(path)
}
