//! Which pipelines a machine can run.

use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, ExperimentError, PipelineEntry, PipelineSettings, Pixels, Registry};
use pxpl5_scene::builtin;
use serde::Serialize;
use std::sync::Arc;

/// Whether a pipeline runs on a machine.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Suitability {
    /// Name of the pipeline that was tried.
    pub pipeline: &'static str,
    /// What the machine lacks; nothing where the pipeline runs.
    pub lacks: Option<String>,
}

/// Every pipeline of a registry, tried on a machine with one triangle for one field: it is loaded and begins.
#[must_use]
pub fn suitability(registry: &Registry, config: &MachineConfig) -> Vec<Suitability> {
    let tried = |entry: &PipelineEntry| Suitability { pipeline: entry.name, lacks: lacks(registry, entry, config) };
    registry.pipelines().iter().map(tried).collect()
}

fn lacks(registry: &Registry, entry: &PipelineEntry, config: &MachineConfig) -> Option<String> {
    let pipeline = (entry.build)(&PipelineSettings::default());
    let scene = builtin("full-screen:1").map_err(|error| ExperimentError::Scene(error.to_string()));
    let config = pipeline.adapt(registry.machine_of(config.clone()));
    let run =
        scene.and_then(|scene| Experiment::with(config, pipeline, Arc::new(scene)).fields(1).pixels(Pixels::Off).run());
    match run {
        // One field shows no picture behind the warm-up, whatever the machine.
        Ok(_) | Err(ExperimentError::TooShort { .. }) => None,
        Err(error) => Some(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lacking(config: &MachineConfig) -> Vec<&'static str> {
        let all = suitability(&crate::registry(), config);
        all.into_iter().filter(|one| one.lacks.is_some()).map(|one| one.pipeline).collect()
    }

    #[test]
    fn every_pipeline_runs_on_the_preset_on_which_it_was_published() {
        let registry = crate::registry();
        for entry in registry.pipelines() {
            let config = MachineConfig::preset(entry.preset).expect("it is listed");
            assert!(!lacking(&config).contains(&entry.name), "{} on {}", entry.name, entry.preset);
        }
    }

    #[test]
    fn a_machine_says_what_it_lacks() {
        // Rendering Control has a master and at least one slave; Slats binds 20 regions, four to a renderer.
        let few = MachineConfig { n_gps: 1, n_renderers: 4, ..MachineConfig::small_hmd() };
        let lacking = lacking(&few);
        assert!(lacking.contains(&"rendering-control") && lacking.contains(&"slats"), "{lacking:?}");
        let all = suitability(&crate::registry(), &few);
        let slats = all.iter().find(|one| one.pipeline == "slats").and_then(|one| one.lacks.clone());
        assert!(slats.is_some_and(|text| text.contains("renderers")), "{all:?}");
    }
}
