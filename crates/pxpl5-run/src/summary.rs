//! Summary of a run in a few numbers that all levels of modelling provide.

use crate::due::DuePictures;
use crate::samples::Samples;
use crate::statistics::Statistics;

/// Results of an experiment that all levels of modelling provide, over the pictures in the window of the run.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Latency of every complete picture, as its pipeline defines latency, in milliseconds.
    pub latencies_ms: Samples,
    /// Period of the display, in milliseconds. For NTSC, the period is a field.
    pub field_ms: f64,
    /// Number of complete pictures shown a second, over the window of `due`. `None` if fewer than two were shown.
    pub updates_hz: Option<f64>,
    /// Counts of the pictures that were due, by result. `None` if no picture was due.
    pub due: Option<DuePictures>,
    /// Times from the start of an eye's TRANSFORM to the end of its COPY, in milliseconds. Empty if eyes have no
    /// TRANSFORM and COPY of their own.
    pub eye_latencies_ms: Samples,
    /// Times from the start of an eye's TRANSFORM to the retrace at which its picture is swapped in, in milliseconds.
    /// Empty if eyes have no TRANSFORM of their own.
    pub eye_swap_latencies_ms: Samples,
    /// Times from the start of an eye's TRANSFORM to the swap, in retraces. The retrace of the swap counts.
    pub eye_retraces: Samples,
    /// Port time of a region of 15,360 pixels, in microseconds. NaN if no region arrived.
    pub region_copy_us: f64,
    /// Mean time from the first to the last word of a picture's first copy, in milliseconds. See
    /// [`Pipeline::copy_part`](crate::Pipeline::copy_part).
    pub first_copy_ms: f64,
    /// Mean time from the first to the last word of a picture's second copy, in milliseconds. 0 if pictures have one
    /// copy only. NaN without any picture.
    pub last_copy_ms: f64,
    /// Mean time from the start of a picture to the first word of its first copy, in milliseconds.
    pub copy_begins_ms: f64,
}

impl Summary {
    /// Returns the statistics of the latencies, in milliseconds.
    #[must_use]
    pub fn latency_ms(&self) -> Statistics {
        self.latencies_ms.statistics()
    }

    /// Returns the statistics of the times from an eye's TRANSFORM to the swap, over both eyes, in milliseconds. The
    /// statistics are empty if eyes have no TRANSFORM of their own.
    #[must_use]
    pub fn eye_latency_ms(&self) -> Statistics {
        self.eye_swap_latencies_ms.statistics()
    }

    /// Returns the statistics of the times from an eye's TRANSFORM to the swap, in retraces. The retrace of the swap
    /// counts.
    #[must_use]
    pub fn eye_retraces(&self) -> Statistics {
        self.eye_retraces.statistics()
    }

    /// Returns the statistics of the latencies in periods of the display. For NTSC, a period is a field of 1001/60000
    /// s.
    #[must_use]
    pub fn latency_fields(&self) -> Statistics {
        self.latencies_ms.statistics_in(self.field_ms)
    }
}

/// Returns the number of retraces in a latency that ends with a retrace. The last retrace counts. `field_ms` is the
/// period of the display in milliseconds.
#[must_use]
pub fn retraces(latency_ms: f64, field_ms: f64) -> f64 {
    /// Tolerance, in periods, that absorbs the rounding of the quotient. A latency of a whole number of periods must
    /// give exactly this number.
    const ROUNDING: f64 = 1e-9;
    (latency_ms / field_ms - ROUNDING).ceil()
}
