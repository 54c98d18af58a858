//! For which instants views are drawn, known from a run without prediction.

use pxpl5_sim::Time;
use pxpl5_wire::ViewNumber;
use std::collections::BTreeMap;

/// For which instants views are drawn, found by a run without prediction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rehearsal {
    /// The instant of each view that was shown, by the view's number.
    aimed_at: BTreeMap<ViewNumber, Time>,
    /// Mean time from the sample of a view to its instant, picoseconds.
    mean_lead_ps: u64,
}

impl Rehearsal {
    /// The instants of the views that were shown, and how long after its sample a view is shown on average, picoseconds.
    pub(crate) const fn new(aimed_at: BTreeMap<ViewNumber, Time>, mean_lead_ps: u64) -> Self {
        Self { aimed_at, mean_lead_ps }
    }

    /// The instant that a view is drawn for; of a view that was not shown, so long after its sample as the others on average.
    pub(crate) fn aimed_at(&self, number: ViewNumber, sampled_at: Time) -> Time {
        let expected = Time(sampled_at.0 + self.mean_lead_ps);
        self.aimed_at.get(&number).copied().filter(|at| *at >= sampled_at).unwrap_or(expected)
    }
}
