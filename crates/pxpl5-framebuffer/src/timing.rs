//! All timing parameters of the frame buffer.

use pxpl5_sim::parameters::{ParameterTable, SettingError};
use pxpl5_wire::{Video, VideoNumbers};

pxpl5_sim::parameters::parameter_table! {
    /// Timing of NTSC video. All times follow from one pixel clock. A line has exactly 780 pixel periods (4004/63 us),
    /// and a field exactly 262.5 lines (1001/60000 s).
    pub struct VideoTiming {
        /// Period of the pixel clock, multiplied by the parameter `pixel_divisor`.
        pixel_ps: 11_000_000, "ps", Derived, 11000000..=11000000 in 1..=MAX, "NTSC square pixels: 135/11 MHz = 12.2727 MHz, 640 in 52.15 us";
        /// Divisor of `pixel_ps`. The quotient is the period of the pixel clock.
        pixel_divisor: 135, "1", Derived, 135..=135 in 1..=MAX, "NTSC square pixels: 135/11 MHz";
        /// Number of pixel periods in a line.
        line_pixels: 780, "pixels", Derived, 780..=780 in 1..=16_384, "(4004/63 us) x (135/11 MHz)";
        /// Number of lines in a frame of two fields.
        frame_lines: 525, "lines", Published, 525..=525 in 2..=16_384, "NTSC: 262.5 lines a field";
        /// Number of visible pixels in a line.
        visible_pixels: 640, "pixels", Published, 640..=640 in 1..=16_384, "TR94";
        /// Number of visible lines in a field.
        visible_lines: 240, "lines", Published, 240..=240 in 1..=16_384, "TR94: 480 lines in two fields";
        /// Number of blanked pixel periods at the start of a line, before its visible pixels.
        left_blanking: 140, "pixels", Assumed, 0..=140 in 0..=16_384, "all of the horizontal blanking comes first";
        /// Number of blanked whole lines after a retrace. In an odd field, the half line after the retrace is blanked
        /// too. The first line of an odd field is therefore scanned half a line later than the first line of an even
        /// field.
        top_blanking: 22, "lines", Assumed, 0..=22 in 0..=16_384, "all of the vertical blanking comes first";
    }
}

impl VideoTiming {
    /// Checks that a picture can be scanned with these parameters. Each parameter must be in its range. The visible
    /// pixels and their blanking must fit in a line. The visible lines and their blanking must fit in a field.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] with the name of the parameter, the expected range and the found value. The period of a
    /// field must also fit in a 64-bit time.
    pub fn check(&self) -> Result<(), SettingError> {
        self.video().map(drop)
    }

    /// Returns the video signal with these parameters.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`VideoTiming::check`].
    pub fn video(&self) -> Result<Video, SettingError> {
        let numbers = VideoNumbers {
            pixel_ps: self.pixel_ps,
            pixel_divisor: self.pixel_divisor,
            line_pixels: self.line_pixels,
            frame_lines: self.frame_lines,
            visible_pixels: self.visible_pixels,
            visible_lines: self.visible_lines,
            left_blanking: self.left_blanking,
            top_blanking: self.top_blanking,
        };
        ParameterTable::check(self).and_then(|()| Video::new(numbers)).map_err(|error| error.at("frame buffer"))
    }
}
