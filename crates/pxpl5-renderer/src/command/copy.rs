//! Commands for selecting a region, clearing, copying, and moving data to and from the backing store.

use super::{CommandKind, enable};
use crate::isa::{ArrayInstruction, Operand};
use crate::layout::Layout;
use pxpl5_wire::{CopyTarget, Lines, NodeId, PictureNumber, RegionGrid, RegionId};

/// Selects the region of all following commands: its position on the screen, and the context (part of pixel memory)
/// that holds it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SelectRegion {
    /// Index of the context (part of pixel memory for one region), less than the layout's number of contexts.
    pub context: u8,
    /// x coordinate of the region's left column on the screen, in pixels.
    pub left: u16,
    /// y coordinate of the region's top row on the screen, counted in drawn lines. If a picture is one field of an
    /// interlaced display, only every second line of the screen is drawn and counted.
    pub top: u16,
}

impl SelectRegion {
    pub(super) const fn program(&self, layout: &Layout) -> [ArrayInstruction; 1] {
        let context_base = layout.context_base(self.context);
        [ArrayInstruction::Select { context_base, left: self.left, top: self.top }]
    }

    pub(super) fn read(program: &[ArrayInstruction], layout: &Layout) -> Option<Self> {
        let &[ArrayInstruction::Select { context_base, left, top }] = program else { return None };
        let context = context_base.checked_div(layout.plan().context_bits)?;
        Some(Self { context, left, top })
    }
}

/// Sets the colour to the background and Z to the far plane, in all pixels of the array.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Clear {
    /// Background colour, 0x00RRGGBB.
    pub colour: u32,
}

impl Clear {
    pub(super) fn program(&self, layout: &Layout) -> [ArrayInstruction; 3] {
        [
            enable(CommandKind::Clear),
            ArrayInstruction::LoadConstant { destination: layout.plan().colour, value: self.colour },
            ArrayInstruction::LoadConstant { destination: layout.plan().z, value: u32::MAX },
        ]
    }

    pub(super) fn read(program: &[ArrayInstruction]) -> Option<Self> {
        match program.get(1)? {
            &ArrayInstruction::LoadConstant { value: colour, .. } => Some(Self { colour }),
            _ => None,
        }
    }
}

/// Copies the colours of a region to a frame buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CopyRegion {
    /// Destination of the pixels: frame buffer, pixel buffer (0 or 1), grid of regions, region, lines, and picture
    /// number.
    pub target: CopyTarget,
}

impl CopyRegion {
    pub(super) const fn program(&self, layout: &Layout) -> [ArrayInstruction; 1] {
        [ArrayInstruction::Output { field: layout.plan().colour, target: self.target }]
    }

    pub(super) fn read(program: &[ArrayInstruction]) -> Option<Self> {
        match program {
            &[ArrayInstruction::Output { target, .. }] => Some(Self { target }),
            _ => None,
        }
    }

    pub(super) const fn blank() -> Self {
        let target = CopyTarget {
            frame_buffer: NodeId(0),
            buffer: 0,
            lines: Lines::Frame,
            grid: RegionGrid::FRAME,
            region: RegionId(0),
            picture: PictureNumber(0),
        };
        Self { target }
    }
}

/// Stores 32 bits of every pixel in a block of the backing store.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StoreBacking {
    /// Block of the backing store, 0 to 127.
    pub block: u8,
    /// Address of the first bit of the 32 bits in pixel memory: an absolute address from 0 to 176.
    pub address: u8,
}

impl StoreBacking {
    pub(super) const fn instruction(self) -> ArrayInstruction {
        ArrayInstruction::StoreBlock { field: Operand::absolute(self.address, 32), block: self.block }
    }

    pub(super) fn read(program: &[ArrayInstruction]) -> Option<Self> {
        match program {
            &[ArrayInstruction::StoreBlock { field, block }] => Some(Self { block, address: field.address }),
            _ => None,
        }
    }
}

/// Loads 32 bits of every pixel from a block of the backing store.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LoadBacking {
    /// Block of the backing store, 0 to 127.
    pub block: u8,
    /// Address of the first bit of the 32 bits in pixel memory: an absolute address from 0 to 176.
    pub address: u8,
}

impl LoadBacking {
    pub(super) const fn instruction(self) -> ArrayInstruction {
        ArrayInstruction::LoadBlock { field: Operand::absolute(self.address, 32), block: self.block }
    }

    pub(super) fn read(program: &[ArrayInstruction]) -> Option<Self> {
        match program {
            &[ArrayInstruction::LoadBlock { field, block }] => Some(Self { block, address: field.address }),
            _ => None,
        }
    }
}
