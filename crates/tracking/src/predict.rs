//! Prediction of the head's pose at an exact future instant.

mod channel;
mod checked;
mod config;
mod evaluate;
mod exact;
mod extrapolation;
mod gate;
mod orientation_kalman;
mod position_kalman;
mod predicting;
mod propagation;
mod tune;

pub use config::{PredictorConfig, PredictorKind, Start};
pub use evaluate::{PredictionDeviation, prediction_errors};
pub use exact::ExactPredictor;
pub use gate::ReportCounts;
pub use propagation::Decay;
pub use tune::{Training, Tuned, training_seed, tune};

use crate::pose::Pose;
use crate::tracker::TrackerReport;

/// A method that computes the head's pose at any instant from past tracker reports.
pub trait Predictor: Send {
    /// Adds a report, in order of arrival. An impossible report is rejected and counted, but causes no error.
    fn observe(&mut self, report: &TrackerReport);

    /// Returns the predicted pose at the instant `at_ps`, in picoseconds. Before the first accepted report the result is
    /// [`Pose::IDENTITY`].
    ///
    /// A predictor of [`PredictorConfig`] extrapolates by at most [`PredictorConfig::horizon_ps`] picoseconds, forwards
    /// or backwards in time (500 ms by default, the limit included). The extrapolation begins at the measurement in the
    /// newest accepted report. If `at_ps` is later or earlier than this limit, the result is the predictor's estimate
    /// for the instant of the measurement. Without a filter, the estimate is the reported pose. Position and
    /// orientation have separate instants of measurement, and the limit applies to each of the two.
    ///
    /// [`ExactPredictor`] has no limit.
    fn predict(&self, at_ps: u64) -> Pose;

    /// Returns the counts of accepted and rejected reports so far.
    fn counts(&self) -> ReportCounts;
}

#[cfg(test)]
mod tests;
