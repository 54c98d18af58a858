use crate::head::Head;
use pxpl5_sim::Time;
use pxpl5_wire::ViewNumber;
use std::collections::BTreeMap;

/// The instants for which a predictor must predict the views of a run, found by a dry run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SeenTimes {
    aimed_at: BTreeMap<ViewNumber, Time>,
    /// Mean time from the request of a pose to the instant for which its picture is drawn, in picoseconds.
    mean_lead_ps: u64,
}

impl SeenTimes {
    pub(crate) const fn new(aimed_at: BTreeMap<ViewNumber, Time>, mean_lead_ps: u64) -> Self {
        Self { aimed_at, mean_lead_ps }
    }

    /// Returns the instant for which view `number` must be predicted. If the dry run did not show this view, the result
    /// is `sampled_at` plus the mean time over all views.
    pub(crate) fn aimed_at(&self, number: ViewNumber, sampled_at: Time) -> Time {
        let expected = Time(sampled_at.0 + self.mean_lead_ps);
        self.aimed_at.get(&number).copied().filter(|at| *at >= sampled_at).unwrap_or(expected)
    }
}

/// The results of a dry run, from which every predictor is tuned.
#[derive(Clone, Debug)]
pub struct DryRun {
    pub(crate) seen_times: SeenTimes,
    /// Mean time from the measurement of a pose to the instant at which its picture is seen, in picoseconds. `None` if
    /// no complete picture used a tracker report.
    pub(crate) interval_ps: Option<u64>,
    pub(crate) turn_interval_ps: Option<u64>,
}

impl DryRun {
    /// Returns the head with a predictor that is tuned for the prediction intervals of this dry run. Returns `None` if
    /// the dry run found no interval.
    ///
    /// The parameters for positions are tuned for the prediction interval of pictures. Some displays turn each picture
    /// by the newest orientation. For such a display, the parameters for orientations are tuned for the prediction
    /// interval of the orientations.
    pub(crate) fn tuned(&self, head: &Head) -> Option<Head> {
        let of_pictures = self.interval_ps.map(|interval_ps| head.tuned_for(interval_ps));
        match self.turn_interval_ps {
            Some(interval_ps) => Some(of_pictures.as_ref().unwrap_or(head).tuned_for_turns(interval_ps)),
            None => of_pictures,
        }
    }
}
