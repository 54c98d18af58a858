//! The experiments that simulate the figures of Rendering Control.

use crate::edges::to_other_retraces;
use crate::figures::applications::key_of;
use crate::figures::interpretation::{FieldCount, Interpretation, LatencySamples};
use crate::figures::rig_lines;
use crate::figures::settings::FigureSettings;
use crate::figures::value::{DEVIATION, EXACT, FigureValue, Result, WHOLE, detail, rate_hz};
use crate::parallel;
use pphigs::{BIN_ENTRY_BYTES, Picture, RegionBinning, Shading, Share, TransformCost};
use pxpl5_analytic::{StereoModel, stereo_loads};
use pxpl5_geometry::Viewport;
use pxpl5_machine::MachineConfig;
use pxpl5_renderer::{CommandKind, Layout};
use pxpl5_run::{Experiment, Level, SceneViews, Statistics, Summary, ViewSource, WARM_UP_PICTURES, display_list};
use pxpl5_scene::{Hmd, Scene};
use pxpl5_sim::Time;
use std::sync::Arc;

/// Milliseconds of TRANSFORM, and also of RENDER, for one eye in row 6 of ACCURACY.md. Both stages take longer than
/// COPY. The results for several times are averaged, because the swap waits for a retrace.
const LONG_STAGES_MS: [u64; 7] = [22, 23, 24, 25, 26, 27, 28];

/// Number of display fields in the runs with full bins (rows 16b and 16c of ACCURACY.md). In these runs, a frame takes
/// about 30 fields.
const FIELDS_OF_FULL_BINS: u64 = 600;

/// Number of head poses for each scene when the regions under triangles are counted (row 8 of ACCURACY.md).
const VIEWS: u64 = 40;
/// Picoseconds between two head poses for row 8 of ACCURACY.md.
const VIEW_PERIOD_PS: u64 = 500_000_000_000;

fn stereo(settings: &FigureSettings, machine: MachineConfig) -> Result<Arc<Summary>> {
    settings.controlled(machine, "full-screen:12", 80)
}

/// Runs the experiment of rows 1, 2 and 4 of ACCURACY.md: twelve triangles that cover the screen.
pub(super) fn trivial(settings: &FigureSettings) -> Result<Arc<Summary>> {
    stereo(settings, settings.machine("small-hmd")?)
}

/// Runs the experiment of rows 16b and 16c of ACCURACY.md. The scene has as many screen-filling triangles as fit into
/// the bins according to the papers.
pub(super) fn full_bins(settings: &FigureSettings) -> Result<Arc<Summary>> {
    settings.controlled(settings.machine("small-hmd")?, "full-screen:7700", FIELDS_OF_FULL_BINS)
}

/// Measures row 3 of ACCURACY.md: the latency if all work except COPY takes no time.
pub(super) fn copy_alone(settings: &FigureSettings) -> Result<FigureValue> {
    let mut machine = settings.machine("small-hmd")?;
    let gp = ["message", "triangle", "guard", "bin_entry", "token_entry", "edit", "pass", "structure"];
    let gp = gp.map(|name| format!("gp.{name}_ns"));
    machine.code = None;
    let array = ["triangle", "phong_triangle", "select", "clear", "shade"];
    let array = array.map(|name| format!("renderer.{name}_clocks"));
    for path in gp.iter().chain(&array) {
        machine.set(path, 0)?;
    }
    Ok(spread_ms(Statistics::of(stereo(settings, machine)?.eye_latencies_ms.iter().copied())))
}

/// Computes row 16 of ACCURACY.md: the number of screen-filling triangles whose entries fit into the slaves' bins, for
/// one eye or for both eyes.
pub(super) fn most_in_bins(settings: &FigureSettings) -> Result<FigureValue> {
    let machine = settings.interpreted("small-hmd")?;
    let slaves = machine.n_gps as u64 - 1;
    let regions = u64::from(Viewport::FRAME.grid().regions());
    let of_slave = machine.gp.bin_bytes / (regions * BIN_ENTRY_BYTES) / settings.interpretation.bins;
    Ok(((of_slave * slaves) as f64).into())
}

/// Measures the latency with the pendulum rig (row 17 of ACCURACY.md) for three lines of the photodiode, unless the
/// settings choose one line.
pub(super) fn rig(settings: &FigureSettings) -> Result<FigureValue> {
    match settings.photodiode_line() {
        Some(_) => settings.rig_measurement().map(|measured| rig_lines::rendering(&measured)),
        None => Ok(settings.rig_lines()?.figure()),
    }
}

