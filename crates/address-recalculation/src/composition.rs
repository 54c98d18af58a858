//! Which of several memories a texel shows, and four texels as one pixel.

use crate::texel::{colour, nearness};
use serde::{Deserialize, Serialize};

/// What comes first: depths or weights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CompositionOrder {
    /// Of each texel the nearest of all memories, then the four are interpolated (assumed).
    #[default]
    DepthFirst,
    /// Each memory is interpolated, depth too, then the nearest memory is shown.
    InterpolationFirst,
}

impl CompositionOrder {
    /// All, by their names on the command line.
    pub const ALL: [(&str, Self); 2] =
        [("depth-first", Self::DepthFirst), ("interpolation-first", Self::InterpolationFirst)];
}

/// How memories become pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Composition {
    /// Whether depths or weights come first.
    pub order: CompositionOrder,
    /// What empty texels show where there is no background memory: 0x00RRGGBB.
    pub background: u32,
    /// Bits of a fraction.
    pub weight_bits: u64,
}

/// Four texels' words in each memory, and how they are weighed; the colours behind all memories.
pub(crate) struct Gathered<'a> {
    /// For each memory the words of the upper left, upper right, lower left and lower right texel.
    pub(crate) memories: &'a [[u64; 4]],
    /// Background of the four texels.
    pub(crate) behind: [u32; 4],
    /// Weights in parts of 4^weight_bits, `None` beyond a corner: the mean of the other three.
    pub(crate) weights: [Option<u32>; 4],
}

impl Composition {
    /// The pixel that four texels of all memories make.
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

    /// Colours weighed, rounded to the nearest, halves up.
    fn mix(&self, four: [u32; 4], weights: [Option<u32>; 4]) -> u32 {
        [16, 8, 0].iter().fold(0, |pixel, shift| {
            pixel | self.weighed(four.map(|colour| colour >> shift & 0xFF), weights, true) << shift
        })
    }

    /// Depths weighed, rounded down.
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

/// The nearer of two texels' words, the first on ties.
#[inline(always)]
pub(crate) const fn nearer(first: u64, second: u64) -> u64 {
    // Both are below 2^56: signed comparisons, which vector units have.
    if second as i64 > (first | 0xFFFF_FFFF) as i64 { second } else { first }
}

/// A texel's colour, or what is behind it where it is empty.
#[inline(always)]
pub(crate) const fn shown(word: u64, behind: u32) -> u32 {
    if nearness(word) == 0 { behind } else { colour(word) }
}
