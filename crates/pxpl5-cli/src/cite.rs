//! The command `pxpl5 cite`, which prints how to cite the software and the papers whose systems it runs.
//!
//! [`works::WORKS`] is the only list of the papers. CITATION.cff and the first part of paper/paper.bib are written by
//! this command, and tests compare both files with its output.

mod bibtex;
mod cff;
mod works;

use crate::error::CliError;
use crate::terminal::print;
use crate::version::{VERSION, commit};
use clap::{Args, ValueEnum};
use std::fmt::Write;
use works::{Name, WORKS, Work};

/// Print how to cite this software, and the papers about the machine and its pipelines.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 cite
  pxpl5 cite --format bibtex > pxpl5.bib
  pxpl5 cite --format cff                     the file CITATION.cff")]
pub(crate) struct CiteArgs {
    /// Form of the citations.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Format {
    /// Plain text.
    Text,
    /// Entries for BibTeX.
    Bibtex,
    /// Citation File Format 1.2.
    Cff,
}

const TITLE: &str = "pxpl5: a cycle-accurate emulator of Pixel-Planes 5 and its low-latency rendering pipelines";

const AUTHOR: &str = "The pxpl5 developers";

const REPOSITORY: &str = env!("CARGO_PKG_REPOSITORY");

pub(crate) fn run(args: CiteArgs) -> Result<(), CliError> {
    print(&match args.format {
        Format::Text => text(),
        Format::Bibtex => bibtex::entries(),
        Format::Cff => cff::file(),
    })
}

fn text() -> String {
    let commit = commit().map(|commit| format!(", commit {commit}")).unwrap_or_default();
    let mut text = format!("The software:\n\n  {AUTHOR}. {TITLE}.\n  Version {VERSION}{commit}. {REPOSITORY}\n");
    text.push_str("\nThe papers; please cite those whose systems you ran:\n");
    for work in WORKS {
        let _ = write!(text, "\n  {} ({})\n  {}\n", work.systems, work.key, citation(work));
    }
    text
}

fn citation(work: &Work) -> String {
    let number = work.number.map(|number| format!(", {number}")).unwrap_or_default();
    let pages = work.pages.map(|[first, last]| format!(", pages {first} to {last}")).unwrap_or_default();
    let doi = work.doi.map(|doi| format!(". https://doi.org/{doi}")).unwrap_or_default();
    format!("{}. {}. {}{number}, {}{pages}{doi}", names(work.authors), work.title, work.venue, work.year)
}

/// Returns names as `Given Family, Given Family and Given Family`.
fn names(authors: &[Name]) -> String {
    let full: Vec<String> = authors.iter().map(|(given, family)| format!("{given} {family}")).collect();
    match full.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        _ => full.concat(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_joined_by_commas_and_the_word_and() {
        assert_eq!(names(&[("A.", "B")]), "A. B");
        assert_eq!(names(&[("A.", "B"), ("C.", "D")]), "A. B and C. D");
        assert_eq!(names(&[("A.", "B"), ("C.", "D"), ("E.", "F")]), "A. B, C. D and E. F");
    }

    /// Tests that docs/sources.md, which is written by hand, contains the short name of each paper that `pxpl5 cite`
    /// lists.
    #[test]
    fn the_list_of_sources_has_each_cited_paper() {
        let sources = include_str!("../../../docs/sources.md").to_lowercase();
        for work in WORKS {
            let title = work.title.split(':').next().unwrap_or_default().to_lowercase();
            assert!(sources.contains(&title), "docs/sources.md lacks {}", work.title);
        }
    }

    #[test]
    fn the_text_of_citations_names_the_systems_and_the_doi_of_a_paper() {
        let text = text();
        assert!(text.contains("Version 0.1.0") && text.contains("https://github.com/pxpl5/pxpl5"), "{text}");
        for system in ["Rendering Control", "Slats", "Just-in-time pixels", "Priority rendering", "SpatialGL"] {
            assert!(text.contains(system), "{system}");
        }
        assert!(text.contains("https://doi.org/10.1145/199404.199407"), "{text}");
    }
}
