//! Counts of hints that a text is hard to read: see docs/style.md. They may get better and may not get worse.

use super::crates::Crate;
use std::fs;
use std::path::Path;

/// Greatest number of lines of documents wider than [`COLUMNS`], outside of tables and links.
const WIDE_LINES: usize = 23;

/// Widest line of a document, in columns.
const COLUMNS: usize = 120;

/// Greatest number of words in a sentence.
const WORDS: usize = 35;

/// Words with which a comment may not begin.
const OPENERS: &str = "What Whether Who Where Of";

/// Words that let a sentence lead on from the previous one.
const PRONOUNS: &str = "it its this they their them you your we our these those";

/// Nouns that a sentence seldom needs after its first word "The", because a name follows them.
const LABELS: &str = "command column value option table page function key file program test row drawing figure crate \
    module type setting";

/// Fails if there are more hints than allowed, and names the places, among which is the new place.
pub(crate) fn check(members: &[Crate]) {
    let mut places = Vec::new();
    for file in members.iter().flat_map(|member| &member.files) {
        for text in comments(&file.text) {
            let is_opener = has_word(OPENERS, text.split_whitespace().next().unwrap_or_default());
            places.extend(is_opener.then(|| format!("{}: opener: {}", file.path, beginning(&text))));
            places.extend(long_sentences(&text).map(|text| format!("{}: long: {text}", file.path)));
        }
    }
    let mut wide = Vec::new();
    let mut rhythm = Rhythm::default();
    documents(Path::new(env!("CARGO_MANIFEST_DIR")), &mut |path, text| {
        places.extend(long_sentences(text).map(|text| format!("{path}: long: {text}")));
        wide.extend(wide_lines(text).map(|text| format!("{path}: wide: {text}")));
        rhythm.document(text);
    });
    assert!(places.is_empty(), "{}", places.join("\n"));
    assert!(wide.len() <= WIDE_LINES, "{} instead of {WIDE_LINES}:\n{}", wide.len(), wide.join("\n"));
    rhythm.check();
}

/// Counts over the sentences of all documents.
#[derive(Default)]
struct Rhythm {
    /// Words of the whole files, with tables and code.
    words: usize,
    pronouns: usize,
    following: usize,
    the: usize,
    labels: usize,
    lengths: Vec<f64>,
}

impl Rhythm {
    fn document(&mut self, text: &str) {
        self.words += text.split_whitespace().count();
        for sentence in sentences(text).iter().filter(|sentence| sentence.split_whitespace().count() > 3) {
            let lower = sentence.to_lowercase();
            let words: Vec<&str> =
                lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
            self.lengths.push(sentence.split_whitespace().count() as f64);
            self.pronouns += words.iter().filter(|word| has_word(PRONOUNS, word)).count();
            self.following += words.iter().filter(|word| **word == "following").count();
            let ["the", noun, ..] = words[..] else { continue };
            self.the += 1;
            self.labels += usize::from(has_word(LABELS, noun.strip_suffix('s').unwrap_or(noun)));
        }
    }

    /// Fails if a count is worse than it was. docs/style.md has the goals.
    fn check(&self) {
        let sentences = self.lengths.len() as f64;
        let words: f64 = self.lengths.iter().sum();
        let squares: f64 = self.lengths.iter().map(|length| (length - words / sentences).powi(2)).sum();
        let share = |count: usize| 100.0 * count as f64 / sentences;
        for (what, value, limits) in [
            ("words in all documents", self.words as f64, 0.0..=62_000.0),
            ("pronouns in 100 words", 100.0 * self.pronouns as f64 / words, 1.8..=100.0),
            ("% of sentences begin with The", share(self.the), 0.0..=18.0),
            ("% of sentences begin with a label", share(self.labels), 0.0..=2.5),
            ("words of deviation of the length of sentences", (squares / sentences).sqrt(), 7.0..=100.0),
            ("uses of the word following", self.following as f64, 0.0..=6.0),
        ] {
            assert!(limits.contains(&value), "{value:.1} {what}, expected {limits:?}");
        }
    }
}

fn has_word(list: &str, word: &str) -> bool {
    list.split(' ').any(|other| other == word)
}

fn comments(source: &str) -> Vec<String> {
    let mut all = vec![String::new()];
    for line in source.lines().map(str::trim_start) {
        match (line.strip_prefix("///").or_else(|| line.strip_prefix("//!")), all.last_mut()) {
            (Some(text), Some(last)) => *last += &format!("{}\n", text.trim_start()),
            _ => all.push(String::new()),
        }
    }
    all
}

/// Calls `visit` with the path and the text of every document of the repository.
fn documents(folder: &Path, visit: &mut impl FnMut(&str, &str)) {
    for path in fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let is_made =
            ["target", "out", "node_modules", "data"].contains(&name) || name.starts_with('.') && name != ".github";
        if path.is_dir() && !is_made {
            documents(&path, visit);
        } else if name.ends_with(".md") {
            visit(&path.display().to_string(), &fs::read_to_string(&path).expect("text"));
        }
    }
}

/// Returns the sentences of a text without its code, tables, headings and pictures. An item of a list ends a sentence.
fn sentences(text: &str) -> Vec<String> {
    let mut prose = String::new();
    let mut is_code = false;
    for line in text.lines().map(str::trim) {
        let is_fence = line.starts_with("```");
        is_code ^= is_fence;
        let is_skipped = is_code || is_fence || line.starts_with(['|', '#', '<', '!']);
        let item = line.strip_prefix("- ").or_else(|| line.strip_prefix("* "));
        prose.push_str(if is_skipped || line.is_empty() || item.is_some() { "\n" } else { " " });
        prose.push_str(if is_skipped { "" } else { item.unwrap_or(line) });
    }
    for end in [". ", "? ", "! ", ".** ", ".) "] {
        prose = prose.replace(end, &format!("{}\n", end.trim_end()));
    }
    prose.lines().map(|sentence| sentence.trim().replace(['`', '*', '['], "")).collect()
}

fn long_sentences(text: &str) -> impl Iterator<Item = String> {
    sentences(text).into_iter().filter(|text| text.split_whitespace().count() > WORDS).map(|text| beginning(&text))
}

fn wide_lines(text: &str) -> impl Iterator<Item = String> {
    let mut is_code = false;
    text.lines().filter_map(move |line| {
        is_code ^= line.trim_start().starts_with("```");
        let is_prose = !is_code && !line.trim_start().starts_with(['|', '<', '!', '-']) && !line.contains("](");
        (is_prose && line.chars().count() > COLUMNS).then(|| beginning(line))
    })
}

/// Returns the first 80 characters of a text on one line.
fn beginning(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(80).collect()
}
