//! Registry of pipelines and displays. Code that offers, reads or compares pipelines iterates over a [`Registry`].

use crate::error::ExperimentError;
use crate::experiment::{Estimates, Experiment};
use crate::keys::{Key, PipelineSettings};
use crate::pipeline::Pipeline;
use crate::summary::Summary;
use parameters::nearest;
use pxpl5_display::DisplayConfig;
use pxpl5_machine::{MachineConfig, NamedTable};
use serde::Serialize;
use std::sync::Arc;

/// Condition under which a pipeline draws a scene in time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Goal {
    /// Every picture that is due is shown in time.
    NoMissedRetrace,
    /// At least this number of updates a second, in the rounded rates of the papers: 30 stands for 29.97 Hz of NTSC,
    /// and 60 for 59.94 Hz.
    RateHz(f64),
    /// A mean latency of at most this number of fields.
    LatencyFields(f64),
}

/// Kind of triangles in the growing scene of a limit search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum TestScene {
    /// Triangles that cover the whole screen.
    FullScreen,
    /// Small triangles spread over the screen. Their size touches 1.3 regions an eye on average (TR94).
    Typical,
}

impl TestScene {
    /// All kinds of triangles, the larger first.
    pub const ALL: [Self; 2] = [Self::FullScreen, Self::Typical];

    /// Returns the name on the command line and in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::FullScreen => "full-screen",
            Self::Typical => "typical",
        }
    }
}

/// Criterion by which the largest number of triangles that a pipeline draws in time is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitCriterion {
    /// Condition that every scene within the limit must meet.
    pub goal: Goal,
    /// Kind of triangles in the growing scene.
    pub scene: TestScene,
    /// Number of fields to simulate for each size, enough to reach a steady state.
    pub fields: u64,
}

/// The closed form of a pipeline: an experiment without events.
#[derive(Clone, Copy, Debug)]
pub struct ClosedForm {
    /// Function that returns the summary of an experiment.
    pub summary: fn(&Experiment) -> Result<Summary, ExperimentError>,
    /// Functions that return estimates for an experiment.
    pub estimates: Estimates,
}

/// Description of a pipeline in the registry.
#[derive(Clone, Copy, Debug)]
pub struct PipelineEntry {
    /// Name in experiment files and on the command line.
    pub name: &'static str,
    /// Name of the family, which all variants of the pipeline share.
    pub family: &'static str,
    /// Description with the place of publication, in a line.
    pub about: &'static str,
    /// Preset of the machine on which the papers ran the pipeline, or could have run it.
    pub preset: &'static str,
    /// Keys of the pipeline, with values, help and ranges.
    pub keys: &'static [Key],
    /// Function that builds the pipeline from its settings. Keys that are not set have the values of the papers.
    pub build: fn(&PipelineSettings) -> Arc<dyn Pipeline>,
    /// Function that returns the criterion for the largest scene, for the given settings.
    pub limit: fn(&PipelineSettings) -> LimitCriterion,
    /// Tables of the firmware's numbers. Each table has a name that begins the paths of its parameters, such as `jitp`.
    pub tables: &'static [NamedTable],
    /// Closed form, or `None` if the pipeline has none.
    pub closed_form: Option<ClosedForm>,
    /// True if the command `compare` has a row for the pipeline.
    pub compared: bool,
}

/// Description of a display in the registry.
#[derive(Clone, Copy, Debug)]
pub struct DisplayEntry {
    /// Name in experiment files and on the command line.
    pub name: &'static str,
    /// Function that returns the configuration from the papers.
    pub config: fn() -> Box<dyn DisplayConfig>,
}

/// All known pipelines and displays.
#[derive(Clone, Debug)]
pub struct Registry {
    pipelines: Vec<PipelineEntry>,
    displays: Vec<DisplayEntry>,
}

impl Registry {
    /// Creates a registry with the given pipelines and displays. More can be added later.
    #[must_use]
    pub const fn with(pipelines: Vec<PipelineEntry>, displays: Vec<DisplayEntry>) -> Self {
        Self { pipelines, displays }
    }

    /// Adds the firmware tables of all pipelines to a machine.
    #[must_use]
    pub fn machine_of(&self, config: MachineConfig) -> MachineConfig {
        let mut config = config;
        for entry in &self.pipelines {
            entry.tables.iter().for_each(|(name, table)| config.add_firmware_table(name, table()));
        }
        config
    }

    /// Adds a pipeline. A pipeline with the same name is replaced.
    pub fn add(&mut self, entry: PipelineEntry) {
        match self.pipelines.iter_mut().find(|known| known.name == entry.name) {
            Some(known) => *known = entry,
            None => self.pipelines.push(entry),
        }
    }

    /// Adds a display. A display with the same name is replaced.
    pub fn add_display(&mut self, entry: DisplayEntry) {
        match self.displays.iter_mut().find(|known| known.name == entry.name) {
            Some(known) => *known = entry,
            None => self.displays.push(entry),
        }
    }

    /// Sets the closed form of all pipelines of a family.
    pub fn closed_form(&mut self, family: &str, form: ClosedForm) {
        let of_family = self.pipelines.iter_mut().filter(|entry| entry.family == family);
        of_family.for_each(|entry| entry.closed_form = Some(form));
    }

    /// Returns all pipelines, in the order in which they were added.
    #[must_use]
    pub fn pipelines(&self) -> &[PipelineEntry] {
        &self.pipelines
    }

    /// Returns all displays, in the order in which they were added.
    #[must_use]
    pub fn displays(&self) -> &[DisplayEntry] {
        &self.displays
    }

    /// Returns the pipeline with a name.
    ///
    /// # Errors
    ///
    /// The nearest valid name, if no pipeline has the name.
    pub fn pipeline(&self, name: &str) -> Result<&PipelineEntry, &'static str> {
        let found = self.pipelines.iter().find(|entry| entry.name == name);
        found.ok_or_else(|| nearest(name, self.pipelines.iter().map(|entry| entry.name)).unwrap_or_default())
    }

    /// Returns the display with a name.
    ///
    /// # Errors
    ///
    /// The nearest valid name, if no display has the name.
    pub fn display(&self, name: &str) -> Result<&DisplayEntry, &'static str> {
        let found = self.displays.iter().find(|entry| entry.name == name);
        found.ok_or_else(|| nearest(name, self.displays.iter().map(|entry| entry.name)).unwrap_or_default())
    }

    /// Returns the keys of all pipelines, each once, with the families that have the key.
    #[must_use]
    pub fn keys(&self) -> Vec<(Key, Vec<&'static str>)> {
        let mut all: Vec<(Key, Vec<&'static str>)> = Vec::new();
        for entry in &self.pipelines {
            for key in entry.keys {
                match all.iter_mut().find(|(known, _)| known.name == key.name) {
                    Some((_, families)) if families.contains(&entry.family) => {}
                    Some((_, families)) => families.push(entry.family),
                    None => all.push((*key, vec![entry.family])),
                }
            }
        }
        all
    }
}
