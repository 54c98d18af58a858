//! Progress of a command on standard error.

use crate::budget::BudgetArgs;
use crate::error::CliError;
use crate::interrupt;
use crate::terminal::print_error;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pxpl5::{ExperimentError, StopFlag, Study, StudyError, Watcher};
use std::fmt::Display;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// A function for each finished row, with its table.
type OnRow<'a> = Box<dyn FnMut(&Bar, &'static str, &dyn Display) + Send + 'a>;

/// The watcher of a study: a bar on a terminal, and elsewhere a line after each tenth of the work.
pub(crate) struct Progress<'a> {
    bar: Bar,
    on_row: Option<OnRow<'a>>,
    /// Finished rows, for an interruption.
    rows: Vec<String>,
    /// Text about what an interruption keeps, and how to continue.
    kept: Option<String>,
}

/// A progress bar.
pub(crate) struct Bar {
    bar: ProgressBar,
    what: &'static str,
    is_quiet: bool,
    begun: Instant,
    /// Numbers of finished parts and of all parts. A cleared bar does not keep them.
    done: [u64; 2],
    /// Number of parts that were finished at the first report.
    found: Option<u64>,
    /// Number of tenths that lines have reported.
    told: u64,
}

/// Time before the first line about tenths. Work that takes less time is done silently.
const PATIENCE: Duration = Duration::from_secs(2);

/// Maximum number of finished rows that an interruption prints.
const ROWS: usize = 20;

impl Bar {
    /// Shows a bar for parts of work that are named `what`.
    pub(crate) fn new(what: &'static str, is_quiet: bool) -> Self {
        let is_shown = !is_quiet && std::io::stderr().is_terminal();
        let target = if is_shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let style = ProgressStyle::with_template("{msg} [{bar:40}] {pos}/{len}, {eta} to go");
        let bar = ProgressBar::with_draw_target(Some(0), target).with_message(what);
        let bar = bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        interrupt::follow(true);
        Self { bar, what, is_quiet, begun: Instant::now(), done: [0; 2], found: None, told: 0 }
    }

    pub(crate) fn advance(&mut self, done: u64, of: u64) {
        if self.found.is_none() {
            self.found = Some(done);
            self.bar.reset_eta();
        }
        self.done = [done, of];
        self.bar.set_length(of);
        self.bar.set_position(done);
        let tenth = 10 * done / of.max(1);
        if self.bar.is_hidden() && self.begun.elapsed() > PATIENCE && tenth > self.told && done < of {
            self.told = tenth;
            self.line(&format!("pxpl5: {done} of {of} {}, {}\n", self.what, self.left()));
        }
    }

    /// Returns the estimated time left as text. The estimate assumes that the remaining parts take as long as the
    /// finished parts.
    pub(crate) fn left(&self) -> String {
        let [done, of] = self.done;
        let made = done.saturating_sub(self.found.unwrap_or_default()).max(1);
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
        interrupt::follow(false);
        self.bar.finish_and_clear();
    }

    /// Returns an error after Ctrl-C: how far the work came, and what is kept of it.
    pub(crate) fn check(&self, kept: &str) -> Result<(), CliError> {
        if !interrupt::flag().is_stopped() {
            return Ok(());
        }
        let [done, of] = self.done;
        Err(CliError::interrupted(format!("interrupted after {done} of {of} {}; {kept}", self.what)))
    }
}

impl<'a> Progress<'a> {
    /// Watches a study whose parts are named `what`.
    pub(crate) fn new(what: &'static str, is_quiet: bool) -> Self {
        Self { bar: Bar::new(what, is_quiet), on_row: None, rows: Vec::new(), kept: None }
    }

    /// Sets what an interruption keeps.
    pub(crate) fn keeping(self, kept: impl Into<String>) -> Self {
        Self { kept: Some(kept.into()), ..self }
    }

    /// Prints a line to standard error.
    pub(crate) fn line(&self, line: &str) {
        self.bar.line(line);
    }

    /// Calls a function for each finished row.
    pub(crate) fn on_row(self, on_row: impl FnMut(&Bar, &'static str, &dyn Display) + Send + 'a) -> Self {
        Self { on_row: Some(Box::new(on_row)), ..self }
    }

    /// Runs a study. After Ctrl-C, the finished part of its report is its result, and the command ends with exit code
    /// 130.
    pub(crate) fn run<S: Study>(mut self, study: &S) -> Result<S::Report, CliError> {
        let report = study.run(&mut self);
        self.bar.clear();
        let ended = |otherwise: &str| self.bar.check(self.kept.as_deref().unwrap_or(otherwise));
        match report {
            Err(StudyError::Experiment(ExperimentError::Stopped(_))) => {
                let rows = self.rows.iter().rev().take(ROWS).rev().map(|row| format!("\n  {row}")).collect::<String>();
                let stopped = ended("nothing was written").err().unwrap_or_else(|| CliError::failure("stopped"));
                Err(CliError::interrupted(format!("{}{rows}", stopped.message())))
            }
            report => {
                if let Err(stopped) = ended("the result is that of the finished part, and no file was written") {
                    print_error(&format!("\npxpl5: {}\n", stopped.message()));
                }
                Ok(report?)
            }
        }
    }

    /// Runs a study whose estimated memory and time are within a budget. `advice` is a text about ways to reduce the
    /// work.
    pub(crate) fn run_within<S: Study>(
        self,
        budget: BudgetArgs,
        advice: &str,
        study: &S,
    ) -> Result<S::Report, CliError> {
        budget.admit_study(study, advice).inspect_err(|_| self.bar.clear())?;
        self.run(study)
    }
}

impl Watcher for Progress<'_> {
    fn progress(&mut self, done: u64, of: u64) {
        self.bar.advance(done, of);
    }

    fn row(&mut self, table: &'static str, row: &dyn Display) {
        match &mut self.on_row {
            Some(on_row) => on_row(&self.bar, table, row),
            None => self.rows.push(row.to_string()),
        }
    }

    fn stop(&self) -> StopFlag {
        interrupt::flag()
    }
}
