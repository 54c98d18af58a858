//! Recognises whole commands in the word stream.

use super::Lanes;
use super::columns::Values;
use super::triangle::{DrawTriangle, Gouraud, Phong};
use crate::array::Executed;
use crate::command::{Command, CommandKind, PhongTriangle, Triangle};
use crate::controller::Bits;
use crate::isa::{Operand, head, opcode};
use crate::layout::Layout;
use crate::simd::{Kernel, Vector};
use pxpl5_wire::{Linear, Word};

/// What identifies a command whose operands are whole words: its other words.
#[derive(Clone, Debug)]
pub(super) struct Template {
    /// Index and value of each word that is no operand.
    fixed: Vec<(usize, Word)>,
    words: usize,
    cost: Cost,
}

impl Template {
    /// `None` where the layout cannot hold the command.
    fn of(kind: CommandKind, layout: &Layout) -> Option<Self> {
        let program = Command::blank(kind).program(layout).ok()?;
        let mut fixed = Vec::new();
        let mut words = Vec::new();
        for instruction in &program {
            let at = words.len();
            instruction.encode(&mut words);
            fixed.push((at, words[at]));
        }
        Some(Self { fixed, words: words.len(), cost: Cost::of(kind, layout)? })
    }

    #[inline]
    fn matches(&self, words: &[Word]) -> bool {
        words.len() >= self.words && self.fixed.iter().all(|&(at, word)| words[at] == word)
    }
}

/// The commands that are recognised by a template.
#[derive(Clone, Debug)]
pub(super) struct Templates {
    clear: Option<Template>,
    triangle: Option<Template>,
    phong_triangle: Option<Template>,
    large: Vec<(CommandKind, Cost)>,
}

/// What a command adds to [`Executed`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Cost {
    pub(super) instructions: u32,
    pub(super) clocks: u64,
}

impl Cost {
    fn of(kind: CommandKind, layout: &Layout) -> Option<Self> {
        let program = Command::blank(kind).program(layout).ok()?;
        let clocks = program.iter().map(|i| u64::from(i.clocks())).sum();
        Some(Self { instructions: program.len() as u32, clocks })
    }
}

impl Templates {
    pub(super) fn new(layout: &Layout) -> Self {
        Self {
            clear: Template::of(CommandKind::Clear, layout),
            triangle: Template::of(CommandKind::Triangle, layout),
            phong_triangle: Template::of(CommandKind::PhongTriangle, layout),
            large: [CommandKind::Sphere, CommandKind::PhongSphere, CommandKind::Shade]
                .into_iter()
                .filter_map(|kind| Some((kind, Cost::of(kind, layout)?)))
                .collect(),
        }
    }

    pub(super) fn cost(&self, kind: CommandKind) -> Option<Cost> {
        self.large.iter().find(|(k, _)| *k == kind).map(|(_, cost)| *cost)
    }

    fn get(&self, kind: CommandKind) -> Option<&Template> {
        match kind {
            CommandKind::Clear => self.clear.as_ref(),
            CommandKind::Triangle => self.triangle.as_ref(),
            CommandKind::PhongTriangle => self.phong_triangle.as_ref(),
            _ => None,
        }
    }
}

/// Columns of the selected context's fields.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContextColumns {
    base: u8,
    pub(super) colour: usize,
    pub(super) z: usize,
    pub(super) normal: Option<[usize; 3]>,
}

impl Lanes {
    /// Executes the command at the start of `words`, if it is one of this layout; returns its words.
    #[inline]
    pub(super) fn whole_command(&mut self, words: &[Word], executed: &mut Executed) -> Option<usize> {
        let kind = CommandKind::from_opcode((words[0] >> 16) as u8)?;
        let columns = self.context_columns()?;
        let Some(template) = self.templates.get(kind) else {
            return self.large_command(kind, words, columns, executed);
        };
        if !template.matches(words) {
            return None;
        }
        let (used, cost) = (template.words, template.cost);
        let keep = !starts_anew(words.get(used));
        match kind {
            CommandKind::Clear => self.clear([words[2], words[4]], columns, keep),
            CommandKind::Triangle => self.triangle(&read_triangle(words), columns, keep)?,
            _ => self.phong_triangle(&read_phong_triangle(words), columns, keep)?,
        }
        executed.instructions += cost.instructions;
        executed.clocks += cost.clocks;
        Some(used)
    }

    /// The same for every command until another context is selected.
    #[inline]
    fn context_columns(&mut self) -> Option<ContextColumns> {
        if self.selected.is_none_or(|known| known.base != self.controller.base) {
            self.selected = self.find_columns();
        }
        self.selected
    }

