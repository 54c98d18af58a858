//! The input files that points of a sweep read, such as models and recordings, with hashes of their contents.

use super::Sweep;
use crate::experiment_file::{ExperimentFile, beside, is_file};
use crate::head_names::is_recording;
use pxpl5_run::Fingerprint;
use std::collections::BTreeMap;
use std::path::Path;
use toml::Value;

/// A function that returns true if a value is the name of a file, and not a built-in name.
type NamesFile = fn(&str) -> bool;
const KEYS: [(&str, NamesFile); 2] = [("scene", is_file), ("head.motion", is_recording)];

impl Sweep {
    /// Returns the hash of each file that a point may read, by the name in the sweep. A file that cannot be read counts
    /// as empty. Points that need this file fail with the reason.
    pub(super) fn inputs(&self) -> BTreeMap<String, Fingerprint> {
        let mut inputs = inputs_of(&self.base);
        for (key, names_file) in KEYS {
            let folder = self.folder();
            self.space.listed(key).for_each(|value| put(&mut inputs, names_file, &folder, value));
        }
        inputs
    }
}

/// Returns the hash of each file that an experiment file names, by the name in the file.
pub(crate) fn inputs_of(file: &ExperimentFile) -> BTreeMap<String, Fingerprint> {
    let mut inputs = BTreeMap::new();
    for (key, names_file) in KEYS {
        if let Some(setting) = file.settings.get(key) {
            put(&mut inputs, names_file, &setting.folder, &setting.value);
        }
    }
    inputs
}

fn put(inputs: &mut BTreeMap<String, Fingerprint>, names_file: NamesFile, folder: &Path, value: &Value) {
    if let Some(name) = value.as_str().filter(|name| names_file(name)) {
        let contents = std::fs::read(beside(folder, name)).unwrap_or_default();
        inputs.insert(name.to_owned(), Fingerprint::of(&contents));
    }
}
