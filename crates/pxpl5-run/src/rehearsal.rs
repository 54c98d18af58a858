//! For which instants views are drawn, known from a run without prediction.

use crate::outcome::Outcome;
use crate::statistics::Statistics;
use pxpl5_display::{Aim, LightSpan};
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
    /// What an aim makes of a run.
    pub(crate) fn of(outcome: &Outcome, aim: Aim) -> Self {
        let Some(head) = outcome.head() else { return Self::default() };
        let aimed_at: BTreeMap<ViewNumber, Time> =
            shown(outcome).into_iter().map(|(view, shown)| (view, aim.instant(&shown))).collect();
        let leads = head.sampled().into_iter().filter_map(|s| Some(aimed_at.get(&s.number)?.since(s.known).as_ms()));
        let mean_lead_ps = (Statistics::of(leads).mean * 1e9) as u64;
        Self { aimed_at, mean_lead_ps }
    }

    /// The instant that a view is drawn for; of a view that was not shown, so long after its sample as the others on average.
    pub(crate) fn aimed_at(&self, number: ViewNumber, sampled_at: Time) -> Time {
        let expected = Time(sampled_at.0 + self.mean_lead_ps);
        self.aimed_at.get(&number).copied().filter(|at| *at >= sampled_at).unwrap_or(expected)
    }
}

/// When each view is shown, in as many pictures as are of it.
fn shown(outcome: &Outcome) -> BTreeMap<ViewNumber, LightSpan> {
    let mut all: BTreeMap<ViewNumber, LightSpan> = BTreeMap::new();
    let pictures = outcome.pictures();
    for (i, times) in pictures.iter().enumerate() {
        let shown = outcome.pipeline().shown(outcome.record(), times, pictures.get(i + 1));
        all.entry(times.view).and_modify(|known| known.last = known.last.max(shown.last)).or_insert(shown);
    }
    all
}
