//! The table as CSV.

use super::SCHEMA;
use super::origin::origin_lines;
use super::table::{columns, rows};
use crate::experiment::Outcome;
use std::fmt::Write;

/// The pictures as CSV: lines of comment, a line of names, a line for each picture; lines end with a line feed.
#[must_use]
pub fn csv(outcome: &Outcome) -> String {
    let mut text = format!("# schema: {SCHEMA}\n{}", origin_lines(&outcome.report(), "# "));
    let names: Vec<String> = columns().into_iter().map(|column| column.name).collect();
    let _ = writeln!(text, "{}", names.join(","));
    for row in rows(outcome) {
        let values: Vec<String> = row.iter().map(|value| value.map_or_else(String::new, |v| v.to_string())).collect();
        let _ = writeln!(text, "{}", values.join(","));
    }
    text
}
