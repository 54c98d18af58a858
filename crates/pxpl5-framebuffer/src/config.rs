//! What a frame buffer is built from.

use crate::timing::check;
use crate::{PortTiming, VideoTiming};
use std::fmt;

/// Numbers of one frame-buffer board.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrameBufferConfig {
    /// Video.
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
    /// [`ConfigError::Value`] names the number, what was expected and what was found.
    pub fn check(&self) -> Result<(), ConfigError> {
        self.video.check()?;
        self.port.check()?;
        check("fields_kept", self.fields_kept, 1, 1_000)
    }
}

/// Why a frame buffer cannot be built.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ConfigError {
    /// A number is outside of what the model can take.
    Value {
        /// Its name.
        name: &'static str,
        /// What it was.
        found: u64,
        /// Smallest and largest possible value.
        expected: (u64, u64),
    },
    /// The pixel clock gives no field that fits into the range of a time.
    Clock,
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value {
                name,
                found,
                expected: (low, high),
            } => write!(
                f,
                "frame buffer: {name} must be {low} to {high}, found {found}"
            ),
            Self::Clock => f.write_str(
                "frame buffer: the period of a field is out of range; expected pixel_ps x frame_lines x line_pixels below 2^64",
            ),
        }
    }
}

impl std::error::Error for ConfigError {}
