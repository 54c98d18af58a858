//! Typed access to the settings of an experiment file.

use super::{ExperimentFile, FileError, Setting};
use pxpl5_sim::parameters::{Value as Number, nearest};
use std::ops::RangeInclusive;
use std::path::Path;
use toml::Value;

impl ExperimentFile {
    pub(super) fn get(&self, key: &str) -> Option<&Setting> {
        self.settings.get(key)
    }

    pub(super) fn text(&self, key: &str) -> Result<Option<&str>, FileError> {
        let Some(setting) = self.get(key) else { return Ok(None) };
        setting.value.as_str().map(Some).ok_or_else(|| wrong(key, setting, "text in quotes"))
    }

    pub(super) fn flag(&self, key: &str) -> Result<Option<bool>, FileError> {
        let Some(setting) = self.get(key) else { return Ok(None) };
        setting.value.as_bool().map(Some).ok_or_else(|| wrong(key, setting, "true or false"))
    }

    pub(super) fn integer(&self, key: &str, range: RangeInclusive<u64>) -> Result<Option<u64>, FileError> {
        let Some(setting) = self.get(key) else { return Ok(None) };
        let value = setting.value.as_integer().and_then(|value| u64::try_from(value).ok());
        value
            .filter(|value| range.contains(value))
            .map(Some)
            .ok_or_else(|| wrong(key, setting, &format!("a whole number from {} to {}", range.start(), range.end())))
    }

    /// Converts the value of a setting to a parameter. A TOML value with a fraction becomes a real number. Any other
    /// value must be a whole number.
    pub(super) fn parameter_value(&self, path: &str, setting: &Setting) -> Result<Number, FileError> {
        match &setting.value {
            Value::Float(number) if number.is_finite() => Ok(Number::Real(*number)),
            // The largest whole number of TOML is `i64::MAX`.
            _ => Ok(Number::Whole(self.integer(path, 0..=i64::MAX as u64)?.unwrap_or_default())),
        }
    }

    pub(super) fn number(&self, key: &str) -> Result<Option<f64>, FileError> {
        let Some(setting) = self.get(key) else { return Ok(None) };
        let value = setting.value.as_float().or(setting.value.as_integer().map(|value| value as f64));
        value.filter(|value| value.is_finite()).map(Some).ok_or_else(|| wrong(key, setting, "a number"))
    }

    pub(super) fn texts(&self, key: &str) -> Result<Option<Vec<String>>, FileError> {
        let Some(setting) = self.get(key) else { return Ok(None) };
        let list: Option<Option<Vec<String>>> =
            setting.value.as_array().map(|list| list.iter().map(|v| v.as_str().map(str::to_owned)).collect());
        list.flatten().map(Some).ok_or_else(|| wrong(key, setting, "a list of texts in quotes"))
    }

    /// Returns the named value that a key selects. A number selects the name with the same digits, so that `code =
    /// 1994` needs no quotes.
    pub(super) fn choice<T: Copy>(&self, key: &str, choices: &[(&str, T)]) -> Result<Option<T>, FileError> {
        let Some(setting) = self.get(key) else { return Ok(None) };
        let found = plain(&setting.value);
        if let Some((_, value)) = choices.iter().find(|(name, _)| *name == found) {
            return Ok(Some(*value));
        }
        let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
        let near = nearest(&found, names.iter().copied()).unwrap_or_default();
        Err(wrong(key, setting, &format!("one of {} (the nearest is {near})", names.join(", "))))
    }
}

/// Returns a TOML value as text without quotes.
pub(crate) fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

pub(super) fn wrong(key: &str, setting: &Setting, expected: &str) -> FileError {
    let found: String = setting.value.to_string().chars().take(60).collect();
    FileError::Value { place: setting.place.clone(), key: key.to_owned(), expected: expected.to_owned(), found }
}

/// Returns the path of a file whose name is relative to a folder.
pub(crate) fn beside(folder: &Path, name: &str) -> String {
    folder.join(name).display().to_string()
}
