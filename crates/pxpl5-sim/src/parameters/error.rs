use crate::parameters::{FileError, FileErrorKind, Value, nearest};
use std::fmt::{self, Display};

/// Largest number of valid names that the message of an error lists after the most similar name.
const MAX_LISTED: usize = 12;

/// Largest number of valid names that an error message lists if the message does not state the most similar name.
const FEW_NAMES: usize = 4;

/// Error of a setting or an argument that cannot be used. The message states where the setting was written, the name of
/// the setting, the expected value and the found value.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct SettingError {
    pub kind: SettingErrorKind,
    /// Place where the setting was written, such as a file with a line, or a command line option. Empty if the place is
    /// clear from the call.
    pub place: Box<str>,
    /// Name or path of the setting, such as `ring.word_ns`. For an unknown name, this text is the kind of thing that
    /// the name should denote, such as `pipeline`.
    pub name: Box<str>,
    /// The expected value in words, such as `a whole number of 1 to 4096 lines`.
    pub expected: Box<str>,
    /// The value or name that the user wrote.
    pub found: Box<str>,
    /// Valid name that is most similar to the unknown name. Empty if the error is not about an unknown name.
    pub nearest: Box<str>,
}

/// The kind of a [`SettingError`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SettingErrorKind {
    /// The value is not one of the expected values.
    Value,
    /// A number lies outside its limits, or is not whole.
    Limits,
    /// A name denotes nothing, for example a pipeline that does not exist.
    UnknownName,
    /// The setting is a fixed property of a chip. Programs can read the property but cannot change the property.
    ReadOnly,
    Missing,
    /// Two settings exclude each other, or a setting does not apply to the experiment. This kind is also for faults of
    /// a setting's text that no other kind describes.
    Combination,
    Scene,
    /// A file that the setting names cannot be used.
    File(FileErrorKind),
}

impl SettingError {
    fn new(kind: SettingErrorKind, name: &str, expected: impl Display, found: impl Display) -> Self {
        let [expected, found] = [expected.to_string().into(), found.to_string().into()];
        Self { kind, place: "".into(), name: name.into(), expected, found, nearest: "".into() }
    }

    /// Creates the error for a wrong value of the setting `name`. The message is `name: expected ..., found ...`.
    pub fn value(name: &str, expected: impl Display, found: impl Display) -> Self {
        Self::new(SettingErrorKind::Value, name, expected, found)
    }

    /// Creates the error of a text that has the wrong form as a whole. The message is `expected ..., found "..."`.
    pub fn text(expected: impl Display, text: &str) -> Self {
        Self::value("", expected, format_args!("{text:?}"))
    }

    /// Creates the error of a number outside its limits. The message is `name must be LOW to HIGH, found ...`.
    pub fn limits<N: Display>(name: &str, (low, high): (N, N), found: impl Display) -> Self {
        Self::new(SettingErrorKind::Limits, name, format_args!("{low} to {high}"), found)
    }

    /// Creates the error of a number with a fraction or a sign, for a setting that must be a whole number.
    pub fn not_whole(name: &str, found: impl Display) -> Self {
        Self::new(SettingErrorKind::Limits, name, "a whole number", found)
    }

    /// Creates the error of a name that denotes nothing. `what` is the kind of thing that the name should denote, such
    /// as `pipeline`.
    ///
    /// The message states the most similar name first, then all valid names unless there are many.
    #[must_use]
    pub fn unknown<S: AsRef<str>>(what: &str, found: &str, valid: impl IntoIterator<Item = S>) -> Self {
        let valid: Vec<S> = valid.into_iter().collect();
        let mut names: Vec<&str> = valid.iter().map(AsRef::as_ref).collect();
        let near = nearest(found, names.iter().copied()).unwrap_or_default();
        // A message that only lists a few names lists the most similar name first.
        if names.len() <= FEW_NAMES {
            names.sort_by_key(|name| *name != near);
        }
        let expected = match names.as_slice() {
            [first @ .., last] if (1..MAX_LISTED).contains(&first.len()) => format!("{} or {last}", first.join(", ")),
            [only] => (*only).to_owned(),
            _ => String::new(),
        };
        Self { nearest: near.into(), ..Self::new(SettingErrorKind::UnknownName, what, expected, found) }
    }

    /// Creates the error of a path, such as `ring.word_ns`, that no setting has. The message states only the most
    /// similar valid path.
    #[must_use]
    pub fn unknown_path<S: AsRef<str>>(what: &str, found: &str, valid: impl IntoIterator<Item = S>) -> Self {
        Self { expected: "".into(), ..Self::unknown(what, found, valid) }
    }

    /// Creates the error of an attempt to change a parameter that is a fixed property of a chip. `origin` is the source
    /// of the fixed value.
    pub fn read_only(path: &str, value: Value, origin: &str) -> Self {
        Self::new(SettingErrorKind::ReadOnly, path, origin, value)
    }

    /// Creates the error of a missing setting. `how` describes the setting with an example of a value.
    pub fn missing(name: &str, how: impl Display) -> Self {
        Self::new(SettingErrorKind::Missing, name, how, "")
    }

    /// Creates the error of settings that exclude each other, or of a setting that does not apply. `reason` is a
    /// sentence with the expected and the found values.
    pub fn combination(reason: impl Display) -> Self {
        Self::new(SettingErrorKind::Combination, "", "", reason)
    }

