//! Who does the work of a volume: one thread, or those that a host hands in.

/// A piece of work that depends on no other.
pub type Task<'a> = Box<dyn FnOnce() + Send + 'a>;

/// Runs tasks, in any order and on any threads, and returns when all are done.
pub trait Workers: Sync {
    /// Runs all of them.
    fn run(&self, tasks: Vec<Task<'_>>);

    /// How many tasks can run at a time, 1 or more.
    fn count(&self) -> usize {
        1
    }
}

/// The calling thread, one task after the other.
#[derive(Clone, Copy, Debug, Default)]
pub struct OneThread;

impl Workers for OneThread {
    fn run(&self, tasks: Vec<Task<'_>>) {
        for task in tasks {
            task();
        }
    }
}
