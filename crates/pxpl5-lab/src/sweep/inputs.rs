//! The input files of a sweep's points, such as models and recordings, with hashes of their contents.

use super::Sweep;
use crate::experiment_file::{ExperimentFile, beside, is_file};
use crate::head_parts::is_recorded_file;
use pxpl5_run::Fingerprint;
use pxpl5_scene::{Placement, load_placed};
use std::collections::BTreeMap;
use std::path::Path;
use toml::Value;

/// A setting whose value can be a file name.
struct FileKey {
    key: &'static str,
    /// Returns true if a value is the name of a file, and not a built-in name.
    names_file: fn(&str) -> bool,
    hash_of: fn(&Path) -> Fingerprint,
}

const KEYS: [FileKey; 3] = [
    FileKey { key: "scene", names_file: is_file, hash_of: hash_of_model },
    FileKey { key: "head.motion", names_file: is_recorded_file, hash_of: hash_of_file },
    FileKey { key: "head.train", names_file: is_recorded_file, hash_of: hash_of_file },
];

impl Sweep {
    /// Returns the hash of each file that a point may read, by the file's name in the settings. A file that cannot be
    /// read counts as empty, and all points that need it fail.
    pub(super) fn inputs(&self) -> BTreeMap<String, Fingerprint> {
        let mut inputs = inputs_of(&self.base);
        let folder = self.folder();
        for file in &KEYS {
            self.space.listed(file.key).for_each(|value| file.put(&mut inputs, &folder, value));
        }
        inputs
    }
}

/// Returns the hash of each file that an experiment file names, by the name of the file.
pub(crate) fn inputs_of(experiment: &ExperimentFile) -> BTreeMap<String, Fingerprint> {
    let mut inputs = BTreeMap::new();
    for file in &KEYS {
        if let Some(setting) = experiment.settings.get(file.key) {
            file.put(&mut inputs, &setting.folder, &setting.value);
        }
    }
    inputs
}

impl FileKey {
    fn put(&self, inputs: &mut BTreeMap<String, Fingerprint>, folder: &Path, value: &Value) {
        if let Some(name) = value.as_str().filter(|name| (self.names_file)(name)) {
            inputs.insert(name.to_owned(), (self.hash_of)(Path::new(&beside(folder, name))));
        }
    }
}

/// Returns the hash of the scene in a model file, in the coordinates of the file.
///
/// The hash covers the scene instead of the bytes of the file, because a glTF file refers to other files. A file
/// without a model gets the hash of its bytes. A file that cannot be read gets the hash of an empty text.
pub fn hash_of_model(path: &Path) -> Fingerprint {
    let scene = load_placed(path, Placement::AsInFile);
    scene.map_or_else(|_| hash_of_file(path), |scene| Fingerprint::of_scene(&scene))
}

fn hash_of_file(path: &Path) -> Fingerprint {
    Fingerprint::of(&std::fs::read(path).unwrap_or_default())
}
