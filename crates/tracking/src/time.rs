//! Conversions between picoseconds and seconds. Instants stay integers, and only their differences become floating
//! point.

/// Picoseconds in a second.
pub const PS_PER_S: u64 = 1_000_000_000_000;

/// Picoseconds in a millisecond.
pub const PS_PER_MS: u64 = 1_000_000_000;

/// Converts an instant to seconds. Whole seconds are converted separately, so a late instant (beyond 2^53 ps) keeps its
/// fraction.
pub fn seconds(t_ps: u64) -> f64 {
    (t_ps / PS_PER_S) as f64 + (t_ps % PS_PER_S) as f64 / PS_PER_S as f64
}

/// Returns the seconds from `from_ps` to `to_ps`, negative if `to_ps` is earlier.
pub fn span_s(from_ps: u64, to_ps: u64) -> f64 {
    if to_ps >= from_ps { seconds(to_ps - from_ps) } else { -seconds(from_ps - to_ps) }
}

/// Returns the start of period `n` of a clock with `rate` periods in `seconds` s: floor(n x seconds / rate), without
/// drift. Returns `None` beyond the end of simulated time (2^64 ps, 213 days).
pub(crate) fn tick_ps(n: u64, seconds: u32, rate: u32) -> Option<u64> {
    let ps = u128::from(n) * u128::from(PS_PER_S) * u128::from(seconds) / u128::from(rate);
    u64::try_from(ps).ok()
}

/// Duration of an NTSC field, floor(1001 / 60000 s).
pub const NTSC_FIELD_PS: u64 = 1_001 * PS_PER_S / 60_000;

/// Returns the time from visible line 0 of an NTSC field to visible line `n` of the same field, ps: floor(n x 4004/63
/// us).
pub fn ntsc_lines_ps(n: u32) -> u64 {
    u64::from(n) * 4_004_000_000 / 63
}

/// Converts seconds to the nearest picosecond. Negative spans and NaN give 0. Spans of 2^64 ps or more give `u64::MAX`.
pub fn nearest_ps(seconds: f64) -> u64 {
    let whole = libm::floor(seconds);
    let rest_ps = libm::round((seconds - whole) * PS_PER_S as f64) as u64;
    (whole as u64).saturating_mul(PS_PER_S).saturating_add(rest_ps)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_takes_262_and_a_half_lines() {
        assert_eq!(NTSC_FIELD_PS, 16_683_333_333);
        assert_eq!(ntsc_lines_ps(525) / 2, NTSC_FIELD_PS);
    }

    #[test]
    fn a_tick_beyond_the_end_of_time_is_none() {
        assert_eq!(tick_ps(u64::MAX, 1, 1), None);
    }

    #[test]
    fn a_time_of_a_hundred_days_keeps_its_picoseconds() {
        let day_100 = 8_640_000 * PS_PER_S;
        assert_eq!(span_s(day_100 + 7, day_100), -7e-12);
        assert_eq!(nearest_ps(0.008_333_333_333), 8_333_333_333);
    }
}
