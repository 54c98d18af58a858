//! Assembler for the i860 in Intel's syntax. Operands are written `operation src1, src2, dest`, and addresses `8(r4)`,
//! `r5(r4)` or `8(r4)++`.
//!
//! | written | meaning |
//! |---|---|
//! | `label:` | the current address |
//! | `name = expression`, `.equ name, expression` | a constant |
//! | `.org`, `.align`, `.space` | address directives; gaps between instructions are filled with `nop` |
//! | `.long .short .byte .float .double` | data |
//! | `.macro name a, b` … `.endm` | `\a` is an argument, `\@` a number unique to the call |
//! | `.rept n` … `.endr` | repetition |
//! | `h%x l%x ha%x` | high half, low half, and high half for use with a sign-extended `l%x` |
//! | `mov`, `nop`, `fmov.ss .dd .sd .ds` | the usual pseudo-operations; `mov constant, r` takes one or two words |
//! | `;` | separates instructions on one line |
//! | `// text` | a comment |
//!
//! After all addresses are known, the assembler checks every instruction. The module `check` lists the rules.

mod check;
mod conditions;
mod error;
mod expression;
mod listing;
mod operand;
mod source;

pub use check::Rule;
pub(crate) use conditions::select;
pub use error::{AssemblyError, AssemblyErrors, AssemblyWarning};

use crate::encode::encode;
use crate::instruction::{Flags, Instruction, Op};
use crate::mnemonic::lookup;
use expression::{Symbols, evaluate};
use operand::Filler;
use source::{Line, is_name, split_label};
use std::collections::BTreeMap;

/// An assembled program with its labels and source lines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// Memory address of the first byte of the program.
    pub base: u32,
    /// All bytes of the program from address `base` on, including the bytes of gaps.
    pub bytes: Vec<u8>,
    /// Value of each name: the address of a label or the value of a constant.
    pub symbols: BTreeMap<String, u32>,
    /// Name and address of each label, sorted by address.
    pub labels: Vec<(String, u32)>,
    /// Address and source line number of every instruction, sorted by address. After [`link`], line numbers start again
    /// at 1 in each source text.
    pub lines: Vec<(u32, usize)>,
    /// Data blocks of the program, sorted by address.
    pub data: Vec<Data>,
    pub warnings: Vec<AssemblyWarning>,
}

/// A block of bytes that one directive puts into memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Data {
    pub address: u32,
    /// Size of the data block in bytes.
    pub bytes: u32,
    /// Line number of the directive in its source text.
    pub line: usize,
    pub kind: DataKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DataKind {
    /// Integers of `.byte`, `.short` or `.long`, with their size in bytes.
    Integers(u32),
    Singles,
    Doubles,
    /// Bytes that the directives `.align`, `.org` and `.space` skip.
    Gap,
}

impl Program {
    /// Makes a program from machine code. The program has no labels and no line numbers.
    pub fn of_bytes(base: u32, bytes: Vec<u8>) -> Program {
        Program {
            base,
            bytes,
            symbols: BTreeMap::new(),
            labels: Vec::new(),
            lines: Vec::new(),
            data: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// Returns the program as little-endian 32-bit words. The last word is padded with zero bytes.
    pub fn words(&self) -> Vec<u32> {
        self.bytes.chunks(4).map(word_of).collect()
    }

    pub fn symbol(&self, name: &str) -> Option<u32> {
        self.symbols.get(name).copied()
    }
}

/// Assembles independent source texts into one program. The code of each source begins at a multiple of 32 bytes. If
/// several sources define the same label, the program keeps the first definition.
///
/// # Errors
/// Returns the errors of [`assemble`] for the first source that has errors.
///
/// ```
/// let program = i860::link(0x1000, &[("one.s", "start: bri r1\n nop"), ("two.s", "start: nop\nother: bri r1\n nop")]).unwrap();
/// assert_eq!([program.symbol("start"), program.symbol("other")], [Some(0x1000), Some(0x1024)]);
/// assert_eq!(program.words().len(), 8 + 3);
/// ```
pub fn link(base: u32, sources: &[(&str, &str)]) -> Result<Program, AssemblyErrors> {
    let empty = Program::of_bytes(base, Vec::new());
    sources.iter().try_fold(empty, |mut all, (file, source)| {
        // The next source begins at the start of a cache line.
        all.bytes.resize(all.bytes.len().next_multiple_of(32), 0);
        let next = assemble(file, base + all.bytes.len() as u32, source)?;
        all.bytes.extend(next.bytes);
        // Keep only the first definition of each symbol.
        next.symbols.into_iter().for_each(|(name, value)| {
            all.symbols.entry(name).or_insert(value);
        });
        all.labels.extend(next.labels);
        all.lines.extend(next.lines);
        all.data.extend(next.data);
        all.warnings.extend(next.warnings);
        Ok(all)
    })
}

/// Makes a little-endian word from up to four bytes. Missing bytes are zero.
fn word_of(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte))
}

