//! The display in an experiment file: a preset by name, and parameters that change the preset.

use super::read::{plain, unknown, wrong};
use super::{ExperimentFile, Setting};
use pxpl5_run::DisplayEntry;
use pxpl5_sim::parameters::{ParameterTable, SettingError, Value as Number};
use pxpl5_wire::display::DisplayConfig;

pub(super) const NUMBERS: &str = "display.";

/// Name of the display that the experiment uses if the file sets display parameters but names no display.
const OWN: &str = "panel";

/// A display parameter in an experiment file. The parameter has one name in the file (`key`) and another name in the
/// display's table of parameters (`parameter`).
struct NumberKey {
    key: &'static str,
    parameter: &'static str,
    per_unit: f64,
    about: &'static str,
    /// Words that the file must use instead of numbers, each with the number that the word stands for. Empty for a
    /// parameter with a number.
    words: &'static [(&'static str, u64)],
}

const fn whole(key: &'static str, about: &'static str) -> NumberKey {
    NumberKey { key, parameter: key, per_unit: 1.0, about, words: &[] }
}

const KEYS: [NumberKey; 12] = [
    whole("width", "visible pixels of a line"),
    whole("height", "visible lines"),
    NumberKey { parameter: "refresh_hz", ..whole("hz", "scans a second") },
    NumberKey {
        words: &[("false", 0), ("true", 1)],
        ..whole("interlace", "true if a scan lights every second line only, else false")
    },
    NumberKey {
        words: &[("rolling", 0), ("global", 1)],
        ..whole("scan", "rolling (pixels light one after the other) or global (all at once)")
    },
    NumberKey {
        words: &[("down", 0), ("up", 1), ("right", 2), ("left", 3)],
        ..whole("direction", "direction of a rolling scan: down, up, right or left")
    },
    NumberKey {
        parameter: "active_permille",
        per_unit: 1e3,
        ..whole("active", "part of the period in which pixels light, 0.001 to 1; a global display lights at its end")
    },
    NumberKey {
        parameter: "persistence_us",
        per_unit: 1e3,
        ..whole("persistence_ms", "time for which a pixel shines in each scan, at most a period")
    },
    NumberKey {
        parameter: "response_us",
        per_unit: 1e3,
        ..whole("response_ms", "time constant of a pixel's brightness")
    },
    whole("ports", "ports of a board on the ring, 1 to 8"),
    whole("word_ns", "time of one word at a port"),
    whole("bits", "bits of a pixel's colour, 3 to 24"),
];

/// Returns the key of every display parameter with its description.
pub(super) fn keys() -> impl Iterator<Item = (String, &'static str)> {
    KEYS.iter().map(|key| (format!("{NUMBERS}{}", key.key), key.about))
}

/// Reads the display of an experiment and its parameters. Returns `None` if the file names no display and sets no
/// display parameter.
pub(super) fn read(file: &ExperimentFile) -> Result<Option<Box<dyn DisplayConfig>>, SettingError> {
    let displays: Vec<(&str, &DisplayEntry)> =
        file.registry().displays().iter().map(|entry| (entry.name, entry)).collect();
    let given: Vec<(&NumberKey, String, &Setting)> = KEYS
        .iter()
        .filter_map(|key| {
            let path = format!("{NUMBERS}{}", key.key);
            let setting = file.get(&path)?;
            Some((key, path, setting))
        })
        .collect();
    let own = displays.iter().find(|(name, _)| *name == OWN && !given.is_empty()).map(|(_, entry)| *entry);
    let Some(entry) = file.choice("display", &displays)?.or(own) else { return Ok(None) };
    let mut config = (entry.config)();
    for (key, path, setting) in &given {
        set(config.as_mut(), key, path, setting)?;
    }
    if let (Err(error), Some(first)) = (config.check(), given.first()) {
        // The message names the number of the table; the place is the place of the key that sets this number.
        let name = error.name.rsplit('.').next().unwrap_or_default();
        let named = given.iter().find(|(key, ..)| key.parameter == name);
        let (_, path, setting) = named.unwrap_or(first);
        return Err(error.at(format_args!("{}: {path}", setting.place)));
    }
    Ok(Some(config))
}

/// Sets one parameter of the display to the value in the experiment file.
fn set(config: &mut dyn DisplayConfig, key: &NumberKey, path: &str, setting: &Setting) -> Result<(), SettingError> {
    let name = config.name();
    let tables = config.tables_mut();
    let table = tables.into_iter().map(|(_, table)| table).find(|table| table.get(key.parameter).is_ok());
    let Some(table) = table else {
        return Err(wrong(path, setting, &format!("nothing: the display {name} has no such number")));
    };
    let number = number(key, path, setting)?;
    let before = table.get(key.parameter);
    let info = table.infos().iter().find(|info| info.name == key.parameter);
    let in_limits = info.is_none_or(|info| (info.limits.0..=info.limits.1).contains(&number));
    if !in_limits || table.set(key.parameter, number).is_err() || before.is_err() {
        return Err(wrong(path, setting, &limits(key, table)));
    }
    Ok(())
}

/// Converts the value of a display parameter to the unit of the display's table.
fn number(key: &NumberKey, path: &str, setting: &Setting) -> Result<Number, SettingError> {
    let found = plain(&setting.value);
    if let Some((_, value)) = key.words.iter().find(|(word, _)| *word == found) {
        return Ok(Number::Whole(*value));
    }
    if !key.words.is_empty() {
        return Err(unknown(path, setting, key.words.iter().map(|(word, _)| *word)));
    }
    let value = setting.value.as_float().or(setting.value.as_integer().map(|value| value as f64));
    let scaled = value.map(|value| value * key.per_unit).filter(|value| (0.0..=1e12).contains(value));
    let is_whole = |value: &f64| (value - value.round()).abs() < 1e-6;
    let whole = scaled.filter(is_whole).map(|value| Number::Whole(value.round() as u64));
    whole.ok_or_else(|| wrong(path, setting, &unit_text(key)))
}

fn unit_text(key: &NumberKey) -> String {
    if key.per_unit == 1.0 {
        "a whole number from 0 on".to_owned()
    } else {
        format!("a number from 0 on in steps of {}", 1.0 / key.per_unit)
    }
}

/// Returns the range of a display parameter in the unit of the experiment file, for error messages.
fn limits(key: &NumberKey, table: &dyn ParameterTable) -> String {
    let info = table.infos().iter().find(|info| info.name == key.parameter);
    let text = |value: Number| match value {
        Number::Whole(whole) => (whole as f64 / key.per_unit).to_string(),
        Number::Real(real) => (real / key.per_unit).to_string(),
    };
    info.map_or_else(String::new, |info| format!("a number from {} to {}", text(info.limits.0), text(info.limits.1)))
}
