//! Where a command takes its drive from: a file or the built-in one, with overrides.

use std::path::{Path, PathBuf};

use clap::Args;
use hihna::drive::Drive;
use hihna::input::{DriveFile, InputErrors, Override};

const BUILT_IN: &str = include_str!("../../../examples/two_pulley.toml");
const BUILT_IN_NAME: &str = "two_pulley.toml";

/// The drive of a command.
#[derive(Debug, Args)]
pub struct DriveSource {
    /// Drive file; without one the built-in two-pulley drive is used
    #[arg(value_name = "DRIVE.toml")]
    file: Option<PathBuf>,

    /// Replace a field of the drive file: `--set belt.elements=30`, `--set pulley.driven.inertia=0.2`,
    /// `--set "belt.length=1.27 m"`. May be given several times
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
}

impl DriveSource {
    /// Reads and checks the drive.
    pub fn load(&self) -> Result<Drive, InputErrors> {
        self.open().map(|file| file.drive)
    }

    /// Reads and checks the drive and keeps its text for messages.
    pub fn open(&self) -> Result<DriveFile, InputErrors> {
        let overrides = self
            .overrides
            .iter()
            .map(|text| text.parse())
            .collect::<Result<Vec<Override>, _>>()?;
        match &self.file {
            Some(file) => DriveFile::load(file, &overrides),
            None => DriveFile::parse(BUILT_IN_NAME, BUILT_IN, &overrides),
        }
    }

    /// Folder for results where the user names none: `drive-result` for `drive.toml`, in the current folder.
    pub fn default_folder(&self) -> PathBuf {
        let file = self.file.as_deref().unwrap_or(Path::new(BUILT_IN_NAME));
        let mut name = file.file_stem().unwrap_or("drive".as_ref()).to_owned();
        name.push("-result");
        name.into()
    }
}
