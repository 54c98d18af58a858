//! The tables of figures, and the measurement of their rows in the order of the tables.

use super::group::Topic;
use super::{Bench, FIGURES, FigureFamily, FigureGroup, FigureRow, Figures, family, jitp, rates, row_of, trackers};
use crate::error::StudyError;
use crate::parallel;

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

/// Rows of all tables.
#[derive(Default)]
pub(super) struct Tables {
    pub(super) main: Vec<FigureRow>,
    pub(super) groups: Vec<FigureGroup>,
    pub(super) families: Vec<FigureFamily>,
}

/// A measurement that runs in parallel to others, and the table of its rows.
struct Task<'a> {
    table: FigureTable,
    measure: Box<dyn Fn() -> Result<Vec<FigureRow>, StudyError> + Sync + 'a>,
}

/// Returns the number of parallel measurements of all tables.
pub(super) fn n_tasks() -> usize {
    FIGURES.len() + topics().iter().map(|topic| topic.measurements.len()).sum::<usize>() + 1
}

impl Tables {
    /// Measures the rows of all tables in parallel. Calls `finished` after each measurement. Calls `row` with each row
    /// in the order of the tables, when all earlier rows are finished. Rows after a failed measurement are left out.
    pub(super) fn measure(
        bench: &Bench,
        finished: impl Fn() + Sync,
        mut row: impl FnMut(FigureTable, &FigureRow) + Send,
    ) -> Result<Self, StudyError> {
        let topics = topics();
        let tasks = tasks(bench, &topics);
        let mut has_failed = false;
        let run = |task: &Task| {
            let rows = (task.measure)();
            finished();
            rows
        };
        let done = parallel::map_in_order(&tasks, run, |task, rows| {
            has_failed |= rows.is_err();
            if !has_failed {
                rows.iter().flatten().for_each(|one| row(task.table, one));
            }
        });
        let done = done.into_iter().collect::<Result<Vec<_>, _>>()?;
        // Rows of the same table are neighbours.
        let mut tables = Self::default();
        for (task, rows) in tasks.iter().zip(done) {
            tables.add(task.table, rows, &topics);
        }
        Ok(tables)
    }

    fn add(&mut self, table: FigureTable, rows: Vec<FigureRow>, topics: &[Topic]) {
        match table {
            FigureTable::Main => self.main.extend(rows),
            FigureTable::Group { title } => match self.groups.last_mut().filter(|group| group.title == title) {
                Some(group) => group.rows.extend(rows),
                None => {
                    let about = topics.iter().find(|topic| topic.title == title).map_or("", |topic| topic.about);
                    self.groups.push(FigureGroup { title, about, rows });
                }
            },
            FigureTable::Family { title, document } => self.families.push(FigureFamily { title, document, rows }),
        }
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
    let one = |row: Result<FigureRow, StudyError>| row.map(|row| vec![row]);
    let main = FIGURES
        .iter()
        .map(move |figure| Task { table: FigureTable::Main, measure: Box::new(move || one(row_of(bench, figure))) });
    let groups = topics.iter().flat_map(move |topic| {
        topic.measurements.iter().map(move |measurement| Task {
            table: FigureTable::Group { title: topic.title },
            measure: Box::new(move || one(measurement.row(bench))),
        })
    });
    let family = Task {
        table: FigureTable::Family { title: family::TITLE, document: family::DOCUMENT },
        measure: Box::new(move || FigureFamily::address_recalculation(bench).map(|family| family.rows)),
    };
    main.chain(groups).chain([family]).collect()
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
