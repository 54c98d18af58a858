//! Panels with a name, and the tables of their parameters.

use super::PanelNumbers;
use super::board::build;
use pxpl5_sim::Span;
use pxpl5_sim::parameters::{ParameterTable, SettingError};
use pxpl5_wire::NodeId;
use pxpl5_wire::display::{Display, DisplayConfig};

pxpl5_sim::parameters::parameter_table! {
    /// The high-resolution frame buffer of Pixel-Planes 5: 1280 x 1024 pixels at 72 Hz.
    ///
    /// Each scan shows every line. The rate is assumed. Blanking is not modelled: the scan fills its whole period.
    pub struct HiResConfig {
        /// Width of the picture: visible pixels in each line.
        width: 1280, "pixels", Published, 1280..=1280 in 1..=1408, "F89";
        /// Height of the picture: visible lines in each frame.
        height: 1024, "lines", Published, 1024..=1024 in 1..=1408, "F89";
        /// Number of scans of the whole screen per second.
        refresh_hz: 72, "Hz", Assumed, 60..=76 in 1..=1000, "monitors of this size at the time";
        /// Number of ring ports of one board. Successive regions use the ports in turn.
        ports: 1, "ports", Assumed, 1..=8 in 1..=8, "no source gives the number. 1 is the number of an NTSC frame buffer (TR94). With 1 port, the 80 regions of a picture take 66.6 ms or five scans, so at most 14.4 pictures per second reach the display. 8 is the number of channels of the ring";
    }
}

pxpl5_sim::parameters::parameter_table! {
    /// A rolling OLED panel for one eye, as in headsets of 2016, connected to ring ports of Pixel-Planes 5.
    pub struct OledConfig {
        /// Width of the panel: visible pixels in each line.
        width: 1080, "pixels", Published, 1080..=1080 in 1..=16_384, "data sheets of HTC Vive and Oculus Rift (2016): 1080 x 1200 for each eye";
        /// Height of the panel: visible lines.
        height: 1200, "lines", Published, 1200..=1200 in 1..=16_384, "data sheets of HTC Vive and Oculus Rift (2016): 1080 x 1200 for each eye";
        /// Number of scans of the panel per second.
        refresh_hz: 90, "Hz", Published, 90..=90 in 1..=1000, "data sheets of HTC Vive and Oculus Rift (2016)";
        /// 1 if each scan shows only every second line, 0 if each scan shows all lines.
        interlace: 0, "1", Assumed, 0..=0 in 0..=1, "no headset of these years is interlaced";
        /// Kind of scan: 0 if pixels are lit one after the other (rolling), 1 if all pixels are lit together (global).
        scan: 0, "1", Assumed, 0..=1 in 0..=1, "rolling, as the OLED of the Oculus Rift DK2";
        /// Direction of a rolling scan: 0 down, 1 up, 2 right, 3 left.
        direction: 0, "1", Assumed, 0..=3 in 0..=3, "down. A panel that is mounted on its side scans to the right or to the left";
        /// Part of each scan period in which the scan lights pixels, in thousandths of the period.
        active_permille: 950, "1/1000", Assumed, 800..=1000 in 1..=1000, "the rest is blanking";
        /// Time for which each pixel is switched on in each scan.
        persistence_us: 2000, "us", Assumed, 1000..=3000 in 0..=1_000_000, "low persistence is 3 ms or less (Abrash 2013, 2014)";
        /// Time constant (first-order lag) of a pixel's brightness. The brightness follows the switching of the
        /// pixel with this lag.
        response_us: 100, "us", Assumed, 10..=100 in 0..=1_000_000, "OLED switches in less than 0.1 ms";
        /// Number of ring ports of one board. Successive regions use the ports in turn.
        ports: 8, "ports", Assumed, 1..=8 in 1..=8, "the number of channels of the ring. With 1 port, at most 13 pictures of 90 regions per second reach the display";
        /// Number of bits of a pixel's colour. Each of the three primary colours has a third of the bits.
        bits: 24, "bits", Assumed, 24..=24 in 3..=24, "8 bits for each primary";
    }
}

