//! Tests which pipelines a machine can run.

use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, ExperimentError, Pause, PipelineEntry, PipelineSettings, Pixels, Registry};
use pxpl5_scene::{Scene, builtin};
use pxpl5_sim::Time;
use serde::Serialize;
use std::sync::Arc;

/// Result of a test of one pipeline on a machine.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Suitability {
    /// Name of the tested pipeline.
    pub pipeline: &'static str,
    /// Reason why the machine cannot run the pipeline. `None` if the machine can run the pipeline.
    pub lacks: Option<String>,
}

/// Tests every pipeline of a registry on a machine. The test loads a scene of one triangle and starts all programs.
///
/// # Panics
///
/// Never panics, because the scene is built in.
pub fn suitability(registry: &Registry, config: &MachineConfig) -> Vec<Suitability> {
    let scene = Arc::new(builtin("full-screen:1").expect("built in"));
    let tried = |entry: &PipelineEntry| {
        let lacks = begins(registry, entry, config, &scene).err().map(|error| error.to_string());
        Suitability { pipeline: entry.name, lacks }
    };
    registry.pipelines().iter().map(tried).collect()
}

/// Simulated time after which a missing resource has caused an error. This time suffices, because programs reserve all
/// memory before their first wait.
const BEGIN: Time = Time(1_000_000);

fn begins(
    registry: &Registry,
    entry: &PipelineEntry,
    config: &MachineConfig,
    scene: &Arc<Scene>,
) -> Result<(), ExperimentError> {
    let experiment = on_machine(registry, entry, config, scene);
    let mut stepper = experiment.stepper()?;
    match stepper.run_to(BEGIN) {
        // Finishing the run gives the same error message as a whole run.
        Pause::Failed(_) => stepper.finish().map(|_| ()),
        _ => Ok(()),
    }
}

fn on_machine(registry: &Registry, entry: &PipelineEntry, config: &MachineConfig, scene: &Arc<Scene>) -> Experiment {
    let pipeline = (entry.build)(&PipelineSettings::default());
    let config = pipeline.adapt(registry.machine_of(config.clone()));
    Experiment::with(config, pipeline, Arc::clone(scene)).fields(1).pixels(Pixels::Off)
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

    /// Tests that the first instant of a run and the simulation of a whole field find the same missing resources. Some
    /// of the machines lack boards or memory.
    #[test]
    fn starting_a_run_finds_the_same_faults_as_running_a_field() {
        let small = |n_gps, n_renderers, memory_bytes| {
            let machine = MachineConfig { n_gps, n_renderers, ..MachineConfig::small_hmd() };
            let gp = pxpl5_gp::GpTiming { memory_bytes, ..machine.gp };
            MachineConfig { gp, ..machine }
        };
        let machines = [
            small(13, 5, 8 << 20),
            small(1, 5, 8 << 20),
            small(2, 1, 8 << 20),
            small(2, 20, 8 << 20),
            small(4, 5, 1 << 20),
            MachineConfig::preset("large").expect("built in"),
        ];
        let registry = crate::registry();
        let scene = Arc::new(builtin("full-screen:1").expect("built in"));
        let mut lacking = 0;
        for machine in machines {
            for (entry, begun) in registry.pipelines().iter().zip(suitability(&registry, &machine)) {
                let of_field = match on_machine(&registry, entry, &machine, &scene).run() {
                    // One field shows no picture after the warm-up on any machine.
                    Ok(_) | Err(ExperimentError::TooShort { .. }) => None,
                    Err(error) => Some(error.to_string()),
                };
                lacking += usize::from(of_field.is_some());
                assert_eq!(begun.lacks, of_field, "{} on {machine:?}", entry.name);
            }
        }
        assert!(lacking > 10, "{lacking} are refused");
    }

    #[test]
    fn an_unsuitable_machine_is_refused_with_the_missing_part() {
        // Rendering Control needs a master and at least one slave. Slats binds 20 regions, four to a renderer.
        let few = MachineConfig { n_gps: 1, n_renderers: 4, ..MachineConfig::small_hmd() };
        let lacking = lacking(&few);
        assert!(lacking.contains(&"rendering-control") && lacking.contains(&"slats"), "{lacking:?}");
        let all = suitability(&crate::registry(), &few);
        let slats = all.iter().find(|one| one.pipeline == "slats").and_then(|one| one.lacks.clone());
        assert!(slats.is_some_and(|text| text.contains("renderers")), "{all:?}");
    }
}
