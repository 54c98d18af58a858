//! Values with units in settings: `20us`, `16.7ms`, `60deg`, `640px`.
//!
//! A plain number has the unit that the documentation of the key states. A number with a unit is converted to the unit
//! of the key.

use super::tracking_numbers::tracking_parameters;
use super::{display, keys};
use pxpl5_run::Registry;
use pxpl5_sim::parameters::Parameter;
use toml::Value;

type Kind = &'static [(&'static str, f64)];

const TIMES: Kind = &[("ps", 1.0), ("ns", 1e3), ("us", 1e6), ("ms", 1e9), ("s", 1e12)];
const LENGTHS: Kind = &[("um", 1.0), ("mm", 1e3), ("cm", 1e4), ("m", 1e6), ("km", 1e9)];
const ANGLES: Kind = &[("deg", 1.0), ("rad", 180.0 / std::f64::consts::PI), ("arcmin", 1.0 / 60.0)];
const RATES: Kind = &[("Hz", 1.0), ("kHz", 1e3), ("MHz", 1e6), ("GHz", 1e9)];
const TURNS: Kind = &[("deg/s", 1.0), ("rad/s", 180.0 / std::f64::consts::PI)];
const SPEEDS: Kind = &[("mm/s", 1.0), ("cm/s", 10.0), ("m/s", 1e3)];
const SIZES: Kind = &[("bytes", 1.0), ("B", 1.0), ("kB", 1e3), ("KiB", 1024.0), ("MB", 1e6), ("MiB", 1_048_576.0)];
const PIXELS: Kind = &[("px", 1.0), ("pixels", 1.0)];

const KINDS: [Kind; 8] = [TIMES, LENGTHS, ANGLES, RATES, TURNS, SPEEDS, SIZES, PIXELS];

/// Converts a text such as `20us` to a number in the unit of a key.
///
/// Returns `Ok(None)` if the text is not a number with a unit, or if the key has no unit. In these cases, the text is
/// used unchanged. The error for a wrong unit lists the units that the key accepts.
pub(super) fn converted(registry: &Registry, key: &str, text: &str) -> Result<Option<Value>, String> {
    let Some((number, unit)) = split(text) else { return Ok(None) };
    let Some(wanted) = unit_of(registry, key) else { return Ok(None) };
    let size = |kind: Kind, unit: &str| kind.iter().find(|(name, _)| *name == unit).map(|(_, size)| *size);
    // A unit without conversions, such as clocks, is accepted only as it is written.
    if unit == wanted {
        return Ok(Some(value(number)));
    }
    let kind = KINDS.into_iter().find_map(|kind| Some((kind, size(kind, &wanted)?)));
    let Some((kind, to)) = kind else { return Err(format!("a number in {wanted}")) };
    let Some(from) = size(kind, unit) else {
        let names: Vec<&str> = kind.iter().map(|(name, _)| *name).collect();
        return Err(format!("a number in {wanted}, or one with a unit: {}", names.join(", ")));
    };
    Ok(Some(value(number * from / to)))
}

/// Splits a text into a number and a unit. Returns `None` if either is missing.
fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    // An exponent belongs to the number; no unit begins with e.
    let is_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+' | '_');
    let end = text.find(|c: char| !is_number(c))?;
    let (number, unit) = text.split_at(end);
    let number: f64 = number.replace('_', "").parse().ok()?;
    let unit = unit.trim();
    (!unit.is_empty() && number.is_finite()).then_some((number, unit))
}

/// Converts a number to TOML. A number that is whole except for rounding errors becomes a whole number: 16.7 ms are
/// 16,700,000 ns.
fn value(number: f64) -> Value {
    let whole = number.round();
    if (number - whole).abs() <= 1e-9 * number.abs().max(1.0) && whole.abs() < 9e15 {
        return Value::Integer(whole as i64);
    }
    Value::Float(number)
}

fn unit_of(registry: &Registry, key: &str) -> Option<String> {
    let own = keys::common(key).map(|key| key.unit).or_else(|| display::unit_of(key));
    if let Some(unit) = own {
        return Some(unit.to_owned()).filter(|unit| !unit.is_empty());
    }
    let unit = |parameters: Vec<Parameter>, path: &str| {
        parameters.into_iter().find(|parameter| parameter.path == path).map(|parameter| parameter.info.unit.to_owned())
    };
    match key.strip_prefix("machine.") {
        Some(path) => unit(keys::machine(registry).parameters(), path),
        None => unit(tracking_parameters(), key),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(key: &str, text: &str) -> Result<Option<Value>, String> {
        converted(&crate::registry(), key, text)
    }

    #[test]
    fn numbers_with_units_are_converted_to_the_unit_of_the_key() {
        for (key, text, expected) in [
            ("machine.gp.triangle_ns", "20us", Value::Integer(20_000)),
            ("machine.gp.triangle_ns", "16.7ms", Value::Integer(16_700_000)),
            ("machine.ring.word_ns", "50 ns", Value::Integer(50)),
            ("machine.renderer.clock_hz", "40MHz", Value::Integer(40_000_000)),
            ("hmd.field_of_view", "60deg", Value::Integer(60)),
            ("hmd.eye_distance", "6.4cm", Value::Integer(64)),
            ("head.distance", "250mm", Value::Float(0.25)),
            ("tracking.optical.latency", "0.02s", Value::Integer(20)),
        ] {
            assert_eq!(read(key, text), Ok(Some(expected)), "{key} = {text}");
        }
    }

    #[test]
    fn a_unit_of_another_quantity_is_refused_with_the_possible_units() {
        let error = read("machine.gp.triangle_ns", "20mm").expect_err("a length is no time");
        assert_eq!(error, "a number in ns, or one with a unit: ps, ns, us, ms, s");
    }

    #[test]
    fn texts_and_keys_without_a_unit_are_unchanged() {
        for (key, text) in
            [("scene", "3cubes.ply"), ("head.motion", "pan:200"), ("title", "20us"), ("machine.gp.triangle_ns", "fast")]
        {
            assert_eq!(read(key, text), Ok(None), "{key} = {text}");
        }
    }
}
