//! The façade of the library: one path for each item, and an example for each type.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Files of the façade. Their names at the root come from `pub use` lines in these files.
const FILES: [&str; 5] = ["lib.rs", "experiments.rs", "laboratory.rs", "machines.rs", "results.rs"];

fn source(file: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(file);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Returns the lines of the examples of a file.
fn examples(text: &str) -> String {
    let mut inside = false;
    let mut code = String::new();
    for line in text.lines().map(str::trim_start) {
        let Some(doc) = line.strip_prefix("///").or_else(|| line.strip_prefix("//!")) else { continue };
        if doc.contains("```") {
            inside = !inside;
        } else if inside {
            code += doc;
            code.push('\n');
        }
    }
    code
}

/// Returns the names that a file exports from other crates, each with the name of its crate and module.
///
/// The prelude and `pub use crate::` lines are lists of names that have their paths elsewhere.
fn exports(text: &str) -> Vec<(String, String)> {
    let (text, _) = text.split_once("pub mod prelude").unwrap_or((text, ""));
    let code: String = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    let mut names = Vec::new();
    for line in code.split("pub use ").skip(1) {
        let (path, _) = line.split_once(';').expect("a line ends");
        let (origin, list) = path.rsplit_once("::").unwrap_or((path, path));
        if origin.starts_with("crate") || list == "*" {
            continue;
        }
        let (origin, list) = path.split_once("::{").map_or((origin, list), |(origin, list)| (origin, list));
        let list = list.trim_end_matches('}').split(',').map(str::trim).filter(|name| !name.is_empty());
        names.extend(list.map(|name| (origin.to_owned(), name.to_owned())));
    }
    names
}

/// Returns the names of the items in a file that have a comment.
fn commented_names(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut has_comment = false;
    for line in text.lines().map(str::trim_start) {
        if line.starts_with("///") {
            has_comment = true;
        } else if !line.starts_with("#[") {
            // A macro that defines a type gets the name alone.
            let words = line.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty());
            names.extend(words.take(3).filter(|_| has_comment).map(str::to_owned));
            has_comment = false;
        }
    }
    names
}

#[test]
fn each_item_of_the_facade_has_one_path() {
    let mut paths: BTreeMap<String, usize> = BTreeMap::new();
    for (_, name) in FILES.iter().flat_map(|file| exports(&source(file))) {
        *paths.entry(name).or_default() += 1;
    }
    assert!(paths.len() > 200, "{} names", paths.len());
    let twice: Vec<_> = paths.iter().filter(|(_, count)| **count > 1).collect();
    assert!(twice.is_empty(), "exported more than once: {twice:?}");
}

#[test]
fn each_comment_of_a_re_export_describes_one_item_and_begins_with_a_summary() {
    for file in FILES {
        let text = source(file);
        let lines: Vec<&str> = text.lines().map(str::trim_start).collect();
        // A list of several names repeats the comment on the page of each name.
        let ends = (1..lines.len()).filter(|&n| lines[n].starts_with("pub use ") && lines[n - 1].starts_with("///"));
        for end in ends {
            assert!(lines[end].ends_with(';') && !lines[end].contains('{'), "{file}: {}", lines[end]);
            let begin = lines[..end].iter().rposition(|line| !line.starts_with("///")).map_or(0, |before| before + 1);
            // The first paragraph is the summary on the index page.
            assert!(lines[begin].ends_with('.') && lines[begin + 1] == "///", "{file}: {}", lines[begin]);
        }
    }
}

#[test]
fn each_item_of_the_facade_has_a_comment_in_its_crate() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates");
    let mut folders = vec![root];
    let mut commented: BTreeSet<String> = BTreeSet::new();
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                commented.extend(commented_names(&fs::read_to_string(path).expect("a source file")));
            }
        }
    }
    let names = FILES.iter().flat_map(|file| exports(&source(file))).map(|(_, name)| name);
    // Modules and functions have lower-case names. Modules have their comments in their own files.
    let is_item = |name: &String| name.starts_with(char::is_uppercase);
    let missing: Vec<String> = names.filter(is_item).filter(|name| !commented.contains(name)).collect();
    assert!(missing.is_empty(), "items without a comment: {missing:?}");
}

#[test]
fn each_type_at_the_root_is_used_in_an_example() {
    let examples: String = FILES.map(|file| examples(&source(file))).concat();
    let words: BTreeSet<&str> = examples.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    // `lib.rs` exports modules.
    let names = FILES[1..].iter().flat_map(|file| exports(&source(file))).map(|(_, name)| name);
    let is_type = |name: &String| name.starts_with(char::is_uppercase) && name.contains(char::is_lowercase);
    let missing: Vec<String> = names.filter(is_type).filter(|name| !words.contains(name.as_str())).collect();
    assert!(missing.is_empty(), "types without an example: {missing:?}");
}
