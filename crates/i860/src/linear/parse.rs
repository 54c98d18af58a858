//! Parser of *linear stretches* of an assembler source. A linear stretch is straight-line code from `.linear` to
//! `.endlinear`. It assigns no registers, and the scheduler chooses the order of its operations.

use super::machine::{self, Name, Width};
use super::settings::Settings;
use crate::AssemblyError;
use std::collections::HashMap;

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// Value of an earlier operation: the index of the operation, and the index of one register of the value (`None`
    /// selects all registers).
    Value(usize, Option<u8>),
    Text(String),
}

/// One line of a linear stretch: an operation with its operands.
#[derive(Clone, Debug)]
pub(super) struct Operation {
    pub(super) name: Name,
    pub(super) sources: Vec<Source>,
    /// Offset and base register of the memory address. `None` if the operation does not access memory.
    pub(super) address: Option<(String, Source)>,
    /// Indices of the stores that must precede this operation.
    pub(super) after: Vec<usize>,
    /// Register in which the code after the linear stretch expects the result. No other line of the stretch may read
    /// this register.
    pub(super) register: Option<u8>,
}

impl Operation {
    pub(super) fn reads(&self) -> impl Iterator<Item = usize> {
        let base = self.address.iter().map(|(_, base)| base);
        self.sources.iter().chain(base).filter_map(|source| match source {
            Source::Value(n, _) => Some(*n),
            Source::Text(_) => None,
        })
    }
}

fn error<T>(line: usize, reason: impl Into<String>) -> Result<T, AssemblyError> {
    Err(AssemblyError::in_line(line, reason.into()))
}

/// Parses a `.pool` line, which lists the integer registers that the scheduler can use.
pub(super) fn pool(line: usize, registers: &[&str]) -> Result<Vec<u8>, AssemblyError> {
    let number = |text: &&str| text.strip_prefix('r').and_then(|n| n.parse().ok()).filter(|n| (1..32).contains(n));
    let found: Option<Vec<u8>> = registers.iter().map(number).collect();
    found.map_or_else(|| error(line, format!("expected r1 to r31, found {registers:?}")), Ok)
}

/// Parses a `.linear` line, which begins a linear stretch and sets parameters of the scheduler.
pub(super) fn settings(line: usize, words: &[&str]) -> Result<Settings, AssemblyError> {
    let numbers: Option<Vec<u32>> = words.iter().map(|word| word.parse().ok()).collect();
    match numbers.as_deref() {
        Some([]) => Ok(Settings::default()),
        Some([window, eagerness, reserve, slope, shake]) => Ok(Settings {
            window: *window as usize,
            eagerness: *eagerness,
            reserve: *reserve as usize,
            slope: *slope as usize,
            shake: *shake,
        }),
        _ => error(line, format!("expected window, eagerness, reserve, slope and shake, found {words:?}")),
    }
}

pub(super) fn operations(block: &[(usize, &str)]) -> Result<Vec<Operation>, AssemblyError> {
    let mut parser = Parser::default();
    for (line, text) in repeated(block)? {
        parser.line(line, &text)?;
    }
    Ok(parser.operations)
}

fn without_comment(text: &str) -> &str {
    text.split("//").next().unwrap_or_default().trim()
}

fn repeated(block: &[(usize, &str)]) -> Result<Vec<(usize, String)>, AssemblyError> {
    let lines: Vec<(usize, String)> = block.iter().map(|(n, text)| (*n, without_comment(text).to_owned())).collect();
    repeat(&lines)
}

fn repeat(lines: &[(usize, String)]) -> Result<Vec<(usize, String)>, AssemblyError> {
    let mut out = Vec::new();
    let mut at = 0;
    while let Some((line, text)) = lines.get(at) {
        at += 1;
        let words: Vec<&str> = text.split_whitespace().collect();
        match words.as_slice() {
            [] => {}
            ["for", variable, values @ ..] => {
                // Find the `endfor` of this loop, then repeat the body of the loop for each value.
                let end = at
                    + matching_end(&lines[at..])
                        .ok_or_else(|| AssemblyError::in_line(*line, "`for` without `endfor`".to_owned()))?;
                for value in values {
                    let name = format!("${variable}");
                    let body: Vec<_> =
                        lines[at..end].iter().map(|(n, text)| (*n, text.replace(&name, value))).collect();
                    out.extend(repeat(&body)?);
                }
                at = end + 1;
            }
            _ => out.push((*line, text.clone())),
        }
    }
    Ok(out)
}

