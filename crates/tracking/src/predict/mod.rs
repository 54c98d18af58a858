//! Where the head will be: predictors that are told the exact time to predict for.

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
pub use evaluate::{PredictionError, prediction_errors};
pub use exact::ExactPredictor;
pub use gate::ReportCounts;
pub use tune::{Training, Tuned, training_seed, tune};

use crate::pose::Pose;
use crate::tracker::TrackerReport;

/// Something that turns late reports into a pose at a wanted instant.
pub trait Predictor: Send {
    /// Takes a report in order of arrival. Reports that cannot be true are rejected and counted, never an error.
    fn observe(&mut self, report: &TrackerReport);

    /// The pose at `at_ps`. Before the first accepted report it is [`Pose::IDENTITY`]; farther from the last report
    /// than the horizon of the configuration it is the last pose, as when the tracker has fallen silent.
    fn predict(&self, at_ps: u64) -> Pose;

    /// What became of the reports so far.
    fn counts(&self) -> ReportCounts;
}
