//! Seeded, band-limited sway of a head.

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

use crate::trig;

/// Unconscious and conscious movement upon a path: sums of sines of fixed frequencies, all below
/// [`crate::config::HEAD_BAND_HZ`], with phases drawn from the seed.
///
/// At scale 1 on [`crate::Path::Look`] the mean angular speed is about
/// [`crate::config::MEAN_HEAD_SPEED_DEG_PER_S`], never above [`crate::config::MAX_HEAD_SPEED_DEG_PER_S`], and at
/// least 95 % of the energy of yaw lies below 0.14 Hz, all three as in recorded traces of headset use. Unlike those,
/// the speeds have no long tail: a sum of sines is nearly Gaussian.
///
/// On [`crate::Path::Look`] the head moves round the target and the gaze wanders; on all other paths only the gaze
/// wanders, by at most 11 degrees a scale.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sway {
    /// Draws the phases.
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
    /// No sway.
    #[must_use]
    pub fn none() -> Self {
        Self { seed: 0, scale: 0.0 }
    }

    pub(crate) fn at(&self, seconds: f64) -> Swing {
        let mut phases = Phases(self.seed);
        let mut sum = |sines: &[Sine]| -> f64 {
            let sine = |&(hz, amplitude): &Sine| amplitude * trig::sin_turns(hz * seconds + phases.next_turns());
            self.scale * sines.iter().map(sine).sum::<f64>()
        };
        Swing {
            azimuth_deg: sum(&AZIMUTH),
            // Held short of the pole, where upright has no meaning, whatever the scale.
            elevation_deg: (10.0 + sum(&ELEVATION)).clamp(-80.0, 80.0),
            distance_factor: (1.0 + sum(&DISTANCE)).max(0.1),
            yaw_deg: sum(&GAZE_YAW),
            pitch_deg: sum(&GAZE_PITCH),
            roll_deg: sum(&GAZE_ROLL),
        }
    }
}

impl Swing {
    /// How far the gaze is off the path's.
    pub(crate) fn gaze(&self) -> DQuat {
        turn(DVec3::Y, self.yaw_deg) * turn(DVec3::X, self.pitch_deg) * turn(DVec3::Z, self.roll_deg)
    }
}

/// Rotation by `angle_deg` about the unit vector `axis`.
pub(crate) fn turn(axis: DVec3, angle_deg: f64) -> DQuat {
    let (sin, cos) = trig::sin_cos_deg(angle_deg / 2.0);
    DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos)
}

/// SplitMix64 (Steele, Lea and Flood, 2014): a well-mixed number per step from any seed.
struct Phases(u64);

impl Phases {
    fn next_turns(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
