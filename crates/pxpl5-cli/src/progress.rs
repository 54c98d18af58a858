//! Progress of a command on standard error.

use crate::interrupt;
use crate::terminal::print_error;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

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
