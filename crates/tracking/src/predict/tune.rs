use glam::DVec3;
use pxpl5_sim::parameters::SettingError;
use serde::Serialize;

use super::{Decay, PredictorConfig, PredictorKind, Start};
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

/// Longest memory of a tuned Kalman filter, seconds. On a motion without any jerk, such as a steady turn, the best memory
/// has no end. A filter with such a memory would take seconds to notice that the motion has changed.
const LONGEST_MEMORY_S: f64 = 1.0;
/// Shortest memory, relative to the time between two reports. With it a filter follows every report.
const SHORTEST_MEMORY: f64 = 0.25;
/// Rates of decay that the search tries, relative to the inverse of the prediction interval. 0 lets nothing decay, and
/// the last rate makes a velocity or an acceleration vanish at once.
const DECAYS: [f64; 9] = [0.0, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 32.0];
/// Combinations of the decay of velocity and acceleration for which the search tries every memory: constant
/// acceleration, constant velocity, decay of both, and decay of a velocity.
const FIRST_DECAYS: [(f64, f64); 4] = [(0.0, 0.0), (0.0, 32.0), (1.0, 4.0), (1.0, 32.0)];

/// Greatest rate of decay that a setting may have, 1/s.
const LARGEST_RATE: f64 = 1_000.0;
/// Least time between two reports for which memories are chosen, seconds: the fastest tracker sends 10,000 per second.
const SHORTEST_REPORT_S: f64 = 1e-4;

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
    /// The same mean angle if the pose of the last report stands for the prediction, degrees.
    pub none_deg: f64,
    /// The same mean angle if a constant velocity is extrapolated, measured over the best number of reports, degrees.
    pub velocity_deg: f64,
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
/// For a Kalman filter, the search covers its memory and the [`Decay`] of velocity and acceleration. The memory is the time
/// from which a filter takes its estimate: about 1 s at most, and at least a quarter of the time between two reports. It
/// gives the strength of the jerk. No prediction and constant velocity are limits of the decays, so the tuned filter is
/// not worse than either on the motion of the tuning.
///
/// For a prediction by differences, the search covers the baseline, which is the distance (1 to 16 reports) between the
/// two poses of a difference. Position and orientation have separate values. The predictor assumes the noise that the
/// tracker model adds. The assumed speeds and accelerations before the first report are the root mean squares of the
/// motion.
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
        PredictorKind::Kalman => lesson.best_checked(&lesson.with_start(*base))?,
        _ => lesson.best_baselines(base)?,
    };
    let reports = (lesson.reports.len() - lesson.settled) as u64;
    let seconds = lesson.seconds;
    let [_, none_deg] = lesson.errors(&PredictorConfig { kind: PredictorKind::None, ..*base })?;
    let velocity = PredictorConfig { kind: PredictorKind::ConstantVelocity, ..*base };
    let (_, [_, velocity_deg]) = lesson.best_baselines(&velocity)?;
    let sibling = sibling.is_some();
    let training = Training { interval_ps, sibling, seconds, reports, seed, mean_m, mean_deg, none_deg, velocity_deg };
    Ok(Tuned { config, training: Some(training) })
}

/// The properties of one Kalman filter that the search covers. Decays are relative to 1/(prediction interval).
#[derive(Clone, Copy, Debug, Default)]
struct Shape {
    memory_s: f64,
    velocity: f64,
    acceleration: f64,
}

struct TrainingData {
    reports: Vec<TrackerReport>,
    truths: Vec<Pose>,
    /// Number of reports that the filter receives before the first evaluated prediction.
    settled: usize,
    seconds: f64,
    interval_ps: u64,
    /// Mean time between two reports, seconds.
    report_s: f64,
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
        let report_s = span_s(reports[0].measured_ps, last.measured_ps) / (reports.len() - 1).max(1) as f64;
        Some(Self { truths, settled, seconds, interval_ps, report_s: report_s.max(SHORTEST_REPORT_S), rates, reports })
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

    /// Returns the mean errors in metres and degrees. For a Kalman filter alone, the fourth power of the way that the head
    /// makes during the interval weights each error.
    fn errors(&self, config: &PredictorConfig) -> Result<[f64; 2], SettingError> {
        let mut predictor = config.build()?;
        let mut sums = [0.0; 2];
        let mut weights = [0.0; 2];
        let is_weighted = config.kind == PredictorKind::Kalman && config.check_ps == [0; 2];
        for (i, (report, truth)) in self.reports.iter().zip(&self.truths).enumerate() {
            // The filter sees every report, but its first predictions are not evaluated.
            predictor.observe(report);
            if i >= self.settled {
                let predicted = predictor.predict(report.measured_ps + self.interval_ps);
                // A filter is for motion, because a still head is left to the last report ([`Checked`](super::checked)).
                // So the parts count most in which the head moves farthest.
                let way = [report.pose.distance_m(truth), report.pose.angle_deg(truth)];
                let weight = way.map(|way| if is_weighted { way * way * way * way } else { 1.0 });
                let found = [predicted.distance_m(truth), predicted.angle_deg(truth)];
                for channel in [0, 1] {
                    weights[channel] += weight[channel];
                    sums[channel] += found[channel] * weight[channel];
                }
            }
        }
        Ok([0, 1].map(|channel| sums[channel] / weights[channel]))
    }

