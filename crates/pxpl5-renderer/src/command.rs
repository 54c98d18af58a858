//! Commands: fixed-length programs of array instructions, which the graphics processors send.
//!
//! A command holds typed operands. With the [`Layout`] they determine its program. A drawing command begins with
//! *enable all*, whose label is the command's kind. The array ignores the label, but [`Command::decode`] and the fast
//! pixel array recognize the command by it.
//!
//! # Formats
//!
//! - Edge: a pixel is inside if the expression is `>= 0` there. A pixel exactly on an edge of two triangles must belong
//!   to one of them, for which the sender adjusts the constant coefficient.
//! - Depth: `(z >> Z_FRACTION_BITS) & (2^24 - 1)`, where nearer is smaller. A pixel passes if the new depth is
//!   **strictly less** than the stored depth. A layout with a narrower Z stores and compares the upper bits of the
//!   depth.
//! - Colour component: `(e >> COLOUR_FRACTION_BITS) & 255` for the expression `e`. Values outside 0 to 255 wrap around,
//!   so senders keep the colours of triangles in this range. Sphere commands limit colours to 0 .. 255.
//! - Normal component: the low 12 bits of `e >> NORMAL_FRACTION_BITS`, as a two's complement number.
//!
//! # Words and clocks
//!
//! | kind | words | clocks | published or assumed clocks |
//! |---|---|---|---|
//! | triangle (Gouraud) | 30 | 258 | the published steps need 256 |
//! | Phong triangle | 32 | 292 | 267 at 150,000 triangles a second (F89); the published steps need 262 to 292, with 28 for the object's colour |
//! | sphere | 53 | 810 (748 for Slats) | assumed "a little dearer than a triangle"; see [`SphereCommand`] |
//! | Phong sphere | 38 | 504 | the same |
//! | shade | 89 | 3,790 = 95 us | assumed 4,000 to 8,000 (100 to 200 us); see [`Shade`] |
//! | clear | 5 | 62 (58 for Slats) | |
//! | select region | 2 | 6 | |
//!
//! The transaction level uses the same times ([`crate::RendererTiming`]).

mod copy;
mod draw;
mod shade;
mod sphere;

pub use copy::{Clear, CopyRegion, LoadBacking, SelectRegion, StoreBacking};
pub(crate) use draw::{COMPONENTS_AT, DEPTH_AT, EDGES_AT, PHONG_WORDS, TRIANGLE_WORDS};
pub use draw::{PhongTriangleCommand, PhongTriangleEncoder, TriangleCommand, TriangleEncoder};
pub(crate) use shade::ShadeFields;
pub use shade::{SPECULAR_SQUARINGS, Shade};
pub(crate) use sphere::SphereScratch;
pub use sphere::{PhongSphereCommand, SphereBody, SphereCommand};

use crate::isa::{ArrayInstruction, DecodeError, DecodeErrorKind, Operand};
use crate::layout::Layout;
use pxpl5_wire::Word;

/// The kind of a command for a renderer.
///
/// The numeric value of the kind is the opcode in [`pxpl5_wire::CommandRun`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum CommandKind {
    /// Selects the region of the following commands, and the context (part of pixel memory) that holds it.
    SelectRegion = 1,
    Clear = 2,
    Triangle = 3,
    PhongTriangle = 4,
    Sphere = 5,
    PhongSphere = 6,
    Shade = 7,
    CopyRegion = 8,
    StoreBacking = 9,
    LoadBacking = 10,
    /// Waits until the backing store is idle.
    WaitBacking = 11,
}

impl CommandKind {
    /// All kinds, in the order of their opcodes.
    pub const ALL: [Self; 11] = [
        Self::SelectRegion,
        Self::Clear,
        Self::Triangle,
        Self::PhongTriangle,
        Self::Sphere,
        Self::PhongSphere,
        Self::Shade,
        Self::CopyRegion,
        Self::StoreBacking,
        Self::LoadBacking,
        Self::WaitBacking,
    ];

    pub const fn from_opcode(opcode: u8) -> Option<Self> {
        match opcode {
            1..=11 => Some(Self::ALL[opcode as usize - 1]),
            _ => None,
        }
    }

    pub const fn opcode(self) -> u8 {
        self as u8
    }

    /// Returns the length of the command in words. The length is the same in every layout.
    pub const fn words(self) -> u32 {
        match self {
            Self::SelectRegion => 2,
            Self::Clear => 5,
            Self::Triangle => 30,
            Self::PhongTriangle => 32,
            Self::Sphere => 53,
            Self::PhongSphere => 38,
            Self::Shade => 89,
            Self::CopyRegion => 9,
            Self::StoreBacking | Self::LoadBacking | Self::WaitBacking => 1,
        }
    }

