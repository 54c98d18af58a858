//! Tests of each instruction's effect on a pixel, with an independent model of the table in `isa`.
//!
//! Unlike all arrays, the model uses whole numbers and single pixels. The arrays are compared with it on random
//! instructions of each opcode.

use pxpl5_renderer::conformance::{Random, scramble};
use pxpl5_renderer::isa::{ArithmeticOp, ArrayInstruction, Expression, ExpressionUse, Operand, Test};
use pxpl5_renderer::{BitSerial, Lanes, Layout, PixelArray, Plane, Vectors};
use pxpl5_wire::{Linear, Quadratic, Word};
use std::collections::HashMap;

/// Number of instructions for each opcode.
const ROUNDS: usize = 10;

/// Pixels to compare: some corners of the array and its parts, and some others.
const PLACES: [[usize; 2]; 16] = [
    [0, 0],
    [127, 0],
    [0, 127],
    [127, 127],
    [31, 15],
    [32, 16],
    [63, 64],
    [64, 63],
    [1, 2],
    [7, 33],
    [8, 90],
    [77, 5],
    [95, 47],
    [96, 112],
    [101, 119],
    [120, 71],
];

#[derive(Clone, Copy, Debug, Default)]
struct Controller {
    base: usize,
    origin: [i64; 2],
    linear: Linear,
    quadratic: Quadratic,
}

/// Model of one of the array's processors.
struct Pixel {
    place: [usize; 2],
    memory: [bool; 208],
    enable: bool,
    backing: HashMap<u8, i128>,
}

fn low(value: i128, bits: u32) -> i128 {
    value & ((1 << bits) - 1)
}

/// Returns the low bits of a number as a two's complement number.
fn signed(value: i128, bits: u32) -> i128 {
    let value = low(value, bits);
    if value >> (bits - 1) == 1 { value - (1 << bits) } else { value }
}

fn number(value: i128, bits: u32, is_signed: bool) -> i128 {
    if is_signed { signed(value, bits) } else { low(value, bits) }
}

fn width(field: Operand) -> u32 {
    field.width.into()
}

fn holds(test: Test, a: i128, b: i128) -> bool {
    match test {
        Test::Less => a < b,
        Test::NotLess => a >= b,
        Test::Equal => a == b,
        Test::NotEqual => a != b,
    }
}

impl Pixel {
    fn read(&self, controller: &Controller, field: Operand) -> i128 {
        let first = first(controller, field);
        let bits = &self.memory[first..][..usize::from(field.width)];
        let value = bits.iter().rev().fold(0, |value, bit| 2 * value + i128::from(*bit));
        number(value, width(field), field.signed)
    }

    fn overwrite(&mut self, controller: &Controller, field: Operand, value: i128) {
        let first = first(controller, field);
        for i in 0..usize::from(field.width) {
            self.memory[first + i] = value >> i & 1 == 1;
        }
    }

    fn write(&mut self, controller: &Controller, field: Operand, value: i128) {
        if self.enable {
            self.overwrite(controller, field, value);
        }
    }

    fn value(&self, controller: &Controller, expression: &Expression) -> i128 {
        let [x, y] = [0, 1].map(|i| (self.place[i] as i64 + controller.origin[i]) as i128);
        if expression.is_quadratic() {
            let Quadratic { xx, xy, yy, x: a, y: b, one } = controller.quadratic;
            let [xx, xy, yy, a, b, one] = [xx, xy, yy, a, b, one].map(i128::from);
            signed(xx * x * x + xy * x * y + yy * y * y + a * x + b * y + one, 48)
        } else {
            let Linear { a, b, c } = controller.linear;
            signed(i128::from(a) * x + i128::from(b) * y + i128::from(c), 32)
        }
    }

