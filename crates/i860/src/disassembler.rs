//! Disassembler from instruction words to text.

use crate::assembler::instruction_word;
use crate::decode::decode;
use crate::encode::encode;
use crate::instruction::{Flags, Instruction, Op};
use crate::mnemonic::mnemonic;
use crate::syntax::{CONTROL_REGISTERS, Syntax};

/// Returns the assembler text of an instruction word at address `pc`. If this text would not assemble to the same word,
/// returns a `.long` directive with the word instead.
pub fn disassemble(word: u32, pc: u32) -> String {
    let text = decode(word).ok().map(|i| text(&i, pc));
    // Print the text only if it assembles to the same word.
    let faithful = text.filter(|text| instruction_word(text, pc).ok() == Some(word));
    faithful.unwrap_or_else(|| format!(".long {word:#010x}"))
}

fn text(i: &Instruction, pc: u32) -> String {
    let operands = operands(i, pc);
    let name = mnemonic(i);
    if encode(i) == 0xA000_0000 {
        return "nop".to_owned();
    }
    if operands.is_empty() { name } else { format!("{name} {operands}") }
}

fn address(i: &Instruction) -> String {
    let increment = if i.has(Flags::AUTOINCREMENT) { "++" } else { "" };
    if i.has(Flags::IMMEDIATE) || matches!(i.op, Op::StB | Op::StS | Op::StL) {
        format!("{}(r{}){increment}", i.imm, i.src2)
    } else {
        format!("r{}(r{}){increment}", i.src1, i.src2)
    }
}

fn control_register(n: u8) -> &'static str {
    CONTROL_REGISTERS.get(usize::from(n)).copied().unwrap_or("?")
}

fn operands(i: &Instruction, pc: u32) -> String {
    let a = i.src1;
    let b = i.src2;
    let d = i.dest;
    // Branches print their target address, not their offset.
    let target = pc.wrapping_add(4).wrapping_add((i.imm as u32) << 2);
    let first = match i.has(Flags::IMMEDIATE) {
        true if i.op == Op::Bte || i.op == Op::Btne => a.to_string(),
        true => i.imm.to_string(),
        false => format!("r{a}"),
    };
    match Syntax::from_op(i.op) {
        Syntax::Bare => String::new(),
        Syntax::Integer => format!("{first}, r{b}, r{d}"),
        Syntax::Load => format!("{}, r{d}", address(i)),
        Syntax::Store => format!("r{a}, {}", address(i)),
        Syntax::FloatingLoad => format!("{}, f{d}", address(i)),
        Syntax::FloatingStore => format!("f{d}, {}", address(i)),
        Syntax::LoadControl => format!("{}, r{d}", control_register(b)),
        Syntax::StoreControl => format!("r{a}, {}", control_register(b)),
        Syntax::ToFloating => format!("r{a}, f{d}"),
        Syntax::ToInteger => format!("f{a}, r{d}"),
        Syntax::Flush => address(i),
        Syntax::Trap => format!("r{a}, r{b}, r{d}"),
        Syntax::Register => format!("r{a}"),
        Syntax::Branch => format!("{target:#x}"),
        Syntax::CompareBranch => format!("{first}, r{b}, {target:#x}"),
        Syntax::LoopBranch => format!("r{a}, r{b}, {target:#x}"),
        Syntax::Three => format!("f{a}, f{b}, f{d}"),
        Syntax::First => format!("f{a}, f{d}"),
        Syntax::Second => format!("f{b}, f{d}"),
    }
}
