//! The command `pxpl5 cite`, which prints how to cite the software and the papers whose systems it runs.
//!
//! The command prints the files of the folder `cite`. CITATION.cff is a copy of one of them, and paper/paper.bib begins
//! with another; tests compare the copies.

use crate::error::CliError;
use crate::terminal::print;
use crate::version::{VERSION, commit};
use clap::{Args, ValueEnum};

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

const PAPERS: &str = include_str!("cite/works.txt");

const BIBTEX: &str = include_str!("cite/works.bib");

const CFF: &str = include_str!("cite/works.cff");

pub(crate) fn run(args: CiteArgs) -> Result<(), CliError> {
    match args.format {
        Format::Text => print(&text()),
        Format::Bibtex => print(BIBTEX),
        Format::Cff => print(CFF),
    }
}

fn text() -> String {
    let commit = commit().map(|commit| format!(", commit {commit}")).unwrap_or_default();
    let title = "pxpl5: a cycle-accurate emulator of Pixel-Planes 5 and its low-latency rendering pipelines";
    let repository = env!("CARGO_PKG_REPOSITORY");
    format!("The software:\n\n  The pxpl5 developers. {title}.\n  Version {VERSION}{commit}. {repository}\n\n{PAPERS}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests that docs/guide/figures.md contains the title of each paper that `pxpl5 cite` lists.
    #[test]
    fn the_list_of_sources_has_each_cited_paper() {
        let sources = include_str!("../../../docs/guide/figures.md").to_lowercase();
        let titles = BIBTEX.lines().filter_map(|line| line.strip_prefix("  title = {{")).skip(1);
        for title in titles {
            let title = title.split([':', '}']).next().unwrap_or_default().to_lowercase();
            assert!(sources.contains(&title), "docs/guide/figures.md lacks {title}");
        }
    }

    #[test]
    fn copies_of_the_citations_and_their_version_are_current() {
        assert!(include_str!("../../../paper/paper.bib").starts_with(BIBTEX), "paper/paper.bib begins with works.bib");
        assert!(include_str!("../../../CITATION.cff") == CFF, "CITATION.cff is a copy of works.cff");
        assert!(BIBTEX.contains(&format!("  version = {{{VERSION}}},")), "works.bib");
        assert!(CFF.contains(&format!("\nversion: {VERSION}\n")), "works.cff");
    }
}
