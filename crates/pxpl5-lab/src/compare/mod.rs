//! All ways to fight latency side by side, in pixels: the same machine, scene, head motion and tracker for each.

mod motion;
mod pictures;
mod possible;
mod rows;

pub use motion::{MotionError, TRACKERS, motion, predictor, tracker, tracker_by};
pub use pictures::{EdgePictures, as_seen, edge_pictures, edge_scene};
pub use possible::{Possible, triangles_possible};
pub use rows::{Comparison, Row, compare, compare_with};
