//! Arithmetic of the reference model at the gate level, for words of any number of bits.

/// Truncates a number to a signed word of `bits` bits. Higher bits are lost.
pub(super) const fn signed(value: i64, bits: u64) -> i64 {
    value << (64 - bits) >> (64 - bits)
}

/// Truncates a number to an unsigned word of `bits` bits.
pub(super) const fn unsigned(value: u64, bits: u64) -> u64 {
    value & (u64::MAX >> (64 - bits))
}

/// Multiplies two signed words by adding partial products. The product has as many bits as both words together.
///
/// Each bit of the second word adds a partial product. The sign bit subtracts a partial product.
pub(super) fn multiply(first: i64, second: i64, bits: [u64; 2]) -> i64 {
    let width = bits[0] + bits[1];
    let sign = bits[1] - 1;
    let partial = |bit: u64| if second >> bit & 1 == 1 { first << bit } else { 0 };
    let sum = (0..sign).fold(0, |sum, bit| signed(sum + partial(bit), width));
    signed(sum - partial(sign), width)
}

/// Multiplies two unsigned words by adding a partial product for each bit of the second word.
pub(super) fn multiply_unsigned(first: u64, second: u64) -> u64 {
    (0..64 - second.leading_zeros()).filter(|bit| second >> bit & 1 == 1).map(|bit| first << bit).sum()
}

/// A restoring divider that computes one bit of the quotient per step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Divider {
    divisor: u64,
    remainder: u64,
    pub(super) quotient: u64,
}

impl Divider {
    /// Starts a division. `divisor` must be at least `dividend`. Equal operands give a quotient of all ones.
    pub(super) const fn new(dividend: u64, divisor: u64) -> Self {
        Self { divisor, remainder: dividend, quotient: 0 }
    }

    /// Computes the next bit of the quotient, with a remainder of `bits` bits.
    pub(super) const fn step(&mut self, bits: u64) {
        let doubled = unsigned(self.remainder << 1, bits);
        let fits = doubled >= self.divisor;
        self.remainder = if fits { doubled - self.divisor } else { doubled };
        self.quotient = self.quotient << 1 | fits as u64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn partial_products_add_up_to_the_product(a in -32_767_i64..=32_767, b in -32_767_i64..=32_767, c in 0_u64..1 << 30) {
            prop_assert_eq!(multiply(a, b, [16, 16]), a * b);
            prop_assert_eq!(multiply_unsigned(c, b.unsigned_abs()), c * b.unsigned_abs());
        }

        #[test]
        fn a_divider_gives_the_bits_of_the_quotient(divisor in 1_u64..1 << 33, part in 0.0..1.0_f64) {
            let dividend = (divisor as f64 * part) as u64;
            let mut divider = Divider::new(dividend, divisor);
            (0..16).for_each(|_| divider.step(35));
            prop_assert_eq!(divider.quotient, ((dividend << 16) / divisor).min(0xFFFF));
        }
    }
}
