//! All ways to fight latency side by side, in pixels: the same machine, scene, head motion and tracker for each.

mod motion;
mod pictures;
mod possible;
mod rig;
mod rows;

pub use motion::{MotionError, TRACKERS, motion, predictor, tracker, tracker_by};
pub use pictures::{EdgePictures, as_seen, edge_pictures, edge_scene};
pub use possible::{Possible, triangles_possible};
pub use rig::measure_on;
pub use rows::{Comparison, Row, compare, compare_with};