    /// Returns the number of clocks for which the array executes the program of a command of this kind.
    ///
    /// # Errors
    /// Returns [`Unsupported`] if the layout lacks a bit field that the program needs.
    pub fn clocks(self, layout: &Layout) -> Result<u32, Unsupported> {
        let program = Command::blank(self).program(layout)?;
        Ok(program.iter().map(ArrayInstruction::clocks).sum())
    }
}

/// An error for a command that needs a bit field of pixel memory that the layout does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{kind:?} needs {missing}, which layout {layout} lacks")]
pub struct Unsupported {
    pub kind: CommandKind,
    /// Name of the layout, from `ContextPlan::name`.
    pub layout: &'static str,
    /// Description of the missing bit field, or of the missing bits of scratch memory.
    pub missing: &'static str,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    SelectRegion(SelectRegion),
    Clear(Clear),
    /// Draws a triangle with interpolated colour (Gouraud).
    Triangle(TriangleCommand),
    /// Draws a triangle whose pixels are shaded after the last primitive of the region.
    PhongTriangle(PhongTriangleCommand),
    /// Draws a sphere with interpolated colour.
    Sphere(SphereCommand),
    /// Draws a sphere whose pixels are shaded after the last primitive of the region.
    PhongSphere(PhongSphereCommand),
    Shade(Shade),
    CopyRegion(CopyRegion),
    StoreBacking(StoreBacking),
    LoadBacking(LoadBacking),
    WaitBacking,
}

impl Command {
    pub const fn kind(&self) -> CommandKind {
        match self {
            Self::SelectRegion(_) => CommandKind::SelectRegion,
            Self::Clear(_) => CommandKind::Clear,
            Self::Triangle(_) => CommandKind::Triangle,
            Self::PhongTriangle(_) => CommandKind::PhongTriangle,
            Self::Sphere(_) => CommandKind::Sphere,
            Self::PhongSphere(_) => CommandKind::PhongSphere,
            Self::Shade(_) => CommandKind::Shade,
            Self::CopyRegion(_) => CommandKind::CopyRegion,
            Self::StoreBacking(_) => CommandKind::StoreBacking,
            Self::LoadBacking(_) => CommandKind::LoadBacking,
            Self::WaitBacking => CommandKind::WaitBacking,
        }
    }

    /// Returns the program of array instructions for this command.
    ///
    /// # Errors
    /// Returns [`Unsupported`] if the layout lacks a bit field that the program needs.
    pub fn program(&self, layout: &Layout) -> Result<Vec<ArrayInstruction>, Unsupported> {
        let program = match self {
            Self::SelectRegion(command) => Ok(command.program(layout).to_vec()),
            Self::Clear(command) => Ok(command.program(layout).to_vec()),
            Self::Triangle(command) => Ok(command.program(layout)),
            Self::PhongTriangle(command) => command.program(layout),
            Self::Sphere(command) => command.program(layout),
            Self::PhongSphere(command) => command.program(layout),
            Self::Shade(command) => command.program(layout),
            Self::CopyRegion(command) => Ok(command.program(layout).to_vec()),
            Self::StoreBacking(command) => Ok(vec![command.instruction()]),
            Self::LoadBacking(command) => Ok(vec![command.instruction()]),
            Self::WaitBacking => Ok(vec![ArrayInstruction::Wait]),
        };
        program.map_err(|missing| self.unsupported(missing, layout))
    }

    fn unsupported(&self, MissingField(missing): MissingField, layout: &Layout) -> Unsupported {
        Unsupported { kind: self.kind(), layout: layout.plan().name, missing }
    }

    /// Appends the words of the command's [program](Command::program) to `out`.
    ///
    /// # Errors
    /// Returns [`Unsupported`] if the layout lacks a bit field that the program needs.
    pub fn encode(&self, layout: &Layout, out: &mut Vec<Word>) -> Result<(), Unsupported> {
        match self {
            Self::SelectRegion(command) => encode_all(&command.program(layout), out),
            Self::Clear(command) => encode_all(&command.program(layout), out),
            Self::CopyRegion(command) => encode_all(&command.program(layout), out),
            _ => encode_all(&self.program(layout)?, out),
        }
        Ok(())
    }

    /// Decodes the command that begins at word `position`. Returns the command and its length in words.
    ///
    /// # Errors
    /// Returns [`DecodeError`] if the words do not encode instructions, or if the instructions are not the program of a
    /// command in this layout.
    pub fn decode(words: &[Word], position: usize, layout: &Layout) -> Result<(Self, usize), DecodeError> {
        let (first, _) = ArrayInstruction::decode(words, position)?;
        // The label of the first instruction gives the kind, and the kind gives the number of words.
        let kind = kind_of(&first).ok_or_else(|| not_the_command(words, position, (words[position] >> 16) as u8))?;
        let length = kind.words() as usize;
        let end = words.len().min(position + length);
        let program = decode_range(&words[..end], position)?;
        let command = Self::from_program(kind, &program, layout)
            .ok_or_else(|| not_the_command(words, position, kind.opcode()))?;
        // The operands determine the whole program, so compare all its words with the words in the list.
        match command.program(layout) {
            Ok(expected) if expected == program => Ok((command, length)),
            _ => Err(not_the_command(words, position, kind.opcode())),
        }
    }

