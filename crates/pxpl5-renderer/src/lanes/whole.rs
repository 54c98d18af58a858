//! Recognises whole commands in the word stream.

use super::Lanes;
use super::columns::Values;
use super::triangle::{DrawTriangles, PaintGouraud, PaintPhong};
use crate::array::Executed;
use crate::command::{COMPONENTS_AT, Command, CommandKind, PHONG_WORDS, TRIANGLE_WORDS};
use crate::controller::FieldBits;
use crate::isa::{Operand, head, opcode};
use crate::layout::Layout;
use crate::simd::{SimdVector, VectorKernel};
use pxpl5_wire::{Linear, Word};

/// What identifies a command of `N` words whose operands are whole words: its other words.
#[derive(Clone, Debug)]
pub(super) struct Template<const N: usize> {
    words: [Word; N],
    /// All ones where a word is no operand, else zero.
    fixed: [Word; N],
    cost: CommandCost,
}

impl<const N: usize> Template<N> {
    /// `None` where the layout cannot hold the command.
    fn for_command(kind: CommandKind, layout: &Layout) -> Option<Self> {
        let program = Command::blank(kind).program(layout).ok()?;
        let mut words = Vec::new();
        let mut fixed = [0; N];
        for instruction in &program {
            *fixed.get_mut(words.len())? = Word::MAX;
            instruction.encode(&mut words);
        }
        Some(Self { words: words.try_into().ok()?, fixed, cost: CommandCost::for_command(kind, layout)? })
    }

    /// The command at the start of `words`, if it is of this kind, and the words behind it.
    #[inline(always)]
    pub(super) fn split<'a>(&self, words: &'a [Word]) -> Option<(&'a [Word; N], &'a [Word])> {
        words.split_first_chunk::<N>().filter(|(command, _)| self.fits(command))
    }

    /// Whether this is such a command.
    #[inline(always)]
    pub(super) fn fits(&self, command: &[Word; N]) -> bool {
        let mut different = 0;
        for ((found, word), fixed) in command.iter().zip(&self.words).zip(&self.fixed) {
            different |= (found ^ word) & fixed;
        }
        different == 0
    }
}

/// The commands that are recognised by a template.
#[derive(Clone, Debug)]
pub(super) struct Templates {
    clear: Option<Template<CLEAR_WORDS>>,
    triangle: Option<Template<TRIANGLE_WORDS>>,
    phong_triangle: Option<Template<PHONG_WORDS>>,
    large: Vec<(CommandKind, CommandCost)>,
}

const CLEAR_WORDS: usize = CommandKind::Clear.words() as usize;

/// What a command adds to [`Executed`].
#[derive(Clone, Copy, Debug)]
pub(super) struct CommandCost {
    pub(super) instructions: u32,
    pub(super) clocks: u64,
}

impl CommandCost {
    fn for_command(kind: CommandKind, layout: &Layout) -> Option<Self> {
        let program = Command::blank(kind).program(layout).ok()?;
        let clocks = program.iter().map(|i| u64::from(i.clocks())).sum();
        Some(Self { instructions: program.len() as u32, clocks })
    }
}

impl Templates {
    pub(super) fn new(layout: &Layout) -> Self {
        Self {
            clear: Template::for_command(CommandKind::Clear, layout),
            triangle: Template::for_command(CommandKind::Triangle, layout),
            phong_triangle: Template::for_command(CommandKind::PhongTriangle, layout),
            large: [CommandKind::Sphere, CommandKind::PhongSphere, CommandKind::Shade]
                .into_iter()
                .filter_map(|kind| Some((kind, CommandCost::for_command(kind, layout)?)))
                .collect(),
        }
    }

