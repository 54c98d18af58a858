//! Models of trackers: measurement times, measurement errors, and the arrival of reports at the host.

mod config;
mod distortion;
mod fault;
mod model;
mod report;
mod reports;
mod serial;

pub use config::TrackerConfig;
pub use distortion::MagneticDistortion;
pub use fault::TrackerFault;
pub use model::TrackerModel;
pub use report::TrackerReport;
pub use reports::Reports;
pub use serial::{SerialLine, SerialRead};
