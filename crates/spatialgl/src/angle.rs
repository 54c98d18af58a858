//! Sine and cosine of fractions of a turn, with symmetries that are exact to the last bit.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4};

/// Returns sine and cosine of `numerator / denominator` of a turn.
///
/// The angle is reduced to the first eighth of a turn with integers. Adding half a turn therefore negates sine and
/// cosine exactly, and adding a quarter turn exchanges them, except for a sign. At 45 degrees, they are equal.
///
/// # Panics
/// Panics if the denominator is zero.
pub fn sin_cos_of_turn(numerator: i64, denominator: u32) -> (f64, f64) {
    // Split the angle into an octant and a rest. Odd octants run backwards.
    let whole = i64::from(denominator);
    let eighths = 8 * numerator.rem_euclid(whole);
    let octant = eighths / whole;
    let remainder = eighths % whole;
    let is_odd = octant % 2 == 1;
    let within = if is_odd { whole - remainder } else { remainder };
    let (s, c) = first_eighth(within, whole);
    match octant {
        0 => (s, c),
        1 => (c, s),
        2 => (c, -s),
        3 => (s, -c),
        4 => (-s, -c),
        5 => (-c, -s),
        6 => (-c, s),
        _ => (-s, c),
    }
}

/// Returns sine and cosine of the angle `part / whole` times 45 degrees.
fn first_eighth(part: i64, whole: i64) -> (f64, f64) {
    if part == whole {
        return (FRAC_1_SQRT_2, FRAC_1_SQRT_2);
    }
    libm::sincos(FRAC_PI_4 * (part as f64 / whole as f64))
}
