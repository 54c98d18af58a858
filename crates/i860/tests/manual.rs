//! Compares every instruction of the i860 XR with a table from the programmer's manual. The tests convert text to words
//! and words to text, and check that no other words are valid.

use i860::{Config, Cpu, Ram, RunEnd, assemble, decode, disassemble, instruction_word};
use std::collections::BTreeSet;

/// Core instructions and `fnop`, each with text and word. The registers make every field visible: r1 in the first
/// source, r2 in the second, r3 in the destination. Branches are at address 0 and have the target 0x10, three words
/// after the next instruction.
const CORE: [(&str, u32); 113] = [
    ("ld.b r1(r2), r3", 0x0043_0800),
    ("ld.b 5(r2), r3", 0x0443_0005),
    ("ld.s r1(r2), r3", 0x1043_0800),
    ("ld.s 6(r2), r3", 0x1443_0006),
    ("ld.l r1(r2), r3", 0x1043_0801),
    ("ld.l 8(r2), r3", 0x1443_0009),
    ("st.b r1, 5(r2)", 0x0C40_0805),
    ("st.s r1, 6(r2)", 0x1C40_0806),
    ("st.l r1, 8(r2)", 0x1C40_0809),
    ("st.b r1, -1(r2)", 0x0C5F_0FFF),
    ("ixfr r1, f3", 0x0803_0800),
    ("fld.l r1(r2), f3", 0x2043_0802),
    ("fld.l r1(r2)++, f3", 0x2043_0803),
    ("fld.l 8(r2), f3", 0x2443_000A),
    ("fld.l 8(r2)++, f3", 0x2443_000B),
    ("fld.d r1(r2), f4", 0x2044_0800),
    ("fld.d r1(r2)++, f4", 0x2044_0801),
    ("fld.d 8(r2), f4", 0x2444_0008),
    ("fld.d 8(r2)++, f4", 0x2444_0009),
    ("fld.q r1(r2), f4", 0x2044_0804),
    ("fld.q r1(r2)++, f4", 0x2044_0805),
    ("fld.q 16(r2), f4", 0x2444_0014),
    ("fld.q 16(r2)++, f4", 0x2444_0015),
    ("fst.l f3, r1(r2)", 0x2843_0802),
    ("fst.l f3, r1(r2)++", 0x2843_0803),
    ("fst.l f3, 8(r2)", 0x2C43_000A),
    ("fst.l f3, 8(r2)++", 0x2C43_000B),
    ("fst.d f4, r1(r2)", 0x2844_0800),
    ("fst.d f4, r1(r2)++", 0x2844_0801),
    ("fst.d f4, 8(r2)", 0x2C44_0008),
    ("fst.d f4, 8(r2)++", 0x2C44_0009),
    ("fst.q f4, r1(r2)", 0x2844_0804),
    ("fst.q f4, r1(r2)++", 0x2844_0805),
    ("fst.q f4, 16(r2)", 0x2C44_0014),
    ("fst.q f4, 16(r2)++", 0x2C44_0015),
    ("pfld.l r1(r2), f3", 0x6043_0802),
    ("pfld.l r1(r2)++, f3", 0x6043_0803),
    ("pfld.l 8(r2), f3", 0x6443_000A),
    ("pfld.l 8(r2)++, f3", 0x6443_000B),
    ("pfld.d r1(r2), f4", 0x6044_0800),
    ("pfld.d r1(r2)++, f4", 0x6044_0801),
    ("pfld.d 8(r2), f4", 0x6444_0008),
    ("pfld.d 8(r2)++, f4", 0x6444_0009),
    ("pst.d f4, 8(r2)", 0x3C44_0008),
    ("pst.d f4, 8(r2)++", 0x3C44_0009),
    ("ld.c fir, r3", 0x3003_0000),
    ("ld.c psr, r3", 0x3023_0000),
    ("ld.c dirbase, r3", 0x3043_0000),
    ("ld.c db, r3", 0x3063_0000),
    ("ld.c fsr, r3", 0x3083_0000),
    ("ld.c epsr, r3", 0x30A3_0000),
    ("st.c r1, fir", 0x3800_0800),
    ("st.c r1, psr", 0x3820_0800),
    ("st.c r1, dirbase", 0x3840_0800),
    ("st.c r1, db", 0x3860_0800),
    ("st.c r1, fsr", 0x3880_0800),
    ("st.c r1, epsr", 0x38A0_0800),
    ("flush 16(r2)", 0x3440_0014),
    ("flush 16(r2)++", 0x3440_0015),
    ("flush 128(r1)", 0x3420_0084),
    ("trap r1, r2, r3", 0x4443_0800),
    ("lock", 0x4C00_0001),
    ("calli r1", 0x4C00_0802),
    ("intovr", 0x4C00_0004),
    ("unlock", 0x4C00_0007),
    ("bri r1", 0x4000_0800),
    ("btne r1, r2, 0x10", 0x5040_0803),
    ("btne 1, r2, 0x10", 0x5440_0803),
    ("bte r1, r2, 0x10", 0x5840_0803),
    ("bte 31, r2, 0x10", 0x5C40_F803),
    ("br 0x10", 0x6800_0003),
    ("br 0x0", 0x6BFF_FFFF),
    ("call 0x10", 0x6C00_0003),
    ("bc 0x10", 0x7000_0003),
    ("bc.t 0x10", 0x7400_0003),
    ("bnc 0x10", 0x7800_0003),
    ("bnc.t 0x10", 0x7C00_0003),
    ("bla r1, r2, 0x10", 0xB440_0803),
    ("bla r1, r2, 0x0", 0xB45F_0FFF),
    ("addu r1, r2, r3", 0x8043_0800),
    ("addu 5, r2, r3", 0x8443_0005),
    ("subu r1, r2, r3", 0x8843_0800),
    ("subu 5, r2, r3", 0x8C43_0005),
    ("adds r1, r2, r3", 0x9043_0800),
    ("adds -1, r2, r3", 0x9443_FFFF),
    ("subs r1, r2, r3", 0x9843_0800),
    ("subs 5, r2, r3", 0x9C43_0005),
    ("shl r1, r2, r3", 0xA043_0800),
    ("shl 5, r2, r3", 0xA443_0005),
    ("nop", 0xA000_0000),
    ("shr r1, r2, r3", 0xA843_0800),
    ("shr 5, r2, r3", 0xAC43_0005),
    ("shrd r1, r2, r3", 0xB043_0800),
    ("fnop", 0xB000_0000),
    ("d.fnop", 0xB000_0200),
    ("shra r1, r2, r3", 0xB843_0800),
    ("shra 5, r2, r3", 0xBC43_0005),
    ("and r1, r2, r3", 0xC043_0800),
    ("and 65535, r2, r3", 0xC443_FFFF),
    ("andh 5, r2, r3", 0xCC43_0005),
    ("andnot r1, r2, r3", 0xD043_0800),
    ("andnot 5, r2, r3", 0xD443_0005),
    ("andnoth 5, r2, r3", 0xDC43_0005),
    ("or r1, r2, r3", 0xE043_0800),
    ("or 5, r2, r3", 0xE443_0005),
    ("orh 5, r2, r3", 0xEC43_0005),
    ("xor r1, r2, r3", 0xF043_0800),
    ("xor 5, r2, r3", 0xF443_0005),
    ("xorh 5, r2, r3", 0xFC43_0005),
    ("ld.s -2(r2), r3", 0x1443_FFFE),
    ("fld.d -8(r2), f4", 0x2444_FFF8),
    ("st.l r1, -4(r2)", 0x1C5F_0FFD),
    ("bte 0, r2, 0x0", 0x5C5F_07FF),
];

