//! Version and commit of the command, for `pxpl5 -V` and for the origin of every output.

pub(crate) use pxpl5::measure::program::VERSION;

/// Version and shortened commit, as shown to users.
pub(crate) const LONG_VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (commit ", env!("PXPL5_SHORT_COMMIT"), ")");

/// Returns the commit from which the command was built. Returns `None` if the build script found none.
///
/// `-modified` follows the commit if the sources differed from this commit when the command was compiled.
pub(crate) fn commit() -> Option<&'static str> {
    Some(commit_text()).filter(|commit| *commit != "unknown")
}

/// Returns the commit as text: `unknown` if the build script found none.
pub(crate) const fn commit_text() -> &'static str {
    env!("PXPL5_COMMIT")
}

/// Adds the commit to all reports of this process.
pub(crate) fn state_commit() {
    if let Some(commit) = commit() {
        pxpl5::measure::program::set_commit(commit);
    }
}
