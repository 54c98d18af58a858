//! What a display does between the frame buffer and the eye.

mod vdrt;

pub use vdrt::Vdrt;
