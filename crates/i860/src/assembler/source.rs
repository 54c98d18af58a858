//! Preprocessor of assembler sources. It removes comments, splits lines at `;`, and expands macros and repetitions.

use super::error::AssemblyError;
use super::operand::split;
use std::collections::BTreeMap;

/// A line of expanded source text, with the line number for error messages.
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub(super) number: usize,
    pub(super) text: String,
}

/// Greatest number of lines that macros and repetitions can produce, including lines of skipped bodies. A source can
/// therefore repeat a line a million times.
const MAX_STEPS: usize = 1 << 21;
/// Greatest size of the expanded text, in bytes. The limit is four times the size of the longest program.
const MAX_TEXT: usize = 64 << 20;
const MAX_DEPTH: u32 = 32;

/// The number of lines and bytes that macro expansion can still produce. The budget also records the source line that
/// has used the most, for the error message.
struct Budget {
    steps: usize,
    text: usize,
    /// Number of the line that is being expanded, and the budget that was left at the start of this expansion.
    current: (usize, usize),
    /// The source line that has used the most of the budget so far: its number, and the amount that the line has used.
    largest_user: (usize, usize),
}

impl Budget {
    const fn new() -> Self {
        Self { steps: MAX_STEPS, text: MAX_TEXT, current: (0, 0), largest_user: (0, 0) }
    }

    /// Returns the unused budget as one number in bytes. Lines are converted to bytes.
    const fn left(&self) -> usize {
        self.steps * (MAX_TEXT / MAX_STEPS) + self.text
    }

    fn begin(&mut self, line: usize) {
        self.largest_user = self.largest_user();
        self.current = (line, self.left());
    }

    fn largest_user(&self) -> (usize, usize) {
        let (line, before) = self.current;
        let taken = before - self.left().min(before);
        if taken > self.largest_user.1 { (line, taken) } else { self.largest_user }
    }

    fn take(&mut self, steps: usize, text: usize) -> Result<(), AssemblyFault> {
        // Both limits count down. The first limit that is exceeded stops the expansion.
        let enough = steps <= self.steps && text <= self.text;
        self.steps = self.steps.saturating_sub(steps);
        self.text = self.text.saturating_sub(text);
        if enough { Ok(()) } else { Err((self.largest_user().0, spent())) }
    }
}

/// An error of the preprocessor: the number of the source line, and a description.
type AssemblyFault = (usize, String);

fn spent() -> String {
    format!(
        "macros and repetitions are written out to more than {MAX_STEPS} lines or {MAX_TEXT} bytes, most of them by this line"
    )
}

#[derive(Clone, Debug)]
struct Macro {
    parameters: Vec<String>,
    body: Vec<Line>,
}

struct Expander<'a> {
    file: &'a str,
    macros: BTreeMap<String, Macro>,
    lines: Vec<Line>,
    calls: usize,
    budget: Budget,
}

/// Iterates over the statements of a line, which are separated by `;`. Comments, from `//` on, are left out.
fn statements(line: &str) -> impl Iterator<Item = &str> {
    let code = line.split("//").next().unwrap_or_default();
    code.split(';').map(str::trim).filter(|statement| !statement.is_empty())
}

pub(super) fn expand(file: &str, source: &str) -> Result<Vec<Line>, AssemblyError> {
    let lines = (1..).zip(source.lines());
    let lines: Vec<Line> = lines
        .flat_map(|(number, line)| statements(line).map(move |text| Line { number, text: text.to_owned() }))
        .collect();
    let mut expander = Expander { file, macros: BTreeMap::new(), lines: Vec::new(), calls: 0, budget: Budget::new() };
    expander.block(&lines, 0)?;
    Ok(expander.lines)
}

fn first_word(text: &str) -> (&str, &str) {
    text.split_once(char::is_whitespace).map_or((text, ""), |(word, rest)| (word, rest.trim()))
}

