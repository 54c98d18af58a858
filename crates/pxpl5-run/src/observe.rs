//! Observation of a run while it goes on, so that old records can be discarded.

pub(crate) mod observers;
pub(crate) mod window;
