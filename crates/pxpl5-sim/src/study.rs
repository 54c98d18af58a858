//! Long work that a [`Watcher`] follows and can stop.

use std::fmt::Display;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A follower of long work, which gets its progress and its finished rows, and can stop it.
///
/// All methods do nothing unless they are implemented, so `()` watches nothing.
pub trait Watcher: Send {
    /// Gets the number of finished parts of the work and the number of all parts, which can grow.
    fn progress(&mut self, done: u64, of: u64) {
        let _ = (done, of);
    }

    /// Gets a row of the result as soon as it is final, with the title of its table.
    fn row(&mut self, table: &'static str, row: &dyn Display) {
        let _ = (table, row);
    }

    /// Returns the flag that stops the work.
    fn stop(&self) -> StopFlag {
        StopFlag::default()
    }
}

impl Watcher for () {}

/// A flag with which one thread stops work on other threads. Clones share the flag.
///
/// As a [`Watcher`], the flag stops the work and ignores its progress.
#[derive(Clone, Debug, Default)]
pub struct StopFlag(Arc<AtomicBool>);

impl StopFlag {
    /// Requests the end of the work. Simulations in progress end within a few display periods.
    pub fn stop(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Withdraws the request to stop, so that the flag can be used again.
    pub fn clear(&self) {
        self.0.store(false, Ordering::Relaxed);
    }

    /// Returns true after a call of [`Self::stop`].
    pub fn is_stopped(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl Watcher for StopFlag {
    fn stop(&self) -> StopFlag {
        self.clone()
    }
}

/// A watcher of work whose parts are done on several threads, with the number of finished parts.
pub struct SharedWatcher<'a> {
    state: Mutex<Shared<'a>>,
    stop: StopFlag,
}

struct Shared<'a> {
    watcher: &'a mut dyn Watcher,
    done: u64,
    all: u64,
}

impl<'a> SharedWatcher<'a> {
    /// Begins work of `all` parts.
    pub fn new(watcher: &'a mut dyn Watcher, all: u64) -> Self {
        let stop = watcher.stop();
        watcher.progress(0, all);
        Self { state: Mutex::new(Shared { watcher, done: 0, all }), stop }
    }

    /// Counts a finished part.
    pub fn step(&self) {
        let mut state = self.state();
        state.done += 1;
        let (done, all) = (state.done, state.all);
        state.watcher.progress(done, all);
    }

    /// Does a part of the work and counts it.
    pub fn part<T>(&self, part: impl FnOnce() -> T) -> T {
        let result = part();
        self.step();
        result
    }

    /// Adds parts that were not expected.
    pub fn add(&self, more: u64) {
        self.state().all += more;
    }

    /// Hands on a finished row with the title of its table.
    pub fn row(&self, table: &'static str, row: &dyn Display) {
        self.state().watcher.row(table, row);
    }

    /// Returns the flag that stops the work.
    pub fn stop(&self) -> StopFlag {
        self.stop.clone()
    }

    fn state(&self) -> MutexGuard<'_, Shared<'a>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
