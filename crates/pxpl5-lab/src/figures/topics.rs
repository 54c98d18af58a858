use super::group::Topic;
use super::{Bench, FigureGroup, jitp, rates, trackers};
use crate::error::StudyError;

/// Measures the figures of all topics.
///
/// # Errors
///
/// Returns the first [`StudyError`].
pub fn figure_groups(bench: &Bench) -> Result<Vec<FigureGroup>, StudyError> {
    let topics = [
        Topic { title: rates::TITLE, about: rates::ABOUT, measurements: rates::measurements() },
        Topic { title: jitp::TITLE, about: jitp::ABOUT, measurements: jitp::measurements() },
        Topic { title: trackers::TITLE, about: trackers::ABOUT, measurements: trackers::measurements() },
    ];
    topics.iter().map(|topic| FigureGroup::of(topic, bench)).collect()
}
