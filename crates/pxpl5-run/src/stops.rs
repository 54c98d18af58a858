//! Fields at which a run pauses, to report progress and to call functions of the user.

use crate::experiment::Experiment;
use pxpl5_wire::PeriodNumber;
use std::collections::BTreeSet;

/// Number of fields between two progress reports. At each report, a long run also discards old records.
pub(crate) const PROGRESS_FIELDS: u64 = 60;

impl Experiment {
    pub(crate) fn stops(&self, asked: &[PeriodNumber]) -> impl Iterator<Item = PeriodNumber> {
        let end = self.end();
        let mut asked: BTreeSet<PeriodNumber> = asked.iter().copied().filter(|field| *field < end).collect();
        let mut regular =
            PeriodNumber(PROGRESS_FIELDS).until(end).step_by(PROGRESS_FIELDS as usize).chain([end]).peekable();
        std::iter::from_fn(move || {
            let next = regular.peek().into_iter().chain(asked.first()).copied().min()?;
            regular.next_if_eq(&next);
            asked.remove(&next);
            Some(next)
        })
    }
}
