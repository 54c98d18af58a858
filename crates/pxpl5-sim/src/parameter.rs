//! Numbers with unit, source and standing: a table declares them once, code reads them as plain fields, and
//! reports, sweeps and configuration files reach them by name.

use serde::{Deserialize, Serialize};
use std::fmt;

/// How well a number is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Standing {
    /// Printed in a paper that we have read.
    Published,
    /// Follows by arithmetic from published figures.
    Derived,
    /// Engineering judgement, with the range that the published figures allow.
    Assumed,
}

impl fmt::Display for Standing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Published => "published",
            Self::Derived => "derived",
            Self::Assumed => "assumed",
        })
    }
}

/// One number of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ParameterInfo {
    /// Field name within its table.
    pub name: &'static str,
    /// Unit of the value.
    pub unit: &'static str,
    /// How well it is known.
    pub standing: Standing,
    /// Smallest and largest value that the sources allow.
    pub range: (u64, u64),
    /// Where it comes from: a paper's short name, a formula or a reason.
    pub source: &'static str,
}

/// A parameter that could not be read or set.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ParameterError {
    /// No parameter has this name.
    Unknown {
        /// The name that was asked for.
        name: String,
        /// The valid names.
        valid: Vec<&'static str>,
    },
}

impl fmt::Display for ParameterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown { name, valid } => {
                write!(f, "there is no parameter `{name}`; expected one of {}", valid.join(", "))
            }
        }
    }
}

impl std::error::Error for ParameterError {}

/// A table made by [`crate::parameter_table`].
pub trait ParameterTable {
    /// What is known of each number, in order.
    fn infos() -> &'static [ParameterInfo];

    /// The value of a parameter.
    ///
    /// # Errors
    ///
    /// [`ParameterError::Unknown`] when no parameter has this name.
    fn get(&self, name: &str) -> Result<u64, ParameterError>;

    /// Changes a parameter.
    ///
    /// # Errors
    ///
    /// [`ParameterError::Unknown`] when no parameter has this name.
    fn set(&mut self, name: &str, value: u64) -> Result<(), ParameterError>;
}

/// Declares a struct of `u64` numbers, each with its preset value, unit, standing, allowed range and source.
///
/// ```
/// pxpl5_sim::parameter_table! {
///     /// Times of a channel.
///     pub struct ChannelTiming {
///         /// Time of one word.
///         word_ns: 50, "ns", Published, 50..=50, "TR94";
///         /// Latency of one hop.
///         hop_ns: 50, "ns", Assumed, 0..=200, "one word time";
///     }
/// }
/// use pxpl5_sim::ParameterTable;
/// let mut timing = ChannelTiming::PAPERS;
/// timing.set("hop_ns", 100).unwrap();
/// assert_eq!((timing.word_ns, timing.hop_ns), (50, 100));
/// ```
#[macro_export]
macro_rules! parameter_table {
    ($(#[$meta:meta])* $vis:vis struct $name:ident {
        $($(#[$doc:meta])* $field:ident : $value:expr, $unit:literal, $standing:ident, $low:literal ..= $high:literal, $source:literal;)*
    }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ::serde::Serialize, ::serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        $vis struct $name {
            $($(#[$doc])* #[doc = concat!("\n\nUnit: ", $unit, ". ", stringify!($standing), ", ", stringify!($low), " to ", stringify!($high), ": ", $source, ".")] pub $field: u64,)*
        }

        impl $name {
            /// The values that the papers give or allow.
            $vis const PAPERS: Self = Self { $($field: $value,)* };
        }

        impl $crate::ParameterTable for $name {
            fn infos() -> &'static [$crate::ParameterInfo] {
                &[$($crate::ParameterInfo {
                    name: stringify!($field), unit: $unit, standing: $crate::Standing::$standing,
                    range: ($low, $high), source: $source,
                },)*]
            }

            fn get(&self, name: &str) -> Result<u64, $crate::ParameterError> {
                match name {
                    $(stringify!($field) => Ok(self.$field),)*
                    _ => Err($crate::ParameterError::Unknown { name: name.to_owned(), valid: vec![$(stringify!($field)),*] }),
                }
            }

            fn set(&mut self, name: &str, value: u64) -> Result<(), $crate::ParameterError> {
                match name {
                    $(stringify!($field) => self.$field = value,)*
                    _ => return Err($crate::ParameterError::Unknown { name: name.to_owned(), valid: vec![$(stringify!($field)),*] }),
                }
                Ok(())
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    crate::parameter_table! {
        /// For the test.
        struct Table {
            /// A time.
            word_ns: 50, "ns", Published, 50..=50, "TR94";
            /// A cost.
            send_ns: 12_000, "ns", Assumed, 10_000..=25_000, "a reason";
        }
    }

    #[test]
    fn a_parameter_is_reached_by_name_and_an_unknown_name_lists_the_valid_ones() {
        let mut table = Table::PAPERS;
        table.set("send_ns", 10_000).expect("known");
        assert_eq!(table.get("send_ns"), Ok(10_000));
        let error = table.set("sned_ns", 1).expect_err("unknown");
        assert_eq!(error.to_string(), "there is no parameter `sned_ns`; expected one of word_ns, send_ns");
    }

    #[test]
    fn every_preset_lies_in_its_allowed_range() {
        for info in Table::infos() {
            let value = Table::PAPERS.get(info.name).expect("listed");
            assert!((info.range.0..=info.range.1).contains(&value), "{}", info.name);
        }
    }
}
