//! How many triangles a pipeline can draw in time, found by simulation.

use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, Goal, Outcome, Pipeline, PipelineSettings, Pixels, Registry};
use serde::Serialize;
use std::sync::Arc;

/// A limit and what it means.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Possible {
    /// Most triangles; 0 if not even one.
    pub triangles: u32,
    /// What holds up to there.
    pub definition: &'static str,
}

/// Fields of each trial, a little more than the warm-up of the slowest.
const FIELDS: u64 = 24;

/// No more are tried.
const MOST: u32 = 4_096;

/// Most triangles, each covering the whole screen, that a pipeline draws in time, by the goal of its registry entry: at a
/// rate, at a latency, or with every picture that is due shown in time.
#[must_use]
pub fn triangles_possible(registry: &Registry, config: &MachineConfig, pipeline: &Arc<dyn Pipeline>) -> Possible {
    let entry = registry.pipeline(pipeline.name()).ok();
    let goal = entry.map_or(Goal::NoMissedRetrace, |entry| (entry.limit)(&PipelineSettings::default()).goal);
    let run = |n| run(config, pipeline, n);
    match goal {
        Goal::RateHz(hz) => Possible {
            triangles: greatest(|n| run(n).is_some_and(|outcome| updates_hz(&outcome) >= hz * NTSC)),
            definition: "full-screen triangles at a pass a frame, 29.97 Hz",
        },
        Goal::LatencyFields(most) => Possible {
            triangles: greatest(|n| run(n).is_some_and(|outcome| outcome.latency_fields().mean <= most)),
            definition: "full-screen triangles at a mean latency",
        },
        Goal::NoMissedRetrace => Possible {
            triangles: greatest(|n| run(n).is_some_and(|outcome| is_in_time(&outcome))),
            definition: "full-screen triangles with every picture that is due shown in time",
        },
    }
}

/// NTSC's rates over the round ones.
const NTSC: f64 = 0.999;

/// A pipeline with so many triangles; nothing of one that cannot draw them.
fn run(config: &MachineConfig, pipeline: &Arc<dyn Pipeline>, triangles: u32) -> Option<Outcome> {
    let scene = pxpl5_scene::builtin(&format!("full-screen:{triangles}")).ok()?;
    let experiment = Experiment::with(config.clone(), Arc::clone(pipeline), Arc::new(scene));
    experiment.fields(FIELDS).pixels(Pixels::Off).run().ok()
}

/// Whole pictures shown a second; 0 where none was, which reaches no rate.
fn updates_hz(outcome: &Outcome) -> f64 {
    outcome.updates_hz().unwrap_or_default()
}

/// Whether every picture that was due was shown.
fn is_in_time(outcome: &Outcome) -> bool {
    outcome.due().is_some_and(|due| due.not_shown() == 0)
}

/// The greatest number up to [`MOST`] that holds, if it holds for all smaller ones.
fn greatest(holds: impl Fn(u32) -> bool) -> u32 {
    let mut high = 1;
    while high <= MOST && holds(high) {
        high *= 2;
    }
    let mut low = high / 2;
    let mut high = high.min(MOST + 1);
    while high - low > 1 {
        let middle = (low + high) / 2;
        *(if holds(middle) { &mut low } else { &mut high }) = middle;
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_greatest_number_that_holds_is_found() {
        for limit in [0, 1, 2, 3, 7, 8, 9, 110, 4_095, 4_096] {
            assert_eq!(greatest(|n| n <= limit), limit);
        }
        assert_eq!(greatest(|_| true), MOST);
    }
}
