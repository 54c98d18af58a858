//! Experiments as text: TOML files and single settings `path=value`. A checked [`Plan`] results from a file and the
//! settings that are added to it.
//!
//! ```
//! use pxpl5_lab::ExperimentFile;
//!
//! let text = r#"
//!     pipeline = "slats"
//!     scene = "mig"
//!     triangles = 110
//!     fields = 20
//!     [machine]
//!     preset = "slats"
//!     gp.triangle_ns = 30_000
//! "#;
//! let mut file = ExperimentFile::parse(text, "example.toml")?;
//! file.set_text("copy=whole", "--set")?;
//! let plan = file.resolve()?;
//! assert_eq!(plan.machine.gp.triangle_ns, 30_000);
//! let outcome = plan.experiment(plan.load_scene()?).run()?;
//! assert_eq!(outcome.experiment().scene().triangles().len(), 110);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`ExperimentFile::keys_of`] lists all keys. Keys without a value get the defaults of [`Plan`]. An unknown key is an
//! error, whose message names the most similar valid key.

mod display;
mod head;
mod hmd;
mod keys;
mod motion;
mod origin;
mod plan;
mod read;
mod reprojection;
mod scene;
mod text;
mod tracking_numbers;
mod units;

pub use head::HeadChoice;
pub use keys::FileKey;
pub use motion::{MotionChoice, PathChoice};
pub use origin::Origin;
pub use plan::{Outputs, Plan, Published};
pub(crate) use read::{beside, plain};
pub(crate) use scene::is_file;
pub use scene::{ModelPlace, SceneChoice};
pub use text::Settings;
pub use tracking_numbers::tracking_parameters;

use pxpl5_run::{Fingerprint, Registry};
use pxpl5_sim::parameters::{FileError, SettingError};
use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::Value;
use toml::de::DeTable;
use tracking::motion::Motion;

/// The value of a setting with its origin: a file and line, or an option of the command line.
#[derive(Clone, Debug)]
pub(crate) struct Setting {
    pub(crate) value: Value,
    pub(crate) place: String,
    /// Folder to which relative file names in the value refer.
    pub(crate) folder: PathBuf,
}

impl Setting {
    /// Returns the origin of the setting and its key, for error messages. The origin `--level` is returned alone,
    /// because it names the key already.
    fn place_of(&self, key: &str) -> String {
        match self.place.as_str() {
            "" => key.to_owned(),
            place if place.strip_prefix("--") == Some(key) => place.to_owned(),
            place => format!("{place}: {key}"),
        }
    }
}

/// Name of the random head motion, which gets its seed from the run.
const SYNTHETIC: &str = "synthetic";

/// Prefix of the value of `head.motion` for a motion without a name.
const GIVEN: &str = "given:";

/// The settings of an experiment by path. Each setting is valid, but the combination of all settings is not yet
/// checked.
#[derive(Clone, Debug)]
pub struct ExperimentFile {
    registry: Arc<Registry>,
    pub(crate) settings: BTreeMap<String, Setting>,
    pub(crate) sweep: Option<Setting>,
    /// File and line of each key in the table `sweep`, by the path of the key.
    pub(crate) sweep_places: BTreeMap<String, String>,
    contents: BTreeMap<String, Arc<[u8]>>,
    /// Motion of the head that has no name ([`ExperimentFile::set_motion`]).
    motion: Option<Arc<dyn Motion + Send + Sync>>,
}

impl ExperimentFile {
    /// Creates an experiment file without settings, for the built-in pipelines and displays.
    pub fn new() -> Self {
        Self::with(crate::registry())
    }

    /// Creates an experiment file without settings, for the pipelines and displays of `registry`.
    pub fn with(registry: Arc<Registry>) -> Self {
        Self {
            registry,
            settings: BTreeMap::new(),
            sweep: None,
            sweep_places: BTreeMap::new(),
            contents: BTreeMap::new(),
            motion: None,
        }
    }

    /// Returns the registry of the pipelines and displays that settings can name.
    pub const fn registry(&self) -> &Arc<Registry> {
        &self.registry
    }

    /// Returns the keys for the pipelines and displays of a registry. Two groups of keys are left out. The key of a
    /// machine parameter is `machine.` followed by a path of `MachineConfig::set`. [`tracking_parameters`] lists the
    /// keys of trackers and predictors.
    pub fn keys_of(registry: &Registry) -> Vec<FileKey> {
        keys::keys(registry)
    }

