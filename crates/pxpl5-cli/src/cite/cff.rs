//! Writer of citations in the Citation File Format, version 1.2, for the file CITATION.cff.

use super::works::{Kind, Name, WORKS, Work};
use super::{AUTHOR, REPOSITORY, TITLE};
use crate::version::VERSION;
use std::fmt::Write;

pub(super) fn file() -> String {
    let mut text = format!(
        "# Written by: pxpl5 cite --format cff
cff-version: 1.2.0
message: If you use this software, please cite it and the papers whose systems you ran.
type: software
title: \"{TITLE}\"
authors:
  - name: {AUTHOR}
version: {VERSION}
license: [MIT, Apache-2.0]
repository-code: {REPOSITORY}
keywords: [graphics hardware, Pixel-Planes 5, latency, virtual reality, simulation]
references:
"
    );
    WORKS.iter().for_each(|work| text.push_str(&reference(work)));
    text
}

fn reference(work: &Work) -> String {
    let kind = match work.kind {
        Kind::Report => "report",
        Kind::Paper => "conference-paper",
    };
    let mut text = format!("  - type: {kind}\n    title: \"{}\"\n    authors:\n{}", work.title, authors(work.authors));
    // Each kind has its own key for the venue.
    let _ = match work.kind {
        Kind::Report => writeln!(text, "    institution: {{name: {}}}", work.venue),
        Kind::Paper => writeln!(text, "    collection-title: {}", work.venue),
    };
    if let Some(number) = work.number {
        let _ = writeln!(text, "    number: {number}");
    }
    let _ = writeln!(text, "    year: {}", work.year);
    if let Some([first, last]) = work.pages {
        let _ = writeln!(text, "    start: {first}\n    end: {last}");
    }
    if let Some(doi) = work.doi {
        let _ = writeln!(text, "    doi: {doi}");
    }
    text
}

fn authors(names: &[Name]) -> String {
    let lines =
        names.iter().map(|(given, family)| format!("      - {{family-names: {family}, given-names: {given}}}\n"));
    lines.collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn citation_cff_equals_the_output_of_the_command() {
        let file = include_str!("../../../../CITATION.cff");
        assert!(file == super::file(), "CITATION.cff is stale: pxpl5 cite --format cff > CITATION.cff");
    }
}
