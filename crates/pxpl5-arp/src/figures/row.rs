//! A row of the comparison: published number, simulated number, and how the simulated number was obtained.

use serde::Serialize;

/// Provenance of a simulated number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Provenance {
    /// The number is simulated, and no parameter was fitted to this number.
    Checked,
    /// The number is simulated with a parameter whose value was chosen so that this row agrees.
    Fitted,
    /// The number depends on facts that the papers do not print. The published number is compared with the interval
    /// over all interpretations.
    Interpretation,
    /// The number cannot be reproduced, because the papers do not print its conditions. Only the shape of its curve or
    /// table is checked.
    Shape,
}

impl Provenance {
    /// Returns the name used in the document.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Checked => "checked",
            Self::Fitted => "fitted",
            Self::Interpretation => "depends on the interpretation",
            Self::Shape => "cannot be reproduced, shape checked",
        }
    }
}

/// A published or derived number next to the simulated number.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Name of the experiment, E1 to E9.
    pub experiment: &'static str,
    /// Name of the number in the specification.
    pub id: &'static str,
    /// Description of the number.
    pub statement: String,
    /// Unit of both numbers.
    pub unit: &'static str,
    /// Number as printed, or derived from printed numbers. NaN (null in JSON) if the paper has a drawing without
    /// numbers.
    pub published: f64,
    /// Simulated number.
    pub ours: f64,
    pub provenance: Provenance,
    /// True if the simulated number agrees to 1 percent. For a number that cannot be reproduced, true if the shape of
    /// its curve or table agrees.
    pub is_met: bool,
}

impl Row {
    /// Creates a row whose numbers should agree to 1 percent.
    #[must_use]
    pub fn number(
        id: &'static str,
        statement: &str,
        unit: &'static str,
        both: [f64; 2],
        provenance: Provenance,
    ) -> Self {
        let [published, ours] = both;
        let is_met = (ours - published).abs() <= 0.01 * published.abs();
        Self { experiment: "", id, statement: statement.to_owned(), unit, published, ours, provenance, is_met }
    }

    /// Creates a row for a number that cannot be reproduced. `holds` is true if the shape of its curve or table agrees.
    #[must_use]
    pub fn shape(id: &'static str, statement: &str, unit: &'static str, both: [f64; 2], holds: bool) -> Self {
        Self { is_met: holds, ..Self::number(id, statement, unit, both, Provenance::Shape) }
    }

    /// Creates a row that has its own criterion for agreement, such as "less than".
    #[must_use]
    pub fn limit(id: &'static str, statement: &str, unit: &'static str, both: [f64; 2], is_met: bool) -> Self {
        Self { is_met, ..Self::number(id, statement, unit, both, Provenance::Checked) }
    }

    /// Returns the row with the name of the experiment that it belongs to.
    #[must_use]
    pub fn of(self, experiment: &'static str) -> Self {
        Self { experiment, ..self }
    }

    /// Returns the relative error in percent, or `None` if the published number is 0 or missing.
    #[must_use]
    pub fn error_percent(&self) -> Option<f64> {
        self.published.is_normal().then(|| 100.0 * (self.ours / self.published - 1.0))
    }

    /// Returns the verdict on the row: `met`, `within`, `shape` or `missed`.
    ///
    /// `within` means that the published number lies in the interval of all interpretations. `shape` means that the
    /// number cannot be reproduced, but the shape of its curve or table agrees with the print.
    #[must_use]
    pub const fn verdict(&self) -> &'static str {
        match (self.is_met, self.provenance) {
            (false, _) => "missed",
            (true, Provenance::Shape) => "shape",
            (true, Provenance::Interpretation) => "within",
            (true, _) => "met",
        }
    }

    /// Returns the known reason why the simulated number misses the published number.
    #[must_use]
    pub fn cause(&self) -> &'static str {
        match self.id {
            "A8" => "No interpretation of size and distance gives such a large factor.",
            "A12" => {
                "The paper does not print its scene, path, rings of cells and threshold. Only the rate of memory 1 was fitted."
            }
            _ => "The cause is not known.",
        }
    }
}
