use crate::parameters::{SettingError, Value};
use serde::{Deserialize, Serialize};

/// The provenance of a parameter's value: printed, calculated or assumed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Provenance {
    /// The value is printed in a paper or manual that the authors of this program have read.
    Published,
    /// The value follows by arithmetic from published figures.
    Derived,
    /// The value was remembered or estimated by the authors of this program. The range of the value is as wide as the
    /// published figures allow.
    Assumed,
}

impl Provenance {
    /// All kinds of provenance with their names, the most reliable kind first.
    pub const ALL: [(&str, Self); 3] =
        [("published", Self::Published), ("derived", Self::Derived), ("assumed", Self::Assumed)];
}

crate::parameters::named!(Provenance, "provenance", Provenance::ALL);

/// Unit, provenance, range and source of one parameter of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ParameterInfo {
    /// Name of the parameter within its table.
    pub name: &'static str,
    /// Unit of the value, the range and the limits. The unit "1" stands for a pure number.
    pub unit: &'static str,
    /// Provenance of the parameter's value: printed, calculated or assumed.
    pub provenance: Provenance,
    /// Initial value of the parameter, which the papers print or allow.
    pub papers: Value,
    /// Smallest and largest value that the sources allow.
    pub range: (Value, Value),
    /// Smallest and largest value that the model can process.
    pub limits: (Value, Value),
    /// Source of the value: the short name of a paper, a formula, or a reason.
    pub source: &'static str,
}

impl ParameterInfo {
    /// Returns the range of a parameter that is a whole number. Returns `None` for a real number.
    pub fn whole_range(&self) -> Option<(u64, u64)> {
        match self.range {
            (Value::Whole(low), Value::Whole(high)) => Some((low, high)),
            _ => None,
        }
    }

    /// Returns the kind, limits and unit of valid values in words, for error messages.
    pub fn expected(&self) -> String {
        let (least, most) = self.limits;
        let kind = if matches!(self.papers, Value::Whole(_)) { "a whole number" } else { "a number" };
        format!("{kind} of {least} to {most} {}", self.unit)
    }
}

/// Creates the error of a table that has no parameter called `name`. The function is public for tables that are written
/// without the macro `parameter_table!`.
pub fn unknown_parameter(name: &str, infos: &[ParameterInfo]) -> SettingError {
    SettingError::unknown_path("parameter", name, infos.iter().map(|info| info.name))
}
