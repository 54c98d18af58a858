//! Figures of the papers on address recalculation, a system other than Pixel-Planes 5.

use super::settings::FigureSettings;
use super::value::{Result, scene_named};
use crate::error::StudyError;
use crate::parallel;
use crate::study::check;
use pxpl5_arp::figures::{Experiments, row, rows, shape};
use pxpl5_run::{
    Experiment, FacePipeline, FacePolicy, Head, Outcome, Pipeline, Pixels, RenderingControl, RotationLatency,
};
use pxpl5_sim::figures::{Basis, FigureRow};
use std::sync::Arc;
use tracking::motion::Pan;
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;

/// Triangle counts of the spheres in experiment E1 (`turning`). The papers' diagram ends at 1,000 triangles.
const TRIANGLES: [u32; 4] = [10, 100, 1_000, 10_000];

const FIELDS: u64 = 60;
/// Number of compared rotation latencies in each run of experiment E1 (`turning`). All runs must have the same number,
/// because they are compared field by field.
const COMPARED: usize = 55;

/// Runs the experiments on address recalculation, priority rendering and region warping. Experiment E1 runs on
/// Pixel-Planes 5, experiments E2 to E9 run with an ideal renderer. Results that follow from the papers' tables by
/// arithmetic are stated only in the group's document.
///
/// # Errors
///
/// Returns a [`StudyError`] that names the experiment.
pub(super) fn address_recalculation(settings: &FigureSettings) -> Result<Vec<FigureRow>> {
    let (turning, experiments) = parallel::both(|| turning(settings), || Experiments::run(&settings.stop));
    let mut all = turning.map_err(StudyError::of_figure("E1"))?;
    let experiments = experiments?;
    check(&settings.stop)?;
    all.extend(rows(&experiments));
    Ok(all)
}

/// Runs experiment E1, which measures two latencies for growing numbers of triangles. One is the latency of the head's
/// rotation with the address recalculation display. The other is the latency of a picture under Rendering Control. For
/// Rendering Control, the viewer always faces the triangles, because triangles out of sight are not drawn.
fn turning(settings: &FigureSettings) -> Result<Vec<FigureRow>> {
    // For each size, run the display with faces under a turning head, then Rendering Control without a tracked head.
    let of_size = |triangles: &u32| -> Result<(Vec<u64>, f64)> {
        let faces = FacePipeline::new(FacePolicy::Full);
        let machine = faces.adapt(settings.machine("small-hmd")?);
        let scene = scene_named(&format!("sphere:{triangles}"))?;
        let experiment = Experiment::new(machine, faces, Arc::clone(&scene));
        let latencies = turned(experiment.stopped_by(settings.stop.clone()))?;
        let turn = totals_ps(&latencies.rotation_latencies());
        let drawn = Experiment::new(settings.machine("small-hmd")?, RenderingControl::stereo(), scene);
        let drawn = drawn.fields(FIELDS).pixels(Pixels::Off).stopped_by(settings.stop.clone());
        Ok((turn, drawn.run()?.latency_ms().mean))
    };
    let measured = parallel::map(&TRIANGLES, of_size).into_iter().collect::<Result<Vec<_>>>()?;
    let (turns, drawn_ms): (Vec<_>, Vec<_>) = measured.into_iter().unzip();
    let same =
        "greatest difference between the latencies of a turn with 10, 100, 1,000 and 10,000 triangles, field by field";
    // With address recalculation, the latency of rotation must not depend on the number of triangles at all.
    let differences = turns.iter().flat_map(|turn| turn.iter().zip(&turns[0]).map(|(a, b)| a.abs_diff(*b)));
    let greatest = differences.max().filter(|_| turns.iter().all(|turn| turn.len() == COMPARED));
    let grows = "latency of a picture with 10,000 triangles under Rendering Control less that with 10";
    let growth = drawn_ms[3] - drawn_ms[0];
    // The diagram has no numbers, and its curve rises everywhere.
    let rises = growth > 0.0 && drawn_ms.is_sorted();
    let rows = [
        row("A4", same, "ps", [0.0, greatest.map_or(f64::NAN, |ps| ps as f64)], Basis::Free),
        shape("fig. 1", grows, "ms", [f64::NAN, growth], rises),
    ];
    Ok(rows.map(|row| FigureRow { experiment: "E1", ..row }).to_vec())
}

/// Runs an experiment in which the head turns at 200 degrees per second.
fn turned(experiment: Experiment) -> Result<Outcome> {
    let head = Head::new(Arc::new(Pan::at(200.0)), TrackerConfig::ideal(), PredictorKind::None, 1)?;
    Ok(experiment.head(head).fields(FIELDS).pixels(Pixels::Off).run()?)
}

fn totals_ps(latencies: &[RotationLatency]) -> Vec<u64> {
    latencies.iter().take(COMPARED).map(|latency| latency.total().0).collect()
}