    fn use_expression(&mut self, controller: &Controller, e: i128, usage: &ExpressionUse) {
        match *usage {
            ExpressionUse::DisableNegative => self.enable &= e >= 0,
            ExpressionUse::Load { field, shift } => self.write(controller, field, e >> shift),
            ExpressionUse::Add { field, shift } => {
                let sum = self.read(controller, field) + (e >> shift);
                self.write(controller, field, sum);
            }
            ExpressionUse::DisableNotLess { field, shift } => {
                let old = low(self.read(controller, field), width(field));
                self.enable &= low(e >> shift, width(field)) < old;
            }
            ExpressionUse::LoadMinus { field, shift, subtrahend, left_shift } => {
                let difference = e - (self.read(controller, subtrahend) << left_shift);
                self.write(controller, field, difference >> shift);
            }
        }
    }

    fn arithmetic(&mut self, controller: &Controller, op: ArithmeticOp, destination: Operand, a: Operand, b: Operand) {
        let x = self.read(controller, a);
        let y = self.read(controller, b);
        let result = match op {
            ArithmeticOp::Add => x + y,
            ArithmeticOp::Subtract => x - y,
            ArithmeticOp::Multiply => x.wrapping_mul(y),
            ArithmeticOp::Divide => {
                let most = low(-1, width(destination));
                let quotient = x.checked_div(y).map_or(most, |quotient| quotient.min(most));
                self.write(controller, a, x - quotient * y);
                quotient
            }
            ArithmeticOp::And => x & y,
            ArithmeticOp::Or => x | y,
            ArithmeticOp::Xor => x ^ y,
            ArithmeticOp::Minimum => x.min(y),
            ArithmeticOp::Maximum => x.max(y),
        };
        self.write(controller, destination, result);
    }

    fn execute(&mut self, controller: &Controller, instruction: &ArrayInstruction) {
        use ArrayInstruction as I;
        match *instruction {
            I::EnableAll { .. } => self.enable = true,
            I::EnableNone => self.enable = false,
            I::EnableInvert => self.enable = !self.enable,
            I::EnableLoad(bit) => self.enable = self.read(controller, bit) != 0,
            I::EnableStore(bit) => self.overwrite(controller, bit, self.enable.into()),
            I::EnableAnd(bit) => self.enable &= self.read(controller, bit) != 0,
            I::Evaluate { expression, usage } => {
                self.use_expression(controller, self.value(controller, &expression), &usage)
            }
            I::ShiftRight { destination, source, by } => {
                self.write(controller, destination, self.read(controller, source) >> by)
            }
            I::ShiftLeft { destination, source, by } => {
                self.write(controller, destination, self.read(controller, source) << by)
            }
            I::Saturate { destination, source } => {
                let most = low(-1, width(destination));
                self.write(controller, destination, self.read(controller, source).clamp(0, most));
            }
            I::SquareRoot { destination, radicand } => {
                let value = self.read(controller, radicand);
                let root = value.isqrt();
                self.write(controller, destination, root);
                self.write(controller, radicand, value - root * root);
            }
            I::Arithmetic { op, destination, a, b } => self.arithmetic(controller, op, destination, a, b),
            I::Compare { test, a, b } => self.enable &= holds(test, self.read(controller, a), self.read(controller, b)),
            I::CompareConstant { test, a, value } => {
                let constant = number(value.into(), width(a).min(32), a.signed);
                self.enable &= holds(test, self.read(controller, a), constant);
            }
            I::LoadConstant { destination, value } => {
                self.write(controller, destination, number(value.into(), 32, destination.signed))
            }
            I::MultiplyConstant { destination, source, factor, factor_bits } => {
                let factor = signed(factor.into(), factor_bits.into());
                self.write(controller, destination, self.read(controller, source) * factor);
            }
            I::StoreBlock { field, block } => {
                self.backing.insert(block, self.read(controller, field));
            }
            I::LoadBlock { field, block } => {
                let value = self.backing.get(&block).copied().unwrap_or(0);
                self.overwrite(controller, field, value);
            }
            I::Select { .. } | I::Wait | I::Output { .. } => {}
        }
    }
}

