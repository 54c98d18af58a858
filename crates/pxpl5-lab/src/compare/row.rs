//! A row of the table: all of its runs together.

use super::contender::Contender;
use super::gallery::LastPicture;
use super::trial::Trial;
use distrs::StudentsT;
use pxpl5_measure::{Budget, FieldError, Percentiles, Showing};
use pxpl5_run::{Cause, Pipeline, Statistics};
use serde::Serialize;
use tracking::predict::PredictorKind;

/// A mean over seeds and where it lies with 95 % confidence (Student's t over the means of the seeds).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MeanInterval {
    /// Mean of the means of the seeds; no number where there is none.
    pub mean: f64,
    /// Lower end of the interval; no number of fewer than two seeds.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
    /// Seeds whose means these are.
    pub n: usize,
}

impl MeanInterval {
    /// Of one number for each seed.
    #[must_use]
    pub fn of(values: &[f64]) -> Self {
        let statistics = Statistics::of(values.iter().copied());
        let n = values.len();
        let half = if n < 2 { f64::NAN } else { quantile_of_t(n - 1) * statistics.sd / (n as f64).sqrt() };
        Self { mean: statistics.mean, low: statistics.mean - half, high: statistics.mean + half, n }
    }
}

/// The 97.5th percentile of Student's t with so many degrees of freedom.
fn quantile_of_t(freedom: usize) -> f64 {
    StudentsT::ppf(0.975, freedom as f64)
}

/// Errors of all runs together.
#[derive(Clone, Debug, Serialize)]
pub struct ErrorSpread {
    /// Mean distance from where a pixel's content should be, pixels.
    pub mean_px: MeanInterval,
    /// The same as an angle, degrees.
    pub mean_deg: MeanInterval,
    /// Percentiles over all judged pixels of all seeds, pixels.
    pub pixels: Percentiles,
    /// Judged pixels of all seeds together.
    pub n: u64,
    /// Every hundredth of the judged pixels' errors, pixels: 101 numbers from the least to the greatest; empty where none was judged.
    pub distribution_px: Vec<f64>,
}

/// What a cause adds to the mean error, pixels, and over how many seeds that is a mean.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct CauseShare {
    /// The cause; none for what is left, the interaction of all.
    pub cause: Option<Cause>,
    /// Pixels of the mean error; negative where the error is greater without the cause.
    pub px: MeanInterval,
}

/// What a predictor would make of a row.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PredictorMean {
    /// The predictor that stood in the place of the chosen one.
    pub kind: PredictorKind,
    /// Mean error, pixels; no number where none was judged.
    pub mean_px: f64,
}

/// One way to fight latency.
#[derive(Clone, Debug, Serialize)]
pub struct ComparisonRow {
    /// Name of the row: the pipeline, or a variant of it.
    pub pipeline: String,
    /// What tells it from others of the same pipeline.
    pub settings: String,
    /// Frame buffers that it draws into.
    pub eyes: usize,
    /// What its latency is of.
    pub latency_definition: String,
    /// Latency of the machine alone, milliseconds, over the complete pictures of all seeds.
    pub latency_ms: Statistics,
    /// From the head's pose to the light of the picture's middle, milliseconds, over the same. Of faces this is the way of a step.
    pub head_to_light_ms: Statistics,
    /// From the head's orientation to the light of the picture's middle, milliseconds. Faces are turned at scan-out, with the newest
    /// orientation; in all other pictures a turn goes the way of a step.
    pub turn_to_light_ms: Statistics,
    /// Its stages, milliseconds, over the same.
    pub end_to_end: Budget,
    /// From the measurement of the newest report to the instant that a picture is drawn for, milliseconds.
    pub prediction_interval_ms: Statistics,
    /// Whole new pictures a second, over the seeds with two or more; no number where none has as many.
    pub updates_hz: MeanInterval,
    /// Pictures that were due, of all seeds; nothing where none ever is.
    pub due: Option<u64>,
    /// Those of them that were not shown: late, incomplete and missed.
    pub not_shown: Option<u64>,
    /// Regions that came after their deadline, of all seeds; nothing where regions have none.
    pub late_regions: Option<usize>,
    /// Registration over a grid of pixels and all fields.
    pub error: ErrorSpread,
    /// The mean error by cause; they add up to it.
    pub causes: Vec<CauseShare>,
    /// The mean error of the first seed with each predictor; nothing of what is not drawn by firmware.
    pub predictors: Vec<PredictorMean>,
    /// Most triangles by the pipeline's own criterion; `None` where it was not asked for or means nothing.
    pub triangles_possible: Option<u32>,
    /// What that number means.
    pub triangles_definition: String,
    /// Why there are no numbers, if so, and what could be drawn.
    pub failure: Option<String>,
    /// Time that the runs took on this host, seconds.
    pub host_seconds: f64,
    /// Errors of the first seed over time.
    #[serde(skip)]
    pub by_field: Vec<FieldError>,
    /// What the first eye sees at the end of the first seed's run; `None` where pictures were not asked for, or nothing was shown.
    #[serde(skip)]
    pub picture: Option<LastPicture>,
}

