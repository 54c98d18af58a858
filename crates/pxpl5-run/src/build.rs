//! Construction of the machine of a run: its programs, its head, and the dry run before it.

pub(crate) mod assembled;
pub(crate) mod assembly;
pub(crate) mod preparation;
