//! Triangles.

use super::{CommandKind, Missing, enable};
use crate::isa::{Expression, ExpressionUse, Instruction, Operand, evaluate_head, head, opcode};
use crate::layout::Layout;
use pxpl5_wire::format::{COLOUR_FRACTION_BITS, NORMAL_FRACTION_BITS};
use pxpl5_wire::{Linear, Word};

/// A triangle with interpolated colour (Gouraud).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Triangle {
    /// Inside where all are `>= 0`.
    pub edges: [Linear; 3],
    /// Depth with [`pxpl5_wire::format::Z_FRACTION_BITS`].
    pub depth: Linear,
    /// Red, green, blue with [`COLOUR_FRACTION_BITS`].
    pub colour: [Linear; 3],
}

/// A triangle whose normals are interpolated and shaded at the end of the frame (Phong).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PhongTriangle {
    /// Inside where all are `>= 0`.
    pub edges: [Linear; 3],
    /// Depth with [`pxpl5_wire::format::Z_FRACTION_BITS`].
    pub depth: Linear,
    /// x, y and z of the normal with [`NORMAL_FRACTION_BITS`]; any length up to the format's.
    pub normal: [Linear; 3],
    /// Colour of the object, 0x00RRGGBB.
    pub colour: u32,
}

impl Triangle {
    pub(super) fn program(&self, layout: &Layout) -> Vec<Instruction> {
        let mut out = vec![enable(CommandKind::Triangle)];
        coverage(&self.edges, self.depth, layout, &mut out);
        for (i, component) in (0..).zip(self.colour) {
            out.push(load(component, layout.component(i), COLOUR_FRACTION_BITS as u8));
        }
        out
    }

    /// Appends the words of the program without building it: a scene sends a hundred thousand of them a frame.
    pub(super) fn encode(&self, layout: &Layout, out: &mut Vec<Word>) {
        let mut words = coverage_words::<TRIANGLE_WORDS>(CommandKind::Triangle, &self.edges, &self.depth, layout);
        for (i, component) in (0..).zip(&self.colour) {
            let head = load_head(layout.component(i), COLOUR_FRACTION_BITS as u8);
            put(&mut words, COMPONENTS_AT + LINEAR_WORDS * usize::from(i), head, component);
        }
        out.extend_from_slice(&words);
    }

    pub(super) fn read(program: &[Instruction]) -> Option<Self> {
        let (edges, depth) = read_coverage(program)?;
        let colour = read_three(program.get(6..9)?)?;
        Some(Self { edges, depth, colour })
    }
}

impl PhongTriangle {
    pub(super) fn program(&self, layout: &Layout) -> Result<Vec<Instruction>, Missing> {
        let mut out = vec![enable(CommandKind::PhongTriangle)];
        coverage(&self.edges, self.depth, layout, &mut out);
        for (i, component) in (0..).zip(self.normal) {
            let field = layout.normal(i).ok_or(Missing("a normal"))?;
            out.push(load(component, field, NORMAL_FRACTION_BITS as u8));
        }
        let destination = layout.plan().colour;
        out.push(Instruction::LoadConstant { destination, value: self.colour });
        Ok(out)
    }

    /// Appends the words of the program without building it.
    pub(super) fn encode(&self, layout: &Layout, out: &mut Vec<Word>) -> Result<(), Missing> {
        let mut words = coverage_words::<PHONG_WORDS>(CommandKind::PhongTriangle, &self.edges, &self.depth, layout);
        for (i, component) in (0..).zip(&self.normal) {
            let field = layout.normal(i).ok_or(Missing("a normal"))?;
            let head = load_head(field, NORMAL_FRACTION_BITS as u8);
            put(&mut words, COMPONENTS_AT + LINEAR_WORDS * usize::from(i), head, component);
        }
        words[PHONG_WORDS - 2] = head(opcode::LOAD_CONSTANT, 0, layout.plan().colour.to_bits());
        words[PHONG_WORDS - 1] = self.colour;
        out.extend_from_slice(&words);
        Ok(())
    }

