//! Region warping: the displacement of vertices at the borders between display memories, before TRANSFORM.

use address_recalculation::priority::{Cell, CellAssignment, Falloff, RegionWarp};
use glam::DVec3;
use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::Word;

/// Displacement of vertices at the border to another display memory.
///
/// The other memory is updated less often, so it was drawn from an older eye position. Without the displacement, the
/// pictures of the two memories would not meet at the border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceWarp {
    /// The display memory of each cell, where a cell is a square of the floor.
    pub assignment: CellAssignment,
    /// The function by which the displacement decreases with the distance from the border.
    pub falloff: Falloff,
    /// Distance from the border at which the displacement ends, in metres.
    pub length_m: f64,
    /// Eye position from which this update is drawn, in metres.
    pub drawn_from: DVec3,
    /// Eye position from which the other memory was drawn, in metres.
    pub slower_from: DVec3,
}

/// Number of words of an encoded warp.
///
/// The cell at the centre of the assignment takes four words. One word has `inner_rings` in its lower half and
/// `ring_growth` in its upper half. The number of memories and the kind of falloff take a word each. Two lengths and
/// two positions follow, with two words for each real number.
pub(crate) const WARP_WORDS: usize = 7 + 2 * (2 + 6);

impl FaceWarp {
    /// Returns the displaced position of a vertex that display memory number `memory` holds.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the length of the falloff is not positive and finite.
    pub fn moved(&self, vertex: DVec3, memory: usize) -> Result<DVec3, SettingError> {
        let warp = RegionWarp::new(self.falloff, self.length_m, self.drawn_from, self.slower_from)?;
        Ok(warp.moved(vertex, self.assignment.to_slower(vertex, memory)))
    }

    pub(crate) fn to_words(self) -> Vec<Word> {
        let CellAssignment { home, side_m, inner_rings, ring_growth, memories } = self.assignment;
        let falloff = Falloff::ALL.iter().position(|(_, falloff)| *falloff == self.falloff).unwrap_or_default();
        let cell = [home.x, home.z].map(|number| halves(number as u64)).concat();
        let counts = [inner_rings as Word | (ring_growth as Word) << 16, memories as Word, falloff as Word];
        let reals =
            [[side_m, self.length_m].to_vec(), self.drawn_from.to_array().into(), self.slower_from.to_array().into()];
        let reals = reals.concat().into_iter().flat_map(|real: f64| halves(real.to_bits()));
        cell.into_iter().chain(counts).chain(reals).collect()
    }

    pub(crate) fn from_words(words: &[Word; WARP_WORDS]) -> Option<Self> {
        let (whole, reals) = words.split_first_chunk::<7>()?;
        // The words of integers come first, then floating-point numbers with two words each.
        let [x_low, x_high, z_low, z_high, rings, memories, falloff] = *whole;
        let cell = |low: Word, high: Word| joined(low, high) as i64;
        let reals: Vec<f64> = reals.chunks_exact(2).map(|pair| f64::from_bits(joined(pair[0], pair[1]))).collect();
        let [side_m, length_m, places @ ..] = &reals[..] else { return None };
        Some(Self {
            assignment: CellAssignment {
                home: Cell { x: cell(x_low, x_high), z: cell(z_low, z_high) },
                side_m: *side_m,
                inner_rings: (rings & 0xFFFF).into(),
                ring_growth: (rings >> 16).into(),
                memories: memories as usize,
            },
            falloff: Falloff::ALL.get(falloff as usize)?.1,
            length_m: *length_m,
            drawn_from: DVec3::from_slice(places.get(..3)?),
            slower_from: DVec3::from_slice(places.get(3..6)?),
        })
    }
}

/// Splits a number into two words, low word first.
const fn halves(number: u64) -> [Word; 2] {
    [number as Word, (number >> 32) as Word]
}

const fn joined(low: Word, high: Word) -> u64 {
    low as u64 | (high as u64) << 32
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) fn warp() -> FaceWarp {
        FaceWarp {
            assignment: CellAssignment {
                home: Cell { x: -3, z: 1 << 40 },
                side_m: 5.0,
                inner_rings: 1,
                ring_growth: 2,
                memories: 4,
            },
            falloff: Falloff::Smoothstep,
            length_m: 4.5,
            drawn_from: DVec3::new(0.1, 1.7, -2.0),
            slower_from: DVec3::new(0.0, -1.7, 1e6),
        }
    }

    #[test]
    fn a_warp_is_decoded_from_its_words() {
        let warp = warp();
        let words: [Word; WARP_WORDS] = warp.to_words().try_into().expect("WARP_WORDS words");
        assert_eq!(FaceWarp::from_words(&words), Some(warp));
    }
}
