use super::{Detection, PendulumRig, ScopeTrace};
use crate::time::{nearest_ps, span_s};
use crate::tracker::TrackerModel;
use pxpl5_sim::Statistics;
use serde::Serialize;

/// The report by which the host detects that the pendulum has passed its lowest point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LowPointReport {
    /// Time stamp of the report, ps: the instant at which its position was true.
    pub measured_ps: u64,
    /// Instant at which the report reaches the host, ps. The host starts a frame at this instant.
    pub arrives_ps: u64,
}

/// One pass of the pendulum through its lowest point, measured by the time stamps of the emulated system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InsidePass {
    /// Tracker report by which the host detected the pass.
    pub sighting: LowPointReport,
    /// Instant at which the host started a frame because of the pass, ps.
    pub started_ps: u64,
    /// Instant at which the pipeline counts this frame as shown, ps.
    pub shown_ps: u64,
}

/// One pass of the pendulum through its lowest point, measured on the oscilloscope without any time stamp of the
/// system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutsidePass {
    /// Instant at which the photodiode detects the pendulum at its lowest point, ps.
    pub low_point_ps: u64,
    /// Instant at which the host switches its D/A output because the host has detected the pass, ps.
    pub dac_ps: u64,
    /// Instant at which the photodiode on the screen detects the frame that was requested because of this pass, ps.
    pub light_ps: u64,
}

fn over<P>(passes: &[P], span: impl Fn(&P) -> (u64, u64)) -> Statistics {
    Statistics::of(passes.iter().map(span).map(|(from, to)| span_s(from, to)))
}

/// Tracking, rendering and total latency over all passes in seconds, measured with the oscilloscope ("outside") or by
/// time stamps ("inside").
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Side {
    /// Latency from the pendulum's motion to the start of a frame. The outside latency begins when the pendulum passes
    /// its lowest point. The inside latency begins at the report's time stamp.
    pub tracking: Statistics,
    /// Latency from the start of a frame to its display. The outside latency ends when the photodiode detects the
    /// frame. The inside latency ends when the pipeline counts the frame as shown.
    pub rendering: Statistics,
    /// Sum of tracking and rendering latency of each pass, from the motion to the display.
    pub total: Statistics,
}

impl Side {
    /// Returns the latencies in milliseconds instead of seconds.
    #[must_use]
    pub fn in_ms(&self) -> Self {
        let in_ms = |latency: Statistics| {
            let Statistics { n, mean, sd, min, max } = latency;
            Statistics { n, mean: mean * 1e3, sd: sd * 1e3, min: min * 1e3, max: max * 1e3 }
        };
        let Self { tracking, rendering, total } = *self;
        Self { tracking: in_ms(tracking), rendering: in_ms(rendering), total: in_ms(total) }
    }

    fn outside(passes: &[OutsidePass]) -> Self {
        Self {
            tracking: over(passes, |p| (p.low_point_ps, p.dac_ps)),
            rendering: over(passes, |p| (p.dac_ps, p.light_ps)),
            total: over(passes, |p| (p.low_point_ps, p.light_ps)),
        }
    }

    fn inside(passes: &[InsidePass]) -> Self {
        Self {
            tracking: over(passes, |p| (p.sighting.measured_ps, p.started_ps)),
            rendering: over(passes, |p| (p.started_ps, p.shown_ps)),
            total: over(passes, |p| (p.sighting.measured_ps, p.shown_ps)),
        }
    }
}

/// Greatest rounding error of a mean latency, seconds: one picosecond, the unit of all instants.
const ROUNDING_S: f64 = 1e-12;

/// Latencies of the same passes of the pendulum, measured by oscilloscope ("outside") and by time stamps ("inside").
/// The measurement also has limits for the differences between outside and inside latencies.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// Measurements with the oscilloscope, one for each pass of the pendulum in order.
    pub outside_passes: Vec<OutsidePass>,
    /// Measurements by time stamps, one for each pass of the pendulum in order.
    pub inside_passes: Vec<InsidePass>,
    /// Latencies measured with the oscilloscope and the photodiodes.
    pub outside: Side,
    /// Latencies measured by the time stamps of host and boards.
    pub inside: Side,
    /// Greatest amount by which the tracking latency on the oscilloscope may exceed the tracking latency by time
    /// stamps, ps. The amount is the delay of the detection: one report interval for detection by crossing the
    /// vertical.
    pub tracking_bound_ps: u64,
    /// Greatest amount by which the rendering latency on the oscilloscope may exceed the rendering latency by time
    /// stamps, ps. The amount is the time from the retrace until the beam passes the photodiode.
    pub rendering_bound_ps: u64,
    /// Greatest amount by which the rendering latency on the oscilloscope may be shorter than the rendering latency by
    /// time stamps, ps. The amount is 0 unless the pipeline counts a frame as shown at a scanline below the photodiode.
    pub rendering_early_ps: u64,
}

