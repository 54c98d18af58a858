//! Conditional assembly: `.if`, `.else` and `.endif`.
//!
//! The conditions are evaluated before macros are expanded and before linear code is scheduled. They use the constants
//! that the lines above define.

use super::expression::{Symbols, evaluate};
use super::source::is_name;
use std::borrow::Cow;

/// An open `.if`: its line number, and which of its lines are selected.
struct Open {
    line: usize,
    /// True if the condition was true.
    taken: bool,
    /// True after `.else`.
    in_else: bool,
    /// True if the lines around this `.if` are selected.
    outer: bool,
}

impl Open {
    const fn selects(&self) -> bool {
        self.outer && self.taken != self.in_else
    }
}

/// Replaces the lines that conditions exclude, and the conditions, by empty lines. Line numbers stay the same.
///
/// # Errors
/// Returns the line number and the reason.
pub(crate) fn select(source: &str) -> Result<Cow<'_, str>, (usize, String)> {
    if !source.contains(".if") && !source.contains(".else") && !source.contains(".endif") {
        return Ok(Cow::Borrowed(source));
    }
    let mut selected = String::with_capacity(source.len());
    let mut constants = Symbols::new();
    let mut open: Vec<Open> = Vec::new();
    for (number, text) in (1..).zip(source.lines()) {
        let active = open.last().is_none_or(Open::selects);
        let code = text.split("//").next().unwrap_or_default().trim();
        let (word, rest) = code.split_once(char::is_whitespace).unwrap_or((code, ""));
        match word {
            // The condition of an excluded `.if` is not evaluated, because its constants may be missing.
            ".if" => {
                let value = if active { evaluate(rest, &constants) } else { Ok(0) };
                let taken = value.map_err(|reason| (number, format!(".if: {reason}")))? != 0;
                open.push(Open { line: number, taken, in_else: false, outer: active });
            }
            ".else" => match open.last_mut() {
                Some(open) if !open.in_else => open.in_else = true,
                _ => return Err((number, ".else without .if".to_owned())),
            },
            ".endif" => {
                open.pop().ok_or((number, ".endif without .if".to_owned()))?;
            }
            _ if active => {
                define(code, &mut constants);
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

/// Stores the constant that a line defines. A line with an unknown name is no constant for conditions: it may be linear
/// code, or use a label, whose address is not known yet.
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
