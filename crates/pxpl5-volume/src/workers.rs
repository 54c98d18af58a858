//! Workers that report their progress.

use pxpl5_sim::{SharedWatcher, Watcher};
use spatialgl::{Task, Workers};
use std::sync::{Mutex, PoisonError};

/// A wrapper of workers, which counts each finished task.
pub struct Counted<'a> {
    inner: &'a dyn Workers,
    watcher: Mutex<&'a mut dyn Watcher>,
}

impl<'a> Counted<'a> {
    /// Wraps these workers.
    pub fn new(inner: &'a dyn Workers, watcher: &'a mut dyn Watcher) -> Self {
        Self { inner, watcher: Mutex::new(watcher) }
    }
}

impl Workers for Counted<'_> {
    fn run(&self, tasks: Vec<Task<'_>>) {
        let mut watcher = self.watcher.lock().unwrap_or_else(PoisonError::into_inner);
        let shared = SharedWatcher::new(&mut **watcher, tasks.len() as u64);
        // Wrap each task so that it reports its end. After a stop, no further task begins.
        let counted = tasks.into_iter().map(|task| {
            let shared = &shared;
            Box::new(move || {
                if !shared.stop().is_stopped() {
                    shared.part(task)
                }
            }) as Task<'_>
        });
        self.inner.run(counted.collect());
    }

    fn count(&self) -> usize {
        self.inner.count()
    }
}
