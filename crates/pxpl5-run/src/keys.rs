//! The keys of pipelines: what experiment files and the command line may set of them.

use address_recalculation::{ArpError, Lens};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// The value of a pipeline's key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum KeyValue {
    /// Whether something is done: true or false.
    Flag(bool),
    /// A whole number within the range of its key.
    Whole(u64),
    /// One of some names.
    Name(&'static str),
    /// A text in the form of its key.
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

/// The values that a key takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyValues {
    /// It takes true or false.
    Flag,
    /// Whole numbers from the first to the second.
    Whole(u64, u64),
    /// It takes one of these names.
    Names(&'static [&'static str]),
    /// It takes the text of a [`Lens`].
    Lens,
}

impl KeyValues {
    /// The value of a text for a key that takes a lens.
    ///
    /// # Errors
    ///
    /// [`ArpError::Lens`] with the texts that it takes.
    pub fn lens(text: &str) -> Result<KeyValue, ArpError> {
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

/// A key of a pipeline: in experiment files `name = value`, on the command line `--name value`.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Its name in experiment files; on the command line `_` is written `-`.
    pub name: &'static str,
    /// What it sets, in a line of help.
    pub about: &'static str,
    /// Which values it takes, with their range.
    pub values: KeyValues,
    /// Machine parameters that it sets too, and that must therefore not be given beside it.
    pub sets: &'static [&'static str],
}

/// The keys of a pipeline that somebody has given, checked against its [`Key`]s.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PipelineSettings {
    values: BTreeMap<&'static str, KeyValue>,
}

impl PipelineSettings {
    /// Gives a key a value.
    pub fn set(&mut self, key: &'static str, value: KeyValue) {
        self.values.insert(key, value);
    }

    /// The value of a key that takes true or false; `None` if it was not given.
    #[must_use]
    pub fn flag(&self, key: &str) -> Option<bool> {
        if let Some(KeyValue::Flag(flag)) = self.values.get(key) { Some(*flag) } else { None }
    }

    /// The value of a key that takes whole numbers; `None` if it was not given.
    #[must_use]
    pub fn whole(&self, key: &str) -> Option<u64> {
        if let Some(KeyValue::Whole(number)) = self.values.get(key) { Some(*number) } else { None }
    }

    /// The value of a key that takes a lens; `None` if it was not given.
    #[must_use]
    pub fn lens(&self, key: &str) -> Option<Lens> {
        if let Some(KeyValue::Text(text)) = self.values.get(key) { text.parse().ok() } else { None }
    }

    /// The value of a key that takes names; `None` if it was not given.
    #[must_use]
    pub fn name(&self, key: &str) -> Option<&'static str> {
        if let Some(KeyValue::Name(name)) = self.values.get(key) { Some(name) } else { None }
    }
}
