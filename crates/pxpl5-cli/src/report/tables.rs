//! Tables of sweeps and comparisons for a report page.

use super::files::Files;
use crate::error::CliError;
use crate::numbers::dash;
use crate::rows::{self, ResultRows, Row, RowsKind};
use pxpl5::sweep::ROWS_FILE;
use pxpl5::views::page::{PagePicture, PageTable};
use serde_json::Value;

const MAX_ROWS: usize = 5_000;

/// Returns the tables of a results folder, or `None` if the folder holds neither a sweep nor a comparison.
pub(super) fn of(files: &Files<'_>) -> Result<Option<Vec<PageTable>>, CliError> {
    let Some(results) = rows::of(files.folder())? else { return Ok(None) };
    let table = match results.kind {
        RowsKind::Sweep => sweep(&results),
        RowsKind::Comparison => comparison(&results),
    };
    Ok(Some(vec![with_pictures(table, files)]))
}

fn sweep(results: &ResultRows) -> PageTable {
    let shown = results.rows.len().min(MAX_ROWS);
    let flat: Vec<Vec<(String, String)>> = results.rows[..shown].iter().map(cells).collect();
    let points = results.about.get("points").and_then(Value::as_u64).unwrap_or_default();
    let mut about = vec![format!("{} of {points} points.", results.rows.len())];
    if shown < results.rows.len() {
        about.push(format!("The first {shown} are shown; {ROWS_FILE} and results.csv hold all."));
    }
    about.extend(results.about.get("settings").map(|settings| format!("All points: {}", pairs(settings))));
    let title = results.about.get("title").and_then(Value::as_str).unwrap_or("Sweep");
    tabular(title, about, &flat)
}

/// Returns the table of a comparison with one row for each pipeline. Columns with numbers come before columns with
/// text.
fn comparison(results: &ResultRows) -> PageTable {
    let flat: Vec<Vec<(String, String)>> = results.rows.iter().map(numbers_first).collect();
    let around =
        results.about.iter().filter(|(key, value)| *key != "schema" && !value.is_array() && !value.is_object());
    let about = around.map(|(key, value)| format!("{key}: {}", shown(value))).collect::<Vec<_>>().join(", ");
    tabular("Comparison", vec![about], &flat)
}

fn cells(row: &Row) -> Vec<(String, String)> {
    row.iter().map(|(key, value)| (key.clone(), shown(value))).collect()
}

fn numbers_first(row: &Row) -> Vec<(String, String)> {
    let (texts, numbers): (Vec<_>, Vec<_>) =
        cells(row).into_iter().partition(|(key, _)| key.ends_with("definition") || key == "failure");
    numbers.into_iter().chain(texts).collect()
}

/// Returns a table. Each row is a list of pairs of a column name and the text of a cell. The columns have the order in
/// which their names first occur.
fn tabular(name: &str, about: Vec<String>, rows: &[Vec<(String, String)>]) -> PageTable {
    let mut columns: Vec<String> = Vec::new();
    for (key, _) in rows.iter().flatten() {
        if !columns.contains(key) {
            columns.push(key.clone());
        }
    }
    let rows = rows.iter().map(|row| columns.iter().map(|column| cell(row, column)).collect()).collect();
    PageTable { name: name.to_owned(), about, columns, rows, ..PageTable::default() }
}

fn cell(row: &[(String, String)], column: &str) -> String {
    row.iter().find(|(key, _)| key == column).map_or_else(dash, |(_, text)| text.clone())
}

/// Formats a value as a cell: "-" for null, and floating-point numbers with at most four decimals.
fn shown(value: &Value) -> String {
    match value {
        Value::Null => "-".to_owned(),
        Value::String(text) => text.clone(),
        Value::Number(number) if number.is_f64() => {
            let text = format!("{:.4}", number.as_f64().unwrap_or(f64::NAN));
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        other => other.to_string(),
    }
}

fn pairs(settings: &Value) -> String {
    let all = settings.as_object().into_iter().flatten();
    all.map(|(key, value)| format!("{key} = {}", shown(value))).collect::<Vec<_>>().join(", ")
}

/// Adds the charts and pictures in the manifest to a table, sorted by name.
fn with_pictures(table: PageTable, files: &Files<'_>) -> PageTable {
    files.warn_if_unlisted();
    let mut names: Vec<&str> = files.names().collect();
    names.sort_unstable();
    let of_kind = |kind: &str| -> Vec<PagePicture> {
        let stems = names.iter().filter_map(|name| Some((name, name.strip_suffix(kind)?)));
        let picture =
            |(name, stem): (&&str, &str)| Some(PagePicture { label: stem.replace('-', " "), png: files.read(name)? });
        stems.filter_map(picture).collect()
    };
    PageTable { charts: of_kind(".svg"), pictures: of_kind(".png"), ..table }
}
