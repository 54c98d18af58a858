//! Latency measured from outside: the pendulum rig.
//!
//! An LED and a photodiode mark the low point of a pendulum's arc; a tracker on the bob feeds the host; when the host
//! sees the low point it starts a new frame and switches a D/A line; frames alternate dark and light under a photodiode
//! on the screen. On the oscilloscope, tracking latency is the way from the low point to the D/A line, rendering
//! latency from the D/A line to the screen (TR94).
//!
//! This module has what stands outside of the system: the pendulum, the host's eye for low points, the oscilloscope. What
//! the system makes of the sightings, and the light on its screen, come from whoever simulates it.

mod detection;
mod measurement;
mod oscilloscope;

pub use detection::Detection;
pub use measurement::{InsidePass, Latency, Measurement, Oscilloscope, OutsidePass, Side, Sighting};
pub use oscilloscope::{ScopeEdge, ScopeTrace};

use thiserror::Error;

use crate::config as table;
use crate::motion::Pendulum;
use crate::time::PS_PER_S;
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
    /// A frame was started and its light never came, or frames were started that nobody asked for.
    #[error("expected the photodiode on the screen to change for each of {expected} frames, found {found} changes")]
    NoLight {
        /// Frames that low points asked for.
        expected: usize,
        /// Changes between dark and light.
        found: usize,
    },
}

impl PendulumRig {
    /// Arm 0.5 m, 20 degrees, low point by crossing the vertical, photodiode in the middle of the screen: all assumed.
    pub fn assumed() -> Self {
        Self {
            pendulum: Pendulum::rig(),
            detection: Detection::Crossing,
            beam_m: table::RigNumbers::PAPERS.led_beam / 1e3,
            photodiode_line: table::RigNumbers::PAPERS.photodiode_line as u32,
        }
    }

    /// The first `n` low points that the host sees, at least 1, from what a tracker on the bob tells it.
    ///
    /// # Errors
    ///
    /// [`RigError::TooFewPasses`] when the tracker falls silent or never shows a low point.
    pub fn sightings(&self, tracker: &TrackerModel, seed: u64, n: usize) -> Result<Vec<Sighting>, RigError> {
        let expected = n.max(1);
        let mut detector = self.detection.start(self.half_swing_ps() / 2);
        let limit_ps = self.pendulum.low_point_ps(n as u64).saturating_add(PATIENCE_PS);
        let seen: Vec<Sighting> = tracker
            .reports(&self.pendulum, seed)
            .take_while(|report| report.measured_ps < limit_ps)
            .filter(|report| detector.sees_low_point(report))
            .map(|report| Sighting { measured_ps: report.position_measured_ps, arrives_ps: report.arrives_ps })
            .take(expected)
            .collect();
        if seen.len() < expected { Err(RigError::TooFewPasses { expected, found: seen.len() }) } else { Ok(seen) }
    }

    /// Reads the oscilloscope, and puts what the system's time stamps say of the same passes beside it. `place_ps` is the
    /// photodiode's place in the scan: from the retrace to the beam's passing it.
    ///
    /// # Errors
    ///
    /// [`RigError::NoLight`] when the screen never shows a frame, or the passes are not the same.
    pub fn compare(
        &self,
        tracker: &TrackerModel,
        place_ps: u64,
        oscilloscope: &Oscilloscope,
        inside: Vec<InsidePass>,
    ) -> Result<Measurement, RigError> {
        let found = oscilloscope.screen.edges().len();
        let no_light = RigError::NoLight { expected: inside.len(), found };
        let outside = oscilloscope.passes(self).filter(|passes| passes.len() == inside.len() && !inside.is_empty());
        Ok(Measurement::new(self.detection, tracker, place_ps, outside.ok_or(no_light)?, inside))
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
