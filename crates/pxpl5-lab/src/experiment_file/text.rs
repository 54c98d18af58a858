//! Converts the plan of an experiment to the text of a complete experiment file.

use super::origin::Origin;
use super::plan::Plan;
use super::scene::is_file;
use super::{ExperimentFile, hmd};
use crate::head_parts::is_recorded_file;
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, Fingerprint, KeyValue};
use pxpl5_sim::parameters::Parameter;
use pxpl5_sim::parameters::Value as Number;
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Component, Path, PathBuf};
use toml::Value;

/// The effective settings of an experiment, by path.
///
/// `Display` writes the settings as the text of an experiment file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// TOML values by the path of their key.
    pub values: BTreeMap<String, Value>,
    /// Remarks by the path of the key: unit, provenance and the value in the preset.
    remarks: BTreeMap<String, String>,
}

impl Plan {
    /// Returns the effective value of each setting and the origin of the results, for an experiment file in `folder`. File
    /// names are relative to the folder where both have a common parent.
    pub fn settings_in(&self, folder: &Path, experiment: &Experiment) -> Settings {
        let mut all = self.settings_for_any_folder();
        all.make_relative(folder);
        all.originate(&Origin::of(experiment));
        all
    }

    /// Returns the effective value of each setting, including defaults.
    pub fn settings(&self) -> Settings {
        let mut all = Settings { values: self.given.clone(), remarks: BTreeMap::new() };
        all.put("pipeline", self.pipeline.name());
        self.pipeline.settings().into_iter().for_each(|(key, value)| all.put(key, toml_value(value)));
        all.put("display", self.display());
        all.put("scene", self.scene.name.clone());
        all.put("head.path", self.scene.motion.path.to_string());
        self.scene.motion.deg_per_s.into_iter().for_each(|rate| all.put("head.deg_per_s", rate));
        // Without a tracked head, tracking parameters have no effect and are left out.
        if let Some(head) = &self.head {
            head.settings().into_iter().for_each(|(path, value)| all.put(&path, value));
            head.parameters().iter().for_each(|parameter| all.parameter(&parameter.path, parameter, &[]));
        }
        hmd::settings(&self.hmd).for_each(|(path, value)| all.put(path, value));
        all.put("fields", self.fields as i64);
        all.put("seed", self.seed as i64);
        all.put("pixels", self.pixels.to_string());
        all.put("level", self.level_name());
        self.within_percent.into_iter().for_each(|bound| all.put("within", bound));
        all.put("measure", self.measure.iter().map(|m| Value::from(m.name())).collect::<Vec<_>>());
        all.put("output.pictures", self.output.pictures);
        all.put("output.timeline", self.output.timeline);
        all.put("output.csv", self.output.csv);
        all.machine(&self.machine);
        all
    }

    /// Returns the effective value of each setting, for an experiment file in any folder. Relative file names become
    /// absolute.
    pub fn settings_for_any_folder(&self) -> Settings {
        let mut all = self.settings();
        for key in ["scene", "head.motion", "head.train"] {
            let named = all.values.get(key).and_then(Value::as_str).filter(|name| names_file(key, name));
            // An empty path cannot be made absolute and stays unchanged.
            if let Some(absolute) = named.and_then(|name| std::path::absolute(name).ok()) {
                all.put(key, absolute.display().to_string());
            }
        }
        all
    }

    /// Returns a hash of the settings that determine the result. The hash excludes the settings of pixels, output
    /// files, and the comparison with a published figure.
    pub fn fingerprint(&self) -> Fingerprint {
        // These settings do not change the simulated result.
        let outside = ["title", "pixels", "measure", "output.", "published."];
        let settings = self.settings();
        let inside = settings.values.iter().filter(|(path, _)| !outside.iter().any(|o| path.starts_with(o)));
        let text: String = inside.map(|(path, value)| format!("{path}={value}\n")).collect();
        Fingerprint::of(text.as_bytes())
    }
}

impl Settings {
    /// Returns the settings of an experiment file, without defaults. Names of files become absolute.
    pub fn of(file: &ExperimentFile) -> Self {
        let mut all = Self::default();
        for (key, setting) in file.settings.iter().filter(|(key, _)| !key.starts_with("origin.")) {
            all.put(key, setting.value.clone());
            let named =
                setting.value.as_str().filter(|name| names_file(key, name)).map(|name| setting.folder.join(name));
            if let Some(absolute) = named.and_then(|name| std::path::absolute(name).ok()) {
                all.put(key, absolute.display().to_string());
            }
        }
        all
    }

    /// Adds the keys of an origin.
    pub fn originate(&mut self, origin: &Origin) {
        origin.entries().for_each(|(key, text)| self.put(key, text));
    }

