//! The number of finished runs of a comparison, and the flag by which another thread stops the runs.

use crate::Workstation;
use crate::error::StudyError;
use pxpl5_machine::PixelWorker;
use pxpl5_run::Host;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Number of finished runs of a comparison, and number of all runs. The number of all runs grows when seeds are added.
pub(super) struct Progress<'a> {
    done: AtomicU64,
    all: AtomicU64,
    /// True when another thread has asked the comparison to stop.
    stop: &'a Arc<AtomicBool>,
    finished: &'a (dyn Fn(u64, u64) + Sync),
}

impl<'a> Progress<'a> {
    pub(super) fn new(all: u64, stop: &'a Arc<AtomicBool>, finished: &'a (dyn Fn(u64, u64) + Sync)) -> Self {
        Self { done: AtomicU64::new(0), all: AtomicU64::new(all), stop, finished }
    }

    pub(super) fn add(&self, runs: u64) {
        self.all.fetch_add(runs, Ordering::Relaxed);
    }

    pub(super) fn step(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        (self.finished)(done, self.all.load(Ordering::Relaxed));
    }

    /// Returns an error if another thread has stopped the comparison.
    pub(super) fn check_stopped(&self) -> Result<(), StudyError> {
        if self.stop.load(Ordering::Relaxed) { Err(StudyError::Stopped) } else { Ok(()) }
    }

    /// Returns a host on which the comparison's runs can be stopped.
    pub(super) fn host(&self) -> impl Host + use<> {
        StoppableWorkstation { workstation: Workstation::new(), stop: Arc::clone(self.stop) }
    }
}

/// A computer on which another thread can stop the runs of a comparison.
#[derive(Debug)]
struct StoppableWorkstation {
    workstation: Workstation,
    stop: Arc<AtomicBool>,
}

impl Host for StoppableWorkstation {
    fn seconds(&self) -> Option<f64> {
        self.workstation.seconds()
    }

    fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    fn pixel_worker(&self) -> Box<dyn PixelWorker> {
        self.workstation.pixel_worker()
    }
}