fn first(controller: &Controller, field: Operand) -> usize {
    usize::from(field.address) + if field.relative { controller.base } else { 0 }
}

/// Returns true if an instruction must be rejected because of the positions of its fields.
///
/// All fields must be in pixel memory. An operand must begin at the same bit as the destination, or have no common bit
/// with the destination. For products, quotients, roots and differences from an expression, only operands without
/// common bits are valid.
fn is_refused(controller: &Controller, instruction: &ArrayInstruction) -> bool {
    use ArrayInstruction as I;
    let bits = |field: Operand| first(controller, field)..first(controller, field) + usize::from(field.width);
    let in_common = |a: Operand, b: Operand| bits(a).any(|bit| bits(b).contains(&bit));
    let askew = |a: Operand, b: Operand| in_common(a, b) && bits(a).start != bits(b).start;
    let (fields, overlaps) = match *instruction {
        I::EnableLoad(field) | I::EnableStore(field) | I::EnableAnd(field) => (vec![field], false),
        I::Evaluate { usage, .. } => match usage {
            ExpressionUse::DisableNegative => (vec![], false),
            ExpressionUse::Load { field, .. }
            | ExpressionUse::Add { field, .. }
            | ExpressionUse::DisableNotLess { field, .. } => (vec![field], false),
            ExpressionUse::LoadMinus { field, subtrahend, .. } => {
                (vec![field, subtrahend], in_common(field, subtrahend))
            }
        },
        I::ShiftRight { destination: d, source, .. }
        | I::ShiftLeft { destination: d, source, .. }
        | I::Saturate { destination: d, source } => (vec![d, source], askew(d, source)),
        I::SquareRoot { destination: d, radicand: a } | I::MultiplyConstant { destination: d, source: a, .. } => {
            (vec![d, a], in_common(d, a))
        }
        I::Arithmetic { op, destination: d, a, b } => {
            let overlaps = match op {
                ArithmeticOp::Multiply => in_common(d, a) || in_common(d, b),
                ArithmeticOp::Divide => in_common(d, a) || in_common(d, b) || in_common(a, b),
                _ => askew(d, a) || askew(d, b),
            };
            (vec![d, a, b], overlaps)
        }
        I::Compare { a, b, .. } => (vec![a, b], false),
        I::CompareConstant { a: field, .. }
        | I::LoadConstant { destination: field, .. }
        | I::StoreBlock { field, .. }
        | I::LoadBlock { field, .. }
        | I::Output { field, .. } => (vec![field], false),
        I::EnableAll { .. } | I::EnableNone | I::EnableInvert | I::Select { .. } | I::Wait => (vec![], false),
    };
    overlaps || fields.into_iter().any(|field| bits(field).end > 208)
}

impl Controller {
    fn take(&mut self, instruction: &ArrayInstruction) {
        match *instruction {
            ArrayInstruction::Select { context_base, left, top } => {
                self.base = context_base.into();
                self.origin = [left.into(), top.into()];
            }
            ArrayInstruction::Evaluate { expression: Expression::Linear(linear), .. } => self.linear = linear,
            ArrayInstruction::Evaluate { expression: Expression::Quadratic(quadratic), .. } => {
                self.quadratic = quadratic;
            }
            _ => {}
        }
    }
}

/// Returns a number of random width, which may be 0 or all ones.
fn word(random: &mut Random) -> Word {
    let any = random.next() as Word;
    [any, any, any >> random.below(32), !(any >> random.below(32)), 0, Word::MAX][random.below(6) as usize]
}

/// Returns all opcodes except output, which changes no pixel.
fn opcodes() -> impl Iterator<Item = Word> {
    let groups =
        [0x01..=0x07, 0x10..=0x14, 0x20..=0x24, 0x30..=0x3c, 0x40..=0x43, 0x48..=0x4b, 0x50..=0x51, 0x60..=0x62];
    groups.into_iter().flatten()
}

