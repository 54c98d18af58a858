use crate::fingerprint::Fingerprint;
use crate::raster::Raster;
use crate::report_schedule::{Arrivals, Coming, Contents};
use crate::tunings::{Tunings, tuned_once};
use pxpl5_sim::Time;
use pxpl5_sim::parameters::Parameter;
use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::display::Aim;
use std::fmt;
use std::sync::Arc;
use tracking::Pose;
use tracking::motion::{Motion, Still};
use tracking::predict::{Predictor, PredictorConfig, PredictorKind, Start, Training, Tuned};
use tracking::tracker::{TrackerConfig, TrackerModel, TrackerReport};

pub(crate) type Moving = Arc<dyn Motion + Send + Sync>;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Numbers {
    Given,
    ToBeTuned,
    /// A dry run has found the parameters. The first training data are for complete poses, the second for orientations.
    ///
    /// Only a display that itself uses the newest orientation has training data for orientations.
    Tuned(Option<Training>, Option<Training>),
}

/// Names of experiments contain this text in place of the tuned parameters. The parameters follow from the method and
/// from all other settings.
const TUNING: &str = "for its interval and motion, version 2";

/// The coordinates in which a head motion is given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HeadPlace {
    /// The first pose of the motion is placed at the start of the scene's own motion. All other poses keep their
    /// position and orientation relative to the first pose.
    #[default]
    Scene,
    /// The motion has the coordinates of the scene's world, in metres. No pose is moved.
    World,
    /// The mean position of the motion is placed at the start of the scene's own motion. The head is turned about the
    /// vertical axis so that it faces the middle of the scene as long as it can.
    Content,
}

impl HeadPlace {
    /// All choices of coordinates, with their names in experiment files.
    pub const ALL: [(&'static str, Self); 3] =
        [("scene", Self::Scene), ("world", Self::World), ("content", Self::Content)];
}

pxpl5_sim::parameters::named!(HeadPlace, "meaning of head poses", HeadPlace::ALL);

/// A viewer's head with a motion, a tracker, a predictor and a display.
#[derive(Clone)]
pub struct Head {
    pub(crate) motion: Moving,
    pub(crate) tracker: TrackerModel,
    predictor: PredictorConfig,
    numbers: Numbers,
    /// Distance at which pixel errors are evaluated, in metres. `None` means the distance of the scene's content.
    pub evaluate_at_m: Option<f64>,
    pub(crate) seed: u64,
    /// Correction that the head-mounted display applies to a picture during scan-out.
    pub raster: Raster,
    /// Instant for which poses are predicted, such as the middle of the time in which a picture lights.
    pub aim: Aim,
    /// Coordinates in which the motion is given.
    pub place: HeadPlace,
    reports: Option<Arc<[TrackerReport]>>,
    /// Parameters of tracker and predictor whose values no source supports. Reports warn of these parameters.
    pub unsupported_parameters: Vec<Parameter>,
    tunings: Option<Arc<Tunings>>,
}

impl fmt::Debug for Head {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Head")
            .field("tracker", self.tracker.config())
            .field("predictor", &self.predictor)
            .field("numbers", &self.numbers)
            .field("evaluate_at_m", &self.evaluate_at_m)
            .field("seed", &self.seed)
            .field("raster", &self.raster)
            .field("aim", &self.aim)
            .field("place", &self.place)
            .finish_non_exhaustive()
    }
}

const EVALUATION_DISTANCE_M: (f64, f64) = (1e-3, 1e6);

impl Head {
    /// Creates a head with a motion, a tracker and a predictor. The predictor assumes the same noise that the tracker
    /// model adds.
    ///
    /// The motion begins where the scene's own motion begins ([`HeadPlace::Scene`]), unless [`Head::with_place`] changes
    /// this.
    ///
    /// A run tunes the predictor's parameters for this motion and for the pipeline's prediction interval. See
    /// [`tune`](tracking::predict::tune).
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the setting, the expected values and the value found.
    pub fn new(
        motion: Arc<dyn Motion + Send + Sync>,
        tracker: TrackerConfig,
        predictor: PredictorKind,
        seed: u64,
    ) -> Result<Self, SettingError> {
        let predictor = PredictorConfig::for_tracker(predictor, &tracker);
        Ok(Self { numbers: Numbers::ToBeTuned, ..Self::predicted_by(motion, tracker, predictor, seed)? })
    }

