//! Printer of results to standard output and of messages to standard error.

use crate::error::CliError;
use crate::interrupt;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;
use std::borrow::Cow;
use std::io::{ErrorKind, IsTerminal, Write};

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

pub(crate) fn advance(bar: &ProgressBar, done: u64, of: u64) {
    bar.set_length(of);
    bar.set_position(done);
}

/// Returns a progress bar with the remaining time. The bar appears on standard error, and only on a terminal.
pub(crate) fn progress(total: u64, what: &str, quiet: bool) -> ProgressBar {
    let shown = !quiet && std::io::stderr().is_terminal();
    let target = if shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
    let bar = ProgressBar::with_draw_target(Some(total), target).with_message(what.to_owned());
    let style = ProgressStyle::with_template("{msg} [{bar:40}] {pos}/{len}, {eta} to go");
    let bar = bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    interrupt::follows(&bar);
    bar
}
