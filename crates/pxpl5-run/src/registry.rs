//! Which pipelines and displays there are. Whoever offers, reads, compares or limits them iterates over a [`Registry`].

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

/// What must hold when a pipeline is said to draw a scene in time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Goal {
    /// Every picture that is due is shown in time.
    NoMissedRetrace,
    /// At least so many updates per second, counted as the papers count: 30 and 60 stand for NTSC's 29.97 and 59.94.
    RateHz(f64),
    /// A mean latency of at most so many fields.
    LatencyFields(f64),
}

/// What the scene of a limit is made of as it grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum TestScene {
    /// Triangles that cover the whole screen.
    FullScreen,
    /// Small triangles spread over the screen, of a size that touches 1.3 regions an eye on average (TR94).
    Typical,
}

impl TestScene {
    /// Both kinds of triangles, the larger first.
    pub const ALL: [Self; 2] = [Self::FullScreen, Self::Typical];

    /// Its name on the command line and in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::FullScreen => "full-screen",
            Self::Typical => "typical",
        }
    }
}

/// How the most triangles that a pipeline draws in time are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitCriterion {
    /// What must hold for every size that counts as reached.
    pub goal: Goal,
    /// What the scene is made of as it grows.
    pub scene: TestScene,
    /// Fields that each size is simulated for: enough to show a steady state.
    pub fields: u64,
}

/// The closed form of a pipeline: an experiment without events.
#[derive(Clone, Copy, Debug)]
pub struct ClosedForm {
    /// What comes of an experiment.
    pub summary: fn(&Experiment) -> Result<Summary, ExperimentError>,
    /// What else it can say of an experiment.
    pub estimates: Estimates,
}

/// A pipeline as everybody finds it.
#[derive(Clone, Copy, Debug)]
pub struct PipelineEntry {
    /// Its name in experiment files and on the command line.
    pub name: &'static str,
    /// The name that it shares with its variants.
    pub family: &'static str,
    /// What it is and where it was published, in a line.
    pub about: &'static str,
    /// The preset of the machine on which its papers ran it, or could have.
    pub preset: &'static str,
    /// The keys that only it takes, with values, help and range.
    pub keys: &'static [Key],
    /// Makes it of its keys; those not given have the values of its papers.
    pub build: fn(&PipelineSettings) -> Arc<dyn Pipeline>,
    /// When it is said to draw a scene in time, with the keys given.
    pub limit: fn(&PipelineSettings) -> LimitCriterion,
    /// Tables of its firmware's own numbers, each with the first part of their paths, such as `jitp`.
    pub tables: &'static [NamedTable],
    /// Its closed form, if it has one.
    pub closed_form: Option<ClosedForm>,
    /// Whether `compare` has a row of it.
    pub compared: bool,
}

/// A display as everybody finds it.
#[derive(Clone, Copy, Debug)]
pub struct DisplayEntry {
    /// Its name in experiment files and on the command line.
    pub name: &'static str,
    /// The numbers of its papers.
    pub config: fn() -> Box<dyn DisplayConfig>,
}

/// The pipelines and displays that are known.
#[derive(Clone, Debug)]
pub struct Registry {
    pipelines: Vec<PipelineEntry>,
    displays: Vec<DisplayEntry>,
}

impl Registry {
    /// With these; more may be added.
    #[must_use]
    pub const fn with(pipelines: Vec<PipelineEntry>, displays: Vec<DisplayEntry>) -> Self {
        Self { pipelines, displays }
    }

    /// A machine with the numbers of every pipeline's firmware beside those of its boards.
    #[must_use]
    pub fn machine_of(&self, config: MachineConfig) -> MachineConfig {
        let mut config = config;
        for entry in &self.pipelines {
            entry.tables.iter().for_each(|(name, table)| config.add_firmware_table(name, table()));
        }
        config
    }

    /// Adds a pipeline, or puts it in the place of the one of the same name.
    pub fn add(&mut self, entry: PipelineEntry) {
        match self.pipelines.iter_mut().find(|known| known.name == entry.name) {
            Some(known) => *known = entry,
            None => self.pipelines.push(entry),
        }
    }

    /// Adds a display, or puts it in the place of the one of the same name.
    pub fn add_display(&mut self, entry: DisplayEntry) {
        match self.displays.iter_mut().find(|known| known.name == entry.name) {
            Some(known) => *known = entry,
            None => self.displays.push(entry),
        }
    }

    /// Says the closed form of a family.
    pub fn closed_form(&mut self, family: &str, form: ClosedForm) {
        let of_family = self.pipelines.iter_mut().filter(|entry| entry.family == family);
        of_family.for_each(|entry| entry.closed_form = Some(form));
    }

    /// All pipelines, in the order in which they were added.
    #[must_use]
    pub fn pipelines(&self) -> &[PipelineEntry] {
        &self.pipelines
    }

    /// All displays, in the order in which they were added.
    #[must_use]
    pub fn displays(&self) -> &[DisplayEntry] {
        &self.displays
    }

    /// The pipeline of this name.
    ///
    /// # Errors
    ///
    /// The nearest valid name.
    pub fn pipeline(&self, name: &str) -> Result<&PipelineEntry, &'static str> {
        let found = self.pipelines.iter().find(|entry| entry.name == name);
        found.ok_or_else(|| nearest(name, self.pipelines.iter().map(|entry| entry.name)).unwrap_or_default())
    }

    /// The display of this name.
    ///
    /// # Errors
    ///
    /// The nearest valid name.
    pub fn display(&self, name: &str) -> Result<&DisplayEntry, &'static str> {
        let found = self.displays.iter().find(|entry| entry.name == name);
        found.ok_or_else(|| nearest(name, self.displays.iter().map(|entry| entry.name)).unwrap_or_default())
    }

    /// The keys of all pipelines, each once, with the families that have it.
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
