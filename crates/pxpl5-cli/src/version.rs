//! Version and commit of the command, for `pxpl5 -V` and for the origin of every output.

pub(crate) use pxpl5::measure::program::VERSION;

pub(crate) const LONG_VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (commit ", env!("PXPL5_SHORT_COMMIT"), ")");

/// Returns the commit of the sources, or `None` if the build script found none.
///
/// The commit ends in `-modified` if the sources had uncommitted changes at compile time.
pub(crate) fn commit() -> Option<&'static str> {
    Some(commit_text()).filter(|commit| *commit != "unknown")
}

/// Returns the commit as text, or `unknown` if the build script found none.
pub(crate) const fn commit_text() -> &'static str {
    env!("PXPL5_COMMIT")
}

pub(crate) fn state_commit() {
    if let Some(commit) = commit() {
        pxpl5::measure::program::set_commit(commit);
    }
}
