//! The table of pictures.

use crate::experiment::{Outcome, WARM_UP_PICTURES};
use crate::latency::{LATENCY_PARTS, LatencyParts};
use crate::pipelines::PictureTimes;
use std::collections::BTreeMap;

/// A column of the table: whole numbers, some of which can be missing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name, with the unit.
    pub name: String,
    /// What it is.
    pub definition: String,
    /// Whether a value can be missing (an empty field in CSV).
    pub optional: bool,
}

/// The columns, in order: those of [`PictureTimes`], then the parts of [`LATENCY_PARTS`].
#[must_use]
pub fn columns() -> Vec<Column> {
    let fixed = [
        (
            "picture",
            "number of the frame (Rendering Control), field (Slats, just-in-time pixels) or update (frameless)",
            false,
        ),
        ("steady", "1 for pictures after the warm-up, over which the report's statistics are; else 0", false),
        ("complete", "1 if all of the picture was there in time, else 0", false),
        ("sampled_at_ps", "when its pose was sampled", true),
        ("transform_at_ps", "start of TRANSFORM", false),
        ("copied_at_ps", "end of COPY; missing if a region never arrived", true),
        (
            "shown_at_ps",
            "the retrace from which on it is shown; the scan of its middle (just-in-time pixels) or of its last block (frameless)",
            false,
        ),
        ("latency_ps", "shown_at_ps - transform_at_ps", false),
    ];
    let fixed = fixed.map(|(name, definition, optional)| (name.to_owned(), definition.to_owned(), optional));
    let parts = LATENCY_PARTS.iter().map(|part| {
        let definition = format!("{}; missing during the warm-up", part.definition);
        (format!("{}_ps", part.name), definition, true)
    });
    let column = |(name, definition, optional)| Column { name, definition, optional };
    fixed.into_iter().chain(parts).map(column).collect()
}

/// The rows: a value for each of [`columns`].
pub(super) fn rows(outcome: &Outcome) -> Vec<Vec<Option<u64>>> {
    let parts: BTreeMap<u64, LatencyParts> =
        outcome.latency_parts().into_iter().map(|parts| (parts.picture, parts)).collect();
    let pictures = outcome.pictures().iter().enumerate();
    pictures.map(|(i, times)| row(times, i >= WARM_UP_PICTURES, parts.get(&times.picture))).collect()
}

fn row(times: &PictureTimes, steady: bool, parts: Option<&LatencyParts>) -> Vec<Option<u64>> {
    let fixed = [
        Some(times.picture),
        Some(steady.into()),
        Some(times.complete.into()),
        times.sampled_at.map(|time| time.0),
        Some(times.transform_at.0),
        times.copied_at.map(|time| time.0),
        Some(times.shown_at.0),
        Some(times.shown_at.since(times.transform_at).0),
    ];
    let spans = (0..LATENCY_PARTS.len()).map(|i| parts.map(|parts| parts.spans[i].0));
    fixed.into_iter().chain(spans).collect()
}
