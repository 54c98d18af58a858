//! Experiments with a head: the pendulum rig, and what passes from head to light.

use super::measured::{FigureValue, Result, detail, scene_named};
use super::reading::Reading;
use crate::rig::Rig;
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{Budget, LatencyCurve, summary};
use pxpl5_run::{Experiment, ExperimentError, Head, Pipeline, Pixels, RenderingControl, Statistics};
use std::sync::Arc;
use tracking::motion::Synthetic;
use tracking::predict::PredictorKind;
use tracking::rig::Latency;
use tracking::tracker::TrackerConfig;

/// Figure 17: the mean that is seen from outside, with the photodiode on a line that was said.
pub(super) fn rig(machine: &MachineConfig, pipeline: RenderingControl, line: Option<u64>) -> Result<FigureValue> {
    let mut rig = Rig::assumed(TrackerConfig::optical_ceiling());
    rig.rig.photodiode_line = line.map_or(rig.rig.photodiode_line, |line| line as u32);
    let measured = rig.measure(machine, Arc::new(pipeline));
    let measured = measured.map_err(|error| ExperimentError::Scene(error.to_string()))?;
    let Latency { mean_s, least_s, greatest_s, .. } = measured.outside.rendering;
    let details = vec![
        detail("least", least_s * 1e3, "ms"),
        detail("greatest", greatest_s * 1e3, "ms"),
        detail("inside, to the swap", measured.inside.rendering.mean_s * 1e3, "ms"),
    ];
    Ok(FigureValue { value: mean_s * 1e3, details })
}

/// Seeds and length of figure 18's motion.
const SEEDS: u64 = 4;
const SECONDS: u64 = 120;

/// Figure 18. The error is that of a rotation, but for the little that a point 1 m ahead adds.
pub(super) fn ratio_of_errors() -> FigureValue {
    let ratio = |seed: u64| {
        let motion = Synthetic::recorded_use(seed);
        let [slow, fast] = [90, 50].map(|ms| LatencyCurve::of(&motion, ms, SECONDS, 1.0).mean_px());
        slow / fast
    };
    let Statistics { mean, min, max, .. } = Statistics::of((1..=SEEDS).map(ratio));
    FigureValue { value: mean, details: vec![detail("least", min, ""), detail("greatest", max, "")] }
}

/// Fields of figure 19's runs: ten seconds.
const FIELDS: u64 = 600;

/// Figures 19 and 19b: the parts that the paper adds, and beside them those that it does not.
pub(super) fn tracker_and_rendering(
    machine: MachineConfig,
    pipeline: impl Pipeline,
    reading: &Reading,
) -> Result<FigureValue> {
    let motion = Arc::new(Synthetic::recorded_use(1));
    let head = Head::new(motion, TrackerConfig::optical_ceiling(), PredictorKind::None, 1);
    let head = head.map_err(|error| ExperimentError::Scene(error.to_string()))?;
    let experiment = Experiment::new(machine, pipeline, scene_named("full-screen:12")?);
    let outcome = experiment.head(head).fields(FIELDS).pixels(Pixels::Off).run()?;
    let Budget { tracking_ms, waiting_ms, sending_ms, drawing_ms, showing_ms, scanning_ms, total_ms, .. } =
        Budget::of(&outcome);
    // The paper adds its own means, which are read as figure 4 is; eyes of Slats have no TRANSFORM of their own.
    let of_eyes = summary(&outcome);
    let samples = reading.latencies_ms(&of_eyes);
    let rendering_ms =
        if samples.is_empty() { drawing_ms + showing_ms } else { Statistics::of(samples.iter().copied()).mean };
    let details = vec![
        detail("tracking", tracking_ms, "ms"),
        detail("rendering", rendering_ms, "ms"),
        detail("from the first eye on", drawing_ms + showing_ms, "ms"),
        detail("not in the paper's sum: waiting for the pipeline", waiting_ms, "ms"),
        detail("sending and edits", sending_ms, "ms"),
        detail("scan to the middle", scanning_ms, "ms"),
        detail("all from head to light", total_ms, "ms"),
    ];
    Ok(FigureValue { value: tracking_ms + rendering_ms, details })
}
