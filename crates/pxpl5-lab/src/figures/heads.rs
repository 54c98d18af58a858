//! Figures that need a tracked head: the pendulum rig, and the latency from head to display.

use super::measured::{FigureValue, Result, detail, scene_named};
use super::reading::Reading;
use crate::rig::Rig;
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{Budget, LatencyCurve, summary};
use pxpl5_run::{Experiment, ExperimentError, Head, Pipeline, Pixels, RenderingControl, Statistics};
use std::sync::Arc;
use tracking::motion::Synthetic;
use tracking::predict::PredictorKind;
use tracking::rig::{Latency, PendulumRig};
use tracking::tracker::TrackerConfig;

/// Path of the parameter for the photodiode's position in figure 17: the visible line of the screen under the
/// photodiode. The common settings of measurements ([`Bench::changes`](super::Bench)) may change this parameter.
pub const PHOTODIODE_LINE: &str = "tracking.rig.photodiode_line";

/// Measures figure 17: the mean latency seen from outside. The photodiode is on the given line, or on the assumed line
/// if `line` is `None`. The paper does not print the photodiode's position, so the details state the latency under the
/// first and the last line.
pub(super) fn rig(machine: &MachineConfig, pipeline: RenderingControl, line: Option<u64>) -> Result<FigureValue> {
    if let Some(line) = line {
        return under_line(machine, pipeline, line as u32);
    }
    let [first, assumed, last] = photodiode_lines();
    let [first, last] = [first, last].map(|line| under_line(machine, pipeline, line).map(|measured| measured.value));
    let [first, last] = [first?, last?];
    let measured = under_line(machine, pipeline, assumed)?;
    let lines = [detail("under the first line", first, "ms"), detail("under the last line", last, "ms")];
    let details = [lines.to_vec(), measured.details].concat();
    Ok(FigureValue { details, unprinted: Some([first.min(last), first.max(last)]), ..measured })
}

/// Returns three possible lines of the photodiode: the first, the assumed and the last.
fn photodiode_lines() -> [u32; 3] {
    let assumed = PendulumRig::assumed().photodiode_line;
    let table = crate::tracking_parameters().into_iter().find(|parameter| parameter.path == PHOTODIODE_LINE);
    let range = table.and_then(|parameter| parameter.info.whole_range());
    range.map_or([assumed; 3], |(first, last)| [first as u32, assumed, last as u32])
}

fn under_line(machine: &MachineConfig, pipeline: RenderingControl, line: u32) -> Result<FigureValue> {
    let mut rig = Rig::assumed(TrackerConfig::optical_ceiling());
    rig.rig.photodiode_line = line;
    let measured = rig.measure(machine, Arc::new(pipeline));
    let measured = measured.map_err(|error| ExperimentError::Scene(error.to_string()))?;
    let Latency { mean_s, least_s, greatest_s, .. } = measured.outside.rendering;
    let details = vec![
        detail("least", least_s * 1e3, "ms"),
        detail("greatest", greatest_s * 1e3, "ms"),
        detail("inside, to the swap", measured.inside.rendering.mean_s * 1e3, "ms"),
    ];
    Ok(FigureValue::with(mean_s * 1e3, details))
}

/// Number of seeds of the head motion in figure 18.
const SEEDS: u64 = 4;
/// Duration of the head motion in figure 18, in seconds.
const SECONDS: u64 = 120;

/// Measures figure 18. Almost all of the error comes from rotation. The position adds little for a point 1 m ahead.
pub(super) fn ratio_of_errors() -> FigureValue {
    let ratio = |seed: u64| {
        let motion = Synthetic::recorded_use(seed);
        let [slow, fast] = [90, 50].map(|ms| LatencyCurve::of(&motion, ms, SECONDS, 1.0).mean_px());
        slow / fast
    };
    let Statistics { mean, min, max, .. } = Statistics::of((1..=SEEDS).map(ratio));
    FigureValue::with(mean, vec![detail("least", min, ""), detail("greatest", max, "")])
}

/// Number of display fields in the runs for figure 19: ten seconds.
const FIELDS: u64 = 600;

/// Measures figures 19 and 19b: the sum of those stages of the latency that the paper adds. The details state the other
/// stages of the latency.
pub(super) fn tracker_and_rendering(
    machine: MachineConfig,
    pipeline: impl Pipeline,
    reading: &Reading,
) -> Result<FigureValue> {
    let motion = Arc::new(Synthetic::recorded_use(1));
    let head = Head::new(motion, TrackerConfig::optical_ceiling(), PredictorKind::None, 1);
    let head = head.map_err(|error| ExperimentError::Scene(error.to_string()))?;
    let experiment = Experiment::new(machine, pipeline, scene_named("full-screen:12")?);
    // One run gives all stages from head to light.
    let outcome = experiment.head(head).fields(FIELDS).pixels(Pixels::Off).run()?;
    let Budget { tracking_ms, waiting_ms, sending_ms, drawing_ms, showing_ms, scanning_ms, total_ms, .. } =
        Budget::of(&outcome);
    // The paper adds its own mean latencies, so rendering is measured like figure 4. Eyes of Slats have no TRANSFORM
    // of their own.
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
    Ok(FigureValue::with(tracking_ms + rendering_ms, details))
}
