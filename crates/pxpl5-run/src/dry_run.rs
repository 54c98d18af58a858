//! Result of a dry run without prediction: the instants for which views are drawn.

use crate::head::Head;
use crate::instants::Instants;
use pxpl5_sim::Time;
use pxpl5_wire::ViewNumber;

/// Instants for which views are drawn, found by a dry run without prediction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SeenTimes {
    /// Instant for which each shown view is drawn, by view number.
    aimed_at: Instants,
    /// Mean time from the sample of a view to the instant for which the view is drawn, in picoseconds.
    mean_lead_ps: u64,
}

impl SeenTimes {
    /// Creates the result from the instants for which shown views are drawn. `mean_lead_ps` is the mean time from a
    /// view's sample to this instant, in picoseconds.
    pub(crate) const fn new(aimed_at: Instants, mean_lead_ps: u64) -> Self {
        Self { aimed_at, mean_lead_ps }
    }

    /// Returns the instant for which a view is drawn. For a view that the dry run did not show, the result is
    /// estimated. The estimate is `sampled_at` plus the mean time from a view's sample to the instant for which the
    /// view is drawn.
    pub(crate) fn aimed_at(&self, number: ViewNumber, sampled_at: Time) -> Time {
        let expected = Time(sampled_at.0 + self.mean_lead_ps);
        self.aimed_at.of(number.0).filter(|at| *at >= sampled_at).unwrap_or(expected)
    }
}

/// The results of a dry run (a run without prediction), which every predictor needs. All predictors use the same
/// results.
#[derive(Clone, Debug)]
pub struct DryRun {
    /// Instants at which views are seen.
    pub(crate) seen_times: SeenTimes,
    /// Mean interval over which views must be predicted, in picoseconds. `None` if no view was predicted.
    pub(crate) interval_ps: Option<u64>,
    pub(crate) turn_interval_ps: Option<u64>,
}

impl DryRun {
    /// Returns the head with a tuned predictor. Returns `None` if the dry run found no prediction interval.
    ///
    /// The parameters for positions are tuned for the prediction interval of pictures. If the display turns pictures,
    /// the parameters for orientations are tuned for the prediction interval of these turns.
    pub(crate) fn tuned(&self, head: &Head) -> Option<Head> {
        let of_pictures = self.interval_ps.map(|interval_ps| head.tuned_for(interval_ps));
        match self.turn_interval_ps {
            Some(interval_ps) => Some(of_pictures.as_ref().unwrap_or(head).tuned_for_turns(interval_ps)),
            None => of_pictures,
        }
    }
}