    /// Returns the Kalman filters with the least errors, checked at the prediction interval against the last report and
    /// against the velocity with the least errors. Also returns the mean errors in metres and degrees.
    fn best_checked(&self, base: &PredictorConfig) -> Result<(PredictorConfig, [f64; 2]), SettingError> {
        let velocity = PredictorConfig { kind: PredictorKind::ConstantVelocity, ..*base };
        let PredictorConfig { position_baseline, orientation_baseline, .. } = self.best_baselines(&velocity)?.0;
        let filter = self.best_filter(&PredictorConfig { check_ps: [0; 2], ..*base })?.0;
        let checked =
            PredictorConfig { position_baseline, orientation_baseline, check_ps: [self.interval_ps; 2], ..filter };
        Ok((checked, self.errors(&checked)?))
    }

    /// Returns the settings of the Kalman filters with the least errors, and the mean errors in metres and degrees.
    ///
    /// One run tries one filter for position and one for orientation, because the two are filtered separately.
    fn best_filter(&self, base: &PredictorConfig) -> Result<(PredictorConfig, [f64; 2]), SettingError> {
        let mut best = [(f64::INFINITY, Shape::default()); 2];
        let try_each = |tried: [Shape; 2], best: &mut [(f64, Shape); 2]| {
            better(best, self.errors(&self.shaped(base, tried))?, tried);
            Ok::<_, SettingError>(())
        };
        // First every memory with a few decays, then every decay with the best memory, then memories between the first.
        let shortest = SHORTEST_MEMORY * self.report_s;
        let memories = core::iter::successors(Some(LONGEST_MEMORY_S), |memory| Some(memory / 2.0));
        for memory_s in memories.take_while(|memory| *memory > shortest) {
            for (velocity, acceleration) in FIRST_DECAYS {
                try_each([Shape { memory_s, velocity, acceleration }; 2], &mut best)?;
            }
        }
        for factor in [core::f64::consts::SQRT_2, 1.2] {
            for acceleration in DECAYS {
                try_each(best.map(|(_, shape)| Shape { acceleration, ..shape }), &mut best)?;
            }
            for velocity in DECAYS {
                try_each(best.map(|(_, shape)| Shape { velocity, ..shape }), &mut best)?;
            }
            let about = best.map(|(_, shape)| shape);
            for factor in [factor, 1.0 / factor] {
                let longer =
                    |shape: Shape| Shape { memory_s: (shape.memory_s * factor).min(LONGEST_MEMORY_S), ..shape };
                try_each(about.map(longer), &mut best)?;
            }
        }
        Ok((self.shaped(base, best.map(|(_, shape)| shape)), best.map(|(error, _)| error)))
    }

    /// Returns the settings with the memory and the decays in `shapes`, for position and orientation.
    ///
    /// A filter ignores noise at angular frequencies above 1/memory. There the spectral density of the motion equals
    /// that of the reports' noise. The density of the motion is that of the jerk divided by w^2 (w^2 + b^2) (w^2 +
    /// c^2), with the rates of decay b and c.
    fn shaped(&self, base: &PredictorConfig, shapes: [Shape; 2]) -> PredictorConfig {
        let interval_s = crate::time::seconds(self.interval_ps).max(self.report_s);
        let rate = |relative: f64| (relative / interval_s).min(LARGEST_RATE);
        let decays =
            shapes.map(|shape| Decay { velocity: rate(shape.velocity), acceleration: rate(shape.acceleration) });
        let jerk = |name: &str, noise: f64, channel: usize| {
            let edge = 1.0 / shapes[channel].memory_s;
            let Decay { velocity: b, acceleration: c } = decays[channel];
            within(name, noise * (self.report_s * (edge * edge + b * b) * (edge * edge + c * c)).sqrt() * edge)
        };
        let [position_decay, orientation_decay] = decays;
        PredictorConfig {
            position_jerk: jerk("position_jerk", base.position_noise_m, 0),
            orientation_jerk: jerk("orientation_jerk", base.orientation_noise_deg.to_radians(), 1),
            position_decay,
            orientation_decay,
            ..*base
        }
    }

    /// Returns the settings with the baselines that give the least errors, and the mean errors in metres and degrees. A
    /// baseline is the number of reports between the two poses whose difference gives a velocity.
    fn best_baselines(&self, base: &PredictorConfig) -> Result<(PredictorConfig, [f64; 2]), SettingError> {
        let mut best = [(f64::INFINITY, 1); 2];
        for baseline in 1..=LONGEST_BASELINE {
            let tried = PredictorConfig { position_baseline: baseline, orientation_baseline: baseline, ..*base };
            better(&mut best, self.errors(&tried)?, [baseline; 2]);
        }
        let [position_baseline, orientation_baseline] = best.map(|(_, baseline)| baseline);
        Ok((PredictorConfig { position_baseline, orientation_baseline, ..*base }, best.map(|(error, _)| error)))
    }
}

/// Stores a tried value as the best value if its error is smaller than the best error, separately for position and
/// orientation. If the errors are equal, the earlier value stays.
fn better<T>(best: &mut [(f64, T); 2], errors: [f64; 2], tried: [T; 2]) {
    for (best, found) in best.iter_mut().zip(errors.into_iter().zip(tried)) {
        if found.0 < best.0 {
            *best = found;
        }
    }
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
