//! Tests of instruction words, encoded by hand from the table in `isa`, and of their clocks.

use pxpl5_renderer::isa::timing::{SET_UP_CLOCKS, divide_clocks, multiply_clocks, square_root_clocks};
use pxpl5_renderer::isa::{ArithmeticOp, ArrayInstruction, DecodeErrorKind, Expression, ExpressionUse, Operand, Test};
use pxpl5_wire::{
    CopyTarget, FieldParity, Linear, Lines, NodeId, PictureNumber, Quadratic, RegionGrid, RegionId, Word,
};

const A: Operand = Operand::absolute(3, 8);
const B: Operand = Operand::context(64, 16);
const SIGNED: Operand = Operand::context(17, 12).signed();

/// Encoding of field `A`, which has 8 bits at address 3. Field `B` has 16 bits at the relative address 64. Field
/// `SIGNED` has 12 signed bits at the relative address 17.
const A_BITS: Word = 7 << 8 | 3;
const B_BITS: Word = 1 << 14 | 15 << 8 | 64;
const SIGNED_BITS: Word = 1 << 15 | 1 << 14 | 11 << 8 | 17;

const LINEAR: Linear = Linear { a: -2, b: 3, c: 1 << 30 };
const QUADRATIC: Quadratic = Quadratic { xx: -1, xy: 2, yy: 3 << 40, x: 4, y: -(5 << 33), one: 6 };

fn target(lines: Lines) -> CopyTarget {
    CopyTarget {
        frame_buffer: NodeId(0x31),
        buffer: 1,
        lines,
        grid: RegionGrid { width: 640, height: 480, region_width: 128, region_height: 96 },
        region: RegionId(24),
        picture: PictureNumber::from_words(9, 2),
    }
}

fn target_words(how: Word) -> [Word; 8] {
    [0x31 << 16 | 24, how << 8 | 1, 640, 480, 128, 96, 9, 2]
}

