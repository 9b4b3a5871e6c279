//! The result folder: written beside its place, then renamed, so that it is whole or not there.

mod read;
mod vtk;

use std::cell::OnceCell;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;
use thiserror::Error;

use crate::drive::Drive;
use crate::input;
use crate::simulate::Outcome;
use crate::summary::Summary;

pub use read::{ReadError, Results};

/// A result folder that could not be written.
#[derive(Debug, Error)]
pub enum RecordError {
    /// The folder exists.
    #[error("the result folder {} exists already; choose another with --out or overwrite it with --force", path.display())]
    Exists {
        /// The folder.
        path: PathBuf,
    },
    /// What stands there is not a result folder.
    #[error("{} is not a folder of results alone, so --force does not replace it; choose another with --out", path.display())]
    NotResults {
        /// The place.
        path: PathBuf,
    },
    /// The file system refused twice: the old results could not be put back.
    #[error("cannot write the result folder: {cause}; the results that stood in its place are now in {}", aside.display())]
    Stranded {
        /// Where the old results are.
        aside: PathBuf,
        /// Why.
        cause: io::Error,
    },
    /// The file system refused.
    #[error("cannot write the result folder {}: {cause}; choose another place with --out", path.display())]
    Io {
        /// The folder.
        path: PathBuf,
        /// Why.
        cause: io::Error,
    },
    /// The files could not be encoded.
    #[error("cannot write {file}: {cause}")]
    Encode {
        /// The file.
        file: &'static str,
        /// Why.
        cause: Box<dyn std::error::Error + Send + Sync>,
    },
}

/// Checks that `dir` can be written, before a run is spent on it.
pub fn check(dir: &Path, overwrite: bool) -> Result<(), RecordError> {
    Folder::new(dir, overwrite).map(drop)
}

/// What a result folder is to be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Replaces a result folder that stands in its place.
    pub overwrite: bool,
    /// Adds the frames as files for ParaView.
    pub vtk: bool,
}

/// Writes `outcome` of `drive` to the folder `dir`.
pub fn write(
    dir: &Path,
    drive: &Drive,
    outcome: &Outcome,
    options: Options,
) -> Result<(), RecordError> {
    let folder = Folder::new(dir, options.overwrite)?;
    folder.text("drive.toml", &input::to_toml(drive))?;
    folder.json("summary.json", &Summary::new(drive, outcome))?;
    folder.csv("history.csv", |writer| {
        writer.write_record(outcome.history.columns())?;
        outcome
            .history
            .rows()
            .try_for_each(|row| writer.serialize(row))
    })?;
    folder.rows("profile.csv", &outcome.profile)?;
    if !outcome.frames.is_empty() {
        folder.rows("frames.csv", &outcome.frames)?;
        if !outcome.edges.is_empty() {
            folder.rows("edges.csv", &outcome.edges)?;
        }
        if options.vtk {
            vtk::write(&folder, drive, outcome)?;
        }
    }
    folder.finish()
}

/// A result folder in the making. From its first file on they stand in a hidden folder beside its place, until
/// [`Folder::finish`]; dropped before that, it leaves nothing. What is computed before the first file may be
/// interrupted, and nothing is left either.
#[derive(Debug)]
pub struct Folder {
    place: PathBuf,
    overwrite: bool,
    files: OnceCell<tempfile::TempDir>,
}

impl Folder {
    /// An empty folder that is to stand at `place`, where it can be made; there may be one already if `overwrite`.
    pub fn new(place: &Path, overwrite: bool) -> Result<Self, RecordError> {
        // The working directory itself may be moved aside: no relative path survives that.
        let place = std::path::absolute(place).map_err(|cause| RecordError::Io {
            path: place.into(),
            cause,
        })?;
        check_free(&place, overwrite)?;
        drop(staging(&place)?);
        Ok(Self {
            files: OnceCell::new(),
            place,
            overwrite,
        })
    }

    /// Where the files stand.
    fn files(&self) -> Result<&Path, RecordError> {
        if self.files.get().is_none() {
            // It is not set twice: nobody else has this cell.
            let _ = self.files.set(staging(&self.place)?);
        }
        Ok(self
            .files
            .get()
            .map_or(&self.place, tempfile::TempDir::path))
    }

    /// Adds a file of text.
    pub fn text(&self, name: &str, text: &str) -> Result<(), RecordError> {
        self.bytes(name, text.as_bytes())
    }