#[derive(Clone, Debug)]
enum Item {
    Instruction {
        template: Instruction,
        operands: String,
    },
    /// Integer values, stored as the text of their source line. A string for each value would need several times the
    /// memory of this text.
    Integers {
        size: u32,
        values: String,
    },
    Floats {
        double: bool,
        values: String,
    },
    Gap {
        end: u32,
    },
}

impl Item {
    fn data_kind(&self) -> Option<DataKind> {
        match self {
            Self::Instruction { .. } => None,
            Self::Integers { size, .. } => Some(DataKind::Integers(*size)),
            Self::Floats { double: false, .. } => Some(DataKind::Singles),
            Self::Floats { double: true, .. } => Some(DataKind::Doubles),
            Self::Gap { .. } => Some(DataKind::Gap),
        }
    }
}

#[derive(Clone, Debug)]
struct Placed {
    address: u32,
    line: usize,
    item: Item,
}

/// Greatest size of an assembled program, in bytes (16 MB).
const MAX_BYTES: u32 = 16 << 20;

struct Assembler<'a> {
    file: &'a str,
    base: u32,
    here: u32,
    symbols: Symbols,
    labels: Vec<(String, u32)>,
    placed: Vec<Placed>,
    errors: Vec<AssemblyError>,
}

/// Assembles one source text to a program that begins at address `base`. `file` is the name of the source in error
/// messages.
///
/// # Errors
/// Returns all errors of the source, each with file, line and reason.
///
/// ```
/// let program = i860::assemble("sum.s", 0x1000, "
///     loop: adds  r5, r6, r6
///           bla   r7, r8, loop
///           nop
/// ").unwrap();
/// assert_eq!(program.words()[2], 0xA000_0000);
/// assert_eq!(program.symbol("loop"), Some(0x1000));
/// ```
pub fn assemble(file: &str, base: u32, source: &str) -> Result<Program, AssemblyErrors> {
    // First pass: select lines by conditions, expand macros, define labels and reserve memory.
    let wrong = |(line, reason)| AssemblyErrors(vec![AssemblyError { file: file.to_owned(), line, reason }]);
    let source = select(source).map_err(wrong)?;
    let lines = source::expand(file, &source).map_err(|e| AssemblyErrors(vec![e]))?;
    let mut assembler = Assembler {
        file,
        base,
        here: base,
        symbols: Symbols::new(),
        labels: Vec::new(),
        placed: Vec::new(),
        errors: Vec::new(),
    };
    // An error in one line does not stop the pass, so that the assembler reports all errors.
    for line in &lines {
        if let Err(reason) = assembler.place(line) {
            assembler.fault(line.number, reason);
        }
    }
    assembler.finish()
}

/// Returns the word of one instruction at address `pc`. The function cannot check rules about neighbouring
/// instructions, such as the rules for pairs.
///
/// # Errors
///
/// Returns [`AssemblyError`] with the file name `instruction` and line 1.
pub fn instruction_word(text: &str, pc: u32) -> Result<u32, AssemblyError> {
    let wrong = |reason| AssemblyError { file: "instruction".to_owned(), line: 1, reason };
    word_at(text, pc).map_err(wrong)
}

