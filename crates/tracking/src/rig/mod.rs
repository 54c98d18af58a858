//! The pendulum rig, which measures latency from outside the machine (TR94).
//!
//! An LED and a photodiode mark the low point of a pendulum's arc. A tracker on the bob sends reports to the host. When
//! the host detects the low point, it starts a new frame and switches a D/A line. Frames alternate between dark and
//! light under a photodiode on the screen. On the oscilloscope, tracking latency is the time from the low point to the
//! step of the D/A line. Rendering latency is the time from this step to the step of the screen.
//!
//! This module has the parts outside of the system: the pendulum, the host's detection of low points and the
//! oscilloscope. The caller simulates the system and supplies the steps of the D/A line and the light on the screen.

mod detection;
mod measurement;
mod oscilloscope;

pub use detection::Detection;
pub use measurement::{InsidePass, Latency, LowPointReport, Measurement, Oscilloscope, OutsidePass, Side};
pub use oscilloscope::{ScopeEdge, ScopeTrace};

use thiserror::Error;

use crate::config as table;
use crate::motion::Pendulum;
use crate::time::PS_PER_S;
use crate::tracker::TrackerModel;

/// Time without a low point after which the rig stops waiting.
const PATIENCE_PS: u64 = 10 * PS_PER_S;

/// Divisor of a half swing: noise may announce a low point early by at most a tenth of a half swing.
const EARLY_PART: u64 = 10;

/// The pendulum rig. The pendulum's pivot and the tracker's origin are both at the origin of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PendulumRig {
    /// Undamped pendulum whose bob carries the tracker.
    pub pendulum: Pendulum,
    /// Method by which the host detects the low point.
    pub detection: Detection,
    /// Width of the LED's beam, m.
    pub beam_m: f64,
    /// Visible line of the screen under the photodiode, 0 at the top.
    pub photodiode_line: u32,
}

/// The reason why a latency measurement failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RigError {
    /// The tracker stopped reporting, or the host detected too few low points.
    #[error("expected {expected} low points, the host saw {found}")]
    TooFewPasses {
        /// Number of low points that the measurement needs.
        expected: usize,
        /// Number of low points that the host detected.
        found: usize,
    },
    /// The light changes of the screen do not match the requested frames.
    #[error("expected the photodiode on the screen to change for each of {expected} frames, found {found} changes")]
    NoLight {
        /// Number of frames that low points requested.
        expected: usize,
        /// Number of changes between dark and light that the photodiode saw.
        found: usize,
    },
}

impl PendulumRig {
    /// Returns the assumed rig: arm 0.5 m, amplitude 20 degrees, detection by crossing the vertical, photodiode in the
    /// middle of the screen.
    pub fn assumed() -> Self {
        Self {
            pendulum: Pendulum::rig(),
            detection: Detection::Crossing,
            beam_m: table::RigNumbers::PAPERS.led_beam / 1e3,
            photodiode_line: table::RigNumbers::PAPERS.photodiode_line as u32,
        }
    }

    /// Returns the first `n` low points (at least 1) that the host detects in the reports of a tracker on the bob.
    ///
    /// # Errors
    ///
    /// [`RigError::TooFewPasses`] if the tracker stops reporting or the host detects fewer than `n` low points.
    pub fn sightings(&self, tracker: &TrackerModel, seed: u64, n: usize) -> Result<Vec<LowPointReport>, RigError> {
        let expected = n.max(1);
        // The dead time of the detector is a quarter of a swing.
        let mut detector = self.detection.start(self.half_swing_ps() / 2);
        let limit_ps = self.pendulum.low_point_ps(n as u64).saturating_add(PATIENCE_PS);
        let seen: Vec<LowPointReport> = tracker
            .reports(&self.pendulum, seed)
            .take_while(|report| report.measured_ps < limit_ps)
            .filter(|report| detector.detects_low_point(report))
            .map(|report| LowPointReport { measured_ps: report.position_measured_ps, arrives_ps: report.arrives_ps })
            .take(expected)
            .collect();
        if seen.len() < expected { Err(RigError::TooFewPasses { expected, found: seen.len() }) } else { Ok(seen) }
    }

    /// Reads the oscilloscope and combines its passes with the system's time stamps of the same passes. `place_ps` is
    /// the photodiode's delay in the scan: the time from the retrace until the beam passes the photodiode.
    ///
    /// # Errors
    ///
    /// [`RigError::NoLight`] if the screen never shows a frame, or if the numbers of passes differ.
    pub fn compare(
        &self,
        tracker: &TrackerModel,
        place_ps: u64,
        oscilloscope: &Oscilloscope,
        inside: Vec<InsidePass>,
    ) -> Result<Measurement, RigError> {
        let found = oscilloscope.screen.edges().len();
        let no_light = RigError::NoLight { expected: inside.len(), found };
        // The passes of both sides are compared one by one, so their numbers must agree.
        let outside = oscilloscope.passes(self).filter(|passes| passes.len() == inside.len() && !inside.is_empty());
        Ok(Measurement::new(self.detection, tracker, place_ps, outside.ok_or(no_light)?, inside))
    }

    /// Returns the low point that caused a step of the D/A line: the last low point, or one that noise announced too
    /// early. The assignment is correct for tracking latencies below nine tenths of a half swing, 0.64 s.
    fn low_point_before(&self, dac_ps: u64) -> u64 {
        let half_ps = self.half_swing_ps();
        let guess = dac_ps.saturating_add(half_ps / EARLY_PART).saturating_sub(half_ps / 2) / half_ps;
        self.pendulum.low_point_ps(guess)
    }

    fn half_swing_ps(&self) -> u64 {
        crate::time::nearest_ps(self.pendulum.period_s() / 2.0)
    }
}
