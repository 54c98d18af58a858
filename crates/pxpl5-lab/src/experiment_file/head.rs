//! The head in front of the pipeline: how it moves, its tracker and predictor, and the raster before its eyes.

use super::read::beside;
use super::{ExperimentFile, FileError};
use crate::head_names::{motion, predictor, tracker};
use pxpl5_run::{Head, Pipeline, Raster};
use std::sync::Arc;

/// A head with its tracker, by the names of its parts.
#[derive(Clone, Debug)]
pub struct HeadChoice {
    motion: String,
    tracker: String,
    predict: String,
    head: Arc<Head>,
}

impl PartialEq for HeadChoice {
    fn eq(&self, other: &Self) -> bool {
        self.settings() == other.settings() && self.head.fingerprint() == other.head.fingerprint()
    }
}

/// What is taken where a motion is given and nothing else: as `pxpl5 compare`.
const TRACKER: &str = "optical";
const PREDICT: &str = "kalman";

impl HeadChoice {
    /// The head of an experiment; `None` where no `head.` key is set. A recording is read here.
    pub(super) fn read(file: &ExperimentFile, pipeline: &dyn Pipeline, seed: u64) -> Result<Option<Self>, FileError> {
        let Some(motion_name) = file.text("head.motion")? else { return Self::none(file) };
        let raster = file.choice("head.raster", &Raster::ALL)?.unwrap_or_default();
        if let (Raster::Vdrt, false, Some(setting)) = (raster, pipeline.has_one_pose(), file.get("head.raster")) {
            let place = setting.place.clone();
            let key = "head.raster = vdrt".to_owned();
            let applies_to = "rendering-control, slats and jitp-field, whose pictures are of one pose".to_owned();
            return Err(FileError::NotApplicable { place, key, pipeline: pipeline.name(), applies_to });
        }
        let motion_name = match file.get("head.motion") {
            Some(setting) if motion_name.to_ascii_lowercase().ends_with(".csv") => beside(&setting.folder, motion_name),
            _ => motion_name.to_owned(),
        };
        let tracker_name = file.text("head.tracker")?.unwrap_or(TRACKER).to_owned();
        let predict = file.text("head.predict")?.unwrap_or(PREDICT).to_owned();
        let moving = motion(&motion_name).map_err(|error| refused(file, "head.motion", &error))?;
        let of_tracker = tracker(&tracker_name).map_err(|error| refused(file, "head.tracker", &error))?;
        let of_predictor = predictor(&predict).map_err(|error| refused(file, "head.predict", &error))?;
        let head = Head::new(moving, of_tracker, of_predictor, seed);
        let head = Arc::new(head.map_err(|error| refused(file, "head.tracker", &error))?.before(raster));
        Ok(Some(Self { motion: motion_name, tracker: tracker_name, predict, head }))
    }

    /// Without a motion there is nothing to track.
    fn none(file: &ExperimentFile) -> Result<Option<Self>, FileError> {
        let of_head = file.settings.keys().any(|path| path.starts_with("head."));
        let how = "how the head moves, such as head.motion = \"pan:200\"";
        if of_head { Err(FileError::Missing { key: "head.motion", how }) } else { Ok(None) }
    }

    /// The head itself.
    #[must_use]
    pub fn head(&self) -> Arc<Head> {
        Arc::clone(&self.head)
    }

    /// Its keys and their values.
    #[must_use]
    pub fn settings(&self) -> [(&'static str, String); 4] {
        [
            ("head.motion", self.motion.clone()),
            ("head.tracker", self.tracker.clone()),
            ("head.predict", self.predict.clone()),
            ("head.raster", self.head.raster().to_string()),
        ]
    }
}

fn refused(file: &ExperimentFile, key: &str, error: &dyn std::error::Error) -> FileError {
    let place = file.get(key).map_or_else(|| key.to_owned(), |setting| format!("{}: {key}", setting.place));
    FileError::Head { place, reason: error.to_string() }
}
