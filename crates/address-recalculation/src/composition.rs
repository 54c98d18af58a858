//! Composition of a pixel from all display memories: selection of the smallest depth, and interpolation of four texels.

use crate::texel::{colour, nearness};
use serde::{Deserialize, Serialize};

/// Order of two steps: comparison of the memories' depths, and interpolation of texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CompositionOrder {
    /// First, the memory with the smallest depth is selected for each texel. Then the four selected texels are
    /// interpolated (assumed).
    #[default]
    DepthFirst,
    /// First, the four texels of each memory are interpolated, including their depths. Then the memory with the
    /// smallest depth is selected.
    InterpolationFirst,
}

impl CompositionOrder {
    pub const ALL: [(&str, Self); 2] =
        [("depth-first", Self::DepthFirst), ("interpolation-first", Self::InterpolationFirst)];
}

/// Rules by which the texels of several memories give the colour of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Composition {
    pub order: CompositionOrder,
    /// Colour of empty texels if there is no background memory, 0x00RRGGBB.
    pub background: u32,
    /// Number of bits of an interpolation fraction.
    pub weight_bits: u64,
}

pub(crate) struct Gathered<'a> {
    /// Words of the upper left, upper right, lower left and lower right texel in each display memory.
    pub(crate) memories: &'a [[u64; 4]],
    pub(crate) behind: [u32; 4],
    /// Weights in units of `4^-weight_bits`. `None` marks a texel beyond a corner. The mean of the other three texels
    /// replaces such a texel.
    pub(crate) weights: [Option<u32>; 4],
}

impl Composition {
    pub(crate) fn pixel(&self, gathered: &Gathered<'_>) -> u32 {
        match self.order {
            CompositionOrder::DepthFirst => {
                let four = [0, 1, 2, 3].map(|k| {
                    let nearest = gathered.memories.iter().fold(0, |best, words| nearer(best, words[k]));
                    shown(nearest, gathered.behind[k])
                });
                self.mix(four, gathered.weights)
            }
            CompositionOrder::InterpolationFirst => self.nearest_mix(gathered),
        }
    }

    fn nearest_mix(&self, gathered: &Gathered<'_>) -> u32 {
        let mut best = (0, self.mix(gathered.behind, gathered.weights));
        for words in gathered.memories {
            let near = self.mixed_nearness(words.map(nearness), gathered.weights);
            if near > best.0 {
                let four = [0, 1, 2, 3].map(|k| shown(words[k], gathered.behind[k]));
                best = (near, self.mix(four, gathered.weights));
            }
        }
        best.1
    }

    /// Interpolates four colours. The result is rounded to the nearest, and halves are rounded up.
    fn mix(&self, four: [u32; 4], weights: [Option<u32>; 4]) -> u32 {
        [16, 8, 0].iter().fold(0, |pixel, shift| {
            pixel | self.weighed(four.map(|colour| colour >> shift & 0xFF), weights, true) << shift
        })
    }

    /// Interpolates the nearness of four texels: the farthest depth minus the depth of the texel. The result is rounded
    /// down.
    fn mixed_nearness(&self, four: [u32; 4], weights: [Option<u32>; 4]) -> u32 {
        self.weighed(four, weights, false)
    }

    fn weighed(&self, four: [u32; 4], weights: [Option<u32>; 4], is_rounded: bool) -> u32 {
        if weights.contains(&None) {
            let sum: u64 =
                four.iter().zip(weights).filter_map(|(value, weight)| weight.map(|_| u64::from(*value))).sum();
            return if is_rounded { ((2 * sum + 3) / 6) as u32 } else { (sum / 3) as u32 };
        }
        let sum: u64 =
            four.iter().zip(weights).map(|(value, weight)| u64::from(*value) * u64::from(weight.unwrap_or(0))).sum();
        let half = if is_rounded { (1 << (2 * self.weight_bits)) >> 1 } else { 0 };
        ((sum + half) >> (2 * self.weight_bits)) as u32
    }
}

/// Returns the nearer of two texel words. At equal depth, the result is the first word.
#[inline(always)]
pub(crate) const fn nearer(first: u64, second: u64) -> u64 {
    // Both words are below 2^56, so signed comparisons work. Vector units have signed comparisons.
    if second as i64 > (first | 0xFFFF_FFFF) as i64 { second } else { first }
}

/// Returns the colour of a texel, or the background `behind` if the texel is empty.
#[inline(always)]
pub(crate) const fn shown(word: u64, behind: u32) -> u32 {
    if nearness(word) == 0 { behind } else { colour(word) }
}
