//! What a machine is built of.

use parameters::{Entry, ParameterError, ParameterInfo, ParameterTable, Value, nearest};
use pxpl5_display::{DisplayConfig, DisplayError};
use pxpl5_gp::{CodeVersion, GpTiming, HostTiming};
use pxpl5_renderer::RendererTiming;
use pxpl5_ring::RingTiming;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{NodeId, PeriodNumber};
use serde::Serialize;
use std::any::Any;
use std::collections::BTreeMap;
use std::fmt::Debug;
use thiserror::Error;

/// Boards and their numbers.
///
/// There is no default: begin with a preset, which states its source.
#[derive(Clone, Debug)]
pub struct MachineConfig {
    /// Name of the preset that it was made from.
    pub preset: String,
    /// Graphics processors, the master included.
    pub n_gps: usize,
    /// Renderer boards on the ring, each with an array of 128 x 128 pixels.
    pub n_renderers: usize,
    /// The ring's channels, clock and overhead.
    pub ring: RingTiming,
    /// Graphics processors: the times of the code that they run, where a table stands for it.
    pub gp: GpTiming,
    /// Which i860 code they run where clocks are counted (cycle level), whatever the table says; `None` for the table.
    pub code: Option<CodeVersion>,
    /// The core and the memory that this code runs on: clocks of its freezes and of its DRAM.
    pub i860: i860::Config,
    /// Clocks of the renderers' commands, their FIFO and backing store.
    pub renderer: RendererTiming,
    /// The host workstation and its link.
    pub host: HostTiming,
    /// The displays. The first is the sync generator, and what pipelines draw for.
    pub displays: Vec<Box<dyn DisplayConfig>>,
    /// Numbers of the firmware that may run on it, which the boards do not know; each table with the first part of its paths.
    pub firmware: Vec<(&'static str, Box<dyn FirmwareTable>)>,
}

/// The first part of the paths of a firmware's numbers, and what makes the table with the values of its papers.
pub type NamedTable = (&'static str, fn() -> Box<dyn FirmwareTable>);

/// A table of the numbers of some firmware.
pub trait FirmwareTable: ParameterTable + Any + Debug + Send + Sync {
    /// A copy of the numbers.
    fn boxed(&self) -> Box<dyn FirmwareTable>;
}

impl<T: ParameterTable + Clone + Debug + Send + Sync + 'static> FirmwareTable for T {
    fn boxed(&self) -> Box<dyn FirmwareTable> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn FirmwareTable> {
    fn clone(&self) -> Self {
        self.as_ref().boxed()
    }
}

impl PartialEq for MachineConfig {
    fn eq(&self, other: &Self) -> bool {
        self.preset == other.preset
            && self.code == other.code
            && self.i860.unusual_settings() == other.i860.unusual_settings()
            && self.boards() == other.boards()
            && self.displays.len() == other.displays.len()
            && self.displays.iter().zip(&other.displays).all(|(own, other)| own.equals(other.as_ref()))
            && self.telling_parameters() == other.telling_parameters()
    }
}

/// A configuration that no machine can have.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ConfigError {
    /// No preset has this name.
    #[error("there is no machine `{found}`; did you mean `{nearest}`? (`pxpl5 machines` lists all)")]
    UnknownPreset {
        /// The name asked for.
        found: String,
        /// The nearest valid name.
        nearest: &'static str,
    },
    /// A number is out of range.
    #[error("{what} must be {} to {}, found {found}", expected.0, expected.1)]
    Value {
        /// The number's path.
        what: String,
        /// Smallest and largest that the model takes.
        expected: (u64, u64),
        /// What was asked for.
        found: u64,
    },
    /// No parameter has this path.
    #[error("there is no parameter `{found}`; did you mean `{nearest}`?")]
    UnknownParameter {
        /// The path asked for.
        found: String,
        /// The nearest valid path.
        nearest: String,
    },
    /// A number is what a part is, and no machine can have another.
    #[error("{path} is {value} in every machine ({origin}); it is listed, but cannot be set")]
    ReadOnly {
        /// The number's path.
        path: String,
        /// The value that it has.
        value: Value,
        /// Where the value comes from.
        origin: &'static str,
    },
    /// A number is none that its table can take.
    #[error("{board}.{error}")]
    Parameter {
        /// The board whose table it is.
        board: String,
        /// What was expected and what was found.
        error: ParameterError,
    },
    /// A board or a pipeline refuses its numbers.
    #[error("{0}")]
    Board(String),
}

impl From<DisplayError> for ConfigError {
    fn from(error: DisplayError) -> Self {
        Self::Board(error.to_string())
    }
}

/// A parameter of a machine: its path, what is known of it and its value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// Board and field, such as `ring.word_ns`.
    pub path: String,
    /// Unit, standing, range and source.
    #[serde(flatten)]
    pub info: ParameterInfo,
    /// Its value in this machine, in the unit that its table states.
    pub value: Value,
    /// Whether it is listed only: what a part is, which nobody can set.
    pub read_only: bool,
}

