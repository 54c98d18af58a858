use pxpl5_gp::{CodeVersion, GpTiming, HostTiming};
use pxpl5_renderer::RendererTiming;
use pxpl5_ring::RingTiming;
use pxpl5_sim::parameters::{
    self, Parameter, ParameterInfo, ParameterTable, Provenance, SettingError, Value, table_at,
};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::display::DisplayConfig;
use pxpl5_wire::{NodeId, PeriodNumber};
use std::any::Any;
use std::collections::BTreeMap;
use std::fmt::Debug;

/// The boards of a machine and all their timing parameters.
///
/// The type does not implement `Default`. Every configuration starts from a preset, which states its sources.
#[derive(Clone, Debug)]
pub struct MachineConfig {
    /// Name of the preset that this configuration started from.
    pub preset: String,
    /// Number of graphics processors, including the master.
    pub n_gps: usize,
    /// Number of renderer boards on the ring, each with an array of 128 x 128 pixels.
    pub n_renderers: usize,
    /// Timing of the ring: number of channels, clock and overhead.
    pub ring: RingTiming,
    /// Times of the graphics processors' work, for runs without i860 code.
    pub gp: GpTiming,
    /// Version of the i860 code that the graphics processors execute at the cycle level. With `None`, the times come
    /// from `gp` instead.
    pub code: Option<CodeVersion>,
    /// Clocks of the i860 and of its memory at the cycle level.
    pub i860: i860::Config,
    /// Clocks of the renderers' commands, and sizes of their memories.
    pub renderer: RendererTiming,
    /// Timing of the host workstation and its link to the ring.
    pub host: HostTiming,
    /// The displays. The first display generates the retrace signal, and pipelines draw for this display.
    pub displays: Vec<Box<dyn DisplayConfig>>,
    /// Timing tables of pipelines, each with the first part of its parameter paths, such as `jitp`.
    pub firmware: Vec<(&'static str, Box<dyn FirmwareTable>)>,
}

/// The first part of a table's parameter paths, and a function that returns the table with the values of the papers.
pub type NamedTable = (&'static str, fn() -> Box<dyn FirmwareTable>);

/// A timing table of a pipeline, which a [`MachineConfig`] can store.
pub trait FirmwareTable: ParameterTable + Any + Debug + Send + Sync {
    /// Returns a copy of the table.
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
            && self.identifying_parameters() == other.identifying_parameters()
    }
}

/// Largest number of boards of one kind. With this limit, 16-bit port numbers suffice for all boards.
const MAX_BOARDS: u64 = 1_000;

impl MachineConfig {
    /// Returns the numbers of graphics processors and of renderers, in this order.
    pub fn boards(&self) -> [u64; 2] {
        [self.n_gps as u64, self.n_renderers as u64]
    }

    /// Returns the name of the i860 code: `unoptimised`, `compiled`, `scheduled`, or `none`.
    pub const fn code_name(&self) -> &'static str {
        match self.code {
            Some(code) => code.name(),
            None => "none",
        }
    }

