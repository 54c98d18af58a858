//! The ways to fight latency side by side: one set of settings, every pipeline, several seeds, and one judge.
//!
//! [`CompareQuery`] says what is compared; [`Comparison`] is the table of a paper: for every [`ComparisonRow`] how long from head to light,
//! over which interval it predicts, how many pixels it is wrong and why, and what it could draw.

mod contender;
mod gallery;
mod pictures;
mod predictors;
mod query;
mod row;
mod trial;

pub use crate::head_names::{
    MOTIONS, MotionError, Replay, TRACKERS, is_recording, is_walk, motion, predictor, replayed, tracker, tracker_by,
    walk,
};
pub use gallery::LastPicture;
pub use pictures::{EdgePictures, as_seen, edge_pictures, edge_scene};
pub use predictors::{PredictorError, Predictors, predictors};
pub use query::{CompareError, CompareQuery, Comparison, LEAST_SEEDS};
pub use row::{CauseShare, ComparisonRow, ErrorSpread, MeanInterval, PredictorMean};
