//! `hihna schema`: the JSON schema of drive files.

use clap::Args;

use crate::diagnostics::Failure;
use crate::standard_output;

/// Print the JSON schema of drive files, for editors and programs.
#[derive(Debug, Args)]
pub struct Arguments {}

/// Prints the schema.
pub fn schema(_: &Arguments) -> Result<(), Failure> {
    standard_output::print_json(&hihna::input::schema())
}
