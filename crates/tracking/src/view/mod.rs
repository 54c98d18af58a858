//! What a late or a shifted picture looks like: pixel errors, and the mathematics of the ways to avoid them.

pub mod dual_list;
mod frameless;
mod hmd;
mod raster_offset;

pub use frameless::RandomOrder;
pub use hmd::{HmdView, PixelError, drift_deg};
pub use raster_offset::RasterOffset;
