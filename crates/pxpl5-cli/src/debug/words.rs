//! Parsers of times, addresses and numbers in debugger commands. An error message states the expected form and the text
//! found.

use pxpl5::{Board, Span, Time};

/// Parses a time such as `12.5ms`, `300us`, `40ns` or `7ps`. A time with a leading `+` is counted from `now`.
pub(super) fn time(text: &str, now: Time) -> Result<Time, String> {
    let refused = || format!("expected a time such as 12.5ms, 300us, 40ns or +1ms, found `{text}`");
    let (begin, length) = text.strip_prefix('+').map_or((Time::ZERO, text), |length| (now, length));
    span(length).map(|span| begin + span).ok_or_else(refused)
}

/// Parses a duration. A text with digits below one picosecond is an error, because the result is exact.
fn span(text: &str) -> Option<Span> {
    // Split the number from its unit.
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let (unit, places): (u64, usize) = match &text[digits.len()..] {
        "s" => (1_000_000_000_000, 12),
        "ms" => (1_000_000_000, 9),
        "us" => (1_000_000, 6),
        "ns" => (1_000, 3),
        "ps" => (1, 0),
        _ => return None,
    };
    let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
    // Digits below one picosecond cannot be represented.
    if !part.bytes().all(|byte| byte.is_ascii_digit()) || part.len() > places {
        return None;
    }
    let whole: u64 = whole.parse().ok()?;
    let part: u64 = if places == 0 { 0 } else { format!("{part:0<places$}").parse().ok()? };
    whole.checked_mul(unit)?.checked_add(part).filter(|ps| *ps < u64::MAX / 4).map(Span)
}

/// Parses a whole number, decimal or hexadecimal with `0x`.
pub(super) fn number(what: &str, text: &str) -> Result<u64, String> {
    let parsed = match text.strip_prefix("0x") {
        Some(digits) => u64::from_str_radix(digits, 16),
        None => text.parse(),
    };
    parsed.map_err(|_| format!("{what}: expected a whole number, found `{text}`"))
}

pub(super) fn below(what: &str, text: &str, bound: u64) -> Result<u64, String> {
    let found = number(what, text)?;
    if found < bound {
        return Ok(found);
    }
    Err(format!("{what}: expected 0 to {}, found {found}", bound.saturating_sub(1)))
}

/// Parses the board's name at the beginning of `words`, and returns the board and the remaining words. `gp 3` and
/// `gp3` name the same board.
pub(super) fn board<'a>(words: &'a [&'a str]) -> Result<(Board, &'a [&'a str]), String> {
    // Try two words such as `gp 3` first, then one word such as `gp3`.
    let two = words.get(..2).map(|two| two.concat()).and_then(|name| name.parse().ok());
    if let Some(board) = two.filter(|_| words[0].chars().all(|c| c.is_ascii_alphabetic())) {
        return Ok((board, &words[2..]));
    }
    let [first, rest @ ..] = words else {
        return Err("expected a board: host, ring, gp N, renderer N or display N, found nothing".to_owned());
    };
    Ok((first.parse::<Board>().map_err(|error| error.to_string())?, rest))
}

/// Parses an address written as `0x` and hexadecimal digits.
pub(super) fn address(text: &str) -> Option<u32> {
    u32::from_str_radix(text.strip_prefix("0x")?, 16).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_to_the_picosecond() {
        let now = Time(5);
        for (text, ps) in [
            ("12.5ms", 12_500_000_000),
            ("300us", 300_000_000),
            ("0.001ns", 1),
            ("7ps", 7),
            ("1s", 1_000_000_000_000),
            ("+1ns", 1_005),
        ] {
            assert_eq!(time(text, now), Ok(Time(ps)), "{text}");
        }
    }

    #[test]
    fn an_invalid_time_is_refused() {
        for wrong in ["", "5", "ms", "-1ms", "1.5ps", "1e3us", "1.2.3ms", "99999999999999999999s", "5 ms", "0.0001ns"] {
            assert!(time(wrong, Time::ZERO).is_err(), "{wrong}");
        }
    }

    #[test]
    fn the_name_of_a_board_may_be_one_word_or_two_words() {
        assert_eq!(board(&["gp", "3", "0x10"]), Ok((Board::Gp(3), &["0x10"][..])));
        assert_eq!(board(&["gp3", "0x10"]), Ok((Board::Gp(3), &["0x10"][..])));
        assert_eq!(board(&["ring"]), Ok((Board::Ring, &[][..])));
        assert_eq!(board(&["host", "7"]), Ok((Board::Host, &["7"][..])));
        assert!(board(&["gpu", "1"]).is_err() && board(&[]).is_err());
    }
}
