//! The panels that are known by name.

use super::PanelNumbers;
use super::board::build;
use parameters::ParameterTable;
use pxpl5_display::{Display, DisplayConfig, DisplayError};
use pxpl5_wire::NodeId;

parameters::parameter_table! {
    /// The high-resolution frame buffer of Pixel-Planes 5: 1280 x 1024 at 72 Hz, every line in every scan.
    ///
    /// The rate is assumed. Blanking is not modelled: the scan fills its whole period.
    pub struct HiResConfig {
        /// Visible pixels of a line.
        width: 1280, "pixels", Published, 1280..=1280 in 1..=1408, "F89";
        /// Visible lines of a frame.
        height: 1024, "lines", Published, 1024..=1024 in 1..=1408, "F89";
        /// Scans of the whole frame per second.
        refresh_hz: 72, "Hz", Assumed, 60..=76 in 1..=1000, "monitors of this size at the time";
        /// Ports of a board on the ring. Successive regions use them in turn.
        ports: 1, "ports", Assumed, 1..=8 in 1..=8, "no source gives the number. 1 is the number of an NTSC frame buffer (TR94). With 1 port, the 80 regions of a picture take 66.6 ms or five scans, so at most 14.4 pictures per second reach the display. 8 is the number of channels of the ring";
        /// Time of one word at a port.
        word_ns: 50, "ns", Published, 50..=50 in 1..=1_000_000, "TR94: 20 Mwords/s per channel";
    }
}

parameters::parameter_table! {
    /// A rolling OLED panel of one eye, as in headsets of 2016, behind a port of Pixel-Planes 5.
    pub struct OledConfig {
        /// Visible pixels of a line.
        width: 1080, "pixels", Published, 1080..=1080 in 1..=16_384, "data sheets of HTC Vive and Oculus Rift (2016): 1080 x 1200 for each eye";
        /// Visible lines.
        height: 1200, "lines", Published, 1200..=1200 in 1..=16_384, "data sheets of HTC Vive and Oculus Rift (2016): 1080 x 1200 for each eye";
        /// Scans per second.
        refresh_hz: 90, "Hz", Published, 90..=90 in 1..=1000, "data sheets of HTC Vive and Oculus Rift (2016)";
        /// 1 if a scan lights every second line only.
        interlace: 0, "1", Assumed, 0..=0 in 0..=1, "no headset of these years is interlaced";
        /// 0 rolling, 1 global.
        scan: 0, "1", Assumed, 0..=1 in 0..=1, "rolling, as the OLED of the Oculus Rift DK2";
        /// The way of a rolling scan: 0 down, 1 up, 2 right, 3 left.
        direction: 0, "1", Assumed, 0..=3 in 0..=3, "down. A panel that is mounted on its side scans to the right or to the left";
        /// Thousandths of the period in which lines light.
        active_permille: 950, "1/1000", Assumed, 800..=1000 in 1..=1000, "the rest is blanking";
        /// Time for which a pixel is driven in each scan.
        persistence_us: 2000, "us", Assumed, 1000..=3000 in 0..=1_000_000, "low persistence is 3 ms or less (Abrash 2013, 2014)";
        /// Time constant with which a pixel follows.
        response_us: 100, "us", Assumed, 10..=100 in 0..=1_000_000, "OLED switches in less than 0.1 ms";
        /// Ports of a board on the ring. Successive regions use them in turn.
        ports: 8, "ports", Assumed, 1..=8 in 1..=8, "the number of channels of the ring. With 1 port, at most 13 pictures of 90 regions per second reach the display";
        /// Time of one word at a port.
        word_ns: 50, "ns", Published, 50..=50 in 1..=1_000_000, "TR94: 20 Mwords/s per channel";
        /// Bits of a pixel's colour, a third for each primary.
        bits: 24, "bits", Assumed, 24..=24 in 3..=24, "8 bits for each primary";
    }
}

