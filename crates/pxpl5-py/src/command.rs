//! The command `pxpl5` in the Python package, and the version of the package.

use crate::errors::wrong_setting;
use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the command ``pxpl5``. The first argument is the name of the program. Returns the exit code.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| pxpl5_cli::run_arguments(pxpl5::registry(), arguments))
}

/// Plots the results of a sweep or a comparison with the command ``pxpl5 plot``. ``arguments`` are the arguments of
/// this command. The output files must not exist.
///
/// Raises :class:`pxpl5.SettingError` for an unknown column, and for results without a number.
#[pyfunction]
pub(crate) fn plot(py: Python<'_>, arguments: Vec<OsString>) -> PyResult<()> {
    let all = ["pxpl5", "plot", "--quiet"].map(OsString::from).into_iter().chain(arguments);
    py.detach(|| pxpl5_cli::try_arguments(pxpl5::registry(), all)).map_err(wrong_setting)
}

/// Returns the version of the emulator.
#[pyfunction]
pub(crate) const fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}
