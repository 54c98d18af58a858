use crate::markup::Element;
use serde_json::Value;
use std::fmt::Display;

pub(super) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// Returns a number with `digits` digits after the decimal point, or `-` if the value is not a number.
pub(super) fn decimal(value: &Value, digits: usize) -> String {
    value.as_f64().map_or_else(|| "-".to_owned(), |number| format!("{number:.digits$}"))
}

/// Returns a value as text, or `-` for null.
pub(super) fn text_or_dash(value: &Value) -> String {
    if value.is_null() { "-".to_owned() } else { plain(value) }
}

/// Returns a value as text, and a string without its quotes.
pub(super) fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Returns the values of a list, or an empty slice for any other value.
pub(super) fn list(value: &Value) -> &[Value] {
    value.as_array().map(Vec::as_slice).unwrap_or_default()
}

pub(super) fn heading(text: &str) -> Element {
    Element::new("h3").text(text)
}

pub(super) fn paragraph(text: impl Display) -> Element {
    Element::new("p").text(text)
}

pub(super) fn cell(text: impl Display) -> Element {
    Element::new("td").text(text)
}

pub(super) fn number_cell(text: impl Display) -> Element {
    Element::new("td").with("class", "n").text(text)
}

pub(super) fn row(cells: impl IntoIterator<Item = Element>) -> Element {
    Element::new("tr").children(cells)
}

/// Returns a table with a header row. On a narrow page, the table scrolls sideways.
pub(super) fn table(names: &[&str], rows: impl IntoIterator<Item = Element>) -> Element {
    let mut table = Element::new("table");
    if !names.is_empty() {
        table.add_line(&row(names.iter().map(|name| Element::new("th").text(name))));
    }
    for row in rows {
        table.add_line(&row);
    }
    wide(&table)
}

pub(super) fn wide(content: &Element) -> Element {
    Element::new("div").with("class", "wide").child(content)
}
