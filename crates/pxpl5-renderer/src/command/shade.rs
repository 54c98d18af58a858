//! The command that shades the pixels of a region after the last primitive of the region.

use super::{CommandKind, MissingField, enable, normal};
use crate::isa::{ArithmeticOp, ArrayInstruction, Operand, Test};
use crate::layout::Layout;

/// Number of times that the cosine of the highlight's angle is squared: 5, for a power of 2^5 = 32 (assumed).
pub const SPECULAR_SQUARINGS: u32 = 5;

/// Shades every pixel whose Z is nearer than the far plane, because a primitive covers such a pixel. All other pixels
/// keep the background colour.
///
/// Inputs are the normal N, the object's colour C, and the directions to a light and an eye at infinity:
///
/// ```text
/// d = limit(N . light / |N|)        10 bits, 1.0 = 1024
/// s = limit(N . half / |N|)^32      10 bits
/// i = limit((d diffuse + 1024 ambient) / 1024)
/// C := limit((C i >> 8) + (s specular >> 10))
/// ```
///
/// The length |N| is a bit-serial square root of 12 bits. The quotients are bit-serial divisions. The power is computed
/// by five squarings, each with a result of 10 bits. The function `limit` limits a value to the range of its
/// destination: 0 to 2^w - 1 for w bits. A zero normal is shaded like a normal that faces the light.
///
/// The command takes 3,790 clocks (95 us): the root takes 206 clocks, each quotient 374 clocks and the power 570
/// clocks. For the real machine, a time of 100 to 200 us is assumed. A second light (938 clocks for each cosine) and a
/// material for each pixel would also fit in this time, but are not modelled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shade {
    /// Unit vector towards the light. The number 1024 stands for 1.0. Each component has 12 bits, two's complement.
    /// Rounding can change the length, but the length must be at most 2.0.
    pub light: [i16; 3],
    /// Unit vector half way between the directions to the light and to the eye, in the same format as `light`.
    pub half: [i16; 3],
    /// Fraction of the object's colour that is visible without light, in units of 1/256.
    pub ambient: u8,
    /// Fraction of the object's colour that full light adds, in units of 1/256.
    pub diffuse: u8,
    /// Intensity of the white highlight, 0 to 255.
    pub specular: u8,
}

const VECTOR_BITS: u8 = 12;
const COSINE_BITS: u8 = 10;

pub(super) const SHADE_BITS: u8 = 104;
/// Address of the square root's bit field, counted from the start of the scratch memory.
pub(super) const SHADE_ROOT: u8 = 72;

pub(crate) struct ShadeFields {
    normal: [Operand; 3],
    colour: [Operand; 3],
    z: Operand,
    pub(crate) a: Operand,
    pub(crate) b: Operand,
    pub(crate) c: Operand,
    pub(crate) root: Operand,
    pub(crate) diffuse: Operand,
    pub(crate) specular: Operand,
}

impl ShadeFields {
    pub(crate) fn in_layout(layout: &Layout) -> Result<Self, MissingField> {
        let normal = [normal(layout, 0)?, normal(layout, 1)?, normal(layout, 2)?];
        let scratch = layout.plan().scratch.filter(|all| all.width >= SHADE_BITS);
        let scratch = scratch.ok_or(MissingField("104 bits of scratch"))?;
        Ok(Self {
            normal,
            colour: [0, 1, 2].map(|i| layout.component(i)),
            z: layout.plan().z,
            a: scratch.part(0, 24),
            b: scratch.part(24, 24),
            c: scratch.part(48, 24),
            root: scratch.part(SHADE_ROOT, 12),
            diffuse: scratch.part(84, COSINE_BITS),
            specular: scratch.part(94, COSINE_BITS),
        })
    }
}

impl Shade {
    pub(super) fn program(&self, layout: &Layout) -> Result<Vec<ArrayInstruction>, MissingField> {
        let f = ShadeFields::in_layout(layout)?;
        let mut out = vec![
            enable(CommandKind::Shade),
            ArrayInstruction::CompareConstant { test: Test::NotEqual, a: f.z, value: u32::MAX },
        ];
        // Compute |N| first, because both cosines need a division by |N|.
        length(&f, &mut out);
        cosine(&f, self.light, f.diffuse, &mut out);
        cosine(&f, self.half, f.specular, &mut out);
        let highlight = power(&f, &mut out);
        self.intensities(&f, highlight, &mut out);
        for component in f.colour {
            out.extend(combine(&f, component));
        }
        Ok(out)
    }

