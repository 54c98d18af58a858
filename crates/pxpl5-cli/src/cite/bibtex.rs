//! Writer of citations in the format of BibTeX.

use super::works::{Kind, WORKS, Work};
use super::{AUTHOR, REPOSITORY, TITLE};
use crate::version::VERSION;
use std::fmt::Write;

pub(super) fn entries() -> String {
    let software = [
        ("author", format!("{{{AUTHOR}}}")),
        ("title", protected(TITLE)),
        ("version", VERSION.to_owned()),
        ("url", REPOSITORY.to_owned()),
    ];
    let mut text = entry("software", "pxpl5", &software);
    WORKS.iter().for_each(|work| text.push_str(&of(work)));
    text
}

fn of(work: &Work) -> String {
    let (kind, venue) = match work.kind {
        Kind::Report => ("techreport", "institution"),
        Kind::Paper => ("inproceedings", "booktitle"),
    };
    let authors: Vec<String> = work.authors.iter().map(|(given, family)| format!("{family}, {given}")).collect();
    let mut fields = vec![
        ("author", authors.join(" and ")),
        ("title", protected(work.title)),
        (venue, work.venue.to_owned()),
        ("year", work.year.to_string()),
    ];
    fields.extend(work.number.map(|number| ("number", number.to_owned())));
    fields.extend(work.pages.map(|[first, last]| ("pages", format!("{first}--{last}"))));
    fields.extend(work.doi.map(|doi| ("doi", doi.to_owned())));
    entry(kind, work.key, &fields)
}

/// Puts the capital letters of a title in braces, because bibliography styles change unprotected capital letters to
/// small letters.
fn protected(title: &str) -> String {
    format!("{{{title}}}")
}

fn entry(kind: &str, key: &str, fields: &[(&str, String)]) -> String {
    let mut text = format!("@{kind}{{{key},\n");
    for (name, value) in fields {
        let _ = writeln!(text, "  {name} = {{{value}}},");
    }
    text + "}\n\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests that paper/paper.bib begins with the output of `pxpl5 cite --format bibtex`.
    #[test]
    fn the_bibliography_of_the_paper_begins_with_the_output_of_cite() {
        let paper = include_str!("../../../../paper/paper.bib");
        assert!(
            paper.starts_with(&entries()),
            "paper/paper.bib must begin with the output of pxpl5 cite --format bibtex"
        );
    }

    #[test]
    fn a_report_has_institution_and_number_and_a_paper_has_book_and_pages() {
        let text = entries();
        let (_, report) = text.split_once("@techreport{TR94,\n").expect("the report");
        let (report, _) = report.split_once("}\n\n").expect("its end");
        let expected = "  author = {Cohen, Jonathan and Olano, Marc},\n  title = {{Low Latency Rendering on \
                        Pixel-Planes 5}},\n  institution = {University of North Carolina at Chapel Hill},\n  year = \
                        {1994},\n  number = {TR94-028},\n";
        assert_eq!(report, expected);
        assert!(text.contains("  booktitle = {SIGGRAPH 94},\n  year = {1994},\n  pages = {155--162},\n"), "{text}");
    }
}
