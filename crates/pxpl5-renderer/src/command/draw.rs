//! Triangles.

use super::{CommandKind, Missing, enable};
use crate::isa::{Expression, ExpressionUse, Instruction, Operand};
use crate::layout::Layout;
use pxpl5_wire::Linear;
use pxpl5_wire::format::{COLOUR_FRACTION_BITS, NORMAL_FRACTION_BITS};

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
