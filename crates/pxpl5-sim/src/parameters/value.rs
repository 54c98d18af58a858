use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::fmt;
use std::hash::{Hash, Hasher};

/// The value of a parameter, either a whole or a real number.
///
/// Files and reports contain only the number, without the name of the variant.
///
/// A whole value never equals a real one, and neither is greater. Two real values are compared in IEEE's total order,
/// so NaN lies outside every range, and tables can be compared for equality.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// An exact whole number, such as a count of bytes or a time in whole nanoseconds.
    Whole(u64),
    /// A measured real number, such as an rms error.
    Real(f64),
}

impl Value {
    /// Returns the value as a whole number. Returns `None` if the value has a fraction, is negative or needs more than
    /// 64 bits.
    pub fn whole(self) -> Option<u64> {
        match self {
            Self::Whole(n) => Some(n),
            Self::Real(x) => exactly(x),
        }
    }

    /// Returns the value as a real number. Whole numbers above 2^53 are rounded to the nearest real number.
    pub fn real(self) -> f64 {
        match self {
            Self::Whole(n) => n as f64,
            Self::Real(x) => x,
        }
    }
}

fn exactly(x: f64) -> Option<u64> {
    let is_whole = x.fract() == 0.0 && (0.0..2f64.powi(64)).contains(&x);
    is_whole.then_some(x as u64)
}

impl PartialEq for Value {
    fn eq(&self, other: &Self) -> bool {
        self.partial_cmp(other) == Some(Ordering::Equal)
    }
}

impl Eq for Value {}

impl PartialOrd for Value {
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match (self, other) {
            (Self::Whole(own), Self::Whole(other)) => Some(own.cmp(other)),
            (Self::Real(own), Self::Real(other)) => Some(own.total_cmp(other)),
            _ => None,
        }
    }
}

impl Hash for Value {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match self {
            Self::Whole(n) => n.hash(state),
            Self::Real(x) => x.to_bits().hash(state),
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole(n) => n.fmt(f),
            Self::Real(x) => x.fmt(f),
        }
    }
}

impl From<u64> for Value {
    #[inline]
    fn from(n: u64) -> Self {
        Self::Whole(n)
    }
}

impl From<f64> for Value {
    #[inline]
    fn from(x: f64) -> Self {
        Self::Real(x)
    }
}

/// The greatest whole number that a limit of a parameter can be: 10^12. With this limit, sums and small multiples of
/// nanoseconds or clocks fit in 64 bits.
pub const MAX: u64 = 1_000_000_000_000;

#[cfg(test)]
mod tests {
    use super::Value;

    #[test]
    fn only_a_real_number_without_fraction_or_sign_is_whole() {
        assert_eq!(Value::Real(115_200.0).whole(), Some(115_200));
        for x in [0.5, -1.0, f64::NAN, f64::INFINITY, 2f64.powi(64)] {
            assert_eq!(Value::Real(x).whole(), None, "{x}");
        }
    }

    #[test]
    fn a_whole_number_keeps_all_its_64_bits() {
        assert_eq!(Value::Whole(u64::MAX).whole(), Some(u64::MAX));
    }

    #[test]
    fn values_of_different_kinds_have_no_order() {
        assert_eq!(Value::Whole(1).partial_cmp(&Value::Real(1.0)), None);
    }

    #[test]
    fn nan_lies_outside_every_range() {
        let all = Value::Real(f64::NEG_INFINITY)..=Value::Real(f64::INFINITY);
        assert!(!all.contains(&Value::Real(f64::NAN)));
        assert!(!all.contains(&Value::Real(-f64::NAN)));
    }
}
