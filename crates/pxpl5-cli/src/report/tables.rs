//! Folders of sweeps and comparisons, as tables.

use crate::error::CliError;
use pxpl5::sweep::ROWS_FILE;
use pxpl5::views::page::{PagePicture, PageTable};
use serde_json::{Map, Value};
use std::fs;
use std::path::Path;

const COMPARISON_FILE: &str = "comparison.json";

/// Rows of a sweep that a page holds: more are for a table program.
const MOST_ROWS: usize = 5_000;

/// Makes a table of a file's text, or says what is wrong with it.
type Reader = fn(&str) -> Result<PageTable, String>;

/// The tables of a folder; nothing where it holds neither a sweep nor a comparison.
///
/// # Errors
///
/// When its file cannot be read, or is none of these.
pub(super) fn of(folder: &Path) -> Result<Option<Vec<PageTable>>, CliError> {
    let readers: [(&str, Reader); 2] = [(ROWS_FILE, sweep), (COMPARISON_FILE, comparison)];
    for (name, read) in readers {
        let path = folder.join(name);
        if path.is_file() {
            let problem = |what: String| CliError::failure(format!("{}: {what}", path.display()));
            let text = fs::read_to_string(&path).map_err(|error| problem(error.to_string()))?;
            let table = read(&text).map_err(problem)?;
            return Ok(Some(vec![with_pictures(table, folder)]));
        }
    }
    Ok(None)
}

fn parsed(text: &str, what: &str) -> Result<Map<String, Value>, String> {
    let value = serde_json::from_str(text).map_err(|error| format!("{what}: {error}"))?;
    if let Value::Object(object) = value { Ok(object) } else { Err(format!("{what}: expected a JSON object")) }
}

fn expect_schema(object: &Map<String, Value>, expected: &str) -> Result<(), String> {
    let found = object.get("schema").and_then(Value::as_str).unwrap_or("none");
    let is_expected = found.rsplit_once('/').is_some_and(|(name, _)| name == expected);
    if is_expected { Ok(()) } else { Err(format!("schema: expected {expected}, found {found}")) }
}

/// Header and rows of a sweep; the last line of one that was interrupted may be torn and is left out.
fn sweep(text: &str) -> Result<PageTable, String> {
    let mut lines = text.split_inclusive('\n').filter(|line| line.ends_with('\n'));
    let header = parsed(lines.next().unwrap_or_default(), "line 1")?;
    expect_schema(&header, "pxpl5-sweep")?;
    let rows: Vec<Map<String, Value>> =
        lines.enumerate().map(|(n, line)| parsed(line, &format!("line {}", n + 2))).collect::<Result<_, _>>()?;
    let told = rows.len().min(MOST_ROWS);
    let flat: Vec<Vec<(String, String)>> = rows[..told].iter().map(sweep_cells).collect();
    let points = header.get("points").and_then(Value::as_u64).unwrap_or_default();
    let mut about = vec![format!("{} of {points} points.", rows.len())];
    if told < rows.len() {
        about.push(format!("The first {told} are shown; {ROWS_FILE} and results.csv hold all."));
    }
    about.extend(header.get("settings").map(|settings| format!("All points: {}", pairs(settings))));
    let title = header.get("title").and_then(Value::as_str).unwrap_or("Sweep");
    Ok(tabular(title, about, &flat))
}

/// Point, what varies, what was measured, and why there is nothing, if so.
fn sweep_cells(row: &Map<String, Value>) -> Vec<(String, String)> {
    let mut cells = Vec::new();
    for key in ["point", "status", "parameters", "measured", "error"] {
        match row.get(key) {
            Some(Value::Object(inner)) => cells.extend(inner.iter().map(|(key, value)| (key.clone(), shown(value)))),
            Some(Value::Null) | None => {}
            Some(value) => cells.push((key.to_owned(), shown(value))),
        }
    }
    cells
}

/// A row for each pipeline, a column for each value; what is a text about the row stands behind the numbers.
fn comparison(text: &str) -> Result<PageTable, String> {
    let all = parsed(text, "the file")?;
    expect_schema(&all, "pxpl5-comparison")?;
    let rows = all.get("pipelines").and_then(Value::as_array).ok_or("expected a list `pipelines`")?;
    let flat: Vec<Vec<(String, String)>> = rows.iter().map(comparison_cells).collect();
    let around = all.iter().filter(|(key, value)| *key != "schema" && !value.is_array() && !value.is_object());
    let about = around.map(|(key, value)| format!("{key}: {}", shown(value))).collect::<Vec<_>>().join(", ");
    Ok(tabular("Comparison", vec![about], &flat))
}

fn comparison_cells(row: &Value) -> Vec<(String, String)> {
    let mut cells = Vec::new();
    flatten("", row, &mut cells);
    let (texts, numbers): (Vec<_>, Vec<_>) =
        cells.into_iter().partition(|(key, _)| key.ends_with("definition") || key == "failure");
    numbers.into_iter().chain(texts).collect()
}

/// Every single value with its path; lists are left to the file.
fn flatten(path: &str, value: &Value, cells: &mut Vec<(String, String)>) {
    match value {
        Value::Object(inner) => {
            for (key, value) in inner {
                let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                flatten(&path, value, cells);
            }
        }
        Value::Array(_) => {}
        value => cells.push((path.to_owned(), shown(value))),
    }
}

/// Columns in the order in which rows bring them.
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
    row.iter().find(|(key, _)| key == column).map_or_else(|| "-".to_owned(), |(_, text)| text.clone())
}

/// What was not judged is "-", never 0; a number is rounded to what can be read.
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

/// The charts and pictures of the folder, by name.
fn with_pictures(table: PageTable, folder: &Path) -> PageTable {
    let mut names: Vec<_> = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    names.sort();
    let of_kind = |kind: &str| -> Vec<PagePicture> {
        let files = names.iter().filter(|path| path.extension().is_some_and(|found| found == kind));
        files.filter_map(|path| picture(path)).collect()
    };
    PageTable { charts: of_kind("svg"), pictures: of_kind("png"), ..table }
}

fn picture(path: &Path) -> Option<PagePicture> {
    let label = path.file_stem()?.to_string_lossy().replace('-', " ");
    Some(PagePicture { label, png: fs::read(path).ok()? })
}
