//! Configuration of one frame buffer board.

use crate::timing::VideoTiming;
use pxpl5_sim::parameters::{SettingError, check};

/// Parameters of one frame buffer board.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrameBufferConfig {
    /// Timing of lines and pixels of the scan.
    pub video: VideoTiming,
    /// Number of scanned fields that the board keeps, 1 to 1,000. An interlaced picture needs at least two.
    pub fields_kept: u64,
}

impl FrameBufferConfig {
    /// The NTSC frame buffer of TR94. The board keeps the last two fields.
    pub const NTSC: Self = Self { video: VideoTiming::PAPERS, fields_kept: 2 };

    /// Checks that a board can be built from these parameters.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] with the name of the parameter, the expected range and the found
    /// value.
    pub fn check(&self) -> Result<(), SettingError> {
        self.video.check()?;
        check("fields_kept", self.fields_kept, (1, 1_000)).map_err(|error| error.at("frame buffer"))
    }
}