    pub(super) fn read(program: &[Instruction]) -> Option<Self> {
        let (edges, depth) = read_coverage(program)?;
        let normal = read_three(program.get(6..9)?)?;
        let &Instruction::LoadConstant { value: colour, .. } = program.get(9)? else { return None };
        Some(Self { edges, depth, normal, colour })
    }
}

pub(super) const fn load(expression: Linear, field: Operand, shift: u8) -> Instruction {
    Instruction::Evaluate { expression: Expression::Linear(expression), usage: ExpressionUse::Load { field, shift } }
}

/// Three edges, then Z: compare, disable where not nearer, store.
fn coverage(edges: &[Linear; 3], depth: Linear, layout: &Layout, out: &mut Vec<Instruction>) {
    out.extend(edges.map(|edge| Instruction::Evaluate {
        expression: Expression::Linear(edge),
        usage: ExpressionUse::DisableNegative,
    }));
    let (field, shift) = (layout.plan().z, layout.z_shift());
    out.push(Instruction::Evaluate {
        expression: Expression::Linear(depth),
        usage: ExpressionUse::DisableNotLess { field, shift },
    });
    out.push(Instruction::Evaluate {
        expression: Expression::LinearAgain,
        usage: ExpressionUse::Load { field, shift },
    });
}

const TRIANGLE_WORDS: usize = CommandKind::Triangle.words() as usize;
const PHONG_WORDS: usize = CommandKind::PhongTriangle.words() as usize;

/// An evaluation: its head and three coefficients.
const LINEAR_WORDS: usize = 4;

/// Behind enable all, three edges, the depth, and the depth again without coefficients.
const COMPONENTS_AT: usize = 1 + 4 * LINEAR_WORDS + 1;

/// The words of [`coverage`] at the start of a command of `N` words.
#[inline(always)]
fn coverage_words<const N: usize>(
    kind: CommandKind,
    edges: &[Linear; 3],
    depth: &Linear,
    layout: &Layout,
) -> [Word; N] {
    let (field, shift) = (layout.plan().z, layout.z_shift());
    let negative = evaluate_head(false, false, &ExpressionUse::DisableNegative);
    let mut words = [0; N];
    words[0] = head(opcode::ENABLE_ALL, kind.opcode(), 0);
    for (i, edge) in edges.iter().enumerate() {
        put(&mut words, 1 + LINEAR_WORDS * i, negative, edge);
    }
    let nearer = evaluate_head(false, false, &ExpressionUse::DisableNotLess { field, shift });
    put(&mut words, 1 + 3 * LINEAR_WORDS, nearer, depth);
    words[COMPONENTS_AT - 1] = evaluate_head(false, true, &ExpressionUse::Load { field, shift });
    words
}

const fn load_head(field: Operand, shift: u8) -> Word {
    evaluate_head(false, false, &ExpressionUse::Load { field, shift })
}

#[inline(always)]
fn put(words: &mut [Word], at: usize, head: Word, e: &Linear) {
    words[at..at + LINEAR_WORDS].copy_from_slice(&[head, e.a as Word, e.b as Word, e.c as Word]);
}

fn read_coverage(program: &[Instruction]) -> Option<([Linear; 3], Linear)> {
    let edges = read_three(program.get(1..4)?)?;
    Some((edges, read_linear(program.get(4)?)?))
}

fn read_three(program: &[Instruction]) -> Option<[Linear; 3]> {
    let [a, b, c] = program else { return None };
    Some([read_linear(a)?, read_linear(b)?, read_linear(c)?])
}

pub(super) const fn read_linear(instruction: &Instruction) -> Option<Linear> {
    match instruction {
        Instruction::Evaluate { expression: Expression::Linear(linear), .. } => Some(*linear),
        _ => None,
    }
}
