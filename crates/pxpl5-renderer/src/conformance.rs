//! Conformance suite for pixel arrays. Two arrays execute the same lists of instructions, and must be equal in every
//! bit after each list.
//!
//! [`crate::BitSerial`] is the reference model. To compare an array with it, a test calls [`instructions`] and
//! [`commands`] once, and then [`random_round`] for the rounds 0, 1, 2 and so on. The number of a failing round is
//! enough to repeat it.

mod random;

pub use random::Random;

use crate::array::{EMPTY_PLANE, PixelArray, Plane};
use crate::isa::{ArithmeticOp, ArrayInstruction, Expression, ExpressionUse, MEMORY_BITS, Operand, Test};
use crate::layout::Layout;
use pxpl5_wire::{Linear, Quadratic, Word};
use std::fmt;

/// A difference between two arrays that have executed the same list of instructions.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("after {after}: {difference}")]
pub struct Mismatch {
    /// Name of the list of instructions after which the arrays differ.
    pub after: String,
    /// Description of the difference, including the first pixel that differs.
    pub difference: String,
}

/// Executes a list of instructions on both arrays. Then compares the returned results, the Enable registers, and all
/// 208 bits of all pixels.
///
/// # Errors
/// Returns the first [`Mismatch`].
pub fn agree(
    definition: &mut impl PixelArray,
    subject: &mut impl PixelArray,
    words: &[Word],
    after: &dyn fmt::Debug,
) -> Result<(), Mismatch> {
    // Compare the cheap results first, then all bits of all pixels.
    let expected = definition.execute(words);
    let found = subject.execute(words);
    let difference = if expected != found {
        Some(format!("expected {expected:?}, found {found:?}"))
    } else if definition.faults() != subject.faults() {
        Some("the counts of faults differ".to_owned())
    } else {
        first_difference(definition, subject)
    };
    match difference {
        Some(difference) => Err(Mismatch { after: format!("{after:?}"), difference }),
        None => Ok(()),
    }
}

fn first_difference(definition: &impl PixelArray, subject: &impl PixelArray) -> Option<String> {
    let enable = difference("Enable", &definition.enable(), &subject.enable());
    enable.or_else(|| {
        (0..MEMORY_BITS as usize)
            .find_map(|bit| difference(&format!("bit {bit}"), &definition.plane(bit), &subject.plane(bit)))
    })
}

fn difference(what: &str, expected: &Plane, found: &Plane) -> Option<String> {
    let i = expected.iter().zip(found).position(|(a, b)| a != b)?;
    let x = (expected[i] ^ found[i]).trailing_zeros() as usize;
    let bit = expected[i] >> x & 1;
    let pixels: u32 = expected.iter().zip(found).map(|(a, b)| (a ^ b).count_ones()).sum();
    let x = 64 * (i % 2) + x;
    let y = i / 2;
    Some(format!("{what} of pixel ({x}, {y}) is not {bit}; {pixels} pixels differ"))
}

/// Fills both arrays with the same random bits. Some bit planes are all zeros or all ones.
pub fn scramble(random: &mut Random, a: &mut impl PixelArray, b: &mut impl PixelArray) {
    for bit in 0..MEMORY_BITS as usize {
        let plane = noise(random);
        a.set_plane(bit, &plane);
        b.set_plane(bit, &plane);
    }
    let plane = noise(random);
    a.set_enable(&plane);
    b.set_enable(&plane);
}

fn noise(random: &mut Random) -> Plane {
    let mut plane = EMPTY_PLANE;
    let kind = random.below(8);
    plane.iter_mut().for_each(|word| {
        *word = match kind {
            0 => 0,
            1 => u64::MAX,
            2 => random.next() & random.next(),
            3 => random.next() | random.next(),
            _ => random.next(),
        }
    });
    plane
}

/// Tests every instruction with extreme operands, on arrays of random bits.
///
/// # Errors
/// Returns the first [`Mismatch`].
pub fn instructions(definition: &mut impl PixelArray, subject: &mut impl PixelArray) -> Result<(), Mismatch> {
    let mut random = Random::new(1);
    scramble(&mut random, definition, subject);
    for instruction in corner_instructions() {
        let mut words = Vec::new();
        ArrayInstruction::EnableAll { label: 0 }.encode(&mut words);
        ArrayInstruction::EnableLoad(Operand::absolute(207, 1)).encode(&mut words);
        instruction.encode(&mut words);
        agree(definition, subject, &words, &instruction)?;
    }
    Ok(())
}

