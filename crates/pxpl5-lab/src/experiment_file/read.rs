//! Typed reading of settings.

use super::{ExperimentFile, FileError, Setting};
use parameters::nearest;
use std::ops::RangeInclusive;
use std::path::Path;
use toml::Value;

impl ExperimentFile {
    pub(super) fn get(&self, key: &str) -> Option<&Setting> {
        self.settings.get(key)
    }

    pub(super) fn text(&self, key: &str) -> Result<Option<&str>, FileError> {
        let text = |setting: &'_ Setting| -> Result<(), FileError> {
            setting.value.as_str().map(|_| ()).ok_or_else(|| wrong(key, setting, "text in quotes"))
        };
        self.get(key).map_or(Ok(()), text)?;
        Ok(self.get(key).and_then(|setting| setting.value.as_str()))
    }

    pub(super) fn flag(&self, key: &str) -> Result<Option<bool>, FileError> {
        let flag = |setting: &Setting| setting.value.as_bool().ok_or_else(|| wrong(key, setting, "true or false"));
        self.get(key).map(flag).transpose()
    }

    pub(super) fn integer(&self, key: &str, range: RangeInclusive<u64>) -> Result<Option<u64>, FileError> {
        let integer = |setting: &Setting| {
            let value = setting.value.as_integer().and_then(|value| u64::try_from(value).ok());
            let expected = || wrong(key, setting, &format!("a whole number from {} to {}", range.start(), range.end()));
            value.filter(|value| range.contains(value)).ok_or_else(expected)
        };
        self.get(key).map(integer).transpose()
    }

    pub(super) fn number(&self, key: &str) -> Result<Option<f64>, FileError> {
        let number = |setting: &Setting| {
            let value = setting.value.as_float().or(setting.value.as_integer().map(|value| value as f64));
            value.filter(|value| value.is_finite()).ok_or_else(|| wrong(key, setting, "a number"))
        };
        self.get(key).map(number).transpose()
    }

    pub(super) fn texts(&self, key: &str) -> Result<Option<Vec<String>>, FileError> {
        let texts = |setting: &Setting| {
            let list =
                setting.value.as_array().map(|list| list.iter().map(|v| v.as_str().map(str::to_owned)).collect());
            list.flatten().ok_or_else(|| wrong(key, setting, "a list of texts in quotes"))
        };
        self.get(key).map(texts).transpose()
    }

    /// One of some names; a number is taken by its digits, so that `code = 1994` needs no quotes.
    pub(super) fn choice<T: Copy>(&self, key: &str, choices: &[(&str, T)]) -> Result<Option<T>, FileError> {
        let choice = |setting: &Setting| {
            let found = plain(&setting.value);
            let chosen = choices.iter().find(|(name, _)| *name == found).map(|(_, value)| *value);
            chosen.ok_or_else(|| {
                let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
                let near = nearest(&found, names.iter().copied()).unwrap_or_default();
                wrong(key, setting, &format!("one of {} (the nearest is {near})", names.join(", ")))
            })
        };
        self.get(key).map(choice).transpose()
    }
}

/// A value without quotes.
pub(crate) fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

pub(super) fn wrong(key: &str, setting: &Setting, expected: &str) -> FileError {
    let found: String = setting.value.to_string().chars().take(60).collect();
    FileError::Value { place: setting.place.clone(), key: key.to_owned(), expected: expected.to_owned(), found }
}

/// A file beside others in a folder.
pub(super) fn beside(folder: &Path, name: &str) -> String {
    folder.join(name).display().to_string()
}
