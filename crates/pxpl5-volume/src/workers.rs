//! Workers that report their progress.

use spatialgl::{Task, Workers};
use std::sync::atomic::{AtomicU64, Ordering};

/// A wrapper of workers, which calls a function after each task. The arguments are the number of finished tasks and the
/// number of all tasks.
pub struct Counted<'a> {
    inner: &'a dyn Workers,
    finished: &'a (dyn Fn(u64, u64) + Sync),
}

impl<'a> Counted<'a> {
    /// Wraps these workers. `finished` receives the number of finished tasks and the number of all tasks.
    #[must_use]
    pub fn new(inner: &'a dyn Workers, finished: &'a (dyn Fn(u64, u64) + Sync)) -> Self {
        Self { inner, finished }
    }
}

impl Workers for Counted<'_> {
    fn run(&self, tasks: Vec<Task<'_>>) {
        let all = tasks.len() as u64;
        let done = AtomicU64::new(0);
        // Wrap each task so that it reports its end.
        let counted = tasks.into_iter().map(|task| {
            let done = &done;
            let counted = move || {
                task();
                (self.finished)(done.fetch_add(1, Ordering::Relaxed) + 1, all);
            };
            Box::new(counted) as Task<'_>
        });
        self.inner.run(counted.collect());
    }

    fn count(&self) -> usize {
        self.inner.count()
    }
}
