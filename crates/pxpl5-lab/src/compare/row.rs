//! A row of a comparison: the results of one method, combined from the runs of all seeds.

use super::compared::{ComparedPipeline, DELAYED_VIDEO, IDEAL};
use super::gallery::LastPicture;
use super::interval::MeanInterval;
use super::trial::Trial;
use pxpl5_measure::{Budget, FieldMisregistration, Percentiles, Showing};
use pxpl5_run::{Cause, Pipeline, ResultWindow, Statistics, number_or_nan};
use pxpl5_wire::PeriodNumber;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use tracking::predict::PredictorKind;

/// Pixel errors of a comparison row, over the runs of all seeds.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ErrorSpread {
    /// Mean distance of a pixel's content from its ideal position, in pixels.
    pub mean_px: MeanInterval,
    /// Mean distance of a pixel's content from its ideal position, in degrees.
    pub mean_deg: MeanInterval,
    /// Percentiles of the error over all evaluated pixels of all seeds, in pixels.
    pub pixels: Percentiles,
    /// Number of evaluated pixels, over all seeds.
    pub n: u64,
    /// Share of the evaluated pixels, 0 to 1, whose content has left the picture when the pixel is lit. `None` if no pixel
    /// was evaluated.
    pub outside_share: Option<f64>,
    /// Percentiles 0 to 100 of the error over all evaluated pixels, in pixels: 101 numbers in ascending order. Empty if
    /// no pixel was evaluated.
    pub distribution_px: Vec<f64>,
}

/// Contribution of one cause to the mean pixel error.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct CauseShare {
    /// The cause of the error. `None` means the interaction of all causes.
    pub cause: Option<Cause>,
    /// Contribution in pixels, as a mean over the seeds. Negative if the error grows when the cause is turned off.
    pub px: MeanInterval,
}

/// Mean pixel error of a row in a run with a different predictor.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct PredictorMean {
    /// Predictor that replaced the predictor of the row.
    pub kind: PredictorKind,
    /// Mean pixel error. NaN if no pixel was evaluated.
    #[serde(deserialize_with = "number_or_nan")]
    pub mean_px: f64,
}

/// Mean pixel error of a row if all prediction intervals were wrong.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct PredictionIntervalErrorMean {
    /// Milliseconds by which the intervals are too long, or too short if negative.
    pub later_ms: i64,
    /// Mean pixel error over the seeds. NaN if no pixel was evaluated.
    #[serde(deserialize_with = "number_or_nan")]
    pub mean_px: f64,
}

