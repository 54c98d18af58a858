//! Settings of an experiment by path, as in an experiment file.

use crate::errors::wrong_setting;
use crate::motion::Motion;
use crate::policy::PythonFunctions;
use pxpl5::{ExperimentFile, Plan};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Settings of an experiment by path, as in an experiment file. The combination of all settings is checked only when an
/// experiment is created from the settings.
#[pyclass(skip_from_py_object, module = "pxpl5._native")]
#[derive(Clone)]
pub(crate) struct Settings {
    pub(crate) file: ExperimentFile,
    /// Function of Python that moves the head, if any.
    pub(crate) functions: PythonFunctions,
}

#[pymethods]
impl Settings {
    /// Creates empty settings.
    #[new]
    fn new() -> Self {
        Self { file: ExperimentFile::new(), functions: PythonFunctions::default() }
    }

    /// Adds the settings of an experiment file (TOML) to the present settings. File names in the file are relative to
    /// the folder of the file.
    ///
    /// Raises :class:`pxpl5.SettingError` with the file, the line, and the expected and the found text.
    fn load(&mut self, path: PathBuf) -> PyResult<()> {
        self.file = self.file.clone().and_load(path).map_err(wrong_setting)?;
        Ok(())
    }

    /// Adds settings from the text of an experiment file to the present settings. ``name`` stands for the text in error
    /// messages.
    ///
    /// Raises :class:`pxpl5.SettingError` in the same cases as :meth:`load`.
    fn parse(&mut self, text: &str, name: &str) -> PyResult<()> {
        self.file = self.file.clone().and_parse(text, name).map_err(wrong_setting)?;
        Ok(())
    }

    /// Sets the value of a setting, given as ``path=value`` with the value written as in TOML. ``place`` is the origin
    /// of the setting in error messages.
    ///
    /// Raises :class:`pxpl5.SettingError` with the nearest existing path.
    fn set(&mut self, assignment: &str, place: &str) -> PyResult<()> {
        self.file.set_text(assignment, place).map_err(wrong_setting)
    }

    /// Moves the head by a motion. A motion without a name has a hash as the value of ``head.motion``.
    ///
    /// Raises any exception of a Python function that computes the motion.
    fn set_motion(&mut self, motion: &Motion) -> PyResult<()> {
        motion.set_in(&mut self.file)?;
        self.functions.motion.clone_from(&motion.called);
        self.functions.check()
    }

    /// Returns all settings that are in effect, as the text of an equivalent experiment file.
    ///
    /// Raises :class:`pxpl5.SettingError` for the first invalid or missing setting.
    fn text(&self) -> PyResult<String> {
        Ok(self.plan()?.settings_for_any_folder().to_string())
    }

    /// Returns an independent copy of the settings.
    fn copy(&self) -> Self {
        self.clone()
    }
}

impl Settings {
    pub(crate) fn plan(&self) -> PyResult<Plan> {
        self.file.resolve().map_err(wrong_setting)
    }
}
