use glam::DVec3;
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};

use super::Motion;
use super::spline::{Activity, Spline};
use crate::error::check;
use crate::identity::{SettingSink, write_vector};
use crate::pose::Pose;
use crate::random::stream;
use crate::rotation;
use crate::time::nearest_ps;

/// One frequency band of random head motion: three quintic B-splines with random coefficients. The power at frequency f
/// is proportional to sinc^12(f spacing), so 99.9 % of the power lies below the frequency 0.53 / spacing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Band {
    /// Time between two knots of the splines, seconds, 0.01 to 1000.
    pub spacing_s: f64,
    /// Standard deviations of the motion: yaw, pitch and roll in degrees, or x, y and z in metres.
    pub deviation: [f64; 3],
    /// Amplitude of the periods of weakest motion, relative to the periods of strongest motion, 0 to 1. With 1, all
    /// periods have the same amplitude.
    pub calm: f64,
    /// Exponent that makes periods of strong motion rare, 1 to 16. The amplitude of a period is calm + (1 - calm)
    /// u^power with u uniform in 0 to 1.
    pub power: u32,
}

/// Number of the stream of random numbers that gives the seed for [`Motion::sibling`].
const SIBLING: u64 = 10;

/// Settings of the random head motion [`Synthetic`]: one frequency band for each kind of movement, and the mean
/// position.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SyntheticConfig {
    /// Slow turns of the body, which cause most of the range of the head's angle.
    pub turn: Band,
    /// Quick glances, which cause most of the head's angular speed.
    pub glance: Band,
    /// Translation of the head around the mean position `centre_m`.
    pub walk: Band,
    /// Mean position of the head in the world, metres.
    pub centre_m: [f64; 3],
}

impl SyntheticConfig {
    /// Returns settings whose statistics agree with recorded headset use ([`crate::config::HeadSpeeds`]). The standard
    /// deviations are assumed. Tests compare the resulting head speeds with published head speeds.
    pub fn recorded_use() -> Self {
        Self {
            turn: Band { spacing_s: 2.6, deviation: [47.0, 4.0, 1.0], calm: 0.6, power: 1 },
            glance: Band { spacing_s: 0.188, deviation: [9.1, 3.7, 2.0], calm: 0.14, power: 5 },
            walk: Band { spacing_s: 1.2, deviation: [0.38, 0.05, 0.38], calm: 0.3, power: 2 },
            centre_m: [0.0, 1.7, 0.0],
        }
    }
}

/// Random, band-limited head motion from a seed, which neither repeats nor drifts. Yaw, pitch, roll and position are
/// sums of random splines. Computing a pose takes the same time and memory at any instant.
#[derive(Clone, Debug)]
pub struct Synthetic {
    config: SyntheticConfig,
    seed: u64,
    turn: Spline,
    glance: Spline,
    walk: Spline,
    centre: DVec3,
}

impl Synthetic {
    /// Creates a random head motion. The same settings and seed give the same motion on every computer.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] if a number is out of range.
    pub fn new(config: &SyntheticConfig, seed: u64) -> Result<Self, SettingError> {
        for metres in config.centre_m {
            check("centre of the motion", metres, -1e6, 1e6)?;
        }
        let radians = std::f64::consts::PI / 180.0;
        Ok(Self {
            config: *config,
            seed,
            // Every band has its own random stream.
            turn: spline(&config.turn, radians, stream(seed, 1))?,
            glance: spline(&config.glance, radians, stream(seed, 2))?,
            walk: spline(&config.walk, 1.0, stream(seed, 3))?,
            centre: DVec3::from_array(config.centre_m),
        })
    }

    /// Creates a random head motion whose speeds agree with recorded headset use.
    pub fn recorded_use(seed: u64) -> Self {
        Self::new(&SyntheticConfig::recorded_use(), seed).expect("the preset is in range")
    }

    /// Returns yaw, pitch and roll in radians, and their rates in rad/s. Yaw counts full turns and can exceed pi.
    pub fn yaw_pitch_roll(&self, t_ps: u64) -> (DVec3, DVec3) {
        let turn = self.turn.at(t_ps);
        let glance = self.glance.at(t_ps);
        (turn.0 + glance.0, turn.1 + glance.1)
    }
}

impl Motion for Synthetic {
    fn pose(&self, t_ps: u64) -> Pose {
        let (angles, _) = self.yaw_pitch_roll(t_ps);
        Pose {
            position: self.centre + self.walk.at(t_ps).0,
            orientation: rotation::from_yaw_pitch_roll(angles.x, angles.y, angles.z),
        }
    }

    fn identify(&self, settings: &mut SettingSink) {
        let Self { config: _, seed: _, turn, glance, walk, centre } = self;
        settings("motion", &"synthetic");
        turn.identify("motion.turn", settings);
        glance.identify("motion.glance", settings);
        walk.identify("motion.walk", settings);
        write_vector(settings, "motion.centre_m", *centre);
    }

    fn sibling(&self) -> Option<Box<dyn Motion + Send + Sync>> {
        let sibling = Self::new(&self.config, stream(self.seed, SIBLING)).ok()?;
        Some(Box::new(sibling))
    }

    fn velocity(&self, t_ps: u64) -> DVec3 {
        self.walk.at(t_ps).1
    }

    fn angular_velocity(&self, t_ps: u64) -> DVec3 {
        let (angles, rates) = self.yaw_pitch_roll(t_ps);
        let yawed = rotation::about_y(angles.x);
        let pitched = yawed * rotation::about_x(angles.y);
        DVec3::Y * rates.x + yawed * DVec3::X * rates.y + pitched * DVec3::Z * rates.z
    }
}

fn spline(band: &Band, unit: f64, seed: u64) -> Result<Spline, SettingError> {
    check("spacing of knots, s", band.spacing_s, 0.01, 1000.0)?;
    check("level of calm spells", band.calm, 0.0, 1.0)?;
    check("power of lively spells", f64::from(band.power), 1.0, 16.0)?;
    for deviation in band.deviation {
        check("deviation of a band", deviation, 0.0, 1e6)?;
    }
    let activity = Activity { calm: band.calm, power: band.power };
    let deviation = DVec3::from_array(band.deviation) * unit;
    Ok(Spline::new(nearest_ps(band.spacing_s), deviation, activity, seed, stream(seed, 9)))
}