fn word_at(text: &str, pc: u32) -> Result<u32, String> {
    let (word, rest) = split_word(text.trim());
    let instructions = pseudo(word, rest).unwrap_or_else(|| one(word, rest))?;
    let [(i, operands)] = instructions.as_slice() else {
        return Err(format!("`{text}` takes more than one word"));
    };
    let symbols = Symbols::new();
    Filler { i: *i, pc, symbols: &symbols }.fill(&operand::split(operands)).map(|i| encode(&i))
}

fn split_word(text: &str) -> (&str, &str) {
    text.split_once(char::is_whitespace).map_or((text, ""), |(word, rest)| (word, rest.trim()))
}

fn plain(word: &str, operands: &str) -> Result<(Instruction, String), String> {
    let i = lookup(word).ok_or_else(|| format!("`{word}` is not an operation"))?;
    Ok((i, operands.to_owned()))
}

type Instructions = Result<Vec<(Instruction, String)>, String>;

fn one(word: &str, operands: &str) -> Instructions {
    Ok(vec![plain(word, operands)?])
}

/// Returns the real instructions of a pseudo-operation such as `mov`, or `None` if `word` is not a pseudo-operation.
fn pseudo(word: &str, operands: &str) -> Option<Instructions> {
    // Split off the D prefix and the p of pipelined moves.
    let (prefix, name) = word.strip_prefix("d.").map_or(("", word), |rest| ("d.", rest));
    let (pipe, name) = name.strip_prefix('p').filter(|n| n.starts_with("fmov")).map_or(("", name), |n| ("p", n));
    let parts = operand::split(operands);
    match (name, parts.as_slice()) {
        ("nop", []) if prefix.is_empty() => Some(one("shl", "r0, r0, r0")),
        ("nop", found) if prefix.is_empty() => {
            Some(Err(format!("`nop` takes no operand, found {} (`{operands}`)", found.len())))
        }
        ("mov", [from, to]) if prefix.is_empty() => Some(mov(from, to)),
        // Moves without conversion are additions of f0 in the graphics unit.
        ("fmov.ss" | "fmov.dd", [from, to]) => {
            Some(one(&format!("{prefix}{pipe}fiadd{}", &name[4..]), &format!("{from}, f0, {to}")))
        }
        // Moves with a conversion of precision use the adder.
        ("fmov.sd" | "fmov.ds", [from, to]) => {
            Some(one(&format!("{prefix}{pipe}famov{}", &name[4..]), &format!("{from}, {to}")))
        }
        _ => None,
    }
}

/// Returns the instructions of the pseudo-operation `mov`. The source is a register, or a constant that needs one or
/// two instructions.
fn mov(from: &str, to: &str) -> Instructions {
    if operand::integer_register(from).is_some() {
        return one("shl", &format!("r0, {from}, {to}"));
    }
    match evaluate(from, &Symbols::new()) {
        Ok(value) if !(-0x8000_0000..=0xFFFF_FFFF).contains(&value) => Err(format!("{value} does not fit 32 bits")),
        Ok(value) if (0..0x1_0000).contains(&value) => one("or", &format!("l%({from}), r0, {to}")),
        Ok(value) if (-0x8000..0).contains(&value) => one("adds", &format!("{value}, r0, {to}")),
        Ok(value) if value & 0xFFFF == 0 => one("orh", &format!("h%({from}), r0, {to}")),
        _ => {
            let high = plain("orh", &format!("h%({from}), r0, {to}"))?;
            let low = plain("or", &format!("l%({from}), {to}, {to}"))?;
            Ok(vec![high, low])
        }
    }
}

