//! Printer of results to standard output and of messages to standard error.

use crate::budget::BudgetArgs;
use crate::error::CliError;
use serde::Serialize;
use std::borrow::Cow;
use std::io::{ErrorKind, Write};

/// Prints a result to standard output. Returns no error if the pipe is closed (`| head`).
pub(crate) fn print(text: &str) -> Result<(), CliError> {
    print_bytes(printable(text).as_bytes())
}

/// Replaces control characters by their escapes, such as `\u{1b}`. Names in files could otherwise change the terminal.
fn printable(text: &str) -> Cow<'_, str> {
    let is_plain = |c: char| !c.is_control() || matches!(c, '\n' | '\t' | '\r');
    if text.chars().all(is_plain) {
        return Cow::Borrowed(text);
    }
    text.chars().map(|c| if is_plain(c) { c.to_string() } else { c.escape_default().to_string() }).collect()
}

/// Formats a value as JSON for readers, with a line end.
pub(crate) fn json_text(value: &impl Serialize) -> Result<String, CliError> {
    Ok(serde_json::to_string_pretty(value).map_err(CliError::failure)? + "\n")
}

/// Options of a command that answers a question: the budget of its runs, and the form of the answer.
#[derive(clap::Args, Clone, Copy, Debug, Default)]
pub(crate) struct AnswerArgs {
    #[command(flatten)]
    pub(crate) budget: BudgetArgs,
    /// Print one JSON object.
    #[arg(long)]
    pub(crate) json: bool,
    /// Print nothing but errors and, with --json, the JSON object.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

impl AnswerArgs {
    /// Prints the answer, as [`answer`].
    pub(crate) fn print(&self, json: &str, text: impl FnOnce() -> String) -> Result<(), CliError> {
        answer(self.json, self.quiet, json, text)
    }
}

/// Prints `json` with the option --json, else `text` without the option --quiet.
pub(crate) fn answer(is_json: bool, quiet: bool, json: &str, text: impl FnOnce() -> String) -> Result<(), CliError> {
    match (is_json, quiet) {
        (true, _) => print(json),
        (false, true) => Ok(()),
        (false, false) => print(&text()),
    }
}

pub(crate) fn print_bytes(bytes: &[u8]) -> Result<(), CliError> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(CliError::failure(format!("standard output cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints a message to standard error. Errors are ignored, because no other channel is left to report them.
pub(crate) fn print_error(text: &str) {
    let _ = std::io::stderr().lock().write_all(printable(text).as_bytes());
}

pub(crate) fn warn(warnings: &[String], quiet: bool) {
    if !quiet {
        warnings.iter().for_each(|warning| print_error(&format!("pxpl5: warning: {warning}\n")));
    }
}

/// Heading of a column, and the cell of a row.
pub(crate) type Column<R> = (&'static str, fn(&R) -> String);

/// Lays out rows under the headings of their columns, as [`laid_out`].
pub(crate) fn columns_text<'a, R: 'a>(
    columns: &[Column<R>],
    rows: impl IntoIterator<Item = &'a R>,
    left: usize,
) -> String {
    let heads = columns.iter().map(|(name, _)| (*name).to_owned()).collect();
    let rows = rows.into_iter().map(|row| columns.iter().map(|(_, cell)| cell(row)).collect());
    laid_out(&std::iter::once(heads).chain(rows).collect::<Vec<_>>(), left)
}

/// Lays out lines of cells in columns that are as wide as their widest cell. The first `left` columns are aligned to the
/// left, and all others to the right.
pub(crate) fn laid_out(lines: &[Vec<String>], left: usize) -> String {
    let columns = lines.iter().map(Vec::len).max().unwrap_or(0);
    let width =
        |column: usize| lines.iter().filter_map(|line| Some(line.get(column)?.chars().count())).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for line in lines {
        let cells = line.iter().zip(&widths).enumerate().map(|(column, (cell, width))| match column < left {
            true => format!("{cell:<width$}  "),
            false => format!("{cell:>width$}  "),
        });
        text.push_str(cells.collect::<String>().trim_end());
        text.push('\n');
    }
    text
}
