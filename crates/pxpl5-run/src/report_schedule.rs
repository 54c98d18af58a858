//! When a tracker's reports reach their host. It does not depend on what they say, so it is known ahead of a head that somebody moves.

use pxpl5_sim::Time;
use std::collections::VecDeque;
use tracking::tracker::TrackerReport;

/// A report without what it says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Coming {
    /// When it reaches the host.
    pub(crate) arrives: Time,
    /// When what it says was true.
    pub(crate) measured: Time,
}

/// Reports to come, in order of arrival.
pub(crate) type Arrivals = Box<dyn Iterator<Item = Coming> + Send>;

/// What reports say, in order of arrival, each made when somebody takes it.
pub(crate) type Contents = Box<dyn Iterator<Item = TrackerReport> + Send>;

impl Coming {
    pub(crate) const fn of(report: TrackerReport) -> Self {
        Self { arrives: Time(report.arrives_ps), measured: Time(report.measured_ps) }
    }
}

/// The reports of a run, as far as somebody has asked about them and they were not given up: memory does not depend on the length of the run.
pub(crate) struct ReportSchedule {
    arrivals: Arrivals,
    known: VecDeque<Coming>,
}

impl ReportSchedule {
    pub(crate) const fn new(arrivals: Arrivals) -> Self {
        Self { arrivals, known: VecDeque::new() }
    }

    /// The first report at an instant or later; `None` where the run has none.
    pub(crate) fn from(&mut self, instant: Time) -> Option<Coming> {
        self.know_beyond(instant);
        let earlier = self.known.partition_point(|coming| coming.arrives < instant);
        self.known.get(earlier).copied()
    }

    /// The first report after an instant; `None` where the run has none.
    pub(crate) fn after(&mut self, instant: Time) -> Option<Coming> {
        self.from(Time(instant.0.saturating_add(1)))
    }

    /// The last report that was there at an instant; `None` before the first.
    pub(crate) fn by(&mut self, instant: Time) -> Option<Coming> {
        self.know_beyond(instant);
        let there = self.known.partition_point(|coming| coming.arrives <= instant);
        self.known.get(there.checked_sub(1)?).copied()
    }

    /// Gives up what nobody asks about who asks about this instant or later: what came before the last that was there then. What came
    /// with that one stays.
    pub(crate) fn forget_before(&mut self, instant: Time) {
        let Some(last) = self.by(instant) else { return };
        let earlier = self.known.partition_point(|coming| coming.arrives < last.arrives);
        self.known.drain(..earlier);
    }

    /// Reports that are held.
    pub(crate) fn held(&self) -> usize {
        self.known.len()
    }

    /// Makes reports until one comes after an instant.
    fn know_beyond(&mut self, instant: Time) {
        while self.known.back().is_none_or(|last| last.arrives <= instant) {
            let Some(coming) = self.arrivals.next() else { return };
            self.known.push_back(coming);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn schedule(arrivals: &[u64]) -> ReportSchedule {
        let coming: Vec<Coming> =
            arrivals.iter().zip(0..).map(|(at, i)| Coming { arrives: Time(*at), measured: Time(i) }).collect();
        ReportSchedule::new(Box::new(coming.into_iter()))
    }

    proptest! {
        /// A list of all of them is the model; several may come at one look of a kernel.
        #[test]
        fn what_was_given_up_is_not_missed_by_whoever_asks_about_later_instants(
            mut all in proptest::collection::vec(0u64..200, 0..60), questions in proptest::collection::vec(0u64..220, 1..60),
        ) {
            all.sort_unstable();
            let mut kept = schedule(&all);
            let mut oldest = 0;
            for (i, at) in questions.into_iter().enumerate() {
                let at = at.max(oldest);
                let place = |coming: Option<Coming>| coming.map(|coming| coming.measured.0 as usize);
                prop_assert_eq!(place(kept.from(Time(at))), all.iter().position(|arrival| *arrival >= at));
                prop_assert_eq!(place(kept.after(Time(at))), all.iter().position(|arrival| *arrival > at));
                let last = all.iter().rposition(|arrival| *arrival <= at);
                prop_assert_eq!(place(kept.by(Time(at))), last);
                if let Some(last) = last {
                    let with_it = all.iter().position(|arrival| *arrival == all[last]);
                    prop_assert_eq!(place(kept.from(Time(all[last]))), with_it);
                }
                if i % 5 == 4 {
                    oldest = at;
                    kept.forget_before(Time(at));
                    let old = kept.known.iter().filter(|coming| coming.arrives.0 <= at);
                    prop_assert!(old.map(|coming| coming.arrives).collect::<std::collections::BTreeSet<_>>().len() <= 1);
                }
            }
        }
    }
}
