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
    let points = results.about.get("points").and_then(Value::as_u64).unwrap_or_default();
    let mut about = vec![format!("{} of {points} points.", results.rows.len())];
    if shown < results.rows.len() {
        about.push(format!("The first {shown} are shown; {ROWS_FILE} and results.csv hold all."));
    }
    let settings = results.about.get("settings").and_then(Value::as_object);
    about.extend(settings.map(|all| format!("All points: {}", pairs(all))));
    let title = results.about.get("title").and_then(Value::as_str).unwrap_or("Sweep");
    tabular(title, about, &results.rows[..shown])
}

/// Returns the table of a comparison with one row for each pipeline, below its answer and its settings. Columns with
/// numbers come before columns with text.
fn comparison(results: &ResultRows) -> PageTable {
    let rows: Vec<Row> = results.rows.iter().map(numbers_first).collect();
    let around =
        results.about.iter().filter(|(key, value)| *key != "schema" && !value.is_array() && !value.is_object());
    tabular("Comparison", answer(results).into_iter().chain([pairs(around)]).collect(), &rows)
}

/// Returns a sentence about the row with the least mean error, and one about the next row, with the interval of the
/// difference. `None` if the comparison has not ended, or if no row showed every picture.
fn answer(results: &ResultRows) -> Option<String> {
    let px = |row: &Row, name: &str| rows::value(row, name).and_then(Value::as_f64);
    let mut ranked: Vec<(f64, &Row)> =
        results.rows.iter().filter_map(|row| Some((px(row, "above_best_px.mean")?, row))).collect();
    ranked.sort_by(|one, other| one.0.total_cmp(&other.0));
    let name = |row| cell(row, "pipeline");
    let (_, best) = ranked.first()?;
    let least = format!("{} has the least error, {:.2} px in the mean", name(best), px(best, "error.mean_px.mean")?);
    let Some((above, next)) = ranked.get(1) else { return Some(format!("{least}. No other row is ranked.")) };
    let more = format!("{least}. {} has {above:.2} px more", name(next));
    let ends = px(next, "above_best_px.low").zip(px(next, "above_best_px.high"));
    let Some((low, high)) = ends else { return Some(format!("{more}, which may be chance: there is no interval.")) };
    let verdict = if low > 0.0 { "a significant difference" } else { "a difference that may be chance" };
    let confidence = results.about.get("confidence").map_or_else(dash, shown);
    Some(format!("{more}, from {low:.2} to {high:.2} at a confidence of {confidence}: {verdict}."))
}

fn numbers_first(row: &Row) -> Row {
    let is_text = |(key, _): &(String, Value)| key.ends_with("definition") || key == "failure";
    let (texts, numbers): (Row, Row) = row.iter().cloned().partition(is_text);
    [numbers, texts].concat()
}

/// Returns a table with the columns in the order in which their names first occur.
fn tabular(name: &str, about: Vec<String>, rows: &[Row]) -> PageTable {
    let mut columns: Vec<String> = Vec::new();
    for (key, _) in rows.iter().flatten() {
        if !columns.contains(key) {
            columns.push(key.clone());
        }
    }
    let rows = rows.iter().map(|row| columns.iter().map(|column| cell(row, column)).collect()).collect();
    PageTable { name: name.to_owned(), about, columns, rows, ..PageTable::default() }
}

fn cell(row: &Row, column: &str) -> String {
    rows::value(row, column).map_or_else(dash, shown)
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

fn pairs<'a>(all: impl IntoIterator<Item = (&'a String, &'a Value)>) -> String {
    all.into_iter().map(|(key, value)| format!("{key} = {}", shown(value))).collect::<Vec<_>>().join(", ")
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
