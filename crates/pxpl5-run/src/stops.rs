//! Where a run stops on its way, to report progress and to be looked at.

use crate::experiment::Experiment;
use pxpl5_wire::PeriodNumber;
use std::collections::BTreeSet;

/// Fields between two reports of progress, and after which what is over is summed up.
pub(crate) const PROGRESS_FIELDS: u64 = 60;

impl Experiment {
    /// Fields at which to stop: those asked for, every so many for the progress, the last.
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
