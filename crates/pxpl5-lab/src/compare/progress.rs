//! Counter of the finished runs of a comparison, and the flag with which another thread stops the runs.

use crate::error::StudyError;
use crate::{StopFlag, Workstation};
use pxpl5_machine::PixelWorker;
use pxpl5_run::Host;
use std::sync::atomic::{AtomicU64, Ordering};

/// Number of finished runs and of all runs of a comparison. The number of all runs grows when seeds are added.
pub(super) struct Progress<'a> {
    done: AtomicU64,
    all: AtomicU64,
    stop: &'a StopFlag,
    finished: &'a (dyn Fn(u64, u64) + Sync),
}

impl<'a> Progress<'a> {
    pub(super) fn new(all: u64, stop: &'a StopFlag, finished: &'a (dyn Fn(u64, u64) + Sync)) -> Self {
        Self { done: AtomicU64::new(0), all: AtomicU64::new(all), stop, finished }
    }

    pub(super) fn add(&self, runs: u64) {
        self.all.fetch_add(runs, Ordering::Relaxed);
    }

    pub(super) fn step(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        (self.finished)(done, self.all.load(Ordering::Relaxed));
    }

    pub(super) fn check_stopped(&self) -> Result<(), StudyError> {
        if self.stop.is_stopped() { Err(StudyError::Stopped) } else { Ok(()) }
    }

    pub(super) fn stop_flag(&self) -> StopFlag {
        self.stop.clone()
    }

    pub(super) fn host(&self) -> impl Host + use<> {
        StoppableWorkstation { workstation: Workstation::new(), stop: self.stop.clone() }
    }
}

#[derive(Debug)]
struct StoppableWorkstation {
    workstation: Workstation,
    stop: StopFlag,
}

impl Host for StoppableWorkstation {
    fn seconds(&self) -> Option<f64> {
        self.workstation.seconds()
    }

    fn is_stopped(&self) -> bool {
        self.stop.is_stopped()
    }

    fn pixel_worker(&self) -> Box<dyn PixelWorker> {
        self.workstation.pixel_worker()
    }
}
