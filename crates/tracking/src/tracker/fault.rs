use serde::{Deserialize, Serialize};

use crate::error::SettingError;

/// Most likely random fault: more would be a tracker that hardly reports.
const MOST_LIKELY: f64 = 0.99;

/// A fault to inject. Several can be combined; where two random faults want one report, the first listed wins.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum TrackerFault {
    /// The tracker falls silent for good: nothing reaches the host at or after this instant.
    Silence {
        /// The first instant at which nothing arrives, ps.
        from_ps: u64,
    },
    /// No solutions are measured in [from, to).
    Dropout {
        /// The first instant without solutions, ps.
        from_ps: u64,
        /// The first instant with solutions again, ps.
        to_ps: u64,
    },
    /// Each solution is lost with this probability.
    RandomDropout {
        /// Chance that one solution is lost, 0 to 0.99.
        probability: f64,
    },
    /// Each report is made of NaN with this probability.
    NotANumber {
        /// Chance that one report is NaN, 0 to 0.99.
        probability: f64,
    },
    /// Each report is, with this probability, moved and turned in a random direction.
    Jump {
        /// Chance that one report jumps, 0 to 0.99.
        probability: f64,
        /// How far the position is moved, m, 0 to 1e6.
        distance_m: f64,
        /// How far the orientation is turned, degrees, 0 to 180.
        angle_deg: f64,
    },
}

impl TrackerFault {
    pub(super) fn check(&self) -> Result<(), SettingError> {
        match *self {
            Self::Silence { .. } => Ok(()),
            Self::Dropout { from_ps, to_ps } if from_ps > to_ps => {
                Err(SettingError::Contradiction { what: "a dropout ends before it begins" })
            }
            Self::Dropout { .. } => Ok(()),
            Self::RandomDropout { probability } | Self::NotANumber { probability } => check_probability(probability),
            Self::Jump { probability, distance_m, angle_deg } => {
                SettingError::check("distance of a jump", distance_m, 0.0, 1e6)?;
                SettingError::check("angle of a jump", angle_deg, 0.0, 180.0)?;
                check_probability(probability)
            }
        }
    }
}

fn check_probability(probability: f64) -> Result<(), SettingError> {
    SettingError::check("probability of a fault", probability, 0.0, MOST_LIKELY)
}
