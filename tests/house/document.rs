//! The tables of ARCHITECTURE.md that are generated from the crates.

use super::FLOORS;
use super::crates::Crate;
use std::fmt::Write;
use std::path::Path;

const BEGIN: &str = "<!-- made by tests/house: begin -->\n";
const END: &str = "<!-- made by tests/house: end -->\n";

/// Compares the document with the crates, or updates the document.
pub(crate) fn check(members: &[Crate]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("ARCHITECTURE.md");
    let text = std::fs::read_to_string(&path).expect("it is there");
    let (before, rest) = text.split_once(BEGIN).expect("the mark of the begin");
    let (_, after) = rest.split_once(END).expect("the mark of the end");
    let made = format!("{before}{BEGIN}{}{END}{after}", tables(members));
    if std::env::var_os("PXPL5_UPDATE_HOUSE").is_some() {
        return std::fs::write(&path, made).expect("it can be written");
    }
    assert!(made == text, "ARCHITECTURE.md is stale: run PXPL5_UPDATE_HOUSE=1 cargo test -p pxpl5 --test main house");
}

fn tables(members: &[Crate]) -> String {
    let mut text = String::from("\n```text\n");
    for (floor, crates, _) in FLOORS.iter().rev() {
        let _ = writeln!(text, "{floor:<9} {}", crates.join("  "));
    }
    text.push_str("```\n\n| crate | what it is |\n|---|---|\n");
    for (_, crates, _) in FLOORS {
        for member in crates.iter().filter_map(|name| members.iter().find(|member| member.name == *name)) {
            let _ = writeln!(text, "| {} | {} |", member.name, member.about);
        }
    }
    text.push('\n');
    text
}