    /// Computes the brightness factor of the object's colour in the low 8 bits of `f.diffuse`, and the highlight in
    /// bits 10 to 18 of `f.c`.
    fn intensities(&self, f: &ShadeFields, highlight: Operand, out: &mut Vec<ArrayInstruction>) {
        let sum = f.b.part(0, 19);
        let ambient = u32::from(self.ambient) << COSINE_BITS;
        out.extend([
            multiply_constant(f.b.part(0, 18), f.diffuse, i32::from(self.diffuse), 9),
            ArrayInstruction::LoadConstant { destination: f.c.part(0, 18), value: ambient },
            arithmetic(ArithmeticOp::Add, sum, f.b.part(0, 18), f.c.part(0, 18)),
            ArrayInstruction::Saturate { destination: f.diffuse.part(0, 8), source: sum.part(10, 9) },
            multiply_constant(f.c.part(0, 18), highlight, i32::from(self.specular), 9),
        ]);
    }

    pub(super) fn read(program: &[ArrayInstruction]) -> Option<Self> {
        let light = read_vector(program, 8)?;
        let half = read_vector(program, 15)?;
        let diffuse = read_factor(program, 27)?;
        let ambient = program.get(28)?;
        let &ArrayInstruction::LoadConstant { value, .. } = ambient else { return None };
        Some(Self {
            light,
            half,
            ambient: u8::try_from(value >> COSINE_BITS).ok()?,
            diffuse: u8::try_from(diffuse).ok()?,
            specular: u8::try_from(read_factor(program, 31)?).ok()?,
        })
    }
}

const fn arithmetic(op: ArithmeticOp, destination: Operand, a: Operand, b: Operand) -> ArrayInstruction {
    ArrayInstruction::Arithmetic { op, destination, a, b }
}

const fn multiply_constant(destination: Operand, source: Operand, factor: i32, factor_bits: u8) -> ArrayInstruction {
    ArrayInstruction::MultiplyConstant { destination, source, factor, factor_bits }
}

/// Computes the length of the normal in `f.root` from the sum of squares in `f.a`. The remainder of the square root
/// stays in `f.a`.
fn length(f: &ShadeFields, out: &mut Vec<ArrayInstruction>) {
    let [x, y, z] = f.normal;
    out.push(arithmetic(ArithmeticOp::Multiply, f.a, x, x));
    for component in [y, z] {
        out.push(arithmetic(ArithmeticOp::Multiply, f.b, component, component));
        out.push(arithmetic(ArithmeticOp::Add, f.a, f.a, f.b));
    }
    out.push(ArrayInstruction::SquareRoot { destination: f.root, radicand: f.a });
}

/// Computes `cosine := limit(N . vector / |N|)`.
fn cosine(f: &ShadeFields, vector: [i16; 3], cosine: Operand, out: &mut Vec<ArrayInstruction>) {
    let [x, y, z] = vector.map(|v| i32::from(v << 4 >> 4));
    out.push(multiply_constant(f.c, f.normal[0], x, VECTOR_BITS));
    for (component, factor) in [(f.normal[1], y), (f.normal[2], z)] {
        out.push(multiply_constant(f.b, component, factor, VECTOR_BITS));
        out.push(arithmetic(ArithmeticOp::Add, f.c, f.c, f.b));
    }
    let positive = f.c.part(0, 23);
    out.push(ArrayInstruction::Saturate { destination: positive, source: f.c.signed() });
    out.push(arithmetic(ArithmeticOp::Divide, cosine, positive, f.root));
}

/// Computes the cosine of the highlight's angle to the power 32, and returns the bit field of the result. Each step
/// squares the value, and alternately writes to `f.a` and `f.b`.
fn power(f: &ShadeFields, out: &mut Vec<ArrayInstruction>) -> Operand {
    let mut base = f.specular;
    for i in 0..SPECULAR_SQUARINGS {
        let square = if i % 2 == 0 { f.a } else { f.b }.part(0, 2 * COSINE_BITS);
        out.push(arithmetic(ArithmeticOp::Multiply, square, base, base));
        base = square.part(COSINE_BITS, COSINE_BITS);
    }
    base
}

/// Returns the instructions for `component := limit((component * light >> 8) + highlight)`.
fn combine(f: &ShadeFields, component: Operand) -> [ArrayInstruction; 3] {
    let product = f.a.part(0, 16);
    let sum = f.b.part(0, 9);
    [
        arithmetic(ArithmeticOp::Multiply, product, component, f.diffuse.part(0, 8)),
        arithmetic(ArithmeticOp::Add, sum, product.part(8, 8), f.c.part(10, 8)),
        ArrayInstruction::Saturate { destination: component, source: sum },
    ]
}

fn read_factor(program: &[ArrayInstruction], index: usize) -> Option<i32> {
    match program.get(index)? {
        ArrayInstruction::MultiplyConstant { factor, .. } => Some(*factor),
        _ => None,
    }
}

fn read_vector(program: &[ArrayInstruction], first: usize) -> Option<[i16; 3]> {
    // The program adds x and y between the products for y and z.
    let indices = [first, first + 1, first + 3];
    let [x, y, z] = indices.map(|index| read_factor(program, index).and_then(|factor| i16::try_from(factor).ok()));
    Some([x?, y?, z?])
}
