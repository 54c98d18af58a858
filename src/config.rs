//! What a machine is built of, and the presets of the papers.

use parameters::{ParameterInfo, ParameterTable};
use pxpl5_framebuffer::FrameBufferConfig;
use pxpl5_gp::{CodeVersion, GpTiming, HostTiming};
use pxpl5_renderer::RendererTiming;
use pxpl5_ring::RingTiming;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// Boards and their numbers.
///
/// There is no default: begin with a preset, which states its source.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MachineConfig {
    /// Name of the preset that it was made from.
    pub preset: String,
    /// Graphics processors, the master included.
    pub n_gps: usize,
    /// Renderers.
    pub n_renderers: usize,
    /// The ring.
    pub ring: RingTiming,
    /// Graphics processors and the times of the code that they run.
    pub gp: GpTiming,
    /// The i860 code that tells those times at the level of cycles; `None` has the table tell them there too.
    pub code: Option<CodeVersion>,
    /// Renderers.
    pub renderer: RendererTiming,
    /// Frame buffers and video.
    pub frame_buffer: FrameBufferConfig,
    /// The host workstation.
    pub host: HostTiming,
}

/// A preset: name, what it is, where it comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Preset {
    /// Name on the command line.
    pub name: &'static str,
    /// What it is and its source.
    pub about: &'static str,
    n_gps: usize,
    n_renderers: usize,
    #[serde(skip)]
    gp: GpTiming,
    #[serde(skip)]
    code: CodeVersion,
}

/// All presets.
pub const PRESETS: [Preset; 7] = [
    Preset {
        name: "small-hmd",
        about: "13 GPs (1 master, 12 slaves), 5 renderers: the machine of the Rendering Control measurements (TR94)",
        n_gps: 13,
        n_renderers: 5,
        gp: GpTiming::PAPERS,
        code: CodeVersion::Scheduled,
    },
    Preset {
        name: "slats",
        about: "1 GP, 5 renderers, code of 1994 (TR94)",
        n_gps: 1,
        n_renderers: 5,
        gp: GpTiming::SLATS_1994,
        code: CodeVersion::Compiled,
    },
    Preset {
        name: "slats-1995",
        about: "1 GP, 5 renderers, code of 1995 (I3D95)",
        n_gps: 1,
        n_renderers: 5,
        gp: GpTiming::SLATS_1995,
        code: CodeVersion::Compiled,
    },
    Preset {
        name: "slats-optimised",
        about: "1 GP, 5 renderers, code of 1994 at a third of the time per triangle (I3D95: what fitting the cache gives)",
        n_gps: 1,
        n_renderers: 5,
        gp: GpTiming::SLATS_OPTIMISED,
        code: CodeVersion::Scheduled,
    },
    Preset {
        name: "medium",
        about: "24 GPs, 10 renderers: a middle-sized configuration (assumed)",
        n_gps: 24,
        n_renderers: 10,
        gp: GpTiming::PAPERS,
        code: CodeVersion::Scheduled,
    },
    Preset {
        name: "design-maximum",
        about: "32 GPs, 16 renderers: the design maximum (F89)",
        n_gps: 32,
        n_renderers: 16,
        gp: GpTiming::PAPERS,
        code: CodeVersion::Scheduled,
    },
    Preset {
        name: "large",
        about: "50 GPs, 20 renderers: the largest number of GPs published (I3D95)",
        n_gps: 50,
        n_renderers: 20,
        gp: GpTiming::PAPERS,
        code: CodeVersion::Scheduled,
    },
];

/// A configuration that no machine can have.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ConfigError {
    /// No preset has this name.
    UnknownPreset {
        /// The name asked for.
        found: String,
        /// The nearest valid name.
        nearest: &'static str,
    },
    /// A number is out of range.
    Value {
        /// The number's path.
        what: String,
        /// Smallest and largest that the model takes.
        expected: (u64, u64),
        /// What was asked for.
        found: u64,
    },
    /// No parameter has this path.
    UnknownParameter {
        /// The path asked for.
        found: String,
        /// The nearest valid path.
        nearest: String,
    },
    /// A board refuses its numbers.
    Board(String),
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownPreset { found, nearest } => {
                write!(f, "there is no machine `{found}`; did you mean `{nearest}`? (`pxpl5 machines` lists all)")
            }
            Self::Value { what, expected: (low, high), found } => {
                write!(f, "{what} must be {low} to {high}, found {found}")
            }
            Self::UnknownParameter { found, nearest } => {
                write!(f, "there is no parameter `{found}`; did you mean `{nearest}`?")
            }
            Self::Board(text) => f.write_str(text),
        }
    }
}

