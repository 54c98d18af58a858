//! Head motion, tracker models and prediction for head-mounted displays.
pub mod config;
mod error;
pub mod motion;
pub mod pose;
pub mod predict;
mod random;
pub mod rotation;
pub mod time;
pub mod tracker;
pub use error::ConfigError;
pub use pose::Pose;
