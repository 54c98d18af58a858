//! Values with names: conversion from and to a name, and the error for an unknown name.

use crate::parameters::nearest;
use std::error::Error;
use std::fmt;

/// Largest number of names that an error lists. For a longer list, the error states only the most similar name.
const MAX_LISTED: usize = 12;

/// An error for a text that is not one of the valid names.
///
/// The message lists the valid names. If there are more than 12 names, the message states only the most similar name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NameError {
    /// Kind of thing that has such names, such as `pipeline`.
    pub what: &'static str,
    /// Text that is not a valid name.
    pub found: String,
    /// All valid names.
    pub valid: Vec<&'static str>,
}

impl NameError {
    /// Creates the error for a text that is none of the valid names.
    #[must_use]
    pub fn new(what: &'static str, found: &str, valid: impl IntoIterator<Item = &'static str>) -> Self {
        Self { what, found: found.to_owned(), valid: valid.into_iter().collect() }
    }

    /// Returns the valid name that is most similar to the given text. Returns an empty text if there are no names.
    #[must_use]
    pub fn nearest(&self) -> &'static str {
        nearest(&self.found, self.valid.iter().copied()).unwrap_or_default()
    }
}

impl fmt::Display for NameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, found, valid } = self;
        match valid.as_slice() {
            [] => write!(f, "there is no {what} `{found}`"),
            [only] => write!(f, "expected {only}, found `{found}`"),
            [first @ .., last] if valid.len() <= MAX_LISTED => {
                write!(f, "expected {} or {last}, found `{found}`", first.join(", "))
            }
            _ => write!(f, "there is no {what} `{found}`; did you mean `{}`?", self.nearest()),
        }
    }
}

impl Error for NameError {}

/// Returns the value with the name `text` from a list of names and values.
///
/// # Errors
///
/// Returns [`NameError`] if no value has the name. The message uses `what` as the kind of value.
pub fn find_named<T>(
    what: &'static str,
    text: &str,
    all: impl IntoIterator<Item = (&'static str, T)>,
) -> Result<T, NameError> {
    let mut valid = Vec::new();
    for (name, value) in all {
        if name == text {
            return Ok(value);
        }
        valid.push(name);
    }
    Err(NameError { what, found: text.to_owned(), valid })
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
/// `FromStr` is [`NameError`].
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
/// assert_eq!(error.to_string(), "expected left or right, found `rihgt`");
/// assert_eq!(error.nearest(), "right");
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
            type Err = $crate::parameters::NameError;

            fn from_str(text: &str) -> Result<Self, $crate::parameters::NameError> {
                $crate::parameters::find_named($what, text, $all)
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_list_is_printed_and_a_long_list_is_replaced_by_the_nearest_name() {
        let short = NameError::new("level", "cycles", ["analytic", "transaction", "cycle"]);
        assert_eq!(short.to_string(), "expected analytic, transaction or cycle, found `cycles`");
        let letters = ["a1", "b1", "c1", "d1", "e1", "f1", "g1", "h1", "i1", "j1", "k1", "l1", "m1"];
        let long = NameError::new("letter", "k2", letters);
        assert_eq!(long.to_string(), "there is no letter `k2`; did you mean `k1`?");
        assert_eq!(NameError::new("letter", "a", ["b"]).to_string(), "expected b, found `a`");
        assert_eq!(NameError::new("letter", "a", []).to_string(), "there is no letter `a`");
    }

    #[test]
    fn a_name_is_found_exactly_or_not_at_all() {
        let all = [("one", 1), ("two", 2)];
        assert_eq!(find_named("number", "two", all), Ok(2));
        for wrong in ["", "Two", " two", "two ", "tw"] {
            let error = find_named("number", wrong, all).expect_err(wrong);
            assert_eq!((error.what, error.found.as_str(), error.valid), ("number", wrong, vec!["one", "two"]));
        }
    }
}
