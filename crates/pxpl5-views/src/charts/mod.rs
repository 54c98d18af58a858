//! Charts: numbers as SVG.
//!
//! | chart | shows |
//! |---|---|
//! | [`level_chart`] | speed against error of the levels of modelling |
//! | [`error_chart`] | error against time that a latency makes of a motion ([`LatencyCurve`]) |
//! | [`histogram`] | how the latencies of a run are spread |
//! | [`part_bar`] | where the latency of a run goes |

mod errors;
mod histogram;
mod levels;
mod parts;

pub use errors::{LatencyCurve, error_chart};
pub use histogram::histogram;
pub(crate) use histogram::histogram_element;
pub use levels::{SpeedAndError, level_chart};
pub use parts::{MeanPart, part_bar};
pub(crate) use parts::{colour_of_part, part_bar_element};
