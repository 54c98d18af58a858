//! The ways to fight latency side by side: one set of settings, every pipeline, several seeds, and one judge.
//!
//! [`CompareQuery`] says what is compared; [`Comparison`] is the table of a paper: for every [`Row`] how long from head to light,
//! over which interval it predicts, how many pixels it is wrong and why, and what it could draw.

mod contender;
mod pictures;
mod query;
mod rig;
mod row;
mod trial;

pub use crate::head_names::{MotionError, TRACKERS, motion, predictor, tracker};
pub use pictures::{EdgePictures, as_seen, edge_pictures, edge_scene};
pub use query::{CompareError, CompareQuery, Comparison, LEAST_SEEDS};
pub use rig::measure_on;
pub use row::{CauseShare, ErrorSpread, MeanInterval, Row};
