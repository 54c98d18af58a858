//! All ways to fight latency side by side, in pixels: the same machine, scene, head motion and tracker for each.

mod motion;
mod pictures;
mod possible;
mod predictors;
mod rows;

pub use motion::{
    MOTIONS, MotionError, Replay, TRACKERS, is_recording, motion, predictor, replayed, tracker, tracker_by,
};
pub use pictures::{EdgePictures, as_seen, edge_pictures, edge_scene};
pub use possible::{Possible, triangles_possible};
pub use predictors::{PredictorError, Predictors, predictors};
pub use rows::{Comparison, Row, compare, compare_with};
