//! How much the program says: progress, summary, logs.

use std::io;

use clap::Args;
use tracing_subscriber::EnvFilter;
use tracing_subscriber::filter::LevelFilter;

/// Options of all commands.
#[derive(Clone, Copy, Debug, Args)]
pub struct Loudness {
    /// Show neither progress nor summary
    #[arg(long, short, global = true)]
    pub quiet: bool,

    /// Tell what the solver does and what it cost, instead of a progress bar; RUST_LOG chooses finer
    #[arg(long, short, global = true, conflicts_with = "quiet")]
    pub verbose: bool,
}

impl Loudness {
    /// Whether a progress bar may be drawn: logs would tear it.
    pub fn shows_progress(self) -> bool {
        !self.quiet && !self.logs()
    }

    fn logs(self) -> bool {
        self.verbose || std::env::var_os(EnvFilter::DEFAULT_ENV).is_some()
    }

    /// Sends logs to standard error: those of the environment variable RUST_LOG, with `--verbose` and without it all
    /// from level `info` on.
    pub fn start_logs(self) {
        if !self.logs() {
            return;
        }
        let level = if self.verbose {
            LevelFilter::INFO
        } else {
            LevelFilter::ERROR
        };
        let filter = EnvFilter::builder()
            .with_default_directive(level.into())
            .from_env_lossy();
        tracing_subscriber::fmt()
            .with_env_filter(filter)
            .with_writer(io::stderr)
            .with_timer(tracing_subscriber::fmt::time::uptime())
            .with_ansi(false)
            .init();
    }
}