/// Results of one low-latency method in a comparison.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ComparisonRow {
    /// Name of the row: the name of a pipeline or of one of its variants.
    pub pipeline: String,
    /// Settings that distinguish this row from other rows of the same pipeline.
    pub settings: String,
    /// Number of eyes for which the pipeline draws pictures.
    pub eyes: usize,
    /// Number of seeds with which this row ran.
    pub seeds: usize,
    /// True if the confidence interval of the mean error is narrow enough. `None` if no width was required.
    pub is_precise: Option<bool>,
    /// Definition of the pipeline's latency, in words.
    pub latency_definition: String,
    /// Time in milliseconds from the start of TRANSFORM until the picture is shown, over the complete pictures of all
    /// seeds.
    pub latency_ms: Statistics,
    /// Latency from the measured pose of the head until the display lights the middle of the picture, in milliseconds.
    /// All complete pictures of all seeds count. For pipelines that draw cube faces, only the position of the head
    /// counts.
    pub head_to_light_ms: Statistics,
    /// Percentiles of the same latencies.
    pub head_to_light_percentiles_ms: Percentiles,
    /// Latency from the measured orientation of the head until the display lights the middle of the picture, in
    /// milliseconds. At scan-out, cube faces get the newest orientation. Other pictures show the orientation of the
    /// pose that gave their position.
    pub turn_to_light_ms: Statistics,
    /// Sum of two mean times in milliseconds, averaged over the seeds, as the papers print it. The first time lasts
    /// from the measurement of a pose to the arrival of the tracker's report. The second time lasts from the start of
    /// an eye's TRANSFORM to the swap.
    ///
    /// The sum is shorter than [`ComparisonRow::head_to_light_ms`], which also contains the wait for the pipeline,
    /// SEND, EDIT and the scan.
    pub tracking_and_rendering_ms: MeanInterval,
    /// Stages of the latency from head to display in milliseconds, over the complete pictures of all seeds.
    pub end_to_end: Budget,
    /// Prediction interval in milliseconds: from the newest measurement of the head to the instant for which a picture
    /// is drawn.
    pub prediction_interval_ms: Statistics,
    /// Number of new complete pictures per second, averaged over the seeds with at least two pictures. NaN if there are
    /// no such seeds.
    pub updates_hz: MeanInterval,
    /// Number of due pictures in all seeds. `None` if the pipeline's pictures have no deadlines.
    pub pictures_due: Option<u64>,
    /// Number of due pictures that were late, incomplete or missed. `None` if the pipeline's pictures have no
    /// deadlines.
    pub missed_retraces: Option<u64>,
    /// Number of regions in all seeds that arrived after their deadline. `None` if regions have no deadline.
    pub late_regions: Option<usize>,
    /// Pixel errors on a grid of pixels, over all evaluated fields.
    pub error: ErrorSpread,
    /// Mean pixel error of each seed that was evaluated, in the order of the seeds.
    pub seed_px: Vec<f64>,
    /// Mean error minus the mean error of the best row, in pixels. Both rows have the same motions, so the interval is
    /// narrower than those of the two means. `None` if the comparison has no best row, and for rows that are not ranked.
    pub above_best_px: Option<MeanInterval>,
    /// Share of the picture, 0 to 1, that the scene covers, as a mean over the seeds. `None` if errors are evaluated at a
    /// fixed distance, or if the whole scene moves with the head.
    pub covered_share: Option<f64>,
    /// Display periods over which the run with the first seed was evaluated. `None` if there is no seed, or if the run
    /// was too short.
    pub window: Option<ResultWindow>,
    /// Contributions of all causes to the mean error. The mean error is the sum of all contributions. Empty if the
    /// comparison did not include causes.
    pub causes: Vec<CauseShare>,
    /// Mean error for wrong prediction intervals. Empty if the comparison did not include causes.
    #[serde(default)]
    pub prediction_interval_errors: Vec<PredictionIntervalErrorMean>,
    /// Mean error of the first seed with each predictor. Empty if the comparison did not include predictors. Also empty
    /// for the row `ideal`, because predictors do not change its pictures.
    pub predictors: Vec<PredictorMean>,
    /// Largest number of triangles that satisfies the condition in `triangles_definition`. `None` without a search,
    /// after a failed search, or if the pipeline has no limit.
    pub triangles_possible: Option<u32>,
    /// True if the search found no limit: [`CEILING`](crate::limit::CEILING) triangles satisfy the condition.
    pub has_no_limit: bool,
    /// Criterion of `triangles_possible`, in words.
    pub triangles_definition: String,
    /// Reason for missing results, with the number of triangles that the pipeline could draw. `None` if no result is
    /// missing.
    pub failure: Option<String>,
    /// Seconds that the runs took on this computer. `None` without a clock.
    pub host_seconds: Option<f64>,
    /// Warnings about times of the first seed that a small change moves by a whole field. Empty for resumed rows.
    #[serde(skip)]
    pub near_edges: Vec<String>,
    /// Pixel errors of each display field for the first motion: in the run with the first seed, or as a mean over all seeds
    /// if they share the motion.
    #[serde(skip)]
    pub by_field: Vec<FieldMisregistration>,
    /// Last picture of the first seed for the first eye. `None` if no picture was kept or shown.
    #[serde(skip)]
    pub picture: Option<LastPicture>,
}

