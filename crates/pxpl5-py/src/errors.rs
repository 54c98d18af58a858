//! What goes wrong, as exceptions of `pxpl5._errors` with the words of the library.

use pyo3::prelude::*;
use std::fmt::Display;

/// An exception of `pxpl5._errors`, by its name.
pub(crate) fn raised(name: &str, error: &impl Display) -> PyErr {
    Python::attach(|py| {
        let class = py.import("pxpl5._errors").and_then(|module| module.getattr(name));
        match class.and_then(|class| class.call1((error.to_string(),))) {
            Ok(exception) => PyErr::from_value(exception),
            Err(error) => error,
        }
    })
}

/// A setting, name, file or array that no experiment can have.
pub(crate) fn wrong_setting(error: impl Display) -> PyErr {
    raised("SettingError", &error)
}

/// A run that ended early, or a machine that cannot go on.
pub(crate) fn failed_run(error: impl Display) -> PyErr {
    raised("RunError", &error)
}

/// A folder of a sweep that cannot be used.
pub(crate) fn failed_sweep(error: impl Display) -> PyErr {
    raised("SweepError", &error)
}

/// Source text that no program can be made of.
pub(crate) fn not_assembled(error: impl Display) -> PyErr {
    raised("AssemblyError", &error)
}
