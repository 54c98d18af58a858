//! Reader of the result rows that `pxpl5 sweep` and `pxpl5 compare` write into a folder.

use crate::error::CliError;
use crate::settings::text_of_file;
use pxpl5::compare::ROWS_FOLDER;
use pxpl5::lab::manifest::Manifest;
use pxpl5::sweep::ROWS_FILE;
use pxpl5::views::results::flat;
use pxpl5_sim::parameters::text_of;
use serde_json::{Map, Value};
use std::fs;
use std::path::Path;

const COMPARISON_FILE: &str = "comparison.json";

pub(crate) type Row = Vec<(String, Value)>;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RowsKind {
    Sweep,
    /// Rows of a comparison, one for each pipeline. The name of a value is its path in the JSON of the comparison.
    /// Lists of plain numbers are left out.
    Comparison,
}

#[derive(Debug)]
pub(crate) struct ResultRows {
    pub(crate) kind: RowsKind,
    /// Header of a sweep, or the JSON of a comparison without its rows.
    pub(crate) about: Map<String, Value>,
    pub(crate) rows: Vec<Row>,
}

/// Reads the rows in a folder. Returns `None` if the folder holds neither a sweep nor a comparison.
pub(crate) fn of(folder: &Path) -> Result<Option<ResultRows>, CliError> {
    type Reader = fn(&str) -> Result<ResultRows, String>;
    let readers: [(&str, Reader); 2] = [(ROWS_FILE, sweep), (COMPARISON_FILE, comparison)];
    let manifest = Manifest::read(folder)?;
    // The first kind of results that the folder holds is used.
    for (name, read) in readers {
        let path = folder.join(name);
        // An unlisted file belongs to another run.
        if path.is_file() && manifest.as_ref().is_none_or(|manifest| manifest.lists(name)) {
            let problem = |what: String| CliError::usage(format!("{}: {what}", path.display()));
            let listed = manifest.as_ref().map(|manifest| manifest.read_file(folder, name)).transpose()?.flatten();
            let bytes = listed.map_or_else(|| fs::read(&path), Ok).map_err(|error| problem(error.to_string()))?;
            let text = text_of(&bytes).map_err(|error| problem(error.to_string()))?;
            return read(text).map(Some).map_err(problem);
        }
    }
    unfinished(folder)
}

/// Reads the finished rows of a comparison that was interrupted or is still running.
fn unfinished(folder: &Path) -> Result<Option<ResultRows>, CliError> {
    let path = folder.join(ROWS_FOLDER).join(ROWS_FILE);
    if !path.is_file() {
        return Ok(None);
    }
    let problem = |what: String| CliError::usage(format!("{}: {what}", path.display()));
    stored_comparison(&text_of_file(&path)?).map(Some).map_err(problem)
}

/// Returns the folder of a results file, or the path itself if it is a folder.
pub(crate) fn folder_of(results: &Path) -> &Path {
    let folder = if results.is_file() { results.parent() } else { None };
    folder.map_or(results, |folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder })
}

pub(crate) fn value<'a>(row: &'a Row, name: &str) -> Option<&'a Value> {
    row.iter().find(|(key, _)| key == name).map(|(_, value)| value)
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

/// Returns the header and rows of a file of JSON lines. Drops an incomplete last line, which an interruption leaves.
fn stored(
    text: &str,
    (schema, kind): (&str, RowsKind),
    row: fn(Map<String, Value>) -> Row,
) -> Result<ResultRows, String> {
    let mut lines = text.split_inclusive('\n').filter(|line| line.ends_with('\n'));
    let about = parsed(lines.next().unwrap_or_default(), "line 1")?;
    expect_schema(&about, schema)?;
    let row = |(n, line): (usize, &str)| parsed(line, &format!("line {}", n + 2)).map(row);
    let rows = lines.enumerate().map(row).collect::<Result<_, _>>()?;
    Ok(ResultRows { kind, about, rows })
}

fn sweep(text: &str) -> Result<ResultRows, String> {
    stored(text, ("pxpl5-sweep", RowsKind::Sweep), of_point)
}

/// Returns a row with the index of the point, its parameters, the measured values, and an error if the point failed.
fn of_point(mut point: Map<String, Value>) -> Row {
    let mut row = Row::new();
    for key in ["point", "status", "parameters", "measured", "error"] {
        match point.remove(key) {
            Some(Value::Object(inner)) => row.extend(inner),
            Some(Value::Null) | None => {}
            Some(value) => row.push((key.to_owned(), value)),
        }
    }
    row
}

/// Returns the header and rows of an unfinished comparison.
fn stored_comparison(text: &str) -> Result<ResultRows, String> {
    let row = |mut line: Map<String, Value>| flat(line.remove("row").unwrap_or_default());
    stored(text, ("pxpl5-comparison-rows", RowsKind::Comparison), row)
}

fn comparison(text: &str) -> Result<ResultRows, String> {
    let mut about = parsed(text, "the file")?;
    expect_schema(&about, "pxpl5-comparison")?;
    let Some(Value::Array(pipelines)) = about.remove("pipelines") else {
        return Err("expected a list `pipelines`".to_owned());
    };
    // A nested object becomes one column for each path.
    Ok(ResultRows { kind: RowsKind::Comparison, rows: pipelines.into_iter().map(flat).collect(), about })
}