fn matching_end(lines: &[(usize, String)]) -> Option<usize> {
    let mut depth = 0;
    lines.iter().position(|(_, text)| {
        let first = text.split_whitespace().next();
        if first == Some("endfor") && depth == 0 {
            return true;
        }
        depth += usize::from(first == Some("for"));
        depth -= usize::from(first == Some("endfor"));
        false
    })
}

#[derive(Default)]
struct Parser {
    operations: Vec<Operation>,
    values: HashMap<String, usize>,
    marks: HashMap<String, usize>,
}

impl Parser {
    fn line(&mut self, line: usize, text: &str) -> Result<(), AssemblyError> {
        // Split off the mark of a store, the result, and the stores to wait for.
        let (text, mark) = split_mark(text);
        let (dest, text) = match text.split_once('=') {
            Some((dest, rest)) => (Some(dest.trim()), rest.trim()),
            None => (None, text),
        };
        let (text, awaited) = match text.split_once('!') {
            Some((text, marks)) => (text.trim(), marks.split('!').map(str::trim).collect()),
            None => (text, Vec::new()),
        };
        let (word, operands) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let Some(name) = machine::named(word) else { return error(line, format!("`{word}` is not an operation")) };
        if name.result.is_some() != dest.is_some() {
            return error(line, format!("`{word}`: a result is named exactly where there is one"));
        }
        let mut operation = self.operation(line, name, operands, &awaited)?;
        operation.register = dest.and_then(integer_register);
        // Add the operation and its names, which only later lines may use.
        let number = self.operations.len();
        self.operations.push(operation);
        if let Some(dest) = dest
            && self.values.insert(dest.to_owned(), number).is_some()
        {
            return error(line, format!("`{dest}` is named twice"));
        }
        if let Some(mark) = mark {
            self.marks.insert(mark.to_owned(), number);
        }
        Ok(())
    }

    fn operation(&self, line: usize, name: Name, operands: &str, awaited: &[&str]) -> Result<Operation, AssemblyError> {
        let mut operands: Vec<&str> = operands.split(',').map(str::trim).filter(|text| !text.is_empty()).collect();
        // The address is the last operand.
        let address = match name.addresses {
            true => Some(self.address(line, operands.pop().unwrap_or_default())?),
            false => None,
        };
        if operands.len() != name.sources {
            return error(line, format!("expected {} sources, found {}", name.sources, operands.len()));
        }
        let sources = operands.iter().map(|text| self.source(line, text)).collect::<Result<_, _>>()?;
        // Marks refer to earlier stores.
        let marked = |mark: &&str| match self.marks.get(*mark) {
            Some(n) => Ok(*n),
            None => error(line, format!("no store is marked `{mark}`")),
        };
        let after = awaited.iter().map(marked).collect::<Result<_, _>>()?;
        Ok(Operation { name, sources, address, after, register: None })
    }

    fn address(&self, line: usize, text: &str) -> Result<(String, Source), AssemblyError> {
        let parts = text.strip_suffix(')').and_then(|text| text.rsplit_once('('));
        let Some((offset, base)) = parts else { return error(line, format!("expected offset(base), found `{text}`")) };
        Ok((offset.to_owned(), self.source(line, base)?))
    }

    fn source(&self, line: usize, text: &str) -> Result<Source, AssemblyError> {
        // A part after a dot selects one register of a value.
        let (name, part) = match text.rsplit_once('.') {
            Some((name, part)) => (name, part.parse().ok()),
            None => (text, None),
        };
        if let Some(n) = self.values.get(name).filter(|_| integer_register(text).is_none()) {
            let width = self.operations[*n].name.result.map_or(0, Width::registers);
            if part.is_some_and(|part: u8| usize::from(part) >= width) {
                return error(line, format!("`{text}`: the value has {width} registers"));
            }
            return Ok(Source::Value(*n, part));
        }
        // Other sources are registers, or constants in capitals or digits.
        let register = integer_register(text).is_some();
        let constant = text.starts_with(|c: char| c.is_ascii_digit() || c == '-' || c.is_ascii_uppercase());
        match register || constant || text == "f0" {
            true => Ok(Source::Text(text.to_owned())),
            false => error(line, format!("`{text}` has no value yet")),
        }
    }
}

fn integer_register(text: &str) -> Option<u8> {
    text.strip_prefix('r').and_then(|n| n.parse().ok()).filter(|n| *n < 32)
}

/// Splits a line of a store into its mark `@name` (if any) and the rest. A load that must wait for this store names the
/// mark.
fn split_mark(text: &str) -> (&str, Option<&str>) {
    match text.strip_prefix('@').and_then(|text| text.split_once(char::is_whitespace)) {
        Some((mark, rest)) => (rest.trim(), Some(mark)),
        None => (text, None),
    }
}
