use super::{Detection, PendulumRig, ScopeTrace};
use crate::time::{nearest_ps, span_s};
use crate::tracker::TrackerModel;

/// The report by which the host detects a low point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LowPointReport {
    /// Time stamp of the report, ps: the instant at which its position was true.
    pub measured_ps: u64,
    /// Instant at which the report reaches the host, ps. The host starts a frame at this instant.
    pub arrives_ps: u64,
}

/// One pass of the bob, measured by the system's own time stamps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InsidePass {
    /// Report by which the host detected the low point.
    pub sighting: LowPointReport,
    /// Start of the frame that the low point requested, ps.
    pub started_ps: u64,
    /// Instant at which the frame is shown according to the pipeline, ps.
    pub shown_ps: u64,
}

/// One pass of the bob, measured on the oscilloscope without any time stamp of the system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutsidePass {
    /// Instant of the low point, ps.
    pub low_point_ps: u64,
    /// Instant of the step on the D/A line, ps.
    pub dac_ps: u64,
    /// Instant at which the photodiode on the screen steps to the level of the D/A line, ps.
    pub light_ps: u64,
}

/// Statistics of a latency over all passes, in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Latency {
    /// Number of passes of the bob.
    pub n: usize,
    /// Mean latency over the passes, seconds.
    pub mean_s: f64,
    /// Sample standard deviation (division by n - 1), seconds, or NaN for a single pass.
    pub deviation_s: f64,
    /// Latency of the fastest pass, seconds.
    pub least_s: f64,
    /// Latency of the slowest pass, seconds.
    pub greatest_s: f64,
}

impl Latency {
    fn over<P>(passes: &[P], span: impl Fn(&P) -> (u64, u64)) -> Self {
        let spans: Vec<f64> = passes.iter().map(span).map(|(from, to)| span_s(from, to)).collect();
        let n = spans.len();
        let mean_s = spans.iter().sum::<f64>() / n as f64;
        // One pass has no deviation: the division gives NaN.
        let variance = spans.iter().map(|s| (s - mean_s) * (s - mean_s)).sum::<f64>() / (n as f64 - 1.0);
        Self {
            n,
            mean_s,
            deviation_s: variance.sqrt(),
            least_s: spans.iter().copied().fold(f64::INFINITY, f64::min),
            greatest_s: spans.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }
}

/// The latencies of all passes, measured either from outside or from inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// Latency from the head to the start of the frame. Outside it begins at the low point, inside at the report's time
    /// stamp.
    pub tracking: Latency,
    /// Latency from the start of the frame to the screen. Outside it ends with light on the photodiode, inside when the
    /// frame is shown.
    pub rendering: Latency,
    /// Sum of tracking and rendering latency, from head to light.
    pub total: Latency,
}

impl Side {
    fn outside(passes: &[OutsidePass]) -> Self {
        Self {
            tracking: Latency::over(passes, |p| (p.low_point_ps, p.dac_ps)),
            rendering: Latency::over(passes, |p| (p.dac_ps, p.light_ps)),
            total: Latency::over(passes, |p| (p.low_point_ps, p.light_ps)),
        }
    }

    fn inside(passes: &[InsidePass]) -> Self {
        Self {
            tracking: Latency::over(passes, |p| (p.sighting.measured_ps, p.started_ps)),
            rendering: Latency::over(passes, |p| (p.started_ps, p.shown_ps)),
            total: Latency::over(passes, |p| (p.sighting.measured_ps, p.shown_ps)),
        }
    }
}

/// Bound of the rounding error of a mean, seconds: one picosecond, the unit of all instants.
const ROUNDING_S: f64 = 1e-12;

/// Both measurements of the same passes, and the bounds of their difference.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// Measurements from outside, in the order of the passes.
    pub outside_passes: Vec<OutsidePass>,
    /// Measurements from inside, in the order of the passes.
    pub inside_passes: Vec<InsidePass>,
    /// Latencies measured with the oscilloscope and the photodiodes.
    pub outside: Side,
    /// Latencies measured by the time stamps of host and boards.
    pub inside: Side,
    /// Bound of the excess of outside tracking over inside tracking: the detection's delay, one report interval for a
    /// crossing.
    pub tracking_bound_ps: u64,
    /// Bound of the excess of outside rendering over inside rendering: the photodiode's delay in the scan.
    pub rendering_bound_ps: u64,
    /// Bound by which outside rendering can be shorter than inside rendering. The bound is 0 unless the pipeline counts
    /// a frame as shown during the scan, at a line below the photodiode.
    pub rendering_early_ps: u64,
}

