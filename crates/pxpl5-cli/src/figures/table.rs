//! Tables of figures on the terminal, and the check that a document is up to date.

use crate::error::CliError;
use crate::terminal::print;
use pxpl5::figures::{Basis, FigureRow};
use pxpl5_sim::figures::column::range;
use pxpl5_sim::figures::significant;
use std::fs;
use std::path::Path;

/// Printer of the tables of figures, row by row.
#[derive(Default)]
pub(crate) struct RowPrinter {
    title: &'static str,
    /// Printed rows of the current table.
    rows: Vec<FigureRow>,
}

impl RowPrinter {
    /// Prints a row. A row of another table ends the current table and begins the other table.
    pub(crate) fn row(&mut self, title: &'static str, row: &FigureRow) -> Result<(), CliError> {
        if self.title != title {
            self.end_table()?;
            let gap = if self.title.is_empty() { "" } else { "\n" };
            self.title = title;
            print(&format!("{gap}{title}\n{HEADER}"))?;
        }
        self.rows.push(row.clone());
        print(&row_text(row))
    }

    pub(crate) fn end_table(&mut self) -> Result<(), CliError> {
        let rows = std::mem::take(&mut self.rows);
        if rows.is_empty() { Ok(()) } else { print(&count_text(&rows)) }
    }
}

pub(crate) const HEADER: &str =
    "#           published    simulated  unit             error  interval               provenance what\n";

/// Formats rows as a table, and counts the rows whose simulated value misses the published value.
pub(crate) fn rows_text(rows: &[FigureRow]) -> String {
    let lines: String = rows.iter().map(row_text).collect();
    format!("{HEADER}{lines}{}", count_text(rows))
}

fn count_text(rows: &[FigureRow]) -> String {
    let missed = rows.iter().filter(|row| !row.is_met).count();
    format!("{} rows, {missed} missed\n", rows.len())
}

/// Formats one row of a table of figures. The cell of a missing published number is "-".
pub(crate) fn row_text(row: &FigureRow) -> String {
    let published = if row.published.is_nan() { "-".to_owned() } else { significant(row.published, DIGITS) };
    let error = row.error_percent.map_or_else(String::new, |error| format!("{error:+.1}%"));
    let interval = row.interval.map_or_else(String::new, range);
    let scene = row.scene.as_ref().map_or_else(String::new, |scene| format!(" ({scene})"));
    // An experiment is either described in words or has a name such as E1.
    let name = if row.experiment.contains(' ') { "" } else { row.experiment };
    format!(
        "{:<10} {published:>10} {:>12}  {:<13} {error:>8}  {interval:<22} {:<10} {}{}{scene}\n",
        format!("{name} {}", row.id).trim_start(),
        significant(row.simulated, DIGITS),
        row.unit,
        provenance(row.basis),
        if row.is_met { "" } else { "miss: " },
        row.statement
    )
}

const fn provenance(basis: Basis) -> &'static str {
    match basis {
        Basis::Interpretation(_) => "interpret.",
        Basis::Unprinted => "interval",
        Basis::Shape => "shape",
        _ => basis.name(),
    }
}

const DIGITS: i32 = 6;

/// Returns an error if the document on disk differs from the text that `subcommand` would write now.
pub(crate) fn fresh(path: &Path, document: &str, subcommand: &str) -> Result<(), CliError> {
    let kept = fs::read_to_string(path).map_err(|error| CliError::failure(format!("{}: {error}", path.display())))?;
    if kept == document {
        return Ok(());
    }
    let path = path.display();
    Err(CliError::failure(format!("{path} is stale: run `pxpl5 {subcommand} --write {path}`")))
}
