//! Columns that several tables of figures share. Numbers have four significant digits.

use super::table::{four, range};
use super::{Basis, FigureRow, TableColumn};

/// Number under which the documents of the project list the figure.
pub const NUMBER: TableColumn<FigureRow> = ("#", |row| row.id.to_owned());

/// Published number with its unit, and with the printed range if the paper prints a range.
pub const PUBLISHED: TableColumn<FigureRow> = ("published", |row| {
    let spread = row.spread.map_or_else(String::new, |spread| format!(" +- {}", four(spread)));
    format!("{}{spread} {}", four(row.published), row.unit)
});

/// Simulated number with its unit. If the paper does not print a condition of the experiment, the column also shows the
/// range of results over this condition.
pub const SIMULATED: TableColumn<FigureRow> = ("simulated", |row| {
    let unprinted = row.unprinted.map_or_else(String::new, |bounds| format!(" ({})", range(bounds)));
    format!("{} {}{unprinted}", four(row.simulated), row.unit)
});

/// Provenance of the row, with the parameter or rule that was chosen.
pub const PROVENANCE: TableColumn<FigureRow> = ("provenance", |row| match row.basis {
    Basis::Fitted(chosen) | Basis::Rule(chosen) | Basis::Interpretation(chosen) | Basis::Derived(chosen) => {
        format!("{}: {chosen}", row.basis.name())
    }
    _ => row.basis.name().to_owned(),
});

/// Formats the relative error in percent, or "-" if the published number is 0 or missing.
pub fn error(row: &FigureRow) -> String {
    row.error_percent.map_or_else(|| "-".to_owned(), |error| format!("{error:+.1} %"))
}
