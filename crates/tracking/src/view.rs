//! The head-mounted display, pixel errors of late or shifted pictures, and formulas of the methods that reduce these
//! errors.

pub mod dual_list;
mod eyes;
mod frameless;
mod hmd;
mod raster_offset;

pub use eyes::{EyePoint, View};
pub use frameless::RandomOrder;
pub use hmd::{Hmd, HmdConfig, Misregistration, drift_deg};
pub use raster_offset::RasterOffset;
