//! Why numbers are refused.

use parameters::ParameterError;

/// Why a frame buffer cannot be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameBufferConfigError {
    /// A number is outside of what the model can take.
    #[error("frame buffer: {0}")]
    Number(#[from] ParameterError),
    /// The pixel clock gives no field that fits into the range of a time.
    #[error(
        "frame buffer: the period of a field is out of range; expected pixel_ps x frame_lines x line_pixels below 2^64"
    )]
    Clock,
}