/// Tests random lists of the layout's commands, on arrays of random bits, in six rounds.
///
/// # Errors
/// Returns the first [`Mismatch`].
pub fn commands(
    layout: &Layout,
    definition: &mut impl PixelArray,
    subject: &mut impl PixelArray,
) -> Result<(), Mismatch> {
    for number in 0..6 {
        random_round(layout, number, definition, subject)?;
    }
    Ok(())
}

/// Runs one round of random tests. The round fills the arrays with random bits, then executes lists of commands, single
/// instructions and invalid words.
///
/// # Errors
/// Returns the first [`Mismatch`], with a text that contains the round number.
pub fn random_round(
    layout: &Layout,
    number: u64,
    definition: &mut impl PixelArray,
    subject: &mut impl PixelArray,
) -> Result<(), Mismatch> {
    let mut random = Random::new(number);
    scramble(&mut random, definition, subject);
    for step in 0..10 {
        let words = random.list(layout);
        agree(definition, subject, &words, &format!("round {number}, step {step}"))?;
    }
    Ok(())
}

fn corner_instructions() -> Vec<ArrayInstruction> {
    let mut out = vec![
        ArrayInstruction::EnableInvert,
        ArrayInstruction::EnableNone,
        ArrayInstruction::EnableLoad(Operand::absolute(0, 1)),
        ArrayInstruction::EnableStore(Operand::absolute(207, 1)),
        ArrayInstruction::EnableAnd(Operand::absolute(3, 1)),
        ArrayInstruction::Select { context_base: 52, left: u16::MAX, top: 384 },
        ArrayInstruction::Wait,
    ];
    // Instructions with expressions, fields or constants have separate generators.
    out.extend(corner_expressions());
    out.extend(corner_fields());
    out.extend(corner_constants());
    for block in [0, 127] {
        let field = Operand::absolute(176, 32);
        out.push(ArrayInstruction::StoreBlock { field, block });
        out.push(ArrayInstruction::LoadBlock { field: Operand::absolute(7, 32), block });
        out.push(ArrayInstruction::LoadBlock { field, block: block / 2 });
    }
    out
}

const EXTREMES: [i32; 6] = [0, 1, -1, i32::MAX, i32::MIN, 0x5555_5555];

fn corner_expressions() -> Vec<ArrayInstruction> {
    let mut out = Vec::new();
    // Combine each extreme value with two other values, so that every coefficient has every value.
    for (i, a) in EXTREMES.into_iter().enumerate() {
        let b = EXTREMES[(i + 1) % 6];
        let c = EXTREMES[(i + 3) % 6];
        let linear = Expression::Linear(Linear { a, b, c });
        let quadratic = Expression::Quadratic(Quadratic {
            xx: beyond_48_bits(a),
            xy: beyond_48_bits(c),
            yy: beyond_48_bits(b),
            x: beyond_48_bits(c),
            y: beyond_48_bits(a),
            one: beyond_48_bits(b),
        });
        for (expression, again) in [(linear, Expression::LinearAgain), (quadratic, Expression::QuadraticAgain)] {
            out.extend(uses(expression));
            out.extend(uses(again));
        }
    }
    out
}

/// Returns a coefficient that tests overflow. The coefficient has bits above bit 47, the highest bit of a quadratic
/// expression's value, and its lowest bit is set.
const fn beyond_48_bits(v: i32) -> i64 {
    (v as i64) << 17 | 1
}

fn uses(expression: Expression) -> Vec<ArrayInstruction> {
    let mut usages = vec![ExpressionUse::DisableNegative];
    for (width, shift) in [(1, 31), (32, 0), (24, 8), (8, 12)] {
        let field = Operand::absolute(40, width);
        let subtrahend = Operand::absolute(120, 12);
        usages.extend([
            ExpressionUse::Load { field, shift },
            ExpressionUse::Add { field, shift },
            ExpressionUse::DisableNotLess { field, shift },
            ExpressionUse::LoadMinus { field, shift, subtrahend, left_shift: shift },
            ExpressionUse::LoadMinus { field, shift, subtrahend: subtrahend.signed(), left_shift: 63 },
        ]);
    }
    usages.into_iter().map(|usage| ArrayInstruction::Evaluate { expression, usage }).collect()
}

