//! Signals that ask the program to stop, or tell it that a file may not grow.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
#[cfg(not(unix))]
use std::sync::atomic::Ordering;

use crate::diagnostics::Failure;

/// Makes a file that may not grow any more (`ulimit -f`) an error of whoever writes it, who then removes what is
/// half-written; by itself the system kills the program.
pub fn survive_full_files() {
    #[cfg(unix)]
    {
        // Without it writing goes on as it did: a limit then ends the program.
        let heard = Arc::new(AtomicBool::new(false));
        let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, heard);
    }
}

/// A flag that Ctrl-C, and where there is one a request to terminate, raises.
pub fn interrupted() -> Result<Arc<AtomicBool>, Failure> {
    let flag = Arc::new(AtomicBool::new(false));
    #[cfg(unix)]
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
        signal_hook::flag::register(signal, Arc::clone(&flag)).map_err(Failure::Signal)?;
    }
    #[cfg(not(unix))]
    {
        let raised = Arc::clone(&flag);
        ctrlc::set_handler(move || raised.store(true, Ordering::Relaxed))
            .map_err(|error| Failure::Signal(std::io::Error::other(error)))?;
    }
    Ok(flag)
}
