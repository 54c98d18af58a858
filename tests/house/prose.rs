//! Counts of hints that a text is hard to read: see docs/style.md. They may get better and may not get worse.

use super::crates::Crate;
use std::fs;
use std::path::Path;

/// Greatest counts of hints of unclear text in all files. Lower a limit when its count falls.
const LIMITS: Counts = Counts { openers: 0, long_comments: 0, long_sentences: 0, wide_lines: 23 };

/// Greatest number of words in a sentence.
const WORDS: usize = 35;

/// Widest line of a document, in columns.
const COLUMNS: usize = 120;

/// Words with which a comment may not begin.
const OPENERS: [&str; 5] = ["What", "Whether", "Who", "Where", "Of"];

/// Words that let a sentence lead on from the previous one.
const PRONOUNS: [&str; 12] =
    ["it", "its", "this", "they", "their", "them", "you", "your", "we", "our", "these", "those"];

/// Nouns that a sentence seldom needs after its first word "The", because a name follows them.
const LABELS: [&str; 18] = [
    "command", "column", "value", "option", "table", "page", "function", "key", "file", "program", "test", "row",
    "drawing", "figure", "crate", "module", "type", "setting",
];

#[derive(Debug, Default, PartialEq, Eq)]
struct Counts {
    /// Doc comments that begin with one of [`OPENERS`].
    openers: usize,
    /// Sentences of doc comments with more than [`WORDS`] words.
    long_comments: usize,
    /// Sentences of documents with more than [`WORDS`] words.
    long_sentences: usize,
    /// Lines of documents wider than [`COLUMNS`], outside of tables and links.
    wide_lines: usize,
}

/// Fails if a count is above its limit, and names the places, among which is the new place.
pub(crate) fn check(members: &[Crate]) {
    let mut counts = Counts::default();
    let mut places = Vec::new();
    for file in members.iter().flat_map(|member| &member.files) {
        comments(&file.text).iter().for_each(|text| counts.comment(text, &file.path, &mut places));
    }
    let mut rhythm = Rhythm::default();
    documents(Path::new(env!("CARGO_MANIFEST_DIR")), &mut |path, text| {
        counts.document(text, path, &mut places);
        rhythm.document(text);
    });
    rhythm.check();
    let found = counts.all();
    let is_within = found.iter().zip(LIMITS.all()).all(|(count, limit)| *count <= limit);
    assert!(is_within, "{counts:#?} is above {LIMITS:#?}:\n{}", places.join("\n"));
}

impl Counts {
    const fn all(&self) -> [usize; 4] {
        [self.openers, self.long_comments, self.long_sentences, self.wide_lines]
    }

    fn comment(&mut self, text: &str, path: &str, places: &mut Vec<String>) {
        if OPENERS.contains(&text.split_whitespace().next().unwrap_or_default()) {
            self.openers += 1;
            places.push(format!("{path}: opener: {}", beginning(text)));
        }
        for sentence in long_sentences(text) {
            self.long_comments += 1;
            places.push(format!("{path}: long: {}", beginning(&sentence)));
        }
    }

    fn document(&mut self, text: &str, path: &str, places: &mut Vec<String>) {
        for sentence in long_sentences(text) {
            self.long_sentences += 1;
            places.push(format!("{path}: long: {}", beginning(&sentence)));
        }
        let mut is_code = false;
        for line in text.lines() {
            is_code ^= line.trim_start().starts_with("```");
            let is_prose = !is_code && !line.trim_start().starts_with(['|', '<', '!', '-']) && !line.contains("](");
            if is_prose && line.chars().count() > COLUMNS {
                self.wide_lines += 1;
                places.push(format!("{path}: wide: {}", beginning(line)));
            }
        }
    }
}

/// Counts over the sentences of all documents.
#[derive(Debug, Default)]
struct Rhythm {
    /// Words of the whole files, with tables and code.
    words: usize,
    pronouns: usize,
    following: usize,
    the: usize,
    labels: usize,
    lengths: Vec<usize>,
}

impl Rhythm {
    fn document(&mut self, text: &str) {
        self.words += text.split_whitespace().count();
        for sentence in sentences(text).iter().filter(|sentence| sentence.split_whitespace().count() > 3) {
            let lower = sentence.to_lowercase();
            let words: Vec<&str> =
                lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
            self.lengths.push(sentence.split_whitespace().count());
            self.pronouns += words.iter().filter(|word| PRONOUNS.contains(word)).count();
            self.following += words.iter().filter(|word| **word == "following").count();
            let ["the", noun, ..] = words[..] else { continue };
            self.the += 1;
            self.labels += usize::from(LABELS.contains(&noun.strip_suffix('s').unwrap_or(noun)));
        }
    }

