//! The pendulum rig, which measures latency from outside the machine (I3D95).
//!
//! An LED and a photodiode detect each pass of a pendulum through its lowest point. A tracker on the pendulum sends
//! reports to the host. When the host detects a pass in the reports, the host starts a new frame and switches its D/A
//! output. A photodiode on the screen detects frames that are alternately dark and light. On the oscilloscope, tracking
//! latency is the time from the pass to the step of the D/A output. Rendering latency is the time from the step of the
//! D/A output to the step of the screen.
//!
//! This module has the parts outside of the emulated system: the pendulum and the oscilloscope. The module also has the
//! host's detection of passes. A program that uses this module simulates the system and supplies the steps of the
//! host's D/A output and the light on the screen.

mod detection;
mod measurement;
mod oscilloscope;

pub use detection::Detection;
pub use measurement::{InsidePass, LowPointReport, Measurement, Oscilloscope, OutsidePass, Side};
pub use oscilloscope::{ScopeEdge, ScopeTrace};

use crate::config as table;
use crate::motion::Pendulum;
use crate::time::PS_PER_S;
use crate::tracker::TrackerModel;
use pxpl5_sim::parameters::SettingError;

/// Greatest time without a detected pass of the pendulum through its lowest point, ps. After this time the measurement
/// fails.
const PATIENCE_PS: u64 = 10 * PS_PER_S;

/// Divisor of half a swing, for detections that are early because of noise. A detection up to this part of half a swing
/// before a pass of the lowest point belongs to this pass.
const EARLY_PART: u64 = 10;

/// The pendulum rig, which measures latency from outside the machine. The pendulum's pivot and the tracker's origin are
/// both at the origin of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PendulumRig {
    /// Undamped pendulum that carries the tracker.
    pub pendulum: Pendulum,
    /// Method by which the host detects that the pendulum passes its lowest point.
    pub detection: Detection,
    /// Width of the LED's light beam at the pendulum, m.
    pub beam_m: f64,
    /// Index of the visible scanline under the photodiode on the screen, 0 at the top.
    pub photodiode_line: u32,
}

impl PendulumRig {
    /// Returns a rig with assumed numbers: arm 0.5 m, amplitude 20 degrees, detection by crossing the vertical,
    /// photodiode in the middle of the screen.
    pub fn assumed() -> Self {
        Self {
            pendulum: Pendulum::rig(),
            detection: Detection::Crossing,
            beam_m: table::RigNumbers::PAPERS.led_beam / 1e3,
            photodiode_line: table::RigNumbers::PAPERS.photodiode_line as u32,
        }
    }

    /// Returns the first `n` passes of the pendulum (at least 1) that the host detects in the reports of a tracker on
    /// the pendulum.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the tracker stops reporting or the host detects fewer than `n` passes.
    pub fn sightings(&self, tracker: &TrackerModel, seed: u64, n: usize) -> Result<Vec<LowPointReport>, SettingError> {
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
        if seen.len() == expected {
            return Ok(seen);
        }
        let reason = format_args!("expected {expected} low points, the host detected {}", seen.len());
        Err(SettingError::combination(reason))
    }

    /// Measures the passes of the pendulum on the oscilloscope and combines the results with the measurements by time
    /// stamps. `place_ps` is the time from the retrace until the beam passes the photodiode on the screen.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the screen never shows a frame, or if the two measurements have different
    /// numbers of passes.
    pub fn compare(
        &self,
        tracker: &TrackerModel,
        place_ps: u64,
        oscilloscope: &Oscilloscope,
        inside: Vec<InsidePass>,
    ) -> Result<Measurement, SettingError> {
        let found = oscilloscope.screen.edges().len();
        let expected = format!("the photodiode on the screen to change for each of {} frames", inside.len());
        let no_light = SettingError::value("", expected, format_args!("{found} changes"));
        // The two measurements are compared pass by pass, so they must have the same number of passes.
        let outside = oscilloscope.passes(self).filter(|passes| passes.len() == inside.len() && !inside.is_empty());
        Ok(Measurement::new(self.detection, tracker, place_ps, outside.ok_or(no_light)?, inside))
    }

    /// Returns the instant at which the pendulum passed its lowest point and so caused the step of the host's D/A
    /// output at `dac_ps`. The result is the last pass before the step, or the next pass if noise caused an early
    /// detection. The result is correct for tracking latencies below nine tenths of a half swing, 0.64 s.
    fn low_point_before(&self, dac_ps: u64) -> u64 {
        let half_ps = self.half_swing_ps();
        let guess = dac_ps.saturating_add(half_ps / EARLY_PART).saturating_sub(half_ps / 2) / half_ps;
        self.pendulum.low_point_ps(guess)
    }

    fn half_swing_ps(&self) -> u64 {
        crate::time::nearest_ps(self.pendulum.period_s() / 2.0)
    }
}
