use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};

use crate::error::{check, contradiction};

/// Greatest allowed probability of a random fault. With a higher probability the tracker would report too rarely for
/// any run.
const MAX_PROBABILITY: f64 = 0.99;

/// A fault to inject into a tracker. Several faults can be combined. If two random faults hit one report, the first in
/// the list applies.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum TrackerFault {
    /// The tracker fails permanently: no report reaches the host at or after this instant.
    Silence {
        /// Instant of the failure, ps.
        from_ps: u64,
    },
    /// The tracker makes no measurements from `from_ps` until before `to_ps`.
    Dropout {
        /// First instant of the interval without measurements, ps.
        from_ps: u64,
        /// First instant after the interval without measurements, ps.
        to_ps: u64,
    },
    /// Some measurements, chosen at random, are lost.
    RandomDropout {
        /// Probability that a measurement is lost, 0 to 0.99.
        probability: f64,
    },
    /// Some reports, chosen at random, contain NaN instead of a pose.
    NotANumber {
        /// Probability that a report contains NaN, 0 to 0.99.
        probability: f64,
    },
    /// Some reports, chosen at random, are moved and turned in a random direction.
    Jump {
        /// Probability that a report is moved and turned, 0 to 0.99.
        probability: f64,
        /// Distance by which the position moves, m, 0 to 1e6.
        distance_m: f64,
        /// Angle by which the orientation turns, degrees, 0 to 180.
        angle_deg: f64,
    },
}

impl TrackerFault {
    pub(super) fn check(&self) -> Result<(), SettingError> {
        match *self {
            Self::Silence { .. } => Ok(()),
            Self::Dropout { from_ps, to_ps } if from_ps > to_ps => {
                Err(contradiction("a dropout ends before it begins"))
            }
            Self::Dropout { .. } => Ok(()),
            Self::RandomDropout { probability } | Self::NotANumber { probability } => check_probability(probability),
            Self::Jump { probability, distance_m, angle_deg } => {
                check("distance of a jump", distance_m, 0.0, 1e6)?;
                check("angle of a jump", angle_deg, 0.0, 180.0)?;
                check_probability(probability)
            }
        }
    }
}

fn check_probability(probability: f64) -> Result<(), SettingError> {
    check("probability of a fault", probability, 0.0, MAX_PROBABILITY)
}