impl std::error::Error for ConfigError {}

/// A parameter of a machine: its path, what is known of it and its value.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Parameter {
    /// Board and field, such as `ring.word_ns`.
    pub path: String,
    /// Unit, standing, range and source.
    #[serde(flatten)]
    pub info: ParameterInfo,
    /// The value.
    pub value: u64,
}

/// Most boards of a kind: a ring of that many is still far from 16 bits of port numbers.
const MAX_BOARDS: u64 = 1_000;

impl MachineConfig {
    /// The machine of a preset.
    ///
    /// # Errors
    ///
    /// [`ConfigError::UnknownPreset`] with the nearest valid name.
    pub fn preset(name: &str) -> Result<Self, ConfigError> {
        let preset = PRESETS.iter().find(|preset| preset.name == name).ok_or_else(|| ConfigError::UnknownPreset {
            found: name.to_owned(),
            nearest: nearest(name, PRESETS.iter().map(|preset| preset.name)).unwrap_or_default(),
        })?;
        Ok(Self::of(preset))
    }

    fn of(preset: &Preset) -> Self {
        Self {
            preset: preset.name.to_owned(),
            n_gps: preset.n_gps,
            n_renderers: preset.n_renderers,
            ring: RingTiming::PAPERS,
            gp: preset.gp,
            code: Some(preset.code),
            renderer: RendererTiming::PAPERS,
            frame_buffer: FrameBufferConfig::NTSC,
            host: HostTiming::PAPERS,
        }
    }

    /// The machine of the Rendering Control measurements: 13 GPs, 5 renderers (TR94).
    #[must_use]
    pub fn small_hmd() -> Self {
        Self::of(&PRESETS[0])
    }

    /// The machine of the Slats prototype: 1 GP, 5 renderers (TR94).
    #[must_use]
    pub fn slats() -> Self {
        Self::of(&PRESETS[1])
    }

    /// All parameters in order of the boards.
    #[must_use]
    pub fn parameters(&self) -> Vec<Parameter> {
        let mut all = Vec::new();
        list(&mut all, "ring", &self.ring);
        list(&mut all, "gp", &self.gp);
        list(&mut all, "renderer", &self.renderer);
        list(&mut all, "video", &self.frame_buffer.video);
        list(&mut all, "frame_buffer", &self.frame_buffer.port);
        list(&mut all, "host", &self.host);
        all
    }

    /// Parameters that differ from the preset's, by path.
    #[must_use]
    pub fn overrides(&self) -> BTreeMap<String, u64> {
        let Ok(preset) = Self::preset(&self.preset) else { return BTreeMap::new() };
        let boards = [("n_gps", self.n_gps, preset.n_gps), ("n_renderers", self.n_renderers, preset.n_renderers)];
        let boards = boards.into_iter().filter(|(_, own, other)| own != other);
        let boards = boards.map(|(path, own, _)| (path.to_owned(), own as u64));
        let pairs = self.parameters().into_iter().zip(preset.parameters());
        let changed = pairs.filter(|(own, other)| own.value != other.value);
        boards.chain(changed.map(|(own, _)| (own.path, own.value))).collect()
    }

    /// Changes a parameter by its path, such as `ring.word_ns`, `n_gps` or `n_renderers`.
    ///
    /// # Errors
    ///
    /// [`ConfigError::UnknownParameter`] with the nearest valid path.
    pub fn set(&mut self, path: &str, value: u64) -> Result<(), ConfigError> {
        let table: &mut dyn ParameterTable = match path.split_once('.') {
            None if path == "n_gps" => return assign(&mut self.n_gps, value),
            None if path == "n_renderers" => return assign(&mut self.n_renderers, value),
            Some(("ring", _)) => &mut self.ring,
            Some(("gp", _)) => &mut self.gp,
            Some(("renderer", _)) => &mut self.renderer,
            Some(("video", _)) => &mut self.frame_buffer.video,
            Some(("frame_buffer", _)) => &mut self.frame_buffer.port,
            Some(("host", _)) => &mut self.host,
            _ => return Err(self.unknown(path)),
        };
        let name = path.split_once('.').map_or("", |(_, name)| name);
        table.set(name, value.into()).map_err(|_| self.unknown(path))
    }