impl Measurement {
    /// Combines the measurements by oscilloscope and by time stamps. `place_ps` is the time from the retrace until the
    /// beam passes the photodiode.
    pub(super) fn new(
        detection: Detection,
        tracker: &TrackerModel,
        place_ps: u64,
        outside_passes: Vec<OutsidePass>,
        inside_passes: Vec<InsidePass>,
    ) -> Self {
        Self {
            outside: Side::outside(&outside_passes),
            inside: Side::inside(&inside_passes),
            tracking_bound_ps: tracker.report_interval_ps() * detection.greatest_delay_half_intervals() / 2,
            rendering_bound_ps: place_ps,
            rendering_early_ps: 0,
            outside_passes,
            inside_passes,
        }
    }

    /// Returns the measurement for a pipeline that counts a frame as shown `counted_ps` after the retrace. If the beam
    /// passes the photodiode earlier, the rendering latency on the oscilloscope can be shorter than the rendering
    /// latency by time stamps.
    #[must_use]
    pub fn with_frames_counted_in_scan(mut self, counted_ps: u64) -> Self {
        self.rendering_early_ps = counted_ps.saturating_sub(self.rendering_bound_ps);
        self
    }

    /// Returns the greatest difference between the two measured total latencies, ps. For detection by crossing, this
    /// difference is one report interval, plus the time from the retrace until the beam passes the photodiode.
    pub fn bound_ps(&self) -> u64 {
        self.tracking_bound_ps + self.rendering_bound_ps
    }

    /// Returns the mean total latency on the oscilloscope minus the mean total latency by time stamps, seconds.
    pub fn outside_less_inside_s(&self) -> f64 {
        self.outside.total.mean - self.inside.total.mean
    }

    /// Returns true if both measurements agree on average over all passes. "Outside" is the oscilloscope, and "inside"
    /// is the time stamps. The outside tracking latency may exceed the inside tracking latency by at most one report
    /// interval (detection by crossing). The outside rendering latency may exceed the inside rendering latency by at
    /// most the time from the retrace until the beam passes the photodiode. The outside rendering latency may be
    /// smaller only if the pipeline counts frames as shown during the scan.
    pub fn agrees(&self) -> bool {
        let tracking_s = self.outside.tracking.mean - self.inside.tracking.mean;
        let rendering_s = self.outside.rendering.mean - self.inside.rendering.mean;
        let most_tracking_s = span_s(0, self.tracking_bound_ps) + ROUNDING_S;
        let most_rendering_s = span_s(0, self.rendering_bound_ps) + ROUNDING_S;
        let least_rendering_s = -span_s(0, self.rendering_early_ps) - ROUNDING_S;
        (-ROUNDING_S..=most_tracking_s).contains(&tracking_s)
            && (least_rendering_s..=most_rendering_s).contains(&rendering_s)
    }
}

/// The traces of an oscilloscope with three channels: the pendulum at its lowest point, the host's D/A output and the
/// screen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Oscilloscope {
    /// Trace of the photodiode at the lowest point of the pendulum. The trace has one pulse for each pass of the
    /// pendulum, centred on the instant of the lowest point.
    pub low_point: ScopeTrace,
    /// Trace of the host's D/A output, with one step for each frame that was requested because of a pass.
    pub dac: ScopeTrace,
    /// Trace of the photodiode on the screen, low for dark frames and high for light frames.
    pub screen: ScopeTrace,
}

impl Oscilloscope {
    /// Creates an oscilloscope whose first channel has a pulse for every pass of the pendulum up to the last step of
    /// the host's D/A output. A pulse lasts as long as the pendulum takes to cross the light beam.
    pub fn of(rig: &PendulumRig, dac: ScopeTrace, screen: ScopeTrace) -> Self {
        let last_ps = dac.edges().last().map_or(0, |edge| edge.t_ps);
        let low_points = (0..).map(|n| rig.pendulum.low_point_ps(n)).take_while(|t_ps| *t_ps <= last_ps);
        let pulse_ps = nearest_ps((rig.beam_m / rig.pendulum.low_point_speed()).clamp(0.0, 1.0));
        Self { low_point: ScopeTrace::pulsing("low point", low_points, pulse_ps), dac, screen }
    }

    /// Finds the passes of the pendulum in the traces. Each step of the host's D/A output gives one pass. The instant
    /// of the lowest point lies before this step. After this step, the screen changes to the same level (high for light
    /// frames). Returns `None` if the screen lacks one of these changes.
    pub fn passes(&self, rig: &PendulumRig) -> Option<Vec<OutsidePass>> {
        let passes = self.dac.edges().iter().map(|step| {
            let light = self.screen.edges().iter().find(|edge| edge.t_ps >= step.t_ps && edge.high == step.high)?;
            Some(OutsidePass { low_point_ps: rig.low_point_before(step.t_ps), dac_ps: step.t_ps, light_ps: light.t_ps })
        });
        passes.collect()
    }
}
