//! Figures that need a tracked head: the pendulum rig, and the latency from head to display.

use super::interpretation::Interpretation;
use super::measurement::{HEAD, LatencyDefinition, Measurement, Varied, figure};
use super::settings::FigureSettings;
use super::value::{FigureValue, Result, detail, scene_named};
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{Budget, LatencyCurve};
use pxpl5_run::{Experiment, Head, Pipeline, Pixels, Slats, Statistics};
use pxpl5_sim::StopFlag;
use pxpl5_sim::figures::Basis;
use std::sync::Arc;
use tracking::motion::Synthetic;
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;

const I3D95: (&str, &str) = ("I3D95", HEAD);

const WITH_TRACKER: LatencyDefinition = LatencyDefinition {
    from: "pose of the head; start of TRANSFORM",
    to: "arrival of the report; swap",
    eyes: "each eye",
    statistic: "sum of two means",
    sentence: "I3D95: the 33 ms of the tracker are added",
};

const FIFO_AND_CHANNELS: Varied = Varied::ByEvents(&["renderer.fifo_words", "ring.source_channels"]);

/// The figures that need a tracked head, in the order of their numbers.
pub(super) const FIGURES: &[Measurement] = &[
    Measurement {
        basis: Basis::Derived("90 over 50"),
        ..figure(
            ("18", I3D95, 1.8, ""),
            "errors in pixels of two systems with 90 and 50 ms from head to light: ratio",
            "a synthetic motion of recorded use, four seeds of two minutes; the pictures are drawn for the poses of 90 ms and of 50 ms before",
            |_| Ok(ratio_of_errors()),
        )
    },
    Measurement {
        basis: Basis::Derived("33 ms + row 4"),
        latency: Some(WITH_TRACKER),
        is_interpreted: true,
        varied: FIFO_AND_CHANNELS,
        cause: "As row 4. I3D95's sum takes 57 ms for Rendering Control, from its range of 54 to 57 ms",
        ..figure(
            ("19", I3D95, 90.0, "ms"),
            "optical tracker and Rendering Control together",
            "full-screen:12 on small-hmd, with a synthetic motion, without prediction: from the pose to the arrival of its report, plus \
             from the start of TRANSFORM to the swap, as in figure 4",
            |settings| {
                tracker_and_rendering(settings, settings.interpreted("small-hmd")?, settings.interpretation.pipeline())
            },
        )
    },
    Measurement {
        basis: Basis::Derived("33 ms + row 9"),
        latency: Some(LatencyDefinition { eyes: "both eyes together", ..WITH_TRACKER }),
        varied: FIFO_AND_CHANNELS,
        ..figure(
            ("19b", I3D95, 50.0, "ms"),
            "optical tracker and Slats together",
            "the same with Slats on slats",
            |settings| tracker_and_rendering(settings, settings.machine("slats")?, Slats::split()),
        )
    },
];

/// Number of seeds of the head motion for row 18 of ACCURACY.md, the ratio of two errors.
const SEEDS: u64 = 4;
/// Seconds of head motion for row 18 of ACCURACY.md.
const SECONDS: u64 = 120;

/// Measures row 18 of ACCURACY.md: the ratio of the errors of two systems with 90 and 50 ms from head to light. Almost
/// all of the error comes from rotation, because the position adds little for a point 1 m ahead.
fn ratio_of_errors() -> FigureValue {
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

/// Measures rows 19 and 19b of ACCURACY.md. Rendering is always simulated with events, even at the analytic level.
fn tracker_and_rendering(
    settings: &FigureSettings,
    machine: MachineConfig,
    pipeline: impl Pipeline,
) -> Result<FigureValue> {
    let key = format!("{pipeline:?} {machine:?} {:?}", settings.interpretation);
    let make = || sum_of_stages(machine, pipeline, (&settings.interpretation, &settings.stop));
    settings.applications.value(key, make)
}

/// Measures the latency of the optical tracker and of rendering. The value is the sum of the stages of the latency that
/// the paper adds. The details state all other stages.
fn sum_of_stages(
    machine: MachineConfig,
    pipeline: impl Pipeline,
    (interpretation, stop): (&Interpretation, &StopFlag),
) -> Result<FigureValue> {
    let motion = Arc::new(Synthetic::recorded_use(1));
    let head = Head::new(motion, TrackerConfig::optical_ceiling(), PredictorKind::None, 1)?;
    let experiment = Experiment::new(machine, pipeline, scene_named("full-screen:12")?);
    // One run gives all stages from head to light.
    let outcome = experiment.head(head).fields(FIELDS).pixels(Pixels::Off).stopped_by(stop.clone()).run()?;
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
