//! A head, its tracker and a predictor in front of a pipeline.

use crate::fingerprint::Fingerprint;
use crate::raster::Raster;
use crate::report_schedule::{Arrivals, Coming, Contents};
use pxpl5_display::Aim;
use pxpl5_machine::Parameter;
use pxpl5_sim::Time;
use std::fmt;
use std::sync::Arc;
use tracking::motion::{Motion, Still};
use tracking::predict::{Predictor, PredictorConfig, PredictorKind, Start, Training, Tuned, tune};
use tracking::tracker::{TrackerConfig, TrackerModel, TrackerReport};
use tracking::{Pose, SettingError};

/// A motion that whoever follows it shares.
pub(crate) type Moving = Arc<dyn Motion + Send + Sync>;

/// Why a head cannot be simulated.
pub type HeadError = SettingError;

/// Where the numbers of a predictor come from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Numbers {
    /// They are as they were given.
    Given,
    /// They are found when the experiment is run, for the interval that its pipeline has to predict over.
    ToBeTuned,
    /// They were found so, if there was anything to find; those of turns by themselves, where turns are predicted over another interval.
    Tuned(Option<Training>, Option<Training>),
}

/// How a predictor is tuned, in names of experiments; the numbers follow from it and from everything else there.
const TUNING: &str = "for its interval and motion, version 1";

/// A head, its tracker, a predictor, and the display before its eyes.
#[derive(Clone)]
pub struct Head {
    pub(crate) motion: Moving,
    pub(crate) tracker: TrackerModel,
    predictor: PredictorConfig,
    numbers: Numbers,
    judge_at_m: Option<f64>,
    pub(crate) seed: u64,
    raster: Raster,
    aim: Aim,
    reports: Option<Arc<[TrackerReport]>>,
    /// Numbers of its tracker and predictor that no source allows.
    suppositions: Vec<Parameter>,
}

impl fmt::Debug for Head {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Head")
            .field("tracker", self.tracker.config())
            .field("predictor", &self.predictor)
            .field("numbers", &self.numbers)
            .field("judge_at_m", &self.judge_at_m)
            .field("seed", &self.seed)
            .field("raster", &self.raster)
            .field("aim", &self.aim)
            .finish_non_exhaustive()
    }
}

/// Distances, in metres, at which errors can be judged.
const JUDGED_AT_M: (f64, f64) = (1e-3, 1e6);

impl Head {
    /// A head that moves, a tracker and a predictor that knows the tracker's noise, and whose numbers are tuned, when the
    /// experiment is run, for the interval that the pipeline has to predict over and for the motion
    /// ([`tune`](tracking::predict::tune)).
    ///
    /// # Errors
    ///
    /// [`HeadError`] names the setting, what was expected and what was found.
    pub fn new(
        motion: Arc<dyn Motion + Send + Sync>,
        tracker: TrackerConfig,
        predictor: PredictorKind,
        seed: u64,
    ) -> Result<Self, HeadError> {
        let predictor = PredictorConfig::for_tracker(predictor, &tracker);
        Ok(Self { numbers: Numbers::ToBeTuned, ..Self::predicted_by(motion, tracker, predictor, seed)? })
    }

    /// The same with a predictor whose numbers are given, and not tuned.
    ///
    /// # Errors
    ///
    /// As [`Head::new`].
    pub fn predicted_by(
        motion: Arc<dyn Motion + Send + Sync>,
        tracker: TrackerConfig,
        predictor: PredictorConfig,
        seed: u64,
    ) -> Result<Self, HeadError> {
        predictor.build()?;
        let tracker = TrackerModel::new(tracker)?;
        Ok(Self {
            motion,
            tracker,
            predictor,
            numbers: Numbers::Given,
            judge_at_m: None,
            seed,
            raster: Raster::Plain,
            aim: Aim::Middle,
            reports: None,
            suppositions: Vec::new(),
        })
    }

    /// Moves otherwise: the same tracker and predictor before another motion.
    #[must_use]
    pub fn moving(self, motion: Arc<dyn Motion + Send + Sync>) -> Self {
        Self { motion, ..self }
    }

    /// Has the numbers of its predictor tuned when the experiment is run; they are searched from the present ones.
    #[must_use]
    pub const fn tuned(mut self) -> Self {
        self.numbers = Numbers::ToBeTuned;
        self
    }

    /// Has another predictor in the place of its own, with the same numbers, or tuned if its own is.
    #[must_use]
    pub const fn predicting(mut self, kind: PredictorKind) -> Self {
        self.predictor.kind = kind;
        self
    }

    /// Says at which distance from the eye, in metres, pixel errors are judged; else it is where the scene's content lies.
    ///
    /// # Errors
    ///
    /// [`HeadError`] for a distance that is not within 0.001 to 1,000,000 metres.
    pub fn judged_at(self, metres: f64) -> Result<Self, HeadError> {
        let (low, high) = JUDGED_AT_M;
        if !(low..=high).contains(&metres) {
            let what = "distance at which errors are judged, m";
            return Err(HeadError::OutOfRange { what, found: metres, low, high });
        }
        Ok(Self { judge_at_m: Some(metres), ..self })
    }

    /// The distance at which pixel errors are judged, metres; `None` where the scene's content lies.
    #[must_use]
    pub const fn judge_at_m(&self) -> Option<f64> {
        self.judge_at_m
    }

    /// Puts a raster before its eyes.
    #[must_use]
    pub const fn before(mut self, raster: Raster) -> Self {
        self.raster = raster;
        self
    }

    /// Says for which instant of what is shown from them views are predicted.
    #[must_use]
    pub const fn aiming(mut self, aim: Aim) -> Self {
        self.aim = aim;
        self
    }

