//! What is said of the head of a run: as it was summed up while it went on, or else of what is kept now that it is over.

use crate::budget::{Budget, BudgetSum, of_pictures, poses};
use crate::error_sum::ErrorSum;
use crate::errors::{PixelErrors, Showing};
use crate::head_sum::HeadSaid;
use crate::step_sum::{StepSum, Steps};
use crate::turn_sum::{TurnSum, Turns};
use pxpl5_run::{Cause, Outcome};

impl HeadSaid {
    /// Of a run that was summed up while it went on.
    fn while_it_ran(outcome: &Outcome) -> Option<&Self> {
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

impl PixelErrors {
    /// Of a run with a head, its pictures as they were drawn; empty without one.
    #[must_use]
    pub fn of(outcome: &Outcome) -> Self {
        Self::shown(outcome, Showing::Plain)
    }

    /// The same with its pictures shown so. Of a run that gave up its records ([`Outcome::has_forgotten`]) it is of all periods only as its
    /// head shows pictures, and only where [`HeadSum`](crate::HeadSum) summed it up; else of the last ones.
    #[must_use]
    pub fn shown(outcome: &Outcome, showing: Showing) -> Self {
        let Some(head) = outcome.head() else { return Self::default() };
        let said = HeadSaid::while_it_ran(outcome).filter(|_| showing == head.head().raster().into());
        said.map_or_else(|| Self::judged(outcome, showing, None), |said| said.error.clone())
    }

    /// The same without one cause of error: with the reports and poses that the run would have had, its times being as they are. Of a run
    /// that gave up its records it is of the last periods alone.
    #[must_use]
    pub fn without(outcome: &Outcome, showing: Showing, cause: Cause) -> Self {
        Self::judged(outcome, showing, Some(cause))
    }

    fn judged(outcome: &Outcome, showing: Showing, without: Option<Cause>) -> Self {
        let mut sum = ErrorSum::of(showing, without);
        sum.take(&outcome.settled());
        sum.said()
    }
}

/// Pixel errors on the raster before the eyes; `None` of a run without a head.
#[must_use]
pub fn pixel_errors(outcome: &Outcome) -> Option<PixelErrors> {
    Some(PixelErrors::shown(outcome, outcome.head()?.head().raster().into()))
}

impl Budget {
    /// Of the complete pictures in the window whose pose was measured.
    #[must_use]
    pub fn of(outcome: &Outcome) -> Self {
        if let Some(said) = HeadSaid::while_it_ran(outcome) {
            return said.end_to_end;
        }
        let mut sum = BudgetSum::default();
        sum.take(&outcome.settled());
        sum.said()
    }

    /// From the pose to the light of each picture's middle, milliseconds, in order; of pictures that are kept.
    #[must_use]
    pub fn totals_ms(outcome: &Outcome) -> Vec<f64> {
        let run = outcome.settled();
        let stages = of_pictures(&run, &poses(&run), run.steady_pictures());
        stages.iter().map(|stages| stages.iter().sum()).collect()
    }
}

impl Turns {
    /// Of a run.
    pub(crate) fn of(outcome: &Outcome) -> Self {
        if let Some(said) = HeadSaid::while_it_ran(outcome) {
            return said.turns.clone();
        }
        let mut sum = TurnSum::default();
        sum.take(&outcome.settled());
        sum.said()
    }
}

impl Steps {
    /// Returns the latencies of a step for each memory of a run; none where the run dropped its records unobserved.
    pub(crate) fn of(outcome: &Outcome) -> Vec<Self> {
        if let Some(said) = HeadSaid::while_it_ran(outcome) {
            return said.steps.clone();
        }
        if outcome.has_forgotten() {
            return Vec::new();
        }
        let mut sum = StepSum::default();
        sum.take(&outcome.settled());
        sum.result()
    }
}
