//! Rows that compare a published figure with the model, and the definition of a miss.

use super::measured::{Detail, FigureValue};
use super::table::{Basis, Figure};
use serde::Serialize;

/// A published figure and the model's value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FigureRow {
    /// Number of the figure.
    pub id: &'static str,
    /// Value printed in the paper, in `unit`.
    pub published: f64,
    /// Value of the model in `unit`, at the level of modelling that was chosen for all figures.
    pub simulated: f64,
    /// Unit of the published and the simulated value.
    pub unit: &'static str,
    /// Relative error in percent: (simulated - published) / published.
    pub error_percent: f64,
    /// Value of the model at the analytic level with the presets' parameters. Its distance from `simulated` is the
    /// error of the analytic level. `None` if no parameter was varied.
    pub analytic: Option<f64>,
    /// Minimum and maximum of the figure while unpublished parameters vary within their ranges, at the analytic level.
    /// `None` if no parameter was varied, because the figure depends only on scenes.
    pub interval: Option<[f64; 2]>,
    /// Provenance of the row. `free`: nothing was fitted to the figure. `fitted`: a parameter was fitted. `rule`: a
    /// rule was chosen.
    pub provenance: &'static str,
    /// Half the width of the range that the paper prints, in `unit`. `None` if the paper prints no range.
    pub spread: Option<f64>,
    /// Parameter that was fitted to the figure, or rule that was chosen because of the figure. Empty if nothing was
    /// fitted or chosen.
    pub fitted: &'static str,
    /// Short name of the paper and the topic within the paper.
    pub source: String,
    /// Statement of the paper in a few words.
    pub statement: &'static str,
    /// Simulated experiment: machine, pipeline and scene.
    pub experiment: &'static str,
    /// Known cause of a difference between model and paper. Empty if the cause is unknown.
    pub cause: &'static str,
    /// Additional numbers of the same experiment.
    pub details: Vec<Detail>,
    /// Minimum and maximum of the figure over a condition of the experiment that the paper does not print. `simulated`
    /// is the value for the assumed condition. `None` if the paper prints all conditions.
    pub unprinted: Option<[f64; 2]>,
}

/// Relative difference in percent above which the model misses a figure, if the paper prints no range.
pub const MISS_PERCENT: f64 = 3.0;

/// Relative rounding error of printed numbers, because papers print three digits.
const ROUNDING: f64 = 0.01;

impl FigureRow {
    /// Creates the row of a figure from its measurement.
    #[must_use]
    pub fn new(figure: &Figure, measured: FigureValue) -> Self {
        // The provenance decides whether the row counts as a free check.
        let (provenance, fitted) = match figure.basis {
            Basis::Free => ("free", ""),
            Basis::Fitted { parameter } => ("fitted", parameter),
            Basis::Rule { rule } => ("rule", rule),
        };
        Self {
            id: figure.id,
            published: figure.value,
            simulated: measured.value,
            unit: figure.unit,
            error_percent: 100.0 * (measured.value - figure.value) / figure.value,
            analytic: None,
            interval: None,
            provenance,
            spread: figure.spread,
            fitted,
            source: format!("{}, {}", figure.paper, figure.section),
            statement: figure.statement,
            experiment: figure.experiment,
            cause: figure.cause,
            details: measured.details,
            unprinted: measured.unprinted,
        }
    }

    /// Returns true if no values of the unpublished parameters reproduce the published value. A rule of the model is
    /// then wrong.
    ///
    /// The values that the model can reach are the interval of the analytic level, extended on both sides. The
    /// extension is the distance between `analytic` and `simulated`. This assumes that the two levels differ as much at
    /// the ends of the ranges as at the presets. The published value is compared with its printed range, or with its
    /// last digit if no range is printed.
    #[must_use]
    pub fn is_out_of_reach(&self) -> bool {
        let Some([low, high]) = self.interval else { return false };
        // Allow for the distance between the levels and for the printed precision.
        let of_levels = self.analytic.map_or(0.0, |analytic| (analytic - self.simulated).abs());
        let spread = self.spread.unwrap_or(0.0);
        let slack = of_levels + spread.max(self.published.abs() * ROUNDING);
        self.published + slack < low || self.published - slack > high
    }

    /// Returns true if the model misses the figure: the simulated value lies outside the printed range. If no range is
    /// printed, an error of more than [`MISS_PERCENT`] is a miss. If the paper does not print a condition, the figure
    /// is missed only if no value of this condition reproduces the figure.
    #[must_use]
    pub fn misses(&self) -> bool {
        // A tiny margin absorbs rounding in floating-point arithmetic.
        let allowed = self.spread.unwrap_or(self.published * MISS_PERCENT / 100.0) * (1.0 + 1e-9);
        let [low, high] = self.unprinted.unwrap_or([self.simulated; 2]);
        self.published + allowed < low || self.published - allowed > high
    }
}

/// Returns the mean absolute error in percent over all rows to which nothing was fitted. A figure without a value
/// counts 100 %.
#[must_use]
pub fn mean_error_percent(rows: &[FigureRow]) -> f64 {
    let free: Vec<_> = rows.iter().filter(|row| row.provenance == "free").collect();
    let errors = free.iter().map(|row| if row.simulated.is_finite() { row.error_percent.abs() } else { 100.0 });
    errors.sum::<f64>() / free.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::FIGURES;

    /// Returns the row of figure 17, published as 54 to 57 ms.
    fn row_of_figure_17(value: f64, unprinted: Option<[f64; 2]>) -> FigureRow {
        let figure = FIGURES.iter().find(|figure| figure.id == "17").expect("listed");
        FigureRow::new(figure, FigureValue { unprinted, ..FigureValue::from(value) })
    }

    #[test]
    fn a_figure_is_missed_where_no_value_of_an_unprinted_condition_gives_it() {
        assert!(row_of_figure_17(49.0, None).misses() && !row_of_figure_17(54.1, None).misses());
        for (interval, misses) in
            [([40.0, 53.9], true), ([40.0, 54.1], false), ([56.9, 60.0], false), ([57.1, 60.0], true)]
        {
            let row = row_of_figure_17(49.0, Some(interval));
            assert_eq!(row.misses(), misses, "{interval:?}");
            // The error always refers to the assumed condition.
            assert!((row.error_percent - 100.0 * (49.0 / 55.5 - 1.0)).abs() < 1e-9);
        }
    }
}
