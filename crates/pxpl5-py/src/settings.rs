//! Settings of an experiment by path, as experiment files have them.

use crate::errors::wrong_setting;
use pxpl5::{ExperimentFile, Plan};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Settings by path that were read or set but not yet checked together: an experiment file.
#[pyclass(skip_from_py_object, module = "pxpl5._native")]
#[derive(Clone)]
pub(crate) struct Settings {
    pub(crate) file: ExperimentFile,
}

#[pymethods]
impl Settings {
    /// No settings.
    #[new]
    fn new() -> Self {
        Self { file: ExperimentFile::new() }
    }

    /// Reads an experiment file (TOML) on top of what is set; names of files in it are relative to its folder.
    ///
    /// Raises :class:`pxpl5.SettingError` with the file, the line, what was expected and what was found.
    fn load(&mut self, path: PathBuf) -> PyResult<()> {
        self.file = self.file.clone().and_load(path).map_err(wrong_setting)?;
        Ok(())
    }

    /// Reads the text of an experiment file on top of what is set; ``name`` stands for it in errors.
    ///
    /// Raises :class:`pxpl5.SettingError` as :meth:`load`.
    fn parse(&mut self, text: &str, name: &str) -> PyResult<()> {
        self.file = self.file.clone().and_parse(text, name).map_err(wrong_setting)?;
        Ok(())
    }

    /// Sets ``path=value``, where the value is written as in TOML; ``place`` says in errors where it was given.
    ///
    /// Raises :class:`pxpl5.SettingError` with the nearest path that there is.
    fn set(&mut self, assignment: &str, place: &str) -> PyResult<()> {
        self.file.set_text(assignment, place).map_err(wrong_setting)
    }

    /// Whether a path was set.
    fn has(&self, path: &str) -> bool {
        self.file.place_of(path).is_some()
    }

    /// Whether a space of settings is described, for a sweep.
    #[getter]
    fn is_sweep(&self) -> bool {
        self.file.is_sweep()
    }

    /// The effective settings as the text of an experiment file that says the same.
    ///
    /// Raises :class:`pxpl5.SettingError` for the first setting that is wrong or missing.
    fn text(&self) -> PyResult<String> {
        Ok(self.plan()?.settings_for_any_folder().to_string())
    }

    /// An independent copy.
    fn copy(&self) -> Self {
        self.clone()
    }
}

impl Settings {
    /// The checked experiment.
    pub(crate) fn plan(&self) -> PyResult<Plan> {
        self.file.resolve().map_err(wrong_setting)
    }
}
