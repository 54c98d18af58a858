//! The tables of ARCHITECTURE.md that are made from the crates.

use crate::FLOORS;
use crate::crates::Crate;
use crate::source;
use std::fmt::Write;
use std::path::Path;

const BEGIN: &str = "<!-- made by tests/house: begin -->\n";
const END: &str = "<!-- made by tests/house: end -->\n";

/// Compares the document with what the crates are, or writes it.
pub(crate) fn check(members: &[Crate]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("ARCHITECTURE.md");
    let text = std::fs::read_to_string(&path).expect("it is there");
    let (before, rest) = text.split_once(BEGIN).expect("the mark of the begin");
    let (_, after) = rest.split_once(END).expect("the mark of the end");
    let made = format!("{before}{BEGIN}{}{END}{after}", tables(members));
    if std::env::var_os("PXPL5_UPDATE_HOUSE").is_some() {
        return std::fs::write(&path, made).expect("it can be written");
    }
    assert!(made == text, "ARCHITECTURE.md is stale: run PXPL5_UPDATE_HOUSE=1 cargo test --test house");
}

fn tables(members: &[Crate]) -> String {
    let mut text = String::from("\n```text\n");
    for (floor, crates, _) in FLOORS.iter().rev() {
        let _ = writeln!(text, "{floor:<9} {}", crates.join("  "));
    }
    text.push_str(
        "```\n\n| crate | what it is | built of | lines | public items | functions: median, longest | longest file |\n",
    );
    text.push_str("|---|---|---|---|---|---|---|\n");
    for (_, crates, _) in FLOORS {
        crates.iter().filter_map(|name| members.iter().find(|member| member.name == *name)).for_each(|member| {
            row(&mut text, member);
        });
    }
    text.push('\n');
    text
}

fn row(text: &mut String, member: &Crate) {
    let lines: usize = member.files.iter().map(|file| file.text.lines().count()).sum();
    let public: usize = member.files.iter().map(|file| source::public_items(&source::product(&file.text))).sum();
    let mut functions: Vec<(String, usize)> =
        member.files.iter().flat_map(|file| source::functions(&source::product(&file.text))).collect();
    functions.sort_by_key(|(_, length)| *length);
    let median = functions.get(functions.len() / 2).map_or(0, |(_, length)| *length);
    let longest = functions.last().map_or_else(String::new, |(name, length)| format!("{length} (`{name}`)"));
    let file = member.files.iter().max_by_key(|file| file.text.lines().count());
    let file = file.map_or_else(String::new, |file| format!("{} ({})", file.path, file.text.lines().count()));
    let below = if member.dependencies.is_empty() { "-".to_owned() } else { member.dependencies.join(", ") };
    let _ = writeln!(
        text,
        "| {} | {} | {below} | {lines} | {public} | {median}, {longest} | {file} |",
        member.name, member.about
    );
}
