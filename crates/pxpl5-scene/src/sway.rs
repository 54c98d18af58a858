//! Seeded, band-limited sway of a head.

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};
use tracking::random;

use crate::trig;

/// Unconscious and conscious movement upon a path: sums of sines of fixed frequencies, all below
/// [`crate::config::HEAD_BAND_HZ`], with phases drawn from the seed.
///
/// At scale 1 on [`crate::HeadPath::Look`] the mean angular speed is about
/// [`crate::config::MEAN_HEAD_SPEED_DEG_PER_S`], never above [`crate::config::MAX_HEAD_SPEED_DEG_PER_S`], and at
/// least 95 % of the energy of yaw lies below 0.14 Hz, all three as in recorded traces of headset use. Unlike those,
/// the speeds have no long tail: a sum of sines is nearly Gaussian.
///
/// On [`crate::HeadPath::Look`] the head moves round the target and the gaze wanders; on all other paths only the gaze
/// wanders, by at most 11 degrees a scale.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sway {
    /// Draws the phases of the sines; any number.
    pub seed: u64,
    /// Multiplies all amplitudes: 0 is none, 1 as published.
    pub scale: f64,
}

/// Frequency in hertz and amplitude of one sine.
type Sine = (f64, f64);

// Amplitudes and frequencies are assumed, within the published band and energy; frequencies have no common period.
// Their root mean square angular speed, sqrt(sum (2 pi f A)^2 / 2) over all but the distance, is 44 degrees per
// second, whose mean, for speeds nearly Gaussian in three unequal directions, is about nine tenths: 40.

/// Degrees round the target.
const AZIMUTH: [Sine; 5] = [(0.041, 41.0), (0.067, 40.0), (0.097, 38.0), (0.131, 35.0), (0.43, 5.0)];
/// Degrees above the target.
const ELEVATION: [Sine; 3] = [(0.053, 12.0), (0.113, 9.0), (0.47, 4.0)];
/// Fraction of the distance.
const DISTANCE: [Sine; 2] = [(0.059, 0.06), (0.149, 0.04)];
/// Degrees of gaze left of the target.
const GAZE_YAW: [Sine; 3] = [(0.37, 3.4), (0.89, 2.9), (1.61, 2.2)];
/// Degrees of gaze above the target.
const GAZE_PITCH: [Sine; 3] = [(0.31, 2.7), (0.97, 2.2), (1.73, 1.6)];
/// Degrees of tilt of the head to its left.
const GAZE_ROLL: [Sine; 3] = [(0.17, 3.4), (0.71, 2.5), (1.37, 1.6)];

/// The sway at one time.
pub(crate) struct Swing {
    pub(crate) azimuth_deg: f64,
    pub(crate) elevation_deg: f64,
    pub(crate) distance_factor: f64,
    yaw_deg: f64,
    pitch_deg: f64,
    roll_deg: f64,
}

impl Sway {
    /// A head that keeps exactly to its path: amplitudes of 0.
    #[must_use]
    pub fn none() -> Self {
        Self { seed: 0, scale: 0.0 }
    }

    pub(crate) fn swing_at(&self, seconds: f64) -> Swing {
        let mut sums = SumsOfSines { sway: self, seconds, phases_drawn: 0 };
        Swing {
            azimuth_deg: sums.next(&AZIMUTH),
            // Held short of the pole, where upright has no meaning, whatever the scale.
            elevation_deg: (10.0 + sums.next(&ELEVATION)).clamp(-80.0, 80.0),
            distance_factor: (1.0 + sums.next(&DISTANCE)).max(0.1),
            yaw_deg: sums.next(&GAZE_YAW),
            pitch_deg: sums.next(&GAZE_PITCH),
            roll_deg: sums.next(&GAZE_ROLL),
        }
    }
}

/// Adds up sines, each with the next phase of the seed.
struct SumsOfSines<'a> {
    sway: &'a Sway,
    seconds: f64,
    phases_drawn: u64,
}

impl SumsOfSines<'_> {
    fn next(&mut self, sines: &[Sine]) -> f64 {
        let values = sines.iter().map(|&(hz, amplitude)| {
            let turns = hz * self.seconds + self.next_phase_turns();
            amplitude * trig::sin_turns(turns)
        });
        let sum: f64 = values.sum();
        self.sway.scale * sum
    }

    fn next_phase_turns(&mut self) -> f64 {
        let phase = random::unit(random::bits(self.sway.seed, self.phases_drawn));
        self.phases_drawn += 1;
        phase
    }
}

impl Swing {
    /// How far the gaze is off the path's.
    pub(crate) fn gaze(&self) -> DQuat {
        turn_about(DVec3::Y, self.yaw_deg) * turn_about(DVec3::X, self.pitch_deg) * turn_about(DVec3::Z, self.roll_deg)
    }
}

/// Rotation by `angle_deg` about the unit vector `axis`.
pub(crate) fn turn_about(axis: DVec3, angle_deg: f64) -> DQuat {
    let (sin, cos) = trig::sin_cos_deg(angle_deg / 2.0);
    DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos)
}
