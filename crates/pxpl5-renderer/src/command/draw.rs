//! Triangle commands.

use super::{Command, CommandKind, MissingField, Unsupported, enable, normal};
use crate::isa::{ArrayInstruction, Expression, ExpressionUse, Operand};
use crate::layout::Layout;
use pxpl5_wire::format::{COLOUR_FRACTION_BITS, NORMAL_FRACTION_BITS};
use pxpl5_wire::{Linear, Word};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TriangleCommand {
    /// Edge expressions. A pixel is inside if all three values are `>= 0`.
    pub edges: [Linear; 3],
    /// Depth expression with [`pxpl5_wire::format::Z_FRACTION_BITS`] fraction bits. A smaller depth is nearer.
    pub depth: Linear,
    /// Red, green and blue expressions, with [`COLOUR_FRACTION_BITS`] fraction bits.
    pub colour: [Linear; 3],
}

/// A triangle with interpolated normals. The triangle's pixels are shaded after the last primitive of the region
/// (Phong).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PhongTriangleCommand {
    /// Edge expressions. A pixel is inside if all three values are `>= 0`.
    pub edges: [Linear; 3],
    /// Depth expression with [`pxpl5_wire::format::Z_FRACTION_BITS`] fraction bits. A smaller depth is nearer.
    pub depth: Linear,
    /// Expressions for x, y and z of the normal, with [`NORMAL_FRACTION_BITS`] fraction bits. The normal can have any
    /// length.
    pub normal: [Linear; 3],
    /// Colour of the object, 0x00RRGGBB.
    pub colour: u32,
}

impl TriangleCommand {
    pub(super) fn program(&self, layout: &Layout) -> Vec<ArrayInstruction> {
        let mut out = vec![enable(CommandKind::Triangle)];
        coverage(&self.edges, self.depth, layout, &mut out);
        for (i, component) in (0..).zip(self.colour) {
            out.push(load(component, layout.component(i), COLOUR_FRACTION_BITS as u8));
        }
        out
    }

    pub(super) fn read(program: &[ArrayInstruction]) -> Option<Self> {
        let (edges, depth) = read_coverage(program)?;
        let colour = read_three(program.get(6..9)?)?;
        Some(Self { edges, depth, colour })
    }
}

impl PhongTriangleCommand {
    pub(super) fn program(&self, layout: &Layout) -> Result<Vec<ArrayInstruction>, MissingField> {
        let mut out = vec![enable(CommandKind::PhongTriangle)];
        coverage(&self.edges, self.depth, layout, &mut out);
        for (i, component) in (0..).zip(self.normal) {
            out.push(load(component, normal(layout, i)?, NORMAL_FRACTION_BITS as u8));
        }
        let destination = layout.plan().colour;
        out.push(ArrayInstruction::LoadConstant { destination, value: self.colour });
        Ok(out)
    }

    pub(super) fn read(program: &[ArrayInstruction]) -> Option<Self> {
        let (edges, depth) = read_coverage(program)?;
        let normal = read_three(program.get(6..9)?)?;
        let &ArrayInstruction::LoadConstant { value: colour, .. } = program.get(9)? else { return None };
        Some(Self { edges, depth, normal, colour })
    }
}

pub(super) const fn load(expression: Linear, field: Operand, shift: u8) -> ArrayInstruction {
    evaluate(Expression::Linear(expression), ExpressionUse::Load { field, shift })
}

pub(super) const fn evaluate(expression: Expression, usage: ExpressionUse) -> ArrayInstruction {
    ArrayInstruction::Evaluate { expression, usage }
}

/// Appends the instructions for three edges and Z. These instructions disable the pixels outside the triangle, and the
/// pixels where the triangle is not nearer than the stored Z. Then they store the new Z.
fn coverage(edges: &[Linear; 3], depth: Linear, layout: &Layout, out: &mut Vec<ArrayInstruction>) {
    out.extend(edges.map(|edge| evaluate(Expression::Linear(edge), ExpressionUse::DisableNegative)));
    let field = layout.plan().z;
    let shift = layout.z_shift();
    out.push(evaluate(Expression::Linear(depth), ExpressionUse::DisableNotLess { field, shift }));
    out.push(evaluate(Expression::LinearAgain, ExpressionUse::Load { field, shift }));
}

