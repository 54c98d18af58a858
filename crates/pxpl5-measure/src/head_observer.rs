//! Streaming observer of the results that concern the head.

use crate::budget::{Budget, BudgetSum};
use crate::error_observer::ErrorSum;
use crate::errors::PixelErrors;
use crate::eye_report::EyeReport;
use crate::percentiles::Percentiles;
use crate::step_observer::{StepSum, Steps};
use crate::turn_observer::{RotationLatencySum, Turns};
use pxpl5_run::{FinalResults, StreamingObserver};
use std::any::Any;

/// A streaming observer for runs that keep only statistics.
///
/// The observer collects the latency from the head's pose until pixels are lit, rotation latencies of address
/// recalculation displays, and errors in pixels. A run uses the observer after
/// `experiment.keep(KeptRecords::Statistics).observed_by(Some(HeadSum::begin))`.
#[derive(Debug, Default)]
pub struct HeadSum {
    budget: BudgetSum,
    turns: RotationLatencySum,
    steps: StepSum,
    errors: ErrorSum,
}

impl HeadSum {
    /// Creates the streaming observer. This function is the argument of
    /// [`Experiment::observed_by`](pxpl5_run::Experiment::observed_by).
    pub fn begin() -> Box<dyn StreamingObserver> {
        Box::<Self>::default()
    }
}

impl StreamingObserver for HeadSum {
    fn take(&mut self, results: &FinalResults<'_>) {
        self.budget.take(results);
        self.turns.take(results);
        self.steps.take(results);
        self.errors.take(results);
    }

    fn result(self: Box<Self>) -> Box<dyn Any + Send + Sync> {
        let Self { budget, turns, steps, errors } = *self;
        let (turns, steps) = (turns.result(), steps.result());
        let (error, eye) = errors.result();
        let percentiles = budget.percentiles();
        Box::new(HeadResults { end_to_end: budget.result(), percentiles, turns, steps, error, eye })
    }
}

#[derive(Clone, Debug)]
pub(crate) struct HeadResults {
    pub(crate) end_to_end: Budget,
    pub(crate) percentiles: [Percentiles; 2],
    pub(crate) turns: Turns,
    pub(crate) steps: Vec<Steps>,
    pub(crate) error: PixelErrors,
    pub(crate) eye: Option<EyeReport>,
}
