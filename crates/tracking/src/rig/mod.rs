//! Latency measured from outside: the pendulum rig.
//!
//! An LED and a photodiode mark the low point of a pendulum's arc; a tracker on the bob feeds the host; when the host
//! sees the low point it starts a new frame and switches a D/A line; frames alternate dark and light under a photodiode
//! on the screen. On the oscilloscope, tracking latency is the way from the low point to the D/A line, rendering
//! latency from the D/A line to the screen (TR94).

mod detection;
mod measurement;
mod oscilloscope;

pub use detection::Detection;
pub use measurement::{Latency, Measurement, Pass};
pub use oscilloscope::{Edge, Trace};

use thiserror::Error;

use crate::config as table;
use crate::motion::Pendulum;
use crate::time::{PS_PER_S, ntsc_lines_ps};
use crate::tracker::TrackerModel;

/// Silence after which the rig gives up waiting for a low point.
const PATIENCE_PS: u64 = 10 * PS_PER_S;

/// The part of a half swing by which noise may make the host see a low point too early.
const EARLY_PART: u64 = 10;

/// The rig. Both the pendulum's pivot and the tracker's origin are the origin of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PendulumRig {
    /// The pendulum, closed form, undamped.
    pub pendulum: Pendulum,
    /// How the host finds the low point.
    pub detection: Detection,
    /// Width of the LED's beam, m.
    pub beam_m: f64,
    /// Visible line of the screen under the photodiode, 0 at the top.
    pub photodiode_line: u32,
}

/// Why a measurement failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RigError {
    /// The tracker fell silent, or never showed a low point.
    #[error("expected {expected} low points, the host saw {found}")]
    TooFewPasses {
        /// How many low points were asked for.
        expected: usize,
        /// How many low points the host saw.
        found: usize,
    },
    /// The pipeline put light on the screen before the frame was started.
    #[error("expected light after the frame's start at {started_ps} ps, found {found_ps} ps")]
    LightBeforeStart {
        /// When the frame was started, ps.
        started_ps: u64,
        /// When its light came, ps.
        found_ps: u64,
    },
}

impl PendulumRig {
    /// Arm 0.5 m, 20 degrees, low point by crossing the vertical, photodiode in the middle of the screen: all assumed.
    pub fn assumed() -> Self {
        Self {
            pendulum: Pendulum::rig(),
            detection: Detection::Crossing,
            beam_m: table::Rig::PAPERS.led_beam / 1e3,
            photodiode_line: table::Rig::PAPERS.photodiode_line as u32,
        }
    }

    /// Measures over `n_passes` low points, at least 1. `pipeline` maps the start of a frame to the instant at which
    /// the scan of that frame begins on the screen; the photodiode sees it `photodiode_line` lines later.
    pub fn measure(
        &self,
        tracker: &TrackerModel,
        seed: u64,
        n_passes: usize,
        mut pipeline: impl FnMut(u64) -> u64,
    ) -> Result<Measurement, RigError> {
        let seen = self.passes_seen(tracker, seed, n_passes);
        if seen.len() < n_passes.max(1) {
            return Err(RigError::TooFewPasses { expected: n_passes.max(1), found: seen.len() });
        }
        let mut passes = Vec::with_capacity(seen.len());
        for report in seen {
            let started_ps = report.arrives_ps;
            let scan_ps = pipeline(started_ps);
            if scan_ps < started_ps {
                return Err(RigError::LightBeforeStart { started_ps, found_ps: scan_ps });
            }
            passes.push(Pass {
                low_point_ps: self.low_point_of(started_ps),
                measured_ps: report.position_measured_ps,
                dac_ps: started_ps,
                scan_ps,
                light_ps: scan_ps.saturating_add(ntsc_lines_ps(self.photodiode_line)),
            });
        }
        Ok(Measurement::new(self, tracker, passes))
    }

    /// The reports at which the host sees low points.
    fn passes_seen(&self, tracker: &TrackerModel, seed: u64, n_passes: usize) -> Vec<crate::tracker::Report> {
        let dead_ps = self.half_swing_ps() / 2;
        let mut detector = self.detection.start(dead_ps);
        let limit_ps = self.pendulum.low_point_ps(n_passes as u64).saturating_add(PATIENCE_PS);
        tracker
            .reports(&self.pendulum, seed)
            .take_while(|report| report.measured_ps < limit_ps)
            .filter(|report| detector.sees_low_point(report))
            .take(n_passes.max(1))
            .collect()
    }

    /// The low point that an event on the D/A line belongs to: the last one, or one that noise announced too early.
    /// So the tracking latency must be below nine tenths of a half swing, 0.64 s.
    fn low_point_of(&self, dac_ps: u64) -> u64 {
        let half_ps = self.half_swing_ps();
        let guess = dac_ps.saturating_add(half_ps / EARLY_PART).saturating_sub(half_ps / 2) / half_ps;
        self.pendulum.low_point_ps(guess)
    }

    fn half_swing_ps(&self) -> u64 {
        crate::time::nearest_ps(self.pendulum.period_s() / 2.0)
    }
}
