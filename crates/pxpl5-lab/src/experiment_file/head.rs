//! Reader of the tracked head: its motion, tracker, predictor and raster. The raster is the correction that the display
//! applies to pictures during the scan.

use super::read::{beside, plain, wrong};
use super::scene::{SceneChoice, is_file};
use super::{ExperimentFile, GIVEN, motion, reprojection, tracking_numbers};
use crate::head_parts::{
    Replay, is_recorded_file, is_recording, is_walk, predictor, recording_of, replayed, tracker_by, walk,
};
use pxpl5_run::{Aim, Head, HeadPlace, Pipeline};
use pxpl5_sim::parameters::Parameter;
use pxpl5_sim::parameters::SettingError;
use std::sync::Arc;
use toml::Value;
use tracking::motion::{Axes, Columns, End, Jumps, RecordingFormat, TrainedOn};
use tracking::predict::PredictorConfig;

/// The tracked head of an experiment, with the names of its motion, tracker and predictor.
#[derive(Clone, Debug)]
pub struct HeadChoice {
    motion: String,
    replay: Replay,
    tracker: String,
    predict: String,
    train: Option<String>,
    added_latency_ms: Option<f64>,
    numbers: Vec<Parameter>,
    /// Meaning of the poses of the motion before this scene, if no setting states it.
    usual_place: HeadPlace,
    head: Arc<Head>,
}

impl PartialEq for HeadChoice {
    fn eq(&self, other: &Self) -> bool {
        self.settings() == other.settings()
            && self.numbers == other.numbers
            && self.head.fingerprint() == other.head.fingerprint()
    }
}

const PS_PER_MS: f64 = 1e9;
const TRACKER: &str = "optical";
const PREDICT: &str = "kalman";

impl HeadChoice {
    /// Reads the settings of the head, and the recording of its motion if there is one. Returns `None` if no `head.` or
    /// `tracking.` key is set.
    pub(super) fn read(
        file: &ExperimentFile,
        pipeline: &dyn Pipeline,
        seed: u64,
    ) -> Result<Option<Self>, SettingError> {
        let Some(motion_name) = file.text("head.motion")? else { return Self::none(file) };
        let raster = reprojection::read(file, pipeline)?;
        let aim = file.choice("head.aim", &Aim::ALL)?.unwrap_or_default();
        // Before a model of one's own, a head faces the model. The scenes that are built in have a start of their own.
        let usual = if file.text("scene")?.is_some_and(is_file) { HeadPlace::Content } else { HeadPlace::Scene };
        let place = file.choice("head.place", &HeadPlace::ALL)?.unwrap_or(usual);
        // A recording is found relative to the experiment file that names the recording.
        let replay = replay(file)?;
        let found = |key: &str, name: &str| match file.get(key) {
            Some(setting) if is_recorded_file(name) => beside(&setting.folder, name),
            _ => name.to_owned(),
        };
        let motion_name = found("head.motion", motion_name);
        let train = file.text("head.train")?.map(|name| found("head.train", name));
        refuse_recording_keys(file, &motion_name)?;
        let tracker_name = file.text("head.tracker")?.unwrap_or(TRACKER).to_owned();
        let predict = file.text("head.predict")?.unwrap_or(PREDICT).to_owned();
        // Build motion, tracker and predictor with the experiment's numbers.
        let mut moving = moving(file, &motion_name, &replay)?;
        if let Some(train) = &train {
            let training = replayed(train, &replay).map_err(|error| refused(file, "head.train", &error))?;
            moving = Arc::new(TrainedOn { motion: moving, training });
        }
        let tables = tracking_numbers::read(file, &tracker_name)?;
        let by_name = tracker_by(&tables, &tracker_name);
        let (mut of_tracker, own_table) = by_name.map_err(|error| refused(file, "head.tracker", &error))?;
        let added_latency_ms = file.number("head.added_latency")?;
        if let Some(ms) = added_latency_ms {
            of_tracker = of_tracker.with_added_latency_ps((ms * PS_PER_MS).round() as u64);
        }
        let of_predictor = predictor(&predict).map_err(|error| refused(file, "head.predict", &error))?;
        let of_predictor = PredictorConfig::for_tracker_by(&tables, of_predictor, &of_tracker);
        let numbers = tracking_numbers::parameters_with(&tables, own_table, &of_tracker);
        let head = Head::predicted_by(moving, of_tracker, of_predictor, seed);
        let head = head
            .map_err(|error| refused(file, "head.tracker", &error))?
            .with_raster(raster)
            .with_aim(aim)
            .with_place(place);
        let mut head = evaluated(file, if is_tuned(file)? { head.tuned() } else { head })?;
        head.unsupported_parameters = numbers.iter().filter(|number| !number.is_in_range()).cloned().collect();
        Ok(Some(Self {
            motion: motion_name,
            replay,
            tracker: tracker_name,
            predict,
            train,
            added_latency_ms,
            numbers,
            usual_place: usual,
            head: Arc::new(head),
        }))
    }

