//! Keys: the settings of pipelines that experiment files and the command line can change.

use address_recalculation::Lens;
use pxpl5_sim::parameters::SettingError;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// The value of a key, which is a setting of a pipeline.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum KeyValue {
    /// A choice between true and false.
    Flag(bool),
    /// A whole number within the range that the key allows.
    Whole(u64),
    /// One of the names that the key allows.
    Name(&'static str),
    /// A text in the format that the key requires.
    Text(Arc<str>),
}

impl fmt::Display for KeyValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flag(flag) => flag.fmt(f),
            Self::Whole(number) => number.fmt(f),
            Self::Name(name) => name.fmt(f),
            Self::Text(text) => text.fmt(f),
        }
    }
}

/// The values that a key allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyValues {
    /// The values true and false.
    Flag,
    /// Whole numbers from the first number to the second number, inclusive.
    Whole(u64, u64),
    /// One of these names.
    Names(&'static [&'static str]),
    /// The text form of a [`Lens`].
    Lens,
}

impl KeyValues {
    /// Parses the text form of a lens into the value of a key.
    ///
    /// # Errors
    ///
    /// [`SettingError`] with the allowed texts.
    pub fn lens(text: &str) -> Result<KeyValue, SettingError> {
        text.parse::<Lens>()?;
        Ok(KeyValue::Text(text.into()))
    }
}

impl fmt::Display for KeyValues {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flag => f.write_str("true or false"),
            Self::Whole(low, high) => write!(f, "{low} to {high}"),
            Self::Lens => f.write_str(Lens::FORMS),
            Self::Names([]) => Ok(()),
            Self::Names([name]) => f.write_str(name),
            Self::Names([first @ .., last]) => write!(f, "{} or {last}", first.join(", ")),
        }
    }
}

/// A setting of a pipeline: `name = value` in experiment files, `--name value` on the command line.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Name in experiment files. On the command line, `-` replaces `_`.
    pub name: &'static str,
    /// Help text of the key, in one line.
    pub about: &'static str,
    /// Values that the key allows.
    pub values: KeyValues,
    /// Paths of the machine parameters that the key changes. An experiment must not set both the key and such a
    /// parameter.
    pub sets: &'static [&'static str],
}

/// Values of the keys that the user has set. Each value must have been checked against its [`Key`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PipelineSettings {
    values: BTreeMap<&'static str, KeyValue>,
}

impl PipelineSettings {
    /// Sets the value of a key.
    pub fn set(&mut self, key: &'static str, value: KeyValue) {
        self.values.insert(key, value);
    }

    /// Returns the value of a true-or-false key, or `None` if the user did not set the key.
    #[must_use]
    pub fn flag(&self, key: &str) -> Option<bool> {
        if let Some(KeyValue::Flag(flag)) = self.values.get(key) { Some(*flag) } else { None }
    }

    /// Returns the value of a whole-number key, or `None` if the user did not set the key.
    #[must_use]
    pub fn whole(&self, key: &str) -> Option<u64> {
        if let Some(KeyValue::Whole(number)) = self.values.get(key) { Some(*number) } else { None }
    }

    /// Returns the value of a lens key, or `None` if the user did not set the key.
    #[must_use]
    pub fn lens(&self, key: &str) -> Option<Lens> {
        if let Some(KeyValue::Text(text)) = self.values.get(key) { text.parse().ok() } else { None }
    }

    /// Returns the value of a key with named values, or `None` if the user did not set the key.
    #[must_use]
    pub fn name(&self, key: &str) -> Option<&'static str> {
        if let Some(KeyValue::Name(name)) = self.values.get(key) { Some(name) } else { None }
    }
}
