//! The program `hihna`: belt drives from one text file.

mod check;
mod completions;
mod diagnostics;
mod drive_source;
mod loudness;
mod progress;
mod report;
mod run;
mod schema;
mod signals;
mod standard_output;
mod steady;
mod summary;
mod tables;
mod validate;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use hihna::quantities;

use loudness::Loudness;

/// Simulates belt drives that are described in one text file.
#[derive(Debug, Parser)]
#[command(name = "hihna", version, about, max_term_width = 100, after_help = AFTER_HELP)]
struct Program {
    #[command(subcommand)]
    command: Command,

    #[command(flatten)]
    loudness: Loudness,
}

const AFTER_HELP: &str = "\
Exit status: 0 done; 1 the run failed, its audit broke its tolerance or a validation failed; 2 the input or the arguments are wrong.";

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Arguments),
    Steady(steady::Arguments),
    Validate(validate::Arguments),
    Check(check::Arguments),
    Schema(schema::Arguments),
    Report(report::Arguments),
    Completions(completions::Arguments),
}

fn main() -> ExitCode {
    let Program { command, loudness } = Program::parse();
    loudness.start_logs();
    signals::survive_full_files();
    let json = match &command {
        Command::Run(arguments) => arguments.json,
        Command::Steady(arguments) => arguments.json,
        Command::Validate(arguments) => arguments.json,
        Command::Check(arguments) => arguments.json,
        Command::Schema(_) | Command::Report(_) | Command::Completions(_) => false,
    };
    let result = match command {
        Command::Run(arguments) => run::run(&arguments, loudness),
        Command::Steady(arguments) => steady::steady(&arguments, loudness),
        Command::Validate(arguments) => validate::validate(&arguments, loudness),
        Command::Check(arguments) => check::check(&arguments),
        Command::Schema(arguments) => schema::schema(&arguments),
        Command::Report(arguments) => report::report(&arguments),
        Command::Completions(arguments) => completions::completions(&arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            if let Some(answer) = failure.json().filter(|_| json) {
                // If this fails, too, the message on standard error is all that can be done.
                let _ = standard_output::print_json(&answer);
            }
            failure.print();
            failure.exit_code()
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn arguments_are_consistent() {
        super::Program::command().debug_assert();
    }
}
