//! Typed access to the settings of an experiment file.

use super::{ExperimentFile, Setting};
use crate::head_parts;
use pxpl5_sim::parameters::{Key, KeyValue, KeyValues, SettingError, Value as Number};
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

    pub(super) fn value(&self, key: &Key) -> Result<Option<KeyValue>, SettingError> {
        let Some(setting) = self.get(key.name) else { return Ok(None) };
        let value = &setting.value;
        let value = match key.values {
            KeyValues::Flag => value.as_bool().map(KeyValue::Flag),
            KeyValues::Whole(low, high) => {
                let whole = value.as_integer().and_then(|value| u64::try_from(value).ok());
                whole.filter(|whole| (low..=high).contains(whole)).map(KeyValue::Whole)
            }
            KeyValues::Real(low, high) => {
                let real = value.as_float().or(value.as_integer().map(|value| value as f64));
                real.filter(|real| (low..=high).contains(real)).map(KeyValue::Real)
            }
            KeyValues::Names(names) => {
                let choices: Vec<(&str, &'static str)> = names.iter().map(|name| (*name, *name)).collect();
                self.choice(key.name, &choices)?.map(KeyValue::Name)
            }
            KeyValues::Text(_, check) => {
                let text = plain(value);
                check(&text).is_ok().then(|| KeyValue::Text(text.into()))
            }
        };
        value.map(Some).ok_or_else(|| wrong(key.name, setting, &key.expected()))
    }

    /// Converts the value of a setting to a parameter. A TOML value with a fraction becomes a real number. Any other
    /// value must be a whole number.
    pub(super) fn parameter_value(path: &str, setting: &Setting) -> Result<Number, SettingError> {
        match &setting.value {
            Value::Float(number) if number.is_finite() => Ok(Number::Real(*number)),
            // The largest whole number of TOML is `i64::MAX`.
            value => value
                .as_integer()
                .and_then(|whole| u64::try_from(whole).ok())
                .map(Number::Whole)
                .ok_or_else(|| wrong(path, setting, &format!("a whole number from 0 to {}", i64::MAX))),
        }
    }

    pub(super) fn texts(&self, key: &str) -> Result<Option<Vec<String>>, SettingError> {
        let Some(setting) = self.get(key) else { return Ok(None) };
        let list: Option<Option<Vec<String>>> =
            setting.value.as_array().map(|list| list.iter().map(|v| v.as_str().map(str::to_owned)).collect());
        list.flatten().map(Some).ok_or_else(|| wrong(key, setting, "a list of texts in quotes"))
    }

    /// Returns the value with this name in `choices`. A number selects the name with the same digits, so that `code =
    /// 1994` needs no quotes.
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

pub(super) fn unknown<'a>(key: &str, setting: &Setting, valid: impl IntoIterator<Item = &'a str>) -> SettingError {
    let what = key.rsplit('.').next().unwrap_or(key);
    let found: String = plain(&setting.value).chars().take(60).collect();
    let names: Vec<&str> = valid.into_iter().collect();
    let error = head_parts::unknown(what, &found, names.iter().copied(), &format!("one of {}", names.join(", ")));
    error.at(setting.place_of(key))
}

/// Creates the error of a key that does not apply to the chosen pipeline. `applies_to` names the pipelines to which the
/// key applies.
pub(super) fn not_applicable(key: &str, pipeline: &str, applies_to: &str) -> SettingError {
    SettingError::combination(format_args!(
        "{key} does not apply to the pipeline {pipeline}; leave it out (it is for {applies_to})"
    ))
}

pub(crate) fn beside(folder: &Path, name: &str) -> String {
    folder.join(name).display().to_string()
}
