//! Errors of the configuration.

use parameters::ParameterError;

/// The reason why a frame buffer cannot be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameBufferConfigError {
    /// A number is out of range.
    #[error("frame buffer: {0}")]
    Number(#[from] ParameterError),
    /// The period of a field, which follows from the pixel clock, does not fit into a time.
    #[error(
        "frame buffer: the period of a field is out of range; expected pixel_ps x frame_lines x line_pixels below 2^64"
    )]
    Clock,
}
