//! Mean errors of all rows by provenance.

use pxpl5_sim::figures::{Basis, FigureRow};
use serde::Serialize;
use std::fmt::{Display, Formatter, Result};

/// Rows of one provenance: their number, their misses, and their mean error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Counted {
    /// Number of rows.
    pub rows: usize,
    /// Number of missed rows.
    pub misses: usize,
    /// Mean of the absolute errors in percent. Within a printed range, the error is 0, and outside it is the distance
    /// from the range. A row without a value counts as 100 %.
    pub mean_error_percent: f64,
}

/// The two means by which the model is judged. Fitted and derived rows, and rows for which a rule was chosen, count in
/// neither.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Headline {
    /// Rows for which nothing was chosen by comparison with a figure.
    pub free: Counted,
    /// Rows that are decided by a rule, a statistic or a machine that was chosen by comparison with figures.
    pub interpretation: Counted,
}

impl Headline {
    /// Counts the rows of a list by provenance.
    pub fn of<'a>(rows: impl IntoIterator<Item = &'a FigureRow>) -> Self {
        let (mut free, mut interpretation) = (Vec::new(), Vec::new());
        for row in rows {
            match row.basis {
                Basis::Free => free.push(row),
                Basis::Interpretation(_) => interpretation.push(row),
                _ => {}
            }
        }
        Self { free: Counted::of(&free), interpretation: Counted::of(&interpretation) }
    }

    /// Returns the mean error in percent over free and interpretation rows together.
    pub fn mean_error_percent(&self) -> f64 {
        let [free, other] = [self.free, self.interpretation];
        let sum = |counted: Counted| counted.mean_error_percent * counted.rows as f64;
        (sum(free) + sum(other)) / (free.rows + other.rows).max(1) as f64
    }
}

impl Display for Headline {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let Self { free, interpretation: other } = self;
        write!(
            f,
            "{} free rows with a mean error of {:.1} % ({} missed), and {} interpretation rows with {:.1} % ({} missed)",
            free.rows, free.mean_error_percent, free.misses, other.rows, other.mean_error_percent, other.misses
        )
    }
}

impl Counted {
    fn of(rows: &[&FigureRow]) -> Self {
        let sum: f64 = rows.iter().map(|row| error_percent(row)).sum();
        Self {
            rows: rows.len(),
            misses: rows.iter().filter(|row| !row.is_met).count(),
            mean_error_percent: sum / rows.len().max(1) as f64,
        }
    }
}

fn error_percent(row: &FigureRow) -> f64 {
    let off = (row.simulated - row.published).abs() - row.spread.unwrap_or(0.0);
    let percent = 100.0 * off.max(0.0) / row.published.abs();
    // A missing value is not finite, and must not count as no error.
    if row.simulated.is_finite() && percent.is_finite() { percent } else { 100.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_row_counts_once_by_its_provenance_and_by_its_distance_from_the_printed_range() {
        let row = |basis, simulated, spread: Option<f64>| {
            let half = spread.unwrap_or(1.5);
            let row = FigureRow::new("x", "", "", [50.0, simulated], [50.0 - half, 50.0 + half]);
            FigureRow { basis, spread, ..row }
        };
        let chosen = Basis::Interpretation("a choice");
        let rows = [
            row(Basis::Free, 51.0, None),
            row(Basis::Free, f64::NAN, None),
            row(chosen, 54.0, Some(5.0)),
            row(chosen, 44.0, Some(5.0)),
            row(Basis::Derived("another row"), 90.0, None),
            row(Basis::Fitted("a parameter"), 50.0, None),
            row(Basis::Rule("a rule"), 50.0, None),
        ];
        let free = Counted { rows: 2, misses: 1, mean_error_percent: 51.0 };
        let interpretation = Counted { rows: 2, misses: 1, mean_error_percent: 1.0 };
        assert_eq!(Headline::of(&rows), Headline { free, interpretation });
        assert_eq!(Headline::of(&rows).mean_error_percent(), 26.0);
    }
}
