//! Conversion between instructions and mnemonics.

use crate::decode::decode;
use crate::instruction::{FNOP, Flags, Instruction, Op};
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Names of the data paths of dual operations, in the order of the bit field DPC. `_` stands for p (plus) or s (minus).
/// The first row belongs to pfam and pfsm, the second to pfmam and pfmsm.
const PATHS: [[&str; 16]; 2] = [
    [
        "r2_1", "r2_t", "r2a_1", "r2a_t", "i2_1", "i2_t", "i2a_1", "i2a_t", "rat1_2", "m12a_m", "ra1_2", "m12tt_a",
        "iat1_2", "m12t_m", "ia1_2", "m12t_a",
    ],
    [
        "mr2_1", "mr2_t", "mr2m_1", "mr2m_t", "mi2_1", "mi2_t", "mi2m_1", "mi2m_t", "mrmt1_2", "mm12m_m", "mrm1_2",
        "mm12tt_m", "mimt1_2", "mm12t_m", "mim1_2", "",
    ],
];

fn base_name(op: Op) -> &'static str {
    match op {
        Op::LdB => "ld.b",
        Op::LdS => "ld.s",
        Op::LdL => "ld.l",
        Op::StB => "st.b",
        Op::StS => "st.s",
        Op::StL => "st.l",
        Op::Fld => "fld",
        Op::Fst => "fst",
        Op::Pfld => "pfld",
        Op::Pst => "pst",
        Op::LdC => "ld.c",
        Op::StC => "st.c",
        Op::Ixfr => "ixfr",
        Op::Flush => "flush",
        Op::Trap => "trap",
        Op::Lock => "lock",
        Op::Unlock => "unlock",
        Op::Calli => "calli",
        Op::Intovr => "intovr",
        Op::Bri => "bri",
        Op::Bte => "bte",
        Op::Btne => "btne",
        Op::Br => "br",
        Op::Call => "call",
        Op::Bc => "bc",
        Op::BcT => "bc.t",
        Op::Bnc => "bnc",
        Op::BncT => "bnc.t",
        Op::Bla => "bla",
        _ => arithmetic_name(op),
    }
}

fn arithmetic_name(op: Op) -> &'static str {
    match op {
        Op::Addu => "addu",
        Op::Subu => "subu",
        Op::Adds => "adds",
        Op::Subs => "subs",
        Op::Shl => "shl",
        Op::Shr => "shr",
        Op::Shrd => "shrd",
        Op::Shra => "shra",
        Op::And => "and",
        Op::Andh => "andh",
        Op::Andnot => "andnot",
        Op::Andnoth => "andnoth",
        Op::Or => "or",
        Op::Orh => "orh",
        Op::Xor => "xor",
        Op::Xorh => "xorh",
        _ => floating_name(op),
    }
}

fn floating_name(op: Op) -> &'static str {
    match op {
        Op::Fnop => "fnop",
        Op::Fmul => "fmul",
        Op::Fmul3 => "fmul3",
        Op::Fmlow => "fmlow",
        Op::Frcp => "frcp",
        Op::Frsqr => "frsqr",
        Op::Fadd => "fadd",
        Op::Fsub => "fsub",
        Op::Fix => "fix",
        Op::Famov => "famov",
        Op::Pfgt => "fgt",
        Op::Pfle => "fle",
        Op::Pfeq => "feq",
        Op::Ftrunc => "ftrunc",
        Op::Fxfr => "fxfr",
        Op::Fiadd => "fiadd",
        Op::Fisub => "fisub",
        Op::Faddp => "faddp",
        Op::Faddz => "faddz",
        Op::Fzchkl => "fzchkl",
        Op::Form => "form",
        _ => "fzchks",
    }
}

fn path_name(i: &Instruction) -> String {
    // Dual operations are named by data path, with p or s for the sign.
    let table = &PATHS[usize::from(!i.has(Flags::PIPELINED))];
    let sign = if i.imm & 16 != 0 { "s" } else { "p" };
    table[(i.imm & 15) as usize].replace('_', sign)
}