pub(crate) const TRIANGLE_WORDS: usize = CommandKind::Triangle.words() as usize;
pub(crate) const PHONG_WORDS: usize = CommandKind::PhongTriangle.words() as usize;

/// Index of each edge's first coefficient word in an encoded triangle command.
pub(crate) const EDGES_AT: [usize; 3] = [2, 6, 10];
pub(crate) const DEPTH_AT: usize = 14;
pub(crate) const COMPONENTS_AT: [usize; 3] = [19, 23, 27];
pub(crate) const COLOUR_AT: usize = PHONG_WORDS - 1;

/// A fast encoder of triangle commands. It does not build the program of each command, because a scene can have 100,000
/// triangles per frame.
///
/// In one layout, the words of all triangle commands differ only in their operands. So the encoder copies those of a
/// blank triangle and overwrites the operands.
#[derive(Clone, Debug)]
pub struct TriangleEncoder([Word; TRIANGLE_WORDS]);

/// A fast encoder of Phong triangle commands, which copies a blank command like [`TriangleEncoder`].
#[derive(Clone, Debug)]
pub struct PhongTriangleEncoder([Word; PHONG_WORDS]);

impl TriangleEncoder {
    pub fn new(layout: &Layout) -> Self {
        Self(blank(&TriangleCommand::default().program(layout)))
    }

    /// Appends the words of a triangle command to `out`. The words equal the words of the command's
    /// [program](super::Command::program).
    #[inline(always)]
    pub fn encode(&self, triangle: &TriangleCommand, out: &mut Vec<Word>) {
        operands(&self.0, &triangle.edges, &triangle.depth, &triangle.colour, out);
    }
}

impl PhongTriangleEncoder {
    /// Creates an encoder for the commands of `layout`.
    ///
    /// # Errors
    /// Returns [`Unsupported`] if the layout has no normals.
    pub fn new(layout: &Layout) -> Result<Self, Unsupported> {
        let blank_one = PhongTriangleCommand::default();
        let program = blank_one
            .program(layout)
            .map_err(|missing| Command::PhongTriangle(blank_one).unsupported(missing, layout))?;
        Ok(Self(blank(&program)))
    }

    /// Appends the words of a triangle command to `out`. The words equal the words of the command's
    /// [program](super::Command::program).
    #[inline(always)]
    pub fn encode(&self, triangle: &PhongTriangleCommand, out: &mut Vec<Word>) {
        operands(&self.0, &triangle.edges, &triangle.depth, &triangle.normal, out)[COLOUR_AT] = triangle.colour;
    }
}

fn blank<const N: usize>(program: &[ArrayInstruction]) -> [Word; N] {
    let mut words = Vec::with_capacity(N);
    program.iter().for_each(|instruction| instruction.encode(&mut words));
    words.try_into().expect("every program of the kind has the kind's words")
}

/// Appends a copy of the triangle command `blank` to `out`, overwrites its operands, and returns the new words.
#[inline(always)]
fn operands<'a, const N: usize>(
    blank: &[Word; N],
    edges: &[Linear; 3],
    depth: &Linear,
    components: &[Linear; 3],
    out: &'a mut Vec<Word>,
) -> &'a mut [Word; N] {
    let at = out.len();
    out.extend_from_slice(blank);
    let words = out[at..].first_chunk_mut().expect("as many have been appended");
    for i in 0..3 {
        put(words, EDGES_AT[i], &edges[i]);
        put(words, COMPONENTS_AT[i], &components[i]);
    }
    put(words, DEPTH_AT, depth);
    words
}

#[inline(always)]
fn put<const N: usize>(words: &mut [Word; N], at: usize, e: &Linear) {
    words[at] = e.a as Word;
    words[at + 1] = e.b as Word;
    words[at + 2] = e.c as Word;
}

fn read_coverage(program: &[ArrayInstruction]) -> Option<([Linear; 3], Linear)> {
    let edges = read_three(program.get(1..4)?)?;
    Some((edges, read_linear(program.get(4)?)?))
}

fn read_three(program: &[ArrayInstruction]) -> Option<[Linear; 3]> {
    let [a, b, c] = program else { return None };
    Some([read_linear(a)?, read_linear(b)?, read_linear(c)?])
}

pub(super) const fn read_linear(instruction: &ArrayInstruction) -> Option<Linear> {
    match instruction {
        ArrayInstruction::Evaluate { expression: Expression::Linear(linear), .. } => Some(*linear),
        _ => None,
    }
}
