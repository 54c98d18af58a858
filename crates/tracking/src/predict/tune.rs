use glam::DVec3;
use serde::Serialize;

use super::{PredictorConfig, PredictorKind, Start};
use crate::config::Filter;
use crate::error::SettingError;
use crate::motion::Motion;
use crate::pose::Pose;
use crate::time::{PS_PER_S, span_s};
use crate::tracker::{TrackerModel, TrackerReport};

/// Seconds of motion for tuning a filter, and the length of its beginning that is not evaluated. Lively spells are
/// rare: with 20 seconds, a filter tuned for 200 ms was worse at 200 ms on another motion than a filter tuned for 50
/// ms.
const TRAINING_S: u64 = 100;
const SETTLING_S: u64 = 1;

/// Greatest number of reports for tuning: all reports of a 120 Hz tracker in the training time. A faster tracker gets
/// less time.
const MOST_REPORTS: usize = 12_000;

/// Seed of the noise in training. If the evaluated run uses this seed, training uses the next seed.
const TRAINING_SEED: u64 = 0x7475_6e65;

/// Range of the decimal logarithm in the search for the white jerk, and the number of values in each round. A step of
/// the last round is 0.2 decades or less. This is 8 % of the filter's time constant, which varies with the sixth root
/// of the jerk.
const JERK_DECADES: (f64, f64) = (-6.0, 6.0);
const JERKS_A_ROUND: usize = 13;
const ROUNDS: usize = 2;

/// Greatest distance in reports between the points of a difference.
const LONGEST_BASELINE: u32 = 16;

/// The conditions under which a filter was tuned, and the remaining errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Training {
    /// Prediction interval, ps, from the instant at which a report was true.
    pub interval_ps: u64,
    /// True if another motion of the same kind was used, false if the motion itself was used.
    pub sibling: bool,
    /// Length of the training motion, seconds. At most the first second is not evaluated.
    pub seconds: f64,
    /// Number of reports whose predictions were evaluated.
    pub reports: u64,
    /// Seed of the tracker's noise, which always differs from the seed of the evaluated run.
    pub seed: u64,
    /// Remaining mean distance between prediction and truth, m.
    pub mean_m: f64,
    /// Remaining mean angle between prediction and truth, degrees.
    pub mean_deg: f64,
}

/// A tuned predictor, with the conditions of the tuning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuned {
    /// Settings of the predictor with the tuned numbers.
    pub config: PredictorConfig,
    /// Conditions of the tuning, or `None` if the predictor has nothing to tune or no report could be evaluated.
    pub training: Option<Training>,
}

/// Returns the seed of the training noise for a run whose noise has the seed `judged`. The two seeds always differ.
pub fn training_seed(judged: u64) -> u64 {
    if judged == TRAINING_SEED { TRAINING_SEED + 1 } else { TRAINING_SEED }
}

/// Finds the settings with the least mean error for predictions `interval_ps` after a tracker's reports of a motion.
///
/// For a Kalman filter the search covers the white jerk: 10^-6 to 10^6, in two rounds over a grid of its logarithm. For
/// a difference it covers the baseline, 1 to 16 reports. Position and orientation have separate values. The noise of
/// reports is the tracker's own. The initial speeds and accelerations of a Kalman filter are the root mean squares of
/// the motion.
///
/// Training uses 100 seconds of the motion's [`Motion::sibling`], or of the motion itself if it has no sibling. The
/// tracker has no bias, metal or faults, and its noise has another seed than `evaluated_seed`. The same (motion, tracker,
/// interval) gives the same result on every host.
///
/// # Errors
///
/// [`SettingError`] for `base` out of range.
pub fn tune<M: Motion + ?Sized>(
    motion: &M,
    tracker: &TrackerModel,
    interval_ps: u64,
    base: &PredictorConfig,
    evaluated_seed: u64,
) -> Result<Tuned, SettingError> {
    // Check the settings before the long search.
    base.build()?;
    let seed = training_seed(evaluated_seed);
    let tracker = TrackerModel::new(tracker.config().clone().without_systematic_errors())?;
    // Collect reports and true poses of another motion of the same kind, if there is one.
    let sibling = motion.sibling();
    let lesson = match &sibling {
        Some(sibling) => TrainingData::of(sibling.as_ref(), &tracker, interval_ps, seed),
        None => TrainingData::of(motion, &tracker, interval_ps, seed),
    };
    let Some(lesson) = lesson.filter(|_| base.kind != PredictorKind::None) else {
        return Ok(Tuned { config: *base, training: None });
    };
    // Search the parameter that this kind of predictor has.
    let (config, [mean_m, mean_deg]) = match base.kind {
        PredictorKind::Kalman => lesson.best_jerks(&lesson.with_start(*base))?,
        _ => lesson.best_baselines(base)?,
    };
    let reports = (lesson.reports.len() - lesson.settled) as u64;
    let seconds = lesson.seconds;
    let training = Training { interval_ps, sibling: sibling.is_some(), seconds, reports, seed, mean_m, mean_deg };
    Ok(Tuned { config, training: Some(training) })
}

