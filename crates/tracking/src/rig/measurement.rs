use super::{PendulumRig, Trace};
use crate::time::{nearest_ps, ntsc_lines_ps, span_s};
use crate::tracker::TrackerModel;

/// One pass through the low point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pass {
    /// When the bob was lowest, ps.
    pub low_point_ps: u64,
    /// When the position that showed it was true, ps: what the host's time stamp says.
    pub measured_ps: u64,
    /// When the host saw it, switched the D/A line and started a frame, ps.
    pub dac_ps: u64,
    /// When the scan of that frame began, ps: the inside end of the measurement.
    pub scan_ps: u64,
    /// When the photodiode on the screen saw it, ps.
    pub light_ps: u64,
}

/// A latency over all passes, seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Latency {
    /// Mean over the passes, seconds.
    pub mean_s: f64,
    /// Standard deviation over the passes (divided by their number), seconds.
    pub deviation_s: f64,
    /// That of the fastest pass, seconds.
    pub least_s: f64,
    /// That of the slowest pass, seconds.
    pub greatest_s: f64,
}

impl Latency {
    fn over(passes: &[Pass], span: impl Fn(&Pass) -> (u64, u64)) -> Self {
        let spans: Vec<f64> = passes.iter().map(span).map(|(from, to)| span_s(from, to)).collect();
        let n = spans.len() as f64;
        let mean_s = spans.iter().sum::<f64>() / n;
        let variance = spans.iter().map(|s| (s - mean_s).powi(2)).sum::<f64>() / n;
        Self {
            mean_s,
            deviation_s: variance.sqrt(),
            least_s: spans.iter().copied().fold(f64::INFINITY, f64::min),
            greatest_s: spans.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }
}

/// What the oscilloscope shows, and what the time stamps inside say of the same passes.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// Photodiode at the low point: a pulse for each.
    pub low_point: Trace,
    /// D/A line of the host: a step for each low point seen.
    pub dac: Trace,
    /// Photodiode on the screen: dark and light frames.
    pub screen: Trace,
    /// The events behind the traces, one for each low point, in order.
    pub passes: Vec<Pass>,
    /// From outside: low point to D/A line.
    pub tracking: Latency,
    /// From outside: D/A line to light on the screen.
    pub rendering: Latency,
    /// From inside: time stamp of the report to its arrival.
    pub inside_tracking: Latency,
    /// From inside: start of the frame to the start of its scan.
    pub inside_rendering: Latency,
    /// How far outside and inside may differ in tracking: the detection's delay, one report interval for a crossing.
    pub tracking_bound_ps: u64,
    /// How far they differ in rendering: the photodiode's place in the scan.
    pub rendering_bound_ps: u64,
}

impl Measurement {
    pub(super) fn new(rig: &PendulumRig, tracker: &TrackerModel, passes: Vec<Pass>) -> Self {
        let pulse_ps = nearest_ps((rig.beam_m / rig.pendulum.low_point_speed()).clamp(0.0, 1.0));
        let late = rig.detection.half_intervals_late();
        Self {
            low_point: Trace::pulsing("low point", passes.iter().map(|p| p.low_point_ps), pulse_ps),
            dac: Trace::toggling("D/A line", passes.iter().map(|p| p.dac_ps).collect()),
            screen: Trace::toggling("screen", passes.iter().map(|p| p.light_ps).collect()),
            tracking: Latency::over(&passes, |p| (p.low_point_ps, p.dac_ps)),
            rendering: Latency::over(&passes, |p| (p.dac_ps, p.light_ps)),
            inside_tracking: Latency::over(&passes, |p| (p.measured_ps, p.dac_ps)),
            inside_rendering: Latency::over(&passes, |p| (p.dac_ps, p.scan_ps)),
            tracking_bound_ps: tracker.report_interval_ps() * late / 2,
            rendering_bound_ps: ntsc_lines_ps(rig.photodiode_line),
            passes,
        }
    }

    /// One report interval plus the photodiode's place in the scan (for detection by crossing): how far the total
    /// latencies from outside and inside may differ.
    pub fn bound_ps(&self) -> u64 {
        self.tracking_bound_ps + self.rendering_bound_ps
    }

    /// Total latency from outside less the total from inside, seconds.
    pub fn outside_less_inside_s(&self) -> f64 {
        self.tracking.mean_s + self.rendering.mean_s - self.inside_tracking.mean_s - self.inside_rendering.mean_s
    }
}