/// Returns instructions, their words, and the clocks in which their bits move.
fn instructions() -> Vec<(ArrayInstruction, Vec<Word>, u32)> {
    use ArrayInstruction as I;
    let evaluate = |expression, usage| I::Evaluate { expression, usage };
    let linear = Expression::Linear(LINEAR);
    let linear_words: [Word; 3] = [-2_i32 as Word, 3, 1 << 30];
    let all = Word::MAX;
    // Low words come first. The high word of -5 x 2^33 is 2^32 - 10, and its low word is 0.
    let quadratic_words = [all, all, 2, 0, 0, 3 << 8, 4, 0, 0, 0xFFFF_FFF6, 6, 0];
    let with = |head: Word, tail: &[Word]| [&[head], tail].concat();
    let load_minus = ExpressionUse::LoadMinus { field: A, shift: 5, subtrahend: SIGNED, left_shift: 33 };
    let mut all = vec![
        (I::EnableAll { label: 0x5A }, vec![0x015A_0000], 2),
        (I::EnableNone, vec![0x0200_0000], 2),
        (I::EnableInvert, vec![0x0300_0000], 2),
        (I::EnableLoad(Operand::absolute(9, 1)), vec![0x0400_0009], 2),
        (I::EnableStore(Operand::absolute(9, 1)), vec![0x0500_0009], 2),
        (I::EnableAnd(Operand::absolute(9, 1)), vec![0x0600_0009], 2),
        (I::Select { context_base: 104, left: 640, top: 0x1_23 }, vec![0x0768_0000, 0x0123_0280], 2),
        (evaluate(linear, ExpressionUse::DisableNegative), with(0x1000_0000, &linear_words), 32),
        (evaluate(linear, ExpressionUse::Load { field: A, shift: 5 }), with(0x1105_0000 | A_BITS, &linear_words), 13),
        (evaluate(linear, ExpressionUse::Add { field: B, shift: 2 }), with(0x1202_0000 | B_BITS, &linear_words), 18),
        (
            evaluate(linear, ExpressionUse::DisableNotLess { field: A, shift: 1 }),
            with(0x1301_0000 | A_BITS, &linear_words),
            9,
        ),
        (
            evaluate(linear, load_minus),
            [&[0x1405_0000 | A_BITS, SIGNED_BITS << 16 | 33], &linear_words[..]].concat(),
            13,
        ),
        (evaluate(Expression::LinearAgain, load_minus), vec![0x1485_0000 | A_BITS, SIGNED_BITS << 16 | 33], 13),
        (evaluate(Expression::LinearAgain, ExpressionUse::DisableNegative), vec![0x1080_0000], 32),
        (
            evaluate(Expression::Quadratic(QUADRATIC), ExpressionUse::Load { field: B, shift: 32 }),
            with(0x2120_0000 | B_BITS, &quadratic_words),
            48,
        ),
        (
            evaluate(Expression::QuadraticAgain, ExpressionUse::Add { field: B, shift: 0 }),
            vec![0x2280_0000 | B_BITS],
            48,
        ),
        (I::ShiftRight { destination: A, source: B, by: 7 }, vec![0x3007_0000 | A_BITS, B_BITS << 16], 8),
        (I::ShiftLeft { destination: B, source: A, by: 63 }, vec![0x313F_0000 | B_BITS, A_BITS << 16], 16),
        (I::Saturate { destination: A, source: B }, vec![0x3200_0000 | A_BITS, B_BITS << 16], 8 + 8),
        (I::Saturate { destination: B, source: A }, vec![0x3200_0000 | B_BITS, A_BITS << 16], 16 + 1),
        (
            I::SquareRoot { destination: A, radicand: B },
            vec![0x3300_0000 | A_BITS, B_BITS << 16],
            square_root_clocks(8),
        ),
        (I::LoadConstant { destination: B, value: 0xFEDC_BA98 }, vec![0x5000_0000 | B_BITS, 0xFEDC_BA98], 16),
        (
            I::MultiplyConstant { destination: B, source: A, factor: -3, factor_bits: 5 },
            vec![0x5104_0000 | B_BITS, A_BITS << 16, -3_i32 as Word],
            // The terms are five additions of eight bits with a carry, and three clocks to fill.
            5 * 9 + 3,
        ),
        (I::StoreBlock { field: Operand::absolute(0, 32), block: 127 }, vec![0x607F_0000 | 31 << 8], 2),
        (I::LoadBlock { field: Operand::absolute(0, 32), block: 1 }, vec![0x6101_0000 | 31 << 8], 2),
        (I::Wait, vec![0x6200_0000], 2),
    ];
    // Clocks of products and quotients are defined in `isa::timing`. The other operations take as many clocks as their
    // width, or the larger of two widths.
    use ArithmeticOp::{Add, And, Divide, Maximum, Minimum, Multiply, Or, Subtract, Xor};
    let ops = [
        (Add, 0, 8),
        (Subtract, 1, 8),
        (Multiply, 2, multiply_clocks(8, 16, 8)),
        (Divide, 3, divide_clocks(8, 16, 8)),
        (And, 4, 8),
        (Or, 5, 8),
        (Xor, 6, 8),
        (Minimum, 7, 8 + 16),
        (Maximum, 8, 8 + 16),
    ];
    all.extend(ops.map(|(op, n, clocks)| {
        (
            I::Arithmetic { op, destination: A, a: B, b: A },
            vec![(0x34 + n) << 24 | A_BITS, B_BITS << 16 | A_BITS],
            clocks,
        )
    }));
    for (n, test) in (0..).zip([Test::Less, Test::NotLess, Test::Equal, Test::NotEqual]) {
        all.push((I::Compare { test, a: A, b: B }, vec![(0x40 + n) << 24, A_BITS << 16 | B_BITS], 16));
        all.push((I::CompareConstant { test, a: SIGNED, value: 77 }, vec![(0x48 + n) << 24 | SIGNED_BITS, 77], 12));
    }
    let lines = [(Lines::Frame, 0), (Lines::Field(FieldParity::Even), 1), (Lines::Field(FieldParity::Odd), 2)];
    all.extend(lines.map(|(lines, how)| {
        let words = with(0x7000_0000 | 23 << 8 | 40, &target_words(how));
        (I::Output { field: Operand::absolute(40, 24), target: target(lines) }, words, 2)
    }));
    all
}

#[test]
fn instructions_have_the_words_of_the_table() {
    for (instruction, words, clocks) in instructions() {
        let mut written = Vec::new();
        instruction.encode(&mut written);
        assert_eq!(written, words, "{instruction:?}");
        assert_eq!(ArrayInstruction::decode(&words, 0), Ok((instruction, words.len())), "{words:x?}");
        assert_eq!(instruction.words() as usize, words.len());
        assert_eq!(instruction.bit_clocks(), clocks, "{instruction:?}");
        assert_eq!(instruction.clocks(), SET_UP_CLOCKS + clocks);
    }
    assert_eq!(square_root_clocks(0), 0);
}

#[test]
fn a_list_is_read_instruction_by_instruction() {
    let all = instructions();
    let words: Vec<Word> = all.iter().flat_map(|(_, words, _)| words).copied().collect();
    let read = ArrayInstruction::decode_all(&words).expect("instructions");
    assert!(read.iter().eq(all.iter().map(|(instruction, ..)| instruction)));
    let error = ArrayInstruction::decode_all(&[0x0200_0000, 0xFF00_0000]).expect_err("the second is none");
    assert_eq!((error.position, error.kind), (1, DecodeErrorKind::UnknownOpcode));
}

/// Tests that the error of a truncated instruction has the number of words that the instruction needs. For a linear
/// evaluation, this error occurs before the coefficients are read.
#[test]
fn a_truncated_instruction_is_detected() {
    for (instruction, words, _) in instructions() {
        for found in 1..words.len() {
            let error = ArrayInstruction::decode(&words[..found], 0).expect_err("a part").kind;
            let DecodeErrorKind::Truncated { expected, found: available } = error else {
                panic!("{instruction:?}: {error}")
            };
            assert!(expected > found && expected <= words.len(), "{instruction:?}: {expected} of {}", words.len());
            assert_eq!(available, found, "{instruction:?}");
        }
    }
}

