use super::group::Topic;
use super::{Bench, FigureError, FigureGroup, jitp, rates, trackers};

/// Measures the figures of all topics.
///
/// # Errors
///
/// Returns the first [`FigureError`].
pub fn figure_groups(bench: &Bench) -> Result<Vec<FigureGroup>, FigureError> {
    let topics = [
        Topic { title: rates::TITLE, about: rates::ABOUT, measurements: rates::measurements() },
        Topic { title: jitp::TITLE, about: jitp::ABOUT, measurements: jitp::measurements() },
        Topic { title: trackers::TITLE, about: trackers::ABOUT, measurements: trackers::measurements() },
    ];
    topics.iter().map(|topic| FigureGroup::of(topic, bench)).collect()
}
