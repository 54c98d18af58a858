//! The origin of an experiment file that a command wrote. A later run says by it what has changed since.

use super::ExperimentFile;
use pxpl5_measure::program;
use pxpl5_run::{Experiment, Fingerprint};
use pxpl5_sim::parameters::{Key, KeyValues, SettingError};

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
    pub fn of(experiment: &Experiment) -> Self {
        let motion = experiment.head.as_ref().map(|head| {
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

    /// Returns the known texts with their keys.
    pub(super) fn entries(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let all = KEYS.iter().zip(&self.texts).filter(|(_, text)| !text.is_empty());
        all.map(|(key, text)| (key.name, text.as_str()))
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

#[cfg(test)]
mod tests {
    use super::*;

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
