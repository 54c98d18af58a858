//! Registry of pipelines and displays. Commands and experiment files find a pipeline or a display in the registry by
//! name.

use crate::error::ExperimentError;
use crate::experiment::{Estimates, Experiment};
use crate::keys::PipelineSettings;
use crate::pipeline::Pipeline;
use crate::result::summary::Summary;
use pxpl5_machine::{MachineConfig, NamedTable};
use pxpl5_scene::{Scene, builtin};
use pxpl5_sim::parameters::Key;
use pxpl5_sim::parameters::{SettingError, find_named};
use pxpl5_wire::display::DisplayConfig;
use serde::Serialize;
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

/// The condition that a pipeline must meet so that a scene counts as drawn in time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Goal {
    /// Every due picture is shown in time.
    NoMissedRetrace,
    /// The update rate is at least this number per second. The papers round rates: 30 stands for 29.97 Hz of NTSC, and
    /// 60 for 59.94 Hz.
    RateHz(f64),
    /// The mean latency is at most this number of fields.
    LatencyFields(f64),
}

/// Kind of triangles in a test scene.
///
/// A search varies the number of these triangles to find the largest scene that a pipeline draws in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum TestScene {
    /// Triangles that cover the whole screen.
    FullScreen,
    /// Small triangles spread over the screen. Each triangle touches 1.3 regions per eye on average (TR94).
    Typical,
}

impl TestScene {
    /// All kinds of test scenes, beginning with the largest triangles.
    pub const ALL: [Self; 2] = [Self::FullScreen, Self::Typical];

    /// Returns the name of the test scene on the command line and in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::FullScreen => "full-screen",
            Self::Typical => "typical",
        }
    }

    /// Returns the test scene with `triangles` triangles, but at least one triangle.
    ///
    /// # Panics
    ///
    /// Panics above the scene generator's maximum number of triangles.
    #[must_use]
    pub fn with_triangles(self, triangles: u32) -> Scene {
        builtin(&format!("{}:{}", self.name(), triangles.max(1))).expect("in range")
    }
}

pxpl5_sim::parameters::named!(TestScene, "test scene", TestScene::ALL.map(|scene| (scene.name(), scene)));

/// Settings of a search for the largest number of triangles that a pipeline draws in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitCriterion {
    /// Condition that every scene up to the limit must meet.
    pub goal: Goal,
    /// Kind of triangles in the test scene.
    pub scene: TestScene,
    /// Number of fields to simulate for each size of the scene, large enough for a steady state.
    pub fields: u64,
}

/// The closed form of a pipeline: formulas that give the results of an experiment without simulated events.
#[derive(Clone, Copy, Debug)]
pub struct ClosedForm {
    /// Function that computes the results of an experiment.
    pub summary: fn(&Experiment) -> Result<Summary, ExperimentError>,
    /// Functions that compute the estimates in error messages.
    pub estimates: Estimates,
}

/// Description of a pipeline in the registry.
#[derive(Clone, Copy, Debug)]
pub struct PipelineEntry {
    /// Name of the entry in experiment files and on the command line.
    pub name: &'static str,
    /// Name of the family. All variants of the pipeline have the same family.
    pub family: &'static str,
    /// Description of the pipeline in one line, with the publication.
    pub about: &'static str,
    /// Name of the machine preset for this pipeline. The papers ran the pipeline on this machine, or could have done
    /// so.
    pub preset: &'static str,
    /// Settings of the pipeline (keys), with allowed values and help texts.
    pub keys: &'static [Key],
    /// Function that builds the pipeline from its settings. Settings that the user did not change have the values from
    /// the papers.
    pub build: fn(&PipelineSettings) -> Arc<dyn Pipeline>,
    /// Function that returns, for the pipeline's settings, how a search finds the largest scene.
    pub limit: fn(&PipelineSettings) -> LimitCriterion,
    /// Timing tables of the firmware, with their names. The parameter paths of the table `jitp` begin with `jitp.`.
    pub tables: &'static [NamedTable],
    /// Closed form of the pipeline, or `None` if the pipeline has no closed form.
    pub closed_form: Option<ClosedForm>,
    /// True if the command `compare` has a row for the pipeline.
    pub compared: bool,
}

/// Description of a display in the registry.
#[derive(Clone, Copy, Debug)]
pub struct DisplayEntry {
    /// Name of the entry in experiment files and on the command line.
    pub name: &'static str,
    /// Function that returns the display's configuration with the values from the papers.
    pub config: fn() -> Box<dyn DisplayConfig>,
}

