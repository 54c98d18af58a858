//! Experiments as text: TOML files, single settings `path=value`, and the checked [`Plan`] that they make together.
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
//! All keys: [`ExperimentFile::keys`]. Keys without a value get the defaults of [`Plan`]; keys that nobody knows are errors that name
//! the nearest valid one.

mod error;
mod head;
mod keys;
mod motion;
mod plan;
mod read;
mod scene;
mod text;
mod tracking_numbers;

pub use error::FileError;
pub use head::HeadChoice;
pub use keys::FileKey;
pub use motion::{MotionChoice, PathChoice};
pub use plan::{Outputs, Plan, Published};
pub(crate) use read::{beside, plain};
pub use scene::SceneChoice;
pub(crate) use scene::is_file;
pub use text::Settings;
pub use tracking_numbers::tracking_parameters;

use pxpl5_run::Registry;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::Value;
use toml::de::DeTable;

/// A value and where it was given.
#[derive(Clone, Debug)]
pub(crate) struct Setting {
    pub(crate) value: Value,
    pub(crate) place: String,
    /// The folder to which file names are relative.
    pub(crate) folder: PathBuf,
}

/// A motion whose seed is the run's, where there are several runs.
const SYNTHETIC: &str = "synthetic";

/// Settings by path that were read but not yet checked together.
#[derive(Clone, Debug)]
pub struct ExperimentFile {
    registry: Arc<Registry>,
    pub(crate) settings: BTreeMap<String, Setting>,
    pub(crate) sweep: Option<Setting>,
    /// Where each key within the table `sweep` was given, by path.
    pub(crate) sweep_places: BTreeMap<String, String>,
    /// Contents of files that are at hand, by name.
    contents: BTreeMap<String, Arc<[u8]>>,
}

impl ExperimentFile {
    /// No settings; with the pipelines and displays of the papers.
    #[must_use]
    pub fn new() -> Self {
        Self::with(crate::registry())
    }

    /// No settings; with the pipelines and displays of a registry.
    #[must_use]
    pub fn with(registry: Arc<Registry>) -> Self {
        let contents = BTreeMap::new();
        Self { registry, settings: BTreeMap::new(), sweep: None, sweep_places: BTreeMap::new(), contents }
    }

    /// The pipelines and displays that it may name.
    #[must_use]
    pub const fn registry(&self) -> &Arc<Registry> {
        &self.registry
    }

    /// All keys but the machine's parameters, which are `machine.` and a path of `MachineConfig::set`, and those of trackers
    /// and predictors ([`tracking_parameters`]).
    #[must_use]
    pub fn keys_of(registry: &Registry) -> Vec<FileKey> {
        keys::keys(registry)
    }

    /// Reads a file.
    ///
    /// # Errors
    ///
    /// [`FileError::Io`], or as [`Self::parse`].
    pub fn load(path: impl AsRef<Path>) -> Result<Self, FileError> {
        Self::new().and_load(path)
    }

    /// Reads a file on top of what is set.
    ///
    /// # Errors
    ///
    /// As [`Self::load`].
    pub fn and_load(self, path: impl AsRef<Path>) -> Result<Self, FileError> {
        let path = path.as_ref();
        let file = path.display().to_string();
        let bytes =
            std::fs::read(path).map_err(|error| FileError::Io { file: file.clone(), reason: error.to_string() })?;
        let text = parameters::text_of(&bytes).map_err(|reason| FileError::Syntax { place: file.clone(), reason })?;
        let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        self.parse_in(text, &file, &folder)
    }

    /// Reads text; `name` stands for it in errors.
    ///
    /// # Errors
    ///
    /// [`FileError::Syntax`] and [`FileError::UnknownKey`] with the line.
    pub fn parse(text: &str, name: &str) -> Result<Self, FileError> {
        Self::new().and_parse(text, name)
    }

    /// Reads text on top of what is set; `name` stands for it in errors.
    ///
    /// # Errors
    ///
    /// As [`Self::parse`].
    pub fn and_parse(self, text: &str, name: &str) -> Result<Self, FileError> {
        self.parse_in(text, name, Path::new(""))
    }

    fn parse_in(mut self, text: &str, name: &str, folder: &Path) -> Result<Self, FileError> {
        let spans = DeTable::parse(text).map_err(|error| not_toml(&error, text, name))?;
        let values: toml::Table = toml::from_str(text).map_err(|error| not_toml(&error, text, name))?;
        for (key, value) in values {
            let at = spans.get_ref().get_key_value(key.as_str());
            let start = at.map_or(0, |(key, _)| key.span().start);
            if key == "sweep" {
                self.sweep = Some(Setting { value, place: place(text, name, start), folder: folder.to_owned() });
                let inner = at.map_or_else(Vec::new, |(_, value)| starts("sweep", value.get_ref()));
                let places = inner.into_iter().map(|(path, start)| (path, place(text, name, start)));
                self.sweep_places = places.collect();
                continue;
            }
            let spans = at.map(|(_, value)| value.get_ref());
            for (path, value, start) in flat(key, value, spans, start) {
                self.put(&path, value, place(text, name, start), folder)?;
            }
        }
        Ok(self)
    }

    /// Sets a value; `place` says in errors where it was given, such as `--fields`.
    ///
    /// # Errors
    ///
    /// [`FileError::UnknownKey`] with the nearest valid path.
    pub fn set(&mut self, path: &str, value: impl Into<Value>, place: &str) -> Result<(), FileError> {
        self.put(path, value.into(), place.to_owned(), Path::new(""))
    }