    fn find_columns(&self) -> Option<ContextColumns> {
        let plan = self.layout.plan();
        let normal = |i| self.column(self.layout.normal(i)?);
        Some(ContextColumns {
            base: self.controller.base,
            colour: self.column(plan.colour)?,
            z: self.column(plan.z)?,
            normal: normal(0).zip(normal(1)).zip(normal(2)).map(|((x, y), z)| [x, y, z]),
        })
    }

    /// The column that holds exactly this field.
    pub(super) fn column(&self, operand: Operand) -> Option<usize> {
        let Bits { first, width, .. } = self.controller.bits(operand).ok()?;
        self.columns.find(first, width)
    }

    /// Both constants are operands: other words than a [`crate::Clear`] has may clear to any depth.
    fn clear(&mut self, [colour, depth]: [Word; 2], columns: ContextColumns, keep: bool) {
        let far = u32::MAX >> (32 - self.layout.plan().z.width);
        for (column, value) in [(columns.colour, colour & 0xff_ffff), (columns.z, depth & far)] {
            self.vectors.run(Fill { column: self.columns.values_mut(column), value });
        }
        if keep {
            self.enable.fill(255);
        }
    }

    fn triangle(&mut self, triangle: &Triangle, columns: ContextColumns, keep: bool) -> Option<()> {
        self.controller.hold(triangle.colour[2]);
        let controller = self.controller;
        let local = |e: &Linear| controller.localise(e);
        let [first, second, third] = &triangle.edges;
        let [red, green, blue] = &triangle.colour;
        let [z, colour] = self.columns.many_mut([columns.z, columns.colour])?;
        if keep {
            self.enable.fill(0);
        }
        self.vectors.run(DrawTriangle {
            edges: [local(first), local(second), local(third)],
            depth: local(&triangle.depth),
            z_shift: self.layout.z_shift(),
            z,
            paint: Gouraud { components: [local(red), local(green), local(blue)], colour },
            enable: keep.then_some(&mut *self.enable),
        });
        Some(())
    }

    fn phong_triangle(&mut self, triangle: &PhongTriangle, columns: ContextColumns, keep: bool) -> Option<()> {
        let [x, y, z] = columns.normal?;
        let indices = [columns.z, columns.colour, x, y, z];
        self.controller.hold(triangle.normal[2]);
        let controller = self.controller;
        let local = |e: &Linear| controller.localise(e);
        let [first, second, third] = &triangle.edges;
        let [z, colour, x, y, depth] = self.columns.many_mut(indices)?;
        if keep {
            self.enable.fill(0);
        }
        self.vectors.run(DrawTriangle {
            edges: [local(first), local(second), local(third)],
            depth: local(&triangle.depth),
            z_shift: self.layout.z_shift(),
            z,
            paint: Phong {
                components: [local(&triangle.normal[0]), local(&triangle.normal[1]), local(&triangle.normal[2])],
                normal: [x, y, depth],
                constant: triangle.colour & 0xff_ffff,
                colour,
            },
            enable: keep.then_some(&mut *self.enable),
        });
        Some(())
    }
}

/// The same value in all pixels.
struct Fill<'a> {
    column: &'a mut Values,
    value: u32,
}

impl Kernel for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        self.column.0.fill(self.value);
    }
}

/// The next instruction overwrites Enable before anybody reads it: it is *enable all*, whatever its label.
pub(super) fn starts_anew(next: Option<&Word>) -> bool {
    const LABEL: Word = 0xff << 16;
    next.is_some_and(|word| word & !LABEL == head(opcode::ENABLE_ALL, 0, 0))
}

#[inline(always)]
fn linear(words: &[Word], at: usize) -> Linear {
    Linear { a: words[at] as i32, b: words[at + 1] as i32, c: words[at + 2] as i32 }
}

/// Operands behind the opcodes at 1, 5, 9 (edges), 13 (depth; 17 repeats it), 18, 22 and 26.
#[inline(always)]
fn read_triangle(words: &[Word]) -> Triangle {
    Triangle {
        edges: [linear(words, 2), linear(words, 6), linear(words, 10)],
        depth: linear(words, 14),
        colour: [linear(words, 19), linear(words, 23), linear(words, 27)],
    }
}

#[inline(always)]
fn read_phong_triangle(words: &[Word]) -> PhongTriangle {
    let Triangle { edges, depth, colour: normal } = read_triangle(words);
    PhongTriangle { edges, depth, normal, colour: words[31] }
}