    /// Returns `None` for an experiment without a head motion. Returns an error if such an experiment sets a `head.` or
    /// `tracking.` key.
    fn none(file: &ExperimentFile) -> Result<Option<Self>, SettingError> {
        let of_head = file.settings.keys().any(|path| {
            path.starts_with("tracking.") || path.starts_with("head.") && !motion::KEYS.contains(&path.as_str())
        });
        let how = "the motion of the head, such as head.motion = \"pan:200\"";
        if of_head { Err(SettingError::missing("head.motion", how)) } else { Ok(None) }
    }

    /// Returns the head with its tracker and predictor, which all runs of this experiment share.
    pub fn head(&self) -> Arc<Head> {
        Arc::clone(&self.head)
    }

    pub(crate) fn warnings(&self) -> impl Iterator<Item = String> {
        self.head.motion().warnings().into_iter().map(|warning| format!("{}: {warning}", self.motion))
    }

    /// Returns the parameters of the tracker, the host's serial port and the predictor.
    pub fn parameters(&self) -> Vec<Parameter> {
        self.numbers.clone()
    }

    pub(crate) fn settings(&self) -> Vec<(String, Value)> {
        let filter = if self.head.is_tuned() { "tuned" } else { "given" };
        let mut all: Vec<(String, Value)> = [
            ("head.motion", self.motion.clone()),
            ("head.tracker", self.tracker.clone()),
            ("head.predict", self.predict.clone()),
            ("head.filter", filter.to_owned()),
            ("head.aim", self.head.aim.to_string()),
        ]
        .map(|(key, value)| (key.to_owned(), Value::from(value)))
        .into();
        if [self.head.place, self.usual_place] != [HeadPlace::Scene; 2] {
            all.push(("head.place".to_owned(), Value::from(self.head.place.to_string())));
        }
        all.extend(self.train.clone().map(|train| ("head.train".to_owned(), Value::from(train))));
        all.extend(self.added_latency_ms.map(|ms| ("head.added_latency".to_owned(), Value::from(ms))));
        all.extend(reprojection::settings(self.head.raster));
        all.extend(self.head.evaluate_at_m.map(|metres| ("head.evaluate_at".to_owned(), Value::from(metres))));
        // Only recordings have an end, axes and columns.
        if is_recording(&self.motion) {
            let Replay { format, end } = &self.replay;
            all.push(("head.end".to_owned(), Value::from(end.name())));
            all.extend(format.axes.map(|axes| ("head.axes".to_owned(), Value::from(axes.name()))));
            if format.jumps != Jumps::default() {
                all.push(("head.jumps".to_owned(), Value::from(format.jumps.name())));
            }
            let columns = format.columns.iter();
            all.extend(columns.map(|(field, column)| (format!("{COLUMNS}{field}"), Value::from(column))));
        }
        all
    }
}