    fn unknown(&self, path: &str) -> ConfigError {
        let paths: Vec<_> =
            self.parameters().into_iter().map(|p| p.path).chain(["n_gps".into(), "n_renderers".into()]).collect();
        let nearest = nearest(path, paths.iter().map(String::as_str)).unwrap_or_default().to_owned();
        ConfigError::UnknownParameter { found: path.to_owned(), nearest }
    }

    /// Checks everything that can be checked before a machine is built.
    ///
    /// # Errors
    ///
    /// [`ConfigError`] names the first number that is out of range, what was expected and what was found.
    pub fn check(&self) -> Result<(), ConfigError> {
        check("n_gps", self.n_gps as u64, 1, MAX_BOARDS)?;
        check("n_renderers", self.n_renderers as u64, 1, MAX_BOARDS)?;
        // The longest command, shading, must fit into the input FIFO.
        check("renderer.fifo_words", self.renderer.fifo_words, 128, 1 << 20)?;
        check("renderer.clock_hz", self.renderer.clock_hz, 1_000, 1_000_000_000_000)?;
        check("host.link_bytes_per_s", self.host.link_bytes_per_s, 1_000, 1_000_000_000_000)?;
        check("host.view_period_ns", self.host.view_period_ns, 1_000, 1_000_000_000_000)?;
        for parameter in self.parameters().iter().filter(|p| matches!(p.info.unit, "ns" | "clocks")) {
            check(&parameter.path, parameter.value, 0, 1_000_000_000_000)?;
        }
        self.frame_buffer.check().map_err(|error| ConfigError::Board(format!("frame buffer: {error}")))
    }
}

fn list(all: &mut Vec<Parameter>, board: &str, table: &dyn ParameterTable) {
    all.extend(table.entries().into_iter().map(|entry| Parameter {
        path: format!("{board}.{}", entry.info.name),
        info: *entry.info,
        value: entry.value.whole().unwrap_or_default(),
    }));
}

fn assign(field: &mut usize, value: u64) -> Result<(), ConfigError> {
    *field = usize::try_from(value).unwrap_or(usize::MAX);
    Ok(())
}

fn check(what: &str, found: u64, low: u64, high: u64) -> Result<(), ConfigError> {
    if (low..=high).contains(&found) {
        return Ok(());
    }
    Err(ConfigError::Value { what: what.to_owned(), expected: (low, high), found })
}

/// The candidate with the fewest single-letter changes to `name`.
pub(crate) fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    candidates.min_by_key(|candidate| edit_distance(name, candidate))
}

fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().take(64).collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().take(64).enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, to) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(from != *to);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_a_valid_machine() {
        for preset in PRESETS {
            MachineConfig::preset(preset.name).expect("it is listed").check().expect(preset.name);
        }
    }

    #[test]
    fn an_unknown_preset_names_the_nearest() {
        let error = MachineConfig::preset("smal-hmd").expect_err("misspelt");
        assert!(error.to_string().contains("did you mean `small-hmd`?"), "{error}");
    }

    #[test]
    fn parameters_are_reached_by_path_and_a_wrong_path_names_the_nearest() {
        let mut config = MachineConfig::small_hmd();
        config.set("gp.triangle_ns", 30_000).expect("known");
        config.set("n_gps", 24).expect("known");
        assert_eq!((config.gp.triangle_ns, config.n_gps), (30_000, 24));
        let error = config.set("gp.triange_ns", 1).expect_err("misspelt");
        assert!(error.to_string().contains("`gp.triangle_ns`"), "{error}");
    }

    #[test]
    fn no_renderer_is_refused_with_what_was_expected() {
        let config = MachineConfig { n_renderers: 0, ..MachineConfig::small_hmd() };
        let error = config.check().expect_err("none");
        assert_eq!(error.to_string(), "n_renderers must be 1 to 1000, found 0");
    }
}