    /// Reads an experiment file.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the file cannot be read, and the errors of [`Self::parse`].
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SettingError> {
        Self::new().and_load(path)
    }

    /// Reads an experiment file. Its settings replace the current settings.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Self::load`].
    pub fn and_load(self, path: impl AsRef<Path>) -> Result<Self, SettingError> {
        let path = path.as_ref();
        let file = path.display().to_string();
        let bytes =
            std::fs::read(path).map_err(|error| FileError::unreadable(&file, "a readable experiment file", error))?;
        let text = pxpl5_sim::parameters::text_of(&bytes).map_err(|error| invalid(&file, error))?;
        let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        self.parse_in(text, &file, &folder)
    }

    /// Parses the text of an experiment file. `name` stands for the file name in error messages.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] with the line.
    pub fn parse(text: &str, name: &str) -> Result<Self, SettingError> {
        Self::new().and_parse(text, name)
    }

    /// Parses the text of an experiment file. Its settings replace the current settings. `name` stands for the file
    /// name in error messages.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Self::parse`].
    pub fn and_parse(self, text: &str, name: &str) -> Result<Self, SettingError> {
        self.parse_in(text, name, Path::new(""))
    }

    // Two parsers read the text: one gives the positions of keys for errors, the other the values.
    fn parse_in(mut self, text: &str, name: &str, folder: &Path) -> Result<Self, SettingError> {
        let spans = DeTable::parse(text).map_err(|error| not_toml(&error, text, name))?;
        let values: toml::Table = toml::from_str(text).map_err(|error| not_toml(&error, text, name))?;
        let starts = starts("", spans.get_ref()).into_iter();
        let places: BTreeMap<String, String> =
            starts.map(|(path, start)| (path, format!("{name}, line {}", line(text, start)))).collect();
        let place = |path: &str| places.get(path).cloned().unwrap_or_default();
        for (key, value) in values {
            // The table of a sweep is kept as a whole and checked later.
            if key == "sweep" {
                self.sweep = Some(Setting { value, place: place(&key), folder: folder.to_owned() });
                let inner = places.iter().filter(|(path, _)| path.starts_with("sweep."));
                self.sweep_places = inner.map(|(path, place)| (path.clone(), place.clone())).collect();
                continue;
            }
            for (path, value) in flat(key, value) {
                self.put(&path, value, place(&path), folder)?;
            }
        }
        Ok(self)
    }

    /// Sets the value of a key. `place` is the origin of the value in error messages, such as `--fields`.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] with the most similar valid path.
    pub fn set(&mut self, path: &str, value: impl Into<Value>, place: &str) -> Result<(), SettingError> {
        self.put(path, value.into(), place.to_owned(), Path::new(""))
    }

    /// Stores the contents of a model file or recording in memory. Settings with the file name `name` use these
    /// contents. Programs without a file system, such as web pages, need this function.
    #[must_use]
    pub fn with_contents(mut self, name: impl Into<String>, contents: impl Into<Arc<[u8]>>) -> Self {
        self.contents.insert(name.into(), contents.into());
        self
    }

    /// Moves the head by a motion without a name, such as a function. The value of `head.motion` becomes a hash of the
    /// motion, so that another motion is another experiment.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Self::set`].
    pub fn set_motion(&mut self, motion: Arc<dyn Motion + Send + Sync>) -> Result<(), SettingError> {
        let mut hash = Fingerprint::default();
        motion.identify(&mut |key, value| hash.setting(key, value));
        self.motion = Some(motion);
        self.set("head.motion", format!("{GIVEN}{hash}"), "the motion")
    }

    pub(super) fn contents(&self, name: &str) -> Option<&Arc<[u8]>> {
        self.contents.get(name)
    }

    /// Returns the line or option that set a key, or `None` if the key is not set.
    pub fn place_of(&self, key: &str) -> Option<&str> {
        self.settings.get(key).map(|setting| setting.place.as_str())
    }

    /// Returns the seed of the random numbers, which is 1 by default.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] when the seed is not a whole number from 0 to 2^63 - 1.
    pub fn seed(&self) -> Result<u64, SettingError> {
        Ok(self.whole("seed")?.unwrap_or(1))
    }