/// Measures row 17b of ACCURACY.md. The details compare it with the measurement from outside, if events are simulated.
pub(super) fn inside_and_outside(settings: &FigureSettings) -> Result<FigureValue> {
    let summary = trivial(settings)?;
    let value = Statistics::of(settings.interpretation.latencies_ms(&summary).iter().copied()).mean;
    if settings.level == Level::Analytic {
        return Ok(value.into());
    }
    let measured = settings.rig_measurement()?;
    let [inside, outside] = [measured.inside.rendering, measured.outside.rendering].map(|side| side.mean * 1e3);
    let details = vec![
        detail("inside, on demand", inside, "ms"),
        detail("outside, on demand", outside, "ms"),
        detail("outside less inside", outside - value, "ms"),
    ];
    Ok(FigureValue::with(value, details))
}

/// Returns a machine and a scene for which TRANSFORM and RENDER of one eye each take `ms` milliseconds.
///
/// RENDER takes this time because enough triangles cover the screen. Slower renderers would distort the result. Commands
/// behind a full input FIFO, such as a copy command, would then wait longer by the same factor. TRANSFORM takes this
/// time because its code is slow. Slow code of TRANSFORM delays no other stage.
fn stages_of(settings: &FigureSettings, ms: f64) -> Result<(MachineConfig, String)> {
    let mut machine = settings.machine("small-hmd")?;
    let slaves = machine.n_gps as u64 - 1;
    let regions = u64::from(Viewport::FRAME.grid().regions());
    let of_renderer = regions.div_ceil(machine.n_renderers as u64) as f64;
    // Time of a region on a renderer: its triangles, and a constant part.
    let ns = |kind| machine.renderer.span(kind).unwrap_or_default().as_ms() * 1e6;
    let besides_ns = ns(CommandKind::Clear) + ns(CommandKind::Shade) + machine.renderer.backing_block().as_ms() * 1e6;
    let triangles = (ms * 1e6 / of_renderer - besides_ns) / ns(CommandKind::PhongTriangle);
    // All slaves get the same number of triangles.
    let of_slave = ((triangles / slaves as f64).round() as u64).max(1);
    let rest = TransformCost { structures: 1, entries: regions * of_slave, ..TransformCost::PASS };
    machine.set("gp.triangle_ns", ((ms * 1e6) as u64).saturating_sub(rest.ns(&machine.gp)) / of_slave)?;
    machine.code = None;
    Ok((machine, format!("full-screen:{}", of_slave * slaves)))
}

/// Runs equal stages of `ms` milliseconds. Returns the times from TRANSFORM of each frame's first eye to the end of
/// COPY of its second eye, and the summary.
fn frames_to_copy(settings: &FigureSettings, ms: f64) -> Result<(Statistics, Arc<Summary>)> {
    let (machine, scene) = stages_of(settings, ms)?;
    let summary = settings.controlled(machine, &scene, 160)?;
    let second = |samples: &[f64]| samples.iter().skip(1).step_by(2).copied().collect::<Vec<_>>();
    let [to_swap, to_copy] = [&summary.eye_swap_latencies_ms, &summary.eye_latencies_ms].map(|all| second(all));
    // The second eye waits for the retrace after its COPY. The frame's latency to the swap contains this wait, too.
    let waits = to_swap.iter().zip(&to_copy).map(|(swap, copy)| swap - copy);
    Ok((Statistics::of(summary.latencies_ms.iter().zip(waits).map(|(frame, wait)| frame - wait)), summary))
}

pub(super) fn equal_stages(settings: &FigureSettings) -> Result<FigureValue> {
    let (latency, summary) = frames_to_copy(settings, 15.6)?;
    let to_swap = Statistics::of(summary.latencies_ms.iter().copied()).max;
    let details = vec![
        detail("mean", latency.mean, "ms"),
        detail("greatest, to the swap", to_swap, "ms"),
        detail("frames a second", rate_hz(&summary), "Hz"),
    ];
    Ok(FigureValue::with(latency.max, details))
}

pub(super) fn long_stages(settings: &FigureSettings) -> Result<FigureValue> {
    let means = LONG_STAGES_MS.map(|ms| frames_to_copy(settings, ms as f64).map(|(latency, _)| latency.mean));
    let means = means.into_iter().collect::<Result<Vec<_>>>()?;
    Ok(spread_ms(Statistics::of(means.into_iter())))
}

