//! The table row of a published figure, and the definition of a missed figure.

use super::measured::FigureValue;
use super::table::Figure;
use pxpl5_sim::figures::{Basis, FigureRow, around};

/// Error in percent above which the model misses a figure, if the paper prints no range.
pub const MISS_PERCENT: f64 = 3.0;

impl Figure {
    /// Returns the table row of the figure, with the printed value and the simulated value `measured`.
    ///
    /// The model misses the figure if its value lies outside the printed range. If no range is printed, an error of
    /// more than [`MISS_PERCENT`] is a miss. If the paper does not print a condition, the figure is missed only if no
    /// value of this condition reproduces the figure.
    pub fn row(&self, measured: FigureValue) -> FigureRow {
        // A tiny margin absorbs rounding in floating-point arithmetic.
        let allowed = self.spread.unwrap_or(self.value * MISS_PERCENT / 100.0) * (1.0 + 1e-9);
        let both = [self.value, measured.value];
        let row = FigureRow::new(self.id, self.statement, self.unit, both, around(self.value, allowed));
        FigureRow {
            source: format!("{}, {}", self.paper, self.section).into(),
            experiment: self.experiment,
            spread: self.spread,
            basis: self.basis,
            cause: self.cause,
            details: measured.details,
            ..row.with_unprinted(measured.unprinted)
        }
    }
}

/// Returns the mean absolute error in percent over all rows without fitted parameters. A figure without a value counts
/// as 100 %.
pub fn mean_error_percent(rows: &[FigureRow]) -> f64 {
    let free: Vec<_> = rows.iter().filter(|row| row.basis == Basis::Free).collect();
    let error = |row: &FigureRow| row.error_percent.filter(|error| error.is_finite()).map_or(100.0, f64::abs);
    free.iter().map(|row| error(row)).sum::<f64>() / free.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::FIGURES;

    /// Returns row 17 of ACCURACY.md for a simulated value. The published value of this row is 54 to 57 ms.
    fn row_of_figure_17(value: f64, unprinted: Option<[f64; 2]>) -> FigureRow {
        let figure = FIGURES.iter().find(|figure| figure.id == "17").expect("listed");
        figure.row(FigureValue { unprinted, ..FigureValue::from(value) })
    }

    #[test]
    fn a_figure_is_missed_if_no_value_of_an_unprinted_condition_gives_it() {
        assert!(!row_of_figure_17(49.0, None).is_met && row_of_figure_17(54.1, None).is_met);
        for (interval, misses) in
            [([40.0, 53.9], true), ([40.0, 54.1], false), ([56.9, 60.0], false), ([57.1, 60.0], true)]
        {
            let row = row_of_figure_17(49.0, Some(interval));
            assert_eq!(row.is_met, !misses, "{interval:?}");
            // The error always refers to the assumed condition.
            let error_percent = row.error_percent.expect("published");
            assert!((error_percent - 100.0 * (49.0 / 55.5 - 1.0)).abs() < 1e-9);
        }
    }
}