impl Assembler<'_> {
    fn fault(&mut self, line: usize, reason: String) {
        self.errors.push(AssemblyError { file: self.file.to_owned(), line, reason });
    }

    fn define(&mut self, name: &str, value: i64) -> Result<(), String> {
        if !is_name(name) {
            return Err(format!("`{name}` is not a name"));
        }
        match self.symbols.insert(name.to_owned(), value) {
            Some(_) => Err(format!("`{name}` is defined twice")),
            None => Ok(()),
        }
    }

    // Defines the symbols of a line and appends its instruction or data to the program.
    fn place(&mut self, line: &Line) -> Result<(), String> {
        let (label, statement) = split_label(&line.text);
        // A label has the address of the code or data after it.
        if let Some(label) = label {
            self.define(label, i64::from(self.here))?;
            self.labels.push((label.to_owned(), self.here));
        }
        // Constants are evaluated immediately, so they can use only earlier names.
        if let Some((name, value)) = statement.split_once('=').filter(|(name, _)| is_name(name.trim())) {
            let value = evaluate(value, &self.symbols)?;
            return self.define(name.trim(), value);
        }
        let (word, rest) = split_word(statement);
        match word {
            "" => Ok(()),
            _ if word.starts_with('.') => self.directive(word, rest, line.number),
            _ => self.instruction(word, rest, line.number),
        }
    }

    fn push(&mut self, line: usize, item: Item, bytes: u32) -> Result<(), String> {
        // Check the size first, so that a huge gap allocates no memory.
        let used = self.here.wrapping_sub(self.base);
        if used.checked_add(bytes).is_none_or(|total| total > MAX_BYTES) {
            return Err(format!("the program is longer than {MAX_BYTES} bytes"));
        }
        self.placed.push(Placed { address: self.here, line, item });
        self.here = self.here.wrapping_add(bytes);
        Ok(())
    }

    fn instruction(&mut self, word: &str, rest: &str, line: usize) -> Result<(), String> {
        if !self.here.is_multiple_of(4) {
            return Err(format!("an instruction at {:#x}, which is not a multiple of 4", self.here));
        }
        let instructions = pseudo(word, rest).unwrap_or_else(|| one(word, rest))?;
        for (template, operands) in instructions {
            self.push(line, Item::Instruction { template, operands }, 4)?;
        }
        Ok(())
    }

    fn directive(&mut self, word: &str, rest: &str, line: usize) -> Result<(), String> {
        // The number of values gives the size. The second pass evaluates the values.
        let count = operand::split(rest).len() as u32;
        let values = rest.to_owned();
        match word {
            // Directives for sections, exports and file names have no effect.
            ".text" | ".data" | ".globl" | ".file" => Ok(()),
            ".equ" | ".set" => {
                let (name, value) = rest.split_once(',').ok_or_else(|| format!("{word} needs a name and a value"))?;
                let value = evaluate(value, &self.symbols)?;
                self.define(name.trim(), value)
            }
            ".long" | ".word" => self.push(line, Item::Integers { size: 4, values }, 4 * count),
            ".short" => self.push(line, Item::Integers { size: 2, values }, 2 * count),
            ".byte" => self.push(line, Item::Integers { size: 1, values }, count),
            ".float" => self.push(line, Item::Floats { double: false, values }, 4 * count),
            ".double" => self.push(line, Item::Floats { double: true, values }, 8 * count),
            ".org" | ".align" | ".space" => self.gap(word, rest, line),
            _ => Err(format!("`{word}` is not a directive")),
        }
    }

    fn gap(&mut self, word: &str, rest: &str, line: usize) -> Result<(), String> {
        let value = evaluate(rest, &self.symbols)?;
        let number = u32::try_from(value).map_err(|_| format!("{word} {value} is out of range"))?;
        let end = match word {
            ".align" if !number.is_power_of_two() => return Err(format!(".align {number} is not a power of two")),
            ".align" => self.here.checked_next_multiple_of(number),
            ".space" => self.here.checked_add(number),
            _ => Some(number).filter(|n| *n >= self.here),
        };
        let end = end.ok_or_else(|| format!("{word} {number:#x} does not lie ahead of {:#x}", self.here))?;
        self.push(line, Item::Gap { end }, end - self.here)
    }

    // Second pass: all symbols have values now, so encode and check the instructions.
    fn finish(mut self) -> Result<Program, AssemblyErrors> {
        let mut bytes = Vec::new();
        let mut instructions = Vec::new();
        let mut data = Vec::new();
        for placed in std::mem::take(&mut self.placed) {
            match self.emit(&placed) {
                Ok((emitted, decoded)) => {
                    let kind = placed.item.data_kind().filter(|_| !emitted.is_empty());
                    let bytes_of_it = emitted.len() as u32;
                    let (address, line) = (placed.address, placed.line);
                    data.extend(kind.map(|kind| Data { address, bytes: bytes_of_it, line, kind }));
                    bytes.extend(emitted);
                    instructions.extend(decoded.map(|i| (address, line, i)));
                }
                Err(reason) => self.fault(placed.line, reason),
            }
        }
        // Check pairs and delay slots of the whole program.
        for (line, reason) in check::faults(&instructions) {
            self.fault(line, reason);
        }
        self.errors.sort_by_key(|e| e.line);
        if !self.errors.is_empty() {
            return Err(AssemblyErrors(self.errors));
        }
        let labels = self.labels.iter().map(|(_, address)| *address).collect();
        let mut warnings: Vec<AssemblyWarning> = check::warnings(&instructions, &labels)
            .into_iter()
            .map(|(line, rule, reason)| AssemblyWarning { file: self.file.to_owned(), line, rule, reason })
            .collect();
        warnings.sort_by_key(|warning| warning.line);
        let symbols = self.symbols.into_iter().map(|(name, value)| (name, value as u32)).collect();
        let lines = instructions.iter().map(|(address, line, _)| (*address, *line)).collect();
        self.labels.sort_by_key(|(_, address)| *address);
        Ok(Program { base: self.base, bytes, symbols, labels: self.labels, lines, data, warnings })
    }

    fn emit(&self, placed: &Placed) -> Result<(Vec<u8>, Option<Instruction>), String> {
        let mut bytes = Vec::new();
        match &placed.item {
            Item::Instruction { template, operands } => {
                // Labels have addresses now, so the operands can be evaluated.
                let filler = Filler { i: *template, pc: placed.address, symbols: &self.symbols };
                let i = filler.fill(&operand::split(operands))?;
                return Ok((encode(&i).to_le_bytes().to_vec(), Some(i)));
            }
            Item::Integers { size, values } => {
                for text in operand::split(values) {
                    let value = evaluate(text, &self.symbols)?;
                    let bits = 8 * size;
                    // Both signed and unsigned values of this size are allowed.
                    if !(-(1 << (bits - 1))..1 << bits).contains(&value) {
                        return Err(format!("{value} does not fit {bits} bits"));
                    }
                    bytes.extend(&value.to_le_bytes()[..*size as usize]);
                }
            }
            Item::Floats { double, values } => {
                for text in operand::split(values) {
                    let value: f64 = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
                    match double {
                        true => bytes.extend(value.to_le_bytes()),
                        false => bytes.extend((value as f32).to_le_bytes()),
                    }
                }
            }
            Item::Gap { end } => fill_gap(&mut bytes, placed.address, *end),
        }
        Ok((bytes, None))
    }
}

/// Fills the bytes of a gap between two addresses. Aligned words become `nop`, so that a program can run through the
/// gap.
fn fill_gap(bytes: &mut Vec<u8>, from: u32, to: u32) {
    let nop = Instruction { op: Op::Shl, flags: Flags(0), ..Instruction::new(Op::Shl) };
    let nop = encode(&nop).to_le_bytes();
    bytes.extend(
        (from..to).map(
            |address| if from.is_multiple_of(4) && to.is_multiple_of(4) { nop[(address % 4) as usize] } else { 0 },
        ),
    );
}
