//! Conditional assembly: `.if`, `.elseif`, `.else` and `.endif`.
//!
//! The conditions can use the constants that the lines above them define. They are evaluated before the expansion of
//! macros, and before linear stretches (code from `.linear` to `.endlinear`) are scheduled.

use super::expression::{Symbols, evaluate};
use super::source::is_name;
use std::borrow::Cow;

/// A `.if` directive whose `.endif` was not read yet.
struct Open {
    line: usize,
    /// True if this `.if` is itself in assembled code, and not in an excluded branch of another `.if`.
    outer: bool,
    selected: bool,
    /// True if a branch of this `.if` was already selected. All later branches are then excluded.
    done: bool,
    ended: bool,
}

impl Open {
    const fn branch(&mut self, holds: bool) {
        self.selected = self.outer && holds && !self.done;
        self.done |= self.selected;
    }
}

/// Replaces excluded lines and all conditional directives by empty lines, so that line numbers stay the same.
///
/// # Errors
/// Returns the line number and the reason.
pub(crate) fn select(source: &str) -> Result<Cow<'_, str>, (usize, String)> {
    if ![".if", ".else", ".endif"].iter().any(|word| source.contains(word)) {
        return Ok(Cow::Borrowed(source));
    }
    let mut selected = String::with_capacity(source.len());
    let mut constants = Symbols::new();
    let mut open: Vec<Open> = Vec::new();
    for (number, text) in (1..).zip(source.lines()) {
        let active = open.last().is_none_or(|open| open.selected);
        let code = text.split("//").next().unwrap_or_default().trim();
        let (word, rest) = code.split_once(char::is_whitespace).unwrap_or((code, ""));
        let holds = |constants| evaluate(rest, constants).map_err(|reason| (number, format!("{word}: {reason}")));
        match word {
            // The condition of an excluded branch is not evaluated, because its constants may be missing.
            ".if" => {
                let mut opened = Open { line: number, outer: active, selected: false, done: false, ended: false };
                opened.branch(active && holds(&constants)? != 0);
                open.push(opened);
            }
            ".elseif" | ".else" => {
                let Some(open) = open.last_mut().filter(|open| !open.ended) else {
                    return Err((number, format!("{word} without .if")));
                };
                open.ended = word == ".else";
                let possible = open.outer && !open.done;
                open.branch(possible && (open.ended || holds(&constants)? != 0));
            }
            ".endif" => {
                open.pop().ok_or((number, ".endif without .if".to_owned()))?;
            }
            _ if active => {
                code.split(';').for_each(|statement| define(statement.trim(), &mut constants));
                selected.push_str(text);
            }
            _ => {}
        }
        selected.push('\n');
    }
    match open.last() {
        Some(open) => Err((open.line, ".if without .endif".to_owned())),
        None => Ok(Cow::Owned(selected)),
    }
}

/// Stores the constant that the line `code` defines. Ignores a value with an unknown name. Such a line can belong to a
/// linear stretch, or use a label whose address is not known yet.
fn define(code: &str, constants: &mut Symbols) {
    let equ = code.strip_prefix(".equ").or_else(|| code.strip_prefix(".set"));
    let parts = equ.map_or_else(|| code.split_once('='), |rest| rest.split_once(','));
    if let Some((name, value)) = parts.map(|(name, value)| (name.trim(), value))
        && is_name(name)
        && let Ok(value) = evaluate(value, constants)
    {
        constants.insert(name.to_owned(), value);
    }
}
