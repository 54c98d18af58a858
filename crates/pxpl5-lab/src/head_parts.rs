//! Builders of head motions, trackers and predictors from their names.

use glam::{DVec3, Vec3};
use pxpl5_sim::parameters::{FileError, FileErrorKind, SettingError};
use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;
use tracking::Pose;
use tracking::config::Tables;
use tracking::motion::{
    End, Motion, Pan, Pendulum, Recording, RecordingFormat, Sinusoid, Slide, Still, Synthetic, Walk,
};
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;

/// Maximum speed of the motion `pan` in degrees per second. A human head reaches at most 370 degrees per second.
const FASTEST_PAN: f64 = 10_000.0;

/// Syntax of all motions that [`motion`] and [`walk`] accept, for help texts and errors.
pub const MOTIONS: &str = "still, pan:DEG_PER_S, slide:M_PER_S, sine:DEG:HZ, pendulum, synthetic:SEED, walk:M_PER_S (or \
                           walk:M_PER_S:SEED) along the scene's path, recorded:NAME (a real head: vive-tracked or vive-dev), \
                           or a recording (FILE.csv, FILE.txt, FILE.tum or FILE.jsonl)";

/// Maximum speed of the motions `slide` and `walk` in metres per second.
const FASTEST_SLIDE: f64 = 100.0;
/// Maximum frequency of the motion `sine` in Hz.
const HIGHEST_HZ: f64 = 100.0;

/// Options for the replay of a recorded head motion: the format of its file, and the behaviour at its end.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Replay {
    /// Columns and axes of a file whose header does not state its columns and axes.
    pub format: RecordingFormat,
    /// Behaviour after the last sample of the recording.
    pub end: End,
}

/// Returns true for a motion `walk`, which follows the scene's path.
pub fn is_walk(name: &str) -> bool {
    name.split(':').next() == Some("walk")
}

/// Builds a walk along a closed path from its name. With `walk:M_PER_S`, the viewer always faces ahead. With
/// `walk:M_PER_S:SEED`, the viewer's head turns at random as in `synthetic:SEED`.
///
/// # Errors
///
/// Returns a [`SettingError`] for an empty path, and for an invalid speed or seed.
pub fn walk(text: &str, path: &[Vec3]) -> Result<Walk, SettingError> {
    let expected =
        "a walk of -100 to 100 metres per second, such as walk:1, and a seed to look around by, such as walk:1:7";
    let wrong = || SettingError::value("", expected, format_args!("`{text}`"));
    let numbers = text.strip_prefix("walk:").ok_or_else(wrong)?;
    // The speed comes before the optional seed.
    let speed = numbers.split(':').next().and_then(|speed| within(speed, FASTEST_SLIDE)).ok_or_else(wrong)?;
    let seed = match numbers.split_once(':') {
        Some((_, seed)) => Some(seed.parse().map_err(|_| wrong())?),
        None => None,
    };
    let no_path = |_| no_path(text);
    let corners: Vec<DVec3> = path.iter().map(|corner| corner.as_dvec3()).collect();
    // An empty path shows that the scene has no path, which is an error.
    let ahead = Walk::new(&corners, speed).map_err(no_path)?;
    Ok(match seed {
        Some(seed) => ahead.with_glances(seed),
        None => ahead,
    })
}

/// Name of the motions that come with the library: `recorded:NAME`.
const RECORDED: &str = "recorded:";

/// Returns true if the name of a motion is a recording: the path of a file, or one that comes with the library.
pub fn is_recording(name: &str) -> bool {
    name.starts_with(RECORDED) || is_recorded_file(name)
}

/// Returns true if the name of a motion is the path of a recording's file.
pub(crate) fn is_recorded_file(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    [".csv", ".txt", ".tum", ".jsonl"].iter().any(|end| name.ends_with(end))
}

/// Builds a motion from its name: `still`, `pan:DEG_PER_S`, `slide:M_PER_S` (to the right), `sine:DEG:HZ` (of the yaw),
/// `pendulum`, `synthetic:SEED`, `recorded:NAME` ([`Recording::SHIPPED`]), or the path of a recording.
///
/// A recording's path ends in `.csv`, `.txt`, `.tum` or `.jsonl` ([`Recording::read`]). For the motion `walk`, which
/// needs a scene, see [`walk`].
///
/// # Errors
///
/// Returns a [`SettingError`] with the expected syntax and the text found.
pub fn motion(text: &str) -> Result<Arc<dyn Motion + Send + Sync>, SettingError> {
    replayed(text, &Replay::default())
}

