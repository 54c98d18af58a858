//! Handler of Ctrl-C. It prints how far the command came and which results are kept, and ends with exit code 130.

use crate::terminal::print_error;
use indicatif::ProgressBar;
use std::sync::{Mutex, PoisonError};

/// Exit code of a command that was ended by Ctrl-C: 128 plus the number of the signal, as in shells.
const INTERRUPTED: i32 = 130;

/// The newest progress bar of the command, which also counts without a terminal.
static PROGRESS: Mutex<Option<ProgressBar>> = Mutex::new(None);
/// The results that an interruption keeps, and how to continue.
static KEPT: Mutex<Option<String>> = Mutex::new(None);

/// Installs the handler for this process. A process has one handler, so later calls have no effect.
pub(crate) fn listen() {
    let _ = ctrlc::set_handler(end);
}

pub(crate) fn follows(bar: &ProgressBar) {
    *PROGRESS.lock().unwrap_or_else(PoisonError::into_inner) = Some(bar.clone());
}

/// Sets the text about the results that an interruption keeps.
pub(crate) fn keeps(text: String) {
    *KEPT.lock().unwrap_or_else(PoisonError::into_inner) = Some(text);
}

fn end() {
    let bar = PROGRESS.lock().unwrap_or_else(PoisonError::into_inner).take();
    let after = bar.map_or_else(String::new, |bar| {
        format!(" after {} of {} {}", bar.position(), bar.length().unwrap_or_default(), bar.message())
    });
    let kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner).take();
    let kept = kept.unwrap_or_else(|| "nothing was written".to_owned());
    print_error(&format!("\npxpl5: interrupted{after}; {kept}\n"));
    std::process::exit(INTERRUPTED);
}
