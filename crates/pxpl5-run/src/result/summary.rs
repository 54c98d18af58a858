use crate::result::due::DuePictures;
use pxpl5_sim::Samples;
use pxpl5_sim::Statistics;

/// Results of an experiment that are available at every level of detail, over the pictures in the result window.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// Latency of every complete picture, by the pipeline's definition, in milliseconds.
    pub latencies_ms: Samples,
    /// Duration of a display period, in milliseconds. For NTSC, a period is a field.
    pub field_ms: f64,
    /// Number of complete pictures shown per second, over the result window. `None` if fewer than two pictures were
    /// shown.
    pub updates_hz: Option<f64>,
    /// Numbers of due pictures, by result. `None` if no picture was due.
    pub due: Option<DuePictures>,
    /// Times from the start of an eye's TRANSFORM to the end of its COPY, in milliseconds. Empty if the eyes share one
    /// TRANSFORM or COPY.
    pub eye_latencies_ms: Samples,
    /// Times from the start of an eye's TRANSFORM to the retrace at which its picture is swapped in, in milliseconds.
    /// Empty if the eyes share one TRANSFORM.
    pub eye_swap_latencies_ms: Samples,
    /// Numbers of retraces from the start of an eye's TRANSFORM to the swap, including the retrace of the swap.
    pub eye_retraces: Samples,
    /// Time for which one region of 15,360 pixels occupies a port of the display, in microseconds. NaN if no region
    /// arrived.
    pub region_copy_us: f64,
    /// Mean duration of the first of a picture's copies, in milliseconds: the first eye, or the upper half of a field.
    /// See [`PictureRules::copy_part`](crate::PictureRules::copy_part).
    pub first_copy_ms: f64,
    /// Mean duration of the second of a picture's copies, in milliseconds. Zero if pictures have only one copy. NaN if
    /// no picture was drawn.
    pub last_copy_ms: f64,
    /// Mean time from the start of TRANSFORM to the first word of the first copy, in milliseconds.
    pub copy_begins_ms: f64,
}

impl Summary {
    /// Returns the statistics of the latencies, in milliseconds.
    pub fn latency_ms(&self) -> Statistics {
        self.latencies_ms.statistics()
    }

    /// Returns the statistics of the latencies in periods of the display. For NTSC, a period is a field of 1001/60000
    /// s.
    pub fn latency_fields(&self) -> Statistics {
        self.latencies_ms.statistics_in(self.field_ms)
    }
}

/// Returns the number of retraces in a latency that ends with a retrace, including this retrace. `field_ms` is the
/// duration of a display period in milliseconds.
pub fn retraces(latency_ms: f64, field_ms: f64) -> f64 {
    /// Tolerance in display periods. Without this tolerance, rounding errors would change the result for a latency of a
    /// whole number of periods.
    const ROUNDING: f64 = 1e-9;
    (latency_ms / field_ms - ROUNDING).ceil()
}
