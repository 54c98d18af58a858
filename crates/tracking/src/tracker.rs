//! Models of trackers: measurement times, measurement errors, and the arrival of reports at the host.

mod config;
mod distortion;
mod fault;
mod model;
mod reports;
mod serial;

pub use config::TrackerConfig;
pub use distortion::MagneticDistortion;
pub use fault::TrackerFault;
pub use model::TrackerModel;
pub use reports::{Reports, TrackerReport};
pub use serial::{SerialLine, SerialRead};