    pub(super) fn cost(&self, kind: CommandKind) -> Option<CommandCost> {
        self.large.iter().find(|(k, _)| *k == kind).map(|(_, cost)| *cost)
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
    /// Executes the command at the start of `words`, if it is one of this layout, and the triangles of the same kind that
    /// follow a triangle; returns their words.
    #[inline]
    pub(super) fn whole_command(&mut self, words: &[Word], executed: &mut Executed) -> Option<usize> {
        let kind = CommandKind::from_opcode((words[0] >> 16) as u8)?;
        let columns = self.context_columns()?;
        let (cost, commands) = match kind {
            CommandKind::Clear => self.clear(words, columns)?,
            CommandKind::Triangle => self.triangles(words, columns)?,
            CommandKind::PhongTriangle => self.phong_triangles(words, columns)?,
            _ => return self.large_command(kind, words, columns, executed),
        };
        executed.instructions += cost.instructions * commands as u32;
        executed.clocks += cost.clocks * commands as u64;
        Some(commands * kind.words() as usize)
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
        Some(ContextColumns {
            base: self.controller.base,
            colour: self.column(plan.colour)?,
            z: self.column(plan.z)?,
            normal: self.normal_columns(),
        })
    }

    /// Columns of x, y and z of the selected context's normal; `None` where the layout has no normals.
    fn normal_columns(&self) -> Option<[usize; 3]> {
        let x = self.column(self.layout.normal(0)?)?;
        let y = self.column(self.layout.normal(1)?)?;
        let z = self.column(self.layout.normal(2)?)?;
        Some([x, y, z])
    }

    /// The column that holds exactly this field.
    pub(super) fn column(&self, operand: Operand) -> Option<usize> {
        let FieldBits { first, width, .. } = self.controller.bits(operand).ok()?;
        self.columns.find(first, width)
    }

    /// Both constants are operands: other words than a [`crate::Clear`] has may clear to any depth.
    fn clear(&mut self, words: &[Word], columns: ContextColumns) -> Option<(CommandCost, usize)> {
        let template = self.templates.clear.as_ref()?;
        let (&[_, _, colour, _, depth], behind) = template.split(words)?;
        let far = u32::MAX >> (32 - self.layout.plan().z.width);
        for (column, value) in [(columns.colour, colour & 0xff_ffff), (columns.z, depth & far)] {
            self.vectors.run(Fill { column: self.columns.values_mut(column), value });
        }
        if !starts_anew(behind.first()) {
            self.enable.fill(true);
        }
        Some((template.cost, 1))
    }

    fn triangles(&mut self, words: &[Word], columns: ContextColumns) -> Option<(CommandCost, usize)> {
        let template = self.templates.triangle.as_ref()?;
        let [z, colour] = self.columns.many_mut([columns.z, columns.colour])?;
        let drawn = self.vectors.run(DrawTriangles {
            words,
            template,
            origin: self.controller.origin(),
            z_shift: self.layout.z_shift(),
            z,
            paint: PaintGouraud { colour },
            enable: &mut self.enable,
        });
        self.controller.hold(linear(words, last(drawn, TRIANGLE_WORDS)?));
        Some((template.cost, drawn))
    }

    fn phong_triangles(&mut self, words: &[Word], columns: ContextColumns) -> Option<(CommandCost, usize)> {
        let template = self.templates.phong_triangle.as_ref()?;
        let [nx, ny, nz] = columns.normal?;
        let [z, colour, nx, ny, nz] = self.columns.many_mut([columns.z, columns.colour, nx, ny, nz])?;
        let drawn = self.vectors.run(DrawTriangles {
            words,
            template,
            origin: self.controller.origin(),
            z_shift: self.layout.z_shift(),
            z,
            paint: PaintPhong { normal: [nx, ny, nz], constant: 0, colour },
            enable: &mut self.enable,
        });
        self.controller.hold(linear(words, last(drawn, PHONG_WORDS)?));
        Some((template.cost, drawn))
    }
}

/// Where the last coefficients of the last of some commands stand; `None` if there are none.
fn last(commands: usize, words: usize) -> Option<usize> {
    Some(commands.checked_sub(1)? * words + COMPONENTS_AT[2])
}

/// The same value in all pixels.
struct Fill<'a> {
    column: &'a mut Values,
    value: u32,
}

impl VectorKernel for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: SimdVector>(self) {
        self.column.0.fill(self.value);
    }
}

/// The next instruction overwrites Enable before anybody reads it: it is *enable all*, whatever its label.
pub(super) fn starts_anew(next: Option<&Word>) -> bool {
    const LABEL: Word = 0xff << 16;
    next.is_some_and(|word| word & !LABEL == head(opcode::ENABLE_ALL, 0, 0))
}

fn linear(words: &[Word], at: usize) -> Linear {
    Linear { a: words[at] as i32, b: words[at + 1] as i32, c: words[at + 2] as i32 }
}