    /// Returns the checked settings for one seed. If `head.motion` is `synthetic`, the motion has the same seed.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Self::resolve`].
    pub fn resolve_for(&self, seed: u64) -> Result<Plan, SettingError> {
        let mut file = self.clone();
        file.set("seed", i64::try_from(seed).unwrap_or(i64::MAX), "seed")?;
        if file.text("head.motion")? == Some(SYNTHETIC) {
            file.set("head.motion", format!("{SYNTHETIC}:{seed}"), "seed")?;
        }
        file.resolve()
    }

    /// Returns true if the head moves differently for each seed. This requires the motion `synthetic` without a seed of
    /// its own.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the motion is not a text.
    pub fn has_motion_for_each_seed(&self) -> Result<bool, SettingError> {
        Ok(self.text("head.motion")? == Some(SYNTHETIC))
    }

    /// Sets a key from the text `path=value`. A value that is not valid TOML becomes a string.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the equals sign is missing, and the errors of [`Self::set`].
    pub fn set_text(&mut self, assignment: &str, place: &str) -> Result<(), SettingError> {
        let (path, text) = assignment
            .split_once('=')
            .ok_or_else(|| invalid(place, format_args!("expected path=value, found `{assignment}`")))?;
        // Numbers and lists need no quotes; any other text is taken literally.
        let parsed: Result<toml::Table, _> = toml::from_str(&format!("value = {text}"));
        let value = parsed.ok().filter(|table| table.len() == 1).and_then(|mut table| table.remove("value"));
        self.set(path.trim(), value.unwrap_or_else(|| Value::String(text.trim().to_owned())), place)
    }

    pub(crate) fn put(&mut self, path: &str, value: Value, place: String, folder: &Path) -> Result<(), SettingError> {
        let canonical = self.canonical_key(path, &place)?;
        let setting = Setting { value, place, folder: folder.to_owned() };
        // A number with a unit is kept as a number in the key's own unit.
        let converted = match setting.value.as_str().map(|text| units::converted(&self.registry, &canonical, text)) {
            Some(Err(expected)) => return Err(read::wrong(&canonical, &setting, &expected)),
            Some(Ok(converted)) => converted,
            None => None,
        };
        let value = converted.unwrap_or_else(|| setting.value.clone());
        self.settings.insert(canonical, Setting { value, ..setting });
        Ok(())
    }

    /// Returns the full path of a key, which may be abbreviated. An error names the most similar valid path.
    pub(crate) fn canonical_key(&self, path: &str, place: &str) -> Result<String, SettingError> {
        keys::canonical(&self.registry, path).ok_or_else(|| keys::unknown(&self.registry, path).at(place))
    }

    /// Returns the keys that are set, in alphabetical order.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.settings.keys().map(String::as_str)
    }

    /// Returns true if the file describes a sweep, which runs an experiment at many points of a parameter space.
    pub const fn is_sweep(&self) -> bool {
        self.sweep.is_some()
    }
}

impl Default for ExperimentFile {
    fn default() -> Self {
        Self::new()
    }
}

/// Returns the values of a nested TOML table with their paths. An empty table counts as a value and is not lost.
fn flat(path: String, value: Value) -> Vec<(String, Value)> {
    match value {
        Value::Table(table) if !table.is_empty() => {
            table.into_iter().flat_map(|(key, value)| flat(format!("{path}.{key}"), value)).collect()
        }
        leaf => vec![(path, leaf)],
    }
}

/// Returns the byte position of every key within a TOML table, by the path of the key. `prefix` is the path of the
/// table with a final dot.
fn starts(prefix: &str, table: &DeTable<'_>) -> Vec<(String, usize)> {
    let nested = table.iter().flat_map(|(key, value)| {
        let path = format!("{prefix}{}", key.get_ref());
        let inner = value.get_ref().as_table().map_or_else(Vec::new, |table| starts(&format!("{path}."), table));
        std::iter::once((path, key.span().start)).chain(inner)
    });
    nested.collect()
}

/// Converts an error of the TOML parser to a [`SettingError`] with file name and line.
fn not_toml(error: &toml::de::Error, text: &str, name: &str) -> SettingError {
    let at = error.span().map_or(0, |span| span.start);
    invalid(&format!("{name}, line {}", line(text, at)), error.message())
}

fn invalid(place: &str, reason: impl Display) -> SettingError {
    SettingError::combination(format_args!("not TOML: {reason}")).at(place)
}

fn line(text: &str, at: usize) -> usize {
    1 + text.as_bytes().iter().take(at).filter(|byte| **byte == b'\n').count()
}

#[cfg(test)]
mod tests;
