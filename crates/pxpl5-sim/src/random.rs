//! Pseudo-random numbers that are the same on every computer.

use crate::trace::{INCREMENT, mix};

/// The generator SplitMix64 (Steele, Lea and Flood: Fast splittable pseudorandom number generators, 2014). Each of the
/// 2^64 numbers of 64 bits occurs once in its sequence. It suits tests and random lists, but not cryptography.
#[derive(Clone, Copy, Debug)]
pub struct SplitMix64 {
    state: u64,
}

impl SplitMix64 {
    /// Makes the generator with a seed. All seeds give the same cyclic sequence of numbers, but each seed starts at a
    /// different position of this sequence.
    pub const fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// Returns the next number of the sequence, which has 64 random bits.
    pub const fn bits(&mut self) -> u64 {
        let bits = mix(self.state);
        self.state = self.state.wrapping_add(INCREMENT);
        bits
    }

    /// Returns a random number from 0 to `n` - 1. The bias, the deviation from equal probabilities, is below `n` /
    /// 2^64.
    ///
    /// # Panics
    ///
    /// Panics if `n` is 0.
    pub const fn below(&mut self, n: u64) -> u64 {
        self.bits() % n
    }

    /// Returns a random number from `least` to `most`.
    ///
    /// # Panics
    ///
    /// Panics if the range is empty, or contains all 2^64 numbers.
    pub const fn between(&mut self, least: u64, most: u64) -> u64 {
        least + self.below(most - least + 1)
    }

    /// Returns a random element of a list.
    ///
    /// # Panics
    ///
    /// Panics if the list is empty.
    pub const fn element<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len() as u64) as usize]
    }

    /// Returns a random number that is at least 0 and less than 1, a multiple of 2^-24. `f32` represents every such
    /// number exactly.
    pub const fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1u32 << 24) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First outputs of the generator for the seed 1234567, as printed by Vigna's reference program.
    const PUBLISHED: [u64; 5] = [
        6_457_827_717_110_365_317,
        3_203_168_211_198_807_973,
        9_817_491_932_198_370_423,
        4_593_380_528_125_082_431,
        16_408_922_859_458_223_821,
    ];

    #[test]
    fn the_random_sequence_is_the_published_sequence() {
        let mut random = SplitMix64::new(1_234_567);
        assert_eq!(PUBLISHED.map(|_| random.bits()), PUBLISHED);
    }

    #[test]
    fn integers_and_fractions_come_from_the_published_bits() {
        let mut random = SplitMix64::new(1_234_567);
        assert_eq!(random.below(1_000), PUBLISHED[0] % 1_000);
        let unit = f64::from(random.unit());
        let exact = PUBLISHED[1] as f64 / 2f64.powi(64);
        assert!(unit <= exact && exact < unit + 2f64.powi(-24), "{unit}, expected {exact}");
    }
}
