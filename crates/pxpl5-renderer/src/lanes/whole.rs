//! Fast execution of whole commands that the array recognizes in a list of words.

use super::Lanes;
use super::columns::{ContextColumns, Values};
use super::painter::TrianglePainter;
use super::template::{CommandCost, next_enables_all};
use super::triangle::{DrawBatch, DrawTriangles, PaintGouraud, PaintPhong};
use crate::array::Executed;
use crate::command::{COMPONENTS_AT, CommandKind, PHONG_WORDS, TRIANGLE_WORDS};
use crate::controller::FieldBits;
use crate::isa::Operand;
use crate::simd::{SimdVector, VectorKernel};
use pxpl5_wire::{Linear, TriangleBatch, Word};

impl Lanes {
    /// Executes the command at the start of `words`, and returns its length in words. Returns `None` if the words are
    /// not a command of this layout.
    ///
    /// Triangles of the same kind that follow a triangle directly are executed too, and their words are included in the
    /// length.
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

    /// Returns the columns (arrays of words) for the bit fields of the selected context, the part of pixel memory that
    /// holds one region. The result is cached until another context is selected.
    #[inline]
    fn context_columns(&mut self) -> Option<ContextColumns> {
        if self.selected.is_none_or(|selected| selected.base != self.controller.base) {
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

    /// Returns the columns (arrays of words) for x, y and z of the normals in the selected context. Returns `None` if
    /// the layout has no normals.
    fn normal_columns(&self) -> Option<[usize; 3]> {
        let x = self.column(self.layout.normal(0)?)?;
        let y = self.column(self.layout.normal(1)?)?;
        let z = self.column(self.layout.normal(2)?)?;
        Some([x, y, z])
    }

    /// Returns the index of the column (array of words) that holds exactly the bit field `operand`, or `None` if there
    /// is no such column.
    pub(super) fn column(&self, operand: Operand) -> Option<usize> {
        let FieldBits { first, width, .. } = self.controller.bits(operand).ok()?;
        self.columns.find(first, width)
    }

    /// Executes a clear command. The depth comes from the words of the command, because it can differ from the depth of
    /// [`crate::Clear`].
    fn clear(&mut self, words: &[Word], columns: ContextColumns) -> Option<(CommandCost, usize)> {
        let template = self.templates.clear.as_ref()?;
        let (&[_, _, colour, _, depth], behind) = template.split(words)?;
        let far = u32::MAX >> (32 - self.layout.plan().z.width);
        for (column, value) in [(columns.colour, colour & 0xff_ffff), (columns.z, depth & far)] {
            self.vectors.run(Fill { column: self.columns.values_mut(column), value });
        }
        if !next_enables_all(behind.first()) {
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
            painter: TrianglePainter {
                origin: self.controller.origin(),
                z_shift: self.layout.z_shift(),
                z,
                paint: PaintGouraud { colour },
                enable: &mut self.enable,
            },
        });
        // The evaluator keeps the last expression, which a later command may use again.
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
            painter: TrianglePainter {
                origin: self.controller.origin(),
                z_shift: self.layout.z_shift(),
                z,
                paint: PaintPhong { normal: [nx, ny, nz], constant: 0, colour },
                enable: &mut self.enable,
            },
        });
        // A later instruction may reuse the last linear coefficients.
        self.controller.hold(linear(words, last(drawn, PHONG_WORDS)?));
        Some((template.cost, drawn))
    }

    /// Draws a batch of triangles in the same pixels as the triangles' commands. Enable and the stored coefficients can
    /// differ from the result of these commands. Returns `None` if the layout does not support the command.
    pub(super) fn batch(&mut self, batch: &TriangleBatch<'_>) -> Option<()> {
        let columns = self.context_columns()?;
        let origin = self.controller.origin();
        let z_shift = self.layout.z_shift();
        let enable = &mut self.enable;
        // A batch without colours holds Gouraud triangles, so its planes are colours.
        if batch.colours.is_none() {
            self.templates.triangle.as_ref()?;
            let [z, colour] = self.columns.many_mut([columns.z, columns.colour])?;
            let painter = TrianglePainter { origin, z_shift, z, paint: PaintGouraud { colour }, enable };
            self.vectors.run(DrawBatch { batch, painter });
        } else {
            self.templates.phong_triangle.as_ref()?;
            let [nx, ny, nz] = columns.normal?;
            let [z, colour, nx, ny, nz] = self.columns.many_mut([columns.z, columns.colour, nx, ny, nz])?;
            let paint = PaintPhong { normal: [nx, ny, nz], constant: 0, colour };
            let painter = TrianglePainter { origin, z_shift, z, paint, enable };
            self.vectors.run(DrawBatch { batch, painter });
        }
        Some(())
    }
}

/// Returns the index of the first coefficient word of the last expression of the last command. The list has `commands`
/// commands of `words` words each. Returns `None` if there are no commands.
fn last(commands: usize, words: usize) -> Option<usize> {
    Some(commands.checked_sub(1)? * words + COMPONENTS_AT[2])
}

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

fn linear(words: &[Word], at: usize) -> Linear {
    Linear { a: words[at] as i32, b: words[at + 1] as i32, c: words[at + 2] as i32 }
}