    /// Creates the error of a scene that its reader cannot use. `part` is the name of the scene and the wrong part.
    pub fn scene(part: &str, expected: impl Display, found: impl Display) -> Self {
        Self::new(SettingErrorKind::Scene, part, expected, found)
    }

    /// Returns `Ok` if `holds` is true, otherwise the error of a wrong value of the setting `name`.
    ///
    /// # Errors
    ///
    /// Returns the error of [`SettingError::value`] if `holds` is false.
    pub fn require(holds: bool, name: &str, expected: impl Display, found: impl Display) -> Result<(), Self> {
        if holds { Ok(()) } else { Err(Self::value(name, expected, found)) }
    }

    /// Adds to the message the place where the setting was written: a file with a line, or a command line option. An
    /// empty place adds nothing.
    #[must_use]
    pub fn at(self, place: impl Display) -> Self {
        match place.to_string() {
            place if place.is_empty() => self,
            place => Self { place: joined(place, ": ", &self.place), ..self },
        }
    }

    /// Adds the name of a table of parameters to the name of the setting: `word_ns` in the table `ring` becomes
    /// `ring.word_ns`.
    #[must_use]
    pub fn in_table(self, table: impl Display) -> Self {
        Self { name: joined(table, ".", &self.name), ..self }
    }
}

fn joined(first: impl Display, separator: &str, second: &str) -> Box<str> {
    if second.is_empty() { first.to_string().into() } else { format!("{first}{separator}{second}").into() }
}

impl fmt::Display for SettingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, place, name, expected, found, nearest } = self;
        if !place.is_empty() {
            write!(f, "{place}: ")?;
        }
        match kind {
            SettingErrorKind::Limits => write!(f, "{name} must be {expected}, found {found}"),
            SettingErrorKind::UnknownName if nearest.is_empty() => write!(f, "there is no {name} `{found}`"),
            // The first of a few names is the most similar.
            SettingErrorKind::UnknownName if !expected.is_empty() && expected.matches(", ").count() < FEW_NAMES - 1 => {
                write!(f, "expected {expected}, found `{found}`")
            }
            SettingErrorKind::UnknownName => {
                write!(f, "there is no {name} `{found}`; did you mean `{nearest}`?")?;
                if expected.is_empty() { Ok(()) } else { write!(f, " (expected {expected})") }
            }
            SettingErrorKind::ReadOnly => {
                write!(f, "{name} is {found} in every machine ({expected}); it is listed, but cannot be set")
            }
            SettingErrorKind::Missing => write!(f, "{name} is missing: give {expected}"),
            _ if expected.is_empty() => f.write_str(found),
            _ if name.is_empty() => write!(f, "expected {expected}, found {found}"),
            _ => write!(f, "{name}: expected {expected}, found {found}"),
        }
    }
}

impl std::error::Error for SettingError {}

impl From<FileError> for SettingError {
    fn from(error: FileError) -> Self {
        Self::new(SettingErrorKind::File(error.kind), "", "", error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_message_states_place_name_expected_and_found_value() {
        let value = SettingError::value("line rate", "300 to 115200", f64::NAN);
        assert_eq!(value.to_string(), "line rate: expected 300 to 115200, found NaN");
        let limits = SettingError::limits("word_ns", (1, 9), 10).in_table("ring").at("--set");
        assert_eq!(limits.to_string(), "--set: ring.word_ns must be 1 to 9, found 10");
        assert_eq!(SettingError::not_whole("n", 0.5).to_string(), "n must be a whole number, found 0.5");
        assert_eq!(
            SettingError::value("", "a text", 1).at("line 2").at("f").to_string(),
            "f: line 2: expected a text, found 1"
        );
        let clock = SettingError::read_only("i860.chip.clock", Value::Whole(40), "data sheet");
        assert!(clock.to_string().starts_with("i860.chip.clock is 40 in every machine (data sheet);"), "{clock}");
        assert_eq!(SettingError::missing("scene", "a scene").to_string(), "scene is missing: give a scene");
    }

    #[test]
    fn the_error_suggests_the_nearest_name_and_lists_all_names_only_if_the_list_is_short() {
        let short = SettingError::unknown("level", "cycles", ["analytic", "transaction", "cycle"]);
        assert_eq!(short.to_string(), "expected cycle, analytic or transaction, found `cycles`");
        assert_eq!(&*short.nearest, "cycle");
        let letters = ["a1", "b1", "c1", "d1", "e1", "f1", "g1", "h1", "i1", "j1", "k1", "l1", "m1"];
        let some = SettingError::unknown("letter", "c2", &letters[..5]);
        assert_eq!(some.to_string(), "there is no letter `c2`; did you mean `c1`? (expected a1, b1, c1, d1 or e1)");
        let long = SettingError::unknown("letter", "k2", letters);
        assert_eq!(long.to_string(), "there is no letter `k2`; did you mean `k1`?");
        let path = SettingError::unknown_path("key", "titel", ["title", "fields"]);
        assert_eq!(path.to_string(), "there is no key `titel`; did you mean `title`?");
        assert_eq!(SettingError::unknown("letter", "a", ["b"]).to_string(), "expected b, found `a`");
        let none: [&str; 0] = [];
        assert_eq!(SettingError::unknown("letter", "a", none).to_string(), "there is no letter `a`");
    }
}
