//! The four interleaved banks of a display memory in the reference model.

use crate::face::{CubeFace, TexelAddress};
use crate::texel::{DEPTH_FARTHEST, FaceSet, TexelFormat, narrowed, widened};

/// Colour and depth as a bank stores them. With 16-bit formats, `depth` and `colour` hold words of 16 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cell {
    /// Stored bits of the depth. All bits are one for an empty texel.
    pub(super) depth: u32,
    pub(super) colour: u32,
}

/// The visible buffer of one display memory as four banks. Each bank holds a quarter of the texels of all six faces.
#[derive(Clone, Debug)]
pub struct BankedMemory {
    texels: u32,
    format: TexelFormat,
    banks: [Vec<Cell>; 4],
}

impl BankedMemory {
    /// Copies the texels of six faces into banks, one by one.
    pub fn of(faces: &FaceSet) -> Self {
        let texels = faces.texels();
        let format = faces.format();
        let empty = Cell { depth: DEPTH_FARTHEST >> (24 - format.depth_bits), colour: 0 };
        let words = 6 * (texels / 2 * (texels / 2)) as usize;
        let mut memory = Self { texels, format, banks: [0; 4].map(|_| vec![empty; words]) };
        for face in CubeFace::ALL {
            for row in 0..texels {
                for column in 0..texels {
                    let texel = TexelAddress { face, column, row };
                    // Empty texels keep the initial cell.
                    if let Some((colour, depth)) = faces.texel(texel) {
                        let colour = if format.colour_bits == 16 { narrowed(colour) } else { colour };
                        let place = memory.place(texel);
                        memory.banks[texel.bank() as usize][place] = Cell { depth, colour };
                    }
                }
            }
        }
        memory
    }

    /// Returns the address of a texel within its bank. The face forms the upper part of the address.
    fn place(&self, texel: TexelAddress) -> usize {
        let words_of_a_face = self.texels / 2 * (self.texels / 2);
        (texel.face as u32 * words_of_a_face + texel.word(self.texels)) as usize
    }

    pub(super) fn read(&self, texel: TexelAddress) -> Cell {
        self.banks[texel.bank() as usize][self.place(texel)]
    }

    pub(super) const fn farthest(&self) -> u32 {
        DEPTH_FARTHEST >> (24 - self.format.depth_bits)
    }

    /// Returns the colour stored in a cell, converted to 8 bits per channel.
    pub(super) const fn wide(&self, cell: Cell) -> u32 {
        if self.format.colour_bits == 16 { widened(cell.colour) } else { cell.colour }
    }
}