    /// Replaces absolute names of files by names that are relative to `folder`.
    pub fn make_relative(&mut self, folder: &Path) {
        for key in ["scene", "head.motion", "head.train"] {
            let named = self.values.get(key).and_then(|value| value.as_str()).map(Path::new);
            if let Some(name) = named.filter(|name| name.is_absolute()).and_then(|name| relative(name, folder)) {
                self.put(key, name);
            }
        }
    }

    pub(super) fn put(&mut self, path: &str, value: impl Into<Value>) {
        self.values.insert(path.to_owned(), value.into());
    }

    fn machine(&mut self, machine: &MachineConfig) {
        self.put("machine.preset", machine.preset.clone());
        self.put("machine.code", machine.code_name());
        self.put("machine.n_gps", machine.n_gps as i64);
        self.put("machine.n_renderers", machine.n_renderers as i64);
        // The remarks name the values of the preset that differ.
        let preset = MachineConfig::preset(&machine.preset).map(|preset| preset.parameters()).unwrap_or_default();
        for parameter in machine.parameters().into_iter().filter(|parameter| !parameter.read_only) {
            self.parameter(&format!("machine.{}", parameter.path), &parameter, &preset);
        }
    }

    /// Adds a parameter under its key, with a remark about its unit and provenance. If the value differs from the
    /// preset, the remark also states the preset's value.
    fn parameter(&mut self, key: &str, parameter: &Parameter, preset: &[Parameter]) {
        let own = preset.iter().find(|other| other.path == parameter.path).map(|other| other.value);
        let changed = own.filter(|own| *own != parameter.value);
        let changed = changed.map_or_else(String::new, |own| format!("; the preset has {own}"));
        let remark = format!("{}, {}{changed}", parameter.info.unit, parameter.info.provenance);
        self.remarks.insert(key.to_owned(), remark);
        self.put(key, toml_number(parameter.value));
    }

    fn lines(&self, f: &mut fmt::Formatter<'_>, table: Option<&str>) -> fmt::Result {
        for (path, value) in &self.values {
            let (of, key) = match path.split_once('.') {
                Some((of, key)) => (Some(of), key),
                None => (None, path.as_str()),
            };
            if of == table {
                let remark = self.remarks.get(path).map_or_else(String::new, |remark| format!("  # {remark}"));
                writeln!(f, "{key} = {value}{remark}")?;
            }
        }
        Ok(())
    }
}

fn names_file(key: &str, name: &str) -> bool {
    match key {
        "scene" => is_file(name),
        "head.motion" | "head.train" => is_recorded_file(name),
        _ => false,
    }
}

/// Returns the way from a folder to a file, or `None` if they have only the root in common.
fn relative(file: &Path, folder: &Path) -> Option<String> {
    let folder = std::path::absolute(folder).ok()?;
    let is_plain = |path: &Path| path.components().all(|part| part != Component::ParentDir);
    let common = file.components().zip(folder.components()).take_while(|(one, other)| one == other).count();
    // The root is the first component.
    if common < 2 || !is_plain(file) || !is_plain(&folder) {
        return None;
    }
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    let way: PathBuf = up.chain(file.components().skip(common)).collect();
    Some(way.display().to_string())
}

pub(super) fn toml_value(value: KeyValue) -> Value {
    match value {
        KeyValue::Flag(flag) => Value::from(flag),
        KeyValue::Whole(number) => Value::from(number.cast_signed()),
        KeyValue::Real(number) => Value::from(number),
        KeyValue::Name(name) => Value::from(name),
        KeyValue::Text(text) => Value::from(&*text),
    }
}

fn toml_number(value: Number) -> Value {
    match value {
        Number::Whole(number) => Value::from(i64::try_from(number).unwrap_or(i64::MAX)),
        Number::Real(number) => Value::from(number),
    }
}

impl fmt::Display for Settings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.lines(f, None)?;
        for table in ["model", "head", "hmd", "tracking", "machine", "limit", "output", "published", "origin"] {
            if self.values.keys().any(|path| path.split_once('.').is_some_and(|(of, _)| of == table)) {
                writeln!(f, "\n[{table}]")?;
                self.lines(f, Some(table))?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_from_a_folder_to_a_file_leads_through_their_common_parent() {
        let way = |file: &str, folder: &str| relative(Path::new(file), Path::new(folder));
        assert_eq!(way("/home/a/models/x.obj", "/home/a/out/one").as_deref(), Some("../../models/x.obj"));
        assert_eq!(way("/home/a/x.obj", "/home/a").as_deref(), Some("x.obj"));
        assert_eq!(way("/data/x.obj", "/home/a"), None);
        assert_eq!(way("/home/b/../x.obj", "/home/a"), None);
    }
}
