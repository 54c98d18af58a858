//! All ways to fight latency side by side, in pixels: the same machine, scene, head motion and tracker for each.

mod chart;
mod errors;
mod motion;
mod pictures;
mod possible;
mod rig;
mod rows;
mod screen;

pub use chart::{LatencyCurve, chart};
pub(crate) use errors::{Drawn, Shown};
pub use errors::{FieldError, Percentiles, PixelErrors, Registration};
pub use motion::{MotionError, TRACKERS, motion, predictor, tracker};
pub use pictures::{EdgePictures, as_seen, edge_pictures, edge_scene};
pub use possible::{Possible, triangles_possible};
pub use rig::measure_on;
pub use rows::{Comparison, Row, compare, compare_with};
