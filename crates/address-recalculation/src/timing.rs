//! All parameters of the address recalculation display, with their sources.

use pxpl5_sim::Span;
use pxpl5_sim::parameters::{ParameterTable, SettingError};
use pxpl5_wire::{Video, VideoNumbers};

pxpl5_sim::parameters::parameter_table! {
    /// Word lengths, memories and stage time of the pipeline.
    pub struct ArpTiming {
        /// Number of display memories per eye. Each memory has two buffers of six faces with depth.
        display_memories: 4, "memories", Published, 1..=8, "CPR05 tables 1 and 2: memories 0 to 3";
        /// Number of texels along an edge of a face, including guard texels (a margin that repeats the neighbouring
        /// face). The number must be a multiple of 128.
        face_texels: 256, "texels", Assumed, 128..=2048, "not printed; a port of the ring can fill faces of 256 texels 25 times a second; 512 for ideal faces";
        /// Number of texels on each side of a face that repeat the content of the neighbouring face.
        guard_texels: 1, "texels", Assumed, 0..=8, "not printed; with 1, every footprint lies on its face";
        /// Number of bits in each component of a viewing vector, including the sign.
        vector_bits: 16, "bits", Assumed, 8..=24, "not printed; 16 bits give an error of 0.02 texels on faces of 512";
        /// Number of bits in each component of the matrix, including the sign.
        matrix_bits: 16, "bits", Assumed, 8..=24, "not printed; the same as the vectors";
        /// Number of bits in a quotient. The divider has one stage per bit.
        quotient_bits: 16, "bits", Assumed, 8..=20, "not printed; 1/128 texel of 512";
        /// Number of bits in each of the two fractions that weight four texels. With 0, the pixel shows the nearest
        /// texel.
        weight_bits: 4, "bits", Assumed, 0..=8, "RPM has hardware for weights and does not print their width";
        /// Number of bits of depth in a display memory: 16 or 24.
        depth_bits: 24, "bits", Derived, 16..=24, "the machine's depth";
        /// Number of bits of colour in a display memory: 24, or 16 (5 red, 6 green, 5 blue).
        colour_bits: 24, "bits", Derived, 16..=24, "the machine's colour";
        /// Duration of one pipeline stage.
        stage_ps: 25_000, "ps", Assumed, 1_000..=38_461 in 1..=1_000_000, "RP94: orientation less than 1 us before the first pixel, so below 38.46 ns in 26 stages";
        /// Horizontal viewing angle of the picture.
        horizontal_deg: f64 = 60.0, "deg", Published, 1.0..=360.0, "JITP; above 170 only with the equidistant lens or a table";
    }
}

pxpl5_sim::parameters::parameter_table! {
    /// Timing of the video scan: NTSC, as in the frame buffer of Pixel-Planes 5.
    pub struct ScanTiming {
        /// Period of the pixel clock, multiplied by `pixel_divisor`. The period is the quotient of both numbers.
        pixel_ps: 11_000_000, "ps", Derived, 11000000..=11000000 in 1..=MAX, "NTSC square pixels: 135/11 MHz";
        /// Number by which `pixel_ps` is divided to get the period of the pixel clock.
        pixel_divisor: 135, "1", Derived, 135..=135 in 1..=MAX, "NTSC square pixels: 135/11 MHz";
        /// Number of pixel periods in a line, including blanking.
        line_pixels: 780, "pixels", Derived, 780..=780 in 1..=16_384, "(4004/63 us) x (135/11 MHz)";
        /// Number of lines in a frame of two fields, including blanking.
        frame_lines: 525, "lines", Published, 525..=525 in 2..=16_384, "NTSC: 262.5 lines a field";
        /// Number of visible pixels in a line.
        visible_pixels: 640, "pixels", Published, 640..=640 in 1..=4_096, "TR94";
        /// Number of visible lines in a field.
        visible_lines: 240, "lines", Published, 240..=240 in 1..=4_096, "TR94: 480 lines in two fields";
        /// Number of blanked pixel periods before the visible pixels of a line.
        left_blanking: 140, "pixels", Assumed, 0..=140 in 0..=16_384, "as in the frame buffer: all horizontal blanking comes first";
        /// Number of blanked lines between a retrace and the first visible line.
        top_blanking: 22, "lines", Assumed, 0..=22 in 0..=16_384, "as in the frame buffer: all vertical blanking comes first";
    }
}

/// Number of pipeline stages without dividers and comparators. Each stage takes one clock.
///
/// These stages are table, multiply, two adders, face, address, memory and interpolate.
const FIXED_STAGES: u64 = 8;

impl ArpTiming {
    /// Returns the number of stages in which the depths of the memories are compared in pairs.
    pub const fn compare_stages(&self) -> u64 {
        self.display_memories.next_power_of_two().trailing_zeros() as u64
    }

    /// Returns the number of stages from reading the table to displaying the pixel: 26 for four memories and quotients
    /// of 16 bits.
    pub const fn stages(&self) -> u64 {
        FIXED_STAGES + self.quotient_bits + self.compare_stages()
    }

    /// Returns the duration of all stages. The orientation for a pixel must arrive at least this time before the pixel
    /// is displayed.
    pub const fn depth(&self) -> Span {
        Span(self.stages() * self.stage_ps)
    }

    /// Returns the time from reading a pixel's texels to displaying the pixel: memory, comparators and interpolation.
    pub const fn read_ahead(&self) -> Span {
        Span((2 + self.compare_stages()) * self.stage_ps)
    }

    /// Checks all parameters against their limits, and the rules that connect parameters.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the parameter, the expected and the found value.
    pub fn check(&self) -> Result<(), SettingError> {
        ParameterTable::check(self).map_err(|error| error.in_table("arp"))?;
        rule(self.face_texels.is_multiple_of(128), "face_texels", "a multiple of 128", self.face_texels)?;
        rule([16, 24].contains(&self.depth_bits), "depth_bits", "16 or 24", self.depth_bits)?;
        rule([16, 24].contains(&self.colour_bits), "colour_bits", "16 or 24", self.colour_bits)
    }
}

fn rule(holds: bool, name: &'static str, expected: &'static str, found: u64) -> Result<(), SettingError> {
    SettingError::require(holds, name, expected, found).map_err(|error| error.in_table("arp"))
}

impl ScanTiming {
    /// Checks all parameters against their limits. A line must have room for the visible pixels and their blanking. A
    /// field must have room for the visible lines and their blanking.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the parameter, the expected and the found value.
    pub fn check(&self) -> Result<(), SettingError> {
        self.video().map(drop)
    }

    pub(crate) fn video(&self) -> Result<Video, SettingError> {
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
        ParameterTable::check(self).and_then(|()| Video::new(numbers)).map_err(|error| error.in_table("arp_scan"))
    }
}
