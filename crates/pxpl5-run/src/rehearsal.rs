//! When views are seen, known from a run without prediction.

use pxpl5_sim::Time;
use pxpl5_wire::ViewNumber;
use std::collections::BTreeMap;

/// When views are seen, found by a run without prediction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rehearsal {
    /// When the light of each view's picture came.
    pub(crate) seen_at: BTreeMap<ViewNumber, Time>,
    /// Mean time from the sample of a view to its light, picoseconds.
    pub(crate) mean_lead_ps: u64,
}

impl Rehearsal {
    /// When a view will be seen; a view that was not, so long after its sample as the others on average.
    pub(crate) fn shown_at(&self, number: ViewNumber, sampled_at: Time) -> Time {
        let expected = Time(sampled_at.0 + self.mean_lead_ps);
        self.seen_at.get(&number).copied().filter(|at| *at >= sampled_at).unwrap_or(expected)
    }
}
