//! The numbers of a panel, whichever table they come from.

use parameters::{ParameterTable, Value};
use pxpl5_display::{DisplayError, Light, Scan};
use pxpl5_sim::Span;
use pxpl5_wire::REGION_SIZE;

/// Regions of a picture that firmware can tell apart: the masks of `pxpl5-geometry` have as many bits.
const MOST_REGIONS: u64 = 128;

/// Microseconds of a second.
const US_PER_S: u64 = 1_000_000;

/// The numbers of a display without NTSC timing. A table that leaves one out has its default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PanelNumbers {
    /// Visible pixels of a line.
    pub width: u64,
    /// Visible lines.
    pub height: u64,
    /// Scans a second.
    pub refresh_hz: u64,
    /// 1 if a scan lights every second line only, 0 if it lights all of them.
    pub interlace: u64,
    /// 0 if pixels light one after the other, 1 if all light at once.
    pub scan: u64,
    /// The way of a rolling scan: 0 down, 1 up, 2 right, 3 left.
    pub direction: u64,
    /// Thousandths of the period in which pixels light; at their end a global display lights.
    pub active_permille: u64,
    /// Time for which a pixel is driven, microseconds.
    pub persistence_us: u64,
    /// Time constant of a pixel, microseconds.
    pub response_us: u64,
    /// Ports of a board on the ring.
    pub ports: u64,
    /// Time of one word at a port, nanoseconds.
    pub word_ns: u64,
    /// Bits of a pixel's colour, a third for each primary.
    pub bits: u64,
}

impl PanelNumbers {
    /// Reads the numbers of a table.
    ///
    /// A number that the table leaves out has its default: a rolling scan of every line from the top, which fills the
    /// period. A pixel lights for an instant and has 24 bits. A board has one port of 20 million words a second.
    #[must_use]
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
            word_ns: number("word_ns", 50),
            bits: number("bits", 24),
        }
    }

    /// Returns the light of its pixels.
    #[must_use]
    pub const fn light(&self) -> Light {
        let scan = match (self.scan, self.direction) {
            (1, _) => Scan::Global,
            (_, 1) => Scan::Up,
            (_, 2) => Scan::Right,
            (_, 3) => Scan::Left,
            _ => Scan::Down,
        };
        let [persistence, response] = [Span::from_us(self.persistence_us), Span::from_us(self.response_us)];
        Light { scan, persistence, response }
    }

    /// Checks the rules between numbers; `table` begins the names in messages.
    ///
    /// # Errors
    ///
    /// [`DisplayError`] names the number, what was expected and what was found.
    pub fn check(&self, table: &str) -> Result<(), DisplayError> {
        let wrong = |name: &str, expected: String, found: String| {
            Err(DisplayError(format!("{table}.{name}: expected {expected}, found {found}")))
        };
        let size = u64::from(REGION_SIZE);
        let regions = self.width.div_ceil(size) * self.height.div_ceil(size);
        if regions > MOST_REGIONS {
            let expected = format!("at most {MOST_REGIONS} regions of {size} x {size}, as many as firmware can number");
            return wrong("width", expected, format!("{regions} ({} x {} pixels)", self.width, self.height));
        }
        let period_us = US_PER_S / self.refresh_hz;
        if self.persistence_us > period_us {
            let expected = format!("0 to {period_us}, a period of {} Hz", self.refresh_hz);
            return wrong("persistence_us", expected, self.persistence_us.to_string());
        }
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
