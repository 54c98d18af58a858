//! Columns that several tables of figures share. Numbers have four significant digits.

use super::{Basis, FigureRow, TableColumn, significant};

/// Number under which the documents of the project list the figure.
pub const NUMBER: TableColumn<FigureRow> = ("#", |row| row.id.to_owned());

/// Statement of the paper about the figure, with the section or page that prints the statement.
pub const STATEMENT: TableColumn<FigureRow> = ("figure", |row| format!("{} ({})", row.statement, row.source));

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

/// Relative error in percent, or "-" if the published number is 0 or missing.
pub const ERROR: TableColumn<FigureRow> = ("error", error);

/// Smallest and largest value of the figure in the model while unpublished parameters vary within their ranges.
pub const INTERVAL: TableColumn<FigureRow> =
    ("interval", |row| row.interval.map_or_else(|| "not varied".to_owned(), range));

/// Provenance of the row, with the parameter or rule that was chosen.
pub const PROVENANCE: TableColumn<FigureRow> = ("provenance", |row| match row.basis {
    Basis::Fitted(chosen) | Basis::Rule(chosen) | Basis::Interpretation(chosen) | Basis::Derived(chosen) => {
        format!("{}: {chosen}", row.basis.name())
    }
    _ => row.basis.name().to_owned(),
});

pub const EXPERIMENT: TableColumn<FigureRow> = ("experiment", |row| row.experiment.to_owned());

pub const DETAILS: TableColumn<FigureRow> = ("other results", |row| {
    let details = row.details.iter().map(|detail| format!("{} {} {}", detail.name, four(detail.value), detail.unit));
    details.collect::<Vec<_>>().join(", ")
});

/// Formats the relative error in percent, or "-" if the published number is 0 or missing.
pub fn error(row: &FigureRow) -> String {
    row.error_percent.map_or_else(|| "-".to_owned(), |error| format!("{error:+.1} %"))
}

pub fn four(value: f64) -> String {
    significant(value, 4)
}

pub fn range([low, high]: [f64; 2]) -> String {
    format!("{} to {}", four(low), four(high))
}
