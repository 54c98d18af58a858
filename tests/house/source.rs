//! Source text, as far as the rules look into it.

/// A source without its tests: everything before the first `#[cfg(test)]`, which stands at the end of a file here, unless
/// it stands before a single line.
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

/// A source without comments.
pub(crate) fn code(text: &str) -> String {
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    lines.fold(String::new(), |all, line| all + line + "\n")
}

/// A source without what the features `files` and `threads` add; a file that is all of it is left out by its first line.
pub(crate) fn without_host_feature(text: &str) -> String {
    let is_of_the_host =
        ["files", "threads"].iter().any(|name| text.contains(&format!("#![cfg(feature = \"{name}\")]")));
    if is_of_the_host { String::new() } else { code(text) }
}

/// Whether a word stands in a text, not as a part of a longer one.
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
