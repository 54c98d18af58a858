/// Greatest number of digits in a time stamp. Nanoseconds since 1970 have only 19 digits.
const MAX_DIGITS: usize = 30;

/// Parses a decimal number exactly and rounds it to a multiple of 10^-`places`. For seconds, 12 places give
/// picoseconds. A time stamp with 10 digits before the decimal point keeps all 9 digits after the point, which an `f64`
/// would lose. Returns `None` if the text is not a number.
pub(super) fn scaled(text: &str, places: i32) -> Option<i128> {
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (text, 0),
    };
    let (negative, unsigned) = match mantissa.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, mantissa.strip_prefix('+').unwrap_or(mantissa)),
    };
    let (whole, fraction) = unsigned.split_once('.').unwrap_or((unsigned, ""));
    // Join the digits around the point. The exponent accounts for the digits after the point.
    let digits = format!("{whole}{fraction}");
    let significant = digits.trim_start_matches('0');
    if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) || significant.len() > MAX_DIGITS {
        return None;
    }
    let number: i128 = if significant.is_empty() { 0 } else { significant.parse().ok()? };
    let power = exponent.checked_add(places)?.checked_sub(i32::try_from(fraction.len()).ok()?)?;
    let scaled = if power >= 0 { multiplied(number, power)? } else { divided(number, power.checked_neg()?) };
    Some(if negative { -scaled } else { scaled })
}

fn multiplied(number: i128, power: i32) -> Option<i128> {
    if number == 0 {
        return Some(0);
    }
    number.checked_mul(10i128.checked_pow(power.try_into().ok()?)?)
}

/// Divides by 10^`power` and rounds to the nearest integer. Returns 0 if 10^`power` overflows, because `number` has at
/// most 30 digits.
fn divided(number: i128, power: i32) -> i128 {
    let divisor = u32::try_from(power).ok().and_then(|power| 10i128.checked_pow(power));
    divisor.map_or(0, |divisor| (number + divisor / 2) / divisor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn stamps_since_1970_keep_every_digit() {
        assert_eq!(scaled("1305031098.665912345", 12), Some(1_305_031_098_665_912_345_000));
        assert_eq!(scaled("1403636579763555584", 3), Some(1_403_636_579_763_555_584_000));
        assert_eq!(scaled("1.403636579763555584e18", 3), Some(1_403_636_579_763_555_584_000));
    }

    #[test]
    fn digits_below_a_picosecond_are_rounded() {
        assert_eq!(scaled("0.0000000000005", 12), Some(1));
        assert_eq!(scaled("0.00000000000049", 12), Some(0));
        assert_eq!(scaled("-1.5e-12", 12), Some(-2));
        assert_eq!(scaled("1e-2000000000", 12), Some(0));
    }

    #[test]
    fn text_that_is_not_a_number_is_none() {
        for text in ["", "-", ".", "inf", "NaN", "1.2.3", "0x10", "1e", "1e99", "12a", "1 2"] {
            assert_eq!(scaled(text, 12), None, "{text}");
        }
    }

    proptest! {
        #[test]
        fn decimals_agree_with_floating_point_to_its_precision(x in -1e6..1e6f64) {
            let exact = scaled(&format!("{x:.9}"), 12).unwrap() as f64 * 1e-12;
            prop_assert!((exact - x).abs() <= 1e-9 + x.abs() * 1e-15);
        }
    }
}
