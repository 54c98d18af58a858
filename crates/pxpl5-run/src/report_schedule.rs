//! Arrival times of a tracker's reports at the host. The times do not depend on the motion, so the times are known in
//! advance, even if a user moves the head during the run.

use pxpl5_sim::Time;
use std::collections::VecDeque;
use tracking::tracker::TrackerReport;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Coming {
    pub(crate) arrives: Time,
    pub(crate) measured: Time,
}

pub(crate) type Arrivals = Box<dyn Iterator<Item = Coming> + Send>;

pub(crate) type Contents = Box<dyn Iterator<Item = TrackerReport> + Send>;

impl Coming {
    pub(crate) const fn of(report: TrackerReport) -> Self {
        Self { arrives: Time(report.arrives_ps), measured: Time(report.measured_ps) }
    }
}

/// Arrival and measurement times of the tracker reports of a run.
///
/// Only reports that were requested and not discarded are in memory. The use of memory therefore does not depend on the
/// length of the run.
pub(crate) struct ReportSchedule {
    arrivals: Arrivals,
    queue: VecDeque<Coming>,
}

impl ReportSchedule {
    pub(crate) const fn new(arrivals: Arrivals) -> Self {
        Self { arrivals, queue: VecDeque::new() }
    }

    pub(crate) fn from(&mut self, instant: Time) -> Option<Coming> {
        self.read_until_after(instant);
        let earlier = self.queue.partition_point(|coming| coming.arrives < instant);
        self.queue.get(earlier).copied()
    }

    pub(crate) fn by(&mut self, instant: Time) -> Option<Coming> {
        self.read_until_after(instant);
        let there = self.queue.partition_point(|coming| coming.arrives <= instant);
        self.queue.get(there.checked_sub(1)?).copied()
    }

    pub(crate) fn discard_before(&mut self, instant: Time) {
        let Some(last) = self.by(instant) else { return };
        let earlier = self.queue.partition_point(|coming| coming.arrives < last.arrives);
        self.queue.drain(..earlier);
    }

    pub(crate) fn held(&self) -> usize {
        self.queue.len()
    }

    fn read_until_after(&mut self, instant: Time) {
        while self.queue.back().is_none_or(|last| last.arrives <= instant) {
            let Some(coming) = self.arrivals.next() else { return };
            self.queue.push_back(coming);
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
        /// Tests a schedule that discards old tracker reports against a list of all reports. Several reports can arrive
        /// at one instant.
        #[test]
        fn discarded_reports_are_not_needed_for_later_instants(
            mut all in proptest::collection::vec(0u64..200, 0..60), questions in proptest::collection::vec(0u64..220, 1..60),
        ) {
            all.sort_unstable();
            let mut kept = schedule(&all);
            let mut oldest = 0;
            for (i, at) in questions.into_iter().enumerate() {
                let at = at.max(oldest);
                let place = |coming: Option<Coming>| coming.map(|coming| coming.measured.0 as usize);
                prop_assert_eq!(place(kept.from(Time(at))), all.iter().position(|arrival| *arrival >= at));
                let last = all.iter().rposition(|arrival| *arrival <= at);
                prop_assert_eq!(place(kept.by(Time(at))), last);
                if let Some(last) = last {
                    let with_it = all.iter().position(|arrival| *arrival == all[last]);
                    prop_assert_eq!(place(kept.from(Time(all[last]))), with_it);
                }
                if i % 5 == 4 {
                    oldest = at;
                    kept.discard_before(Time(at));
                    let old = kept.queue.iter().filter(|coming| coming.arrives.0 <= at);
                    prop_assert!(old.map(|coming| coming.arrives).collect::<std::collections::BTreeSet<_>>().len() <= 1);
                }
            }
        }
    }
}
