//! Printer of results to standard output and of messages to standard error.

use crate::error::CliError;
use crate::interrupt;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;
use std::borrow::Cow;
use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

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

/// Progress on standard error: a bar on a terminal, and elsewhere a line after each tenth of the work.
pub(crate) struct Progress {
    bar: ProgressBar,
    what: &'static str,
    is_quiet: bool,
    begun: Instant,
    /// Amount of the work that was done before.
    found: AtomicU64,
    /// Number of tenths that lines have reported.
    told: AtomicU64,
}

/// Time before the first line about tenths. Work that takes less time is done silently.
const PATIENCE: Duration = Duration::from_secs(2);

/// Returns the progress of `total` parts of work, which are named `what`.
pub(crate) fn progress(total: u64, what: &'static str, is_quiet: bool) -> Progress {
    let is_shown = !is_quiet && std::io::stderr().is_terminal();
    let target = if is_shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
    let style = ProgressStyle::with_template("{msg} [{bar:40}] {pos}/{len}, {eta} to go");
    let bar = ProgressBar::with_draw_target(Some(total), target).with_message(what);
    let bar = bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    interrupt::follows(&bar);
    Progress { bar, what, is_quiet, begun: Instant::now(), found: AtomicU64::new(0), told: AtomicU64::new(0) }
}

impl Progress {
    /// Begins at `found` parts, which an interrupted command has finished.
    pub(crate) fn begin_at(&self, found: u64) {
        self.found.store(found, Ordering::Relaxed);
        self.bar.set_position(found);
        self.bar.reset_eta();
    }

    pub(crate) fn advance(&self, done: u64, of: u64) {
        self.bar.set_length(of);
        self.bar.set_position(done);
        let tenth = 10 * done / of.max(1);
        let is_news = self.begun.elapsed() > PATIENCE && self.told.fetch_max(tenth, Ordering::Relaxed) < tenth;
        if self.bar.is_hidden() && is_news && done < of {
            self.line(&format!("pxpl5: {done} of {of} {}, {}\n", self.what, self.left()));
        }
    }

    pub(crate) fn add_one(&self) {
        self.advance(self.bar.position() + 1, self.bar.length().unwrap_or_default());
    }

    /// Returns the estimated time left as text. The estimate assumes that the remaining parts take as long as the
    /// finished parts.
    pub(crate) fn left(&self) -> String {
        let [done, of] = [self.bar.position(), self.bar.length().unwrap_or_default()];
        let made = done.saturating_sub(self.found.load(Ordering::Relaxed)).max(1);
        let left = self.begun.elapsed().as_secs_f64() / made as f64 * of.saturating_sub(done) as f64;
        format!("about {left:.0} s to go")
    }

    /// Prints a line to standard error, above the bar.
    pub(crate) fn line(&self, line: &str) {
        if !self.is_quiet {
            self.above(|| print_error(line));
        }
    }

    /// Prints something above the bar.
    pub(crate) fn above<T>(&self, printing: impl FnOnce() -> T) -> T {
        self.bar.suspend(printing)
    }

    pub(crate) fn clear(&self) {
        self.bar.finish_and_clear();
    }
}