impl ComparisonRow {
    /// All runs of a contender; a row without any has no numbers.
    pub(super) fn of(contender: &Contender, pipeline: &dyn Pipeline, trials: &[&Trial]) -> Self {
        let is_reference = contender.showing == Showing::Ideal;
        let definition = if is_reference {
            "none: every pixel's own moment, computed and not timed"
        } else {
            pipeline.latency_definition()
        };
        let hz: Vec<f64> = trials.iter().filter_map(|trial| trial.updates_hz).collect();
        Self {
            pipeline: contender.name.clone(),
            settings: settings_text(contender),
            eyes: pipeline.eyes(),
            latency_definition: definition.to_owned(),
            latency_ms: pooled(trials, |trial| &trial.latency_ms),
            head_to_light_ms: pooled(trials, |trial| &trial.head_to_light_ms),
            turn_to_light_ms: pooled(trials, |trial| &trial.turn_to_light_ms),
            end_to_end: Budget::pooled(trials.iter().filter(|_| !is_reference).map(|trial| trial.budget)),
            prediction_interval_ms: pooled(trials, |trial| &trial.prediction_interval_ms),
            updates_hz: MeanInterval::of(&hz),
            due: sum(trials.iter().map(|trial| Some(trial.due?.due))),
            not_shown: sum(trials.iter().map(|trial| Some(trial.due?.not_shown()))),
            late_regions: sum(trials.iter().map(|trial| trial.due.map(|_| trial.late_regions))),
            error: ErrorSpread::of(trials),
            causes: causes(trials),
            predictors: Vec::new(),
            triangles_possible: None,
            triangles_definition: String::new(),
            failure: None,
            host_seconds: trials.iter().map(|trial| trial.host_seconds).sum(),
            by_field: trials.first().map(|trial| trial.errors.by_field.clone()).unwrap_or_default(),
            picture: trials.first().and_then(|trial| trial.picture.clone()),
        }
    }

    /// The predictor with the least mean error, if any was judged.
    #[must_use]
    pub fn best_predictor(&self) -> Option<PredictorMean> {
        let judged = self.predictors.iter().copied().filter(|one| one.mean_px.is_finite());
        judged.min_by(|one, other| one.mean_px.total_cmp(&other.mean_px))
    }

    /// Whether any pixel of it could be judged.
    #[must_use]
    pub const fn is_judged(&self) -> bool {
        self.error.n > 0
    }
}

/// The sum of what is known; nothing where nothing is.
fn sum<T: std::iter::Sum>(values: impl Iterator<Item = Option<T>>) -> Option<T> {
    let mut known = values.flatten().peekable();
    known.peek().is_some().then(|| known.sum())
}