    /// Has the contents of a model or of a recording at hand, which are then taken wherever a setting names that file: for a host without
    /// files, such as a browser.
    #[must_use]
    pub fn with_contents(mut self, name: impl Into<String>, contents: impl Into<Arc<[u8]>>) -> Self {
        self.contents.insert(name.into(), contents.into());
        self
    }

    pub(super) fn contents(&self, name: &str) -> Option<&Arc<[u8]>> {
        self.contents.get(name)
    }

    /// Where a key was set: a line, an option; `None` of one that was not.
    #[must_use]
    pub fn place_of(&self, key: &str) -> Option<&str> {
        self.settings.get(key).map(|setting| setting.place.as_str())
    }

    /// The seed, 1 where none is set.
    ///
    /// # Errors
    ///
    /// [`FileError`] when it is no whole number from 0 on.
    pub fn seed(&self) -> Result<u64, FileError> {
        Ok(self.integer("seed", 0..=plan::MAX_SEED)?.unwrap_or(1))
    }

    /// The checked experiment of one seed; a `head.motion` of `synthetic` moves as that seed says.
    ///
    /// # Errors
    ///
    /// As [`Self::resolve`].
    pub fn resolve_for(&self, seed: u64) -> Result<Plan, FileError> {
        let mut file = self.clone();
        file.set("seed", i64::try_from(seed).unwrap_or(i64::MAX), "seed")?;
        if file.text("head.motion")? == Some(SYNTHETIC) {
            file.set("head.motion", format!("{SYNTHETIC}:{seed}"), "seed")?;
        }
        file.resolve()
    }

    /// Sets `path=value`; a value that is not TOML is taken as text.
    ///
    /// # Errors
    ///
    /// As [`Self::set`], and [`FileError::Syntax`] without an equals sign.
    pub fn set_text(&mut self, assignment: &str, place: &str) -> Result<(), FileError> {
        let (path, text) = assignment.split_once('=').ok_or_else(|| FileError::Syntax {
            place: place.to_owned(),
            reason: format!("expected path=value, found `{assignment}`"),
        })?;
        let parsed: Result<toml::Table, _> = toml::from_str(&format!("value = {text}"));
        let value = parsed.ok().filter(|table| table.len() == 1).and_then(|mut table| table.remove("value"));
        self.set(path.trim(), value.unwrap_or_else(|| Value::String(text.trim().to_owned())), place)
    }

    /// Puts a setting under the key that it is kept by.
    pub(crate) fn put(&mut self, path: &str, value: Value, place: String, folder: &Path) -> Result<(), FileError> {
        let canonical = self.canonical_key(path, &place)?;
        self.settings.insert(canonical, Setting { value, place, folder: folder.to_owned() });
        Ok(())
    }

    /// The key by which a path is kept.
    ///
    /// # Errors
    ///
    /// [`FileError::UnknownKey`] with the nearest valid path.
    pub(crate) fn canonical_key(&self, path: &str, place: &str) -> Result<String, FileError> {
        keys::canonical(&self.registry, path).ok_or_else(|| FileError::UnknownKey {
            place: place.to_owned(),
            found: path.to_owned(),
            nearest: keys::nearest_key(&self.registry, path),
        })
    }

    /// The keys that are set, in order.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.settings.keys().map(String::as_str)
    }

    /// Takes over all settings of another file, in place of its own.
    pub fn overlay(&mut self, other: Self) {
        if other.is_sweep() {
            self.sweep = other.sweep;
            self.sweep_places = other.sweep_places;
        }
        self.settings.extend(other.settings);
    }

    /// Whether the file describes a sweep.
    #[must_use]
    pub const fn is_sweep(&self) -> bool {
        self.sweep.is_some()
    }
}

impl Default for ExperimentFile {
    fn default() -> Self {
        Self::new()
    }
}

/// The leaves of a value with their paths and places; empty tables are leaves, so that they are not lost.
fn flat(
    path: String,
    value: Value,
    spans: Option<&toml::de::DeValue<'_>>,
    start: usize,
) -> Vec<(String, Value, usize)> {
    let table = match value {
        Value::Table(table) if !table.is_empty() => table,
        leaf => return vec![(path, leaf, start)],
    };
    let spans = spans.and_then(toml::de::DeValue::as_table);
    let entries = table.into_iter().flat_map(|(key, value)| {
        let at = spans.and_then(|spans| spans.get_key_value(key.as_str()));
        let start = at.map_or(start, |(key, _)| key.span().start);
        flat(format!("{path}.{key}"), value, at.map(|(_, value)| value.get_ref()), start)
    });
    entries.collect()
}

/// Where every key within a table begins, by path.
fn starts(path: &str, table: &toml::de::DeValue<'_>) -> Vec<(String, usize)> {
    let entries = table.as_table().into_iter().flatten();
    let nested = entries.flat_map(|(key, value)| {
        let path = format!("{path}.{}", key.get_ref());
        let inner = starts(&path, value.get_ref());
        std::iter::once((path, key.span().start)).chain(inner)
    });
    nested.collect()
}

/// Where a byte of a file stands, for errors.
fn place(text: &str, name: &str, at: usize) -> String {
    format!("{name}, line {}", line(text, at))
}

/// What the parser of TOML says, with its place.
fn not_toml(error: &toml::de::Error, text: &str, name: &str) -> FileError {
    let at = error.span().map_or(0, |span| span.start);
    FileError::Syntax { place: place(text, name, at), reason: error.message().to_owned() }
}

/// The line of a byte, from 1.
fn line(text: &str, at: usize) -> usize {
    1 + text.as_bytes().iter().take(at).filter(|byte| **byte == b'\n').count()
}

#[cfg(test)]
mod tests;