    /// Creates a head whose predictor uses the parameters in `predictor` without tuning.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Head::new`].
    pub fn predicted_by(
        motion: Arc<dyn Motion + Send + Sync>,
        tracker: TrackerConfig,
        predictor: PredictorConfig,
        seed: u64,
    ) -> Result<Self, SettingError> {
        // Check both configurations now, so that later calls cannot fail.
        predictor.build()?;
        let tracker = TrackerModel::new(tracker)?;
        Ok(Self {
            motion,
            tracker,
            predictor,
            numbers: Numbers::Given,
            evaluate_at_m: None,
            seed,
            raster: Raster::Plain,
            aim: Aim::Middle,
            place: HeadPlace::Scene,
            reports: None,
            unsupported_parameters: Vec::new(),
            tunings: None,
        })
    }

    /// Uses a cache of tuned predictors, which several heads can share. The cache changes no result.
    #[must_use]
    pub fn sharing_tunings(self, tunings: Arc<Tunings>) -> Self {
        Self { tunings: Some(tunings), ..self }
    }

    /// Replaces the motion. Tracker and predictor stay the same.
    #[must_use]
    pub fn with_motion(self, motion: Arc<dyn Motion + Send + Sync>) -> Self {
        Self { motion, ..self }
    }

    /// Makes a run tune the parameters of the predictor. The tuning search begins at the current parameters.
    #[must_use]
    pub const fn tuned(mut self) -> Self {
        self.numbers = Numbers::ToBeTuned;
        self
    }

    /// Replaces the prediction method and keeps all other settings of the predictor.
    #[must_use]
    pub const fn with_prediction(mut self, kind: PredictorKind) -> Self {
        self.predictor.kind = kind;
        self
    }

    /// Sets the distance from the eye, in metres, at which pixel errors are evaluated. The default is the distance of
    /// the scene's content.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] for a distance that is not within 0.001 to 1,000,000 metres.
    pub fn evaluated_at(self, metres: f64) -> Result<Self, SettingError> {
        let (low, high) = EVALUATION_DISTANCE_M;
        let what = "distance at which errors are evaluated, m";
        SettingError::require((low..=high).contains(&metres), what, format_args!("{low} to {high}"), metres)?;
        Ok(Self { evaluate_at_m: Some(metres), ..self })
    }

    /// Sets the coordinates of the motion: relative to the start of the scene's own motion, or in the scene.
    #[must_use]
    pub const fn with_place(mut self, place: HeadPlace) -> Self {
        self.place = place;
        self
    }

    /// Sets the correction that the head-mounted display applies to a picture during scan-out.
    #[must_use]
    pub const fn with_raster(mut self, raster: Raster) -> Self {
        self.raster = raster;
        self
    }

    /// Sets the instant for which poses are predicted, such as the middle of the time in which a picture lights.
    #[must_use]
    pub const fn with_aim(mut self, aim: Aim) -> Self {
        self.aim = aim;
        self
    }

    /// Replaces the tracker's reports by `reports`, which must be sorted by arrival time.
    #[must_use]
    pub fn reporting(self, reports: Vec<TrackerReport>) -> Self {
        Self { reports: Some(reports.into()), ..self }
    }

    pub(crate) fn arrivals(&self, until: Time) -> Arrivals {
        let reports = self.reports_of(Arc::new(Still(Pose::IDENTITY)));
        Box::new(reports.map(Coming::of).take_while(move |coming| coming.arrives < until))
    }

    pub(crate) fn contents(&self) -> Contents {
        self.reports_of(Arc::clone(&self.motion))
    }

    fn reports_of(&self, motion: Moving) -> Contents {
        match &self.reports {
            Some(given) => {
                let given = Arc::clone(given);
                Box::new((0..given.len()).map(move |next| given[next]))
            }
            None => Box::new(self.tracker.reports(motion, self.seed)),
        }
    }

