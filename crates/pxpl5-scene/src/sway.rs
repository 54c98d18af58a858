//! Random, band-limited sway of a head. A seed determines the sway.

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};
use tracking::random;

use crate::trig;

/// Random head movement that is added to a path. The movement is a sum of sines of fixed frequencies, with phases drawn
/// from the seed. All are below 2 Hz, where recorded yaw has practically all of its energy (published).
///
/// At scale 1 on [`crate::HeadPath::Look`], three statistics agree with recorded traces of headset use. The mean
/// angular speed is about [`crate::config::MEAN_HEAD_SPEED_DEG_PER_S`]. The speed never exceeds
/// [`crate::config::MAX_HEAD_SPEED_DEG_PER_S`]. At least 95 % of the energy of yaw lies below 0.14 Hz. Unlike recorded
/// speeds, these speeds have no long tail, because a sum of sines is nearly Gaussian.
///
/// On [`crate::HeadPath::Look`] the head moves around the target, and the direction of the gaze varies. On all other
/// paths only the direction of the gaze varies, by at most 11 degrees at scale 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sway {
    /// Seed from which the phases of the sines are drawn.
    pub seed: u64,
    /// Factor of all amplitudes, 0 to 10. A factor of 0 turns the sway off, and a factor of 1 gives the published head
    /// speeds.
    pub scale: f64,
}

/// Frequency (Hz) and amplitude of one sine of the sway.
type Sine = (f64, f64);

// Amplitudes and frequencies are assumed, within the published band and energy. The frequencies have no common period.
// The root mean square angular speed, sqrt(sum (2 pi f A)^2 / 2) over all but the distance, is 44 degrees per second.
// For nearly Gaussian speeds in three unequal directions the mean is about nine tenths of this: 40.

/// Sine waves whose sum is the head's angle around the target, degrees.
const AZIMUTH: [Sine; 5] = [(0.041, 41.0), (0.067, 40.0), (0.097, 38.0), (0.131, 35.0), (0.43, 5.0)];
/// Sine waves whose sum is added to the head's mean angle above the target, degrees.
const ELEVATION: [Sine; 3] = [(0.053, 12.0), (0.113, 9.0), (0.47, 4.0)];
/// Sine waves whose sum is the deviation from the mean distance to the target, as a fraction of this distance.
const DISTANCE: [Sine; 2] = [(0.059, 0.06), (0.149, 0.04)];
/// Sine waves whose sum is the angle of the gaze to the left of the target, degrees.
const GAZE_YAW: [Sine; 3] = [(0.37, 3.4), (0.89, 2.9), (1.61, 2.2)];
/// Sine waves whose sum is the angle of the gaze above the target, degrees.
const GAZE_PITCH: [Sine; 3] = [(0.31, 2.7), (0.97, 2.2), (1.73, 1.6)];
/// Sine waves whose sum is the head's tilt to its left, degrees.
const GAZE_ROLL: [Sine; 3] = [(0.17, 3.4), (0.71, 2.5), (1.37, 1.6)];

pub(crate) struct Swing {
    pub(crate) azimuth_deg: f64,
    pub(crate) elevation_deg: f64,
    pub(crate) distance_factor: f64,
    yaw_deg: f64,
    pitch_deg: f64,
    roll_deg: f64,
}

impl Sway {
    /// Returns a sway whose amplitudes are 0, so that the head stays exactly on its path.
    pub const fn none() -> Self {
        Self { seed: 0, scale: 0.0 }
    }

    pub(crate) fn swing_at(&self, seconds: f64) -> Swing {
        let mut sums = SumsOfSines { sway: self, seconds, phases_drawn: 0 };
        Swing {
            azimuth_deg: sums.next(&AZIMUTH),
            // The limit keeps the head away from the point above the target at any scale, because an upright head has
            // no unique orientation there.
            elevation_deg: (10.0 + sums.next(&ELEVATION)).clamp(-80.0, 80.0),
            distance_factor: (1.0 + sums.next(&DISTANCE)).max(0.1),
            yaw_deg: sums.next(&GAZE_YAW),
            pitch_deg: sums.next(&GAZE_PITCH),
            roll_deg: sums.next(&GAZE_ROLL),
        }
    }
}

/// A generator of sums of sines. Every sine gets a new random phase from the seed.
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
    pub(crate) fn gaze(&self) -> DQuat {
        turn_about(DVec3::Y, self.yaw_deg) * turn_about(DVec3::X, self.pitch_deg) * turn_about(DVec3::Z, self.roll_deg)
    }
}

pub(crate) fn turn_about(axis: DVec3, angle_deg: f64) -> DQuat {
    let (sin, cos) = trig::sin_cos_deg(angle_deg / 2.0);
    DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos)
}
