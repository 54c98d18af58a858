use crate::error::check;
use crate::random::{bits, stream};
use pxpl5_sim::parameters::SettingError;

/// Number of rounds of the Feistel network. Four rounds with a good mixing function give a good permutation (Luby and
/// Rackoff 1988).
const ROUNDS: u64 = 4;

/// The pixel order of frameless rendering (Bishop et al. 1994). Each pass updates every pixel once, in a random order.
///
/// The order is a permutation of 0..n from a seed. Computing any element takes constant memory. A Feistel network
/// permutes the numbers up to the next power of two. The network is applied repeatedly until the result is below n, on
/// average at most twice. Every pass uses the same order. The age of a pixel therefore never exceeds one pass, and its
/// mean is half a pass. A new order for each pass would raise the mean age to 7/12 of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RandomOrder {
    n_pixels: u32,
    half_bits: u32,
    odd_bit: u32,
    seed: u64,
}

impl RandomOrder {
    /// Creates an order of `n_pixels`, at least 1 and at most 2^31.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] if `n_pixels` is out of range.
    pub fn new(n_pixels: u32, seed: u64) -> Result<Self, SettingError> {
        check("pixels of a frameless order", f64::from(n_pixels), 1.0, f64::from(1u32 << 31))?;
        let width = n_pixels.next_power_of_two().trailing_zeros().max(2);
        Ok(Self { n_pixels, half_bits: width / 2, odd_bit: width % 2, seed: stream(seed, 5) })
    }

    /// Returns the number of pixels in a pass.
    pub fn n_pixels(&self) -> u32 {
        self.n_pixels
    }

    /// Returns the index of the pixel, 0..n, that is updated at step `step`. A new pass begins at steps n, 2n, ...
    pub fn pixel(&self, step: u64) -> u32 {
        let mut place = (step % u64::from(self.n_pixels)) as u32;
        loop {
            place = self.permuted(place);
            if place < self.n_pixels {
                return place;
            }
        }
    }

    /// Permutes the numbers 0..2^width by a Feistel network. The upper and the lower bits of `place` exchange their
    /// roles in each round, so that `width` can be odd.
    fn permuted(&self, place: u32) -> u32 {
        let mut low_bits = self.half_bits;
        let mut high_bits = self.half_bits + self.odd_bit;
        let mut word = place;
        for round in 0..ROUNDS {
            // A Feistel round: the low part passes through, and its hash changes the high part.
            let low = word & mask(low_bits);
            let high = word >> low_bits;
            let noise = bits(stream(self.seed, round), u64::from(low)) as u32;
            word = (low << high_bits) | ((high ^ noise) & mask(high_bits));
            std::mem::swap(&mut low_bits, &mut high_bits);
        }
        word
    }
}

fn mask(bits: u32) -> u32 {
    (1 << bits) - 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_pixel_is_drawn_once_in_a_pass(n in 1u32..5000, seed in any::<u64>()) {
            let order = RandomOrder::new(n, seed).unwrap();
            let mut seen = vec![false; n as usize];
            for step in 0..u64::from(n) {
                prop_assert!(!std::mem::replace(&mut seen[order.pixel(step) as usize], true));
            }
        }
    }

    #[test]
    fn an_ntsc_frame_is_covered_in_one_pass() {
        let order = RandomOrder::new(640 * 480, 1).unwrap();
        let mut seen = vec![false; 640 * 480];
        (0..640 * 480).for_each(|step| seen[order.pixel(step) as usize] = true);
        assert!(seen.iter().all(|&s| s));
    }

    #[test]
    fn in_the_long_run_the_mean_age_of_a_pixel_is_half_a_pass() {
        // After each update of the third pass, the ages of the pixels are 0 to n - 1 steps. Their mean is (n - 1) / 2.
        let n = 1000u64;
        let order = RandomOrder::new(n as u32, 3).unwrap();
        let mut updated = vec![0; n as usize];
        let mut mean_age = 0.0;
        for step in 0..3 * n {
            updated[order.pixel(step) as usize] = step;
            if step >= 2 * n {
                mean_age += updated.iter().map(|u| (step - u) as f64).sum::<f64>() / (n * n) as f64;
            }
        }
        assert!((mean_age - (n - 1) as f64 / 2.0).abs() < 1e-6, "{mean_age}");
    }

    #[test]
    fn the_first_pixels_of_a_pass_are_spread_over_the_whole_picture() {
        // Each tenth of the picture contains 300 +- 17 of the first 3,000 of 300,000 pixels.
        let order = RandomOrder::new(300_000, 9).unwrap();
        let mut tenths = [0; 10];
        (0..3000).for_each(|step| tenths[(order.pixel(step) / 30_000) as usize] += 1);
        assert!(tenths.iter().all(|n| (230..370).contains(n)), "{tenths:?}");
    }

    #[test]
    fn blocks_drawn_in_succession_are_not_adjacent() {
        let order = RandomOrder::new(300_000, 9).unwrap();
        let near = (0..3000u64).filter(|&s| order.pixel(s).abs_diff(order.pixel(s + 1)) < 3000).count();
        // A random order gives 2 x 3,000 / 300,000 = 2 % of 3,000 pairs: 60, with a standard deviation of 8.
        assert!((25..95).contains(&near), "{near}");
    }

    fn first_pixels(seed: u64) -> Vec<u32> {
        let order = RandomOrder::new(5000, seed).unwrap();
        (0..50).map(|step| order.pixel(step)).collect()
    }

    #[test]
    fn different_seeds_give_different_pixel_orders_and_a_repeated_seed_gives_the_same_order() {
        assert_eq!(first_pixels(1), first_pixels(1));
        assert_ne!(first_pixels(1), first_pixels(2));
    }

    #[test]
    fn a_picture_without_pixels_is_an_error() {
        assert!(RandomOrder::new(0, 1).is_err());
        assert!(RandomOrder::new(1, 1).is_ok_and(|order| order.pixel(7) == 0));
    }
}
