//! Source text to plain lines: comments go, macros and repetitions are written out.

use super::error::AssemblyError;
use super::operand::split;
use std::collections::BTreeMap;

/// A line of source with the number that errors name.
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub(super) number: usize,
    pub(super) text: String,
}

/// Lines that a program may expand to.
const MOST_LINES: usize = 1 << 20;
/// How deeply macros may call macros.
const MOST_DEPTH: u32 = 32;

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
}

/// Everything from `//` or `;` on is comment.
fn without_comment(text: &str) -> &str {
    let end = [text.find("//"), text.find(';')].into_iter().flatten().min();
    text[..end.unwrap_or(text.len())].trim()
}

/// Expands macros and repetitions.
pub(super) fn expand(file: &str, source: &str) -> Result<Vec<Line>, AssemblyError> {
    let plain = (1..).zip(source.lines().map(without_comment)).filter(|(_, text)| !text.is_empty());
    let lines: Vec<Line> = plain.map(|(number, text)| Line { number, text: text.to_owned() }).collect();
    let mut expander = Expander { file, macros: BTreeMap::new(), lines: Vec::new(), calls: 0 };
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

    fn block(&mut self, lines: &[Line], depth: u32) -> Result<(), AssemblyError> {
        let mut at = 0;
        while let Some(line) = lines.get(at) {
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

    /// Number of lines up to the one that closes a block; nested blocks are passed over.
    fn body_len(&self, lines: &[Line], open: &str, close: &str) -> Result<usize, AssemblyError> {
        let mut depth = 0;
        for (n, line) in lines.iter().enumerate() {
            let word = first_word(&line.text).0;
            depth += i32::from(word == open) - i32::from(word == close);
            if depth == 0 {
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
        for _ in 0..count {
            self.limit(lines[0].number)?;
            self.block(&lines[1..len], depth + 1)?;
            if len == 1 {
                break;
            }
        }
        Ok(len + 1)
    }

    fn limit(&self, line: usize) -> Result<(), AssemblyError> {
        let within = self.lines.len() < MOST_LINES && self.calls < MOST_LINES;
        if within { Ok(()) } else { Err(self.error(line, format!("more than {MOST_LINES} lines or macro calls"))) }
    }

    fn plain(&mut self, line: &Line, depth: u32) -> Result<usize, AssemblyError> {
        self.limit(line.number)?;
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
        if depth >= MOST_DEPTH {
            return Err(self.error(line, format!("macro {name} calls itself, or macros nest deeper than {MOST_DEPTH}")));
        }
        if arguments.len() != called.parameters.len() {
            let expected = called.parameters.len();
            let found = arguments.len();
            return Err(self.error(line, format!("macro {name}: expected {expected} arguments, found {found}")));
        }
        self.calls += 1;
        let unique = self.calls.to_string();
        let body: Vec<Line> = (called.body.iter())
            .map(|l| Line { number: line, text: substitute(&l.text, &called.parameters, &arguments, &unique) })
            .collect();
        self.block(&body, depth + 1)
    }
}

/// `\name` becomes the argument, `\@` a number that differs with every call.
fn substitute(text: &str, parameters: &[String], arguments: &[&str], unique: &str) -> String {
    let mut result = String::new();
    let mut rest = text;
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
    }
    result + rest
}

/// `label: rest`, or no label.
pub(super) fn split_label(text: &str) -> (Option<&str>, &str) {
    match text.split_once(':') {
        Some((label, rest)) if is_name(label.trim()) => (Some(label.trim()), rest.trim()),
        _ => (None, text),
    }
}

/// Whether it may be the name of a label.
pub(super) fn is_name(text: &str) -> bool {
    let starts = text.starts_with(|c: char| c.is_ascii_alphabetic() || "_.$".contains(c));
    starts && text.chars().all(|c| c.is_ascii_alphanumeric() || "_.$@".contains(c))
}
