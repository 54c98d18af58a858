//! Workers on several threads of this computer.

use crate::workers::{Task, Workers};
use std::num::NonZero;
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Worker threads of this computer. Each thread takes the next task when its current task is done.
#[derive(Clone, Copy, Debug)]
pub struct Threads(pub NonZero<usize>);

impl Threads {
    /// Returns the number of threads that this computer can execute in parallel.
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
