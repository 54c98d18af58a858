//! Execution of the tasks of a volume, on one thread or on threads that a host program supplies.

use std::num::NonZero;
use std::sync::{Mutex, PoisonError};
use std::thread;

/// A task that does not depend on any other task.
pub type Task<'a> = Box<dyn FnOnce() + Send + 'a>;

/// An executor of tasks, which may execute the tasks in any order and on any threads.
pub trait Workers: Sync {
    /// Executes all tasks and returns when they are done.
    fn run(&self, tasks: Vec<Task<'_>>);

    /// Returns the number of tasks that can run at a time, 1 or more.
    fn count(&self) -> usize {
        1
    }
}

/// Execution on the calling thread, one task after the other.
#[derive(Clone, Copy, Debug, Default)]
pub struct OneThread;

impl Workers for OneThread {
    fn run(&self, tasks: Vec<Task<'_>>) {
        for task in tasks {
            task();
        }
    }
}

/// Worker threads of this computer. Each thread takes the next task when its current task is done.
#[derive(Clone, Copy, Debug)]
pub struct Threads(pub NonZero<usize>);

impl Threads {
    /// Returns the number of threads that this computer can execute in parallel.
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
