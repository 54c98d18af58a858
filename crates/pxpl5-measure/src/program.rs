//! Version and commit of the running program, which each output of the program states as its origin.
//!
//! A library has no access to the commit from which it was built. Instead, a program states its own commit once, before
//! the first report. All outputs of the process then contain this commit.

use std::sync::OnceLock;

/// Version of the emulator.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

static COMMIT: OnceLock<&'static str> = OnceLock::new();

/// States the commit from which the running program was built. Later calls have no effect.
///
/// The commit has the form of Git: 40 hexadecimal digits. `-modified` follows if the sources differed from the commit.
pub fn set_commit(commit: &'static str) {
    // The first caller is the program itself. A second commit in one process would make its outputs contradictory.
    let _ = COMMIT.set(commit);
}

/// Returns the commit from which the running program was built. Returns `None` if the program did not state a commit.
pub fn commit() -> Option<&'static str> {
    COMMIT.get().copied()
}