fn settings_text(contender: &Contender) -> String {
    let settings = contender.settings.iter().map(|(key, value)| format!("{key}={value}"));
    settings.collect::<Vec<_>>().join(" ")
}

fn pooled(trials: &[&Trial], values: impl Fn(&Trial) -> &Vec<f64>) -> Statistics {
    Statistics::of(trials.iter().flat_map(|trial| values(trial)).copied())
}

/// The interaction comes last.
fn causes(trials: &[&Trial]) -> Vec<CauseShare> {
    let split: Vec<_> = trials.iter().filter_map(|trial| trial.causes.as_ref()).collect();
    if split.is_empty() {
        return Vec::new();
    }
    let of_cause = |cause: Cause| {
        let px: Vec<f64> = split
            .iter()
            .flat_map(|causes| &causes.parts_px)
            .filter(|part| part.cause == cause)
            .map(|part| part.px)
            .collect();
        CauseShare { cause: Some(cause), px: MeanInterval::of(&px) }
    };
    let mut shares: Vec<CauseShare> = Cause::ALL.into_iter().map(of_cause).collect();
    let interaction: Vec<f64> = split.iter().map(|causes| causes.interaction_px).collect();
    shares.push(CauseShare { cause: None, px: MeanInterval::of(&interaction) });
    shares
}

impl ErrorSpread {
    fn of(trials: &[&Trial]) -> Self {
        let judged: Vec<&Trial> = trials.iter().copied().filter(|trial| trial.errors.judged > 0).collect();
        let px: Vec<f64> = judged.iter().map(|trial| trial.errors.pixels.mean).collect();
        let deg: Vec<f64> = judged.iter().map(|trial| trial.errors.degrees.mean).collect();
        let mut all: Vec<f64> = judged.iter().flat_map(|trial| &trial.errors.all_px).copied().collect();
        all.sort_by(f64::total_cmp);
        Self {
            mean_px: MeanInterval::of(&px),
            mean_deg: MeanInterval::of(&deg),
            pixels: Percentiles::of(all.iter().copied()),
            n: judged.iter().map(|trial| trial.errors.judged).sum(),
            distribution_px: hundredths(&all),
        }
    }
}

/// The least of some sorted numbers, and for each of 1 to 100 percent the smallest that so many do not exceed.
fn hundredths(sorted: &[f64]) -> Vec<f64> {
    let Some(least) = sorted.first() else { return Vec::new() };
    let place = |percent: usize| (sorted.len() * percent).div_ceil(100).max(1) - 1;
    std::iter::once(*least).chain((1..=100).map(|percent| sorted[place(percent)])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_five_means_is_that_of_the_tables() {
        // Mean 3, sample sd sqrt(2.5); t with 4 degrees of freedom is 2.776 (any table).
        let interval = MeanInterval::of(&[1.0, 2.0, 3.0, 4.0, 5.0]);
        let half = 2.776_445 * 2.5f64.sqrt() / 5f64.sqrt();
        assert_eq!((interval.mean, interval.n), (3.0, 5));
        assert!((interval.high - 3.0 - half).abs() < 1e-5 && (3.0 - interval.low - half).abs() < 1e-5, "{interval:?}");
    }

    #[test]
    fn one_seed_has_a_mean_and_no_interval() {
        let interval = MeanInterval::of(&[7.0]);
        assert!(interval.mean == 7.0 && interval.low.is_nan() && interval.high.is_nan());
        assert!(MeanInterval::of(&[]).mean.is_nan());
    }

    #[test]
    fn hundredths_of_a_thousand_numbers_are_every_tenth() {
        let sorted: Vec<f64> = (1..=1_000).map(f64::from).collect();
        let hundredths = hundredths(&sorted);
        assert_eq!((hundredths.len(), hundredths[0], hundredths[50], hundredths[100]), (101, 1.0, 500.0, 1_000.0));
    }
}
