//! One experiment with every predictor: the best of none, velocity, acceleration and Kalman beside the chosen one.

use super::row::PredictorMean;
use crate::parallel;
use pxpl5_measure::{PixelErrors, Showing};
use pxpl5_run::{Experiment, ExperimentError, Head, Outcome, Pixels};
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
    let head = experiment.tracked_head()?;
    let showing = head.raster().into();
    let each = parallel::map(&PredictorKind::ALL, |kind| with_predictor(experiment, head, showing, *kind));
    let mean = |one: &PredictorError| one.error.as_ref().map(|error| (one.kind, error.pixels.mean));
    let judged = each.iter().filter_map(mean).filter(|(_, mean)| mean.is_finite());
    let best = judged.reduce(|best, next| if next.1 < best.1 { next } else { best });
    Some(Predictors { chosen: head.predictor_kind(), best: best.map(|(kind, _)| kind), each })
}

/// The mean error of an experiment with each predictor, of which that with the chosen one has been run; no number where none was judged.
pub(super) fn predictor_means(experiment: &Experiment, showing: Showing, of_chosen_px: f64) -> Vec<PredictorMean> {
    let Some(head) = experiment.tracked_head() else { return Vec::new() };
    parallel::map(&PredictorKind::ALL, |kind| {
        let mean_px = if *kind == head.predictor_kind() {
            of_chosen_px
        } else {
            with_predictor(experiment, head, showing, *kind).error.map_or(f64::NAN, |error| error.pixels.mean)
        };
        PredictorMean { kind: *kind, mean_px }
    })
}

fn with_predictor(experiment: &Experiment, head: &Head, showing: Showing, kind: PredictorKind) -> PredictorError {
    let with_kind = Arc::new(head.clone().predicting(kind));
    of_run(kind, showing, experiment.clone().head(with_kind).pixels(Pixels::Off).run())
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
