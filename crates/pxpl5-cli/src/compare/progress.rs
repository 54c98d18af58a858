//! Progress of a comparison on standard error: a bar on a terminal, plain lines elsewhere.

use crate::progress::{Progress, progress};
use pxpl5::compare::ComparisonRow;
use std::sync::atomic::{AtomicU64, Ordering};

pub(super) struct CompareProgress {
    runs: Progress,
    /// Number of finished rows, and number of all rows.
    rows: (AtomicU64, u64),
}

impl CompareProgress {
    /// Shows the progress of a comparison of `rows` rows. `found` is the number of rows that an earlier, interrupted
    /// command has finished.
    pub(super) fn new(found: usize, rows: usize, quiet: bool) -> Self {
        let runs = progress(0, "runs", quiet);
        if found > 0 {
            runs.line(&format!("pxpl5: {found} of {rows} rows were finished before\n"));
        }
        Self { runs, rows: (AtomicU64::new(found as u64), rows as u64) }
    }

    pub(super) fn finished(&self, done: u64, of: u64) {
        self.runs.advance(done, of);
    }

    pub(super) fn ended(&self, row: &ComparisonRow) {
        let done = self.rows.0.fetch_add(1, Ordering::Relaxed) + 1;
        self.runs.line(&format!("pxpl5: row {done} of {}, {}; {}\n", self.rows.1, result(row), self.runs.left()));
    }

    pub(super) fn clear(&self) {
        self.runs.clear();
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
