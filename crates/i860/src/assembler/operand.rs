//! Conversion of the text of operands to the bit fields of instructions.

use super::expression::{Symbols, evaluate};
use crate::instruction::{Flags, Instruction, Op};
use crate::syntax::{CONTROL_REGISTERS, Syntax};

/// Splits a text at its commas, except commas inside parentheses.
pub(super) fn split(text: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let mut depth = 0i32;
    let mut start = 0;
    // Commas inside parentheses belong to an expression.
    for (at, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            ',' if depth <= 0 => {
                parts.push(text[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
    }
    // An empty text has no operands, not one empty operand.
    let last = text[start..].trim();
    if !(parts.is_empty() && last.is_empty()) {
        parts.push(last);
    }
    parts
}

fn register_number(text: &str, file: char) -> Option<u8> {
    let digits = text.strip_prefix(file)?;
    let plain = digits.len() == 1 || digits.len() == 2 && !digits.starts_with('0');
    digits.parse().ok().filter(|n| *n < 32 && plain && digits.bytes().all(|b| b.is_ascii_digit()))
}

pub(super) fn integer_register(text: &str) -> Option<u8> {
    match text {
        "sp" => Some(2),
        "fp" => Some(3),
        _ => register_number(text, 'r'),
    }
}

fn need_integer(text: &str) -> Result<u8, String> {
    integer_register(text).ok_or_else(|| format!("expected an integer register, found `{text}`"))
}

fn need_floating(text: &str, bytes: u8) -> Result<u8, String> {
    let n = register_number(text, 'f').ok_or_else(|| format!("expected a floating-point register, found `{text}`"))?;
    // A register pair or quad must begin at a multiple of its length.
    let registers = (bytes / 4).max(1);
    if n % registers == 0 {
        return Ok(n);
    }
    Err(format!("f{n}: an operand of {bytes} bytes needs a register number that is a multiple of {registers}"))
}

fn need_control(text: &str) -> Result<u8, String> {
    let at = CONTROL_REGISTERS.iter().position(|name| *name == text);
    at.map(|n| n as u8).ok_or_else(|| format!("expected one of {}, found `{text}`", CONTROL_REGISTERS.join(", ")))
}

fn in_range(value: i64, least: i64, most: i64) -> Result<i32, String> {
    if (least..=most).contains(&value) { Ok(value as i32) } else { Err(format!("{value} is not in {least}..={most}")) }
}

/// Parses a signed 16-bit constant. If the text is a low half (`l%`), bit 15 is the sign.
fn signed16(text: &str, symbols: &Symbols) -> Result<i32, String> {
    let value = evaluate(text, symbols)?;
    if text.trim_start().starts_with("l%") {
        return Ok(i32::from(value as u16 as i16));
    }
    in_range(value, -0x8000, 0x7FFF)
}

/// An instruction under construction. The texts of the operands give its bit fields.
pub(super) struct Filler<'a> {
    pub(super) i: Instruction,
    pub(super) pc: u32,
    pub(super) symbols: &'a Symbols,
}

impl Filler<'_> {
    pub(super) fn fill(mut self, operands: &[&str]) -> Result<Instruction, String> {
        // The operation determines the number and the order of the operands.
        match (Syntax::from_op(self.i.op), operands) {
            (Syntax::Bare | Syntax::Trap, []) => {}
            (Syntax::Integer, [a, b, d]) => self.integer(a, b, d)?,
            (Syntax::Load, [from, d]) => {
                self.i.dest = need_integer(d)?;
                self.address(from)?;
            }
            (Syntax::Store, [a, to]) => {
                self.i.src1 = need_integer(a)?;
                self.displacement_only(to)?;
            }
            (Syntax::FloatingLoad, [address, d]) | (Syntax::FloatingStore, [d, address]) => {
                self.i.dest = need_floating(d, self.i.size)?;
                self.address(address)?;
            }
            (Syntax::LoadControl, [c, d]) => {
                self.i.src2 = need_control(c)?;
                self.i.dest = need_integer(d)?;
            }
            (Syntax::StoreControl, [a, c]) => {
                self.i.src1 = need_integer(a)?;
                self.i.src2 = need_control(c)?;
            }
            (Syntax::ToFloating, [a, d]) => {
                self.i.src1 = need_integer(a)?;
                self.i.dest = need_floating(d, 4)?;
            }
            (Syntax::ToInteger, [a, d]) => {
                self.i.src1 = need_floating(a, 4)?;
                self.i.dest = need_integer(d)?;
            }
            (Syntax::Flush, [address]) => self.displacement_only(address)?,
            (Syntax::Trap, [a, b, d]) => {
                self.i.src1 = need_integer(a)?;
                self.i.src2 = need_integer(b)?;
                self.i.dest = need_integer(d)?;
            }
            (Syntax::Register, [a]) => self.i.src1 = need_integer(a.trim_matches(['[', ']']))?,
            (Syntax::Branch, [target]) => self.i.imm = self.offset(target, 26)?,
            (Syntax::CompareBranch, [a, b, target]) => self.compare_branch(a, b, target)?,
            (Syntax::LoopBranch, [a, b, target]) => {
                self.i.src1 = need_integer(a)?;
                self.i.src2 = need_integer(b)?;
                self.i.imm = self.offset(target, 16)?;
            }
            (Syntax::Three, [a, b, d]) => self.three(a, b, d)?,
            (Syntax::First, [a, d]) => {
                self.i.src1 = need_floating(a, self.source())?;
                self.i.dest = need_floating(d, self.result())?;
            }
            (Syntax::Second, [b, d]) => {
                self.i.src2 = need_floating(b, self.source())?;
                self.i.dest = need_floating(d, self.result())?;
            }
            (syntax, found) => return Err(wrong_count(syntax, found.len())),
        }
        Ok(self.i)
    }

    fn source(&self) -> u8 {
        if self.i.has(Flags::SOURCE_DOUBLE) { 8 } else { 4 }
    }

    fn result(&self) -> u8 {
        // A pipelined operation writes the result of an earlier operation, whose precision can be different.
        if self.i.op == Op::DualOp || self.i.has(Flags::PIPELINED) {
            return 4;
        }
        if self.i.has(Flags::RESULT_DOUBLE) { 8 } else { 4 }
    }

    fn three(&mut self, a: &str, b: &str, d: &str) -> Result<(), String> {
        self.i.src1 = need_floating(a, self.source())?;
        self.i.src2 = need_floating(b, self.source())?;
        self.i.dest = need_floating(d, self.result())?;
        Ok(())
    }

    fn integer(&mut self, a: &str, b: &str, d: &str) -> Result<(), String> {
        self.i.src2 = need_integer(b)?;
        self.i.dest = need_integer(d)?;
        // Operations on the high half exist only with an immediate.
        let high = matches!(self.i.op, Op::Andh | Op::Andnoth | Op::Orh | Op::Xorh);
        if let Some(n) = integer_register(a) {
            if high {
                return Err(format!("expected an immediate, found `{a}`"));
            }
            self.i.src1 = n;
            return Ok(());
        }
        if self.i.op == Op::Shrd {
            return Err(format!("shrd takes registers only, found `{a}`"));
        }
        self.i.flags = self.i.flags.with(Flags::IMMEDIATE, true);
        self.i.src1 = 0;
        // Logical operations have unsigned immediates, and other operations have signed immediates.
        let logical = self.i.op >= Op::And;
        self.i.imm =
            if logical { in_range(evaluate(a, self.symbols)?, 0, 0xFFFF)? } else { signed16(a, self.symbols)? };
        Ok(())
    }

    fn compare_branch(&mut self, a: &str, b: &str, target: &str) -> Result<(), String> {
        self.i.src2 = need_integer(b)?;
        self.i.imm = self.offset(target, 16)?;
        if let Some(n) = integer_register(a) {
            self.i.src1 = n;
            return Ok(());
        }
        self.i.flags = self.i.flags.with(Flags::IMMEDIATE, true);
        self.i.src1 = in_range(evaluate(a, self.symbols)?, 0, 31)? as u8;
        Ok(())
    }

    /// Converts the text of a branch target to a signed offset of `bits` bits, in words.
    fn offset(&self, target: &str, bits: u32) -> Result<i32, String> {
        let address = evaluate(target, self.symbols)? as u32;
        // Offsets count words from the instruction after the branch.
        let distance = address.wrapping_sub(self.pc).wrapping_sub(4) as i32;
        if distance % 4 != 0 {
            return Err(format!("branch target {address:#x} is not a multiple of 4"));
        }
        let words = distance / 4;
        let most = 1 << (bits - 1);
        if (-most..most).contains(&words) {
            return Ok(words);
        }
        Err(format!("branch target {address:#x} is {words} words away, the field holds {bits} bits"))
    }

    fn displacement_only(&mut self, text: &str) -> Result<(), String> {
        self.address(text)?;
        if self.i.has(Flags::IMMEDIATE) {
            return Ok(());
        }
        Err(format!("expected displacement(register), found `{text}`"))
    }

    /// Parses an address: `register(base)` or `displacement(base)`. The suffix `++` (auto-increment) is only legal for
    /// some operations.
    fn address(&mut self, text: &str) -> Result<(), String> {
        let (plain, increment) = match text.strip_suffix("++") {
            Some(rest) => (rest.trim_end(), true),
            None => (text, false),
        };
        // Only floating-point accesses and flush have auto-increment.
        let can_increment = self.i.size != 0 || self.i.op == Op::Flush;
        if increment && !can_increment {
            return Err(format!("`{text}`: only fld, fst, pfld, pst and flush increment"));
        }
        self.i.flags = self.i.flags.with(Flags::AUTOINCREMENT, increment);
        let open = plain.rfind('(').filter(|_| plain.ends_with(')'));
        let open = open.ok_or_else(|| format!("expected an address like 8(r4) or r5(r4), found `{text}`"))?;
        self.i.src2 = need_integer(plain[open + 1..plain.len() - 1].trim())?;
        self.index(plain[..open].trim().trim_start_matches('#'))
    }

    fn index(&mut self, text: &str) -> Result<(), String> {
        if let Some(n) = integer_register(text) {
            if self.i.op == Op::Pst || Syntax::from_op(self.i.op) == Syntax::Store || self.i.op == Op::Flush {
                return Err(format!("`{text}`: this operation takes a displacement only"));
            }
            self.i.src1 = n;
            return Ok(());
        }
        let store = Syntax::from_op(self.i.op) == Syntax::Store;
        self.i.src1 = if store { self.i.src1 } else { 0 };
        self.i.flags = self.i.flags.with(Flags::IMMEDIATE, true);
        self.i.imm = if text.is_empty() { 0 } else { signed16(text, self.symbols)? };
        self.check_displacement()
    }

    /// Checks that the low bits of a displacement are zero, because they encode the operand size in the instruction
    /// word.
    fn check_displacement(&self) -> Result<(), String> {
        let unit = match (self.i.op, self.i.size) {
            (Op::LdB | Op::StB, _) => 1,
            (Op::LdS | Op::StS, _) => 2,
            (Op::LdL | Op::StL, _) | (_, 4) => 4,
            _ => 8,
        };
        if self.i.imm % unit == 0 {
            Ok(())
        } else {
            Err(format!("displacement {} is not a multiple of {unit}", self.i.imm))
        }
    }
}

fn wrong_count(syntax: Syntax, found: usize) -> String {
    let expected = match syntax {
        Syntax::Bare => "no operand",
        Syntax::Flush | Syntax::Register | Syntax::Branch => "1 operand",
        Syntax::Trap => "0 or 3 operands",
        Syntax::Integer | Syntax::CompareBranch | Syntax::LoopBranch | Syntax::Three => "3 operands",
        _ => "2 operands",
    };
    format!("expected {expected}, found {found}")
}
