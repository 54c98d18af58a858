//! The table with one row for each picture.

use super::csv_file::csv_table;
use pxpl5_measure::{HeadTimes, LATENCY_PARTS, LatencyParts, Measure, Results, head_times};
use pxpl5_run::{Outcome, PictureTimes};
use pxpl5_wire::PictureNumber;
use std::collections::{BTreeMap, BTreeSet};

/// Name and version of the table's schema. Adding a column at the end does not change the version.
pub const SCHEMA: &str = "pxpl5-pictures/2";

/// A column of the table. The values are whole numbers, and some values may be missing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name of the column, with the unit.
    pub name: String,
    /// Definition of the values, in a sentence.
    pub definition: String,
    /// True if a value may be missing, which CSV shows as an empty cell.
    pub optional: bool,
}

impl Column {
    fn always(name: &str, definition: &str) -> Self {
        Self { name: name.to_owned(), definition: definition.to_owned(), optional: false }
    }

    fn optional(name: &str, definition: &str) -> Self {
        Self { optional: true, ..Self::always(name, definition) }
    }
}

/// Returns the columns in order: first the members of [`PictureTimes`], then the parts of the latency in
/// [`LATENCY_PARTS`], then the times of the head ([`HeadTimes`]).
pub fn columns() -> Vec<Column> {
    // Identity, state and times of a picture come first.
    let mut columns = vec![
        Column::always(
            "picture",
            "number of the frame (Rendering Control), field (Slats, just-in-time pixels) or update (frameless)",
        ),
        Column::always("steady", "1 for pictures in the window of the report's statistics, else 0"),
        Column::always("complete", "1 if the picture was complete in time, else 0"),
        Column::optional("sampled_at_ps", "when its pose was sampled"),
        Column::always("transform_at_ps", "start of TRANSFORM"),
        Column::optional("copied_at_ps", "end of COPY; missing if a region never arrived"),
        Column::always(
            "shown_at_ps",
            "the retrace from which on it is shown; the scan of its middle (just-in-time pixels) or of its last block (frameless)",
        ),
        Column::optional(
            "latency_ps",
            "shown_at_ps - transform_at_ps; missing for a picture that was not complete in time",
        ),
    ];
    // The parts of the latency follow.
    columns.extend(LATENCY_PARTS.iter().map(|part| {
        Column::optional(
            &format!("{}_ps", part.name),
            &format!(
                "{}; missing outside of the window, and for a picture that was not complete in time",
                part.definition
            ),
        )
    }));
    // Columns that were added later stand at the end.
    columns.extend([
        Column::optional("measured_at_ps", "when the newest measurement in its pose was made; only with a head.motion"),
        Column::optional("aimed_at_ps", "the instant for which it was drawn; only with a head.motion"),
        Column::optional("light_at_ps", "the middle of the light of its middle; only with a head.motion"),
        Column::optional(
            "head_to_light_ps",
            "light_at_ps - measured_at_ps; missing for a picture that was not complete in time",
        ),
    ]);
    columns
}

/// Returns the rows, one for each picture that was begun. Each row has one value per column ([`columns`]), or `None`
/// for a missing value.
pub fn rows(outcome: &Outcome) -> Vec<Vec<Option<u64>>> {
    let parts: BTreeMap<PictureNumber, LatencyParts> =
        outcome.latency_parts().into_iter().map(|parts| (parts.picture, parts)).collect();
    let steady: BTreeSet<PictureNumber> = outcome.steady_pictures().iter().map(|times| times.picture).collect();
    let heads = head_times(outcome);
    let row_of = |times: &PictureTimes| {
        let (parts, head) = (parts.get(&times.picture), heads.get(&times.picture));
        row(times, steady.contains(&times.picture), parts, head)
    };
    outcome.pictures().iter().map(row_of).collect()
}

fn row(times: &PictureTimes, steady: bool, parts: Option<&LatencyParts>, head: Option<&HeadTimes>) -> Vec<Option<u64>> {
    let mut row = vec![
        Some(times.picture.0),
        Some(steady.into()),
        Some(times.is_shown().into()),
        times.sampled_at.map(|time| time.0),
        Some(times.transform_at.0),
        times.copied_at.map(|time| time.0),
        Some(times.shown_at.0),
        times.is_shown().then(|| times.shown_at.since(times.transform_at).0),
    ];
    row.extend((0..LATENCY_PARTS.len()).map(|i| parts.map(|parts| parts.spans[i].0)));
    let measured_at = head.and_then(|head| head.measured_at);
    let whole = head.zip(measured_at).filter(|_| times.is_shown());
    row.extend([
        measured_at.map(|time| time.0),
        head.map(|head| head.aimed_at.0),
        head.map(|head| head.light_at.0),
        whole.map(|(head, measured_at)| head.light_at.since(measured_at).0),
    ]);
    row
}

/// Returns the table of pictures as CSV: a line of names and a line for each picture. Lines end with a line feed.
pub fn csv(outcome: &Outcome) -> String {
    let names = columns().into_iter().map(|column| column.name);
    csv_table(names, rows(outcome).into_iter().map(as_text))
}

fn as_text(row: Vec<Option<u64>>) -> Vec<String> {
    row.into_iter().map(|value| value.map_or_else(String::new, |value| value.to_string())).collect()
}

/// Returns the quantities of a run as CSV. Each line has the name, the value and the definition of one quantity. The
/// value is empty if the run has no such value.
pub fn quantities_csv(measures: &[Measure], results: &Results) -> String {
    let rows = measures.iter().map(|measure| {
        let value = measure.of(results).map_or_else(String::new, |value| value.to_string());
        [measure.name().to_owned(), value, measure.definition().to_owned()]
    });
    csv_table(["quantity", "value", "definition"], rows)
}