fn suffix(i: &Instruction) -> &'static str {
    let s = i.has(Flags::SOURCE_DOUBLE);
    let r = i.has(Flags::RESULT_DOUBLE);
    match i.op {
        Op::Fld | Op::Fst | Op::Pfld | Op::Pst => match i.size {
            4 => ".l",
            8 => ".d",
            _ => ".q",
        },
        Op::Fnop | Op::Fxfr | Op::Faddp | Op::Faddz | Op::Fzchkl | Op::Fzchks | Op::Form => "",
        Op::Pfgt | Op::Pfle | Op::Pfeq => [".ss", ".dd"][usize::from(s)],
        _ if i.is_floating() => [".ss", ".sd", ".ds", ".dd"][2 * usize::from(s) + usize::from(r)],
        _ => "",
    }
}

/// Returns the mnemonic of an instruction, with the prefix `d.` if its D bit is set.
pub fn mnemonic(i: &Instruction) -> String {
    let dual = if i.is_floating() && i.has(Flags::DUAL) { "d." } else { "" };
    if i.op == Op::DualOp {
        return format!("{dual}{}{}", path_name(i), suffix(i));
    }
    let pipelined = if i.is_floating() && i.has(Flags::PIPELINED) { "p" } else { "" };
    format!("{dual}{pipelined}{}{}", base_name(i.op), suffix(i))
}

/// Returns true if all bits that the operation ignores have the values that Intel's assembler writes.
fn is_canonical(i: &Instruction) -> bool {
    let double = Flags(Flags::SOURCE_DOUBLE.0 | Flags::RESULT_DOUBLE.0);
    match i.op {
        Op::Faddp | Op::Faddz | Op::Fzchkl | Op::Fzchks | Op::Form => i.has(double),
        Op::Fxfr => i.flags.0 & double.0 == 0,
        Op::Pfeq => !i.has(Flags::RESULT_DOUBLE),
        _ => true,
    }
}

/// Returns all mnemonics without the prefix `d.`, each with an instruction whose registers and immediates are zero.
pub(crate) fn templates() -> &'static BTreeMap<String, Instruction> {
    static TABLE: OnceLock<BTreeMap<String, Instruction>> = OnceLock::new();
    TABLE.get_or_init(|| {
        let mut table = BTreeMap::new();
        // If several words have the same mnemonic, the first word determines the unused bits.
        for i in every_word().filter_map(|word| decode(word).ok()).filter(is_canonical) {
            let name = mnemonic(&i);
            let plain = Flags(i.flags.0 & !(Flags::IMMEDIATE.0 | Flags::AUTOINCREMENT.0));
            table.entry(name).or_insert(Instruction { flags: plain, ..i });
        }
        table
    })
}

/// Iterates over words with every form of instruction: all opcodes, operand sizes and floating-point operations.
fn every_word() -> impl Iterator<Item = u32> {
    let floating = (0..2048u32).filter(|low| low & 0x200 == 0).map(|low| 0x12 << 26 | low);
    let core = (0..64u32).filter(|op| *op != 0x12).flat_map(|op| (0..8).map(move |low| op << 26 | low));
    core.chain(floating).chain([FNOP])
}

/// Returns the instruction with the mnemonic `name`, or `None` if there is none. The prefix `d.` sets the D bit.
pub(crate) fn lookup(name: &str) -> Option<Instruction> {
    let (plain, dual) = match name.strip_prefix("d.") {
        Some(rest) => (rest, true),
        None => (name, false),
    };
    let mut i = *templates().get(plain)?;
    if dual && !i.is_floating() {
        return None;
    }
    i.flags = i.flags.with(Flags::DUAL, dual);
    Some(i)
}

#[cfg(test)]
mod tests {
    use super::templates;

    #[test]
    fn the_table_of_mnemonics_has_every_instruction_of_the_i860_xr() {
        let names: Vec<&str> = templates().keys().map(String::as_str).collect();
        // The 4 families of dual operations have 16 + 16 + 15 + 15 data paths, each in the three precisions .ss, .sd
        // and .dd.
        let paths = names.iter().filter(|n| n.starts_with(['r', 'i', 'm']) && !["ixfr", "intovr"].contains(n));
        assert_eq!(paths.count(), 62 * 3);
        for name in ["ld.c", "pst.d", "fst.q", "pfmul.dd", "famov.ds", "pfle.dd", "m12apm.ss", "mim1s2.dd", "bla"] {
            assert!(names.contains(&name), "{name}");
        }
        assert!(!names.contains(&"pfld.q") && !names.contains(&"fadd.ds") && !names.contains(&"frcp.ds"));
    }
}
