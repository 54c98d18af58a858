//! Execution of the tasks of a volume, on one thread or on threads that a host program supplies.

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
