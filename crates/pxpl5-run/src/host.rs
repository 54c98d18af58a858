use pxpl5_machine::{PixelWorker, SameThread};
use std::fmt::Debug;

/// Services of the computer on which a simulation runs.
///
/// No service affects a result.
pub trait Host: Debug + Send + Sync {
    /// Returns the time of the host's clock in seconds, or `None` without a clock. The zero of the clock is arbitrary.
    fn seconds(&self) -> Option<f64> {
        None
    }

    /// Returns the worker that computes the pixels of [`Pixels::All`](crate::Pixels::All).
    fn pixel_worker(&self) -> Box<dyn PixelWorker> {
        Box::new(SameThread::default())
    }
}

/// Default host of an [`Experiment`](crate::Experiment): one thread, no clock and no files, as in a browser.
#[derive(Clone, Copy, Debug, Default)]
pub struct BareHost;

impl Host for BareHost {}
