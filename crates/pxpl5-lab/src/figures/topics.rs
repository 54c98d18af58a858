//! The published figures by topic.

use super::measurement::{Measurement, RC, SLATS};
use super::settings::FigureSettings;
use super::value::{FigureValue, Result};
use super::{heads, jitp, rates, rendering_control, slats, trackers};
use pxpl5_run::ExperimentError;

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

impl FigureSettings {
    /// Measures the figure with the number `id`.
    ///
    /// # Errors
    ///
    /// Returns a [`StudyError`](crate::StudyError) for an unknown figure, if the experiment fails, or if another thread sets
    /// the flag.
    pub fn measure(&self, id: &str) -> Result<FigureValue> {
        let figure = all().find(|figure| figure.id == id);
        figure.ok_or_else(|| ExperimentError::Scene(format!("there is no figure {id}")))?.value(self)
    }
}