impl Measurement {
    /// Combines the passes of both measurements. `place_ps` is the photodiode's delay in the scan, counted from the
    /// retrace.
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

    /// Returns the measurement for a pipeline that counts a frame as shown `counted_ps` after the retrace. The beam
    /// passes a photodiode above this line earlier, so outside rendering can be shorter than inside rendering.
    #[must_use]
    pub fn with_frames_counted_in_scan(mut self, counted_ps: u64) -> Self {
        self.rendering_early_ps = counted_ps.saturating_sub(self.rendering_bound_ps);
        self
    }

    /// Returns the bound of the difference between the total latencies. For detection by crossing it is one report
    /// interval plus the photodiode's delay in the scan.
    #[must_use]
    pub fn bound_ps(&self) -> u64 {
        self.tracking_bound_ps + self.rendering_bound_ps
    }

    /// Returns the mean total latency from outside minus the mean total latency from inside, seconds.
    #[must_use]
    pub fn outside_less_inside_s(&self) -> f64 {
        self.outside.total.mean_s - self.inside.total.mean_s
    }

    /// Returns true if both measurements agree on average over the passes. Outside tracking may exceed inside tracking
    /// by at most one report interval (for a crossing). Outside rendering may exceed inside rendering by at most the
    /// photodiode's delay in the scan. Outside rendering may be shorter only if the pipeline counts frames during the
    /// scan.
    #[must_use]
    pub fn agrees(&self) -> bool {
        let tracking_s = self.outside.tracking.mean_s - self.inside.tracking.mean_s;
        let rendering_s = self.outside.rendering.mean_s - self.inside.rendering.mean_s;
        let most_tracking_s = span_s(0, self.tracking_bound_ps) + ROUNDING_S;
        let most_rendering_s = span_s(0, self.rendering_bound_ps) + ROUNDING_S;
        let least_rendering_s = -span_s(0, self.rendering_early_ps) - ROUNDING_S;
        (-ROUNDING_S..=most_tracking_s).contains(&tracking_s)
            && (least_rendering_s..=most_rendering_s).contains(&rendering_s)
    }
}

/// The traces of the oscilloscope's three channels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Oscilloscope {
    /// Photodiode at the low point: one pulse for each low point, centred on its instant.
    pub low_point: ScopeTrace,
    /// D/A line: one step for each frame that a low point requested.
    pub dac: ScopeTrace,
    /// Photodiode on the screen: dark and light frames.
    pub screen: ScopeTrace,
}

impl Oscilloscope {
    /// Creates an oscilloscope with a pulse for every low point up to the last step of the D/A line. The width of a
    /// pulse is the time that the bob takes to cross the LED's beam.
    #[must_use]
    pub fn of(rig: &PendulumRig, dac: ScopeTrace, screen: ScopeTrace) -> Self {
        let last_ps = dac.edges().last().map_or(0, |edge| edge.t_ps);
        let low_points = (0..).map(|n| rig.pendulum.low_point_ps(n)).take_while(|t_ps| *t_ps <= last_ps);
        let pulse_ps = nearest_ps((rig.beam_m / rig.pendulum.low_point_speed()).clamp(0.0, 1.0));
        Self { low_point: ScopeTrace::pulsing("low point", low_points, pulse_ps), dac, screen }
    }

    /// Reads the passes off the traces. Each step of the D/A line gives one pass with its low point and the next step
    /// of the screen to the same level. Returns `None` if the screen lacks one of these steps.
    #[must_use]
    pub fn passes(&self, rig: &PendulumRig) -> Option<Vec<OutsidePass>> {
        let passes = self.dac.edges().iter().map(|step| {
            let light = self.screen.edges().iter().find(|edge| edge.t_ps >= step.t_ps && edge.high == step.high)?;
            Some(OutsidePass { low_point_ps: rig.low_point_before(step.t_ps), dac_ps: step.t_ps, light_ps: light.t_ps })
        });
        passes.collect()
    }
}
