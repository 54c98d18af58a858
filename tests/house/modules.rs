//! Imports between the modules of a crate, and circles among them.

use super::crates::Crate;
use super::source;
use std::collections::{BTreeMap, BTreeSet};

/// Returns, for each module path such as `isa::decode`, the modules from which it imports. The root of a crate is the
/// empty path. Re-exports (`pub use`) do not count.
pub(crate) fn imports(member: &Crate) -> BTreeMap<String, BTreeSet<String>> {
    let sources: BTreeMap<String, String> = member
        .files
        .iter()
        .filter(|file| file.path != "main.rs" || member.files.iter().all(|other| other.path != "lib.rs"))
        .map(|file| (module_of(&file.path), source::code(&source::product(&file.text))))
        .collect();
    let handed_on: BTreeMap<&str, BTreeMap<String, String>> =
        sources.iter().map(|(module, text)| (module.as_str(), hands_on(module, text))).collect();
    let mut graph = BTreeMap::new();
    for (module, text) in &sources {
        let taken = paths(module, text).into_iter().filter_map(|path| resolve(&path, &sources, &handed_on));
        let others: BTreeSet<String> = taken.filter(|other| other != module).collect();
        graph.insert(module.clone(), others);
    }
    graph
}

fn module_of(path: &str) -> String {
    let path = path.trim_end_matches(".rs");
    let path = if path == "lib" || path == "main" { "" } else { path };
    path.trim_end_matches("/mod").replace('/', "::")
}

/// Returns the full paths, from the crate's root, of all names that a module uses with `crate::`, `super::` or
/// `self::`, and of names from its own children.
fn paths(module: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for statement in statements(text) {
        if let Some(tree) = statement.strip_prefix("use ") {
            found.extend(leaves(tree).into_iter().filter_map(|leaf| absolute(module, &leaf)));
        }
    }
    for prefix in ["crate::", "super::"] {
        for (at, _) in text.match_indices(prefix) {
            let rest: String =
                text[at..].chars().take_while(|c| c.is_alphanumeric() || *c == '_' || *c == ':').collect();
            // A path that ends before a brace is an import of several names, which were found above.
            found.extend(absolute(module, &rest).filter(|path| !path.ends_with(':')));
        }
    }
    found
}

/// Returns the `use` statements of a source, one line each, without re-exports.
fn statements(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut open: Option<String> = None;
    for line in text.lines() {
        let line = line.trim();
        if open.is_none() && line.starts_with("use ") {
            open = Some(String::new());
        }
        if let Some(statement) = &mut open {
            statement.push_str(line);
            statement.push(' ');
            if line.ends_with(';') {
                found.extend(open.take().map(|whole| whole.trim_end_matches([';', ' ']).to_owned()));
            }
        }
    }
    found
}

/// Returns the paths of a tree such as `a::{b, c::{d, e as f}}`.
fn leaves(tree: &str) -> Vec<String> {
    let tree = tree.trim();
    let Some((prefix, rest)) = tree.split_once('{') else {
        let path = tree.split(" as ").next().unwrap_or_default();
        return vec![path.trim().to_owned()];
    };
    let inner = rest.trim().trim_end_matches('}').trim();
    let inner = if rest.matches('}').count() > rest.matches('{').count() + 1 { rest } else { inner };
    split_commas(balanced(inner)).iter().flat_map(|part| leaves(part)).map(|leaf| format!("{prefix}{leaf}")).collect()
}

/// Appends the closing braces that are missing.
fn balanced(text: &str) -> String {
    let missing = text.matches('{').count().saturating_sub(text.matches('}').count());
    format!("{text}{}", "}".repeat(missing))
}

fn split_commas(text: String) -> Vec<String> {
    let mut depth = 0;
    let mut parts = vec![String::new()];
    for c in text.chars() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(String::new());
                continue;
            }
            _ => {}
        }
        parts.last_mut().expect("one at least").push(c);
    }
    parts.into_iter().map(|part| part.trim().to_owned()).filter(|part| !part.is_empty()).collect()
}