    fn tables(&self) -> Vec<(&'static str, &dyn ParameterTable)> {
        let mut all: Vec<(&'static str, &dyn ParameterTable)> = vec![("ring", &self.ring), ("gp", &self.gp)];
        all.extend(self.i860.tables());
        all.push(("renderer", &self.renderer));
        all.extend(self.displays.iter().flat_map(|display| display.tables()));
        all.push(("host", &self.host));
        all.extend(self.firmware.iter().map(|(name, table)| (*name, table.as_ref() as &dyn ParameterTable)));
        all
    }

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

    /// Returns the parameters that identify this machine in the names of experiments.
    ///
    /// Parameters of pipelines and of the i860 are omitted if they have the values of the papers. Older versions could
    /// not change them, so names of old experiments do not contain them.
    pub fn identifying_parameters(&self) -> Vec<Parameter> {
        let all = self.parameters().into_iter();
        all.filter(|parameter| parameter.value != parameter.info.papers || !self.is_implied(parameter)).collect()
    }

    fn is_implied(&self, parameter: &Parameter) -> bool {
        let table = parameter.path.rsplit_once('.').map(|(table, _)| table);
        let of_i860 = self.i860.tables().map(|(name, _)| name);
        self.firmware.iter().map(|(name, _)| *name).chain(of_i860).any(|name| Some(name) == table)
    }

    /// Adds the timing table of a pipeline, unless the configuration already has a table of this name.
    pub fn add_firmware_table(&mut self, name: &'static str, table: Box<dyn FirmwareTable>) {
        if self.firmware.iter().all(|(known, _)| *known != name) {
            self.firmware.push((name, table));
        }
    }

    /// Returns the timing table of a pipeline that has the type `T`.
    pub fn firmware_table<T: FirmwareTable>(&self) -> Option<&T> {
        self.firmware.iter().find_map(|(_, table)| (table.as_ref() as &dyn Any).downcast_ref())
    }

    /// Returns all parameters in the order of the boards.
    pub fn parameters(&self) -> Vec<Parameter> {
        let all = self.tables().into_iter();
        let all = all.flat_map(|(path, table)| Parameter::of_table(path, table, path == i860::CHIP_PATH));
        all.map(|mut parameter| {
            let name = parameter.path.strip_prefix("gp.");
            if let Some(source) = name.and_then(|name| GpTiming::source_of(name, parameter.value)) {
                parameter.info = ParameterInfo { provenance: Provenance::Derived, source, ..parameter.info };
            }
            parameter
        })
        .collect()
    }

    /// Returns the parameters that differ from the preset, by path.
    ///
    /// If the preset lacks the table of a parameter, the parameter is compared with the value of the papers.
    pub fn overrides(&self) -> BTreeMap<String, Value> {
        let Ok(preset) = Self::preset(&self.preset) else { return BTreeMap::new() };
        let of_preset: BTreeMap<String, Value> = preset.settings().into_iter().collect();
        let of_papers: BTreeMap<String, Value> =
            self.parameters().into_iter().map(|parameter| (parameter.path, parameter.info.papers)).collect();
        let expected = |path: &String| of_preset.get(path).or_else(|| of_papers.get(path));
        self.settings().into_iter().filter(|(path, value)| expected(path) != Some(value)).collect()
    }

    /// Returns the changed parameters whose values lie outside the range that the sources support. The model accepts
    /// such values.
    pub fn out_of_range(&self) -> Vec<Parameter> {
        let changed = self.overrides();
        let is_supposed = |parameter: &Parameter| !parameter.is_in_range() && changed.contains_key(&parameter.path);
        self.parameters().into_iter().filter(is_supposed).collect()
    }

    /// Returns the numbers of boards and the values of all parameters, each with its path.
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
    /// Returns a [`SettingError`] if the path is unknown, if the parameter is a fixed property of a chip, or if the
    /// value has a fraction where an integer is expected.
    pub fn set(&mut self, path: &str, value: impl Into<Value>) -> Result<(), SettingError> {
        let value = value.into();
        match path {
            "n_gps" => self.n_gps = whole(path, value)?,
            "n_renderers" => self.n_renderers = whole(path, value)?,
            _ => return self.set_parameter(path, value),
        }
        Ok(())
    }

    fn set_parameter(&mut self, path: &str, value: Value) -> Result<(), SettingError> {
        match table_at(self.tables_mut(), path) {
            Some((prefix, table, name)) => table.set(name, value).map_err(|error| error.in_table(prefix)),
            None => Err(self.not_settable(path)),
        }
    }

    fn not_settable(&self, path: &str) -> SettingError {
        match self.parameters().into_iter().find(|parameter| parameter.path == path) {
            Some(Parameter { path, info, value, .. }) => SettingError::read_only(&path, value, info.source),
            None => self.unknown(path),
        }
    }

    fn unknown(&self, path: &str) -> SettingError {
        SettingError::unknown_path("parameter", path, self.settings().into_iter().map(|(path, _)| path))
    }

    /// Returns the duration of the first display's first period. For NTSC, a period is one field.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the machine has no display or the display's parameters are invalid.
    pub fn period(&self) -> Result<Span, SettingError> {
        let display = self.displays.first().ok_or_else(no_display)?;
        let nodes: Vec<NodeId> = (0..display.ports(1) as u16).map(NodeId).collect();
        Ok(display.build(&nodes, self.ring.word())?.tick(PeriodNumber(1)).since(Time::ZERO))
    }

    /// Checks all numbers of boards, parameter tables and displays before a machine is built.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] with the first invalid value and the expected values.
    pub fn check(&self) -> Result<(), SettingError> {
        parameters::check("n_gps", self.n_gps as u64, (1, MAX_BOARDS))?;
        parameters::check("n_renderers", self.n_renderers as u64, (1, MAX_BOARDS))?;
        for (board, table) in self.tables() {
            table.check().map_err(|error| error.in_table(board))?;
        }
        if self.displays.is_empty() {
            return Err(no_display());
        }
        self.check_channels()?;
        self.displays.iter().try_for_each(|display| display.check())
    }
}

impl MachineConfig {
    /// Returns the machine with `n_gps` graphics processors, including the master.
    #[must_use]
    pub fn with_gps(self, n_gps: usize) -> Self {
        Self { n_gps, ..self }
    }

