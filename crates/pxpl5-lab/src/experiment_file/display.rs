//! Reader of the display in an experiment file: a preset, and parameters that change the preset.

use super::read::wrong;
use super::{ExperimentFile, Setting};
use pxpl5_framebuffer::PanelConfig;
use pxpl5_run::DisplayEntry;
use pxpl5_sim::parameters::{Key, KeyValue, KeyValues, ParameterTable, SettingError, Value as Number};
use pxpl5_wire::display::DisplayConfig;

/// Name of the display for a file that sets display parameters but names no display.
const OWN: &str = "panel";

/// A display parameter. Its name in the file is the last part of the key. Its name in the display's table of parameters
/// is `parameter`.
struct NumberKey {
    key: Key,
    parameter: &'static str,
    /// Factor that converts a value in the file to the unit of the display's table.
    per_unit: f64,
}

/// Creates a key with a number. The display's table gives the range of the number.
const fn number(name: &'static str, unit: &'static str, about: &'static str, parameter: &'static str) -> NumberKey {
    NumberKey { key: Key { unit, ..Key::new(name, about, KeyValues::NUMBER) }, parameter, per_unit: 1.0 }
}

/// Creates a key with names. The first name means 0 in the display's table, the second name means 1, and so on.
const fn choice(name: &'static str, about: &'static str, values: KeyValues, parameter: &'static str) -> NumberKey {
    NumberKey { key: Key::new(name, about, values), parameter, per_unit: 1.0 }
}

const KEYS: [NumberKey; 11] = [
    number("display.width", "px", "visible pixels of a line", "width"),
    number("display.height", "px", "visible lines", "height"),
    number("display.hz", "Hz", "scans a second", "refresh_hz"),
    choice("display.interlace", "a scan lights every second line only", KeyValues::Flag, "interlace"),
    choice(
        "display.scan",
        "rolling (pixels light one after the other) or global (all at once)",
        KeyValues::Names(&["rolling", "global"]),
        "scan",
    ),
    choice(
        "display.direction",
        "direction of a rolling scan",
        KeyValues::Names(&["down", "up", "right", "left"]),
        "direction",
    ),
    number(
        "display.active",
        "",
        "part of the period in which pixels light; a global display lights at its end",
        "active_permille",
    )
    .in_thousandths(),
    number(
        "display.persistence_ms",
        "ms",
        "time for which a pixel shines in each scan, at most a period",
        "persistence_us",
    )
    .in_thousandths(),
    number("display.response_ms", "ms", "time constant of a pixel's brightness", "response_us").in_thousandths(),
    number("display.ports", "", "ports of a board on the ring", "ports"),
    number("display.bits", "", "bits of a pixel's colour", "bits"),
];

impl NumberKey {
    /// Returns the key of a number that the display's table has in thousandths of the unit.
    const fn in_thousandths(self) -> Self {
        Self { per_unit: 1e3, ..self }
    }

    /// Returns the range of the parameter in a display's table, in the unit of the experiment file.
    fn limits(&self, table: &dyn ParameterTable) -> KeyValues {
        let info = table.infos().iter().find(|info| info.name == self.parameter);
        let in_file = |value: Number| value.real() / self.per_unit;
        info.map_or(KeyValues::NUMBER, |info| KeyValues::Real(in_file(info.limits.0), in_file(info.limits.1)))
    }

    fn with_limits(&self, table: &dyn ParameterTable) -> Key {
        let is_number = matches!(self.key.values, KeyValues::Real(..));
        Key { values: if is_number { self.limits(table) } else { self.key.values }, ..self.key }
    }
}

/// Returns each display parameter's key and description, with the ranges of the display `panel`.
pub(super) fn keys() -> impl Iterator<Item = (&'static str, String)> {
    KEYS.iter().map(|key| (key.key.name, key.with_limits(&PanelConfig::PAPERS).help()))
}

pub(super) fn unit_of(name: &str) -> Option<&'static str> {
    KEYS.iter().find(|key| key.key.name == name).map(|key| key.key.unit)
}

/// Reads the display and its parameters. Returns `None` if the file names no display and sets no display parameter.
pub(super) fn read(file: &ExperimentFile) -> Result<Option<Box<dyn DisplayConfig>>, SettingError> {
    let displays: Vec<(&str, &DisplayEntry)> =
        file.registry().displays().iter().map(|entry| (entry.name, entry)).collect();
    let given: Vec<(&NumberKey, &Setting)> =
        KEYS.iter().filter_map(|key| Some((key, file.get(key.key.name)?))).collect();
    let own = displays.iter().find(|(name, _)| *name == OWN && !given.is_empty()).map(|(_, entry)| *entry);
    let Some(entry) = file.choice("display", &displays)?.or(own) else { return Ok(None) };
    let mut config = (entry.config)();
    for (key, setting) in &given {
        set(file, config.as_mut(), key, setting)?;
    }
    if let (Err(error), Some(first)) = (config.check(), given.first()) {
        // The message names the number in the table. The place is the place of the key that sets this number.
        let name = error.name.rsplit('.').next().unwrap_or_default();
        let (key, setting) = given.iter().find(|(key, _)| key.parameter == name).unwrap_or(first);
        return Err(error.at(setting.place_of(key.key.name)));
    }
    Ok(Some(config))
}

fn set(
    file: &ExperimentFile,
    config: &mut dyn DisplayConfig,
    number: &NumberKey,
    setting: &Setting,
) -> Result<(), SettingError> {
    let display = config.name();
    let name = number.key.name;
    let table =
        config.tables_mut().into_iter().map(|(_, table)| table).find(|table| table.get(number.parameter).is_ok());
    let Some(table) = table else {
        return Err(wrong(name, setting, &format!("nothing: the display {display} has no such number")));
    };
    let key = number.with_limits(table);
    let value = match file.value(&key)? {
        Some(KeyValue::Flag(flag)) => u64::from(flag) as f64,
        Some(KeyValue::Name(found)) => position(key.values, found) as f64,
        Some(KeyValue::Real(real)) => real * number.per_unit,
        _ => return Ok(()),
    };
    let is_whole = (value - value.round()).abs() < 1e-6;
    let step = 1.0 / number.per_unit;
    let expected = || format!("{} in steps of {step}", key.expected());
    let set = is_whole.then(|| table.set(number.parameter, Number::Whole(value.round() as u64)));
    if let Some(Ok(())) = set { Ok(()) } else { Err(wrong(name, setting, &expected())) }
}

fn position(values: KeyValues, found: &str) -> usize {
    let KeyValues::Names(names) = values else { return 0 };
    names.iter().position(|name| *name == found).unwrap_or_default()
}
