//! The four interleaved memories of a display memory, as words lie in them.

use crate::face::{CubeFace, TexelAddress};
use crate::texel::{DEPTH_FARTHEST, FaceSet, TexelFormat, narrowed, widened};

/// Colour and depth as a bank holds them: of 16 bits the narrow words themselves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cell {
    /// Kept bits of the depth, all ones for an empty texel.
    pub(super) depth: u32,
    /// Kept bits of the colour.
    pub(super) colour: u32,
}

/// The shown buffer of one display memory: four banks, each with its part of six faces.
#[derive(Clone, Debug)]
pub struct BankedMemory {
    texels: u32,
    format: TexelFormat,
    banks: [Vec<Cell>; 4],
}

impl BankedMemory {
    /// The banks with what six faces show, texel by texel.
    #[must_use]
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

    /// The address within a bank: the face above the word.
    fn place(&self, texel: TexelAddress) -> usize {
        let words_of_a_face = self.texels / 2 * (self.texels / 2);
        (texel.face as u32 * words_of_a_face + texel.word(self.texels)) as usize
    }

    pub(super) fn read(&self, texel: TexelAddress) -> Cell {
        self.banks[texel.bank() as usize][self.place(texel)]
    }

    /// The depth of an empty texel.
    pub(super) const fn farthest(&self) -> u32 {
        DEPTH_FARTHEST >> (24 - self.format.depth_bits)
    }

    /// A cell's colour in 8 bits a channel.
    pub(super) const fn wide(&self, cell: Cell) -> u32 {
        if self.format.colour_bits == 16 { widened(cell.colour) } else { cell.colour }
    }
}
