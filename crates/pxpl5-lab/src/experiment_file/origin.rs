//! The origin of an experiment file that a command wrote. A later run says by it what has changed since.

use super::plan::Plan;
use super::scene::is_file;
use super::{ExperimentFile, Settings};
use crate::head_parts::is_recorded_file;
use pxpl5_measure::program;
use pxpl5_run::{Experiment, Fingerprint};
use pxpl5_sim::parameters::{Key, KeyValues, SettingError};
use std::path::{Component, Path, PathBuf};

/// Keys `origin.*` of an experiment file, with their meaning.
pub(super) const KEYS: [Key; 5] = [
    Key::new("origin.version", "version of the program that wrote the file", KeyValues::ANY),
    Key::new("origin.commit", "commit of the program that wrote the file", KeyValues::ANY),
    Key::new("origin.config_hash", "hash of everything that affected the results", KeyValues::ANY),
    Key::new("origin.scene", "hash of the scene", KeyValues::ANY),
    Key::new("origin.motion", "hash of the motion of the head", KeyValues::ANY),
];

/// Program, settings, scene and motion from which results were made. A text is empty if it is not known.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Origin {
    texts: [String; KEYS.len()],
}

impl Origin {
    /// Returns the origin of the results of an experiment.
    #[must_use]
    pub fn of(experiment: &Experiment) -> Self {
        let motion = experiment.tracked_head().map(|head| {
            let mut hash = Fingerprint::default();
            head.motion().identify(&mut |key, value| hash.setting(key, value));
            hash.to_string()
        });
        Self {
            texts: [
                program::VERSION.to_owned(),
                program::commit().unwrap_or_default().to_owned(),
                experiment.config_hash().to_string(),
                Fingerprint::of_scene(experiment.scene()).to_string(),
                motion.unwrap_or_default(),
            ],
        }
    }

    pub(super) fn read(file: &ExperimentFile) -> Result<Self, SettingError> {
        let mut origin = Self::default();
        for (text, key) in origin.texts.iter_mut().zip(&KEYS) {
            *text = file.text(key.name)?.unwrap_or_default().to_owned();
        }
        Ok(origin)
    }

    /// Returns a warning that names what differs from the origin `now`. `None` if the results will be the same, or if the
    /// file names no origin.
    pub fn changes(&self, now: &Self) -> Option<String> {
        let [version, commit, config_hash, scene, motion] = &self.texts;
        let [now_version, now_commit, now_hash, now_scene, now_motion] = &now.texts;
        if config_hash.is_empty() || config_hash == now_hash {
            return None;
        }
        let parts = [("the model of the scene", scene, now_scene), ("the motion of the head", motion, now_motion)];
        let mut changed: Vec<String> =
            parts.iter().filter(|(_, before, after)| before != after).map(|(name, ..)| (*name).to_owned()).collect();
        if changed.is_empty() {
            changed.push("a setting".to_owned());
        }
        if [version, commit] != [now_version, now_commit] {
            changed.push(format!("the program (it was {version} {commit})"));
        }
        let what = changed.join(" and ");
        Some(format!(
            "the results will differ from those beside this file: {what} has changed (config_hash {config_hash}, now {now_hash})"
        ))
    }
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
}

impl Settings {
    /// Returns the settings of an experiment file, without defaults. Names of files become absolute.
    #[must_use]
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
        for (key, text) in KEYS.iter().zip(&origin.texts).filter(|(_, text)| !text.is_empty()) {
            self.put(key.name, text.clone());
        }
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
}

pub(super) fn names_file(key: &str, name: &str) -> bool {
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

    #[test]
    fn an_origin_names_what_has_changed() {
        let of = |texts: [&str; 5]| Origin { texts: texts.map(str::to_owned) };
        let before = of(["1.0", "abc", "h1", "s1", "m1"]);
        assert_eq!(before.changes(&before), None);
        assert_eq!(Origin::default().changes(&before), None);
        let model = before.changes(&of(["1.0", "abc", "h2", "s2", "m1"])).expect("a warning");
        assert!(model.contains("the model of the scene has changed") && model.contains("h1, now h2"), "{model}");
        let program = before.changes(&of(["2.0", "abc", "h2", "s1", "m1"])).expect("a warning");
        assert!(program.contains("a setting and the program (it was 1.0 abc) has changed"), "{program}");
    }
}
