//! The tables of a run as CSV.

use super::csv_file::csv_table;
use super::pictures::{columns, rows};
use pxpl5_measure::{Measure, Results};
use pxpl5_run::Outcome;

/// Returns the table of pictures as CSV: a line of names and a line for each picture. Lines end with a line feed.
#[must_use]
pub fn csv(outcome: &Outcome) -> String {
    let names = columns().into_iter().map(|column| column.name);
    csv_table(names, rows(outcome).into_iter().map(as_text))
}

fn as_text(row: Vec<Option<u64>>) -> Vec<String> {
    row.into_iter().map(|value| value.map_or_else(String::new, |value| value.to_string())).collect()
}

/// Returns the quantities of a run as CSV. Each line has the name, the value and the definition of one quantity. The
/// value is empty if the run has no such value.
#[must_use]
pub fn quantities_csv(measures: &[Measure], results: &Results) -> String {
    let rows = measures.iter().map(|measure| {
        let value = measure.of(results).map_or_else(String::new, |value| value.to_string());
        [measure.name().to_owned(), value, measure.definition().to_owned()]
    });
    csv_table(["quantity", "value", "definition"], rows)
}