/// The training data: reports, and the true pose to predict from each report.
struct TrainingData {
    reports: Vec<TrackerReport>,
    truths: Vec<Pose>,
    /// Number of reports at the start whose predictions are not evaluated.
    settled: usize,
    seconds: f64,
    /// Prediction interval, ps, after the instant of a report.
    interval_ps: u64,
    /// Root mean squares for each axis: speed, acceleration, angular velocity, angular acceleration.
    rates: [f64; 4],
}

impl TrainingData {
    /// Collects the training data of a motion behind a tracker, or returns `None` if no report can be evaluated.
    fn of<M: Motion + ?Sized>(motion: &M, tracker: &TrackerModel, interval_ps: u64, seed: u64) -> Option<Self> {
        // A head that stands still at its end teaches the filter nothing.
        let until_ps = motion.moves_until_ps().unwrap_or(u64::MAX).min(TRAINING_S * PS_PER_S);
        let settling_ps = (SETTLING_S * PS_PER_S).min(until_ps / 2);
        let in_time = |report: &TrackerReport| report.measured_ps.saturating_add(interval_ps) <= until_ps;
        let reports: Vec<TrackerReport> =
            tracker.reports(motion, seed).take_while(in_time).take(MOST_REPORTS).collect();
        let settled = reports.partition_point(|report| report.measured_ps < settling_ps);
        let last = reports.get(settled..)?.last()?;
        let seconds = crate::time::seconds(last.measured_ps.saturating_add(interval_ps));
        let truths = reports.iter().map(|report| motion.pose(report.measured_ps + interval_ps)).collect();
        let rates = rates(motion, &reports);
        Some(Self { truths, settled, seconds, interval_ps, rates, reports })
    }

    /// Returns the settings with initial deviations that match the motion.
    fn with_start(&self, base: PredictorConfig) -> PredictorConfig {
        let [speed, acceleration, turn, turn_acceleration] = self.rates;
        let start = Start {
            speed: within("start_speed", speed),
            acceleration: within("start_acceleration", acceleration),
            turn: within("start_turn", turn),
            turn_acceleration: within("start_turn_acceleration", turn_acceleration),
        };
        PredictorConfig { start, ..base }
    }

    /// Returns the mean errors of a predictor in metres and degrees.
    fn errors(&self, config: &PredictorConfig) -> Result<[f64; 2], SettingError> {
        let mut predictor = config.build()?;
        let mut sums = [0.0; 2];
        for (i, (report, truth)) in self.reports.iter().zip(&self.truths).enumerate() {
            // The filter sees every report, but its first predictions are not evaluated.
            predictor.observe(report);
            if i >= self.settled {
                let predicted = predictor.predict(report.measured_ps + self.interval_ps);
                sums[0] += predicted.distance_m(truth);
                sums[1] += predicted.angle_deg(truth);
            }
        }
        Ok(sums.map(|sum| sum / (self.reports.len() - self.settled) as f64))
    }