/// Measures rows 7, 7b and 7c of ACCURACY.md: a fly-through of an application scene. The number of seeds is divided by
/// `seeds_of_one`, because larger scenes get fewer fly-throughs.
pub(super) fn application(settings: &FigureSettings, scene: &'static str, seeds_of_one: u64) -> Result<FigureValue> {
    let samples_a_frame = if settings.interpretation.samples == LatencySamples::EachEye { 2 } else { 1 };
    let seeds: Vec<u64> = (1..=settings.seeds.div_ceil(seeds_of_one)).collect();
    // One seed gives one fly-through.
    let summaries = parallel::map(&seeds, |seed| fly_through(settings, scene, *seed, seeds.len() as u64));
    let summaries = summaries.into_iter().collect::<Result<Vec<Arc<Summary>>>>()?;
    let of_seed = |summary: &Arc<Summary>| -> Vec<(f64, f64)> {
        let samples =
            settings.interpretation.latencies_ms(summary).iter().take(samples_a_frame * settings.frames as usize);
        samples.map(|ms| (*ms, summary.field_ms)).collect()
    };
    let latencies: Vec<(f64, f64)> = summaries.iter().flat_map(of_seed).collect();
    // Both definitions of the unit "field" are stated, whatever the interpretation counts.
    let in_fields = |fields| {
        let counted = Interpretation { fields, ..settings.interpretation };
        Statistics::of(latencies.iter().map(|(ms, field_ms)| counted.fields_of(*ms, *field_ms)))
    };
    let all = in_fields(settings.interpretation.fields);
    let (name, other) = match settings.interpretation.fields {
        FieldCount::Exact => (WHOLE, in_fields(FieldCount::Whole)),
        FieldCount::Whole => (EXACT, in_fields(FieldCount::Exact)),
    };
    let details = vec![
        detail(DEVIATION, all.sd, "fields"),
        detail("least", all.min, "fields"),
        detail("greatest", all.max, "fields"),
        detail("samples", latencies.len() as f64, ""),
        detail(name, other.mean, "fields"),
        detail("their deviation", other.sd, "fields"),
    ];
    // The picture that is nearest to an edge counts.
    let edges = summaries.iter().filter_map(|summary| to_other_retraces(summary));
    let nearest = edges.reduce(|[a, b], [c, d]| [a.min(c), b.min(d)]);
    Ok(FigureValue::with(all.mean, details).beside(nearest))
}

fn fly_through(settings: &FigureSettings, scene: &'static str, seed: u64, seeds: u64) -> Result<Arc<Summary>> {
    let experiment = application_experiment(settings, scene, seed)?;
    let drawn = format!("{scene} {} {seeds}", settings.interpretation.culled);
    let key = key_of(&experiment.clone().level(settings.level), &drawn);
    settings.applications.summary(key, || fly_through_once(settings, &experiment, (scene, seed, seeds)))
}