    pub(crate) fn blank(kind: CommandKind) -> Self {
        match kind {
            CommandKind::SelectRegion => Self::SelectRegion(SelectRegion::default()),
            CommandKind::Clear => Self::Clear(Clear::default()),
            CommandKind::Triangle => Self::Triangle(TriangleCommand::default()),
            CommandKind::PhongTriangle => Self::PhongTriangle(PhongTriangleCommand::default()),
            CommandKind::Sphere => Self::Sphere(SphereCommand::default()),
            CommandKind::PhongSphere => Self::PhongSphere(PhongSphereCommand::default()),
            CommandKind::Shade => Self::Shade(Shade::default()),
            CommandKind::CopyRegion => Self::CopyRegion(CopyRegion::blank()),
            CommandKind::StoreBacking => Self::StoreBacking(StoreBacking::default()),
            CommandKind::LoadBacking => Self::LoadBacking(LoadBacking::default()),
            CommandKind::WaitBacking => Self::WaitBacking,
        }
    }

    /// Extracts the operands from the program of a command. The function ignores the rest of the program, so the caller
    /// must compare the rest with the expected program.
    fn from_program(kind: CommandKind, program: &[ArrayInstruction], layout: &Layout) -> Option<Self> {
        Some(match kind {
            CommandKind::SelectRegion => Self::SelectRegion(SelectRegion::read(program, layout)?),
            CommandKind::Clear => Self::Clear(Clear::read(program)?),
            CommandKind::Triangle => Self::Triangle(TriangleCommand::read(program)?),
            CommandKind::PhongTriangle => Self::PhongTriangle(PhongTriangleCommand::read(program)?),
            CommandKind::Sphere => Self::Sphere(SphereCommand::read(program, layout)?),
            CommandKind::PhongSphere => Self::PhongSphere(PhongSphereCommand::read(program, layout)?),
            CommandKind::Shade => Self::Shade(Shade::read(program)?),
            CommandKind::CopyRegion => Self::CopyRegion(CopyRegion::read(program)?),
            CommandKind::StoreBacking => Self::StoreBacking(StoreBacking::read(program)?),
            CommandKind::LoadBacking => Self::LoadBacking(LoadBacking::read(program)?),
            CommandKind::WaitBacking => Self::WaitBacking,
        })
    }
}

/// Returns the error for instructions that begin like the program of a command, but differ from this program later.
/// `label` is the opcode of the command's kind, which the first instruction contains.
fn not_the_command(words: &[Word], position: usize, label: u8) -> DecodeError {
    DecodeError { position, word: words[position], kind: DecodeErrorKind::NotTheCommand(label) }
}

pub(crate) struct MissingField(&'static str);

fn encode_all(program: &[ArrayInstruction], out: &mut Vec<Word>) {
    program.iter().for_each(|instruction| instruction.encode(out));
}

fn kind_of(first: &ArrayInstruction) -> Option<CommandKind> {
    match first {
        ArrayInstruction::EnableAll { label } => CommandKind::from_opcode(*label),
        ArrayInstruction::Select { .. } => Some(CommandKind::SelectRegion),
        ArrayInstruction::Output { .. } => Some(CommandKind::CopyRegion),
        ArrayInstruction::StoreBlock { .. } => Some(CommandKind::StoreBacking),
        ArrayInstruction::LoadBlock { .. } => Some(CommandKind::LoadBacking),
        ArrayInstruction::Wait => Some(CommandKind::WaitBacking),
        _ => None,
    }
}

fn decode_range(words: &[Word], from: usize) -> Result<Vec<ArrayInstruction>, DecodeError> {
    let mut out = Vec::with_capacity(16);
    let mut position = from;
    while position < words.len() {
        let (instruction, used) = ArrayInstruction::decode(words, position)?;
        out.push(instruction);
        position += used;
    }
    Ok(out)
}

/// Returns the bit field for one component of the normal: 0 (x), 1 (y) or 2 (z).
fn normal(layout: &Layout, component: u8) -> Result<Operand, MissingField> {
    layout.normal(component).ok_or(MissingField("a normal"))
}

const fn enable(kind: CommandKind) -> ArrayInstruction {
    ArrayInstruction::EnableAll { label: kind.opcode() }
}

#[cfg(test)]
mod tests;
