//! Comparison of all predictors on one experiment.

use super::row::PredictorMean;
use super::trial::with_raster;
use crate::parallel;
use pxpl5_measure::{PixelErrors, Showing};
use pxpl5_run::{Experiment, ExperimentError, Head, Outcome, Pixels};
use serde::Serialize;
use std::sync::Arc;
use tracking::predict::{PredictorConfig, PredictorKind, Training};

/// Result of an experiment with one predictor.
#[derive(Clone, Debug, Serialize)]
pub struct PredictorResult {
    /// Predictor that extrapolates the tracker's reports.
    pub kind: PredictorKind,
    /// Parameters of the predictor in the run. `None` if the run failed.
    pub numbers: Option<PredictorConfig>,
    /// Data on which the parameters were tuned. `None` if the settings state the parameters or the predictor needs no
    /// tuning.
    pub training: Option<Training>,
    /// Pixel errors of the run. `None` if no pixel was evaluated.
    pub error: Option<PixelErrors>,
    /// Reason for a missing result. `None` if `error` has a result.
    pub failure: Option<String>,
}

/// Results of all predictors on one experiment.
#[derive(Clone, Debug, Serialize)]
pub struct Predictors {
    /// Predictor in the settings of the experiment.
    pub chosen: PredictorKind,
    /// Predictor with the smallest mean error. Among equal errors, the simplest predictor is the best. `None` if no
    /// pixel was evaluated.
    pub best: Option<PredictorKind>,
    /// Results of all predictors, with the simplest predictor first.
    pub each: Vec<PredictorResult>,
}

impl Predictors {
    /// Returns the result of one predictor.
    pub fn of(&self, kind: PredictorKind) -> Option<&PredictorResult> {
        self.each.iter().find(|one| one.kind == kind)
    }
}

/// Runs an experiment once with each predictor and without pixels. All other settings stay the same. If the
/// experiment's own predictor is tuned, each predictor is tuned for the pipeline's prediction interval and the motion.
/// Returns `None` for an experiment without a head.
pub fn predictors(experiment: &Experiment) -> Option<Predictors> {
    let head = experiment.head.as_ref()?;
    let showing = head.raster.into();
    let each = parallel::map(&PredictorKind::ALL, |kind| with_predictor(experiment, head, showing, *kind));
    let mean = |one: &PredictorResult| one.error.as_ref().map(|error| (one.kind, error.pixels.mean));
    let evaluated = each.iter().filter_map(mean).filter(|(_, mean)| mean.is_finite());
    let best = evaluated.reduce(|best, next| if next.1 < best.1 { next } else { best });
    Some(Predictors { chosen: head.predictor().kind, best: best.map(|(kind, _)| kind), each })
}

/// Returns the mean error of an experiment with each predictor. `of_chosen_px` is the mean error with the experiment's
/// own predictor from an earlier run. The mean is NaN if no pixel was evaluated.
pub(super) fn predictor_means(experiment: &Experiment, showing: Showing, of_chosen_px: f64) -> Vec<PredictorMean> {
    let Some(head) = experiment.head.as_ref() else { return Vec::new() };
    let showing = with_raster(showing, Some(head.as_ref()));
    parallel::map(&PredictorKind::ALL, |kind| {
        let mean_px = if *kind == head.predictor().kind {
            of_chosen_px
        } else {
            with_predictor(experiment, head, showing, *kind).error.map_or(f64::NAN, |error| error.pixels.mean)
        };
        PredictorMean { kind: *kind, mean_px }
    })
}

fn with_predictor(experiment: &Experiment, head: &Head, showing: Showing, kind: PredictorKind) -> PredictorResult {
    let with_kind = Arc::new(head.clone().with_prediction(kind));
    of_run(kind, showing, experiment.clone().head(with_kind).pixels(Pixels::Off).run())
}

fn of_run(kind: PredictorKind, showing: Showing, run: Result<Outcome, ExperimentError>) -> PredictorResult {
    let blank = PredictorResult { kind, numbers: None, training: None, error: None, failure: None };
    match run {
        Ok(outcome) => PredictorResult {
            numbers: outcome.head().map(|views| *views.head().predictor()),
            training: outcome.head().and_then(|views| views.head().training().copied()),
            error: Some(PixelErrors::shown(&outcome, showing)).filter(|error| error.evaluated > 0),
            ..blank
        },
        Err(error) => PredictorResult { failure: Some(error.to_string()), ..blank },
    }
}
