//! Comparison of all low-latency methods, with the same settings, seeds and evaluation for every pipeline.
//!
//! [`CompareQuery`] describes a comparison. [`Comparison`] is its result. Each [`ComparisonRow`] has the latency from
//! head to display, the prediction interval, and the error in pixels by cause. The row also has the largest number of
//! triangles that the pipeline can draw in time.

mod compared;
mod gallery;
mod interval;
mod length;
mod pictures;
mod precision;
mod predictors;
mod query;
mod resume;
mod row;
mod store;
mod trial;

pub use crate::head_parts::{
    MOTIONS, Replay, TRACKERS, is_recording, is_walk, motion, predictor, replayed, tracker, tracker_by, walk,
};
pub use compared::RowChoice;
pub use gallery::LastPicture;
pub use interval::{CONFIDENCE, IntervalMethod, MeanInterval};
pub use length::RecordedLength;
pub use pictures::{EdgePictures, as_seen, edge_pictures, edge_scene};
pub use precision::{MAX_SEEDS, Precision, UntilPrecise};
pub use predictors::{PredictorResult, Predictors, predictors};
pub use query::{CompareQuery, Comparison, MIN_SEEDS};
pub use row::{CauseShare, ComparisonRow, ErrorSpread, PredictionIntervalErrorMean, PredictorMean};
pub use store::{CompareStore, ROWS_FOLDER, ROWS_SCHEMA};
