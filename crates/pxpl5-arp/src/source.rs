//! A renderer of limited speed, which draws memories in ascending order of their indices and shows only complete
//! updates.

use crate::content::Content;

#[derive(Clone, Debug)]
pub(crate) struct Job {
    pub(crate) content: Content,
    /// Time that the renderer needs to draw the whole update, in seconds.
    pub(crate) work_s: f64,
    pub(crate) left_s: f64,
    /// Bit mask of the memories that must be shown in the same frame as this memory. The mask is 0 if the memory is
    /// independent.
    pub(crate) together: u8,
}

#[derive(Clone, Debug)]
pub(crate) struct Queue {
    running: Vec<Option<Job>>,
    waiting: Vec<Option<Job>>,
}

impl Queue {
    pub(crate) fn new(memories: usize) -> Self {
        Self { running: vec![None; memories], waiting: vec![None; memories] }
    }

    /// Adds an update of a memory. If the renderer has already begun an older update of this memory, the new update
    /// waits. Otherwise the new update replaces the older update.
    pub(crate) fn put(&mut self, memory: usize, job: Job) {
        let has_begun = self.running[memory].as_ref().is_some_and(|running| running.left_s < running.work_s);
        let place = if has_begun { &mut self.waiting[memory] } else { &mut self.running[memory] };
        *place = Some(job);
    }

    /// Draws for `seconds`, the duration of a frame, starting with the memory that is updated most often.
    pub(crate) fn work(&mut self, mut seconds: f64) {
        for job in self.running.iter_mut().flatten() {
            let spent = job.left_s.min(seconds);
            job.left_s -= spent;
            seconds -= spent;
        }
    }

    /// Returns for each memory the update that can be shown at a retrace. `Err` marks an incomplete update.
    pub(crate) fn retrace(&mut self) -> Vec<Option<Result<Content, ()>>> {
        // A memory without an update counts as complete, so that it does not delay its group.
        let whole: Vec<bool> =
            self.running.iter().map(|job| job.as_ref().is_none_or(|job| job.left_s == 0.0)).collect();
        let outcomes = (0..self.running.len()).map(|memory| {
            let job = self.running[memory].as_ref()?;
            let together = (0..whole.len()).filter(|other| job.together >> other & 1 == 1);
            let may_swap = whole[memory] && together.into_iter().all(|other| whole[other]);
            Some(if may_swap { Ok(job.content.clone()) } else { Err(()) })
        });
        let outcomes: Vec<Option<Result<Content, ()>>> = outcomes.collect();
        // The next waiting update takes the place of a shown update.
        for (memory, outcome) in outcomes.iter().enumerate() {
            if matches!(outcome, Some(Ok(_))) {
                self.running[memory] = self.waiting[memory].take();
            }
        }
        outcomes
    }
}
