//! A published figure beside what the model gives, and when it is missed.

use super::measured::{Detail, FigureValue};
use super::table::{Basis, Figure};
use serde::Serialize;

/// A figure beside what the model gives.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FigureRow {
    /// Number of the figure.
    pub id: &'static str,
    /// The value that the paper prints, in `unit`.
    pub published: f64,
    /// The model's value, in `unit`, at the level of the bench.
    pub simulated: f64,
    /// Unit of the published and the simulated value.
    pub unit: &'static str,
    /// (simulated - published) / published, in percent.
    pub error_percent: f64,
    /// What the analytic level gives with the presets' numbers: how far it is from `simulated` is that level's own error.
    /// `None` where nothing was varied.
    pub analytic: Option<f64>,
    /// Least and greatest value when parameters that are not published are varied within their ranges, as computed at the
    /// analytic level. `None` where nothing was varied: a property of the scenes.
    pub interval: Option<[f64; 2]>,
    /// `free`, `fitted` or `rule`.
    pub standing: &'static str,
    /// Half of the printed range.
    pub spread: Option<f64>,
    /// What was fitted, or which rule was chosen; empty for a free check.
    pub fitted: &'static str,
    /// Short name of the paper, and the topic within it.
    pub source: String,
    /// What the paper states, in a few words.
    pub statement: &'static str,
    /// What was run for it here: machine, pipeline, scene.
    pub experiment: &'static str,
    /// What is known of the cause of a miss.
    pub cause: &'static str,
    /// Further numbers of the same experiment.
    pub details: Vec<Detail>,
    /// Least and greatest value over a condition of the experiment that the paper does not print; `simulated` is for the condition that is
    /// assumed. `None` where the paper prints all conditions.
    pub unprinted: Option<[f64; 2]>,
}

/// A difference that is called a miss, in percent, where a paper prints no range.
pub const MISS_PERCENT: f64 = 3.0;

/// Papers print three digits.
const ROUNDING: f64 = 0.01;

impl FigureRow {
    /// A figure with what was measured.
    #[must_use]
    pub fn new(figure: &Figure, measured: FigureValue) -> Self {
        let (standing, fitted) = match figure.basis {
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
            standing,
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

    /// Whether no values of the open parameters within their ranges give the figure: an error of the model's rules.
    ///
    /// The interval is the analytic level's. It is widened on both sides by the distance of `analytic` from `simulated`: as
    /// far as the levels are apart at the presets they may be at the ends of the ranges. What is published is met within
    /// its printed range, and where none is printed within its last digit.
    #[must_use]
    pub fn is_out_of_reach(&self) -> bool {
        let Some([low, high]) = self.interval else { return false };
        let of_levels = self.analytic.map_or(0.0, |analytic| (analytic - self.simulated).abs());
        let spread = self.spread.unwrap_or(0.0);
        let slack = of_levels + spread.max(self.published.abs() * ROUNDING);
        self.published + slack < low || self.published - slack > high
    }

    /// Whether the model is outside of the printed range, or, where none is printed, off by more than
    /// [`MISS_PERCENT`]. Where a condition is not printed, no value of it may give the figure.
    #[must_use]
    pub fn misses(&self) -> bool {
        let allowed = self.spread.unwrap_or(self.published * MISS_PERCENT / 100.0) * (1.0 + 1e-9);
        let [low, high] = self.unprinted.unwrap_or([self.simulated; 2]);
        self.published + allowed < low || self.published - allowed > high
    }
}

/// Mean absolute error in percent over the rows that are free checks.
#[must_use]
pub fn mean_error_percent(rows: &[FigureRow]) -> f64 {
    let free: Vec<_> = rows.iter().filter(|row| row.standing == "free").collect();
    let errors = free.iter().map(|row| if row.simulated.is_finite() { row.error_percent.abs() } else { 100.0 });
    errors.sum::<f64>() / free.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::FIGURES;

    /// Figure 17, published as 54 to 57 ms.
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
            // The error is that of the assumed condition all the same.
            assert!((row.error_percent - 100.0 * (49.0 / 55.5 - 1.0)).abs() < 1e-9);
        }
    }
}
