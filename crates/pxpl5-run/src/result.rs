//! Results of a run: pictures, latencies, and statistics over a window of periods.

pub(crate) mod due;
pub(crate) mod latency;
pub(crate) mod outcome;
pub(crate) mod picture_ends;
pub(crate) mod result_window;
pub(crate) mod summary;
pub(crate) mod tally;
