//! Tables of figures on the terminal, and the check that a document is up to date.

use crate::error::CliError;
use pxpl5::figures::FigureRow;
use std::fs;
use std::path::Path;

/// Formats rows as a table, and counts the rows whose simulated value misses the published value.
pub(crate) fn rows_text(rows: &[FigureRow]) -> String {
    let lines: String = rows.iter().map(|row| format!("{row}\n")).collect();
    let missed = rows.iter().filter(|row| !row.is_met).count();
    format!("{}\n{lines}{} rows, {missed} missed\n", FigureRow::HEADER, rows.len())
}

/// Formats rows as a table with a title.
pub(crate) fn titled(title: &str, rows: &[FigureRow]) -> String {
    format!("\n{title}\n{}", rows_text(rows))
}

/// Returns an error if the document on disk differs from the text that `subcommand` would write now.
pub(crate) fn fresh(path: &Path, document: &str, subcommand: &str) -> Result<(), CliError> {
    let kept = fs::read_to_string(path).map_err(|error| CliError::failure(format!("{}: {error}", path.display())))?;
    if kept == document {
        return Ok(());
    }
    let path = path.display();
    Err(CliError::failure(format!("{path} is stale: run `pxpl5 {subcommand} --write {path}`")))
}