fn any_of(opcode: Word, random: &mut Random) -> ArrayInstruction {
    loop {
        // Half of the fields have at most eight bits, so that numbers are sometimes equal. For the same reason, only
        // two blocks are used.
        let fields = [Word::MAX, 0xC7FF_C7FF][random.below(2) as usize];
        let modifiers = if opcode >> 4 == 6 { 0x01 } else { [0, 0x1F, 0x3F, 0xFF][random.below(4) as usize] };
        let operand = if random.below(8) == 0 { 0 } else { fields & 0xFFFF };
        let mut words = vec![opcode << 24 | random.next() as Word & (modifiers << 16 | operand)];
        // The second word holds two fields, one field, one field and a shift, or a number.
        let second = [fields, fields & 0xFFFF_0000, fields & 0xFFFF_003F][random.below(3) as usize];
        words.push([random.next() as Word & second, word(random)][random.below(2) as usize]);
        words.extend((0..12).map(|_| word(random)));
        if let Ok((instruction, _)) = ArrayInstruction::decode(&words, 0) {
            return instruction;
        }
    }
}

fn pixels(array: &impl PixelArray) -> Vec<([bool; 208], bool)> {
    let planes: Vec<Plane> = (0..208).map(|bit| array.plane(bit)).collect();
    let enable = array.enable();
    let at = |plane: &Plane, [x, y]: [usize; 2]| plane[2 * y + x / 64] >> (x % 64) & 1 == 1;
    PLACES.iter().map(|place| (std::array::from_fn(|bit| at(&planes[bit], *place)), at(&enable, *place))).collect()
}

/// An array and the model with which it is compared.
struct Followed<A> {
    array: A,
    controller: Controller,
    model: Vec<Pixel>,
    executed: usize,
    faults: u64,
}

impl<A: PixelArray> Followed<A> {
    /// Creates an array and a model with the same random bits.
    fn new(mut array: A, random: &mut Random) -> Self {
        scramble(random, &mut array, &mut BitSerial::new(&Layout::slats()));
        let pixel = |((memory, enable), place)| Pixel { place, memory, enable, backing: HashMap::new() };
        let model = pixels(&array).into_iter().zip(PLACES).map(pixel).collect();
        Self { array, controller: Controller::default(), model, executed: 0, faults: 0 }
    }

    /// Runs an instruction on the array and on the model. An instruction with invalid fields must have no effect.
    fn run(&mut self, instruction: &ArrayInstruction) {
        let mut words = Vec::new();
        instruction.encode(&mut words);
        let result = self.array.execute(&words);
        assert_eq!(result.is_err(), is_refused(&self.controller, instruction), "{instruction:?}");
        if let Ok(executed) = result {
            assert_eq!((executed.instructions, executed.clocks), (1, instruction.clocks().into()), "{instruction:?}");
            self.controller.take(instruction);
            self.model.iter_mut().for_each(|pixel| pixel.execute(&self.controller, instruction));
            self.executed += 1;
        } else {
            self.faults += 1;
        }
    }

    fn check(&self, instruction: &ArrayInstruction) {
        assert_eq!(self.array.faults(), self.faults);
        for ((memory, enable), pixel) in pixels(&self.array).into_iter().zip(&self.model) {
            let description = |bit: Option<usize>| format!("{bit:?} of {:?} after {instruction:?}", pixel.place);
            assert_eq!(enable, pixel.enable, "{}", description(None));
            let wrong = (0..208).find(|bit| memory[*bit] != pixel.memory[*bit]);
            assert_eq!(wrong, None, "{}", description(wrong));
        }
    }
}

