//! The parameters that all kinds of panels share.

use pxpl5_sim::Span;
use pxpl5_sim::parameters::{ParameterTable, SettingError, Value};
use pxpl5_wire::REGION_SIZE;
use pxpl5_wire::display::{PixelLight, ScanOrder};

/// Greatest number of regions in a picture. The region masks of `pxpl5-geometry` have this number of bits.
const MAX_REGIONS: u64 = 128;

const US_PER_S: u64 = 1_000_000;

/// The parameters of a panel, a display without NTSC timing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PanelNumbers {
    /// Width of the panel: visible pixels in each line.
    pub width: u64,
    /// Height of the panel: visible lines.
    pub height: u64,
    /// Number of scans of the panel per second.
    pub refresh_hz: u64,
    /// 1 if each scan shows only every second line, 0 if each scan shows all lines.
    pub interlace: u64,
    /// Kind of scan: 0 if pixels are lit one after the other (rolling), 1 if all pixels are lit at the same time
    /// (global).
    pub scan: u64,
    /// Direction of a rolling scan: 0 down, 1 up, 2 right, 3 left.
    pub direction: u64,
    /// Part of each period in which a rolling scan lights pixels, in thousandths of the period. A global scan lights
    /// all pixels at the end of this part.
    pub active_permille: u64,
    /// Time for which a pixel is switched on in each scan, in microseconds.
    pub persistence_us: u64,
    /// Time constant, in microseconds, of a pixel's brightness after the pixel is switched on or off.
    pub response_us: u64,
    /// Number of ring ports of one board.
    pub ports: u64,
    /// Number of bits of a pixel's colour. Each of the three primary colours has a third of the bits.
    pub bits: u64,
}

impl PanelNumbers {
    /// Reads the parameters of a panel from a table.
    ///
    /// A missing parameter has its default. The scan is then rolling, runs from the top, shows every line and fills the
    /// period. A pixel has 24 bits and shines for an instant, and a board has one port.
    pub fn of(table: &dyn ParameterTable) -> Self {
        let number = |name: &str, default: u64| match table.get(name) {
            Ok(Value::Whole(value)) => value,
            _ => default,
        };
        Self {
            width: number("width", 0),
            height: number("height", 0),
            refresh_hz: number("refresh_hz", 0),
            interlace: number("interlace", 0),
            scan: number("scan", 0),
            direction: number("direction", 0),
            active_permille: number("active_permille", 1_000),
            persistence_us: number("persistence_us", 0),
            response_us: number("response_us", 0),
            ports: number("ports", 1),
            bits: number("bits", 24),
        }
    }

    /// Returns the order in which pixels are lit, and the time for which each pixel shines.
    pub const fn light(&self) -> PixelLight {
        let scan = match (self.scan, self.direction) {
            (1, _) => ScanOrder::Global,
            (_, 1) => ScanOrder::Up,
            (_, 2) => ScanOrder::Right,
            (_, 3) => ScanOrder::Left,
            _ => ScanOrder::Down,
        };
        let [persistence, response] = [Span::from_us(self.persistence_us), Span::from_us(self.response_us)];
        PixelLight { scan, persistence, response }
    }

    /// Checks rules that relate several parameters. `table` is the prefix of parameter names in error messages.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] with the name of the parameter, the expected range and the found value.
    pub fn check(&self, table: &str) -> Result<(), SettingError> {
        let wrong = |name: &str, expected: String, found: String| {
            Err(SettingError::value(name, expected, found).in_table(table))
        };
        for (name, number) in [("width", self.width), ("height", self.height), ("refresh_hz", self.refresh_hz)] {
            if number == 0 {
                return wrong(name, "1 or more".to_owned(), "0".to_owned());
            }
        }
        let size = u64::from(REGION_SIZE);
        // Firmware has a mask with one bit for each region, and the mask has a fixed size.
        let regions = self.width.div_ceil(size).saturating_mul(self.height.div_ceil(size));
        if regions > MAX_REGIONS {
            let expected = format!("at most {MAX_REGIONS} regions of {size} x {size}, as many as firmware can number");
            return wrong("width", expected, format!("{regions} ({} x {} pixels)", self.width, self.height));
        }
        // A pixel is driven again in the next period, so it cannot shine longer than one period.
        let period_us = US_PER_S / self.refresh_hz;
        if self.persistence_us > period_us {
            let expected = format!("0 to {period_us}, a period of {} Hz", self.refresh_hz);
            return wrong("persistence_us", expected, self.persistence_us.to_string());
        }
        // Both fields of an interlaced picture have the same number of lines.
        if self.interlace == 1 && !self.height.is_multiple_of(2) {
            return wrong("height", "an even number of interlaced lines".to_owned(), self.height.to_string());
        }
        if self.interlace == 1 && (self.scan == 1 || self.direction > 1) {
            let expected = "0: an interlaced scan is rolling, and goes down or up".to_owned();
            return wrong("interlace", expected, "1".to_owned());
        }
        if !self.bits.is_multiple_of(3) {
            return wrong("bits", "a multiple of 3, as many for each primary".to_owned(), self.bits.to_string());
        }
        Ok(())
    }
}
