//! Builds head motions, trackers and predictors from their names.

use glam::{DVec3, Vec3};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;
use thiserror::Error;
use tracking::Pose;
use tracking::config::Tables;
use tracking::motion::{
    End, Motion, Pan, Pendulum, Recording, RecordingError, RecordingFormat, Sinusoid, Slide, Still, Synthetic, Walk,
};
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;

/// Maximum speed of the motion `pan` in degrees per second, well above the peak rate of a head, 370.
const FASTEST_PAN: f64 = 10_000.0;

/// Error in the name or parameters of a motion, tracker or predictor.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MotionError {
    /// The name is unknown.
    #[error("there is no {what} `{found}`; expected {expected}")]
    Unknown {
        /// Kind of thing that was named: motion, tracker or predictor.
        what: &'static str,
        /// The unknown name.
        found: String,
        /// List of the accepted names, as text.
        expected: &'static str,
    },
    /// The text after the colon is not a number, or the number is out of range.
    #[error("expected {expected}, found `{found}`")]
    Number {
        /// The invalid text.
        found: String,
        /// Expected form and range of the number, in words.
        expected: &'static str,
    },
    /// The motion walks along the scene's path, but the scene has no path.
    #[error(
        "`{found}` walks along the scene's path, and this scene has none; expected a scene with a path, such as gallery"
    )]
    NoPath {
        /// Name of the motion, as given by the user.
        found: String,
    },
    /// The file of a recorded head motion cannot be opened.
    #[error("{path} cannot be opened: {error}")]
    Open {
        /// Path of the recording's file.
        path: String,
        /// Error of the operating system.
        error: io::Error,
    },
    /// The recording of a head motion cannot be replayed.
    #[error("{path}: {error}")]
    Load {
        /// Path of the recording's file.
        path: String,
        /// Error of the recording's reader.
        error: RecordingError,
    },
}

/// Forms of all motions that [`motion`] and [`walk`] accept, for help texts and errors.
pub const MOTIONS: &str = "still, pan:DEG_PER_S, slide:M_PER_S, sine:DEG:HZ, pendulum, synthetic:SEED, walk:M_PER_S (or \
                           walk:M_PER_S:SEED) along the scene's path, or a recording (FILE.csv, FILE.txt, FILE.tum or FILE.jsonl)";

/// Maximum speed of the motions `slide` and `walk` in metres per second.
const FASTEST_SLIDE: f64 = 100.0;
/// Maximum frequency of the motion `sine` in Hz.
const HIGHEST_HZ: f64 = 100.0;

/// Options for replaying a recorded head motion: the format of its file, and the behaviour at its end.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Replay {
    /// Columns and axes of the recording's file, for a file whose header does not state them.
    pub format: RecordingFormat,
    /// Behaviour after the last sample of the recording.
    pub end: End,
}

/// Returns true if the name denotes the motion `walk`, along the scene's path.
#[must_use]
pub fn is_walk(name: &str) -> bool {
    name.split(':').next() == Some("walk")
}

/// Builds a walk along a closed path from its name. With `walk:M_PER_S`, the viewer always faces ahead. With
/// `walk:M_PER_S:SEED`, the viewer's head turns at random as in `synthetic:SEED`.
///
/// # Errors
///
/// Returns [`MotionError`] for an empty path, and for an invalid speed or seed.
pub fn walk(text: &str, path: &[Vec3]) -> Result<Walk, MotionError> {
    let expected =
        "a walk of -100 to 100 metres per second, such as walk:1, and a seed to look around by, such as walk:1:7";
    let wrong = || MotionError::Number { found: text.to_owned(), expected };
    let numbers = text.strip_prefix("walk:").ok_or_else(wrong)?;
    // The speed comes before the optional seed.
    let speed = numbers.split(':').next().and_then(|speed| within(speed, FASTEST_SLIDE)).ok_or_else(wrong)?;
    let seed = match numbers.split_once(':') {
        Some((_, seed)) => Some(seed.parse().map_err(|_| wrong())?),
        None => None,
    };
    let no_path = |_| MotionError::NoPath { found: text.to_owned() };
    let corners: Vec<DVec3> = path.iter().map(|corner| corner.as_dvec3()).collect();
    // An empty path is the error of a scene without a path.
    let ahead = Walk::new(&corners, speed).map_err(no_path)?;
    Ok(match seed {
        Some(seed) => ahead.with_glances(seed),
        None => ahead,
    })
}

/// Returns true if the name of a motion is the path of a recording's file.
#[must_use]
pub fn is_recording(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    [".csv", ".txt", ".tum", ".jsonl"].iter().any(|end| name.ends_with(end))
}

/// Builds a motion from its name: `still`, `pan:DEG_PER_S`, `slide:M_PER_S` (to the right), `sine:DEG:HZ` (of the yaw),
/// `pendulum`, `synthetic:SEED`, or the path of a recording. A recording's path ends in `.csv`, `.txt`, `.tum` or
/// `.jsonl` ([`Recording::read`]). The motion `walk` also needs a scene, see [`walk`].
///
/// # Errors
///
/// Returns [`MotionError`] with the expected form and the text found.
pub fn motion(text: &str) -> Result<Arc<dyn Motion + Send + Sync>, MotionError> {
    replayed(text, &Replay::default())
}

