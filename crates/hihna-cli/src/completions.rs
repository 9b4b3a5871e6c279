//! `hihna completions`: what a shell needs to complete the program's arguments.

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use crate::diagnostics::Failure;
use crate::standard_output;

/// Print the completion script of a shell.
///
/// For bash: `hihna completions bash > ~/.local/share/bash-completion/completions/hihna`
#[derive(Debug, Args)]
pub struct Arguments {
    /// The shell.
    shell: Shell,
}

/// Prints the script.
pub fn completions(arguments: &Arguments) -> Result<(), Failure> {
    let mut script = Vec::new();
    let mut program = crate::Program::command();
    clap_complete::generate(arguments.shell, &mut program, "hihna", &mut script);
    standard_output::print(&String::from_utf8_lossy(&script))
}
