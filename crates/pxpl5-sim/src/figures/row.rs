//! Two types of rows. A [`FigureRow`] compares a published figure with a model. A [`Definition`] is an input of the
//! model, so it has no comparison.

use super::table::{range, significant};
use crate::parameters::Provenance;
use serde::Serialize;
use std::borrow::Cow;
use std::fmt;

/// Provenance of a row: the relation between a published figure and the choices made in the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "provenance", content = "chosen", rename_all = "lowercase")]
pub enum Basis {
    /// An independent check: no parameter and no rule of the model was chosen by comparison with a figure.
    Free,
    /// The named parameter was fitted to this figure, or derived from this figure.
    Fitted(&'static str),
    /// The named rule of the model was chosen because of this figure alone.
    Rule(&'static str),
    /// The named rule, statistic or machine decides the figure, and was chosen by comparison with several figures.
    Interpretation(&'static str),
    /// The figure follows from the named rows or inputs by arithmetic.
    Derived(&'static str),
    /// The figure depends on facts that the papers do not print. The published number is compared with the range of
    /// results over all possible facts.
    Unprinted,
    /// The number cannot be reproduced, because the papers do not print its conditions. Only the shape of the curve or
    /// table is checked.
    Shape,
}

impl Basis {
    pub const fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Fitted(_) => "fitted",
            Self::Rule(_) => "rule",
            Self::Interpretation(_) => "interpretation",
            Self::Derived(_) => "derived",
            Self::Unprinted => "conditions not printed",
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

/// A row that compares a published figure (a number of a paper) with the value of a model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FigureRow {
    /// Number under which the documents of the project list the figure, such as `7` or `E1`.
    pub id: &'static str,
    pub statement: Cow<'static, str>,
    /// Paper that prints the figure, with the section or page.
    pub source: Cow<'static, str>,
    /// Description of the simulated experiment: a name, or the machine, the pipeline and the scene.
    pub experiment: &'static str,
    /// Scene that was drawn for the figure. `None` if the experiment defines its own scene or draws no scene.
    pub scene: Option<String>,
    /// Number as printed, or derived from printed numbers, in `unit`. NaN (null in JSON) if the paper has a drawing
    /// without numbers.
    pub published: f64,
    /// Provenance of the published number: printed or derived.
    pub origin: Provenance,
    /// Half the width of the range that the paper prints, in `unit`. `None` if the paper prints no range.
    pub spread: Option<f64>,
    /// Smallest and largest simulated value that count as agreement with the paper.
    pub accepted: [f64; 2],
    /// Value that the model gives for the figure, in `unit`.
    pub simulated: f64,
    pub unit: &'static str,
    /// Minimum and maximum of the figure over a condition of the experiment that the paper does not print. `simulated`
    /// is the value for the assumed condition. `None` if the paper prints all conditions.
    pub unprinted: Option<[f64; 2]>,
    /// Relative error in percent: (simulated - published) / published. `None` if the published number is 0 or missing.
    pub error_percent: Option<f64>,
    pub is_met: bool,
    #[serde(flatten)]
    pub basis: Basis,
    /// Value of the figure at the analytic level, with the parameters of the presets. The difference from `simulated`
    /// is the error of the analytic level. `None` if no parameter was varied.
    pub analytic: Option<f64>,
    /// Minimum and maximum of the figure while unpublished parameters vary within their ranges, at the analytic level.
    /// `None` if no parameter was varied.
    pub interval: Option<[f64; 2]>,
    /// Known cause of a difference between the values of model and paper. Empty if no cause is known.
    pub cause: &'static str,
    pub details: Vec<Detail>,
}

/// A row of a table on the terminal, below [`FigureRow::HEADER`].
impl fmt::Display for FigureRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let published = if self.published.is_nan() { "-".to_owned() } else { significant(self.published, DIGITS) };
        let error = self.error_percent.map_or_else(String::new, |error| format!("{error:+.1}%"));
        let interval = self.interval.map_or_else(String::new, range);
        let scene = self.scene.as_ref().map_or_else(String::new, |scene| format!(" ({scene})"));
        // An experiment is either described in words or has a name such as E1.
        let name = if self.experiment.contains(' ') { "" } else { self.experiment };
        let provenance = match self.basis {
            Basis::Interpretation(_) => "interpret.",
            Basis::Unprinted => "interval",
            Basis::Shape => "shape",
            _ => self.basis.name(),
        };
        write!(
            f,
            "{:<10} {published:>10} {:>12}  {:<13} {error:>8}  {interval:<22} {provenance:<10} {}{}{scene}",
            format!("{name} {}", self.id).trim_start(),
            significant(self.simulated, DIGITS),
            self.unit,
            if self.is_met { "" } else { "miss: " },
            self.statement
        )
    }
}

const DIGITS: i32 = 6;

/// Returns the lowest and the highest value that differ from `middle` by at most `half`.
pub const fn around(middle: f64, half: f64) -> [f64; 2] {
    [middle - half, middle + half]
}

/// Relative rounding error of printed numbers, because papers print three digits.
const ROUNDING: f64 = 0.01;

impl FigureRow {
    /// Head of a table of rows on the terminal.
    pub const HEADER: &'static str =
        "#           published    simulated  unit             error  interval               provenance what";

    /// Returns the known cause of a difference between model and paper, or a sentence that states that no cause is
    /// known.
    pub const fn cause_or_unknown(&self) -> &'static str {
        if self.cause.is_empty() { "The cause is not known." } else { self.cause }
    }

    /// Creates a row from the published and the simulated number. The row counts as met if the simulated number is
    /// within `accepted`. All optional facts about the figure are missing.
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

    /// Replaces the smallest and largest simulated value that count as agreement with the paper.
    #[must_use]
    pub fn with_accepted(self, accepted: [f64; 2]) -> Self {
        let is_met = (accepted[0]..=accepted[1]).contains(&self.simulated);
        Self { accepted, is_met, ..self }
    }

    /// Returns true if the model cannot reproduce the published value with any values of the unpublished parameters. A
    /// rule of the model is wrong then.
    ///
    /// It can reach the interval of the analytic level, extended on both sides by the distance between `analytic` and
    /// `simulated`, by which the two levels may differ everywhere. The published value is compared with its printed
    /// range, or with its last digit if no range is printed.
    pub fn is_out_of_reach(&self) -> bool {
        let Some([low, high]) = self.interval else { return false };
        // The margin has the difference between the two levels and the precision of the printed figure.
        let of_levels = self.analytic.map_or(0.0, |analytic| (analytic - self.simulated).abs());
        let spread = self.spread.unwrap_or(0.0);
        let slack = of_levels + spread.max(self.published.abs() * ROUNDING);
        self.published + slack < low || self.published - slack > high
    }
}

/// A number of a paper that is an input of the model, or that follows from printed numbers by arithmetic alone.
///
/// A simulation always gives this value, so a definition tests nothing.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Definition {
    /// Name under which the documents of the project list the number.
    pub id: &'static str,
    pub statement: Cow<'static, str>,
    /// Section or page of the paper that prints the number, or "derived".
    pub source: &'static str,
    pub value: f64,
    pub unit: &'static str,
    pub provenance: Provenance,
}
