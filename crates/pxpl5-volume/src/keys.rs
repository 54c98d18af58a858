//! Access to the settings of a volume by path.

use crate::choices::{ClipKind, Named};
use crate::settings::VolumeSettings;
use pxpl5_sim::parameters::SettingError;
use pxpl5_sim::parameters::{Entry, ParameterInfo, ParameterTable, Value};

/// Paths of the settings that are choices, and of the numbers that no table contains.
const CHOICES: [&str; 12] = [
    "on",
    "clip.variant",
    "clip.ties",
    "projection",
    "seed",
    "bins.planes",
    "bins.tolerance",
    "draw.coverage",
    "draw.strobes",
    "draw.combine",
    "draw.lit",
    "display.rotation",
];

impl VolumeSettings {
    /// Returns all paths that [`Self::set`] accepts.
    #[must_use]
    pub fn keys(&self) -> Vec<String> {
        let numbers = self
            .tables()
            .into_iter()
            .flat_map(|(prefix, table)| table.infos().iter().map(move |info| path_of(prefix, info)));
        CHOICES.iter().map(|key| (*key).to_owned()).chain(numbers).collect()
    }

    /// Returns all numbers with their paths and current values.
    #[must_use]
    pub fn numbers(&self) -> Vec<(String, Entry)> {
        let numbers = self.tables().into_iter().flat_map(|(prefix, table)| {
            table.entries().into_iter().map(move |entry| (path_of(prefix, entry.info), entry))
        });
        numbers.collect()
    }

    /// Sets the setting at a path to a value. Errors name `place`, the source of the value, such as `--set`.
    ///
    /// # Errors
    ///
    /// [`SettingError`] with the most similar path, or with the allowed values.
    pub fn set(&mut self, path: &str, text: &str, place: &str) -> Result<(), SettingError> {
        let done = match path {
            "clip.variant" => self.set_clip(text),
            "clip.ties" => choose(&mut self.ties, text),
            "projection" => choose(&mut self.projection, text),
            "on" => choose(&mut self.renderer, text),
            "seed" => whole(text).map(|seed| self.seed = seed),
            "bins.planes" => choose(&mut self.binning, text),
            "bins.tolerance" => self.set_tolerance(text),
            "draw.coverage" => choose(&mut self.coverage, text),
            "draw.strobes" => choose(&mut self.strobes, text),
            "draw.combine" => choose(&mut self.combine, text),
            "draw.lit" => choose(&mut self.is_lit, text),
            "display.rotation" => choose(&mut self.rotation, text),
            // All other paths are numbers of a table.
            _ => return self.set_number(path, text, place),
        };
        done.map_err(|expected| wrong(path, text, place, expected))
    }

    /// Applies an assignment `path=value`, as after `--set`.
    ///
    /// # Errors
    ///
    /// The same as [`Self::set`], and a [`SettingError`] without an equals sign.
    pub fn assign(&mut self, assignment: &str, place: &str) -> Result<(), SettingError> {
        match assignment.split_once('=') {
            Some((path, text)) => self.set(path.trim(), text.trim(), place),
            None => Err(wrong("PATH=VALUE", assignment, place, "an equals sign".to_owned())),
        }
    }

    /// Parses a clip as `NAME` or `NAME:NUMBER`. The number is the clip's offset or bias.
    fn set_clip(&mut self, text: &str) -> Result<(), String> {
        let (name, number) = match text.split_once(':') {
            Some((name, number)) => (name, Some(number)),
            None => (text, None),
        };
        let clip = ClipKind::named(name)?;
        // Only some clips have a number, and the number belongs to one of two settings.
        let own = match clip {
            ClipKind::Tapered | ClipKind::Parallel => Some(&mut self.clip_numbers.offset_px),
            ClipKind::Hyperbolic => Some(&mut self.clip_numbers.bias_px2),
            _ => None,
        };
        match (own, number) {
            (Some(own), Some(number)) => {
                *own = number.parse().map_err(|_| format!("a number after {name}:"))?;
            }
            (None, Some(_)) => return Err(format!("{name} without a number")),
            (_, None) => {}
        }
        self.clip = clip;
        Ok(())
    }

    /// Parses the tolerance of bins: `clip`, `codes` or a number of pixels.
    fn set_tolerance(&mut self, text: &str) -> Result<(), String> {
        if let Ok(pixels) = text.parse::<f64>()
            && pixels.is_finite()
            && pixels >= 0.0
        {
            self.bin_tolerance = spatialgl::BinTolerance::Pixels(pixels);
            return Ok(());
        }
        choose(&mut self.bin_tolerance, text).map_err(|names| format!("{names} or a number of pixels from 0 on"))
    }

    fn set_number(&mut self, path: &str, text: &str, place: &str) -> Result<(), SettingError> {
        let unknown = || SettingError::unknown_path("key", path, self.keys()).at(place);
        let Some((_, entry)) = self.numbers().into_iter().find(|(key, _)| key == path) else { return Err(unknown()) };
        let expected = expected_of(entry.info);
        // A whole number is also valid for a real setting, but not the reverse.
        let value = number(text).filter(|value| matches!(entry.value, Value::Real(_)) || value.whole().is_some());
        let Some(value) = value else { return Err(wrong(path, text, place, expected)) };
        let value = if matches!(entry.value, Value::Real(_)) { Value::Real(value.real()) } else { value };
        let found = Entry { info: entry.info, value };
        if !found.is_within_limits() {
            return Err(wrong(path, text, place, expected));
        }
        let prefix = path.split('.').next().unwrap_or_default();
        let table = self.table_mut(prefix, entry.info.name);
        match table.map(|table| table.set(entry.info.name, value)) {
            Some(Ok(())) => Ok(()),
            _ => Err(wrong(path, text, place, expected)),
        }
    }

    fn table_mut(&mut self, prefix: &str, name: &str) -> Option<&mut dyn ParameterTable> {
        let tables: [(&str, &mut dyn ParameterTable); 9] = [
            ("display", &mut self.display),
            ("display", &mut self.sweep),
            ("clip", &mut self.clip_numbers),
            ("jitter", &mut self.jitter),
            ("eye", &mut self.eye),
            ("tile", &mut self.tile),
            ("draw", &mut self.draw),
            ("gpu", &mut self.gpu),
            ("viewer", &mut self.viewer),
        ];
        let found = tables.into_iter().find(|(own, table)| *own == prefix && table.get(name).is_ok());
        found.map(|(_, table)| table)
    }
}

fn path_of(prefix: &str, info: &ParameterInfo) -> String {
    format!("{prefix}.{}", info.name)
}

fn expected_of(info: &ParameterInfo) -> String {
    let (least, most) = info.limits;
    let kind = if matches!(info.papers, Value::Whole(_)) { "a whole number" } else { "a number" };
    format!("{kind} of {least} to {most} {}", info.unit)
}

fn number(text: &str) -> Option<Value> {
    text.parse().map(Value::Whole).or_else(|_| text.parse().map(Value::Real)).ok()
}

fn whole(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| "a whole number of 0 to 2^64 - 1".to_owned())
}

fn choose<T: Named>(choice: &mut T, text: &str) -> Result<(), String> {
    *choice = T::named(text)?;
    Ok(())
}

fn wrong(key: &str, found: &str, place: &str, expected: String) -> SettingError {
    SettingError::value(key, expected, found).at(place)
}