    /// Fails if a count is worse than it was. docs/style.md has the goals.
    fn check(&self) {
        let sentences = self.lengths.len() as f64;
        let words = self.lengths.iter().sum::<usize>() as f64;
        let mean = words / sentences;
        let squares: f64 = self.lengths.iter().map(|length| (*length as f64 - mean).powi(2)).sum();
        let deviation = (squares / sentences).sqrt();
        let share = |count: usize| 100.0 * count as f64 / sentences;
        for (what, value, limits) in [
            ("words in all documents", self.words as f64, 0.0..=81_000.0),
            ("pronouns in 100 words", 100.0 * self.pronouns as f64 / words, 1.8..=100.0),
            ("% of sentences begin with The", share(self.the), 0.0..=22.0),
            ("% of sentences begin with a label", share(self.labels), 0.0..=4.0),
            ("words of deviation of the length of sentences", deviation, 7.0..=100.0),
            ("uses of the word following", self.following as f64, 0.0..=20.0),
        ] {
            assert!(limits.contains(&value), "{value:.1} {what}, expected {limits:?}");
        }
    }
}

/// Returns the doc comments of a source, each as one text.
fn comments(source: &str) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    let mut is_inside = false;
    for line in source.lines().map(str::trim_start) {
        let text = line.strip_prefix("///").or_else(|| line.strip_prefix("//!"));
        match (text, all.last_mut().filter(|_| is_inside)) {
            (Some(text), Some(last)) => *last += &format!("\n{}", text.trim_start()),
            (Some(text), None) => all.push(text.trim_start().to_owned()),
            (None, _) => {}
        }
        is_inside = text.is_some();
    }
    all
}

/// Calls `visit` with the path and the text of every document of the repository.
fn documents(folder: &Path, visit: &mut impl FnMut(&str, &str)) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for path in entries.flatten().map(|entry| entry.path()) {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if path.is_dir()
            && !["target", "out", "node_modules"].contains(&name)
            && (name == ".github" || !name.starts_with('.'))
        {
            documents(&path, visit);
        } else if let Some(text) = name.ends_with(".md").then(|| fs::read_to_string(&path).ok()).flatten() {
            visit(&path.display().to_string(), &text);
        }
    }
}

/// Returns the sentences of more than [`WORDS`] words, without code, tables, headings and lists.
fn long_sentences(text: &str) -> Vec<String> {
    let mut prose = String::new();
    let mut is_code = false;
    for line in text.lines().map(str::trim) {
        is_code ^= line.starts_with("```");
        let is_item = line.starts_with(['|', '#', '<', '!', '-', '*']) || line.starts_with("```");
        let ends_sentence = is_code || is_item || line.is_empty();
        prose.push_str(if ends_sentence { "\n" } else { " " });
        if !is_code && !is_item {
            prose.push_str(line);
        }
    }
    let paragraphs = prose.split('\n');
    let sentences = paragraphs.flat_map(|paragraph| paragraph.split(". "));
    sentences.filter(|sentence| sentence.split_whitespace().count() > WORDS).map(str::to_owned).collect()
}

/// Returns the sentences of a document as plain text, without code, tables, headings and pictures.
fn sentences(text: &str) -> Vec<String> {
    let mut prose = String::new();
    let mut is_code = false;
    for line in text.lines().map(str::trim) {
        let is_fence = line.starts_with("```");
        is_code ^= is_fence;
        let is_skipped = is_code || is_fence || line.starts_with(['|', '#', '<', '!']);
        let item = line.strip_prefix("- ").or_else(|| line.strip_prefix("* "));
        prose.push_str(if is_skipped || line.is_empty() || item.is_some() { "\n" } else { " " });
        if !is_skipped {
            prose.push_str(item.unwrap_or(line));
        }
    }
    // Only the text of a link counts.
    let mut parts = prose.split("](");
    let mut plain = parts.next().unwrap_or_default().to_owned();
    parts.for_each(|part| plain.push_str(part.split_once(')').map_or(part, |(_, rest)| rest)));
    let plain = plain.replace(['`', '*', '_', '['], "");
    let mut all = Vec::new();
    for paragraph in plain.split('\n') {
        let mut begin = 0;
        for (at, _) in paragraph.match_indices(' ') {
            if paragraph[..at].ends_with(['.', '!', '?']) && paragraph[at + 1..].starts_with(char::is_uppercase) {
                all.push(paragraph[begin..at].to_owned());
                begin = at + 1;
            }
        }
        all.push(paragraph[begin..].to_owned());
    }
    all
}

/// Returns the first 80 characters of a text on one line.
fn beginning(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(80).collect()
}
