//! Execution of long work on a separate thread without the interpreter's lock. During the work, the calling thread
//! reports progress and reacts to Ctrl-C.

use crate::errors::failed_run;
use pxpl5::{StopFlag, Study, StudyError, Watcher};
use pyo3::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::Duration;

#[derive(Debug, Default)]
pub(crate) struct Progress {
    done: AtomicU64,
    of: AtomicU64,
    stopped: StopFlag,
}

impl Progress {
    pub(crate) fn report(&self, done: u64, of: u64) {
        self.of.store(of, Ordering::Relaxed);
        self.done.fetch_max(done, Ordering::Relaxed);
    }

    pub(crate) fn stop(&self) {
        self.stopped.stop();
    }

    pub(crate) fn stop_flag(&self) -> StopFlag {
        self.stopped.clone()
    }
}

const POLL_INTERVAL: Duration = Duration::from_millis(50);

impl Watcher for &Progress {
    fn progress(&mut self, done: u64, of: u64) {
        self.report(done, of);
    }

    fn stop(&self) -> StopFlag {
        self.stop_flag()
    }
}

/// Runs `work` on a separate thread. `callback` gets the number of finished steps and the number of all steps. The
/// callback is called at most twenty times a second, and only after a change.
///
/// Ctrl-C or an exception of the callback asks the work to stop. If `waits` is true, the exception is raised after the
/// work has stopped. If `waits` is false, the exception is raised immediately, and the result of the work is discarded.
///
/// A panic of the work, which is a bug of the emulator, raises `RunError`.
pub(crate) fn in_background<T: Send + 'static>(
    py: Python<'_>,
    callback: Option<&Bound<'_, PyAny>>,
    waits: bool,
    work: impl FnOnce(Arc<Progress>) -> T + Send + 'static,
) -> PyResult<T> {
    let progress = Arc::new(Progress::default());
    let (sender, mut results) = sync_channel(1);
    let watch = Arc::clone(&progress);
    spawn("pxpl5", move || {
        // After an early return of the caller the receiver no longer exists, so an error is ignored.
        let _ = sender.send(work(watch));
    })?;
    let mut watch = None;
    loop {
        // Wait without the interpreter's lock, then check for Ctrl-C and report progress.
        let result = py.detach(|| recv(&mut results));
        let checked = py.check_signals().and_then(|()| tell(callback, &progress, &mut watch));
        if let Err(error) = checked {
            // Ask the work to stop, and raise the exception.
            progress.stop();
            if waits {
                py.detach(|| end(&mut results));
            }
            return Err(error);
        }
        match result {
            Ok(result) => return Ok(result),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(failed_run("a bug of the emulator: its thread panicked"));
            }
        }
    }
}

/// Runs a study on a separate thread.
pub(crate) fn study<S: Study<Report: Send + 'static> + Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    study: S,
) -> PyResult<Result<S::Report, StudyError>> {
    in_background(py, progress, false, move |watch| study.run(&mut &*watch))
}

/// Stack size of the worker thread in bytes, equal to the stack of a main thread. The emulator has not been tested with
/// a smaller stack.
const STACK_BYTES: usize = 8 << 20;

/// Starts a thread with a stack of [`STACK_BYTES`].
pub(crate) fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> PyResult<()> {
    let started = std::thread::Builder::new().name(name.to_owned()).stack_size(STACK_BYTES).spawn(work);
    started.map(drop).map_err(|error| failed_run(format!("no thread can be started: {error}")))
}

// The receiver is borrowed mutably. It can be sent to another thread, but threads cannot share it.

/// Waits a short time for a result of another thread.
pub(crate) fn recv<T>(results: &mut Receiver<T>) -> Result<T, RecvTimeoutError> {
    results.recv_timeout(POLL_INTERVAL)
}

fn end<T>(results: &mut Receiver<T>) -> Option<T> {
    results.recv().ok()
}

fn tell(callback: Option<&Bound<'_, PyAny>>, progress: &Progress, watch: &mut Option<(u64, u64)>) -> PyResult<()> {
    let now = (progress.done.load(Ordering::Relaxed), progress.of.load(Ordering::Relaxed));
    let Some(callback) = callback.filter(|_| now.1 > 0 && *watch != Some(now)) else { return Ok(()) };
    *watch = Some(now);
    callback.call1(now).map(drop)
}
