//! What came of an experiment as a few numbers, whatever the level of modelling.

use crate::due::DuePictures;
use crate::samples::Samples;
use crate::statistics::Statistics;

/// What came of an experiment at any level of modelling, over the pictures in the window of the run.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Latency of every complete picture as its pipeline defines it, milliseconds.
    pub latencies_ms: Samples,
    /// A period of the display, milliseconds: an NTSC field.
    pub field_ms: f64,
    /// Whole pictures shown a second, over the window of `due`; `None` where fewer than two were shown.
    pub updates_hz: Option<f64>,
    /// The pictures that were due, and what became of them; `None` where none was.
    pub due: Option<DuePictures>,
    /// From the start of an eye's TRANSFORM to the end of its COPY, milliseconds; empty where eyes have none of their own.
    pub eye_latencies_ms: Samples,
    /// From the start of an eye's TRANSFORM to the retrace at which its picture is swapped in, milliseconds; empty where eyes have none
    /// of their own.
    pub eye_swap_latencies_ms: Samples,
    /// The same in retraces: up to and with the one of the swap.
    pub eye_retraces: Samples,
    /// Port time of a region of 15,360 pixels, microseconds; no number where none came.
    pub region_copy_us: f64,
    /// First to last word of a picture's first copy (see [`Pipeline::copy_part`](crate::Pipeline::copy_part)), milliseconds.
    pub first_copy_ms: f64,
    /// The same of its second copy; 0 where pictures have none. Of no picture there is no number, as of the first copy.
    pub last_copy_ms: f64,
    /// From the start of a picture to the first word of its first copy, milliseconds.
    pub copy_begins_ms: f64,
}

impl Summary {
    /// The latencies' mean, deviation, least and greatest, milliseconds.
    #[must_use]
    pub fn latency_ms(&self) -> Statistics {
        self.latencies_ms.statistics()
    }

    /// The mean over both eyes, each from the start of its own TRANSFORM to the swap, milliseconds; of nothing where eyes have none of
    /// their own.
    #[must_use]
    pub fn eye_latency_ms(&self) -> Statistics {
        self.eye_swap_latencies_ms.statistics()
    }

    /// The same in retraces: up to and with the one of the swap.
    #[must_use]
    pub fn eye_retraces(&self) -> Statistics {
        self.eye_retraces.statistics()
    }

    /// Latency in periods of the display: for NTSC, fields of 1001/60000 s.
    #[must_use]
    pub fn latency_fields(&self) -> Statistics {
        self.latencies_ms.statistics_in(self.field_ms)
    }
}

/// Retraces in a latency that ends with one, that one included: whole periods of the display of `field_ms`.
#[must_use]
pub fn retraces(latency_ms: f64, field_ms: f64) -> f64 {
    /// A latency of exactly so many periods ends with a retrace, whatever the last bit of the quotient is.
    const ROUNDING: f64 = 1e-9;
    (latency_ms / field_ms - ROUNDING).ceil()
}
