//! Unit, provenance, range and source of a number.

use crate::Value;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The provenance of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Standing {
    /// Printed in a paper or manual that the authors of this program have read.
    Published,
    /// Follows by arithmetic from published figures.
    Derived,
    /// A recollection or an engineering estimate, with the range that the published figures allow.
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

/// Unit, provenance, range and source of one number of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ParameterInfo {
    /// Field name within its table.
    pub name: &'static str,
    /// Unit of value, range and limits; "1" for a pure number.
    pub unit: &'static str,
    /// Provenance of the value.
    pub standing: Standing,
    /// Initial value of a table, which the papers give or allow.
    pub papers: Value,
    /// Smallest and largest value that the sources allow.
    pub range: (Value, Value),
    /// Smallest and largest value that the model can use.
    pub limits: (Value, Value),
    /// Source of the value: a paper's short name, a formula or a reason.
    pub source: &'static str,
}

impl ParameterInfo {
    /// Returns the range of a whole number; `None` for a real number.
    #[must_use]
    pub fn whole_range(&self) -> Option<(u64, u64)> {
        match self.range {
            (Value::Whole(low), Value::Whole(high)) => Some((low, high)),
            _ => None,
        }
    }
}
