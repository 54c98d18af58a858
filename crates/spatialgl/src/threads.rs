#![cfg(feature = "threads")]
//! Several threads of the host.

use crate::workers::{Task, Workers};
use std::num::NonZero;
use std::sync::{Mutex, PoisonError};
use std::thread;

/// So many threads of the host, each of which takes the next task when it is done with one.
#[derive(Clone, Copy, Debug)]
pub struct Threads(pub NonZero<usize>);

impl Threads {
    /// As many as the host runs at a time.
    #[must_use]
    pub fn all() -> Self {
        Self(thread::available_parallelism().unwrap_or(NonZero::<usize>::MIN))
    }
}

impl Workers for Threads {
    fn run(&self, tasks: Vec<Task<'_>>) {
        let queue = Mutex::new(tasks.into_iter());
        thread::scope(|scope| {
            for _ in 0..self.0.get() {
                scope.spawn(|| {
                    while let Some(task) = next(&queue) {
                        task();
                    }
                });
            }
        });
    }

    fn count(&self) -> usize {
        self.0.get()
    }
}

fn next<'a>(queue: &Mutex<std::vec::IntoIter<Task<'a>>>) -> Option<Task<'a>> {
    queue.lock().unwrap_or_else(PoisonError::into_inner).next()
}
