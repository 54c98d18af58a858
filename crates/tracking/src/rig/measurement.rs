use super::{Detection, PendulumRig, ScopeTrace};
use crate::time::{nearest_ps, span_s};
use crate::tracker::TrackerModel;

/// A low point as the host sees it: the report that shows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sighting {
    /// When the position that shows it was true, ps: what the report's time stamp says.
    pub measured_ps: u64,
    /// When the report reached the host, which starts a frame then, ps.
    pub arrives_ps: u64,
}

/// What the system's own time stamps say of one pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InsidePass {
    /// The host's sight of the low point.
    pub sighting: Sighting,
    /// When the frame that it asked for was started, ps.
    pub started_ps: u64,
    /// When that frame was shown, ps, as the pipeline counts it.
    pub shown_ps: u64,
}

/// What the oscilloscope shows of one pass: nothing of it comes from the system's time stamps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutsidePass {
    /// When the bob was lowest, ps.
    pub low_point_ps: u64,
    /// The step of the D/A line, ps.
    pub dac_ps: u64,
    /// The step of the photodiode on the screen to the same level, ps.
    pub light_ps: u64,
}

/// A latency over all passes, seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Latency {
    /// Passes of the bob that it is over.
    pub n: usize,
    /// Mean over the passes, seconds.
    pub mean_s: f64,
    /// Standard deviation of the passes (divided by their number less one; of one pass not a number), seconds.
    pub deviation_s: f64,
    /// That of the fastest pass, seconds.
    pub least_s: f64,
    /// That of the slowest pass, seconds.
    pub greatest_s: f64,
}

impl Latency {
    fn over<P>(passes: &[P], span: impl Fn(&P) -> (u64, u64)) -> Self {
        let spans: Vec<f64> = passes.iter().map(span).map(|(from, to)| span_s(from, to)).collect();
        let n = spans.len();
        let mean_s = spans.iter().sum::<f64>() / n as f64;
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

/// Latencies of the same passes from one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// From the head (outside: the bob's low point; inside: the time stamp of the report) to the start of the frame.
    pub tracking: Latency,
    /// From the start of the frame to the screen (outside: light under the photodiode; inside: the frame is shown).
    pub rendering: Latency,
    /// Tracking and rendering together, from head to light.
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

/// Means of seconds are rounded by less than the picosecond in which all instants are given.
const ROUNDING_S: f64 = 1e-12;

/// Both measurements of the same passes, and by how much they may differ.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// From outside, in the order of the passes.
    pub outside_passes: Vec<OutsidePass>,
    /// From inside, in the same order.
    pub inside_passes: Vec<InsidePass>,
    /// What oscilloscope and photodiodes say.
    pub outside: Side,
    /// What the time stamps of host and boards say.
    pub inside: Side,
    /// How much longer tracking may be from outside: the detection's delay, one report interval for a crossing.
    pub tracking_bound_ps: u64,
    /// How much longer rendering may be from outside: the photodiode's place in the scan.
    pub rendering_bound_ps: u64,
    /// How much shorter rendering may be from outside: 0 unless the pipeline counts a frame as shown inside the scan, below the
    /// photodiode.
    pub rendering_early_ps: u64,
}

impl Measurement {
    /// Of passes as they were read off the oscilloscope and off the time stamps; `place_ps` is the photodiode's place in the
    /// scan, from the retrace on.
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
            tracking_bound_ps: tracker.report_interval_ps() * detection.half_intervals_late() / 2,
            rendering_bound_ps: place_ps,
            rendering_early_ps: 0,
            outside_passes,
            inside_passes,
        }
    }

    /// The same of a pipeline that counts a frame as shown `counted_ps` behind the retrace: the beam passes a photodiode that hangs
    /// higher before that.
    #[must_use]
    pub fn counted_in_the_scan(mut self, counted_ps: u64) -> Self {
        self.rendering_early_ps = counted_ps.saturating_sub(self.rendering_bound_ps);
        self
    }

    /// One report interval plus the photodiode's place in the scan (for detection by crossing): how far the total
    /// latencies from outside and inside may differ.
    #[must_use]
    pub fn bound_ps(&self) -> u64 {
        self.tracking_bound_ps + self.rendering_bound_ps
    }

    /// Mean total latency from outside less that from inside, seconds.
    #[must_use]
    pub fn outside_less_inside_s(&self) -> f64 {
        self.outside.total.mean_s - self.inside.total.mean_s
    }

    /// Returns true if both measurements agree on average over the passes. Outside tracking is longer by 0 to one report interval,
    /// outside rendering by 0 to the photodiode's place in the scan. Light before a frame is shown is no agreement, unless the
    /// pipeline counts frames inside the scan.
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

/// The channels of the oscilloscope.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Oscilloscope {
    /// Photodiode at the low point: a pulse for each, half of it before.
    pub low_point: ScopeTrace,
    /// D/A line: a step for each frame that a low point asked for.
    pub dac: ScopeTrace,
    /// Photodiode on the screen: dark and light frames.
    pub screen: ScopeTrace,
}

impl Oscilloscope {
    /// With a pulse for every low point of the pendulum up to the last step of the D/A line, as wide as the bob is in the LED's
    /// beam.
    #[must_use]
    pub fn of(rig: &PendulumRig, dac: ScopeTrace, screen: ScopeTrace) -> Self {
        let last_ps = dac.edges().last().map_or(0, |edge| edge.t_ps);
        let low_points = (0..).map(|n| rig.pendulum.low_point_ps(n)).take_while(|t_ps| *t_ps <= last_ps);
        let pulse_ps = nearest_ps((rig.beam_m / rig.pendulum.low_point_speed()).clamp(0.0, 1.0));
        Self { low_point: ScopeTrace::pulsing("low point", low_points, pulse_ps), dac, screen }
    }

    /// The passes as they are read off it: for each step of the D/A line the low point that it belongs to, and the next step of
    /// the screen to the same level; `None` where the screen never gets there.
    #[must_use]
    pub fn passes(&self, rig: &PendulumRig) -> Option<Vec<OutsidePass>> {
        let passes = self.dac.edges().iter().map(|step| {
            let light = self.screen.edges().iter().find(|edge| edge.t_ps >= step.t_ps && edge.high == step.high)?;
            Some(OutsidePass { low_point_ps: rig.low_point_of(step.t_ps), dac_ps: step.t_ps, light_ps: light.t_ps })
        });
        passes.collect()
    }
}
