//! Errors in the configuration of a frame buffer.

use pxpl5_sim::parameters::ParameterError;

/// The reason why a frame buffer cannot be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameBufferConfigError {
    /// A parameter of the configuration is out of range.
    #[error("frame buffer: {0}")]
    Number(#[from] ParameterError),
    /// The period of a field does not fit into a 64-bit time. The pixel clock determines this period.
    #[error(
        "frame buffer: the period of a field is out of range; expected pixel_ps x frame_lines x line_pixels below 2^64"
    )]
    Clock,
}
