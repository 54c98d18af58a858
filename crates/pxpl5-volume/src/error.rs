//! The error of settings and requests.

pub use pxpl5_sim::parameters::SettingError as VolumeError;
