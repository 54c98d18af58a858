//! The measurement of all published figures.

use super::bench::Bench;
use super::family;
use super::headline::Headline;
use super::measurement::Measurement;
use super::topics::{TOPICS, Topic};
use crate::error::StudyError;
use crate::intervals::{Interval, fill, intervals};
use crate::parallel;
use pxpl5_sim::figures::FigureRow;
use serde::Serialize;
use std::sync::atomic::{AtomicU64, Ordering};

/// Published figures of one topic, with the model's values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FigureGroup {
    /// Name of the topic in commands.
    pub name: &'static str,
    /// Title of the topic.
    pub title: &'static str,
    /// Conditions that all experiments of the group share.
    pub about: &'static str,
    /// Path of a document with more details. `None` if ACCURACY.md has all details.
    pub document: Option<&'static str>,
    /// Table rows of the figures.
    pub rows: Vec<FigureRow>,
}

/// All published figures with the model's values and intervals.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Groups of [`TOPICS`], and then the group of the papers on address recalculation.
    pub groups: Vec<FigureGroup>,
    /// Interval of each figure while the unpublished parameters vary. Figures that depend only on scenes have no
    /// interval. The list is empty if the settings leave out intervals ([`Bench::without_intervals`]).
    pub intervals: Vec<Interval>,
}

impl Figures {
    /// Measures all figures in parallel, with their intervals if the settings include intervals. Calls `finished` with
    /// the number of finished steps and the number of all steps. Calls `row` with each row and its group, in the order
    /// of the tables, as soon as all earlier rows are finished. These rows have neither an interval nor an analytic
    /// value.
    ///
    /// # Errors
    ///
    /// Returns the first [`StudyError`].
    pub fn run(
        bench: &Bench,
        finished: impl Fn(u64, u64) + Sync,
        mut row: impl FnMut(&'static str, &FigureRow) + Send,
    ) -> Result<Self, StudyError> {
        let tasks: Vec<(&Topic, &Measurement)> =
            TOPICS.iter().flat_map(|topic| topic.figures.iter().map(move |figure| (topic, figure))).collect();
        // The last two steps are the group of address recalculation and all intervals.
        let steps = tasks.len() as u64 + 2;
        let done = AtomicU64::new(0);
        let step = || finished(done.fetch_add(1, Ordering::Relaxed) + 1, steps);
        let mut has_failed = false;
        let rows = || {
            let run = |(_, figure): &(&Topic, &Measurement)| stepped(&step, || row_of(figure, bench));
            parallel::map_in_order(&tasks, run, |(topic, _), measured| {
                has_failed |= measured.is_err();
                measured.iter().filter(|_| !has_failed).for_each(|one| row(topic.title, one));
            })
        };
        // The other system takes long and comes last, so its measurement starts first.
        let other = || stepped(&step, || family::address_recalculation(bench));
        let vary = || stepped(&step, || if bench.intervals { intervals(bench) } else { Vec::new() });
        let ((rows, other), intervals) = parallel::both(|| parallel::both(rows, other), vary);
        let mut rows = rows.into_iter();
        let mut groups = Vec::new();
        for Topic { name, title, about, figures } in TOPICS {
            let rows = rows.by_ref().take(figures.len()).collect::<Result<_, _>>()?;
            groups.push(FigureGroup { name, title, about, document: None, rows });
        }
        groups.push(FigureGroup {
            name: "address-recalculation",
            title: "Address recalculation and priority rendering",
            about: "Experiment E1 runs on Pixel-Planes 5, experiments E2 to E9 run with an ideal renderer.",
            document: Some("docs/address-recalculation.md"),
            rows: other?,
        });
        // After a stop, intervals are missing or too narrow.
        bench.stop.check().map_err(StudyError::of_figure("intervals"))?;
        groups.iter_mut().for_each(|group| fill(&mut group.rows, &intervals));
        if let Some(other) = groups.last() {
            other.rows.iter().for_each(|one| row(other.title, one));
        }
        Ok(Self { groups, intervals })
    }

    /// Returns the rows of all topics, without the group of address recalculation.
    pub fn rows(&self) -> impl Iterator<Item = &FigureRow> {
        self.groups.iter().filter(|group| group.document.is_none()).flat_map(|group| &group.rows)
    }

    /// Returns the row with the number `id`.
    pub fn row(&self, id: &str) -> Option<&FigureRow> {
        self.rows().find(|row| row.id == id)
    }

    /// Returns the mean errors and misses over the rows of all topics.
    pub fn headline(&self) -> Headline {
        Headline::of(self.rows())
    }
}

pub(super) fn row_of(figure: &Measurement, bench: &Bench) -> Result<FigureRow, StudyError> {
    figure.measured_row(bench).map_err(StudyError::of_figure(figure.id))
}

pub(super) fn stepped<T>(step: &impl Fn(), part: impl FnOnce() -> T) -> T {
    let result = part();
    step();
    result
}
