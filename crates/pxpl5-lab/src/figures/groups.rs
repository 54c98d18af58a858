//! The published figures by topic, and the measurement of all of them.

use super::measurement::Measurement;
use super::{Bench, FigureRow, Headline, family, heads, jitp, rates, rendering_control, slats, trackers};
use crate::error::StudyError;
use crate::intervals::{Interval, fill, intervals};
use crate::parallel;
use serde::Serialize;
use std::sync::atomic::{AtomicU64, Ordering};

/// Figures of one topic, as entries. A new figure is one entry in a list of a topic.
#[derive(Clone, Copy, Debug)]
pub struct Topic {
    /// Name of the topic in commands.
    pub name: &'static str,
    /// Title of the topic's section in ACCURACY.md.
    pub title: &'static str,
    /// Conditions that all experiments of the topic share, including conditions that the papers do not state.
    pub about: &'static str,
    /// The figures in the order of their numbers.
    pub figures: &'static [Measurement],
}

/// Name of the topic "Rendering Control".
pub(super) const RC: &str = "Rendering Control";
/// Name of the topic "Slats".
pub(super) const SLATS: &str = "Slats";
/// Name of the topic "From head to light".
pub(super) const HEAD: &str = "from head to light";

/// All topics with experiments on Pixel-Planes 5, in the order of their tables.
pub static TOPICS: [Topic; 6] = [
    Topic { name: "rendering-control", title: RC, about: "", figures: rendering_control::FIGURES },
    Topic { name: "slats", title: SLATS, about: "", figures: slats::FIGURES },
    Topic { name: "head-to-light", title: "From head to light", about: "", figures: heads::FIGURES },
    Topic { name: "rates", title: rates::TITLE, about: rates::ABOUT, figures: rates::FIGURES },
    Topic { name: "jitp", title: jitp::TITLE, about: jitp::ABOUT, figures: jitp::FIGURES },
    Topic { name: "trackers", title: trackers::TITLE, about: trackers::ABOUT, figures: trackers::FIGURES },
];

/// Returns the figures of all topics.
pub fn all() -> impl Iterator<Item = &'static Measurement> {
    TOPICS.iter().flat_map(|topic| topic.figures)
}

/// Returns the figures that are measured at every level of detail. The other topics always simulate events.
pub fn at_all_levels() -> impl Iterator<Item = &'static Measurement> {
    TOPICS.iter().take(3).flat_map(|topic| topic.figures)
}

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
        groups.extend(other);
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
