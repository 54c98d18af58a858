//! Results that concern the head. The source is the streaming observer of the run. Without an observer, the source is
//! the records that the run still has in memory.

use crate::budget::{Budget, BudgetSum, of_pictures, poses};
use crate::error_observer::ErrorSum;
use crate::errors::{PixelErrors, Showing};
use crate::eye_report::EyeReport;
use crate::percentiles::Percentiles;
use crate::step_observer::{StepSum, Steps};
use crate::turn_observer::{RotationLatencySum, Turns};
use pxpl5_run::{Cause, FinalResults, Outcome, StreamingObserver};
use std::any::Any;
use std::borrow::Cow;
use tracking::time::PS_PER_MS;

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

    fn results(self) -> HeadResults {
        let Self { budget, turns, steps, errors } = self;
        let percentiles = budget.percentiles();
        let (error, eye) = errors.result();
        let (turns, steps) = (turns.result(), steps.result());
        HeadResults { end_to_end: budget.result(), percentiles, turns, steps, error, eye }
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
        Box::new(self.results())
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

impl HeadResults {
    pub(crate) fn of(outcome: &Outcome) -> Cow<'_, Self> {
        if let Some(results) = outcome.observed() {
            return Cow::Borrowed(results);
        }
        let mut sum = HeadSum::default();
        sum.take(&outcome.final_results());
        let mut results = sum.results();
        // A translation latency needs the records of the whole time in which an update is shown.
        if outcome.has_discarded_records() {
            results.steps.clear();
        }
        Cow::Owned(results)
    }
}

/// Returns a warning if a run with a head has discarded its records and had no streaming observer.
pub(crate) fn missing_results_warning(outcome: &Outcome) -> Option<String> {
    let is_missing =
        outcome.head().is_some() && outcome.has_discarded_records() && outcome.observed::<HeadResults>().is_none();
    is_missing.then(|| MISSING_RESULTS.to_owned())
}

const MISSING_RESULTS: &str = "latencies from the head to light and errors in pixels cover only the last pictures: the run discarded its records and had no \
    streaming observer (Experiment::observed_by; or keep all records with KeptRecords::Everything)";

impl PixelErrors {
    /// Returns the errors that the pictures of a run have if a display shows the pictures as drawn, without any
    /// correction. The result is empty for a run without a head.
    pub fn of(outcome: &Outcome) -> Self {
        Self::shown(outcome, Showing::Plain)
    }

    /// Returns the errors of a run in the display mode `showing`.
    ///
    /// A run that discarded its records ([`Outcome::has_discarded_records`]) covers all periods only if
    /// [`HeadSum`](crate::HeadSum) observed the run and `showing` is the head's own display mode. Otherwise the result
    /// covers only the last periods.
    pub fn shown(outcome: &Outcome, showing: Showing) -> Self {
        let Some(head) = outcome.head() else { return Self::default() };
        let results = outcome.observed::<HeadResults>().filter(|_| showing == head.head().raster.into());
        results.map_or_else(|| evaluated(outcome, showing, None, 0).0, |results| results.error.clone())
    }

    /// Returns the errors that the run would have without one cause of error. All times stay the same.
    ///
    /// For a run that discarded its records, the result covers only the last periods.
    pub fn without(outcome: &Outcome, showing: Showing, cause: Cause) -> Self {
        evaluated(outcome, showing, Some(cause), 0).0
    }

    /// Returns the errors that the run would have if each picture's pose were predicted for an instant that is `later_ms`
    /// milliseconds too late, or too early if negative. All times stay the same, and so does what a device does to the
    /// pictures.
    ///
    /// For a run that discarded its records, the result covers only the last periods.
    pub fn with_prediction_interval_error(outcome: &Outcome, showing: Showing, later_ms: i64) -> Self {
        evaluated(outcome, showing, None, later_ms * PS_PER_MS as i64).0
    }
}

fn evaluated(
    outcome: &Outcome,
    showing: Showing,
    without: Option<Cause>,
    later_ps: i64,
) -> (PixelErrors, Option<EyeReport>) {
    let mut sum = ErrorSum::of(showing, without, later_ps);
    sum.take(&outcome.final_results());
    sum.result()
}

impl EyeReport {
    /// Returns the report of a run with a head, for the display mode `showing`.
    ///
    /// Returns `None` for a run without a head, and for a display without persistence and without reprojection.
    pub fn shown(outcome: &Outcome, showing: Showing) -> Option<Self> {
        outcome.head().and_then(|_| evaluated(outcome, showing, None, 0).1)
    }
}

/// Returns the pixel errors in the display mode of the head's display, or `None` for a run without a head.
pub fn pixel_errors(outcome: &Outcome) -> Option<PixelErrors> {
    Some(PixelErrors::shown(outcome, outcome.head()?.head().raster.into()))
}

impl Budget {
    /// Returns the mean time of each stage of the latency. The mean covers the pictures in the result window that are
    /// complete and have a measured pose.
    pub fn of(outcome: &Outcome) -> Self {
        if let Some(results) = outcome.observed::<HeadResults>() {
            return results.end_to_end;
        }
        let mut sum = BudgetSum::default();
        sum.take(&outcome.final_results());
        sum.result()
    }

    /// Returns the latency of each picture whose records are in memory, in milliseconds. The latency lasts from the
    /// measurement of the pose until the middle of the picture is lit.
    pub fn totals_ms(outcome: &Outcome) -> Vec<f64> {
        let run = outcome.final_results();
        let stages = of_pictures(&run, &poses(&run));
        stages.iter().map(|stages| stages.iter().sum()).collect()
    }
}
