//! Settings of an experiment by path, as in experiment files.

use crate::errors::wrong_setting;
use pxpl5::{ExperimentFile, Plan};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Settings by path, like an experiment file. The settings are checked together only when an experiment is created.
#[pyclass(skip_from_py_object, module = "pxpl5._native")]
#[derive(Clone)]
pub(crate) struct Settings {
    pub(crate) file: ExperimentFile,
}

#[pymethods]
impl Settings {
    /// Creates empty settings.
    #[new]
    fn new() -> Self {
        Self { file: ExperimentFile::new() }
    }

    /// Reads an experiment file (TOML) in addition to the present settings. File names in it are relative to its
    /// folder.
    ///
    /// Raises :class:`pxpl5.SettingError` with the file, the line, and the expected and the found text.
    fn load(&mut self, path: PathBuf) -> PyResult<()> {
        self.file = self.file.clone().and_load(path).map_err(wrong_setting)?;
        Ok(())
    }

    /// Reads the text of an experiment file in addition to the present settings. ``name`` is the name of the text in
    /// error messages.
    ///
    /// Raises :class:`pxpl5.SettingError` as :meth:`load`.
    fn parse(&mut self, text: &str, name: &str) -> PyResult<()> {
        self.file = self.file.clone().and_parse(text, name).map_err(wrong_setting)?;
        Ok(())
    }

    /// Sets ``path=value``, with the value written as in TOML. ``place`` is the origin of the setting in error
    /// messages.
    ///
    /// Raises :class:`pxpl5.SettingError` with the nearest existing path.
    fn set(&mut self, assignment: &str, place: &str) -> PyResult<()> {
        self.file.set_text(assignment, place).map_err(wrong_setting)
    }

    /// Returns true if a path was set.
    fn has(&self, path: &str) -> bool {
        self.file.place_of(path).is_some()
    }

    /// Returns true if the settings describe the space of a sweep.
    #[getter]
    fn is_sweep(&self) -> bool {
        self.file.is_sweep()
    }

    /// Returns the effective settings as the text of an equivalent experiment file.
    ///
    /// Raises :class:`pxpl5.SettingError` for the first invalid or missing setting.
    fn text(&self) -> PyResult<String> {
        Ok(self.plan()?.settings_for_any_folder().to_string())
    }

    /// Returns an independent copy.
    fn copy(&self) -> Self {
        self.clone()
    }
}

impl Settings {
    /// Checks the settings and returns the experiment.
    pub(crate) fn plan(&self) -> PyResult<Plan> {
        self.file.resolve().map_err(wrong_setting)
    }
}
