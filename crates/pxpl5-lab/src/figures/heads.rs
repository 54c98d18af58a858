//! Figures that need a tracked head: the pendulum rig, and the latency from head to display.

use super::interpretation::Interpretation;
use super::measured::{FigureValue, Result, detail, scene_named};
use crate::StopFlag;
use crate::error::StudyError;
use crate::rig::Rig;
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{Budget, LatencyCurve};
use pxpl5_run::{Experiment, ExperimentError, Head, Pipeline, Pixels, Statistics};
use std::sync::Arc;
use tracking::motion::Synthetic;
use tracking::predict::PredictorKind;
use tracking::rig::{Measurement as RigMeasurement, PendulumRig};
use tracking::tracker::TrackerConfig;

/// Path of the parameter for the line of the screen under the photodiode of the pendulum rig (row 17 of ACCURACY.md).
/// [`Bench::changes`](super::Bench) may change this parameter.
pub const PHOTODIODE_LINE: &str = "tracking.rig.photodiode_line";

/// The measurements of the pendulum rig in one run, with the photodiode under the first, the assumed and the last line
/// of the screen.
#[derive(Clone, Debug)]
pub(super) struct RigLines {
    measured: [(u32, Arc<RigMeasurement>); 3],
}

impl RigLines {
    /// Measures the latency with a pendulum and a photodiode. Also returns true if a backing store was full in the run.
    pub(super) fn measure(
        machine: &MachineConfig,
        interpretation: &Interpretation,
        stop: &StopFlag,
    ) -> Result<(Self, bool)> {
        let lines = photodiode_lines();
        let (measured, met_full_store) = under_lines(machine, (interpretation, stop), lines)?;
        let mut lines = lines.into_iter();
        let measured = measured.map(|measured| (lines.next().unwrap_or_default(), Arc::new(measured)));
        Ok((Self { measured }, met_full_store))
    }

    /// Returns the latency from the pendulum rig (row 17 of ACCURACY.md), with the photodiode on the assumed line. The
    /// paper does not print the photodiode's position. The details therefore also state the latency on the first and on
    /// the last line of the screen.
    pub(super) fn figure(&self) -> FigureValue {
        let [first, assumed, last] = self.measured.each_ref().map(|(_, measured)| rendering(measured));
        let lines =
            [detail("under the first line", first.value, "ms"), detail("under the last line", last.value, "ms")];
        let details = [lines.to_vec(), assumed.details].concat();
        let unprinted = Some([first.value.min(last.value), first.value.max(last.value)]);
        FigureValue { value: assumed.value, details, unprinted }
    }

    pub(super) fn assumed(&self) -> Arc<RigMeasurement> {
        Arc::clone(&self.measured[1].1)
    }

    pub(super) fn under(&self, line: u64) -> Option<Arc<RigMeasurement>> {
        let found = self.measured.iter().find(|(measured, _)| u64::from(*measured) == line);
        found.map(|(_, measured)| Arc::clone(measured))
    }
}

/// Returns the first, the assumed and the last line of the photodiode.
fn photodiode_lines() -> [u32; 3] {
    let assumed = PendulumRig::assumed().photodiode_line;
    let table = crate::tracking_parameters().into_iter().find(|parameter| parameter.path == PHOTODIODE_LINE);
    let range = table.and_then(|parameter| parameter.info.whole_range());
    range.map_or([assumed; 3], |(first, last)| [first as u32, assumed, last as u32])
}

pub(super) fn under_line(
    machine: &MachineConfig,
    of: (&Interpretation, &StopFlag),
    line: u64,
) -> Result<RigMeasurement> {
    let ([measured], _) = under_lines(machine, of, [u32::try_from(line).unwrap_or(u32::MAX)])?;
    Ok(measured)
}

/// Measures the latency with the photodiode under each of several lines in one run. Also returns true if a backing
/// store was full in the run.
fn under_lines<const N: usize>(
    machine: &MachineConfig,
    (interpretation, stop): (&Interpretation, &StopFlag),
    lines: [u32; N],
) -> Result<([RigMeasurement; N], bool)> {
    let rig = Rig { stop: stop.clone(), ..Rig::assumed(TrackerConfig::optical_ceiling()) };
    let measured = rig.measure_lines(machine, Arc::new(interpretation.pipeline()), lines);
    let (measured, outcome) = measured.map_err(|error| match error {
        StudyError::Experiment(error) => error,
        error => ExperimentError::Scene(error.to_string()),
    })?;
    Ok((measured, outcome.record().met_full_store()))
}

/// Returns the part of the latency from the start of SEND to the light under the photodiode (row 17 of ACCURACY.md).
pub(super) fn rendering(measured: &RigMeasurement) -> FigureValue {
    let Statistics { mean, min, max, .. } = measured.outside.rendering;
    let details = vec![
        detail("least", min * 1e3, "ms"),
        detail("greatest", max * 1e3, "ms"),
        detail("inside, to the swap", measured.inside.rendering.mean * 1e3, "ms"),
    ];
    FigureValue::with(mean * 1e3, details)
}

/// Number of seeds of the head motion for row 18 of ACCURACY.md, the ratio of two errors.
const SEEDS: u64 = 4;
/// Seconds of head motion for row 18 of ACCURACY.md.
const SECONDS: u64 = 120;

/// Measures row 18 of ACCURACY.md: the ratio of the errors of two systems with 90 and 50 ms from head to light. Almost
/// all of the error comes from rotation, because the position adds little for a point 1 m ahead.
pub(super) fn ratio_of_errors() -> FigureValue {
    let ratio = |seed: u64| {
        let motion = Synthetic::recorded_use(seed);
        let [slow, fast] = [90, 50].map(|ms| LatencyCurve::of(&motion, ms, SECONDS, 1.0).mean_px());
        slow / fast
    };
    let Statistics { mean, min, max, .. } = Statistics::of((1..=SEEDS).map(ratio));
    FigureValue::with(mean, vec![detail("least", min, ""), detail("greatest", max, "")])
}

/// Number of display fields in each measurement of the latency of tracker and rendering: ten seconds.
const FIELDS: u64 = 600;

/// Measures rows 19 and 19b of ACCURACY.md: the latency of the optical tracker and of rendering, under Rendering
/// Control or Slats. The value is the sum of the stages of the latency that the paper adds. The details state all other
/// stages.
pub(super) fn tracker_and_rendering(
    machine: MachineConfig,
    pipeline: impl Pipeline,
    (interpretation, stop): (&Interpretation, &StopFlag),
) -> Result<FigureValue> {
    let motion = Arc::new(Synthetic::recorded_use(1));
    let head = Head::new(motion, TrackerConfig::optical_ceiling(), PredictorKind::None, 1)?;
    let experiment = Experiment::new(machine, pipeline, scene_named("full-screen:12")?);
    // One run gives all stages from head to light.
    let outcome = experiment.head(head).fields(FIELDS).pixels(Pixels::Off).host(stop.clone()).run()?;
    let Budget { tracking_ms, waiting_ms, sending_ms, drawing_ms, showing_ms, scanning_ms, total_ms, .. } =
        Budget::of(&outcome);
    // The paper's sum contains its own mean latency of rendering, so rendering is measured as for figure 4. Eyes of
    // Slats have no TRANSFORM of their own.
    let of_eyes = outcome.summary();
    let samples = interpretation.latencies_ms(&of_eyes);
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
