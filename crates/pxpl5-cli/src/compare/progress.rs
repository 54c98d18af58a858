//! Progress of a comparison on standard error: a bar on a terminal, plain lines elsewhere.

use crate::terminal;
use indicatif::ProgressBar;
use pxpl5::compare::ComparisonRow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

pub(super) struct CompareProgress {
    bar: ProgressBar,
    quiet: bool,
    begun: Instant,
    /// Number of finished rows, and number of all rows.
    rows: (AtomicU64, u64),
    /// Number of finished runs, and number of all runs.
    runs: (AtomicU64, AtomicU64),
}

/// Maximum number of lines about finished runs on an output that is not a terminal: one after each tenth of the runs.
/// Lines about finished rows come in addition.
const LINES: u64 = 10;

impl CompareProgress {
    /// Shows the progress of a comparison of `rows` rows. `found` is the number of rows that an earlier, interrupted
    /// command has finished.
    pub(super) fn new(found: usize, rows: usize, quiet: bool) -> Self {
        let progress = Self {
            bar: terminal::progress(0, "runs", quiet),
            quiet,
            begun: Instant::now(),
            rows: (AtomicU64::new(found as u64), rows as u64),
            runs: Default::default(),
        };
        if found > 0 {
            progress.line(&format!("pxpl5: {found} of {rows} rows were finished before\n"));
        }
        progress
    }

    pub(super) fn finished(&self, done: u64, of: u64) {
        self.bar.set_length(of);
        self.bar.set_position(done);
        self.runs.0.store(done, Ordering::Relaxed);
        self.runs.1.store(of, Ordering::Relaxed);
        // A log gets a line for each tenth of the runs.
        let is_tenth = done * LINES / of.max(1) > (done - 1) * LINES / of.max(1);
        if self.bar.is_hidden() && is_tenth && done < of {
            self.line(&format!("pxpl5: {done} of {of} runs, {}\n", self.left()));
        }
    }

    pub(super) fn ended(&self, row: &ComparisonRow) {
        let done = self.rows.0.fetch_add(1, Ordering::Relaxed) + 1;
        self.line(&format!("pxpl5: row {done} of {}, {}; {}\n", self.rows.1, result(row), self.left()));
    }

    pub(super) fn clear(&self) {
        self.bar.finish_and_clear();
    }

    /// Returns the estimated time left as text. The estimate assumes that the remaining runs take as long as the
    /// finished runs.
    fn left(&self) -> String {
        let [done, of] = [&self.runs.0, &self.runs.1].map(|count| count.load(Ordering::Relaxed));
        let left = self.begun.elapsed().as_secs_f64() / done.max(1) as f64 * of.saturating_sub(done) as f64;
        format!("about {left:.0} s to go")
    }

    fn line(&self, line: &str) {
        if !self.quiet {
            self.bar.suspend(|| terminal::print_error(line));
        }
    }
}

fn result(row: &ComparisonRow) -> String {
    let error = row.error.mean_px.mean;
    let error = if error.is_finite() { format!("error {error:.2} px") } else { "no error".to_owned() };
    let missed = row.not_shown.filter(|missed| *missed > 0);
    let shown = missed
        .map_or_else(String::new, |missed| format!(", {missed} of {} pictures not shown", row.due.unwrap_or_default()));
    format!("{}: {error}{shown}", row.pipeline)
}