impl Expander<'_> {
    fn error(&self, line: usize, reason: impl Into<String>) -> AssemblyError {
        AssemblyError { file: self.file.to_owned(), line, reason: reason.into() }
    }

    fn take(&mut self, steps: usize, text: usize) -> Result<(), AssemblyError> {
        self.budget.take(steps, text).map_err(|(line, reason)| self.error(line, reason))
    }

    fn block(&mut self, lines: &[Line], depth: u32) -> Result<(), AssemblyError> {
        let mut at = 0;
        while let Some(line) = lines.get(at) {
            match depth {
                // Lines of the source itself do not count. Only the expansion uses the budget.
                0 => self.budget.begin(line.number),
                _ => self.take(1, line.text.len())?,
            }
            let (word, rest) = first_word(&line.text);
            at += match word {
                ".macro" => self.define(rest, &lines[at..])?,
                ".rept" => self.repeat(rest, &lines[at..], depth)?,
                ".endm" | ".endr" => return Err(self.error(line.number, format!("{word} without a beginning"))),
                _ => self.plain(line, depth)?,
            };
        }
        Ok(())
    }

    /// Returns the index, in `lines`, of the line with the word `close` (for example `.endm`) that ends a macro or
    /// repetition. The first line of `lines` contains the word `open`. Nested macros and repetitions belong to the
    /// body.
    fn body_len(&mut self, lines: &[Line], open: &str, close: &str) -> Result<usize, AssemblyError> {
        let mut depth = 0;
        for (n, line) in lines.iter().enumerate() {
            let word = first_word(&line.text).0;
            // A nested block of the same kind adds one level.
            depth += i32::from(word == open) - i32::from(word == close);
            if depth == 0 {
                self.take(n, 0)?;
                return Ok(n);
            }
        }
        Err(self.error(lines[0].number, format!("{open} without {close}")))
    }

    fn define(&mut self, header: &str, lines: &[Line]) -> Result<usize, AssemblyError> {
        let len = self.body_len(lines, ".macro", ".endm")?;
        let (name, parameters) = first_word(header);
        if name.is_empty() {
            return Err(self.error(lines[0].number, ".macro needs a name"));
        }
        let parameters = split(parameters).into_iter().map(str::to_owned).collect();
        self.macros.insert(name.to_owned(), Macro { parameters, body: lines[1..len].to_vec() });
        Ok(len + 1)
    }

    fn repeat(&mut self, count: &str, lines: &[Line], depth: u32) -> Result<usize, AssemblyError> {
        let len = self.body_len(lines, ".rept", ".endr")?;
        let count: usize =
            count.parse().map_err(|_| self.error(lines[0].number, format!(".rept needs a number, found `{count}`")))?;
        if depth >= MAX_DEPTH {
            return Err(self.error(lines[0].number, format!("repetitions and macros nest deeper than {MAX_DEPTH}")));
        }
        // An empty body needs no repetition, for any count.
        let count = if len == 1 { 0 } else { count };
        for _ in 0..count {
            self.take(1, 0)?;
            self.block(&lines[1..len], depth + 1)?;
        }
        Ok(len + 1)
    }

    fn plain(&mut self, line: &Line, depth: u32) -> Result<usize, AssemblyError> {
        let (label, statement) = split_label(&line.text);
        let (word, rest) = first_word(statement);
        let Some(called) = self.macros.get(word).cloned() else {
            self.lines.push(line.clone());
            return Ok(1);
        };
        if let Some(label) = label {
            self.lines.push(Line { number: line.number, text: format!("{label}:") });
        }
        self.call(&called, word, rest, line.number, depth)?;
        Ok(1)
    }

    fn call(&mut self, called: &Macro, name: &str, rest: &str, line: usize, depth: u32) -> Result<(), AssemblyError> {
        let arguments = split(rest);
        if depth >= MAX_DEPTH {
            return Err(self.error(line, format!("macro {name} calls itself, or macros nest deeper than {MAX_DEPTH}")));
        }
        // Every parameter needs an argument.
        if arguments.len() != called.parameters.len() {
            let expected = called.parameters.len();
            let found = arguments.len();
            return Err(self.error(line, format!("macro {name}: expected {expected} arguments, found {found}")));
        }
        // Replace the parameters in each line of the body, then expand the result.
        self.calls += 1;
        let unique = self.calls.to_string();
        let mut body = Vec::with_capacity(called.body.len());
        for own in &called.body {
            let text = substitute(&own.text, &called.parameters, &arguments, &unique, self.budget.text);
            // A line that was cut off uses one byte more than the budget, so that the expansion fails.
            let taken = text.as_ref().map_or(self.budget.text + 1, String::len);
            self.take(1, taken)?;
            body.extend(text.map(|text| Line { number: line, text }));
        }
        self.block(&body, depth + 1)
    }
}

/// Replaces each `\name` by the argument of this name, and `\@` by the text `unique`. Returns `None` if the result
/// would have more than `most` bytes.
fn substitute(text: &str, parameters: &[String], arguments: &[&str], unique: &str, most: usize) -> Option<String> {
    let mut result = String::new();
    let mut rest = text;
    // Copy the text up to each backslash, then replace the name after it.
    while let Some(at) = rest.find('\\') {
        result.push_str(&rest[..at]);
        rest = &rest[at + 1..];
        if let Some(after) = rest.strip_prefix('@') {
            result.push_str(unique);
            rest = after;
            continue;
        }
        let end = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len());
        match parameters.iter().position(|p| *p == rest[..end]) {
            Some(n) => result.push_str(arguments[n]),
            None => {
                result.push('\\');
                result.push_str(&rest[..end]);
            }
        }
        rest = &rest[end..];
        if result.len() > most {
            return None;
        }
    }
    Some(result + rest).filter(|text| text.len() <= most)
}

/// Splits `label: rest` into the label and the rest. The label is `None` if the text has no label.
pub(super) fn split_label(text: &str) -> (Option<&str>, &str) {
    match text.split_once(':') {
        Some((label, rest)) if is_name(label.trim()) => (Some(label.trim()), rest.trim()),
        _ => (None, text),
    }
}

pub(super) fn is_name(text: &str) -> bool {
    let starts = text.starts_with(|c: char| c.is_ascii_alphabetic() || "_.$".contains(c));
    starts && text.chars().all(|c| c.is_ascii_alphanumeric() || "_.$@".contains(c))
}
