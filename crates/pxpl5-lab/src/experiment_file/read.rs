//! Typed access to the settings of an experiment file.

use super::{ExperimentFile, Setting};
use crate::head_names;
use pxpl5_sim::parameters::{SettingError, Value as Number};
use std::ops::RangeInclusive;
use std::path::Path;
use toml::Value;

impl ExperimentFile {
    pub(super) fn get(&self, key: &str) -> Option<&Setting> {
        self.settings.get(key)
    }

    pub(super) fn text(&self, key: &str) -> Result<Option<&str>, SettingError> {
        let Some(setting) = self.get(key) else { return Ok(None) };
        setting.value.as_str().map(Some).ok_or_else(|| wrong(key, setting, "text in quotes"))
    }

    pub(super) fn flag(&self, key: &str) -> Result<Option<bool>, SettingError> {
        let Some(setting) = self.get(key) else { return Ok(None) };
        setting.value.as_bool().map(Some).ok_or_else(|| wrong(key, setting, "true or false"))
    }

    pub(super) fn integer(&self, key: &str, range: RangeInclusive<u64>) -> Result<Option<u64>, SettingError> {
        let Some(setting) = self.get(key) else { return Ok(None) };
        let value = setting.value.as_integer().and_then(|value| u64::try_from(value).ok());
        value
            .filter(|value| range.contains(value))
            .map(Some)
            .ok_or_else(|| wrong(key, setting, &format!("a whole number from {} to {}", range.start(), range.end())))
    }

    /// Converts the value of a setting to a parameter. A TOML value with a fraction becomes a real number. Any other
    /// value must be a whole number.
    pub(super) fn parameter_value(&self, path: &str, setting: &Setting) -> Result<Number, SettingError> {
        match &setting.value {
            Value::Float(number) if number.is_finite() => Ok(Number::Real(*number)),
            // The largest whole number of TOML is `i64::MAX`.
            _ => Ok(Number::Whole(self.integer(path, 0..=i64::MAX as u64)?.unwrap_or_default())),
        }
    }

    pub(super) fn number(&self, key: &str) -> Result<Option<f64>, SettingError> {
        let Some(setting) = self.get(key) else { return Ok(None) };
        let value = setting.value.as_float().or(setting.value.as_integer().map(|value| value as f64));
        value.filter(|value| value.is_finite()).map(Some).ok_or_else(|| wrong(key, setting, "a number"))
    }

    pub(super) fn texts(&self, key: &str) -> Result<Option<Vec<String>>, SettingError> {
        let Some(setting) = self.get(key) else { return Ok(None) };
        let list: Option<Option<Vec<String>>> =
            setting.value.as_array().map(|list| list.iter().map(|v| v.as_str().map(str::to_owned)).collect());
        list.flatten().map(Some).ok_or_else(|| wrong(key, setting, "a list of texts in quotes"))
    }

    /// Returns the value that a key selects by name from `choices`. A number selects the name with the same digits, so
    /// that `code = 1994` needs no quotes.
    pub(super) fn choice<T: Copy>(&self, key: &str, choices: &[(&str, T)]) -> Result<Option<T>, SettingError> {
        let Some(setting) = self.get(key) else { return Ok(None) };
        let found = plain(&setting.value);
        if let Some((_, value)) = choices.iter().find(|(name, _)| *name == found) {
            return Ok(Some(*value));
        }
        Err(unknown(key, setting, choices.iter().map(|(name, _)| *name)))
    }
}

/// Returns a TOML value as text without quotes.
pub(crate) fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

pub(super) fn wrong(key: &str, setting: &Setting, expected: &str) -> SettingError {
    let found: String = setting.value.to_string().chars().take(60).collect();
    SettingError::value(key, expected, found).at(&setting.place)
}

/// Creates the error of a key whose value is not one of the valid names.
pub(super) fn unknown<'a>(key: &str, setting: &Setting, valid: impl IntoIterator<Item = &'a str>) -> SettingError {
    let what = key.rsplit('.').next().unwrap_or(key);
    let found: String = plain(&setting.value).chars().take(60).collect();
    let names: Vec<&str> = valid.into_iter().collect();
    let error = head_names::unknown(what, &found, names.iter().copied(), &format!("one of {}", names.join(", ")));
    error.at(format_args!("{}: {key}", setting.place))
}

/// Creates the error of a key that the chosen pipeline does not have. `applies_to` names the pipelines that have the
/// key.
pub(super) fn not_applicable(key: &str, pipeline: &str, applies_to: &str) -> SettingError {
    SettingError::combination(format_args!(
        "{key} does not apply to the pipeline {pipeline}; leave it out (it is for {applies_to})"
    ))
}

/// Returns the path of a file whose name is relative to a folder.
pub(crate) fn beside(folder: &Path, name: &str) -> String {
    folder.join(name).display().to_string()
}
