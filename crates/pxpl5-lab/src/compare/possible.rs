//! How many triangles a pipeline can draw in time, found by simulation.

use crate::config::MachineConfig;
use crate::experiment::{Experiment, Outcome, Pixels};
use crate::pipelines::Pipeline;
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

/// Most triangles, each covering the whole screen, that a pipeline draws in time: all regions before their beam, where
/// it has deadlines; else at the update rate that it has with one triangle (Rendering Control), or a pass in each frame
/// of 1/30 s (frameless).
#[must_use]
pub fn triangles_possible(config: &MachineConfig, pipeline: &Arc<dyn Pipeline>) -> Possible {
    let run = |n: u32| {
        let scene = pxpl5_scene::builtin(&format!("full-screen:{n}")).ok()?;
        Experiment::with(config.clone(), Arc::clone(pipeline), Arc::new(scene))
            .fields(FIELDS)
            .pixels(Pixels::Off)
            .run()
            .ok()
    };
    let rate = |outcome: &Outcome| outcome.report().updates_hz;
    match pipeline.name() {
        "rendering-control" => {
            let best = run(1).as_ref().map_or(0.0, rate);
            let holds = |n| run(n).is_some_and(|o| rate(&o) > 0.98 * best);
            Possible { triangles: greatest(holds), definition: "full-screen triangles at the update rate of one" }
        }
        "frameless" => {
            let holds = |n| run(n).is_some_and(|o| rate(&o) >= 29.97);
            Possible { triangles: greatest(holds), definition: "full-screen triangles at a pass a frame, 29.97 Hz" }
        }
        _ => {
            let in_time = |o: &Outcome| o.steady_pictures().iter().all(|times| times.complete) && whole(o);
            let holds = |n| run(n).is_some_and(|o| in_time(&o));
            Possible { triangles: greatest(holds), definition: "full-screen triangles with every region in time" }
        }
    }
}

/// Whether no field between the first and the last picture was left out.
fn whole(outcome: &Outcome) -> bool {
    let pictures = outcome.steady_pictures();
    let end = |times: Option<&crate::pipelines::PictureTimes>| times.map_or(0, |t| t.picture);
    end(pictures.last()) + 1 - end(pictures.first()) == pictures.len() as u64 && pictures.len() as u64 > FIELDS / 3
}

/// The greatest number up to [`MOST`] that holds, if it holds for all smaller ones.
fn greatest(holds: impl Fn(u32) -> bool) -> u32 {
    let mut high = 1;
    while high <= MOST && holds(high) {
        high *= 2;
    }
    let (mut low, mut high) = (high / 2, high.min(MOST + 1));
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
