use glam::DVec3;
use pxpl5_sim::parameters::SettingError;
use serde::Serialize;

use super::{PredictorConfig, PredictorKind, Start};
use crate::config::Filter;
use crate::motion::Motion;
use crate::pose::Pose;
use crate::time::{PS_PER_S, span_s};
use crate::tracker::{TrackerModel, TrackerReport};

/// Length in seconds of the motion on which a filter is tuned. The motion must be long, because periods of fast motion
/// are rare. In a test with only 20 seconds, the filter tuned for predictions of 200 ms was worse than the filter tuned
/// for 50 ms. The test used a motion on which no filter was tuned.
const TRAINING_S: u64 = 100;
/// Time at the start of the training motion for which predictions are not evaluated, seconds.
const SETTLING_S: u64 = 1;

/// Greatest number of reports on which a filter is tuned. A 120 Hz tracker sends this number in `TRAINING_S` seconds. A
/// tracker with a higher rate reaches the limit in less time.
const MAX_REPORTS: usize = 12_000;

/// Seed of the tracker's noise when a filter is tuned. If the noise of the evaluated run has the same seed, the tuning
/// uses the next seed.
const TRAINING_SEED: u64 = 0x7475_6e65;

/// Range of the decimal logarithm of the jerk's strength that the search covers.
const JERK_DECADES: (f64, f64) = (-6.0, 6.0);
/// Number of values that each round of the search tries. In the last round, two neighbouring values differ by a factor
/// of 10^0.2 or less. The time constant of a filter varies with the sixth root of the jerk, so this factor changes the
/// time constant by only 8 %.
const JERKS_A_ROUND: usize = 13;
/// Number of rounds of the search. The second round covers only the neighbourhood of the best value of the first round.
const ROUNDS: usize = 2;

/// Greatest baseline, the number of reports between the two poses whose difference gives a velocity.
const LONGEST_BASELINE: u32 = 16;

/// Conditions of the tuning of a prediction filter, and the errors that remained.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Training {
    /// Prediction interval of the tuning, ps: from the instant at which a reported pose was true to the predicted
    /// instant.
    pub interval_ps: u64,
    /// True if the filter was tuned on another random motion of the same kind, false if the filter was tuned on the
    /// evaluated motion.
    pub sibling: bool,
    /// Length of the motion on which the filter was tuned, seconds. Up to one second at its start is not evaluated.
    pub seconds: f64,
    /// Number of evaluated predictions, one from each report.
    pub reports: u64,
    /// Seed of the tracker's noise during the tuning. This seed always differs from the seed of the noise in the
    /// evaluated run.
    pub seed: u64,
    /// Mean distance between predicted and true position after the tuning, m.
    pub mean_m: f64,
    /// Mean angle between predicted and true orientation after the tuning, degrees.
    pub mean_deg: f64,
}

/// A tuned predictor, with the conditions of the tuning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuned {
    /// Settings of the predictor, which include the tuned parameters.
    pub config: PredictorConfig,
    /// Conditions of the tuning, or `None` if the predictor has nothing to tune or no report could be evaluated.
    pub training: Option<Training>,
}

/// Returns a seed for the tracker's noise during the tuning. The result always differs from `evaluated_seed`, the seed
/// of the noise in the evaluated run.
pub fn training_seed(evaluated_seed: u64) -> u64 {
    if evaluated_seed == TRAINING_SEED { TRAINING_SEED + 1 } else { TRAINING_SEED }
}

/// Finds the predictor settings with the least mean error on a motion. The predicted instant is `interval_ps` after the
/// instant at which the reported pose was true.
///
/// For a Kalman filter, the search covers the assumed strength of the head's jerk, from 10^-6 to 10^6. The search has
/// two rounds over a grid of the logarithm of this strength. For a prediction by differences, the search covers the
/// baseline, which is the distance (1 to 16 reports) between the two poses of a difference. Position and orientation
/// have separate values. The predictor assumes the noise that the tracker model adds. The assumed speeds and
/// accelerations before the first report are the root mean squares of the motion.
///
/// The tuning uses 100 seconds of the motion's [`Motion::sibling`], or of the motion itself if it has no sibling. The
/// tracker has no bias, metal or faults, and the seed of its noise differs from `evaluated_seed`. The same (motion,
/// tracker, interval) gives the same result on every computer.
///
/// # Errors
///
/// Returns [`SettingError`] for `base` out of range.
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

struct TrainingData {
    reports: Vec<TrackerReport>,
    truths: Vec<Pose>,
    /// Number of reports that the filter receives before the first evaluated prediction.
    settled: usize,
    seconds: f64,
    interval_ps: u64,
    /// Root mean squares of speed, acceleration, angular velocity and angular acceleration along each axis.
    rates: [f64; 4],
}

impl TrainingData {
    fn of<M: Motion + ?Sized>(motion: &M, tracker: &TrackerModel, interval_ps: u64, seed: u64) -> Option<Self> {
        // The part of a motion in which the head stands still at the end does not help to tune a filter.
        let until_ps = motion.moves_until_ps().unwrap_or(u64::MAX).min(TRAINING_S * PS_PER_S);
        let settling_ps = (SETTLING_S * PS_PER_S).min(until_ps / 2);
        let in_time = |report: &TrackerReport| report.measured_ps.saturating_add(interval_ps) <= until_ps;
        let reports: Vec<TrackerReport> = tracker.reports(motion, seed).take_while(in_time).take(MAX_REPORTS).collect();
        let settled = reports.partition_point(|report| report.measured_ps < settling_ps);
        let last = reports.get(settled..)?.last()?;
        let seconds = crate::time::seconds(last.measured_ps.saturating_add(interval_ps));
        let truths = reports.iter().map(|report| motion.pose(report.measured_ps + interval_ps)).collect();
        let rates = rates(motion, &reports);
        Some(Self { truths, settled, seconds, interval_ps, rates, reports })
    }

    /// Returns the settings with the motion's root mean squares as the assumed speeds and accelerations before the
    /// first report.
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

    /// Returns the settings with the strengths of jerk that give the least errors, and the mean errors in metres and
    /// degrees.
    fn best_jerks(&self, base: &PredictorConfig) -> Result<(PredictorConfig, [f64; 2]), SettingError> {
        let mut spans = [JERK_DECADES; 2];
        let mut best = [(f64::INFINITY, 0.0); 2];
        for _ in 0..ROUNDS {
            // One run tries one value for position and one for orientation, because the two are filtered separately.
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

    /// Returns the settings with the baselines that give the least errors, and the mean errors in metres and degrees. A
    /// baseline is the number of reports between the two poses of a difference.
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

/// Stores a tried value as the best value if its error is smaller than the best error, separately for position and
/// orientation. If the errors are equal, the earlier value stays.
fn better(best: &mut [(f64, f64); 2], errors: [f64; 2], tried: [f64; 2]) {
    for (best, found) in best.iter_mut().zip(errors.into_iter().zip(tried)) {
        if found.0 < best.0 {
            *best = found;
        }
    }
}

/// Returns the strength of jerk with the decimal logarithm `decades`, limited to the range that the filters of position
/// and orientation both allow.
fn jerk(decades: f64) -> f64 {
    within("position_jerk", libm::pow(10.0, decades))
}

fn within(name: &str, value: f64) -> f64 {
    let limits = Filter::INFOS.iter().find(|info| info.name == name).map(|info| info.limits);
    limits.map_or(value, |(low, high)| value.clamp(low.real(), high.real()))
}

/// Returns the root mean squares along each axis of speed, acceleration, angular velocity and angular acceleration,
/// computed at the reports.
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
