//! The computer that a simulation runs on.

use pxpl5_machine::{PixelWorker, SameThread};
use std::fmt::Debug;

/// What a simulation may ask of the computer that it runs on. Nothing of it reaches the trace.
pub trait Host: Debug + Send + Sync {
    /// Seconds since some moment; `None` without a clock.
    fn seconds(&self) -> Option<f64> {
        None
    }

    /// Whether nobody wants the result any more. Runs ask now and then, rehearsals too, and end with
    /// [`ExperimentError::Stopped`](crate::ExperimentError::Stopped).
    fn is_given_up(&self) -> bool {
        false
    }

    /// Who computes the pixels of [`Pixels::All`](crate::Pixels::All).
    fn pixel_worker(&self) -> Box<dyn PixelWorker> {
        Box::new(SameThread::default())
    }
}

/// One thread, no clock and no files, as in a browser: what an [`Experiment`](crate::Experiment) runs on unless said.
#[derive(Clone, Copy, Debug, Default)]
pub struct BareHost;

impl Host for BareHost {}
