//! Compact storage of a list of instants, such as one instant for each view. Each entry takes two or three bytes, so
//! the instants of 10^7 views take 30 MB instead of 300 MB.

use pxpl5_sim::Time;

/// Number of entries from one `Begin` to the next. A lookup decodes at most this number of entries.
const BLOCK: u64 = 256;

/// A compressed list of instants. Each instant has a number, such as the number of its view, and the numbers ascend.
///
/// A *step* is the time between two successive instants. Two lengths of steps often alternate, for example two and
/// three periods. The next step is therefore expected to be as long as the step before the last step.
///
/// An entry stores how many numbers were skipped before the entry. It also stores the difference between its instant
/// and the instant after the expected step. If the steps alternate exactly, the difference is 0 and takes one byte.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Instants {
    written: Vec<u8>,
    begins: Vec<Begin>,
    last: Option<At>,
    count: u64,
}

/// An entry at which decoding can begin, with the position of the next entry in the bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Begin {
    at: At,
    next: usize,
}

/// A decoded entry: number, instant in picoseconds, and the last two differences of successive instants, the difference
/// of the earlier instants first.
#[derive(Clone, Copy, Debug, PartialEq)]
struct At {
    number: u64,
    instant: u64,
    steps: [u64; 2],
}

impl At {
    /// Returns the expected next instant. The addition wraps, because an instant may lie before its predecessor.
    const fn expected(&self) -> u64 {
        self.instant.wrapping_add(self.steps[0])
    }

    const fn followed_by(&self, number: u64, instant: u64) -> Self {
        Self { number, instant, steps: [self.steps[1], instant.wrapping_sub(self.instant)] }
    }
}

impl Instants {
    /// Adds an instant. `number` must be greater than the numbers of all earlier instants.
    pub(crate) fn push(&mut self, number: u64, instant: Time) {
        let at = match self.last {
            None => At { number, instant: instant.0, steps: [0; 2] },
            Some(last) => {
                assert!(number > last.number, "{number} after {}", last.number);
                // Store only the differences from the expected entry, which are small.
                write(&mut self.written, number - last.number - 1);
                write(&mut self.written, folded(instant.0.wrapping_sub(last.expected())));
                last.followed_by(number, instant.0)
            }
        };
        // Decoding can begin at every block.
        if self.count.is_multiple_of(BLOCK) {
            self.begins.push(Begin { at, next: self.written.len() });
        }
        self.last = Some(at);
        self.count += 1;
    }

    pub(crate) fn of(&self, number: u64) -> Option<Time> {
        let block = self.begins.partition_point(|begin| begin.at.number <= number);
        let Begin { mut at, mut next } = *self.begins.get(block.checked_sub(1)?)?;
        while at.number < number && next < self.written.len() {
            let left_out = read(&self.written, &mut next);
            let from_expected = unfolded(read(&self.written, &mut next));
            at = at.followed_by(at.number + 1 + left_out, at.expected().wrapping_add(from_expected));
        }
        (at.number == number).then_some(Time(at.instant))
    }
}

/// Maps 0, -1, 1, -2, 2 ... to 0, 1, 2, 3, 4 ... (zigzag code), so that small differences take few bytes.
const fn folded(difference: u64) -> u64 {
    let signed = difference.cast_signed();
    (signed << 1 ^ signed >> 63).cast_unsigned()
}

const fn unfolded(folded: u64) -> u64 {
    folded >> 1 ^ (folded & 1).wrapping_neg()
}

/// Writes a number with seven bits per byte, the lowest bits first. The eighth bit is set if more bytes follow.
fn write(bytes: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
}

fn read(bytes: &[u8], next: &mut usize) -> u64 {
    let mut value = 0;
    for shift in (0..).step_by(7) {
        let byte = bytes[*next];
        *next += 1;
        value |= u64::from(byte & 0x7F) << shift;
        if byte < 0x80 {
            break;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    proptest! {
        #[test]
        fn every_stored_number_has_its_instant(
            steps in proptest::collection::vec((1u64..5, any::<u64>(), 0u32..64), 0..900),
        ) {
            let mut instants = Instants::default();
            let mut model = BTreeMap::new();
            let mut number = 0;
            for (step, bits, shift) in steps {
                number += step;
                model.insert(number, bits >> shift);
                instants.push(number, Time(bits >> shift));
            }
            for asked in 0..number + 3 {
                prop_assert_eq!(instants.of(asked), model.get(&asked).copied().map(Time));
            }
        }
    }

    /// Tests the memory for instants that are two or three fields apart, in turn: at most three bytes for each instant.
    #[test]
    fn instants_with_nearly_equal_steps_take_at_most_three_bytes_each() {
        let field_ps = |n: u64| n * 1_001_000_000_000 / 60;
        let mut instants = Instants::default();
        (0..10_000).for_each(|n| instants.push(n, Time(field_ps(2 * n + n / 2))));
        assert!(instants.written.len() <= 30_000, "{}", instants.written.len());
        assert_eq!(instants.of(9_999), Some(Time(field_ps(2 * 9_999 + 4_999))));
    }
}
