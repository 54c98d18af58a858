//! Pages of tables, such as the results of sweeps and comparisons.

use super::html::page;
use super::run::PagePicture;
use super::section::figure;
use super::values::{cell, heading, number_cell, paragraph, row, table};
use crate::markup::Element;

/// A table of results with texts, charts and pictures. If the table has no columns, the page shows only the texts,
/// charts and pictures.
#[derive(Clone, Debug, Default)]
pub struct PageTable {
    /// Heading of the table.
    pub name: String,
    /// Description of the table, with one string per paragraph.
    pub about: Vec<String>,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Rows, with one cell for each column.
    pub rows: Vec<Vec<String>>,
    /// Charts as SVG, with captions.
    pub charts: Vec<PagePicture>,
    /// Pictures as PNG, with captions.
    pub pictures: Vec<PagePicture>,
}

/// Returns a page with tables. The page needs no external resources.
pub fn html_of_tables(tables: &[PageTable]) -> String {
    page(tables.iter().map(section))
}

fn section(of: &PageTable) -> Element {
    let mut section = Element::new("section").child(&Element::new("h2").text(&of.name));
    section.end_line();
    of.about.iter().for_each(|text| section.add_line(&paragraph(text)));
    // Charts come first, because they show more than a table at a glance.
    of.charts.iter().for_each(|chart| section.add_line(&figure("image/svg+xml", chart, &chart.label)));
    let names: Vec<&str> = of.columns.iter().map(String::as_str).collect();
    if !names.is_empty() {
        section.add_line(&table(&names, of.rows.iter().map(|cells| row(cells.iter().map(|text| shown(text))))));
    }
    if of.pictures.is_empty() {
        return section;
    }
    let pictures = of.pictures.iter().map(|picture| figure("image/png", picture, &picture.label));
    section.child(&heading("Pictures")).child(&Element::new("div").with("class", "pair").children(pictures))
}

/// Returns a table cell, aligned to the right if its text is a number.
fn shown(text: &str) -> Element {
    if text == "-" || text.parse::<f64>().is_ok() { number_cell(text) } else { cell(text) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_of_tables_is_well_formed_with_escaped_text() {
        let of = PageTable {
            name: "<sweep>".to_owned(),
            about: vec!["a & b".to_owned()],
            columns: vec!["n".to_owned(), "what".to_owned()],
            rows: vec![vec!["1.5".to_owned(), "<b>".to_owned()], vec!["-".to_owned(), "x".to_owned()]],
            charts: vec![PagePicture { label: "error".to_owned(), png: b"<svg/>".to_vec() }],
            ..PageTable::default()
        };
        let page = html_of_tables(&[of]);
        roxmltree::Document::parse(page.strip_prefix("<!DOCTYPE html>\n").expect("HTML")).expect("closed");
        assert!(page.contains("&lt;b&gt;") && page.contains("<td class=\"n\">1.5</td>") && page.contains("<td>x</td>"));
        assert!(page.contains("data:image/svg+xml;base64,PHN2Zy8+"));
    }
}
