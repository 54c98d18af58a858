//! All parameters of the Perspecta display, with their sources.

use crate::{Rotation, SweptConfig};
use pxpl5_sim::parameters::{ParameterTable, SettingError};
use pxpl5_sim::{Clock, Span, Time};

pxpl5_sim::parameters::parameter_table! {
    /// A screen that rotates about its vertical axis, and the projector that lights the screen.
    pub struct PerspectaConfig {
        /// Number of slices that the projector flashes in a revolution.
        slices: 396, "slices", Published, 396..=396 in 4..=4096, "the SpatialGL paper (P1)";
        /// Number of pixels in a line of the projector.
        width: 768, "pixels", Assumed, 256..=2048 in 8..=4096, "the paper gives no value; 768 x 768 in SPIE 4297, 1024 x 768 in SPIE 5664";
        /// Number of lines of the projector.
        height: 768, "lines", Assumed, 256..=2048 in 1..=4096, "the paper gives no value; 768 in SPIE 4297 and SPIE 5664";
        /// Revolutions of the screen per minute.
        spin_rpm: 900, "1/min", Assumed, 600..=900 in 1..=1_000_000, "the paper gives no value; 600 in SPIE 4297, 730 and 900 in the press";
        /// Percentage of the interval between two strobes (flashes) in which the projector is lit.
        lit_percent: 100, "%", Assumed, 1..=100 in 1..=100, "the paper gives no value; a lower value only makes the display darker";
        /// Time to transfer one word at the ring port.
        word_ns: 50, "ns", Published, 50..=50 in 1..=1_000_000, "TR94: 20 Mwords/s per channel of the ring, the same as other displays";
    }
}

impl PerspectaConfig {
    /// Checks that every parameter is within its limits, that the number of slices is even, and that a line consists of
    /// whole words.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the invalid number, the expected and the found value.
    pub fn check(&self) -> Result<(), SettingError> {
        ParameterTable::check(self).map_err(|error| error.in_table("perspecta"))?;
        SettingError::require(self.slices.is_multiple_of(2), "perspecta.slices", "an even number", self.slices)?;
        SettingError::require(self.width.is_multiple_of(8), "perspecta.width", "a multiple of 8", self.width)
    }

    /// Returns a clock whose edges are the instants of strobe 0, the first flash of a revolution. The period is exactly
    /// 60 s divided by the revolutions per minute.
    ///
    /// # Panics
    /// The function never panics after a successful [`Self::check`].
    pub fn revolution(&self) -> Clock {
        Clock::new(60_000_000_000_000, self.spin_rpm).expect("at most a million revolutions a minute")
    }

    /// Returns the instant at which strobe (flash) `slice` of a revolution begins, and the duration of the strobe. For
    /// strobe k of N in revolution n, the instant is (n + k / N) / f, for f revolutions per second. The duration is
    /// `lit_percent` of the interval between strobes.
    pub fn strobe(&self, revolution: u64, slice: u64) -> (Time, Span) {
        let begin = self.instant(revolution, slice);
        let interval = self.instant(revolution, slice + 1).since(begin);
        (begin, Span(interval.0 * self.lit_percent / 100))
    }

    fn instant(&self, revolution: u64, slice: u64) -> Time {
        let picoseconds = u128::from(revolution * self.slices + slice) * 60_000_000_000_000;
        Time((picoseconds / u128::from(self.slices * self.spin_rpm)) as u64)
    }

    /// Returns the number of volumes per second that an eye sees. There are two volumes per revolution, because the
    /// screen passes every plane twice (figure D2).
    pub fn volume_hz(&self) -> f64 {
        2.0 * self.spin_rpm as f64 / 60.0
    }

    /// Returns the number of strobes (flashes) per second: slices times revolutions per second.
    pub fn strobe_hz(&self) -> f64 {
        self.slices as f64 * self.spin_rpm as f64 / 60.0
    }

    /// Returns this display in the form that the rendering pipeline needs, with a clip and a projection.
    ///
    /// # Errors
    ///
    /// [`SettingError`] as for [`Self::check`], or for settings that the pipeline does not support.
    pub fn swept(
        &self,
        clip: crate::SliceClip,
        projection: crate::Projection,
    ) -> Result<crate::SweptDisplay, SettingError> {
        self.check()?;
        let config = SweptConfig {
            slices: self.slices as u32,
            width: self.width as u32,
            height: self.height as u32,
            rotation: Rotation::XToZ,
            ..SweptConfig::perspecta(clip, projection)
        };
        crate::SweptDisplay::new(config)
    }
}