/// Prefix of the keys that name the columns of a recording's file.
pub(super) const COLUMNS: &str = "head.columns.";

/// Builds the head motion `name`. The motion `walk` follows the path of the scene.
fn moving(
    file: &ExperimentFile,
    name: &str,
    replay: &Replay,
) -> Result<Arc<dyn tracking::motion::Motion + Send + Sync>, SettingError> {
    if let Some(motion) = file.motion.as_ref().filter(|_| name.starts_with(GIVEN)) {
        return Ok(Arc::clone(motion));
    }
    // A recording in memory has priority over a file.
    if let Some(contents) = file.contents(name).filter(|_| is_recorded_file(name)) {
        let recording = recording_of(&**contents, name, replay);
        return Ok(Arc::new(recording.map_err(|error| refused(file, "head.motion", &error))?));
    }
    if !is_walk(name) {
        return replayed(name, replay).map_err(|error| refused(file, "head.motion", &error));
    }
    let path = SceneChoice::read(file)?.path()?;
    Ok(Arc::new(walk(name, &path).map_err(|error| refused(file, "head.motion", &error))?))
}

/// Reads how a recording is replayed: its columns, its axes and the behaviour at its end.
fn replay(file: &ExperimentFile) -> Result<Replay, SettingError> {
    let mut columns = Columns::default();
    for (path, setting) in &file.settings {
        if let Some(field) = path.strip_prefix(COLUMNS) {
            columns.map(field, &plain(&setting.value)).map_err(|error| refused(file, path, &error))?;
        }
    }
    let jumps = file.choice("head.jumps", &Jumps::NAMES)?.unwrap_or_default();
    let format = RecordingFormat { columns, axes: file.choice("head.axes", &Axes::NAMES)?, jumps };
    Ok(Replay { format, end: file.choice("head.end", &End::NAMES)?.unwrap_or_default() })
}

fn refuse_recording_keys(file: &ExperimentFile, motion: &str) -> Result<(), SettingError> {
    let is_of_recordings =
        |path: &str| ["head.end", "head.axes", "head.jumps"].contains(&path) || path.starts_with(COLUMNS);
    match file.settings.iter().find(|(path, _)| is_of_recordings(path) && !is_recording(motion)) {
        Some((path, setting)) => Err(wrong(path, setting, "nothing: head.motion is no recording")),
        None => Ok(()),
    }
}

/// Parameters of the predictor whose values come from automatic tuning.
const TUNED: [&str; 11] = [
    "position_jerk",
    "orientation_jerk",
    "velocity_decay",
    "acceleration_decay",
    "turn_decay",
    "turn_acceleration_decay",
    "start_speed",
    "start_acceleration",
    "start_turn",
    "start_turn_acceleration",
    "baseline",
];

/// Returns true if the predictor is tuned automatically. Tuning starts from the values of `tracking.filter`. Without
/// `head.filter`, the predictor is tuned unless a parameter in [`TUNED`] is set.
fn is_tuned(file: &ExperimentFile) -> Result<bool, SettingError> {
    let is_given = |name: &str| file.get(&format!("tracking.filter.{name}")).is_some();
    let choice = file.choice("head.filter", &[("tuned", true), ("given", false)])?;
    Ok(choice.unwrap_or(!TUNED.iter().any(|name| is_given(name))))
}

fn evaluated(file: &ExperimentFile, head: Head) -> Result<Head, SettingError> {
    match file.number("head.evaluate_at")? {
        Some(metres) => head.evaluated_at(metres).map_err(|error| refused(file, "head.evaluate_at", &error)),
        None => Ok(head),
    }
}

fn refused(file: &ExperimentFile, key: &str, error: &dyn std::error::Error) -> SettingError {
    let place = file.get(key).map_or_else(|| key.to_owned(), |setting| setting.place_of(key));
    SettingError::combination(error).at(place)
}