    /// Says which numbers of its tracker and predictor lie outside of what their sources allow, so that reports warn of them.
    #[must_use]
    pub fn supposing(self, suppositions: Vec<Parameter>) -> Self {
        Self { suppositions, ..self }
    }

    /// The numbers of its tracker and predictor that no source allows, as far as they were said.
    #[must_use]
    pub fn suppositions(&self) -> &[Parameter] {
        &self.suppositions
    }

    /// Puts these reports, in order of arrival, in the place of those that its tracker would make of the motion.
    #[must_use]
    pub fn reporting(self, reports: Vec<TrackerReport>) -> Self {
        Self { reports: Some(reports.into()), ..self }
    }

    /// The reports that reach the host before an instant.
    pub(crate) fn arrivals(&self, until: Time) -> Arrivals {
        let reports = self.reports_of(Arc::new(Still(Pose::IDENTITY)));
        Box::new(reports.map(Coming::of).take_while(move |coming| coming.arrives < until))
    }

    /// What all of its reports say.
    pub(crate) fn contents(&self) -> Contents {
        self.reports_of(Arc::clone(&self.motion))
    }

    /// What its tracker says of a motion, or what was put in the place of that, in order of arrival.
    fn reports_of(&self, motion: Moving) -> Contents {
        match &self.reports {
            Some(given) => Box::new(GivenReports { given: Arc::clone(given), next: 0 }),
            None => Box::new(self.tracker.reports(motion, self.seed)),
        }
    }

    /// For which instant of what is shown from them views are predicted.
    #[must_use]
    pub const fn aim(&self) -> Aim {
        self.aim
    }

    /// How the raster before its eyes shows the picture.
    #[must_use]
    pub const fn raster(&self) -> Raster {
        self.raster
    }

    /// Name of everything that it is, the motion included.
    #[must_use]
    pub fn fingerprint(&self) -> Fingerprint {
        let mut hash = Fingerprint::default();
        let mut add = |key: &str, value: &dyn fmt::Display| hash.setting(key, value);
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
        if let Some(metres) = self.judge_at_m {
            hash.setting("judge_at_m", metres);
        }
        hash.setting("seed", self.seed);
        hash.setting("raster", self.raster);
        hash.setting("aim", self.aim);
        self.reports.iter().flat_map(|reports| reports.iter()).for_each(|report| {
            hash.setting("report", format_args!("{report:?}"));
        });
        hash
    }

    /// Whether poses are predicted.
    #[must_use]
    pub fn predicts(&self) -> bool {
        self.predictor.kind != PredictorKind::None
    }

    /// Whether the numbers of its predictor are found when the experiment is run, or were.
    #[must_use]
    pub fn is_tuned(&self) -> bool {
        self.numbers != Numbers::Given
    }

    /// Whether the numbers of its predictor are still to be found.
    pub(crate) fn is_to_be_tuned(&self) -> bool {
        self.numbers == Numbers::ToBeTuned && self.predicts()
    }

    /// The same with the numbers with which its predictor errs least so far ahead of the tracker's reports.
    pub(crate) fn tuned_for(&self, interval_ps: u64) -> Self {
        let tuned = tune(self.motion.as_ref(), &self.tracker, interval_ps, &self.predictor, self.seed);
        let tuned = tuned.expect("checked by Head::new");
        Self { predictor: tuned.config, numbers: Numbers::Tuned(tuned.training, None), ..self.clone() }
    }

    /// The same with numbers for orientations with which its predictor errs least in turns so far ahead; those for places stay.
    pub(crate) fn tuned_for_turns(&self, interval_ps: u64) -> Self {
        let tuned = tune(self.motion.as_ref(), &self.tracker, interval_ps, &self.predictor, self.seed);
        let Tuned { config: of_turns, training } = tuned.expect("checked by Head::new");
        let own = self.predictor;
        let start =
            Start { turn: of_turns.start.turn, turn_acceleration: of_turns.start.turn_acceleration, ..own.start };
        let predictor = PredictorConfig {
            orientation_baseline: of_turns.orientation_baseline,
            orientation_jerk: of_turns.orientation_jerk,
            start,
            ..own
        };
        let of_all = if let Numbers::Tuned(of_all, _) = self.numbers { of_all } else { None };
        Self { predictor, numbers: Numbers::Tuned(of_all, training), ..self.clone() }
    }

    /// The predictor with its numbers: in an outcome those with which it ran.
    #[must_use]
    pub const fn predictor(&self) -> &PredictorConfig {
        &self.predictor
    }

    /// On what its predictor was tuned; `None` where its numbers were given, or before the experiment is run.
    #[must_use]
    pub const fn training(&self) -> Option<&Training> {
        if let Numbers::Tuned(Some(training), _) = &self.numbers { Some(training) } else { None }
    }

    /// On what the numbers of orientations were tuned by themselves, for a display that latches turns alone; `None` elsewhere.
    #[must_use]
    pub const fn training_of_turns(&self) -> Option<&Training> {
        if let Numbers::Tuned(_, Some(training)) = &self.numbers { Some(training) } else { None }
    }

    /// Which filter makes poses of the tracker's reports.
    #[must_use]
    pub const fn predictor_kind(&self) -> PredictorKind {
        self.predictor.kind
    }

    /// The tracker that reports where the head is.
    #[must_use]
    pub const fn tracker(&self) -> &TrackerModel {
        &self.tracker
    }

    /// The motion, in the tracker's coordinates.
    #[must_use]
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

/// Reports that were said, one after the other.
struct GivenReports {
    given: Arc<[TrackerReport]>,
    next: usize,
}

impl Iterator for GivenReports {
    type Item = TrackerReport;

    fn next(&mut self) -> Option<TrackerReport> {
        let report = self.given.get(self.next).copied();
        self.next += 1;
        report
    }
}