fn fly_through_once(
    settings: &FigureSettings,
    experiment: &Experiment,
    (scene, seed, seeds): (&'static str, u64, u64),
) -> Result<(Summary, bool)> {
    // At the analytic level the loads of all views are computed once for all seeds.
    if settings.level != Level::Analytic {
        return settings.summarise(experiment);
    }
    let of_seed = |seed| Ok(stereo_loads(&application_experiment(settings, scene, seed)?)?);
    let of_seeds = || (1..=seeds).map(of_seed).collect();
    let loads =
        settings.applications.loads((scene, settings.interpretation.culled, seeds, settings.frames), of_seeds)?;
    let model = StereoModel::new(experiment.config(), settings.interpretation.pipeline())?;
    Ok((model.summary(&model.frames(&loads[seed as usize - 1]), experiment.fields), true))
}

/// Returns the experiment of a fly-through, with two display fields for each frame (30 Hz). If frames take longer, the
/// run has fewer frames.
fn application_experiment(settings: &FigureSettings, scene: &'static str, seed: u64) -> Result<Experiment> {
    let fields = 2 * (settings.frames + WARM_UP_PICTURES as u64) + 8;
    let machine = settings.interpreted(settings.interpretation.machine)?;
    let drawn = settings.applications.scene(scene, settings.interpretation.culled)?;
    Ok(Experiment::with(machine, Arc::new(settings.interpretation.pipeline()), drawn).fields(fields).seed(seed))
}

/// Measures row 8 of ACCURACY.md: the number of regions under a triangle, which is the number of bin entries per visible
/// triangle. Each scene is seen from poses along its own head motion. The figure is the mean over three scenes.
pub(super) fn regions_touched(settings: &FigureSettings) -> Result<FigureValue> {
    const SCENES: [&str; 3] = ["mig", "molecules", "head"];
    let of = |binning| {
        SCENES
            .iter()
            .map(|name| touched(&settings.applications.scene(name, false)?, binning, VIEWS))
            .collect::<Result<Vec<_>>>()
    };
    let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len() as f64;
    let [edges, boxes] = [of(RegionBinning::Touched)?, of(RegionBinning::Boxes)?];
    let mut details: Vec<_> = SCENES.iter().zip(&edges).map(|(name, found)| detail(name, *found, "regions")).collect();
    details.push(detail("by bounding boxes", mean(&boxes), "regions"));
    Ok(FigureValue::with(mean(&edges), details))
}

/// Returns the number of bin entries per visible triangle, over both eyes and `n_views` head poses.
fn touched(scene: &Arc<Scene>, binning: RegionBinning, n_views: u64) -> Result<f64> {
    let list = Arc::new(display_list(scene)?);
    let views = SceneViews::new(scene, 1, Hmd::unc(), 2);
    let share = Share::new(list, 0, 1);
    let layout = Layout::rendering_control_phong();
    let picture = Picture { viewport: Viewport::FRAME, shading: Shading::Phong, binning, layout, pixels: false };
    let mut entries = 0u64;
    let mut triangles = 0u64;
    for number in 0..n_views {
        let view = views.newest(pxpl5_wire::ViewNumber(number), Time(number * VIEW_PERIOD_PS));
        for eye in 0..2 {
            // Both eyes of every view count.
            let pass = share.transform(&view, eye, picture);
            let regions = (0..picture.viewport.grid().regions() as u16).map(pxpl5_wire::RegionId);
            entries += regions.map(|region| u64::from(pass.counts(region).triangles)).sum::<u64>();
            triangles += u64::from(pass.screen_counts().triangles);
        }
    }
    Ok(entries as f64 / triangles.max(1) as f64)
}

/// Returns the mean as the value of a figure, with standard deviation, minimum and maximum as details.
pub(super) fn spread_ms(statistics: Statistics) -> FigureValue {
    let Statistics { mean, sd, min, max, .. } = statistics;
    let details = vec![detail(DEVIATION, sd, "ms"), detail("least", min, "ms"), detail("greatest", max, "ms")];
    FigureValue::with(mean, details)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_run::TestScene;
    use pxpl5_scene::config::{TYPICAL_LEG_PX, TYPICAL_SPREAD_PX};

    /// Tests the mean number of regions of a right-angled triangle. Its two short sides are parallel to the region
    /// borders and `leg` pixels long. Its position is random within `TYPICAL_SPREAD_PX`.
    ///
    /// The triangle touches the regions of those pixels whose centres it covers. A short side crosses a border at
    /// `leg - 1` of its possible positions. Four borders separate the columns of regions, which gives the factor
    /// `1 + 4 (leg - 1) / width`. Three borders separate the rows, which gives `1 + 3 (leg - 1) / height`. The product
    /// of both factors is the mean for the triangle's bounding box.
    ///
    /// In some positions, the box contains a point where four regions meet. In half of these positions, the triangle
    /// misses one of the four regions.
    #[test]
    fn triangles_of_18_pixels_and_their_boxes_touch_as_many_regions_as_their_formulas() {
        let [width, height] = TYPICAL_SPREAD_PX;
        let columns = 4.0 * (TYPICAL_LEG_PX - 1.0) / width;
        let rows = 3.0 * (TYPICAL_LEG_PX - 1.0) / height;
        let boxes = (1.0 + columns) * (1.0 + rows);
        let scene = Arc::new(TestScene::Typical.with_triangles(4_000));
        for (binning, expected) in
            [(RegionBinning::Touched, boxes - columns * rows / 2.0), (RegionBinning::Boxes, boxes)]
        {
            let found = touched(&scene, binning, 1).expect("it has triangles");
            // The 4,000 positions sample the average to a few thousandths.
            assert!((found - expected).abs() < 0.005, "{binning:?}: {found}, expected {expected}");
        }
    }
}