impl Parameter {
    /// The numbers of a table, whose paths begin with `prefix`; `read_only` says that none of them can be set.
    pub fn of_table(prefix: &str, table: &dyn ParameterTable, read_only: bool) -> impl Iterator<Item = Self> {
        table.entries().into_iter().map(move |Entry { info, value }| {
            let path = format!("{prefix}.{}", info.name);
            Self { path, info: *info, value, read_only }
        })
    }
}

impl Parameter {
    /// Whether the sources allow the value.
    #[must_use]
    pub fn is_in_range(&self) -> bool {
        let (low, high) = self.info.range;
        (low..=high).contains(&self.value)
    }

    /// That the value is outside what the sources allow, with range and source.
    #[must_use]
    pub fn warning(&self) -> String {
        let Self { path, info, value, .. } = self;
        let (low, high) = info.range;
        let unit = info.unit;
        format!(
            "{path} = {value} {unit} is outside its range, {low} to {high} {unit} ({}: {})",
            info.standing, info.source
        )
    }
}

/// Most boards of a kind: a ring of that many is still far from 16 bits of port numbers.
const MAX_BOARDS: u64 = 1_000;

impl MachineConfig {
    /// Numbers of GPs and of renderers.
    #[must_use]
    pub fn boards(&self) -> [u64; 2] {
        [self.n_gps as u64, self.n_renderers as u64]
    }

