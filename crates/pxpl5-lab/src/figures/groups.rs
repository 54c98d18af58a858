//! The measurement of all published figures.

use super::family;
use super::headline::Headline;
use super::measurement::Measurement;
use super::settings::FigureSettings;
use super::topics::{TOPICS, Topic, all};
use crate::error::StudyError;
use crate::estimate::{BUSY, Estimate};
use crate::intervals::{Interval, fill, intervals};
use crate::parallel;
use crate::study::{Study, check};
use pxpl5_sim::figures::FigureRow;
use pxpl5_sim::{SharedWatcher, Watcher};
use serde::Serialize;

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
    /// interval. The list is empty if the settings leave out intervals ([`FigureQuery::intervals`]).
    pub intervals: Vec<Interval>,
}

/// CPU seconds to measure all published figures on one core of 3 GHz, with the build profile `dist`.
const FIGURES_S: f64 = 36.0;
/// Peak memory in bytes to measure all published figures with two threads, rounded up.
const FIGURES_BYTES: f64 = 300e6;

/// The measurement of the published figures.
#[derive(Clone, Debug)]
pub struct FigureQuery {
    /// Settings of all measurements.
    pub settings: FigureSettings,
    /// True if the figures' intervals are computed too. The intervals take half of the time of all measurements.
    pub intervals: bool,
    /// The figures to measure. Empty measures all figures and the group of address recalculation.
    pub only: Vec<&'static Measurement>,
}

impl Study for FigureQuery {
    type Report = Figures;

    fn estimate(&self, threads: usize) -> Estimate {
        let measured = if self.only.is_empty() { 1.0 } else { self.only.len() as f64 / all().count() as f64 };
        let seconds = BUSY * FIGURES_S * measured / threads.max(1) as f64;
        Estimate { bytes: FIGURES_BYTES, seconds }
    }

    /// Measures all figures in parallel. The watcher gets each row with the title of its group, in the order of the
    /// tables, as soon as all earlier rows are finished. These rows have neither an interval nor an analytic value.
    fn run(&self, watcher: &mut dyn Watcher) -> Result<Figures, StudyError> {
        let is_chosen =
            |figure: &&Measurement| self.only.is_empty() || self.only.iter().any(|chosen| chosen.id == figure.id);
        let of_topic =
            |topic: &'static Topic| topic.figures.iter().filter(is_chosen).map(move |figure| (topic, figure));
        let tasks: Vec<(&Topic, &Measurement)> = TOPICS.iter().flat_map(of_topic).collect();
        let is_whole = self.only.is_empty();
        let has_intervals = self.intervals && is_whole;
        // The group of address recalculation and all intervals are a part each.
        let watcher = SharedWatcher::new(watcher, tasks.len() as u64 + u64::from(is_whole) + u64::from(has_intervals));
        let settings = FigureSettings { stop: watcher.stop(), ..self.settings.clone() };
        let mut has_failed = false;
        let rows = || {
            let run = |(_, figure): &(&Topic, &Measurement)| watcher.part(|| row_of(figure, &settings));
            parallel::map_in_order(&tasks, run, |(topic, _), measured| {
                has_failed |= measured.is_err();
                measured.iter().filter(|_| !has_failed).for_each(|one| watcher.row(topic.title, one));
            })
        };
        // The other system takes long and comes last, so its measurement starts first.
        let other = || is_whole.then(|| watcher.part(|| family::address_recalculation(&settings)));
        let vary = || if has_intervals { watcher.part(|| intervals(&settings)) } else { Vec::new() };
        let ((rows, other), intervals) = parallel::both(|| parallel::both(rows, other), vary);
        let mut groups: Vec<FigureGroup> = Vec::new();
        for ((topic, _), row) in tasks.iter().zip(rows) {
            if groups.last().is_none_or(|group| group.name != topic.name) {
                let Topic { name, title, about, .. } = **topic;
                groups.push(FigureGroup { name, title, about, document: None, rows: Vec::new() });
            }
            groups.last_mut().expect("a group").rows.push(row?);
        }
        if let Some(rows) = other.transpose()? {
            groups.push(FigureGroup {
                name: "address-recalculation",
                title: "Address recalculation and priority rendering",
                about: "Experiment E1 runs on Pixel-Planes 5, experiments E2 to E9 run with an ideal renderer.",
                document: Some("docs/address-recalculation.md"),
                rows,
            });
        }
        // After a stop, intervals are missing or too narrow.
        check(&watcher.stop())?;
        groups.iter_mut().for_each(|group| fill(&mut group.rows, &intervals));
        let others = groups.iter().filter(|group| group.document.is_some());
        others.for_each(|group| group.rows.iter().for_each(|row| watcher.row(group.title, row)));
        Ok(Figures { groups, intervals })
    }
}

impl Figures {
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

pub(super) fn row_of(figure: &Measurement, settings: &FigureSettings) -> Result<FigureRow, StudyError> {
    figure.measured_row(settings).map_err(StudyError::of_figure(figure.id))
}
