//! Conversion of the library's errors to exceptions of `pxpl5._errors` with the same messages.

use pyo3::prelude::*;
use std::fmt::Display;

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