    /// Adds a file.
    pub fn bytes(&self, name: &str, bytes: &[u8]) -> Result<(), RecordError> {
        fs::write(self.files()?.join(name), bytes).map_err(|cause| self.refused(cause))
    }

    /// Adds a JSON file.
    pub fn json(&self, name: &'static str, value: &impl Serialize) -> Result<(), RecordError> {
        let text = serde_json::to_string_pretty(value).map_err(|cause| RecordError::Encode {
            file: name,
            cause: cause.into(),
        })?;
        self.text(name, &(text + "\n"))
    }

    /// Adds a CSV file whose columns are the fields of its rows.
    pub fn rows(&self, name: &'static str, rows: &[impl Serialize]) -> Result<(), RecordError> {
        self.csv(name, |writer| {
            rows.iter().try_for_each(|row| writer.serialize(row))
        })
    }

    /// Puts the folder in its place, whole.
    pub fn finish(self) -> Result<(), RecordError> {
        check_free(&self.place, self.overwrite)?;
        let (place, files) = (&self.place, self.files()?);
        if place.exists() {
            // Keep the old folder until the new one stands in its place.
            let old = staging(place)?;
            let aside = old.path().join("old");
            fs::rename(place, &aside).map_err(|cause| self.refused(cause))?;
            if let Err(cause) = fs::rename(files, place) {
                if fs::rename(&aside, place).is_err() {
                    // Not lost: the old results stay where they are.
                    let _ = old.keep();
                    return Err(RecordError::Stranded { aside, cause });
                }
                return Err(self.refused(cause));
            }
        } else {
            fs::rename(files, place).map_err(|cause| self.refused(cause))?;
        }
        // The folder has moved: there is nothing left to clean up.
        if let Some(files) = self.files.into_inner() {
            let _ = files.keep();
        }
        Ok(())
    }

    fn csv(
        &self,
        name: &'static str,
        write: impl FnOnce(&mut csv::Writer<fs::File>) -> Result<(), csv::Error>,
    ) -> Result<(), RecordError> {
        let written = csv::Writer::from_path(self.files()?.join(name)).and_then(|mut writer| {
            write(&mut writer)?;
            Ok(writer.flush()?)
        });
        written.map_err(|error| match error.into_kind() {
            csv::ErrorKind::Io(cause) => self.refused(cause),
            other => RecordError::Encode {
                file: name,
                cause: format!("{other:?}").into(),
            },
        })
    }

    fn refused(&self, cause: io::Error) -> RecordError {
        RecordError::Io {
            path: self.place.clone(),
            cause,
        }
    }
}

fn check_free(place: &Path, overwrite: bool) -> Result<(), RecordError> {
    if !place.exists() && !place.is_symlink() {
        return Ok(());
    }
    if !overwrite {
        return Err(RecordError::Exists { path: place.into() });
    }
    if !is_result_folder(place) {
        return Err(RecordError::NotResults { path: place.into() });
    }
    Ok(())
}

/// Files that a result folder may hold, beside those of [`vtk`].
const FILES: [&str; 11] = [
    "drive.toml",
    "summary.json",
    "history.csv",
    "profile.csv",
    "frames.csv",
    "edges.csv",
    "belt.pvd",
    "report.html",
    "map.csv",
    "map.parquet",
    "campbell.csv",
];

/// Whether `place` is a folder (no link to one) with nothing in it but results.
fn is_result_folder(place: &Path) -> bool {
    let is_folder = place.symlink_metadata().is_ok_and(|found| found.is_dir());
    is_folder
        && fs::read_dir(place).is_ok_and(|mut entries| {
            entries.all(|entry| {
                entry.is_ok_and(|entry| {
                    let found = entry.file_name();
                    FILES.iter().any(|name| found == *name) || vtk::is_frame(&found)
                })
            })
        })
}

/// A fresh folder beside `dir`, on the same file system, that vanishes unless kept.
fn staging(dir: &Path) -> Result<tempfile::TempDir, RecordError> {
    let parent = match dir.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".hihna-");
    #[cfg(unix)]
    {
        // As any other folder the user makes, not private to them.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o777));
    }
    builder.tempdir_in(parent).map_err(|cause| RecordError::Io {
        path: dir.into(),
        cause,
    })
}
