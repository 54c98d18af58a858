//! Source text in the forms that the rules need.

/// Returns a source without its tests: everything before the first `#[cfg(test)]` that begins a module. An attribute
/// before a single line does not count.
pub(crate) fn product(text: &str) -> String {
    let mut kept = String::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if line.trim() == "#[cfg(test)]" {
            let next = lines.next().unwrap_or_default();
            if next.trim_end().ends_with('{') {
                break;
            }
            continue;
        }
        kept.push_str(line);
        kept.push('\n');
    }
    kept
}

/// Returns a source without comments.
pub(crate) fn code(text: &str) -> String {
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    lines.fold(String::new(), |all, line| all + line + "\n")
}

/// Returns a source without the code of the features `files` and `threads`. A file that belongs to such a feature as a
/// whole states this in its first line.
pub(crate) fn without_host_feature(text: &str) -> String {
    let is_of_the_host =
        ["files", "threads"].iter().any(|name| text.contains(&format!("#![cfg(feature = \"{name}\")]")));
    if is_of_the_host { String::new() } else { code(text) }
}

/// Returns true if a text contains a word that is not part of a longer word.
pub(crate) fn has_word(text: &str, word: &str) -> bool {
    text.match_indices(word).any(|(at, _)| {
        let before = text[..at].chars().next_back();
        let after = text[at + word.len()..].chars().next();
        !before.is_some_and(part_of_name) && (word.ends_with(':') || !after.is_some_and(part_of_name))
    })
}

fn part_of_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}
