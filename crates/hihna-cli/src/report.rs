//! `hihna report`: a result folder as one HTML page.

use std::path::PathBuf;

use clap::Args;

use crate::diagnostics::Failure;
use crate::standard_output;

/// Write `report.html` into a result folder of `hihna run`: drawing, tables, charts and, if the run kept frames, the
/// belt in motion. Of a folder of `hihna steady --map`: what was found over one field, or over two as contours; with
/// `--modes`, a Campbell diagram.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Result folder
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

/// Writes the page and says where it is.
pub fn report(arguments: &Arguments) -> Result<(), Failure> {
    let page = hihna_report::write(&arguments.folder)?;
    standard_output::print(&format!("{}\n", page.display()))
}