impl ComparisonRow {
    /// Combines the runs of all seeds into a row. Without runs, the row has no numbers.
    pub(super) fn of(
        compared: &ComparedPipeline,
        pipeline: &dyn Pipeline,
        trials: &[&Trial],
        sampling: Sampling,
    ) -> Self {
        let confidence = sampling.confidence;
        let is_reference = compared.showing == Showing::Ideal;
        // The reference is computed for each pixel's own instant and has no latency.
        let definition = if is_reference {
            "none: computed for the instant of each pixel, without a machine"
        } else {
            pipeline.properties().latency_definition
        };
        // With one motion, an interval over the seeds would show the noise of the tracker alone.
        let over_seeds = |values: &[f64]| {
            let interval = MeanInterval::of(values, confidence);
            if sampling.is_one_motion { interval.without_interval() } else { interval }
        };
        let sums_ms: Vec<f64> = trials.iter().filter_map(|trial| trial.tracking_and_rendering_ms).collect();
        let hz: Vec<f64> = trials.iter().filter_map(|trial| trial.updates_hz).collect();
        Self {
            pipeline: compared.name.to_owned(),
            settings: settings_text(compared),
            eyes: pipeline.properties().eyes,
            seeds: sampling.seeds,
            is_precise: None,
            latency_definition: definition.to_owned(),
            latency_ms: pooled(trials, |trial| &trial.latency_ms),
            head_to_light_ms: pooled(trials, |trial| &trial.head_to_light_ms),
            head_to_light_percentiles_ms: Percentiles::of(
                trials.iter().flat_map(|trial| &trial.head_to_light_ms).copied(),
            ),
            turn_to_light_ms: pooled(trials, |trial| &trial.turn_to_light_ms),
            tracking_and_rendering_ms: over_seeds(&sums_ms),
            end_to_end: Budget::pooled(trials.iter().filter(|_| !is_reference).map(|trial| trial.budget)),
            prediction_interval_ms: pooled(trials, |trial| &trial.prediction_interval_ms),
            updates_hz: over_seeds(&hz),
            pictures_due: sum(trials.iter().map(|trial| Some(trial.due?.due))),
            missed_retraces: sum(trials.iter().map(|trial| Some(trial.due?.not_shown()))),
            late_regions: sum(trials.iter().map(|trial| trial.due.map(|_| trial.late_regions))),
            error: ErrorSpread::of(trials, sampling),
            seed_px: seed_means(trials),
            above_best_px: None,
            covered_share: mean_of(trials.iter().filter_map(|trial| trial.errors.covered_share)),
            window: trials.first().and_then(|trial| trial.window),
            causes: causes(trials, sampling),
            prediction_interval_errors: prediction_interval_errors(trials),
            predictors: Vec::new(),
            triangles_possible: None,
            has_no_limit: false,
            triangles_definition: String::new(),
            failure: None,
            host_seconds: trials.iter().map(|trial| trial.host_seconds).sum(),
            near_edges: trials.first().map(|trial| trial.near_edges.clone()).unwrap_or_default(),
            by_field: if sampling.is_one_motion {
                mean_of_fields(trials)
            } else {
                trials.first().map(|trial| trial.errors.by_field.clone()).unwrap_or_default()
            },
            picture: trials.first().and_then(|trial| trial.picture.clone()),
        }
    }

    /// Returns the predictor with the smallest mean error, or `None` if no predictor was evaluated.
    pub fn best_predictor(&self) -> Option<PredictorMean> {
        let evaluated = self.predictors.iter().copied().filter(|one| one.mean_px.is_finite());
        evaluated.min_by(|one, other| one.mean_px.total_cmp(&other.mean_px))
    }

    /// Returns true if every picture that was due was shown in time.
    pub fn shows_all(&self) -> bool {
        self.missed_retraces.unwrap_or(0) == 0
    }

    /// Returns true if the error of the row can be ranked with the errors of other rows. The rows `delayed-video` and
    /// `ideal` are references that cannot be ranked. The error of `delayed-video` leaves out the delay of the real
    /// world, and `ideal` has no pipeline.
    pub fn is_ranked(&self) -> bool {
        ![DELAYED_VIDEO, IDEAL].contains(&self.pipeline.as_str())
    }

    /// Returns true if the error of at least one pixel was evaluated.
    pub const fn was_evaluated(&self) -> bool {
        self.error.n > 0
    }
}

