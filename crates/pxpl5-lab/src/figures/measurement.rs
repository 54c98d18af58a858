//! A published figure as one entry: what the paper prints, how the model measures it, and what moves it.

use super::settings::FigureSettings;
use super::value::{FigureValue, Result};
use crate::study::check;
use pxpl5_sim::figures::{Basis, FigureRow, around};
use serde::Serialize;

/// Name of the topic "Rendering Control".
pub(super) const RC: &str = "Rendering Control";
/// Name of the topic "Slats".
pub(super) const SLATS: &str = "Slats";
/// Name of the topic "From head to light".
pub(super) const HEAD: &str = "from head to light";

/// The rule that decides the limits of Slats, and that was chosen by comparison with figures 12 and 13.
pub(super) const CLUMP_RULE: &str = "when a clump's buffer is free";

/// Error in percent above which the model misses a figure, if the paper prints no range.
pub const MISS_PERCENT: f64 = 3.0;

/// A figure printed in a paper, with the experiment that measures it.
#[derive(Clone, Copy, Debug)]
pub struct Measurement {
    /// Number under which documents and commands list the figure, such as `4b` or `R1`.
    pub id: &'static str,
    /// Short name of the paper.
    pub paper: &'static str,
    /// Topic of the part of the paper that prints the figure.
    pub section: &'static str,
    /// Statement of the paper with the figure, in a few words.
    pub statement: &'static str,
    /// Value printed in the paper, in `unit`.
    pub value: f64,
    /// Unit of the printed value.
    pub unit: &'static str,
    /// Half the width of the range that the paper prints, or implies by words such as "1 to 2". `None` if the paper
    /// gives no range.
    pub range: Option<f64>,
    /// Standard deviation of the samples, if the paper prints one.
    pub deviation: Option<f64>,
    /// Description of the experiment that simulates the figure.
    pub experiment: &'static str,
    /// Relation between the figure and the choices in the model.
    pub basis: Basis,
    /// Reason for `basis`. Empty if the basis itself says from what the figure follows.
    pub reason: &'static str,
    /// Definition of the latency, if the figure is one.
    pub latency: Option<LatencyDefinition>,
    /// True if answers to the open questions about Rendering Control change the figure
    /// ([`Interpretation`](super::Interpretation)).
    pub is_interpreted: bool,
    /// Parameters that vary for the interval of the figure.
    pub varied: Varied,
    /// Known cause of a difference between model and paper. Empty if no cause is known, or the model meets the figure.
    pub cause: &'static str,
    /// Simulates the figure.
    pub measure: fn(&FigureSettings) -> Result<FigureValue>,
}

/// Definition of a published latency: its beginning, its end, its eyes, and its statistic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct LatencyDefinition {
    /// Event at which the latency begins.
    pub from: &'static str,
    /// Event at which the latency ends.
    pub to: &'static str,
    /// Eyes that give samples.
    pub eyes: &'static str,
    /// Statistic over all samples.
    pub statistic: &'static str,
    /// Sentence of the paper that asks for this definition, in other words.
    pub sentence: &'static str,
}

/// Parameters that vary for the interval of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Varied {
    /// None: only scenes, motions or inputs determine the figure.
    Nothing,
    /// All parameters without a published value, at the analytic level.
    ByFormula,
    /// These parameters, one at a time, in runs with events.
    ByEvents(&'static [&'static str]),
}

/// Creates a figure to which nothing was fitted and for which nothing varies. Each list of figures replaces the members
/// that differ. The first argument is what the paper prints.
pub(super) const fn figure(
    (id, (paper, section), value, unit): (&'static str, (&'static str, &'static str), f64, &'static str),
    statement: &'static str,
    experiment: &'static str,
    measure: fn(&FigureSettings) -> Result<FigureValue>,
) -> Measurement {
    Measurement {
        id,
        paper,
        section,
        statement,
        value,
        unit,
        range: None,
        deviation: None,
        experiment,
        basis: Basis::Free,
        reason: "",
        latency: None,
        is_interpreted: false,
        varied: Varied::Nothing,
        cause: "",
        measure,
    }
}

/// Returns true if a file of experiments/ runs the figure with this number, such as figure-04.toml for 4 and 4b.
pub fn has_file(id: &str) -> bool {
    matches!(id.trim_end_matches(char::is_alphabetic).parse(), Ok(1..=7 | 9..=15))
}

impl Measurement {
    /// Simulates the figure with the settings of `settings`.
    ///
    /// # Errors
    ///
    /// Returns a [`StudyError`](crate::StudyError) if the experiment fails, or if another thread sets the flag of
    /// `settings`.
    pub fn value(&self, settings: &FigureSettings) -> Result<FigureValue> {
        check(&settings.stop)?;
        (self.measure)(settings)
    }

    /// Returns the table row of the figure, with the printed value and the simulated value `measured`.
    ///
    /// The model misses the figure if its value lies outside the printed range. If no range is printed, an error of
    /// more than [`MISS_PERCENT`] is a miss.
    pub fn row(&self, measured: FigureValue) -> FigureRow {
        // A tiny margin absorbs rounding in floating-point arithmetic.
        let allowed = self.range.unwrap_or(self.value * MISS_PERCENT / 100.0) * (1.0 + 1e-9);
        let both = [self.value, measured.value];
        let row = FigureRow::new(self.id, self.statement, self.unit, both, around(self.value, allowed));
        FigureRow {
            source: format!("{}, {}", self.paper, self.section).into(),
            experiment: self.experiment,
            spread: self.range,
            basis: self.basis,
            cause: self.cause,
            details: measured.details,
            unprinted: measured.unprinted,
            ..row
        }
    }

    /// Measures the figure and returns its row, without an interval.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Self::value`].
    pub fn measured_row(&self, settings: &FigureSettings) -> Result<FigureRow> {
        // With times of executed code no time of a triangle is fitted, so the limits of Slats become checks.
        let basis = match self.basis {
            Basis::Fitted(chosen) if settings.has_times_of_code && chosen.starts_with("gp.triangle_ns") => {
                Basis::Interpretation(CLUMP_RULE)
            }
            basis => basis,
        };
        Ok(FigureRow { basis, ..self.row(self.value(settings)?) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_nothing(_: &FigureSettings) -> Result<FigureValue> {
        Ok(0.0.into())
    }

    #[test]
    fn a_value_outside_the_printed_range_or_off_by_3_percent_is_a_miss_for_every_unprinted_condition() {
        let exact = figure(("x", ("", ""), 55.5, "ms"), "", "", of_nothing);
        let ranged = Measurement { range: Some(1.5), ..exact };
        for (figure, value, is_met) in
            [(exact, 57.1, true), (exact, 57.2, false), (ranged, 54.0, true), (ranged, 53.9, false)]
        {
            let row = figure.row(FigureValue { unprinted: Some([40.0, 70.0]), ..FigureValue::from(value) });
            assert_eq!(row.is_met, is_met, "{value}");
            assert!((row.error_percent.expect("published") - 100.0 * (value / 55.5 - 1.0)).abs() < 1e-9);
        }
    }
}
