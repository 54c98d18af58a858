//! What a frame buffer is built from.

use crate::error::FrameBufferConfigError;
use crate::timing::{PortTiming, VideoTiming};
use parameters::{ParameterTable, check};

/// Numbers of one frame-buffer board.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrameBufferConfig {
    /// When lines and pixels are scanned.
    pub video: VideoTiming,
    /// Port to the ring.
    pub port: PortTiming,
    /// Scanned fields that are remembered, 1 to 1,000; an interlaced picture takes two.
    pub fields_kept: u64,
}

impl FrameBufferConfig {
    /// The NTSC frame buffer of TR94; the last two fields are remembered.
    pub const NTSC: Self = Self { video: VideoTiming::PAPERS, port: PortTiming::PAPERS, fields_kept: 2 };

    /// Checks that a board can be built.
    ///
    /// # Errors
    ///
    /// [`FrameBufferConfigError::Number`] names the number, what was expected and what was found.
    pub fn check(&self) -> Result<(), FrameBufferConfigError> {
        self.video.check()?;
        self.port.check()?;
        check("fields_kept", self.fields_kept, (1, 1_000))?;
        Ok(())
    }
}