/// Names of precisions with their bits 8 (source) and 7 (result).
const SS: (&str, u32) = (".ss", 0);
const SD: (&str, u32) = (".sd", 0x080);
const DD: (&str, u32) = (".dd", 0x180);
const DS: (&str, u32) = (".ds", 0x100);
/// Graphics operations have no suffix and both bits set.
const PAIRS: (&str, u32) = ("", 0x180);

/// The operands of an operation: all three, the first source, the second source, or a floating-point register and an
/// integer register.
#[derive(Clone, Copy, PartialEq)]
enum Operands {
    Three,
    First,
    Second,
    ToInteger,
}

/// Instructions of the floating-point unit other than the dual operations. A row has the name, the low seven bits, the
/// precisions, two booleans and the operands. The booleans are true if a scalar form and a pipelined form exist.
type Row = (&'static str, u32, &'static [(&'static str, u32)], [bool; 2], Operands);

const FLOATING: [Row; 21] = {
    use Operands::{First, Second, Three, ToInteger};
    const BOTH: [bool; 2] = [true, true];
    const SCALAR: [bool; 2] = [true, false];
    const PIPELINED: [bool; 2] = [false, true];
    [
        ("fmul", 0x20, &[SS, SD, DD], BOTH, Three),
        ("fmlow", 0x21, &[DD], SCALAR, Three),
        ("frcp", 0x22, &[SS, SD, DD], SCALAR, Second),
        ("frsqr", 0x23, &[SS, SD, DD], SCALAR, Second),
        ("fmul3", 0x24, &[DD], PIPELINED, Three),
        ("fadd", 0x30, &[SS, SD, DD], BOTH, Three),
        ("fsub", 0x31, &[SS, SD, DD], BOTH, Three),
        ("fix", 0x32, &[SD, DD], BOTH, First),
        ("famov", 0x33, &[SS, SD, DS, DD], BOTH, First),
        ("fgt", 0x34, &[SS, (".dd", 0x100)], PIPELINED, Three),
        ("fle", 0x34, &[(".ss", 0x080), DD], PIPELINED, Three),
        ("feq", 0x35, &[SS, (".dd", 0x100)], PIPELINED, Three),
        ("ftrunc", 0x3A, &[SD, DD], BOTH, First),
        ("fxfr", 0x40, &[("", 0)], SCALAR, ToInteger),
        ("fiadd", 0x49, &[SS, DD], BOTH, Three),
        ("fisub", 0x4D, &[SS, DD], BOTH, Three),
        ("faddp", 0x50, &[PAIRS], BOTH, Three),
        ("faddz", 0x51, &[PAIRS], BOTH, Three),
        ("fzchkl", 0x57, &[PAIRS], BOTH, Three),
        ("form", 0x5A, &[PAIRS], BOTH, First),
        ("fzchks", 0x5F, &[PAIRS], BOTH, Three),
    ]
};

/// The data paths of pfam by number (bits 3 to 0). The names for pfsm have `s` instead of `p`, and its bit 4 is set.
const PATHS: [&str; 16] = [
    "r2p1", "r2pt", "r2ap1", "r2apt", "i2p1", "i2pt", "i2ap1", "i2apt", "rat1p2", "m12apm", "ra1p2", "m12ttpa",
    "iat1p2", "m12tpm", "ia1p2", "m12tpa",
];

/// The data paths of pfmam by number. Number 15 does not exist.
const MULTIPLIER_PATHS: [&str; 15] = [
    "mr2p1", "mr2pt", "mr2mp1", "mr2mpt", "mi2p1", "mi2pt", "mi2mp1", "mi2mpt", "mrmt1p2", "mm12mpm", "mrm1p2",
    "mm12ttpm", "mimt1p2", "mm12tpm", "mim1p2",
];

/// Returns all floating-point instructions with texts and words. The operands are f2, f4, f6 and r3.
fn floating() -> Vec<(String, u32)> {
    let word = |low: u32, operands: Operands| {
        let fields = match operands {
            Operands::Three => 4 << 21 | 6 << 16 | 2 << 11,
            Operands::First => 6 << 16 | 2 << 11,
            Operands::Second => 4 << 21 | 6 << 16,
            Operands::ToInteger => 3 << 16 | 2 << 11,
        };
        0x12 << 26 | fields | low
    };
    let text = |operands: Operands| match operands {
        Operands::Three => "f2, f4, f6",
        Operands::First => "f2, f6",
        Operands::Second => "f4, f6",
        Operands::ToInteger => "f2, r3",
    };
    let mut all = Vec::new();
    for (name, low, precisions, forms, operands) in FLOATING {
        for (suffix, bits) in precisions {
            let forms = [("", 0), ("p", 0x400)].into_iter().zip(forms).filter(|(_, exists)| *exists);
            all.extend(forms.map(|((prefix, pipelined), _)| {
                (format!("{prefix}{name}{suffix} {}", text(operands)), word(low | bits | pipelined, operands))
            }));
        }
    }
    let families = [(&PATHS[..], 0x400), (&MULTIPLIER_PATHS[..], 0)];
    for (paths, pipelined) in families {
        for (number, name) in (0..).zip(paths) {
            for (suffix, bits) in [SS, SD, DD] {
                // In names of additions, the last p is the letter for the sum.
                let at = name.rfind('p').expect("a p");
                let minus = format!("{}s{}", &name[..at], &name[at + 1..]);
                for (name, subtract) in [((*name).to_owned(), 0), (minus, 0x10)] {
                    let low = number | bits | pipelined | subtract;
                    all.push((format!("{name}{suffix} f2, f4, f6"), word(low, Operands::Three)));
                }
            }
        }
    }
    all
}

#[track_caller]
fn assert_both_ways(text: &str, word: u32) {
    let found = instruction_word(text, 0).unwrap_or_else(|reason| panic!("{text}: {reason}"));
    assert_eq!(found, word, "{text}: {found:08x}, expected {word:08x}");
    assert_eq!(disassemble(word, 0), text, "{word:08x}");
}

#[test]
fn every_instruction_of_the_core_has_the_word_of_the_manual() {
    CORE.iter().for_each(|(text, word)| assert_both_ways(text, *word));
}

#[test]
fn every_instruction_of_the_floating_point_unit_has_the_word_of_the_manual_in_both_modes() {
    for (text, word) in floating() {
        assert_both_ways(&text, word);
        assert_both_ways(&format!("d.{text}"), word | 0x200);
    }
}

/// Returns the first word of a text.
fn name(text: &str) -> String {
    text.split(' ').next().unwrap_or_default().to_owned()
}

#[test]
fn every_disassembled_instruction_is_in_the_manual() {
    let mnemonics: BTreeSet<String> =
        CORE.iter().map(|(text, _)| name(text)).chain(floating().iter().map(|(text, _)| name(text))).collect();
    // Try all low bits that can select an operation, for every operation code. Floating-point codes are tried without
    // the D bit.
    for op in 0..64_u32 {
        for low in (0..2048).filter(|low| low & 0x200 == 0) {
            let word = op << 26 | low;
            let text = disassemble(word, 0);
            assert!(text.starts_with(".long") || mnemonics.contains(&name(&text)), "{word:08x} {text}");
        }
    }
    // These words are invalid: words of the i860 XP, reserved codes, and precisions that an operation does not have.
    for word in [
        0x6044_0804,
        0x4C00_0408,
        0x4C00_000B,
        0x4800_0032,
        0x4800_003A,
        0x4800_0432,
        0x4800_0424,
        0x4800_01A4,
        0x4800_0130,
        0x4800_0021,
        0x4800_0422,
        0x4800_000F,
        0x4800_0025,
        0x1800_0000,
        0xC800_0000,
        0x30C3_0000,
    ] {
        assert!(decode(word).is_err(), "{word:08x} {}", disassemble(word, 0));
    }
}

/// According to the manual, `pfmul3` advances all three stages, also in double precision.
#[test]
fn a_three_stage_multiply_returns_the_product_of_the_third_previous_multiply() {
    let source = "start: mov data, r4; fld.d 0(r4), f2; fld.d 8(r4), f4; nop; nop
        pfmul3.dd f2, f4, f0; pfmul3.dd f4, f4, f0; pfmul3.dd f2, f2, f0
        pfmul3.dd f0, f0, f6; pfmul3.dd f0, f0, f8; pfmul3.dd f0, f0, f10
        end: nop; .align 8; data: .double 2.0, 3.0";
    let program = assemble("t.s", 0x1000, source).expect("correct");
    let mut ram = Ram::new(0, 0x4000);
    ram.load(program.base, &program.bytes).expect("it fits");
    let mut cpu = Cpu::at(Config::cycle(), program.base);
    assert_eq!(cpu.run(&mut ram, program.symbol("end"), 100), RunEnd::Stopped);
    let double = |n: usize| f64::from_bits(u64::from(cpu.state.f[n + 1]) << 32 | u64::from(cpu.state.f[n]));
    assert_eq!([6, 8, 10].map(double), [6.0, 9.0, 4.0]);
}