/// Returns a path from the crate's root, or `None` for another crate. A name without a prefix may be a child.
fn absolute(module: &str, path: &str) -> Option<String> {
    if let Some(rest) = path.strip_prefix("crate::") {
        return Some(rest.to_owned());
    }
    if let Some(rest) = path.strip_prefix("self::") {
        return Some(join(module, rest));
    }
    let mut base = module.to_owned();
    let mut rest = path;
    while let Some(further) = rest.strip_prefix("super::") {
        base = base.rsplit_once("::").map_or_else(String::new, |(parent, _)| parent.to_owned());
        rest = further;
    }
    Some(join(&base, rest))
}

fn join(base: &str, rest: &str) -> String {
    if base.is_empty() { rest.to_owned() } else { format!("{base}::{rest}") }
}

/// Returns the names that a module re-exports, with their origins.
fn hands_on(module: &str, text: &str) -> BTreeMap<String, String> {
    let public = text.replace("pub(crate) use ", "use ").replace("pub(super) use ", "use ").replace("pub use ", "use ");
    let mut names = BTreeMap::new();
    for statement in statements(&public) {
        let tree = statement.strip_prefix("use ").unwrap_or_default();
        for leaf in leaves(tree) {
            if let Some(path) = absolute(module, &leaf) {
                let name = path.rsplit("::").next().unwrap_or_default().to_owned();
                names.insert(name, path);
            }
        }
    }
    names
}

/// Returns the module that a path leads to: the deepest existing module, or the origin of a re-exported name.
fn resolve(
    path: &str,
    sources: &BTreeMap<String, String>,
    handed_on: &BTreeMap<&str, BTreeMap<String, String>>,
) -> Option<String> {
    let mut path = path.to_owned();
    for _ in 0..8 {
        let parts: Vec<&str> = path.split("::").collect();
        let depth = (0..=parts.len()).rev().find(|depth| sources.contains_key(&parts[..*depth].join("::")))?;
        let module = parts[..depth].join("::");
        let Some(name) = parts.get(depth) else { return Some(module) };
        match handed_on.get(module.as_str()).and_then(|names| names.get(*name)) {
            Some(further) if *further != path => path = further.clone(),
            _ if module.is_empty() && !defines(&sources[""], name) => return None,
            _ => return Some(module),
        }
    }
    None
}

fn defines(text: &str, name: &str) -> bool {
    let kinds = ["fn", "struct", "enum", "trait", "type", "const", "static", "macro_rules!"];
    kinds.iter().any(|kind| source::has_word(text, &format!("{kind} {name}")))
}

/// Returns the sets of at least two names that reach each other. The graphs are small, so a simple search is used
/// instead of Tarjan's algorithm.
pub(crate) fn circles<'a>(arrows: &BTreeMap<&'a str, Vec<&'a str>>) -> Vec<Vec<&'a str>> {
    let reach: BTreeMap<&str, BTreeSet<&str>> = arrows.keys().map(|from| (*from, reached(arrows, from))).collect();
    let mut seen: BTreeSet<&str> = BTreeSet::new();
    let mut found = Vec::new();
    for from in arrows.keys() {
        if seen.contains(from) || !reach[from].contains(from) {
            continue;
        }
        let back = |to: &&&str| reach.get(**to).is_some_and(|further| further.contains(from));
        let circle: Vec<&str> = reach[from].iter().filter(back).copied().collect();
        seen.extend(&circle);
        found.push(circle);
    }
    found
}

fn reached<'a>(arrows: &BTreeMap<&'a str, Vec<&'a str>>, from: &str) -> BTreeSet<&'a str> {
    let mut all: BTreeSet<&str> = BTreeSet::new();
    let mut next: Vec<&str> = arrows.get(from).cloned().unwrap_or_default();
    while let Some(to) = next.pop() {
        if all.insert(to) {
            next.extend(arrows.get(to).cloned().unwrap_or_default());
        }
    }
    all
}

#[test]
fn nested_imports_are_parsed() {
    let found = leaves("crate::{a::{B, c::D as E}, f::G}");
    assert_eq!(found, ["crate::a::B", "crate::a::c::D", "crate::f::G"]);
}

#[test]
fn a_circle_of_imports_is_found_and_a_chain_is_accepted() {
    let line = BTreeMap::from([("a", vec!["b"]), ("b", vec!["c"]), ("c", vec![])]);
    assert!(circles(&line).is_empty());
    let circle = BTreeMap::from([("a", vec!["b"]), ("b", vec!["c"]), ("c", vec!["a"]), ("d", vec!["a"])]);
    assert_eq!(circles(&circle), [["a", "b", "c"]]);
}
