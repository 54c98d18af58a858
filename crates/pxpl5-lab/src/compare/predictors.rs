//! One experiment with every predictor: the best of none, velocity, acceleration and Kalman beside the chosen one.

use crate::parallel;
use pxpl5_measure::{PixelErrors, Showing};
use pxpl5_run::{Experiment, ExperimentError, Outcome, Pixels};
use serde::Serialize;
use std::sync::Arc;
use tracking::predict::{PredictorConfig, PredictorKind, Training};

/// What one predictor makes of an experiment.
#[derive(Clone, Debug, Serialize)]
pub struct PredictorError {
    /// The filter that was put between tracker and pipeline.
    pub kind: PredictorKind,
    /// Its numbers, as it ran; nothing where it could not.
    pub numbers: Option<PredictorConfig>,
    /// On what they were tuned; nothing where they were given, or nothing is tuned.
    pub training: Option<Training>,
    /// Pixel errors; nothing where none was judged.
    pub error: Option<PixelErrors>,
    /// Why there is no error, if so.
    pub failure: Option<String>,
}

/// All predictors on one experiment.
#[derive(Clone, Debug, Serialize)]
pub struct Predictors {
    /// The predictor that the experiment asks for.
    pub chosen: PredictorKind,
    /// The one with the least mean error; the simplest of those that have it. Nothing where no error was judged.
    pub best: Option<PredictorKind>,
    /// Each of them, the simplest first.
    pub each: Vec<PredictorError>,
}

impl Predictors {
    /// What one of them makes of the experiment.
    #[must_use]
    pub fn of(&self, kind: PredictorKind) -> Option<&PredictorError> {
        self.each.iter().find(|one| one.kind == kind)
    }
}

/// Runs an experiment with each predictor, tuned for the pipeline's interval and the motion if the experiment's own is, and else with
/// its numbers; everything else stays. `None` of an experiment without a head. No pixels are computed.
#[must_use]
pub fn predictors(experiment: &Experiment) -> Option<Predictors> {
    let raster = experiment.tracked_head()?.raster();
    predictors_shown(experiment, raster.into())
}

/// The same with pictures shown otherwise than on the head's own raster.
pub(super) fn predictors_shown(experiment: &Experiment, showing: Showing) -> Option<Predictors> {
    let head = experiment.tracked_head()?;
    let each = parallel::map(&PredictorKind::ALL, |kind| {
        let with_kind = Arc::new(head.as_ref().clone().predicting(*kind));
        of_run(*kind, showing, experiment.clone().head(with_kind).pixels(Pixels::Off).run())
    });
    let mean = |one: &PredictorError| one.error.as_ref().map(|error| (one.kind, error.pixels.mean));
    let judged = each.iter().filter_map(mean).filter(|(_, mean)| mean.is_finite());
    let best = judged.reduce(|best, next| if next.1 < best.1 { next } else { best });
    Some(Predictors { chosen: head.predictor_kind(), best: best.map(|(kind, _)| kind), each })
}

fn of_run(kind: PredictorKind, showing: Showing, run: Result<Outcome, ExperimentError>) -> PredictorError {
    let blank = PredictorError { kind, numbers: None, training: None, error: None, failure: None };
    match run {
        Ok(outcome) => PredictorError {
            numbers: outcome.head().map(|views| *views.head().predictor()),
            training: outcome.head().and_then(|views| views.head().training().copied()),
            error: Some(PixelErrors::shown(&outcome, showing)).filter(|error| error.judged > 0),
            ..blank
        },
        Err(error) => PredictorError { failure: Some(error.to_string()), ..blank },
    }
}
