//! The registers that move with a pixel from stage to stage.

use super::arithmetic::Divider;
use crate::address::Footprint;
use crate::face::CubeFace;
use crate::orientation::MatrixWords;

/// A candidate for the nearest memory, with its four texels. After interpolation, all four are equal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) depths: [u32; 4],
    /// Colours of the four texels, with 8 bits per channel. Empty texels have the background colours.
    pub(super) colours: [u32; 4],
}

#[derive(Clone, Debug)]
pub(super) struct Registers {
    pub(super) pixel: [u32; 2],
    pub(super) matrix: MatrixWords,
    pub(super) vector: [i64; 3],
    pub(super) products: [[i64; 3]; 3],
    pub(super) sums: [i64; 3],
    pub(super) face: CubeFace,
    pub(super) dividers: [Divider; 2],
    pub(super) footprint: Option<Footprint>,
    pub(super) candidates: Vec<Candidate>,
    pub(super) behind: [u32; 4],
    pub(super) colour: u32,
}

impl Registers {
    pub(super) const fn of(pixel: [u32; 2], matrix: MatrixWords) -> Self {
        let none = Divider::new(0, 1);
        Self {
            pixel,
            matrix,
            vector: [0; 3],
            products: [[0; 3]; 3],
            sums: [0; 3],
            face: CubeFace::PosX,
            dividers: [none; 2],
            footprint: None,
            candidates: Vec::new(),
            behind: [0; 4],
            colour: 0,
        }
    }
}
