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

/// The lengths of a source's functions in lines, from `fn` to the closing brace of the same indent.
pub(crate) fn functions(text: &str) -> Vec<(String, usize)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (begin, line) in lines.iter().enumerate() {
        let Some(name) = function_name(line) else { continue };
        let one_line = line.trim_end().ends_with('}') && line.contains('{');
        let length = if one_line {
            Some(0)
        } else {
            lines[begin..].iter().position(|other| other.trim_start().starts_with('}') && indent(other) == indent(line))
        };
        found.extend(length.map(|length| (name, length + 1)));
    }
    found
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

fn function_name(line: &str) -> Option<String> {
    let words = line.split_whitespace();
    let mut words = words.skip_while(|word| {
        word.starts_with("pub") || ["const", "async", "unsafe", "in", "crate)", "super)"].contains(word)
    });
    if words.next() != Some("fn") {
        return None;
    }
    let name = words.next()?.split(['(', '<']).next()?;
    Some(name.to_owned())
}

/// Items that a source shows to other crates, as far as their lines begin so.
pub(crate) fn public_items(text: &str) -> usize {
    text.lines().filter(|line| shows_an_item(line)).count()
}

fn shows_an_item(line: &str) -> bool {
    let kinds = ["fn ", "const fn ", "async fn ", "struct ", "enum ", "trait ", "type ", "const ", "static ", "mod "];
    let item = line.trim_start().strip_prefix("pub ");
    item.is_some_and(|item| kinds.iter().any(|kind| item.starts_with(kind)))
}
