//! Pixel errors of late or shifted pictures, and formulas of the methods that reduce these errors.

pub mod dual_list;
mod frameless;
mod hmd;
mod raster_offset;

pub use frameless::RandomOrder;
pub use hmd::{HmdView, Misregistration, drift_deg};
pub use raster_offset::RasterOffset;