impl fmt::Display for ComparisonRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let px = self.error.mean_px.mean;
        let error = if px.is_finite() { format!("error {px:.2} px") } else { "no error".to_owned() };
        write!(f, "{}: {error}", self.pipeline)?;
        match self.missed_retraces.filter(|missed| *missed > 0) {
            Some(missed) => write!(f, ", {missed} of {} pictures not shown", self.pictures_due.unwrap_or_default()),
            None => Ok(()),
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Sampling {
    pub(super) seeds: usize,
    /// True if the head moves in the same way for each seed, for example because the motion is a recording.
    pub(super) is_one_motion: bool,
    /// True if the tracker's reports have random errors.
    pub(super) is_noisy: bool,
    pub(super) confidence: f64,
}

/// Returns the sum of all values except `None`, or `None` if no other value exists.
fn sum<T: std::iter::Sum>(values: impl Iterator<Item = Option<T>>) -> Option<T> {
    let mut present = values.flatten().peekable();
    present.peek().is_some().then(|| present.sum())
}

fn settings_text(compared: &ComparedPipeline) -> String {
    let settings = compared.settings.iter().map(|(key, value)| format!("{key}={value}"));
    settings.collect::<Vec<_>>().join(" ")
}

fn pooled(trials: &[&Trial], values: impl Fn(&Trial) -> &Vec<f64>) -> Statistics {
    Statistics::of(trials.iter().flat_map(|trial| values(trial)).copied())
}

/// Returns the mean errors for wrong prediction intervals, over all seeds.
fn prediction_interval_errors(trials: &[&Trial]) -> Vec<PredictionIntervalErrorMean> {
    let later_ms =
        trials.first().map(|trial| trial.prediction_interval_errors.iter().map(|one| one.0)).into_iter().flatten();
    let mean = |(i, later_ms): (usize, i64)| {
        let of_seeds = trials.iter().filter_map(|trial| trial.prediction_interval_errors.get(i)).map(|one| one.1);
        PredictionIntervalErrorMean { later_ms, mean_px: Statistics::of(of_seeds.filter(|px| px.is_finite())).mean }
    };
    later_ms.enumerate().map(mean).collect()
}

/// Returns the contributions of all causes to the mean error, with the interaction of the causes last.
fn causes(trials: &[&Trial], sampling: Sampling) -> Vec<CauseShare> {
    let interval = |px: &[f64]| {
        let interval = MeanInterval::of_signed(px, sampling.confidence);
        if sampling.is_one_motion { interval.without_interval() } else { interval }
    };
    let split: Vec<_> = trials.iter().filter_map(|trial| trial.causes.as_ref()).collect();
    if split.is_empty() {
        return Vec::new();
    }
    // Each cause gets the mean of its contribution over all seeds.
    let of_cause = |cause: Cause| {
        let px: Vec<f64> = split
            .iter()
            .flat_map(|causes| &causes.parts_px)
            .filter(|part| part.cause == cause)
            .map(|part| part.px)
            .collect();
        CauseShare { cause: Some(cause), px: interval(&px) }
    };
    let mut shares: Vec<CauseShare> = Cause::ALL.into_iter().map(of_cause).collect();
    // The part of the error that no single cause explains comes last.
    let interaction: Vec<f64> = split.iter().map(|causes| causes.interaction_px).collect();
    shares.push(CauseShare { cause: None, px: interval(&interaction) });
    shares
}

impl ErrorSpread {
    /// Combines the errors of all runs. Several motions give a confidence interval over the seeds. For one motion, see
    /// [`MeanInterval::of_one_motion`].
    pub(super) fn of(trials: &[&Trial], sampling: Sampling) -> Self {
        let confidence = sampling.confidence;
        let evaluated: Vec<&Trial> = trials.iter().copied().filter(|trial| trial.errors.evaluated > 0).collect();
        let px = seed_means(trials);
        let deg: Vec<f64> = evaluated.iter().map(|trial| trial.errors.degrees.mean).collect();
        let mut all: Vec<f64> = evaluated.iter().flat_map(|trial| &trial.errors.all_px).copied().collect();
        all.sort_by(f64::total_cmp);
        let mean_px = if sampling.is_one_motion {
            let series: Vec<f64> = mean_of_fields(&evaluated).iter().map(|field| field.mean_px).collect();
            MeanInterval::of_one_motion(&px, &series, sampling.is_noisy, confidence)
        } else {
            MeanInterval::of(&px, confidence)
        };
        let mean_deg = MeanInterval::of(&deg, confidence);
        let evaluated_n: u64 = evaluated.iter().map(|trial| trial.errors.evaluated).sum();
        let share = |count: fn(&Trial) -> u64| {
            (evaluated_n > 0)
                .then(|| evaluated.iter().map(|trial| count(trial)).sum::<u64>() as f64 / evaluated_n as f64)
        };
        Self {
            mean_px,
            // Angles are not kept for each field, so their mean has no interval over time.
            mean_deg: if sampling.is_one_motion { mean_deg.without_interval() } else { mean_deg },
            pixels: Percentiles::of(all.iter().copied()),
            n: evaluated_n,
            outside_share: share(|trial| trial.errors.outside),
            distribution_px: hundredths(&all),
        }
    }
}

/// Returns the difference of two rows' mean errors, with its interval. Both rows have the same motions, so a field, or a
/// seed, of one row is compared with the same field or seed of the other.
pub(super) fn difference(row: &ComparisonRow, best: &ComparisonRow, sampling: Sampling) -> MeanInterval {
    let seeds: Vec<f64> = row.seed_px.iter().zip(&best.seed_px).map(|(one, other)| one - other).collect();
    if !sampling.is_one_motion {
        return MeanInterval::of_signed(&seeds, sampling.confidence);
    }
    let of_best: BTreeMap<PeriodNumber, f64> = best.by_field.iter().map(|one| (one.field, one.mean_px)).collect();
    let paired = row.by_field.iter().filter_map(|one| Some(one.mean_px - of_best.get(&one.field)?));
    let series: Vec<f64> = paired.filter(|px| px.is_finite()).collect();
    MeanInterval::of_one_motion(&seeds, &series, sampling.is_noisy, sampling.confidence)
}

fn seed_means(trials: &[&Trial]) -> Vec<f64> {
    let evaluated = trials.iter().filter(|trial| trial.errors.evaluated > 0);
    evaluated.map(|trial| trial.errors.pixels.mean).collect()
}

fn mean_of(values: impl Iterator<Item = f64>) -> Option<f64> {
    Some(Statistics::of(values).mean).filter(|mean| mean.is_finite())
}

/// Returns the errors of each evaluated field, averaged over the seeds, in the order of time.
fn mean_of_fields(evaluated: &[&Trial]) -> Vec<FieldMisregistration> {
    let mut fields: BTreeMap<PeriodNumber, (FieldMisregistration, f64)> = BTreeMap::new();
    for field in evaluated.iter().flat_map(|trial| &trial.errors.by_field).filter(|field| field.mean_px.is_finite()) {
        let blank = FieldMisregistration { mean_px: 0.0, centre_px: 0.0, ..*field };
        let (sum, n) = fields.entry(field.field).or_insert((blank, 0.0));
        sum.mean_px += field.mean_px;
        sum.centre_px += field.centre_px;
        *n += 1.0;
    }
    let mean = |(sum, n): (FieldMisregistration, f64)| FieldMisregistration {
        mean_px: sum.mean_px / n,
        centre_px: sum.centre_px / n,
        ..sum
    };
    fields.into_values().map(mean).collect()
}

/// Returns the minimum of sorted numbers, followed by the percentiles 1 to 100. Percentile p is the smallest number
/// that is at least as large as p % of all numbers.
fn hundredths(sorted: &[f64]) -> Vec<f64> {
    let Some(least) = sorted.first() else { return Vec::new() };
    // Position of the smallest number that is at least as large as `percent` % of all numbers.
    let place = |percent: usize| (sorted.len() * percent).div_ceil(100).max(1) - 1;
    std::iter::once(*least).chain((1..=100).map(|percent| sorted[place(percent)])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_of_a_thousand_numbers_are_every_tenth_number() {
        let sorted: Vec<f64> = (1..=1_000).map(f64::from).collect();
        let hundredths = hundredths(&sorted);
        assert_eq!((hundredths.len(), hundredths[0], hundredths[50], hundredths[100]), (101, 1.0, 500.0, 1_000.0));
    }
}