/// Runs instructions of every opcode, resets the array, and runs some more.
fn follow(array: impl PixelArray, seed: u64) {
    let mut random = Random::new(seed);
    let mut followed = Followed::new(array, &mut random);
    for opcode in (0..ROUNDS).flat_map(|_| opcodes()) {
        let instruction = any_of(opcode, &mut random);
        followed.run(&instruction);
        followed.check(&instruction);
        // Enable pixels again, or invert Enable.
        let enable = [ArrayInstruction::EnableAll { label: 0 }, ArrayInstruction::EnableInvert];
        followed.run(&enable[random.below(2) as usize]);
    }
    assert!(followed.executed > 70 * ROUNDS && followed.faults > 0, "{} {}", followed.executed, followed.faults);
    followed.array.reset();
    let pixel = |place| Pixel { place, memory: [false; 208], enable: false, backing: HashMap::new() };
    let model = PLACES.map(pixel).into_iter().collect();
    let array = followed.array;
    let mut followed = Followed { array, controller: Controller::default(), model, executed: 0, faults: 0 };
    let everywhere = ArrayInstruction::EnableAll { label: 0 };
    let relative = ArrayInstruction::LoadConstant { destination: Operand::context(9, 8), value: 0xA5 };
    let loaded = [0, 1].map(|block| ArrayInstruction::LoadBlock { field: Operand::absolute(9, 32), block });
    let held = [Expression::LinearAgain, Expression::QuadraticAgain].map(|expression| ArrayInstruction::Evaluate {
        expression,
        usage: ExpressionUse::Load { field: Operand::absolute(9, 32), shift: 0 },
    });
    for instruction in [everywhere, relative, loaded[0], relative, loaded[1], relative, held[0], relative, held[1]] {
        followed.run(&instruction);
        followed.check(&instruction);
    }
}

#[test]
fn the_bit_serial_array_has_the_effects_of_the_table_of_instructions() {
    for (seed, vectors) in (1..).zip(Vectors::available()) {
        follow(BitSerial::with_vectors(&Layout::slats(), vectors), seed);
    }
}

#[test]
fn the_bit_serial_array_that_skips_work_has_the_effects_of_the_table_of_instructions() {
    for (seed, vectors) in (10..).zip(Vectors::available()) {
        follow(BitSerial::with_vectors(&Layout::slats(), vectors).skipping(), seed);
    }
}

#[test]
fn the_array_of_lanes_has_the_effects_of_the_table_of_instructions() {
    for (seed, layout) in (20..).zip([Layout::slats(), Layout::slats_quarters(), Layout::rendering_control_phong()]) {
        follow(Lanes::new(&layout), seed);
    }
}

/// Tests signs at 0 and at values that barely fit in the array. For such expressions, the corners of blocks determine
/// the signs.
fn follow_signs(array: impl PixelArray) {
    let mut followed = Followed::new(array, &mut Random::new(30));
    let mut expressions = vec![Expression::Linear(Linear::default()), Expression::Quadratic(Quadratic::default())];
    for slope in [1 << 24, -(1 << 24)] {
        for (a, b) in [(slope, 0), (0, slope)] {
            for (end, is_last) in [(i32::MAX, slope > 0), (i32::MIN, slope < 0)] {
                let c = if is_last { end.wrapping_sub(127_i32.wrapping_mul(slope)) } else { end };
                expressions.push(Expression::Linear(Linear { a, b, c }));
            }
        }
    }
    for expression in expressions {
        followed.run(&ArrayInstruction::EnableAll { label: 0 });
        let sign = ArrayInstruction::Evaluate { expression, usage: ExpressionUse::DisableNegative };
        followed.run(&sign);
        followed.check(&sign);
    }
}

#[test]
fn signs_are_correct_at_0_and_at_the_largest_and_smallest_numbers() {
    let layout = Layout::slats();
    for vectors in Vectors::available() {
        follow_signs(BitSerial::with_vectors(&layout, vectors));
        follow_signs(BitSerial::with_vectors(&layout, vectors).skipping());
    }
    follow_signs(Lanes::new(&layout));
}