/// Widths in bits of the destination and the two operands of tested instructions. The operands are as wide as the
/// destination, narrower or wider.
const WIDTHS: [[u8; 3]; 7] = [[8, 8, 8], [5, 12, 9], [20, 7, 11], [1, 1, 1], [64, 64, 64], [64, 3, 33], [2, 40, 1]];

fn corner_fields() -> Vec<ArrayInstruction> {
    let mut out = Vec::new();
    for [w, wa, wb] in WIDTHS {
        for [a_signed, b_signed] in [[false, false], [true, false], [false, true], [true, true]] {
            let destination = Operand::absolute(0, w);
            let a = Operand { signed: a_signed, ..Operand::absolute(64, wa) };
            let b = Operand { signed: b_signed, ..Operand::absolute(128, wb) };
            out.extend(two_operands(destination, a, b));
            out.extend(one_operand(destination, a));
            // The destination lies at the end of pixel memory, so the upper bits of a product are lost.
            let last = Operand { address: 208 - w, ..destination };
            let low_a = Operand { address: 0, ..a };
            let low_b = Operand { address: 64, ..b };
            out.extend(two_operands(last, low_a, low_b));
            out.extend(one_operand(last, low_a));
            let in_place = Operand { address: 0, ..a };
            out.extend(one_operand(destination, in_place));
            let op = ArithmeticOp::Subtract;
            out.push(ArrayInstruction::Arithmetic { op, destination, a: in_place, b });
        }
    }
    for n in [1, 2, 5, 12, 31, 32] {
        let destination = Operand::absolute(0, n);
        let radicand = Operand::absolute(64, 2 * n);
        out.push(ArrayInstruction::SquareRoot { destination, radicand });
    }
    out
}

fn two_operands(destination: Operand, a: Operand, b: Operand) -> Vec<ArrayInstruction> {
    let mut out = ArithmeticOp::ALL.map(|op| ArrayInstruction::Arithmetic { op, destination, a, b }).to_vec();
    out.extend(Test::ALL.map(|test| ArrayInstruction::Compare { test, a, b }));
    out
}

fn one_operand(destination: Operand, source: Operand) -> Vec<ArrayInstruction> {
    let mut out = vec![ArrayInstruction::Saturate { destination, source }];
    for by in [0, 1, 7, 63] {
        out.push(ArrayInstruction::ShiftRight { destination, source, by });
        out.push(ArrayInstruction::ShiftLeft { destination, source, by });
    }
    for (factor, factor_bits) in [(0, 1), (-1, 1), (5, 4), (-128, 8), (i32::MIN, 32)] {
        out.push(ArrayInstruction::MultiplyConstant { destination, source, factor, factor_bits });
    }
    out
}

fn corner_constants() -> Vec<ArrayInstruction> {
    let mut out = Vec::new();
    for width in [1, 8, 31, 32, 33, 64] {
        for field in [Operand::absolute(70, width), Operand::absolute(70, width).signed()] {
            for value in EXTREMES.map(|v| v as u32) {
                out.push(ArrayInstruction::LoadConstant { destination: field, value });
                out.extend(Test::ALL.map(|test| ArrayInstruction::CompareConstant { test, a: field, value }));
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn corner_instructions_cover_every_opcode_that_the_command_tests_do_not_cover() {
        let mut legal = BTreeSet::new();
        for instruction in corner_instructions() {
            let mut words = Vec::new();
            instruction.encode(&mut words);
            if ArrayInstruction::decode(&words, 0).is_ok() {
                legal.insert(words[0] >> 24);
            }
        }
        // Every list of the suite begins with "enable all". A test outside this suite compares the outputs in
        // `Executed`.
        let expected: BTreeSet<u32> = [0x02..=0x07, 0x10..=0x14, 0x20..=0x24, 0x30..=0x3c, 0x40..=0x43]
            .into_iter()
            .chain([0x48..=0x4b, 0x50..=0x51, 0x60..=0x62])
            .flatten()
            .collect();
        assert_eq!(legal, expected);
    }
}
