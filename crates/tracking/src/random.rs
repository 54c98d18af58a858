//! Random numbers as pure functions of (seed, index). The numbers can be computed in any order and are the same on
//! every computer.
//!
//! The generator is SplitMix64 (Steele, Lea and Flood 2014). The function [`pxpl5_sim::mix`] of the simulation kernel
//! computes one step of the generator.

use pxpl5_sim::mix;

/// Increment of SplitMix64 between the states of neighbouring elements: 2^64 / golden ratio, made odd.
const INCREMENT: u64 = 0x9E37_79B9_7F4A_7C15;

/// Returns 64 random bits for (seed, index): element `index`, from 0, of the SplitMix64 sequence that starts at `seed`.
pub fn bits(seed: u64, index: u64) -> u64 {
    mix(seed.wrapping_add(index.wrapping_mul(INCREMENT)))
}

/// Returns the seed of stream number `name` of random numbers. Streams with different numbers or seeds are independent.
/// Two rounds of mixing prevent streams of neighbouring seeds from overlapping.
pub(crate) fn stream(seed: u64, name: u64) -> u64 {
    bits(bits(seed, name), seed)
}

/// Converts random bits to a number uniform in [0, 1), using the upper 53 bits.
pub fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1u64 << 53) as f64
}

/// Converts random bits to an integer uniform in [0, bound). The probabilities differ by less than bound / 2^64.
pub(crate) fn below(bits: u64, bound: u64) -> u64 {
    ((u128::from(bits) * u128::from(bound)) >> 64) as u64
}

/// Returns two independent standard normal deviates (Box and Muller 1958).
pub(crate) fn normal_pair(seed: u64, index: u64) -> (f64, f64) {
    let open = 1.0 - unit(bits(seed, 2 * index));
    let turn = unit(bits(seed, 2 * index + 1));
    let (sin, cos) = libm::sincos(core::f64::consts::TAU * turn);
    let radius = (-2.0 * libm::log(open)).sqrt();
    (radius * cos, radius * sin)
}

/// Converts random bits to a bell-shaped deviate of mean 0 and variance 1, within [-2 sqrt 3, 2 sqrt 3]. The deviate is
/// computed from the sum of four 16-bit uniform numbers (Irwin-Hall). The function is much cheaper than
/// [`normal_pair`], because it uses no transcendental functions.
pub(crate) fn bell(bits: u64) -> f64 {
    let sum = (bits & 0xFFFF) + ((bits >> 16) & 0xFFFF) + ((bits >> 32) & 0xFFFF) + (bits >> 48);
    (sum as f64 / 65_535.0 - 2.0) * SQRT_3
}

const SQRT_3: f64 = 1.732_050_807_568_877_2;

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(draw: impl Fn(u64) -> f64) -> (f64, f64) {
        let n = 200_000;
        let (sum, squares) = (0..n).map(draw).fold((0.0, 0.0), |(s, q), x| (s + x, q + x * x));
        (sum / n as f64, squares / n as f64)
    }

    // Tolerances are five standard errors of 200,000 draws: 5 / sqrt(n) = 0.011, and sqrt 2 times that for variances.
    #[test]
    fn the_normal_and_bell_distributions_have_mean_0_and_variance_1() {
        for (mean, variance) in
            [moments(|i| normal_pair(7, i).0), moments(|i| normal_pair(7, i).1), moments(|i| bell(bits(7, i)))]
        {
            assert!(mean.abs() < 0.011 && (variance - 1.0).abs() < 0.016, "{mean} {variance}");
        }
    }

    #[test]
    fn the_two_normals_of_a_pair_are_uncorrelated() {
        let (mean, _) = moments(|i| {
            let (a, b) = normal_pair(3, i);
            a * b
        });
        assert!(mean.abs() < 0.011, "{mean}");
    }

    #[test]
    fn streams_of_neighbouring_seeds_are_uncorrelated() {
        let (mean, _) = moments(|i| bell(bits(stream(1, 0), i)) * bell(bits(stream(2, 0), i)));
        assert!(mean.abs() < 0.011, "{mean}");
    }

    #[test]
    fn the_first_value_equals_that_of_splitmix64() {
        // Published test vector of SplitMix64 for seed 1234567.
        assert_eq!(bits(1_234_567, 0), 6_457_827_717_110_365_317);
        assert_eq!(bits(1_234_567, 1), 3_203_168_211_198_807_973);
    }

    #[test]
    fn bounded_numbers_stay_below_their_bound_and_reach_every_value() {
        let mut seen = [false; 7];
        (0..1000).for_each(|i| seen[below(bits(5, i), 7) as usize] = true);
        assert!(seen.iter().all(|&s| s));
    }
}
