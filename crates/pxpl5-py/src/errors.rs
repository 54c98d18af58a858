//! Conversion of the library's errors to exceptions of `pxpl5._errors` with the same messages.

use pxpl5::StopFlag;
use pyo3::prelude::*;
use std::fmt::Display;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Returns an exception of the class `name` from `pxpl5._errors`, with the message of `error`.
pub(crate) fn raised(name: &str, error: &impl Display) -> PyErr {
    Python::attach(|py| {
        let class = py.import("pxpl5._errors").and_then(|module| module.getattr(name));
        match class.and_then(|class| class.call1((error.to_string(),))) {
            Ok(exception) => PyErr::from_value(exception),
            Err(error) => error,
        }
    })
}

pub(crate) fn wrong_setting(error: impl Display) -> PyErr {
    raised("SettingError", &error)
}

pub(crate) fn failed_run(error: impl Display) -> PyErr {
    raised("RunError", &error)
}

pub(crate) fn failed_sweep(error: impl Display) -> PyErr {
    raised("SweepError", &error)
}

pub(crate) fn not_assembled(error: impl Display) -> PyErr {
    raised("AssemblyError", &error)
}

/// An exception of a Python function that is not yet reported, and the flag of the run that it ends.
#[derive(Default)]
pub(crate) struct Raised(Mutex<(Option<PyErr>, StopFlag)>);

impl Raised {
    fn state(&self) -> MutexGuard<'_, (Option<PyErr>, StopFlag)> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Names the run that the next exception stops.
    pub(crate) fn ends(&self, run: StopFlag) {
        self.state().1 = run;
    }

    pub(crate) fn is_there(&self) -> bool {
        self.state().0.is_some()
    }

    pub(crate) fn keep(&self, error: PyErr) {
        let mut state = self.state();
        state.0 = Some(error);
        state.1.stop();
    }

    /// Raises the exception, if any.
    pub(crate) fn check(&self) -> PyResult<()> {
        self.state().0.take().map_or(Ok(()), Err)
    }
}