    /// Returns the settings with the best white jerks, and their errors in metres and degrees.
    fn best_jerks(&self, base: &PredictorConfig) -> Result<(PredictorConfig, [f64; 2]), SettingError> {
        let mut spans = [JERK_DECADES; 2];
        let mut best = [(f64::INFINITY, 0.0); 2];
        for _ in 0..ROUNDS {
            // Both channels try one value each in the same run, because position and orientation are filtered
            // separately.
            let steps = spans.map(|(low, high)| (high - low) / (JERKS_A_ROUND - 1) as f64);
            for i in 0..JERKS_A_ROUND {
                let tried: [f64; 2] = core::array::from_fn(|channel| spans[channel].0 + steps[channel] * i as f64);
                let [position_jerk, orientation_jerk] = tried.map(jerk);
                let errors = self.errors(&PredictorConfig { position_jerk, orientation_jerk, ..*base })?;
                better(&mut best, errors, tried);
            }
            // Narrow the next round to one step on each side of the best value.
            let about = |channel: usize| (best[channel].1 - steps[channel], best[channel].1 + steps[channel]);
            let clamped = |(low, high): (f64, f64)| (low.max(JERK_DECADES.0), high.min(JERK_DECADES.1));
            spans = [0, 1].map(|channel| clamped(about(channel)));
        }
        let [position_jerk, orientation_jerk] = best.map(|(_, decades)| jerk(decades));
        Ok((PredictorConfig { position_jerk, orientation_jerk, ..*base }, best.map(|(error, _)| error)))
    }

    /// Returns the settings with the best baselines, and their errors in metres and degrees.
    fn best_baselines(&self, base: &PredictorConfig) -> Result<(PredictorConfig, [f64; 2]), SettingError> {
        let mut best = [(f64::INFINITY, 1.0); 2];
        for baseline in 1..=LONGEST_BASELINE {
            let tried = PredictorConfig { position_baseline: baseline, orientation_baseline: baseline, ..*base };
            better(&mut best, self.errors(&tried)?, [f64::from(baseline); 2]);
        }
        let [position_baseline, orientation_baseline] = best.map(|(_, baseline)| baseline as u32);
        Ok((PredictorConfig { position_baseline, orientation_baseline, ..*base }, best.map(|(error, _)| error)))
    }
}

/// Keeps, for each channel, the first value with the least error.
fn better(best: &mut [(f64, f64); 2], errors: [f64; 2], tried: [f64; 2]) {
    for (best, found) in best.iter_mut().zip(errors.into_iter().zip(tried)) {
        if found.0 < best.0 {
            *best = found;
        }
    }
}

/// Returns the white jerk for a decimal logarithm. The jerks of both filters have the same limits.
fn jerk(decades: f64) -> f64 {
    within("position_jerk", libm::pow(10.0, decades))
}

/// Clamps a number to the limits of the filter's parameter table.
fn within(name: &str, value: f64) -> f64 {
    let limits = Filter::INFOS.iter().find(|info| info.name == name).map(|info| info.limits);
    limits.map_or(value, |(low, high)| value.clamp(low.real(), high.real()))
}

/// Returns root mean squares at the reports, for one of three axes: speed, acceleration, angular velocity, angular
/// acceleration.
fn rates<M: Motion + ?Sized>(motion: &M, reports: &[TrackerReport]) -> [f64; 4] {
    let at =
        |report: &TrackerReport| (motion.velocity(report.measured_ps), motion.angular_velocity(report.measured_ps));
    let mut squares = [0.0; 4];
    for pair in reports.windows(2) {
        // Accelerations are differences of the velocities at successive reports.
        let dt_s = span_s(pair[0].measured_ps, pair[1].measured_ps);
        let before = at(&pair[0]);
        let after = at(&pair[1]);
        let four: [DVec3; 4] = [after.0, (after.0 - before.0) / dt_s, after.1, (after.1 - before.1) / dt_s];
        squares.iter_mut().zip(four).for_each(|(sum, rate)| *sum += rate.length_squared());
    }
    let n = 3.0 * reports.len().saturating_sub(1).max(1) as f64;
    squares.map(|sum| (sum / n).sqrt())
}