pxpl5_sim::parameters::parameter_table! {
    /// An assumed LCD panel for one eye, with numbers between the numbers of two headsets of 2019.
    ///
    /// A short flash lights the panel after all its pixels were written.
    ///
    /// No single headset has these numbers. Oculus Rift S has this size at 80 Hz. Valve Index has this rate and flash,
    /// but its 1440 x 1600 pixels have 156 regions, and firmware supports at most 128 regions.
    pub struct LcdConfig {
        /// Width of the panel: visible pixels in each line.
        width: 1280, "pixels", Assumed, 1280..=1440 in 1..=16_384, "an assumed panel: 1280 x 1440 for each eye in Oculus Rift S (2019), 1440 x 1600 in Valve Index (2019), whose 156 regions are more than firmware can number";
        /// Height of the panel: visible lines.
        height: 1440, "lines", Assumed, 1440..=1600 in 1..=16_384, "an assumed panel: 1280 x 1440 for each eye in Oculus Rift S (2019), 1440 x 1600 in Valve Index (2019)";
        /// Number of scans of the panel per second.
        refresh_hz: 120, "Hz", Assumed, 80..=144 in 1..=1000, "an assumed panel: 80, 90, 120 and 144 Hz in Valve Index (2019), 80 Hz in Oculus Rift S (2019)";
        /// 1 if each scan shows only every second line, 0 if each scan shows all lines.
        interlace: 0, "1", Assumed, 0..=0 in 0..=1, "no headset of these years is interlaced";
        /// Kind of scan: 0 if pixels are lit one after the other (rolling), 1 if all pixels are lit together (global).
        scan: 1, "1", Assumed, 1..=1 in 0..=1, "an assumed panel: global backlight illumination in Valve Index (2019)";
        /// Direction of a rolling scan: 0 down, 1 up, 2 right, 3 left.
        direction: 0, "1", Assumed, 0..=3 in 0..=3, "without effect while the scan is global";
        /// Time from the start of a period to the flash that lights the panel, in thousandths of the period.
        active_permille: 950, "1/1000", Assumed, 800..=1000 in 1..=1000, "the flash begins when the panel is written and liquid crystals have settled";
        /// Time for which the backlight is on in each scan.
        persistence_us: 330, "us", Assumed, 330..=530 in 0..=1_000_000, "an assumed panel: 0.330 to 0.530 ms in Valve Index (2019), depending on the rate";
        /// Time constant (first-order lag) of a pixel's brightness. The brightness follows the switching of the
        /// backlight with this lag.
        response_us: 0, "us", Assumed, 0..=0 in 0..=1_000_000, "the backlight switches at once; crystals settle before it";
        /// Number of ring ports of one board. Successive regions use the ports in turn.
        ports: 8, "ports", Assumed, 1..=8 in 1..=8, "the number of channels of the ring";
        /// Number of bits of a pixel's colour. Each of the three primary colours has a third of the bits.
        bits: 24, "bits", Assumed, 24..=24 in 3..=24, "8 bits for each primary";
    }
}

pxpl5_sim::parameters::parameter_table! {
    /// A panel without published values: the experiment chooses all parameters.
    pub struct PanelConfig {
        /// Width of the panel: visible pixels in each line.
        width: 640, "pixels", Assumed, 1..=16_384, "an experiment's own; 640 as NTSC";
        /// Height of the panel: visible lines.
        height: 480, "lines", Assumed, 1..=16_384, "an experiment's own; 480 as NTSC";
        /// Number of scans of the panel per second.
        refresh_hz: 60, "Hz", Assumed, 1..=1000, "an experiment's own";
        /// 1 if each scan shows only every second line, 0 if each scan shows all lines.
        interlace: 0, "1", Assumed, 0..=1, "an experiment's own";
        /// Kind of scan: 0 if pixels are lit one after the other (rolling), 1 if all pixels are lit together (global).
        scan: 0, "1", Assumed, 0..=1, "an experiment's own";
        /// Direction of a rolling scan: 0 down, 1 up, 2 right, 3 left.
        direction: 0, "1", Assumed, 0..=3, "an experiment's own";
        /// Part of each period in which a rolling scan lights pixels, in thousandths of the period. A global scan
        /// lights all pixels at the end of this part.
        active_permille: 1000, "1/1000", Assumed, 1..=1000, "an experiment's own";
        /// Time for which each pixel is switched on in each scan.
        persistence_us: 0, "us", Assumed, 0..=1_000_000, "an experiment's own; at most a period";
        /// Time constant (first-order lag) of a pixel's brightness. The brightness follows the switching of the
        /// pixel with this lag.
        response_us: 0, "us", Assumed, 0..=1_000_000, "an experiment's own";
        /// Number of ring ports of one board. Successive regions use the ports in turn.
        ports: 1, "ports", Assumed, 1..=8, "an experiment's own; the ring has 8 channels";
        /// Number of bits of a pixel's colour. Each of the three primary colours has a third of the bits.
        bits: 24, "bits", Assumed, 3..=24, "an experiment's own";
    }
}

/// Implements the configuration of a display for a table of panel parameters.
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

            fn check(&self) -> Result<(), SettingError> {
                ParameterTable::check(self).map_err(|error| error.in_table($name))?;
                PanelNumbers::of(self).check($name)
            }

            fn build(&self, nodes: &[NodeId], word: Span) -> Result<Box<dyn Display>, SettingError> {
                DisplayConfig::check(self)?;
                build($name, PanelNumbers::of(self), nodes, word)
            }

            fn boxed(&self) -> Box<dyn DisplayConfig> {
                Box::new(*self)
            }
        }
    };
}

panel!(HiResConfig, "hires", "high-resolution frame buffer of 1280 x 1024, progressive, 72 Hz (F89)");
panel!(OledConfig, "oled-90", "rolling OLED of 1080 x 1200 at 90 Hz, 2 ms persistence (headsets of 2016)");
panel!(LcdConfig, "lcd-120", "assumed global LCD of 1280 x 1440 at 120 Hz, 0.33 ms persistence");
panel!(PanelConfig, "panel", "a display of your own numbers (panel.width, panel.refresh_hz, ...)");