/// Builds a motion from its name as [`motion`] does. `replay` has the options for recordings.
///
/// # Errors
///
/// Fails in the same cases as [`motion`].
pub fn replayed(text: &str, replay: &Replay) -> Result<Arc<dyn Motion + Send + Sync>, SettingError> {
    let number = |found: &str, expected| SettingError::value("", expected, format_args!("`{found}`"));
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
        ("walk", _) => return Err(no_path(text)),
        ("recorded", name) => {
            let names = Recording::SHIPPED.map(|(name, _)| name);
            let file = Recording::shipped(name).ok_or_else(|| {
                unknown("recording", name, names.into_iter(), &format!("{RECORDED}{}", names.join(" or ")))
            })?;
            Arc::new(recording_of(file, text, &Replay { format: RecordingFormat::default(), end: replay.end })?)
        }
        _ if is_recorded_file(text) => Arc::new(recording(Path::new(text), replay)?),
        // A path of a file with another ending is no mistyped name.
        _ if Path::new(text).extension().is_some_and(|end| end.to_string_lossy().contains(char::is_alphabetic)) => {
            return Err(number(text, "a recording whose name ends in .csv, .txt, .tum or .jsonl"));
        }
        _ => {
            return Err(unknown(
                "motion",
                text,
                listed("still pan slide sine pendulum synthetic walk recorded"),
                MOTIONS,
            ));
        }
    })
}

fn no_path(motion: &str) -> SettingError {
    SettingError::combination(format_args!(
        "`{motion}` walks along the scene's path, and this scene has none; expected a scene with a path, such as gallery"
    ))
}

/// Creates the error of an unknown name. The message states the most similar valid name, then `forms`: all names, or
/// names with their parameters.
pub(crate) fn unknown<'a>(what: &str, found: &str, names: impl Iterator<Item = &'a str>, forms: &str) -> SettingError {
    let SettingError { nearest, .. } = SettingError::unknown_path(what, found, names);
    SettingError::combination(format_args!(
        "there is no {what} `{found}`; did you mean `{nearest}`? (expected {forms})"
    ))
}

/// Returns the names in a list such as `none, velocity or kalman`.
fn listed(names: &str) -> impl Iterator<Item = &str> {
    names.split([',', ' ']).filter(|name| !["", "or"].contains(name))
}

/// Parses a number with an absolute value of at most `most`.
fn within(text: &str, most: f64) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.abs() <= most)
}

fn recording(path: &Path, replay: &Replay) -> Result<Recording, SettingError> {
    let name = || path.display().to_string();
    let file = File::open(path).map_err(|error| {
        FileError::because(FileErrorKind::Unreadable, format_args!("{} cannot be opened: {error}", name()))
    })?;
    recording_of(file, &name(), replay)
}

/// Reads a recorded head motion from the contents of its file. `name` stands for the file name in error messages.
pub(crate) fn recording_of(contents: impl Read, name: &str, replay: &Replay) -> Result<Recording, SettingError> {
    let recording = Recording::read_as(contents, &replay.format);
    Ok(recording.map_err(|error| error.in_file(name))?.ending(replay.end))
}

/// Names of all trackers that [`tracker`] accepts, for help texts and errors.
pub const TRACKERS: &str = "optical, fastrak, fastrak-polled, flock, flock-patched, 3space, 3space-patched or ideal";

/// Returns the tracker `name`, which is one of the names in [`TRACKERS`].
///
/// # Errors
///
/// Returns a [`SettingError`] with the list of names.
pub fn tracker(name: &str) -> Result<TrackerConfig, SettingError> {
    Ok(tracker_by(&Tables::PAPERS, name)?.0)
}

/// Returns the tracker `name` with the constants in `tables`, and the name of the table with these constants.
///
/// # Errors
///
/// Fails in the same cases as [`tracker`].
pub fn tracker_by(tables: &Tables, name: &str) -> Result<(TrackerConfig, &'static str), SettingError> {
    Ok(match name {
        "optical" => (TrackerConfig::optical_ceiling_by(tables), "optical"),
        "fastrak" => (TrackerConfig::fastrak_by(tables), "fastrak"),
        "fastrak-polled" => (TrackerConfig::fastrak_by(tables).with_polling_by(tables), "fastrak"),
        "flock" => (TrackerConfig::flock_of_birds_by(tables), "flock"),
        "flock-patched" => (TrackerConfig::flock_of_birds_on_patched_host_by(tables), "flock"),
        "3space" => (TrackerConfig::polhemus_3space_by(tables), "space"),
        "3space-patched" => (TrackerConfig::polhemus_3space_by(tables).without_polling(), "space"),
        "ideal" => (TrackerConfig::ideal_by(tables), "ideal"),
        _ => return Err(unknown("tracker", name, listed(TRACKERS), TRACKERS)),
    })
}

/// Names of all predictors that [`predictor`] accepts, for help texts and errors.
pub const PREDICTORS: &str = "none, velocity, acceleration or kalman";

/// Returns the predictor `name`, which is one of the names in [`PREDICTORS`].
///
/// # Errors
///
/// Returns a [`SettingError`] with the list of names.
pub fn predictor(name: &str) -> Result<PredictorKind, SettingError> {
    Ok(match name {
        "none" => PredictorKind::None,
        "velocity" => PredictorKind::ConstantVelocity,
        "acceleration" => PredictorKind::ConstantAcceleration,
        "kalman" => PredictorKind::Kalman,
        _ => {
            return Err(unknown("predictor", name, listed(PREDICTORS), PREDICTORS));
        }
    })
}