/// Implements the text form of an entry, its name, which the registry of the papers finds.
macro_rules! found_by_name {
    ($entry:ty, $find:ident) => {
        impl fmt::Display for $entry {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.pad(self.name)
            }
        }

        impl FromStr for $entry {
            type Err = SettingError;

            fn from_str(name: &str) -> Result<Self, SettingError> {
                Registry::of_papers().$find(name).copied()
            }
        }
    };
}

found_by_name!(PipelineEntry, pipeline);
found_by_name!(DisplayEntry, display);

/// All registered pipelines and displays.
#[derive(Clone, Debug)]
pub struct Registry {
    pipelines: Vec<PipelineEntry>,
    displays: Vec<DisplayEntry>,
}

impl Registry {
    /// Creates a registry with the entries `pipelines` and `displays`. More entries can be added later.
    pub const fn with(pipelines: Vec<PipelineEntry>, displays: Vec<DisplayEntry>) -> Self {
        Self { pipelines, displays }
    }

    /// Adds the timing tables of the firmware of all pipelines to the configuration of a machine.
    pub fn machine_of(&self, config: MachineConfig) -> MachineConfig {
        let mut config = config;
        for entry in &self.pipelines {
            entry.tables.iter().for_each(|(name, table)| config.add_firmware_table(name, table()));
        }
        config
    }

    /// Adds a pipeline. An existing pipeline with the same name is replaced.
    pub fn add(&mut self, entry: PipelineEntry) {
        match self.pipelines.iter_mut().find(|existing| existing.name == entry.name) {
            Some(existing) => *existing = entry,
            None => self.pipelines.push(entry),
        }
    }

    /// Adds a display. An existing display with the same name is replaced.
    pub fn add_display(&mut self, entry: DisplayEntry) {
        match self.displays.iter_mut().find(|existing| existing.name == entry.name) {
            Some(existing) => *existing = entry,
            None => self.displays.push(entry),
        }
    }

    /// Sets the closed form for all pipelines of a family.
    pub fn closed_form(&mut self, family: &str, form: ClosedForm) {
        let of_family = self.pipelines.iter_mut().filter(|entry| entry.family == family);
        of_family.for_each(|entry| entry.closed_form = Some(form));
    }

    /// Returns all pipelines, in the order in which they were added.
    pub fn pipelines(&self) -> &[PipelineEntry] {
        &self.pipelines
    }

    /// Returns all displays, in the order in which they were added.
    pub fn displays(&self) -> &[DisplayEntry] {
        &self.displays
    }

    /// Returns the pipeline with the name `name`.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] with the most similar name if no pipeline has the name.
    pub fn pipeline(&self, name: &str) -> Result<&PipelineEntry, SettingError> {
        find_named("pipeline", name, self.pipelines.iter().map(|entry| (entry.name, entry)))
    }

    /// Returns the display with the name `name`.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] with the valid names if no display has the name.
    pub fn display(&self, name: &str) -> Result<&DisplayEntry, SettingError> {
        find_named("display", name, self.displays.iter().map(|entry| (entry.name, entry)))
    }

    /// Returns the settings (keys) of all pipelines. Each setting appears once, with the families of pipelines that
    /// have this setting.
    pub fn keys(&self) -> Vec<(Key, Vec<&'static str>)> {
        let mut all: Vec<(Key, Vec<&'static str>)> = Vec::new();
        for entry in &self.pipelines {
            for key in entry.keys {
                match all.iter_mut().find(|(existing, _)| existing.name == key.name) {
                    Some((_, families)) if families.contains(&entry.family) => {}
                    Some((_, families)) => families.push(entry.family),
                    None => all.push((*key, vec![entry.family])),
                }
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests the stated default of every key that a single value states.
    #[test]
    fn pipelines_have_the_stated_defaults_of_their_keys() {
        for entry in Registry::of_papers().pipelines() {
            let settings = (entry.build)(&PipelineSettings::default()).settings();
            for key in entry.keys.iter().filter(|key| !key.default.contains(' ')) {
                // A key that only applies with another value of a second key is absent.
                if let Some((_, value)) = settings.iter().find(|(name, _)| *name == key.name) {
                    assert_eq!((key.name, &*value.to_string()), (key.name, key.default), "{entry}");
                }
            }
        }
    }
}