#[test]
fn an_instruction_that_breaks_a_rule_is_refused_with_that_rule() {
    use DecodeErrorKind as K;
    let output = |words: [Word; 8]| [&[0x7000_0000 | 23 << 8 | 40], &words[..]].concat();
    let changed = |place: usize, word: Word| {
        let mut words = target_words(0);
        words[place] = word;
        output(words)
    };
    let cases: Vec<(Vec<Word>, K)> = vec![
        (vec![0x0001_0000], K::UnknownOpcode),
        (vec![0x0201_0000], K::ReservedBits),
        (vec![0x0200_0001], K::ReservedBits),
        (vec![0x0100_0001], K::ReservedBits),
        (vec![0x0400_0109], K::Width { field: Operand::absolute(9, 2), expected: 1 }),
        (vec![0x0400_00D0], K::FieldOutOfRange(Operand::absolute(208, 1))),
        (vec![0x1040_0000, 0, 0, 0], K::ReservedBits),
        (vec![0x1001_0000, 0, 0, 0], K::ReservedBits),
        (vec![0x1000_0001, 0, 0, 0], K::ReservedBits),
        (vec![0x1001_0001, 0, 0, 0], K::ReservedBits),
        (vec![0x1119_0000 | A_BITS, 0, 0, 0], K::Width { field: A, expected: 32 - 25 }),
        (vec![0x1405_0000 | A_BITS, SIGNED_BITS << 16 | 1 << 6, 0, 0, 0], K::ReservedBits),
        (vec![0x3040_0000 | A_BITS, B_BITS << 16], K::ReservedBits),
        (vec![0x3000_0000 | A_BITS, B_BITS << 16 | 1], K::ReservedBits),
        (vec![0x3201_0000 | A_BITS, B_BITS << 16], K::ReservedBits),
        (vec![0x3300_0000 | A_BITS, A_BITS << 16], K::Width { field: A, expected: 16 }),
        (vec![0x3300_0000 | A_BITS, (B_BITS | 1 << 15) << 16], K::Signedness),
        // These words encode a quotient of 16 bits from 8 bits, and quotients with a signed operand in each place.
        (vec![0x3700_0000 | B_BITS, A_BITS << 16 | A_BITS], K::Width { field: B, expected: 8 }),
        (vec![0x3700_0000 | A_BITS, SIGNED_BITS << 16 | A_BITS], K::Signedness),
        (vec![0x3700_0000 | A_BITS, A_BITS << 16 | SIGNED_BITS], K::Signedness),
        (vec![0x3B00_0000 | A_BITS, A_BITS << 16 | SIGNED_BITS], K::Signedness),
        (vec![0x3C00_0000 | A_BITS, SIGNED_BITS << 16 | A_BITS], K::Signedness),
        (vec![0x4000_0000, SIGNED_BITS << 16 | A_BITS], K::Signedness),
        (vec![0x4001_0000, A_BITS << 16 | A_BITS], K::ReservedBits),
        (vec![0x4000_0001, A_BITS << 16 | A_BITS], K::ReservedBits),
        (vec![0x4001_0001, A_BITS << 16 | A_BITS], K::ReservedBits),
        (vec![0x5120_0000 | B_BITS, A_BITS << 16, 1], K::ReservedBits),
        (vec![0x6080_0000 | 31 << 8], K::UnknownBlock(128)),
        (vec![0x6000_0000 | A_BITS], K::Width { field: A, expected: 32 }),
        (vec![0x6201_0000], K::ReservedBits),
        (vec![0x6200_0001], K::ReservedBits),
        (vec![0x6201_0001], K::ReservedBits),
        (changed(1, 3 << 8), K::BadTarget),
        // A picture of 640 x 480 has 25 regions of 128 x 96. A side is at least 1, and at most 2^16 for a picture and
        // 128 for a region.
        (changed(0, 0x31 << 16 | 25), K::BadTarget),
        (changed(2, 0), K::BadTarget),
        (changed(2, 65_537), K::BadTarget),
        (changed(3, 0), K::BadTarget),
        (changed(3, 65_537), K::BadTarget),
        (changed(4, 0), K::BadTarget),
        (changed(4, 129), K::BadTarget),
        (changed(5, 0), K::BadTarget),
        (changed(5, 129), K::BadTarget),
    ];
    for (words, kind) in cases {
        assert_eq!(ArrayInstruction::decode(&words, 0).map_err(|error| error.kind), Err(kind), "{words:x?}");
    }
    // The width of a quotient can equal the width of the dividend.
    ArrayInstruction::decode(&[0x3700_0000 | B_BITS, B_BITS << 16 | A_BITS], 0).expect("as wide");
}