    /// The name of the code that its processors run: `unoptimised`, `compiled`, `scheduled`, or `none`.
    #[must_use]
    pub const fn code_name(&self) -> &'static str {
        match self.code {
            Some(code) => code.name(),
            None => "none",
        }
    }

    /// All tables of numbers in order of the boards, each with the first part of its paths.
    fn tables(&self) -> Vec<(&'static str, &dyn ParameterTable)> {
        let mut all: Vec<(&'static str, &dyn ParameterTable)> = vec![("ring", &self.ring), ("gp", &self.gp)];
        all.extend(self.i860.tables());
        all.push(("renderer", &self.renderer));
        all.extend(self.displays.iter().flat_map(|display| display.tables()));
        all.push(("host", &self.host));
        all.extend(self.firmware.iter().map(|(name, table)| (*name, table.as_ref() as &dyn ParameterTable)));
        all
    }

    /// The tables whose numbers can be set.
    fn tables_mut(&mut self) -> Vec<(&'static str, &mut dyn ParameterTable)> {
        let mut all: Vec<(&'static str, &mut dyn ParameterTable)> =
            vec![("ring", &mut self.ring), ("gp", &mut self.gp)];
        all.extend(self.i860.tables_mut());
        all.push(("renderer", &mut self.renderer));
        all.extend(self.displays.iter_mut().flat_map(|display| display.tables_mut()));
        all.push(("host", &mut self.host));
        all.extend(self.firmware.iter_mut().map(|(name, table)| (*name, table.as_mut() as &mut dyn ParameterTable)));
        all
    }

    /// The parameters that tell this machine from others: all but those of firmware and of the i860 with the values of the
    /// papers. It has those of firmware without a table too, and those of the i860 had every machine before they could be set,
    /// so that names of experiments made then are the same now.
    #[must_use]
    pub fn telling_parameters(&self) -> Vec<Parameter> {
        let all = self.parameters().into_iter();
        all.filter(|parameter| parameter.value != parameter.info.papers || !self.is_implied(parameter)).collect()
    }

    /// Whether a parameter has the value of the papers in every machine that does not say otherwise.
    fn is_implied(&self, parameter: &Parameter) -> bool {
        let table = parameter.path.rsplit_once('.').map(|(table, _)| table);
        let of_i860 = self.i860.tables().map(|(name, _)| name);
        self.firmware.iter().map(|(name, _)| *name).chain(of_i860).any(|name| Some(name) == table)
    }

    /// Adds the numbers of some firmware, unless it has them already.
    pub fn add_firmware_table(&mut self, name: &'static str, table: Box<dyn FirmwareTable>) {
        if self.firmware.iter().all(|(known, _)| *known != name) {
            self.firmware.push((name, table));
        }
    }

    /// The numbers of some firmware, by their type.
    #[must_use]
    pub fn firmware_table<T: FirmwareTable>(&self) -> Option<&T> {
        self.firmware.iter().find_map(|(_, table)| (table.as_ref() as &dyn Any).downcast_ref())
    }

    /// All parameters in order of the boards.
    #[must_use]
    pub fn parameters(&self) -> Vec<Parameter> {
        let all = self.tables().into_iter();
        all.flat_map(|(path, table)| Parameter::of_table(path, table, path == i860::CHIP_PATH)).collect()
    }

    /// Parameters that differ from the preset's, by path; those of tables that the preset has not (firmware, another
    /// display) where they differ from the value that the papers give.
    #[must_use]
    pub fn overrides(&self) -> BTreeMap<String, Value> {
        let Ok(preset) = Self::preset(&self.preset) else { return BTreeMap::new() };
        let of_preset: BTreeMap<String, Value> = preset.settings().into_iter().collect();
        let of_papers: BTreeMap<String, Value> =
            self.parameters().into_iter().map(|parameter| (parameter.path, parameter.info.papers)).collect();
        let expected = |path: &String| of_preset.get(path).or_else(|| of_papers.get(path));
        self.settings().into_iter().filter(|(path, value)| expected(path) != Some(value)).collect()
    }

    /// Parameters that no source allows: outside their stated range, and not what the preset says. The model can take them, but
    /// what comes of them is a supposition.
    #[must_use]
    pub fn out_of_range(&self) -> Vec<Parameter> {
        let changed = self.overrides();
        let is_supposed = |parameter: &Parameter| !parameter.is_in_range() && changed.contains_key(&parameter.path);
        self.parameters().into_iter().filter(is_supposed).collect()
    }

    /// The numbers of boards and all parameters, by path.
    #[must_use]
    pub fn settings(&self) -> Vec<(String, Value)> {
        let [n_gps, n_renderers] = self.boards();
        let boards = [("n_gps".to_owned(), n_gps.into()), ("n_renderers".to_owned(), n_renderers.into())];
        let parameters = self.parameters().into_iter().map(|parameter| (parameter.path, parameter.value));
        boards.into_iter().chain(parameters).collect()
    }

    /// Changes a parameter by its path, such as `ring.word_ns`, `n_gps` or `n_renderers`.
    ///
    /// # Errors
    ///
    /// [`ConfigError::UnknownParameter`] with the nearest valid path; [`ConfigError::ReadOnly`] for what a part is;
    /// [`ConfigError::Parameter`] for a number that is not whole where one must be.
    pub fn set(&mut self, path: &str, value: impl Into<Value>) -> Result<(), ConfigError> {
        let value = value.into();
        match path {
            "n_gps" => self.n_gps = whole(path, value)?,
            "n_renderers" => self.n_renderers = whole(path, value)?,
            _ => return self.set_parameter(path, value),
        }
        Ok(())
    }

    fn set_parameter(&mut self, path: &str, value: Value) -> Result<(), ConfigError> {
        // The last part is the number's name; tables may have names of two parts, and numbers of the same name.
        let Some((board, name)) = path.rsplit_once('.') else { return Err(self.unknown(path)) };
        for (prefix, table) in self.tables_mut() {
            if prefix == board && table.infos().iter().any(|info| info.name == name) {
                return table.set(name, value).map_err(|error| refused(board, error));
            }
        }
        Err(self.not_settable(path))
    }

    /// Why no table that can be set has a path: it is listed only, or nobody knows it.
    fn not_settable(&self, path: &str) -> ConfigError {
        match self.parameters().into_iter().find(|parameter| parameter.path == path) {
            Some(Parameter { path, info, value, .. }) => ConfigError::ReadOnly { path, value, origin: info.source },
            None => self.unknown(path),
        }
    }

    fn unknown(&self, path: &str) -> ConfigError {
        let paths: Vec<String> = self.settings().into_iter().map(|(path, _)| path).collect();
        let nearest = nearest(path, paths.iter().map(String::as_str)).unwrap_or_default().to_owned();
        ConfigError::UnknownParameter { found: path.to_owned(), nearest }
    }

    /// The first period of the first display: for NTSC, a field.
    ///
    /// # Errors
    ///
    /// [`ConfigError::Board`] when there is no display, or none can be built of its numbers.
    pub fn period(&self) -> Result<Span, ConfigError> {
        let display = self.displays.first().ok_or_else(no_display)?;
        let nodes: Vec<NodeId> = (0..display.ports(1) as u16).map(NodeId).collect();
        Ok(display.build(&nodes)?.tick(PeriodNumber(1)).since(Time::ZERO))
    }

    /// Checks everything that can be checked before a machine is built.
    ///
    /// # Errors
    ///
    /// [`ConfigError`] names the first number that is out of range, what was expected and what was found.
    pub fn check(&self) -> Result<(), ConfigError> {
        check("n_gps", self.n_gps as u64, 1, MAX_BOARDS)?;
        check("n_renderers", self.n_renderers as u64, 1, MAX_BOARDS)?;
        for (board, table) in self.tables() {
            table.check().map_err(|error| refused(board, error))?;
        }
        if self.displays.is_empty() {
            return Err(no_display());
        }
        self.displays.iter().try_for_each(|display| Ok(display.check()?))
    }
}

/// A number of boards.
fn whole(path: &str, value: Value) -> Result<usize, ConfigError> {
    let number = value.whole().and_then(|number| usize::try_from(number).ok());
    number.ok_or_else(|| ConfigError::Board(format!("{path} must be a whole number, found {value}")))
}

fn no_display() -> ConfigError {
    ConfigError::Board("a machine needs a display; found none".to_owned())
}

fn refused(board: &str, error: ParameterError) -> ConfigError {
    ConfigError::Parameter { board: board.to_owned(), error }
}

fn check(what: &str, found: u64, low: u64, high: u64) -> Result<(), ConfigError> {
    if (low..=high).contains(&found) {
        return Ok(());
    }
    Err(ConfigError::Value { what: what.to_owned(), expected: (low, high), found })
}
#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_a_valid_machine() {
        for preset in crate::PRESETS {
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

    parameters::parameter_table! {
        /// Numbers of some firmware.
        struct Numbers {
            /// A time that may be changed.
            step_ns: 500, "ns", Assumed, 100..=900, "made up";
        }
    }

    #[test]
    fn an_override_of_a_table_that_the_preset_has_not_is_what_differs_from_the_papers() {
        let mut config = MachineConfig::small_hmd();
        config.add_firmware_table("extra", Box::new(Numbers::PAPERS));
        assert!(config.overrides().is_empty(), "{:?}", config.overrides());
        assert_eq!(config, MachineConfig::small_hmd());
        config.set("extra.step_ns", 600).expect("known");
        assert_ne!(config, MachineConfig::small_hmd());
        config.set("ring.word_ns", 51).expect("known");
        let expected = [("extra.step_ns".to_owned(), 600.into()), ("ring.word_ns".to_owned(), 51.into())];
        assert_eq!(config.overrides(), BTreeMap::from(expected));
        config.set("extra.step_ns", 500).expect("known");
        assert!(!config.overrides().contains_key("extra.step_ns"));
    }

    #[test]
    fn a_value_that_no_source_allows_is_told_with_range_and_source() {
        let mut config = MachineConfig::small_hmd();
        assert!(config.out_of_range().is_empty());
        config.set("gp.triangle_ns", 3).expect("within the limits");
        config.check().expect("the model can take it");
        let [found] = &config.out_of_range()[..] else { panic!("{:?}", config.out_of_range()) };
        let (low, high) = found.info.range;
        let text = found.warning();
        assert!(
            text.starts_with(&format!("gp.triangle_ns = 3 ns is outside its range, {low} to {high} ns (")),
            "{text}"
        );
        assert!(text.contains(found.info.source), "{text}");
        let inside = low.whole().expect("nanoseconds are whole");
        config.set("gp.triangle_ns", inside).expect("known");
        assert!(config.out_of_range().is_empty());
    }

    #[test]
    fn no_preset_is_warned_of() {
        for preset in crate::PRESETS {
            let config = MachineConfig::preset(preset.name).expect("it is listed");
            assert!(config.out_of_range().is_empty(), "{}: {:?}", preset.name, config.out_of_range());
        }
    }

    #[test]
    fn no_renderer_is_refused_with_what_was_expected() {
        let config = MachineConfig { n_renderers: 0, ..MachineConfig::small_hmd() };
        let error = config.check().expect_err("none");
        assert_eq!(error.to_string(), "n_renderers must be 1 to 1000, found 0");
    }
}
