//! When views are seen, known from a run without prediction.

use crate::outcome::Outcome;
use crate::statistics::Statistics;
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
    /// When the views of a run were seen.
    pub(crate) fn of(outcome: &Outcome) -> Self {
        let Some(head) = outcome.head() else { return Self::default() };
        let record = outcome.record();
        let pipeline = outcome.pipeline();
        let mut seen_at = BTreeMap::new();
        for times in outcome.pictures() {
            seen_at.entry(times.view).or_insert_with(|| pipeline.light(record, times));
        }
        let leads = head.sampled().into_iter().filter_map(|s| Some(seen_at.get(&s.number)?.since(s.known).as_ms()));
        let mean_lead_ps = (Statistics::of(leads).mean * 1e9) as u64;
        Self { seen_at, mean_lead_ps }
    }

    /// When a view will be seen; a view that was not, so long after its sample as the others on average.
    pub(crate) fn shown_at(&self, number: ViewNumber, sampled_at: Time) -> Time {
        let expected = Time(sampled_at.0 + self.mean_lead_ps);
        self.seen_at.get(&number).copied().filter(|at| *at >= sampled_at).unwrap_or(expected)
    }
}
