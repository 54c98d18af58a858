//! Prediction of the head's pose at an exact future instant.

mod channel;
mod config;
mod evaluate;
mod exact;
mod extrapolation;
pub mod gain;
mod gate;
mod orientation_kalman;
mod position_kalman;
mod predicting;
mod tune;

pub use config::{PredictorConfig, PredictorKind, Start};
pub use evaluate::{PredictionDeviation, prediction_errors};
pub use exact::ExactPredictor;
pub use gate::ReportCounts;
pub use tune::{Training, Tuned, training_seed, tune};

use crate::pose::Pose;
use crate::tracker::TrackerReport;

/// A method that computes the head's pose at any instant from past tracker reports.
pub trait Predictor: Send {
    /// Adds a report, in order of arrival. An impossible report is rejected and counted, but causes no error.
    fn observe(&mut self, report: &TrackerReport);

    /// Returns the predicted pose at `at_ps`. Before the first accepted report the result is [`Pose::IDENTITY`]. The
    /// settings limit how far a predictor extrapolates beyond the last report. If `at_ps` is later than this limit, the
    /// result is the last reported pose.
    fn predict(&self, at_ps: u64) -> Pose;

    /// Returns the counts of accepted and rejected reports so far.
    fn counts(&self) -> ReportCounts;
}
