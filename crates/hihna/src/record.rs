//! The result folder: written beside its place, then renamed, so that it is whole or not there.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::drive::Drive;
use crate::history::History;
use crate::input;
use crate::observe::ProfileRow;
use crate::simulate::Outcome;
use crate::summary::Summary;

/// A result folder that could not be written.
#[derive(Debug, Error)]
pub enum RecordError {
    /// The folder exists.
    #[error("the result folder {} exists already; choose another with --out or overwrite it with --force", path.display())]
    Exists {
        /// The folder.
        path: PathBuf,
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
    if dir.exists() && !overwrite {
        return Err(RecordError::Exists { path: dir.into() });
    }
    staging(dir).map(drop)
}

/// Writes `outcome` of `drive` to the folder `dir`.
pub fn write(
    dir: &Path,
    drive: &Drive,
    outcome: &Outcome,
    overwrite: bool,
) -> Result<(), RecordError> {
    if dir.exists() && !overwrite {
        return Err(RecordError::Exists { path: dir.into() });
    }
    let io_error = |cause| RecordError::Io {
        path: dir.into(),
        cause,
    };
    let folder = staging(dir)?;
    let place = |name: &str| folder.path().join(name);
    fs::write(place("drive.toml"), input::to_toml(drive)).map_err(io_error)?;
    let summary = Summary::new(drive, outcome);
    let mut text = serde_json::to_string_pretty(&summary).map_err(|cause| RecordError::Encode {
        file: "summary.json",
        cause: cause.into(),
    })?;
    text.push('\n');
    fs::write(place("summary.json"), text).map_err(io_error)?;
    write_history(&place("history.csv"), &outcome.history).map_err(|e| encode("history.csv", e, dir))?;
    write_profile(&place("profile.csv"), &outcome.profile).map_err(|e| encode("profile.csv", e, dir))?;

    if dir.exists() {
        // Keep the old folder until the new one stands in its place.
        let old = staging(dir)?;
        let aside = old.path().join("old");
        fs::rename(dir, &aside).map_err(io_error)?;
        if let Err(cause) = fs::rename(folder.path(), dir) {
            let _ = fs::rename(&aside, dir);
            return Err(io_error(cause));
        }
    } else {
        fs::rename(folder.path(), dir).map_err(io_error)?;
    }
    // The folder has moved: there is nothing left to clean up.
    let _ = folder.keep();
    Ok(())
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

fn encode(file: &'static str, error: csv::Error, dir: &Path) -> RecordError {
    match error.into_kind() {
        csv::ErrorKind::Io(cause) => RecordError::Io {
            path: dir.into(),
            cause,
        },
        other => RecordError::Encode {
            file,
            cause: format!("{other:?}").into(),
        },
    }
}

fn write_history(path: &Path, history: &History) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_path(path)?;
    writer.write_record(history.columns())?;
    for row in history.rows() {
        writer.serialize(row)?;
    }
    Ok(writer.flush()?)
}

fn write_profile(path: &Path, profile: &[ProfileRow]) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_path(path)?;
    for row in profile {
        writer.serialize(row)?;
    }
    Ok(writer.flush()?)
}
