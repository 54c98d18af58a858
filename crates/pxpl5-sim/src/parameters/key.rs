use crate::parameters::SettingError;
use std::fmt;
use std::sync::Arc;

/// The value of a setting (key).
#[derive(Clone, Debug, PartialEq)]
pub enum KeyValue {
    Flag(bool),
    /// A whole number within the range that the key allows.
    Whole(u64),
    /// A real number within the range that the key allows.
    Real(f64),
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
            Self::Real(number) => number.fmt(f),
            Self::Name(name) => name.fmt(f),
            Self::Text(text) => text.fmt(f),
        }
    }
}

/// The values that a [`Key`] permits.
#[derive(Clone, Copy, Debug)]
pub enum KeyValues {
    Flag,
    /// The key allows whole numbers from the first number to the second number, inclusive.
    Whole(u64, u64),
    /// The key allows real numbers from the first number to the second number, inclusive.
    Real(f64, f64),
    Names(&'static [&'static str]),
    /// The key allows texts of a certain form. The first value describes the form in words and may be empty. The second
    /// value checks a text.
    Text(&'static str, fn(&str) -> Result<(), SettingError>),
}

impl KeyValues {
    /// Any text, which other settings or files restrict further.
    pub const ANY: Self = Self::Text("", |_| Ok(()));
    pub const NUMBER: Self = Self::Real(f64::MIN, f64::MAX);
}

impl fmt::Display for KeyValues {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flag => f.write_str("true or false"),
            Self::Whole(low, high) => write!(f, "{low} to {high}"),
            Self::Real(f64::MIN, f64::MAX) => f.write_str("any number"),
            Self::Real(low, high) => write!(f, "{low} to {high}"),
            Self::Text(form, _) => f.write_str(form),
            Self::Names([]) => Ok(()),
            Self::Names([name]) => f.write_str(name),
            Self::Names([first @ .., last]) => write!(f, "{} or {last}", first.join(", ")),
        }
    }
}

/// A setting: `name = value` in experiment files.
///
/// The settings of pipelines are also options `--name value` of commands.
///
/// ```
/// use pxpl5_sim::parameters::{Key, KeyValues};
///
/// let near = Key::new("near", "nothing nearer is drawn", KeyValues::Real(0.0, 9.0)).with_unit("m").with_default("0.05");
/// assert_eq!(near.help(), "nothing nearer is drawn; 0 to 9 m; default 0.05");
/// assert_eq!(near.expected(), "a number from 0 to 9 m");
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Name in experiment files. On the command line, `-` replaces `_`.
    pub name: &'static str,
    pub about: &'static str,
    pub values: KeyValues,
    /// Unit of a number, or an empty text.
    pub unit: &'static str,
    /// Default value with its provenance, in words. Empty if the key has no default, if the default depends on the
    /// pipeline, or if [`Key::about`] states the default.
    pub default: &'static str,
    /// Paths of machine parameters that the key sets too. A user must not set both the key and one of these parameters.
    pub sets: &'static [&'static str],
}

impl Key {
    /// Creates a key that states no unit and no default.
    pub const fn new(name: &'static str, about: &'static str, values: KeyValues) -> Self {
        Self { name, about, values, unit: "", default: "", sets: &[] }
    }

    /// Sets the unit of the number.
    #[must_use]
    pub const fn with_unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// Sets the text of the default.
    #[must_use]
    pub const fn with_default(self, default: &'static str) -> Self {
        Self { default, ..self }
    }

    /// Returns the meaning, the allowed values, the unit and the default in one line. Names that the meaning explains
    /// are not repeated.
    pub fn help(&self) -> String {
        let Self { about, values, unit, default, .. } = self;
        let allowed = match values {
            KeyValues::Names(names) if names.iter().all(|name| about.contains(name)) => String::new(),
            _ => with_unit(values.to_string(), unit),
        };
        let default = if default.is_empty() { String::new() } else { format!("default {default}") };
        let parts = [(*about).to_owned(), allowed, default].into_iter().filter(|part| !part.is_empty());
        parts.collect::<Vec<_>>().join("; ")
    }

    /// Returns the allowed values in words, for error messages.
    pub fn expected(&self) -> String {
        match self.values {
            KeyValues::Whole(low, high) => with_unit(format!("a whole number from {low} to {high}"), self.unit),
            KeyValues::Real(f64::MIN, f64::MAX) => with_unit("a number".to_owned(), self.unit),
            KeyValues::Real(low, high) => with_unit(format!("a number from {low} to {high}"), self.unit),
            values => values.to_string(),
        }
    }
}

fn with_unit(text: String, unit: &str) -> String {
    if unit.is_empty() { text } else { format!("{text} {unit}") }
}

pub const fn names<T, const N: usize>(all: &[(&'static str, T); N]) -> [&'static str; N] {
    let mut names = [""; N];
    let mut i = 0;
    while i < N {
        names[i] = all[i].0;
        i += 1;
    }
    names
}
