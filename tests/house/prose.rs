//! Counts of hints that a text is hard to read. Each count may fall and may not rise: see docs/style.md.

use super::crates::Crate;
use std::fs;
use std::path::Path;

/// Greatest counts of hints of unclear text in all files. Lower a limit when its count falls.
const LIMITS: Counts = Counts { openers: 0, long_comments: 0, long_sentences: 0, idioms: 4, wide_lines: 23 };

/// Greatest number of words in a sentence.
const WORDS: usize = 35;

/// Widest line of a document, in columns.
const COLUMNS: usize = 120;

/// Words with which a comment may not begin.
const OPENERS: [&str; 5] = ["What", "Whether", "Who", "Where", "Of"];

const IDIOMS: [&str; 8] =
    ["somebody", "nobody", "whoever", "in parts of", "what of", "told late", "given up", "given away"];

#[derive(Debug, Default, PartialEq, Eq)]
struct Counts {
    /// Doc comments that begin with one of [`OPENERS`].
    openers: usize,
    /// Sentences of doc comments with more than [`WORDS`] words.
    long_comments: usize,
    /// Sentences of documents with more than [`WORDS`] words.
    long_sentences: usize,
    /// Uses of [`IDIOMS`] in doc comments and documents.
    idioms: usize,
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
    documents(Path::new(env!("CARGO_MANIFEST_DIR")), &mut |path, text| counts.document(text, path, &mut places));
    let found = counts.all();
    let is_within = found.iter().zip(LIMITS.all()).all(|(count, limit)| *count <= limit);
    assert!(is_within, "{counts:#?} is above {LIMITS:#?}:\n{}", places.join("\n"));
}

impl Counts {
    const fn all(&self) -> [usize; 5] {
        [self.openers, self.long_comments, self.long_sentences, self.idioms, self.wide_lines]
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
        self.idioms(text, path, places);
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
        self.idioms(text, path, places);
    }

    fn idioms(&mut self, text: &str, path: &str, places: &mut Vec<String>) {
        // Compare whole words: the letters of an idiom can end a longer word.
        let words: String =
            text.to_lowercase().chars().map(|c| if c.is_alphabetic() || c == '_' { c } else { ' ' }).collect();
        let words = format!(" {} ", words.split_whitespace().collect::<Vec<_>>().join(" "));
        for idiom in IDIOMS.iter().filter(|idiom| words.contains(&format!(" {idiom} "))) {
            self.idioms += 1;
            places.push(format!("{path}: idiom: {idiom}"));
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

/// Returns the first 80 characters of a text on one line.
fn beginning(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(80).collect()
}
