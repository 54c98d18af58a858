//! A hash of all events of a simulation. The order of events within an instant does not change the hash.

use crate::Time;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::num::ParseIntError;
use std::str::FromStr;

/// The constant that the generator SplitMix64 adds in each step: the odd number nearest to 2^64 divided by the golden
/// ratio.
pub(crate) const INCREMENT: u64 = 0x9E37_79B9_7F4A_7C15;

/// Mixes 64 bits: each input bit affects about half of the output bits. The function is the last step of the generator
/// SplitMix64. Different inputs give different outputs.
#[inline]
pub const fn mix(value: u64) -> u64 {
    let a = value.wrapping_add(INCREMENT);
    let b = (a ^ (a >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let c = (b ^ (b >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    c ^ (c >> 31)
}

/// The hash of a run: the sum of the hashes of all its records.
///
/// A record has the time of an event and numbers that describe it. The sum depends on all of them, but not on the order
/// of simultaneous events, because this order has no meaning.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct TraceHash(pub u64);

impl TraceHash {
    /// Adds one record: the time of an event, and the numbers that describe the event.
    #[inline]
    pub fn record(&mut self, time: Time, facts: &[u64]) {
        let hash = facts.iter().fold(mix(time.0), |hash, fact| mix(hash ^ mix(*fact)));
        self.0 = self.0.wrapping_add(hash);
    }
}

impl FromStr for TraceHash {
    type Err = ParseIntError;

    fn from_str(text: &str) -> Result<Self, ParseIntError> {
        u64::from_str_radix(text, 16).map(Self)
    }
}

impl fmt::Display for TraceHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hash(records: &[(u64, &[u64])]) -> TraceHash {
        let mut hash = TraceHash::default();
        records.iter().for_each(|(time, facts)| hash.record(Time(*time), facts));
        hash
    }

    #[test]
    fn the_hash_depends_on_time_fact_and_number_but_not_on_order() {
        let base = hash(&[(1, &[2, 3]), (1, &[4])]);
        assert_eq!(base, hash(&[(1, &[4]), (1, &[2, 3])]));
        assert_ne!(base, hash(&[(1, &[3, 2]), (1, &[4])]));
        assert_ne!(base, hash(&[(2, &[2, 3]), (1, &[4])]));
        assert_ne!(base, hash(&[(1, &[2, 3]), (1, &[4]), (1, &[4])]));
    }

    /// Tests a record whose only number equals its time. The hash mixes both, and their exclusive or is 0. The result
    /// is the first output of SplitMix64 for the seed 0 (Vigna's reference program).
    #[test]
    fn a_record_whose_number_equals_its_time_has_the_published_hash_of_zero() {
        for both in [0, 1, 1_234_567, u64::MAX] {
            assert_eq!(hash(&[(both, &[both])]), TraceHash(0xE220_A839_7B1D_CDAF));
        }
    }

    #[test]
    fn a_hash_prints_as_sixteen_digits() {
        assert_eq!(TraceHash(0xAB0).to_string(), "0000000000000ab0");
    }

    #[test]
    fn mix_agrees_with_the_published_splitmix64_sequence() {
        // First outputs of SplitMix64 seeded with 1234567 (Vigna's reference program).
        let seed = 1_234_567u64;
        let second = seed.wrapping_add(0x9E37_79B9_7F4A_7C15);
        assert_eq!([mix(seed), mix(second)], [6_457_827_717_110_365_317, 3_203_168_211_198_807_973]);
    }
}
