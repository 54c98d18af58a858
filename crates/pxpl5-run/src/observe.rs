//! Observation of a run while it goes on, so that old records can be discarded.

pub(crate) mod observed_run;
pub(crate) mod observers;
pub(crate) mod window;
