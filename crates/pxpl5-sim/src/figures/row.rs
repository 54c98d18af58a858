//! A row that compares a published figure with a model, and a definition, which is not compared.

use crate::parameters::Provenance;
use serde::Serialize;
use std::borrow::Cow;

/// Provenance of a row: the relation between a published figure and the choices made in the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "provenance", content = "fitted", rename_all = "lowercase")]
pub enum Basis {
    /// An independent check: nothing was chosen to reproduce the figure.
    Free,
    /// The named parameter was fitted to this figure, or derived from it.
    Fitted(&'static str),
    /// The named rule of the model was chosen because of this figure.
    Rule(&'static str),
    /// Depends on facts that the papers do not print. The published number is compared with the interval over all
    /// interpretations.
    Interpretation,
    /// Cannot be reproduced, because the papers do not print its conditions. Only the shape of its curve or table is
    /// checked.
    Shape,
}

impl Basis {
    /// Returns the name used in documents, without the parameter or rule.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Fitted(_) => "fitted",
            Self::Rule(_) => "rule",
            Self::Interpretation => "depends on the interpretation",
            Self::Shape => "cannot be reproduced, shape checked",
        }
    }
}

/// An additional number that a figure's experiment yields.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Detail {
    /// Name of the number, in a few words, such as `standard deviation`.
    pub name: String,
    /// The number, in [`Detail::unit`].
    pub value: f64,
    /// Unit of the number: `ms`, `fields`, `Hz`, `triangles`.
    pub unit: &'static str,
}

/// A published figure and the model's value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FigureRow {
    /// Number of the figure in the specification.
    pub id: &'static str,
    /// Statement of the paper in a few words.
    pub statement: Cow<'static, str>,
    /// Part of a paper that prints the figure.
    pub source: Cow<'static, str>,
    /// Simulated experiment: its name, or its machine, pipeline and scene.
    pub experiment: &'static str,
    /// Scene that was drawn for the figure. `None` if the experiment has its own scene, or none.
    pub scene: Option<String>,
    /// Number as printed, or derived from printed numbers, in `unit`. NaN (null in JSON) if the paper has a drawing
    /// without numbers.
    pub published: f64,
    /// Provenance of the published number: printed or derived.
    pub origin: Provenance,
    /// Half the width of the range that the paper prints, in `unit`. `None` if the paper prints no range.
    pub spread: Option<f64>,
    /// Least and greatest simulated value that count as agreement.
    pub accepted: [f64; 2],
    /// Value of the model in `unit`.
    pub simulated: f64,
    /// Unit of all values of the row.
    pub unit: &'static str,
    /// Minimum and maximum of the figure over a condition of the experiment that the paper does not print. `simulated`
    /// is the value for the assumed condition. `None` if the paper prints all conditions.
    pub unprinted: Option<[f64; 2]>,
    /// Relative error in percent: (simulated - published) / published. `None` if the published number is 0 or missing.
    pub error_percent: Option<f64>,
    /// True if the model agrees with the figure.
    pub is_met: bool,
    /// Provenance of the row, and the parameter or rule that was chosen for the figure.
    #[serde(flatten)]
    pub basis: Basis,
    /// Value of the model at the analytic level with the presets' parameters. Its distance from `simulated` is the
    /// error of the analytic level. `None` if no parameter was varied.
    pub analytic: Option<f64>,
    /// Minimum and maximum of the figure while unpublished parameters vary within their ranges, at the analytic level.
    /// `None` if no parameter was varied.
    pub interval: Option<[f64; 2]>,
    /// Known cause of a difference between model and paper. Empty if the cause is unknown.
    pub cause: &'static str,
    /// Additional numbers of the same experiment.
    pub details: Vec<Detail>,
}

/// Returns the values that differ from `middle` by at most `half`.
#[must_use]
pub const fn around(middle: f64, half: f64) -> [f64; 2] {
    [middle - half, middle + half]
}

/// Relative rounding error of printed numbers, because papers print three digits.
const ROUNDING: f64 = 0.01;

impl FigureRow {
    /// Returns the known cause of a difference between model and paper, or a sentence that the cause is not known.
    #[must_use]
    pub const fn cause_or_unknown(&self) -> &'static str {
        if self.cause.is_empty() { "The cause is not known." } else { self.cause }
    }

    /// Creates a row from the published and the simulated number. The row is met if the simulated number is among the
    /// accepted ones. Nothing else is known about the figure.
    #[must_use]
    pub fn new(
        id: &'static str,
        statement: impl Into<Cow<'static, str>>,
        unit: &'static str,
        [published, simulated]: [f64; 2],
        accepted: [f64; 2],
    ) -> Self {
        Self {
            id,
            statement: statement.into(),
            source: Cow::Borrowed(""),
            experiment: "",
            scene: None,
            published,
            origin: Provenance::Published,
            spread: None,
            accepted,
            simulated,
            unit,
            unprinted: None,
            error_percent: published.is_normal().then(|| 100.0 * (simulated - published) / published),
            is_met: (accepted[0]..=accepted[1]).contains(&simulated),
            basis: Basis::Free,
            analytic: None,
            interval: None,
            cause: "",
            details: Vec::new(),
        }
    }

    /// Returns the row with the least and greatest simulated value that count as agreement.
    #[must_use]
    pub fn with_accepted(self, accepted: [f64; 2]) -> Self {
        Self { accepted, ..self }.with_unprinted(None)
    }

    /// Returns the row with the range of the figure over a condition that the paper does not print. The row is met if
    /// any value of this range is accepted.
    #[must_use]
    pub fn with_unprinted(self, unprinted: Option<[f64; 2]>) -> Self {
        let [low, high] = unprinted.unwrap_or([self.simulated; 2]);
        let is_met = low <= self.accepted[1] && high >= self.accepted[0];
        Self { unprinted, is_met, ..self }
    }

    /// Returns true if no values of the unpublished parameters reproduce the published value. A rule of the model is
    /// then wrong.
    ///
    /// The values that the model can reach are the interval of the analytic level, extended on both sides. The
    /// extension is the distance between `analytic` and `simulated`. The two levels may differ as much at the ends of
    /// the ranges as at the presets. The published value is compared with its printed range, or with its last digit if
    /// no range is printed.
    #[must_use]
    pub fn is_out_of_reach(&self) -> bool {
        let Some([low, high]) = self.interval else { return false };
        // Allow for the distance between the levels and for the printed precision.
        let of_levels = self.analytic.map_or(0.0, |analytic| (analytic - self.simulated).abs());
        let spread = self.spread.unwrap_or(0.0);
        let slack = of_levels + spread.max(self.published.abs() * ROUNDING);
        self.published + slack < low || self.published - slack > high
    }
}

/// A number of a paper that is an input of the model, or that follows from printed numbers by arithmetic alone.
///
/// No run can give another value, so a definition has no verdict.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Definition {
    /// Name of the number in the specification.
    pub id: &'static str,
    /// Description of the number and of its inputs.
    pub statement: Cow<'static, str>,
    /// Part of the paper that prints the number, or "derived".
    pub source: &'static str,
    /// Value of the number in `unit`.
    pub value: f64,
    pub unit: &'static str,
    /// Provenance of the value: printed or derived.
    pub provenance: Provenance,
}
