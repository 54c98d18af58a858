//! What a report says of a head, summed up while a run goes on.

use crate::budget::{Budget, BudgetSum};
use crate::error_sum::ErrorSum;
use crate::errors::PixelErrors;
use crate::turn_sum::{TurnSum, Turns};
use pxpl5_run::{Outcome, Settled, Summing};
use std::any::Any;

/// From the head to light, turns of a display with faces, and errors in pixels, for a run that keeps statistics only:
/// `experiment.keep(Keep::Statistics).summed_by(Some(HeadSum::begin))`.
#[derive(Debug, Default)]
pub struct HeadSum {
    budget: BudgetSum,
    turns: TurnSum,
    errors: ErrorSum,
}

impl HeadSum {
    /// Begins, for [`Experiment::summed_by`](pxpl5_run::Experiment::summed_by).
    #[must_use]
    pub fn begin() -> Box<dyn Summing> {
        Box::<Self>::default()
    }
}

impl Summing for HeadSum {
    fn take(&mut self, settled: &Settled<'_>) {
        self.budget.take(settled);
        self.turns.take(settled);
        self.errors.take(settled);
    }

    fn said(self: Box<Self>) -> Box<dyn Any + Send + Sync> {
        let Self { budget, turns, errors } = *self;
        Box::new(HeadSaid { end_to_end: budget.said(), turns: turns.said(), error: errors.said() })
    }
}

/// What came of it.
#[derive(Clone, Debug)]
pub(crate) struct HeadSaid {
    pub(crate) end_to_end: Budget,
    pub(crate) turns: Turns,
    pub(crate) error: PixelErrors,
}

impl HeadSaid {
    /// Of a run that was summed up while it went on.
    pub(crate) fn while_it_ran(outcome: &Outcome) -> Option<&Self> {
        outcome.said()
    }
}

/// What is missing where a run with a head gave up its records and nobody summed them up: a sentence.
pub(crate) fn untold(outcome: &Outcome) -> Option<String> {
    let is_untold = outcome.head().is_some() && outcome.has_forgotten() && HeadSaid::while_it_ran(outcome).is_none();
    is_untold.then(|| UNTOLD.to_owned())
}

const UNTOLD: &str = "what is said from the head to light, of its turns and of errors in pixels is of the last pictures alone: the run gave up \
    its records, and nobody summed them up before (Experiment::summed_by, or Keep::Everything)";