/// Builds a motion from its name. The options `replay` apply to recordings.
///
/// # Errors
///
/// Fails in the same cases as [`motion`].
pub fn replayed(text: &str, replay: &Replay) -> Result<Arc<dyn Motion + Send + Sync>, MotionError> {
    let number = |found: &str, expected| MotionError::Number { found: found.to_owned(), expected };
    // Each motion has a name, and most have parameters after a colon.
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
        ("slide", speed) => {
            let expected = "a slide of -100 to 100 metres per second, such as slide:0.5";
            Arc::new(Slide::right_at(within(speed, FASTEST_SLIDE).ok_or_else(|| number(speed, expected))?))
        }
        ("sine", both) => {
            let sine = both.split_once(':').and_then(|(degrees, hz)| {
                Some(Sinusoid::of_yaw(within(degrees, 180.0)?, within(hz, HIGHEST_HZ).filter(|hz| *hz > 0.0)?))
            });
            let expected = "an amplitude of -180 to 180 degrees and a frequency up to 100 Hz, such as sine:20:0.5";
            Arc::new(sine.ok_or_else(|| number(both, expected))?)
        }
        ("synthetic", seed) => {
            let seed = seed.parse().map_err(|_| number(seed, "a seed of 0 to 2^64 - 1, such as synthetic:1"))?;
            Arc::new(Synthetic::recorded_use(seed))
        }
        ("walk", _) => return Err(MotionError::NoPath { found: text.to_owned() }),
        _ if is_recording(text) => Arc::new(recording(Path::new(text), replay)?),
        _ => return Err(MotionError::Unknown { what: "motion", found: text.to_owned(), expected: MOTIONS }),
    })
}

/// Parses a number whose absolute value is at most `most`.
fn within(text: &str, most: f64) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.abs() <= most)
}

fn recording(path: &Path, replay: &Replay) -> Result<Recording, MotionError> {
    let name = || path.display().to_string();
    let file = File::open(path).map_err(|error| MotionError::Open { path: name(), error })?;
    recording_of(file, &name(), replay)
}

/// Reads a recorded head motion from the contents of its file. Error messages call the recording `name`.
pub(crate) fn recording_of(contents: impl Read, name: &str, replay: &Replay) -> Result<Recording, MotionError> {
    let recording = Recording::read_as(contents, &replay.format);
    Ok(recording.map_err(|error| MotionError::Load { path: name.to_owned(), error })?.ending(replay.end))
}

/// Names of all trackers that [`tracker`] accepts, for help texts and errors.
pub const TRACKERS: &str = "optical, fastrak, fastrak-polled, flock, flock-patched, 3space, 3space-patched or ideal";

/// Returns the tracker with one of the names in [`TRACKERS`].
///
/// # Errors
///
/// Returns [`MotionError::Unknown`] with the list of names.
pub fn tracker(name: &str) -> Result<TrackerConfig, MotionError> {
    Ok(tracker_by(&Tables::PAPERS, name)?.0)
}

/// Returns the tracker with one of the names in [`TRACKERS`] and the constants of `tables`. Also returns the name of
/// the table from which the tracker's constants come.
///
/// # Errors
///
/// Fails in the same cases as [`tracker`].
pub fn tracker_by(tables: &Tables, name: &str) -> Result<(TrackerConfig, &'static str), MotionError> {
    Ok(match name {
        "optical" => (TrackerConfig::optical_ceiling_by(tables), "optical"),
        "fastrak" => (TrackerConfig::fastrak_by(tables), "fastrak"),
        "fastrak-polled" => (TrackerConfig::fastrak_by(tables).with_polling_by(tables), "fastrak"),
        "flock" => (TrackerConfig::flock_of_birds_by(tables), "flock"),
        "flock-patched" => (TrackerConfig::flock_of_birds_on_patched_host_by(tables), "flock"),
        "3space" => (TrackerConfig::polhemus_3space_by(tables), "space"),
        "3space-patched" => (TrackerConfig::polhemus_3space_by(tables).without_polling(), "space"),
        "ideal" => (TrackerConfig::ideal_by(tables), "ideal"),
        _ => return Err(MotionError::Unknown { what: "tracker", found: name.to_owned(), expected: TRACKERS }),
    })
}

/// Names of all predictors that [`predictor`] accepts, for help texts and errors.
pub const PREDICTORS: &str = "none, velocity, acceleration or kalman";

/// Returns the predictor with one of the names in [`PREDICTORS`].
///
/// # Errors
///
/// Returns [`MotionError::Unknown`] with the list of names.
pub fn predictor(name: &str) -> Result<PredictorKind, MotionError> {
    Ok(match name {
        "none" => PredictorKind::None,
        "velocity" => PredictorKind::ConstantVelocity,
        "acceleration" => PredictorKind::ConstantAcceleration,
        "kalman" => PredictorKind::Kalman,
        _ => {
            return Err(MotionError::Unknown { what: "predictor", found: name.to_owned(), expected: PREDICTORS });
        }
    })
}
