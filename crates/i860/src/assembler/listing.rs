//! Listings: a program as a table of addresses, words and instructions.

use super::{Data, DataKind, Program};
use crate::disassembler::disassemble;
use std::fmt::Write as _;

/// Width, in characters, of the column with the instruction text. Nearly all instructions fit in this width.
const TEXT_COLUMNS: usize = 30;

impl Program {
    /// Returns the data directive that defines the byte at `address`, or `None` if the byte belongs to an instruction.
    pub fn data_at(&self, address: u32) -> Option<&Data> {
        let after = self.data.partition_point(|data| data.address <= address);
        let data = self.data.get(after.checked_sub(1)?)?;
        (address.wrapping_sub(data.address) < data.bytes).then_some(data)
    }

    /// Lists every word with its address and its instruction or data. If `source` is given, rows also contain the
    /// source line.
    ///
    /// ```
    /// let source = "start: mov 3, r5\nend: nop\ntable: .long 7";
    /// let listing = i860::assemble("t.s", 0x1000, source).unwrap().listing(Some(source));
    /// assert!(listing.contains("00001000  e4050003  or 3, r0, r5                        1  start: mov 3, r5"));
    /// assert!(listing.contains("table:\n00001008  00000007  .long 0x7"));
    /// ```
    pub fn listing(&self, source: Option<&str>) -> String {
        let source: Vec<&str> = source.unwrap_or_default().lines().collect();
        let mut rows = Rows { text: String::new(), labels: &self.labels, source, line: 0 };
        let mut data = self.data.as_slice();
        // Data before an instruction are listed before the instruction.
        for &(address, line) in &self.lines {
            while let Some((first, rest)) = data.split_first().filter(|(first, _)| first.address < address) {
                rows.data(self, first);
                data = rest;
            }
            let word = self.number(address, 4) as u32;
            rows.row(address, &format!("{word:08x}"), &disassemble(word, address), line);
        }
        data.iter().for_each(|data| rows.data(self, data));
        rows.labels_before(u32::MAX);
        rows.text
    }

    /// Returns the little-endian number in `bytes` (at most eight) bytes from `address` on.
    fn number(&self, address: u32, bytes: u32) -> u64 {
        let from = address.wrapping_sub(self.base) as usize;
        let bytes = self.bytes.iter().skip(from).take(bytes as usize);
        bytes.rev().fold(0, |number, byte| number << 8 | u64::from(*byte))
    }
}

struct Rows<'a> {
    text: String,
    labels: &'a [(String, u32)],
    source: Vec<&'a str>,
    line: usize,
}

impl Rows<'_> {
    fn labels_before(&mut self, end: u32) {
        while let Some(((name, _), rest)) = self.labels.split_first().filter(|((_, at), _)| *at < end) {
            let _ = writeln!(self.text, "{name}:");
            self.labels = rest;
        }
    }

    fn row(&mut self, address: u32, bytes: &str, what: &str, line: usize) {
        self.labels_before(address.saturating_add(1));
        let _ = write!(self.text, "{address:08x}  {bytes:<8}  {what}");
        // If several rows belong to one source line, print this line only beside the first row.
        if let Some(source) = self.source.get(line.wrapping_sub(1)).filter(|_| line != self.line) {
            let pad = TEXT_COLUMNS.saturating_sub(what.chars().count());
            let _ = write!(self.text, "{:pad$}  {line:>5}  {}", "", source.trim());
        }
        self.line = line;
        self.text.push('\n');
    }

    fn data(&mut self, program: &Program, data: &Data) {
        let end = data.address.wrapping_add(data.bytes);
        // Doubles are listed in rows of 8 bytes, and other data in rows of words.
        let step = match data.kind {
            DataKind::Gap => return self.row(data.address, "", &format!(".space {}", data.bytes), data.line),
            DataKind::Doubles => 8,
            _ => 4,
        };
        for address in (data.address..end).step_by(step) {
            let bytes = (step as u32).min(end - address);
            let number = program.number(address, bytes);
            let digits = 2 * bytes as usize;
            self.row(address, &format!("{number:0digits$x}"), &text(data.kind, number, bytes), data.line);
        }
    }
}

/// Returns the text of the data directive that puts `number` into `bytes` bytes of memory, for example `.long 0x7`.
fn text(kind: DataKind, number: u64, bytes: u32) -> String {
    match kind {
        DataKind::Doubles => format!(".double {:?}", f64::from_bits(number)),
        DataKind::Singles => format!(".float {:?}", f32::from_bits(number as u32)),
        DataKind::Gap => format!(".space {bytes}"),
        DataKind::Integers(size) => {
            let directive = [".byte", ".short", ".long"][size.trailing_zeros().min(2) as usize];
            let mask = u64::MAX >> (64 - 8 * size);
            let parts = (0..bytes / size).map(|n| format!("{:#x}", number >> (8 * size * n) & mask));
            format!("{directive} {}", parts.collect::<Vec<_>>().join(", "))
        }
    }
}
