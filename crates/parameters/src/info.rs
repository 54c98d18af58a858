//! What is known of a number besides its value.

use crate::Value;
use serde::{Deserialize, Serialize};
use std::fmt;

/// How well a number is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Standing {
    /// Printed in a paper or manual that we have read.
    Published,
    /// Follows by arithmetic from published figures.
    Derived,
    /// Recollection or engineering judgement, with the range that the published figures allow.
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

/// What is known of one number of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ParameterInfo {
    /// Field name within its table.
    pub name: &'static str,
    /// Unit of value, range and limits; "1" for a pure number.
    pub unit: &'static str,
    /// How well the value is known.
    pub standing: Standing,
    /// The value that the papers give or allow: what a table holds before anybody changes it.
    pub papers: Value,
    /// Smallest and largest value that the sources allow.
    pub range: (Value, Value),
    /// Smallest and largest value that the model can take.
    pub limits: (Value, Value),
    /// Where it comes from: a paper's short name, a formula or a reason.
    pub source: &'static str,
}

impl ParameterInfo {
    /// The range of a whole number; `None` for a real one.
    #[must_use]
    pub fn whole_range(&self) -> Option<(u64, u64)> {
        match self.range {
            (Value::Whole(low), Value::Whole(high)) => Some((low, high)),
            _ => None,
        }
    }
}
