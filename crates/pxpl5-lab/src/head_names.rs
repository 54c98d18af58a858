//! Head motions, trackers and predictors by name.

use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::Arc;
use thiserror::Error;
use tracking::Pose;
use tracking::motion::{LoadError, Motion, Pan, Pendulum, Recording, Still, Synthetic};
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;

/// Fastest pan, degrees per second: well above the peak of a head, 370.
const FASTEST_PAN: f64 = 10_000.0;

/// Why a motion, tracker or predictor cannot be had.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MotionError {
    /// The name is none of those known.
    #[error("there is no {what} `{found}`; expected {expected}")]
    Unknown {
        /// What was to be named.
        what: &'static str,
        /// The name.
        found: String,
        /// The names that are known.
        expected: &'static str,
    },
    /// A number after the colon is none, or out of range.
    #[error("expected {expected}, found `{found}`")]
    Number {
        /// The text.
        found: String,
        /// What was expected.
        expected: &'static str,
    },
    /// A recording cannot be opened.
    #[error("{path} cannot be opened: {error}")]
    Open {
        /// The file.
        path: String,
        /// Why.
        error: io::Error,
    },
    /// A recording cannot be replayed.
    #[error("{path}: {error}")]
    Load {
        /// The file.
        path: String,
        /// Why.
        error: LoadError,
    },
}

const MOTIONS: &str = "still, pan:DEG_PER_S, pendulum, synthetic:SEED or a file FILE.csv";

/// `still`, `pan:DEG_PER_S`, `pendulum`, `synthetic:SEED`, or the path of a recording that ends in `.csv`.
///
/// # Errors
///
/// [`MotionError`] says what was expected and what was found.
pub fn motion(text: &str) -> Result<Arc<dyn Motion + Send + Sync>, MotionError> {
    let number = |found: &str, expected| MotionError::Number { found: found.to_owned(), expected };
    Ok(match text.split_once(':').unwrap_or((text, "")) {
        ("still", "") => Arc::new(Still(Pose::IDENTITY)),
        ("pendulum", "") => Arc::new(Pendulum::rig()),
        ("pan", rate) => {
            let deg_per_s: f64 = rate
                .parse()
                .ok()
                .filter(|r: &f64| r.abs() <= FASTEST_PAN)
                .ok_or_else(|| number(rate, "a pan of -10000 to 10000 degrees per second, such as pan:200"))?;
            Arc::new(Pan::at(deg_per_s))
        }
        ("synthetic", seed) => {
            let seed = seed.parse().map_err(|_| number(seed, "a seed of 0 to 2^64 - 1, such as synthetic:1"))?;
            Arc::new(Synthetic::recorded_use(seed))
        }
        _ if text.to_ascii_lowercase().ends_with(".csv") => Arc::new(recording(Path::new(text))?),
        _ => return Err(MotionError::Unknown { what: "motion", found: text.to_owned(), expected: MOTIONS }),
    })
}

fn recording(path: &Path) -> Result<Recording, MotionError> {
    let name = || path.display().to_string();
    let file = File::open(path).map_err(|error| MotionError::Open { path: name(), error })?;
    Recording::from_csv(file).map_err(|error| MotionError::Load { path: name(), error })
}

/// Names of [`tracker`].
pub const TRACKERS: &str = "optical, fastrak, flock, flock-patched, 3space or ideal";

/// A tracker of [`TRACKERS`].
///
/// # Errors
///
/// [`MotionError::Unknown`] lists the names.
pub fn tracker(name: &str) -> Result<TrackerConfig, MotionError> {
    Ok(match name {
        "optical" => TrackerConfig::optical_ceiling(),
        "fastrak" => TrackerConfig::fastrak(),
        "flock" => TrackerConfig::flock_of_birds(),
        "flock-patched" => TrackerConfig::flock_of_birds_on_patched_host(),
        "3space" => TrackerConfig::polhemus_3space(),
        "ideal" => TrackerConfig::ideal(),
        _ => return Err(MotionError::Unknown { what: "tracker", found: name.to_owned(), expected: TRACKERS }),
    })
}

/// `none`, `velocity`, `acceleration` or `kalman`.
///
/// # Errors
///
/// [`MotionError::Unknown`] lists the names.
pub fn predictor(name: &str) -> Result<PredictorKind, MotionError> {
    Ok(match name {
        "none" => PredictorKind::None,
        "velocity" => PredictorKind::ConstantVelocity,
        "acceleration" => PredictorKind::ConstantAcceleration,
        "kalman" => PredictorKind::Kalman,
        _ => {
            let expected = "none, velocity, acceleration or kalman";
            return Err(MotionError::Unknown { what: "predictor", found: name.to_owned(), expected });
        }
    })
}
