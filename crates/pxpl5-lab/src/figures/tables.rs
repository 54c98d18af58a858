//! The tables of figures, and the measurement of their rows in the order of the tables.

use super::group::Topic;
use super::{Bench, FIGURES, FigureFamily, FigureGroup, FigureRow, Figures, jitp, rates, row_of, stepped, trackers};
use crate::error::StudyError;
use crate::intervals::{fill, intervals};
use crate::parallel;
use std::sync::atomic::{AtomicU64, Ordering};

/// A table of figures. The order of the tables is that of `pxpl5 figures`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FigureTable {
    /// The main table, with the rows of [`FIGURES`].
    Main,
    /// Figures of one topic ([`FigureGroup`]).
    Group {
        /// Name of the topic.
        title: &'static str,
    },
    /// Figures of papers about another system ([`FigureFamily`]).
    Family {
        /// Title of the section in ACCURACY.md.
        title: &'static str,
        /// Path of the document with more details.
        document: &'static str,
    },
}

/// Measures all figures in parallel, with their intervals if the settings include intervals.
///
/// # Errors
///
/// Returns the first [`StudyError`].
pub fn run_all(bench: &Bench) -> Result<Figures, StudyError> {
    run_all_with(bench, |_, _| {})
}

/// Measures all figures in parallel, like [`run_all`]. Calls `finished` with the number of finished steps and the
/// number of all steps. A step is the measurement of a row, of a family, or of all intervals.
///
/// # Errors
///
/// Fails in the same cases as [`run_all`].
pub fn run_all_with(bench: &Bench, finished: impl Fn(u64, u64) + Sync) -> Result<Figures, StudyError> {
    run_all_in_order(bench, finished, |_, _| {})
}

/// Measures all figures in parallel, like [`run_all_with`]. Calls `row` with each row as soon as the row and all
/// earlier rows of [`Figures`] are finished. Rows of the main table then have neither an interval nor an analytic
/// value.
///
/// # Errors
///
/// Fails in the same cases as [`run_all`].
pub fn run_all_in_order(
    bench: &Bench,
    finished: impl Fn(u64, u64) + Sync,
    row: impl FnMut(FigureTable, &FigureRow) + Send,
) -> Result<Figures, StudyError> {
    let steps = n_steps() as u64 + 1;
    let done = AtomicU64::new(0);
    let step = || finished(done.fetch_add(1, Ordering::Relaxed) + 1, steps);
    let tables = || Tables::measure(bench, step, row);
    let intervals = || stepped(&step, || if bench.intervals { intervals(bench) } else { Vec::new() });
    let (tables, intervals) = parallel::both(tables, intervals);
    let Tables { main: mut rows, groups, families } = tables?;
    // After a stop, intervals are missing or too narrow.
    bench.stop.check().map_err(StudyError::of_figure("intervals"))?;
    fill(&mut rows, &intervals);
    Ok(Figures { rows, intervals, families, groups })
}

/// Rows of all tables.
struct Tables {
    main: Vec<FigureRow>,
    groups: Vec<FigureGroup>,
    families: Vec<FigureFamily>,
}

/// The measurement of a row, and the table of the row.
struct Task<'a> {
    table: FigureTable,
    measure: Box<dyn Fn() -> Result<FigureRow, StudyError> + Sync + 'a>,
}

/// Returns the number of steps in which [`Tables::measure`] measures all tables: one for each row, and one for the
/// family.
fn n_steps() -> usize {
    FIGURES.len() + topics().iter().map(|topic| topic.measurements.len()).sum::<usize>() + 1
}

impl Tables {
    /// Measures the rows of all tables in parallel. Calls `step` after each row and each family. Calls `row` with each
    /// row in the order of the tables, when all earlier rows are finished. Rows after a failed measurement are left
    /// out.
    fn measure(
        bench: &Bench,
        step: impl Fn() + Sync,
        mut row: impl FnMut(FigureTable, &FigureRow) + Send,
    ) -> Result<Self, StudyError> {
        let topics = topics();
        let tasks = tasks(bench, &topics);
        let mut has_failed = false;
        let rows = || {
            let run = |task: &Task| stepped(&step, || (task.measure)());
            parallel::map_in_order(&tasks, run, |task, measured| {
                has_failed |= measured.is_err();
                measured.iter().filter(|_| !has_failed).for_each(|one| row(task.table, one));
            })
        };
        // The family takes long and comes last, so its measurement starts first.
        let family = || stepped(&step, || FigureFamily::address_recalculation(bench));
        let (rows, family) = parallel::both(rows, family);
        let mut tables = Self { main: Vec::new(), groups: Vec::new(), families: Vec::new() };
        for (task, one) in tasks.iter().zip(rows) {
            tables.add(task.table, one?, &topics);
        }
        tables.families.push(family?);
        for FigureFamily { title, document, rows } in &tables.families {
            rows.iter().for_each(|one| row(FigureTable::Family { title, document }, one));
        }
        Ok(tables)
    }

    fn add(&mut self, table: FigureTable, row: FigureRow, topics: &[Topic]) {
        let FigureTable::Group { title } = table else { return self.main.push(row) };
        // Rows of the same group are neighbours.
        if let Some(group) = self.groups.last_mut().filter(|group| group.title == title) {
            return group.rows.push(row);
        }
        let about = topics.iter().find(|topic| topic.title == title).map_or("", |topic| topic.about);
        self.groups.push(FigureGroup { title, about, rows: vec![row] });
    }
}

impl Figures {
    /// Calls `row` with each row and its table, in the order of the tables.
    ///
    /// # Errors
    ///
    /// Returns the first error of `row`.
    pub fn each_row<E>(&self, mut row: impl FnMut(FigureTable, &FigureRow) -> Result<(), E>) -> Result<(), E> {
        self.rows.iter().try_for_each(|one| row(FigureTable::Main, one))?;
        for group in &self.groups {
            group.rows.iter().try_for_each(|one| row(FigureTable::Group { title: group.title }, one))?;
        }
        for FigureFamily { title, document, rows } in &self.families {
            rows.iter().try_for_each(|one| row(FigureTable::Family { title, document }, one))?;
        }
        Ok(())
    }
}

fn tasks<'a>(bench: &'a Bench, topics: &'a [Topic]) -> Vec<Task<'a>> {
    let main = FIGURES
        .iter()
        .map(move |figure| Task { table: FigureTable::Main, measure: Box::new(move || row_of(bench, figure)) });
    let groups = topics.iter().flat_map(move |topic| {
        topic.measurements.iter().map(move |measurement| Task {
            table: FigureTable::Group { title: topic.title },
            measure: Box::new(move || measurement.row(bench)),
        })
    });
    main.chain(groups).collect()
}

/// Measures the figures of all topics.
///
/// # Errors
///
/// Returns the first [`StudyError`].
pub fn figure_groups(bench: &Bench) -> Result<Vec<FigureGroup>, StudyError> {
    topics().into_iter().map(|topic| FigureGroup::of(&topic, bench)).collect()
}

fn topics() -> [Topic; 3] {
    [
        Topic { title: rates::TITLE, about: rates::ABOUT, measurements: rates::measurements() },
        Topic { title: jitp::TITLE, about: jitp::ABOUT, measurements: jitp::measurements() },
        Topic { title: trackers::TITLE, about: trackers::ABOUT, measurements: trackers::measurements() },
    ]
}
