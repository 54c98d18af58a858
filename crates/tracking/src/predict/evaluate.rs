use super::{Predictor, PredictorConfig};
use crate::motion::Motion;
use crate::pose::Pose;
use crate::tracker::TrackerModel;
use pxpl5_sim::parameters::SettingError;

/// Differences between predicted poses and the true poses of a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PredictionDeviation {
    /// Number of evaluated predictions.
    pub n: u64,
    /// Mean distance between predicted and true position, m.
    pub mean_m: f64,
    /// Greatest distance between predicted and true position, m.
    pub max_m: f64,
    /// Mean angle between predicted and true orientation, degrees.
    pub mean_deg: f64,
    /// Greatest angle between predicted and true orientation, degrees.
    pub max_deg: f64,
}

impl PredictionDeviation {
    fn add(&mut self, predicted: &Pose, truth: &Pose) {
        let metres = predicted.distance_m(truth);
        let degrees = predicted.angle_deg(truth);
        self.n += 1;
        self.mean_m += (metres - self.mean_m) / self.n as f64;
        self.mean_deg += (degrees - self.mean_deg) / self.n as f64;
        self.max_m = self.max_m.max(metres);
        self.max_deg = self.max_deg.max(degrees);
    }
}

/// Computes the errors of a predictor for each prediction interval in `horizons_ps`. An interval begins when the
/// orientation of the last report was measured. Only reports whose orientation was measured at or after `from_ps` and
/// before `until_ps` are evaluated.
///
/// # Errors
///
/// Returns [`SettingError`] if a setting of `config` is out of range.
pub fn prediction_errors<M: Motion + ?Sized>(
    motion: &M,
    tracker: &TrackerModel,
    config: &PredictorConfig,
    seed: u64,
    horizons_ps: &[u64],
    (from_ps, until_ps): (u64, u64),
) -> Result<Vec<PredictionDeviation>, SettingError> {
    let mut predictor: Box<dyn Predictor> = config.build()?;
    let mut errors = vec![PredictionDeviation::default(); horizons_ps.len()];
    // Reports before `from_ps` only warm up the filter.
    for report in tracker.reports(motion, seed).take_while(|r| r.measured_ps < until_ps) {
        predictor.observe(&report);
        if report.measured_ps < from_ps {
            continue;
        }
        for (error, horizon_ps) in errors.iter_mut().zip(horizons_ps) {
            let at_ps = report.measured_ps.saturating_add(*horizon_ps);
            error.add(&predictor.predict(at_ps), &motion.pose(at_ps));
        }
    }
    Ok(errors)
}
