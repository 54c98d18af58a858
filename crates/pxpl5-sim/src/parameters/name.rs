//! Conversion between values and their names, for types with a fixed list of named values.

use crate::parameters::SettingError;
use std::fmt;

/// Returns the value with the name `text` from a list of names and values.
///
/// # Errors
///
/// Returns [`SettingError`] if no value has the name. In the message, `what` is the kind of the value, such as
/// `pipeline`.
pub fn find_named<T>(
    what: &str,
    text: &str,
    all: impl IntoIterator<Item = (&'static str, T)>,
) -> Result<T, SettingError> {
    let mut valid = Vec::new();
    for (name, value) in all {
        if name == text {
            return Ok(value);
        }
        valid.push(name);
    }
    Err(SettingError::unknown(what, text, valid))
}

/// Writes the name of a value from a list of names and values. A value that is not in the list has an empty name.
///
/// # Errors
///
/// Returns an error only if the formatter returns an error.
pub fn write_name<T: PartialEq>(
    f: &mut fmt::Formatter<'_>,
    value: &T,
    all: impl IntoIterator<Item = (&'static str, T)>,
) -> fmt::Result {
    f.pad(all.into_iter().find(|(_, other)| other == value).map_or("", |(name, _)| name))
}

/// Implements `Display` and `FromStr` for a type whose values have names, from a list of names and values. The error of
/// `FromStr` is [`SettingError`].
///
/// ```
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// enum Eye {
///     Left,
///     Right,
/// }
///
/// pxpl5_sim::parameters::named!(Eye, "eye", [("left", Eye::Left), ("right", Eye::Right)]);
///
/// assert_eq!(Eye::Right.to_string().parse(), Ok(Eye::Right));
/// let error = "rihgt".parse::<Eye>().expect_err("no eye");
/// assert_eq!(error.to_string(), "expected right or left, found `rihgt`");
/// assert_eq!(&*error.nearest, "right");
/// ```
#[macro_export]
macro_rules! named {
    ($type:ty, $what:literal, $all:expr) => {
        impl ::std::fmt::Display for $type {
            fn fmt(&self, f: &mut ::std::fmt::Formatter<'_>) -> ::std::fmt::Result {
                $crate::parameters::write_name(f, self, $all)
            }
        }

        impl ::std::str::FromStr for $type {
            type Err = $crate::parameters::SettingError;

            fn from_str(text: &str) -> Result<Self, $crate::parameters::SettingError> {
                $crate::parameters::find_named($what, text, $all)
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_must_match_exactly() {
        let all = [("one", 1), ("two", 2)];
        assert_eq!(find_named("number", "two", all), Ok(2));
        for wrong in ["", "Two", " two", "two ", "tw"] {
            let error = find_named("number", wrong, all).expect_err(wrong);
            // The most similar name comes first. The distance of a name from an empty text is the length of the name.
            let expected = if wrong.is_empty() { "one or two" } else { "two or one" };
            assert_eq!(error.to_string(), format!("expected {expected}, found `{wrong}`"));
        }
    }
}