    /// Returns a hash of the motion and of all settings of the head.
    pub fn fingerprint(&self) -> Fingerprint {
        let mut hash = Fingerprint::default();
        let mut add = |key: &str, value: &dyn fmt::Display| hash.setting(key, value);
        // Motion, tracker and predictor, with the method or the result of the tuning.
        self.motion.identify(&mut add);
        self.tracker.config().identify(&mut add);
        self.predictor.identify(&mut add);
        match self.numbers {
            Numbers::ToBeTuned if self.predicts() => hash.setting("predictor.tuned", TUNING),
            Numbers::Tuned(of_all, of_turns) => {
                of_all.iter().for_each(|training| hash.setting("predictor.tuned_on", format_args!("{training:?}")));
                of_turns
                    .iter()
                    .for_each(|training| hash.setting("predictor.turns_tuned_on", format_args!("{training:?}")));
            }
            Numbers::Given | Numbers::ToBeTuned => {}
        }
        if self.place != HeadPlace::Scene {
            hash.setting("place", self.place.to_string());
        }
        // Settings that affect evaluation and display, then the given reports.
        if let Some(metres) = self.evaluate_at_m {
            hash.setting("evaluate_at_m", metres);
        }
        hash.setting("seed", self.seed);
        hash.setting("raster", self.raster);
        hash.setting("aim", self.aim);
        self.reports.iter().flat_map(|reports| reports.iter()).for_each(|report| {
            hash.setting("report", format_args!("{report:?}"));
        });
        hash
    }

    /// Returns true if the head's pose is predicted.
    pub fn predicts(&self) -> bool {
        self.predictor.kind != PredictorKind::None
    }

    /// Returns true if a run tunes, or has tuned, the parameters of the predictor.
    pub fn is_tuned(&self) -> bool {
        self.numbers != Numbers::Given
    }

    pub(crate) fn is_to_be_tuned(&self) -> bool {
        self.numbers == Numbers::ToBeTuned && self.predicts()
    }

    pub(crate) fn tuned_for(&self, interval_ps: u64) -> Self {
        let tuned = self.tuning(interval_ps);
        Self { predictor: tuned.config, numbers: Numbers::Tuned(tuned.training, None), ..self.clone() }
    }

    /// Returns this head with new parameters for orientations, tuned for a prediction interval in picoseconds. The
    /// parameters for positions stay the same.
    pub(crate) fn tuned_for_turns(&self, interval_ps: u64) -> Self {
        let Tuned { config: of_turns, training } = self.tuning(interval_ps);
        // Only the numbers for orientations are taken from the tuned predictor.
        let own = self.predictor;
        let start =
            Start { turn: of_turns.start.turn, turn_acceleration: of_turns.start.turn_acceleration, ..own.start };
        let predictor = PredictorConfig {
            orientation_baseline: of_turns.orientation_baseline,
            orientation_jerk: of_turns.orientation_jerk,
            orientation_decay: of_turns.orientation_decay,
            check_ps: [own.check_ps[0], of_turns.check_ps[1]],
            start,
            ..own
        };
        // The training for positions is kept.
        let of_all = if let Numbers::Tuned(of_all, _) = self.numbers { of_all } else { None };
        Self { predictor, numbers: Numbers::Tuned(of_all, training), ..self.clone() }
    }

    fn tuning(&self, interval_ps: u64) -> Tuned {
        let (motion, tracker) = (self.motion.as_ref(), &self.tracker);
        match &self.tunings {
            Some(tunings) => tunings.tuned(motion, tracker, interval_ps, &self.predictor, self.seed),
            None => tuned_once(motion, tracker, interval_ps, &self.predictor, self.seed),
        }
    }

    /// Returns the predictor's kind and parameters. In an outcome, the parameters are those that the run used.
    pub const fn predictor(&self) -> &PredictorConfig {
        &self.predictor
    }

    /// Returns the training data from which the predictor was tuned. Returns `None` before the run, or if the user set
    /// the parameters.
    pub const fn training(&self) -> Option<&Training> {
        if let Numbers::Tuned(Some(training), _) = &self.numbers { Some(training) } else { None }
    }

    /// Returns the training data from which the parameters for orientations were tuned separately, or `None`.
    ///
    /// Only a display that turns pictures by the newest orientation needs separate parameters.
    pub const fn training_of_turns(&self) -> Option<&Training> {
        if let Numbers::Tuned(_, Some(training)) = &self.numbers { Some(training) } else { None }
    }

    /// Returns the tracker that reports the pose of the head.
    pub const fn tracker(&self) -> &TrackerModel {
        &self.tracker
    }

    /// Returns the head's motion, in the tracker's coordinates.
    pub fn motion(&self) -> &(dyn Motion + Send + Sync) {
        self.motion.as_ref()
    }

    pub(crate) fn without_prediction(&self) -> Self {
        Self { predictor: PredictorConfig { kind: PredictorKind::None, ..self.predictor }, ..self.clone() }
    }

    pub(crate) fn build_predictor(&self) -> Box<dyn Predictor> {
        self.predictor.build().expect("checked by Head::new")
    }
}