    /// Returns the machine with `n_renderers` renderers.
    #[must_use]
    pub fn with_renderers(self, n_renderers: usize) -> Self {
        Self { n_renderers, ..self }
    }

    /// Returns the machine with `display` in place of all displays.
    #[must_use]
    pub fn with_display(self, display: impl DisplayConfig + 'static) -> Self {
        Self { displays: vec![Box::new(display)], ..self }
    }

    /// Returns an error for a ring in which commands for full renderer FIFOs can occupy all channels.
    ///
    /// A renderer empties its FIFO only after it has sent pixels, so the machine could then deadlock. Three limits
    /// apply to the number of these channels: `fifo_channels`, the number of renderers, and `source_channels` for each
    /// graphics processor.
    fn check_channels(&self) -> Result<(), SettingError> {
        let RingTiming { channels, fifo_channels, source_channels, .. } = self.ring;
        let sent = source_channels.saturating_mul(self.n_gps as u64);
        let held = fifo_channels.min(self.n_renderers as u64).min(sent);
        if held < channels {
            return Ok(());
        }
        let possible = match channels {
            0 | 1 => format!("ring.channels {}", held + 1),
            _ => format!("ring.fifo_channels {} or ring.channels {}", channels - 1, held + 1),
        };
        Err(SettingError::combination(format_args!(
            "ring.channels {channels} with ring.fifo_channels {fifo_channels} and {} renderers: commands for full FIFOs could hold all channels, and \
             no pixels would leave the renderers; nearest possible: {possible}",
            self.n_renderers
        )))
    }
}

fn whole(path: &str, value: Value) -> Result<usize, SettingError> {
    let number = value.whole().and_then(|number| usize::try_from(number).ok());
    number.ok_or_else(|| SettingError::not_whole(path, value))
}

fn no_display() -> SettingError {
    SettingError::combination("a machine needs a display; found none")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_is_refused_if_full_fifos_can_block_all_of_its_channels() {
        let machine = |channels: u64, fifo_channels: u64, renderers: u64| {
            let mut machine = MachineConfig::small_hmd();
            machine.set("ring.channels", channels).expect("in range");
            machine.set("ring.fifo_channels", fifo_channels).expect("in range");
            machine.set("n_renderers", renderers).expect("in range");
            machine.check()
        };
        let error = machine(2, 6, 5).expect_err("five renderers").to_string();
        assert!(error.ends_with("nearest possible: ring.fifo_channels 1 or ring.channels 6"), "{error}");
        let error = machine(1, 1, 5).expect_err("one channel").to_string();
        assert!(error.ends_with("nearest possible: ring.channels 2"), "{error}");
        for (channels, fifo_channels, renderers) in [(2, 1, 5), (6, 6, 5), (2, 6, 1), (8, 6, 20)] {
            assert_eq!(machine(channels, fifo_channels, renderers), Ok(()), "{channels} {fifo_channels} {renderers}");
        }
    }

    #[test]
    fn every_preset_is_a_valid_machine() {
        for preset in crate::PRESETS {
            MachineConfig::preset(preset.name).expect("it is listed").check().expect(preset.name);
        }
    }

    pxpl5_sim::parameters::parameter_table! {
        struct Numbers {
            /// A time that is only used in this test.
            step_ns: 500, "ns", Assumed, 100..=900, "made up";
        }
    }

    #[test]
    fn an_override_of_a_table_missing_from_the_preset_is_listed_as_a_difference() {
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
    fn no_preset_causes_a_warning() {
        for preset in crate::PRESETS {
            let config = MachineConfig::preset(preset.name).expect("it is listed");
            assert!(config.out_of_range().is_empty(), "{}: {:?}", preset.name, config.out_of_range());
        }
    }
}