parameters::parameter_table! {
    /// An LCD panel of one eye that is lit by a short flash when all of it is written, as in headsets of 2019.
    pub struct LcdConfig {
        /// Visible pixels of a line.
        width: 1280, "pixels", Published, 1280..=1280 in 1..=16_384, "data sheet of Oculus Rift S (2019): 1280 x 1440 for each eye. The 1440 x 1600 of Valve Index have 156 regions, more than firmware can number";
        /// Visible lines.
        height: 1440, "lines", Published, 1440..=1440 in 1..=16_384, "data sheet of Oculus Rift S (2019): 1280 x 1440 for each eye";
        /// Scans per second.
        refresh_hz: 120, "Hz", Published, 80..=144 in 1..=1000, "data sheet of Valve Index (2019): 80, 90, 120 and 144 Hz";
        /// 1 if a scan lights every second line only.
        interlace: 0, "1", Assumed, 0..=0 in 0..=1, "no headset of these years is interlaced";
        /// 0 rolling, 1 global.
        scan: 1, "1", Published, 1..=1 in 0..=1, "data sheet of Valve Index (2019): global backlight illumination";
        /// The way of a rolling scan: 0 down, 1 up, 2 right, 3 left.
        direction: 0, "1", Assumed, 0..=3 in 0..=3, "without effect while the scan is global";
        /// Thousandths of the period after which the panel lights.
        active_permille: 950, "1/1000", Assumed, 800..=1000 in 1..=1000, "the flash begins when the panel is written and liquid crystals have settled";
        /// Time for which the backlight is on in each scan.
        persistence_us: 330, "us", Published, 330..=530 in 0..=1_000_000, "data sheet of Valve Index (2019): 0.330 to 0.530 ms";
        /// Time constant with which a pixel follows.
        response_us: 0, "us", Assumed, 0..=0 in 0..=1_000_000, "the backlight switches at once; crystals settle before it";
        /// Ports of a board on the ring. Successive regions use them in turn.
        ports: 8, "ports", Assumed, 1..=8 in 1..=8, "the number of channels of the ring";
        /// Time of one word at a port.
        word_ns: 50, "ns", Published, 50..=50 in 1..=1_000_000, "TR94: 20 Mwords/s per channel";
        /// Bits of a pixel's colour, a third for each primary.
        bits: 24, "bits", Assumed, 24..=24 in 3..=24, "8 bits for each primary";
    }
}

parameters::parameter_table! {
    /// A panel of one's own numbers.
    pub struct PanelConfig {
        /// Visible pixels of a line.
        width: 640, "pixels", Assumed, 1..=16_384, "an experiment's own; 640 as NTSC";
        /// Visible lines.
        height: 480, "lines", Assumed, 1..=16_384, "an experiment's own; 480 as NTSC";
        /// Scans per second.
        refresh_hz: 60, "Hz", Assumed, 1..=1000, "an experiment's own";
        /// 1 if a scan lights every second line only.
        interlace: 0, "1", Assumed, 0..=1, "an experiment's own";
        /// 0 rolling, 1 global.
        scan: 0, "1", Assumed, 0..=1, "an experiment's own";
        /// The way of a rolling scan: 0 down, 1 up, 2 right, 3 left.
        direction: 0, "1", Assumed, 0..=3, "an experiment's own";
        /// Thousandths of the period in which pixels light; at their end a global display lights.
        active_permille: 1000, "1/1000", Assumed, 1..=1000, "an experiment's own";
        /// Time for which a pixel is driven in each scan.
        persistence_us: 0, "us", Assumed, 0..=1_000_000, "an experiment's own; at most a period";
        /// Time constant with which a pixel follows.
        response_us: 0, "us", Assumed, 0..=1_000_000, "an experiment's own";
        /// Ports of a board on the ring. Successive regions use them in turn.
        ports: 1, "ports", Assumed, 1..=8, "an experiment's own; the ring has 8 channels";
        /// Time of one word at a port.
        word_ns: 50, "ns", Published, 50..=50 in 1..=1_000_000, "TR94: 20 Mwords/s per channel";
        /// Bits of a pixel's colour, a third for each primary.
        bits: 24, "bits", Assumed, 3..=24, "an experiment's own";
    }
}

/// Makes a table of numbers the configuration of a display.
macro_rules! panel {
    ($table:ident, $name:literal, $about:literal) => {
        impl DisplayConfig for $table {
            fn name(&self) -> &'static str {
                $name
            }

            fn about(&self) -> &'static str {
                $about
            }

            fn tables(&self) -> Vec<(&'static str, &dyn ParameterTable)> {
                vec![($name, self)]
            }

            fn tables_mut(&mut self) -> Vec<(&'static str, &mut dyn ParameterTable)> {
                vec![($name, self)]
            }

            fn ports(&self, pictures: usize) -> usize {
                pictures * self.ports as usize
            }

            fn check(&self) -> Result<(), DisplayError> {
                ParameterTable::check(self).map_err(|error| DisplayError(format!("{}.{error}", $name)))?;
                PanelNumbers::of(self).check($name)
            }

            fn build(&self, nodes: &[NodeId]) -> Result<Box<dyn Display>, DisplayError> {
                DisplayConfig::check(self)?;
                build($name, PanelNumbers::of(self), nodes)
            }

            fn boxed(&self) -> Box<dyn DisplayConfig> {
                Box::new(*self)
            }
        }
    };
}

panel!(HiResConfig, "hires", "high-resolution frame buffer of 1280 x 1024, progressive, 72 Hz (F89)");
panel!(OledConfig, "oled-90", "rolling OLED of 1080 x 1200 at 90 Hz, 2 ms persistence (headsets of 2016)");
panel!(LcdConfig, "lcd-120", "global LCD of 1280 x 1440 at 120 Hz, 0.33 ms persistence (headsets of 2019)");
panel!(PanelConfig, "panel", "a display of your own numbers (panel.width, panel.refresh_hz, ...)");
