//! A source of faces that needs time: memories are served in rising order, and nothing half-drawn is shown.

use crate::content::Content;

/// An update on its way into a memory.
#[derive(Clone, Debug)]
pub(crate) struct Job {
    pub(crate) content: Content,
    /// Seconds of drawing, and how many of them are left.
    pub(crate) work_s: f64,
    pub(crate) left_s: f64,
    /// Memories that may only be shown together with this one, bit by bit; 0 for it alone.
    pub(crate) together: u8,
}

/// Updates that are being drawn, and those that wait behind them.
#[derive(Clone, Debug)]
pub(crate) struct Queue {
    running: Vec<Option<Job>>,
    waiting: Vec<Option<Job>>,
}

impl Queue {
    pub(crate) fn new(memories: usize) -> Self {
        Self { running: vec![None; memories], waiting: vec![None; memories] }
    }

    /// Takes an update in place of one that has not begun; one that has begun is drawn to its end first.
    pub(crate) fn put(&mut self, memory: usize, job: Job) {
        let has_begun = self.running[memory].as_ref().is_some_and(|running| running.left_s < running.work_s);
        let place = if has_begun { &mut self.waiting[memory] } else { &mut self.running[memory] };
        *place = Some(job);
    }

    /// Draws for a frame's time, the fastest memory first.
    pub(crate) fn work(&mut self, mut seconds: f64) {
        for job in self.running.iter_mut().flatten() {
            let spent = job.left_s.min(seconds);
            job.left_s -= spent;
            seconds -= spent;
        }
    }

    /// At a retrace: what can be shown, by memory; `Err` for an update that is not whole.
    pub(crate) fn retrace(&mut self) -> Vec<Option<Result<Content, ()>>> {
        let whole: Vec<bool> =
            self.running.iter().map(|job| job.as_ref().is_none_or(|job| job.left_s == 0.0)).collect();
        let outcomes = (0..self.running.len()).map(|memory| {
            let job = self.running[memory].as_ref()?;
            let together = (0..whole.len()).filter(|other| job.together >> other & 1 == 1);
            let may_swap = whole[memory] && together.into_iter().all(|other| whole[other]);
            Some(if may_swap { Ok(job.content.clone()) } else { Err(()) })
        });
        let outcomes: Vec<Option<Result<Content, ()>>> = outcomes.collect();
        for (memory, outcome) in outcomes.iter().enumerate() {
            if matches!(outcome, Some(Ok(_))) {
                self.running[memory] = self.waiting[memory].take();
            }
        }
        outcomes
    }
}
