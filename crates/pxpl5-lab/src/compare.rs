//! Comparison of all low-latency methods: the same settings for every pipeline, several seeds, and one method of
//! evaluation.
//!
//! [`CompareQuery`] describes a comparison. [`Comparison`] is its result. Each [`ComparisonRow`] has the latency from
//! head to display, the prediction interval, the error in pixels by cause, and the number of triangles that the
//! pipeline could draw.

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
pub use contender::usual_rows;
pub use gallery::LastPicture;
pub use pictures::{EdgePictures, as_seen, edge_pictures, edge_scene};
pub use predictors::{PredictorError, Predictors, predictors};
pub use query::{CompareError, CompareQuery, Comparison, LEAST_SEEDS};
pub use row::{CONFIDENCE, CauseShare, ComparisonRow, ErrorSpread, MeanInterval, PredictorMean};
