//! Values of a report as they stand on a page.

use crate::markup::Element;
use serde_json::Value;
use std::fmt::Display;

/// A number; not a number where there is none.
pub(super) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// A number with so many digits behind the point; `-` where there is none.
pub(super) fn decimal(value: &Value, digits: usize) -> String {
    value.as_f64().map_or_else(|| "-".to_owned(), |number| format!("{number:.digits$}"))
}

/// A value as text; `-` where there is none.
pub(super) fn known(value: &Value) -> String {
    if value.is_null() { "-".to_owned() } else { plain(value) }
}

/// A value as text, without the quotes of a string.
pub(super) fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// The values of a list; none of anything else.
pub(super) fn list(value: &Value) -> &[Value] {
    value.as_array().map(Vec::as_slice).unwrap_or_default()
}

/// A heading within a section.
pub(super) fn heading(text: &str) -> Element {
    Element::new("h3").text(text)
}

/// A paragraph.
pub(super) fn paragraph(text: impl Display) -> Element {
    Element::new("p").text(text)
}

/// A cell of a table with text.
pub(super) fn cell(text: impl Display) -> Element {
    Element::new("td").text(text)
}

/// A cell of a table with a number, which stands right.
pub(super) fn number_cell(text: impl Display) -> Element {
    Element::new("td").with("class", "n").text(text)
}

/// A row of a table.
pub(super) fn row(cells: impl IntoIterator<Item = Element>) -> Element {
    Element::new("tr").children(cells)
}

/// A table with a row of names, to be scrolled sideways where the page is narrow.
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

/// Something that may be wider than the page.
pub(super) fn wide(content: &Element) -> Element {
    Element::new("div").with("class", "wide").child(content)
}
