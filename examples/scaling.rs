//! Measures how host time and simulated latency grow with the size of scenes and machines.
//!
//! Prints tables of growth in Markdown: `cargo run --release --example scaling`.

use pxpl5::{
    Experiment, ExperimentError, MachineConfig, Measured, Pixels, RenderingControl, Statistics, TestScene, Workstation,
    in_parallel, scene::builtin,
};
use std::fmt::Write as _;
use std::sync::Arc;

/// Size and result of one run. If no frame was shown, `frames` and all members below it are zero.
#[derive(Default)]
struct Point {
    /// Number of triangles and spheres in the scene.
    primitives: usize,
    /// Number of graphics processors, including the master.
    n_gps: usize,
    /// Number of renderers, each of 128 x 128 pixels.
    n_renderers: usize,
    /// Number of complete stereo frames shown during the run.
    frames: usize,
    /// Host time per simulated frame in milliseconds, without pixels: the fastest of three runs.
    host_ms: f64,
    /// Mean latency of a frame in display fields.
    latency_fields: f64,
    /// Frames per second of simulated time, or 0 for fewer than two frames.
    updates_hz: f64,
}

/// Triangles in the test scenes for a machine of 50 graphics processors (GPs) and 5 renderers.
const TRIANGLES: [u32; 7] = [12, 100, 1_000, 10_000, 100_000, 300_000, 1_000_000];

/// Triangles in the scenes for machines of all sizes: a typical scene of 1994, and the built-in head.
const SCENES: [u32; 2] = [10_000, 59_592];

/// Numbers of GPs and of renderers. Each machine draws all scenes in [`SCENES`].
const MACHINES: [(usize, usize); 9] = [(2, 5), (4, 5), (13, 5), (24, 5), (50, 5), (13, 1), (13, 2), (13, 10), (13, 20)];

/// Memory of a GP in bytes. A million triangles do not fit into 50 real graphics processors with 8 MB each.
const MEMORY_BYTES: u64 = 1 << 30;

/// Nanoseconds to process a triangle: in a graphics processor, and in renderers for the 1.35 regions under a triangle.
/// The length of a run is computed from these times.
const TRIANGLE_NS: (u64, u64) = (24_000, 9_200);

const FRAMES: u64 = 30;

/// Returns the number of display periods in which a run shows [`FRAMES`] stereo frames.
fn fields(config: &MachineConfig, triangles: u64) -> Result<u64, ExperimentError> {
    let slaves = config.n_gps as u64 - 1;
    let renderers = config.n_renderers as u64;
    let frame_ns = 2 * triangles * (TRIANGLE_NS.0 / slaves + TRIANGLE_NS.1 / renderers);
    let period_ns = config.period()?.0 / 1_000;
    Ok(50 + FRAMES * frame_ns / period_ns)
}

fn run(triangles: u32, n_gps: usize, n_renderers: usize) -> Result<Point, ExperimentError> {
    let mut fastest = run_once(triangles, n_gps, n_renderers)?;
    for _ in 1..3 {
        fastest.host_ms = fastest.host_ms.min(run_once(triangles, n_gps, n_renderers)?.host_ms);
    }
    Ok(fastest)
}

fn run_once(triangles: u32, n_gps: usize, n_renderers: usize) -> Result<Point, ExperimentError> {
    let mut config = MachineConfig { n_gps, n_renderers, ..MachineConfig::preset("large")? };
    // The memory of a real board would limit the scenes.
    config.gp.memory_bytes = MEMORY_BYTES;
    config.gp.bin_bytes = MEMORY_BYTES;
    let fields = fields(&config, u64::from(triangles))?;
    let scene = TestScene::Typical.with_triangles(triangles);
    let experiment = Experiment::new(config, RenderingControl::stereo(), scene).fields(fields).pixels(Pixels::Off);
    let run = experiment.host(Workstation::new()).run();
    let primitives = triangles as usize;
    // A machine that shows no frame in time still has a row.
    let outcome = match run {
        Err(ExperimentError::TooShort { .. }) => {
            return Ok(Point { primitives, n_gps, n_renderers, ..Point::default() });
        }
        other => other?,
    };
    let report = outcome.report();
    let frames = outcome.pictures().len();
    Ok(Point {
        primitives,
        n_gps,
        n_renderers,
        frames,
        host_ms: report.host_seconds.unwrap_or(f64::NAN) * 1e3 / frames.max(1) as f64,
        latency_fields: report.latency_fields.statistics.mean,
        updates_hz: report.updates_hz.unwrap_or_default(),
    })
}

/// Simulates scenes of 12 to a million triangles on a machine of 50 GPs and 5 renderers.
///
/// # Errors
///
/// Returns the first [`ExperimentError`].
fn by_triangles() -> Result<Vec<Point>, ExperimentError> {
    TRIANGLES.into_iter().map(|triangles| run(triangles, 50, 5)).collect()
}

/// Simulates scenes of 10,000 and 59,592 triangles on machines of 2 to 50 GPs and 1 to 20 renderers.
///
/// # Errors
///
/// Returns the first [`ExperimentError`].
fn by_machine() -> Result<Vec<Point>, ExperimentError> {
    let all = SCENES.into_iter().flat_map(|scene| MACHINES.map(|machine| (scene, machine)));
    all.map(|(triangles, (n_gps, n_renderers))| run(triangles, n_gps, n_renderers)).collect()
}

/// Result of an application scene on a machine preset. The papers do not state which machine drew the scene.
struct Application {
    /// Name of the built-in scene.
    scene: &'static str,
    /// Name of the machine's preset.
    machine: &'static str,
    /// Mean and standard deviation of the latency in fields, over the frames of all seeds.
    latency_fields: [f64; 2],
    /// Frames per second of simulated time.
    updates_hz: f64,
    /// Number of frames of all seeds after the warm-up.
    frames: usize,
}

const SEEDS: u64 = 30;
/// Number of display fields in a run of an application scene: the warm-up and 300 frames at 30 Hz.
const FIELDS: u64 = 616;

/// Simulates the scenes `mig`, `molecules` and `head` on the machine presets `small-hmd`, `medium` and `large`.
///
/// # Errors
///
/// Returns the first [`ExperimentError`].
fn applications() -> Result<Vec<Application>, ExperimentError> {
    let mut all = Vec::new();
    for scene in ["mig", "molecules", "head"] {
        for machine in ["small-hmd", "medium", "large"] {
            all.push(application(scene, machine)?);
        }
    }
    Ok(all)
}

fn application(scene: &'static str, machine: &'static str) -> Result<Application, ExperimentError> {
    let built = Arc::new(builtin(scene)?);
    let config = MachineConfig::preset(machine)?;
    let experiment = Experiment::new(config, RenderingControl::stereo(), built).fields(FIELDS).pixels(Pixels::Off);
    let seeds: Vec<u64> = (1..=SEEDS).collect();
    let mut latencies = Vec::new();
    let mut hz = 0.0;
    // Pool the latencies of all seeds, and average their rates.
    for outcome in in_parallel(&seeds, |seed| run_seed(&experiment, *seed)) {
        let (of_seed, updates_hz) = outcome.map_err(ExperimentError::Stopped)?;
        latencies.extend(of_seed);
        hz += updates_hz / SEEDS as f64;
    }
    let frames = latencies.len();
    let fields = Statistics::of(latencies.into_iter());
    Ok(Application { scene, machine, latency_fields: [fields.mean, fields.sd], updates_hz: hz, frames })
}

/// Simulates the head motion of one seed. Returns the latency of each frame in fields, and the frames per second.
fn run_seed(experiment: &Experiment, seed: u64) -> Result<(Vec<f64>, f64), String> {
    let outcome = experiment.clone().seed(seed).run().map_err(|error| error.to_string())?;
    let pictures = outcome.complete_pictures();
    let latencies = pictures.map(|times| (times.shown_at - times.transform_at).as_ms() / outcome.field_ms());
    Ok((latencies.collect(), outcome.report().updates_hz.unwrap_or_default()))
}

/// Returns the exponent of a power law fitted to points: the slope of a straight line through their logarithms.
fn exponent(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<_> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let n = logs.len() as f64;
    let mean_x = logs.iter().map(|p| p.0).sum::<f64>() / n;
    let mean_y = logs.iter().map(|p| p.1).sum::<f64>() / n;
    let products: f64 = logs.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y)).sum();
    products / logs.iter().map(|p| (p.0 - mean_x) * (p.0 - mean_x)).sum::<f64>()
}

/// Returns a text in Markdown: tables, exponents and a chart.
fn markdown(triangles: &[Point], machines: &[Point], applications: &[Application]) -> String {
    let mut text = format!(
        "# Growth\n\nThe example `scaling` wrote this text. All runs use Rendering Control in stereo. Each\n\
         triangle covers 18 pixels, and the runs compute no pixels. The GPs have 1 GB of memory instead of 8 MB. The host time is\n\
         the computing time of the simulation, the fastest of three runs on one computer.\n\n\
         ## Triangles, on 50 GPs and 5 renderers\n\n\
         For 1,000 triangles and more, the host time grows with the power {:.2} of the number of triangles. For 100,000 triangles\n\
         and more, the host time grows with the power {:.2} of the number of triangles. With fewer than 100,000 triangles, the\n\
         tokens of 40 regions cost more host time than the triangles, because every GP receives and sends each token. For 100,000\n\
         triangles and more, the simulated latency grows with the power {:.2} of the number of triangles. Below 100,000 triangles,\n\
         COPY is the bottleneck.\n\n",
        power(triangles, 1_000, |p| p.host_ms),
        power(triangles, 100_000, |p| p.host_ms),
        power(triangles, 100_000, |p| p.latency_fields),
    );
    // First the growth with triangles, then the growth with boards.
    table(&mut text, triangles);
    text.push_str("\n```text\n");
    chart(&mut text, triangles);
    text.push_str("```\n\n## Machines\n\n");
    for scene in SCENES {
        let _ = writeln!(
            text,
            "With {scene} triangles, 50 GPs instead of 13 take {:.0} % more host time per frame. With 20 renderers instead of 5, a frame takes\n\
             {:.0} % more host time.\n",
            more_host_time(machines, scene as usize, (50, 5)).unwrap_or(f64::NAN),
            more_host_time(machines, scene as usize, (13, 20)).unwrap_or(f64::NAN)
        );
    }
    table(&mut text, machines);
    text.push_str(
        "\n## Application scenes\n\nThe papers do not state which machine drew their application scenes, so the table has results for three machines. Each\n\
         result is the mean over runs with 30 seeds of the head motion. A run has 616 fields: a short warm-up, and then about\n\
         300 frames at 30 Hz. The column *frames* gives the number of frames in all runs together, after the warm-up. The\n\
         published latency of the Mig is 4.61 fields with a standard deviation of 0.589 fields.\n\n\
         | scene | machine | latency, fields | sd | frames/s | frames |\n|---|---|---|---|---|---|\n",
    );
    // The papers' scenes on three possible machines.
    for a in applications {
        let [mean, sd] = a.latency_fields;
        let _ = writeln!(
            text,
            "| {} | {} | {mean:.2} | {sd:.3} | {:.2} | {} |",
            a.scene, a.machine, a.updates_hz, a.frames
        );
    }
    text.push_str(
        "\nThe column *latency* gives the latency of the pair of eyes in fields (`latency_fields`), with back faces. Figure 7 has\n\
         lower values for two reasons. First, figure 7 counts whole retraces of each eye separately. Second, figure 7 leaves out\n\
         back faces ([One scene, several latencies](guide/latency.md#one-scene-several-latencies)).\n",
    );
    text
}

/// Returns the exponent of the power law by which a quantity grows with the number of primitives, over runs with at
/// least `from` primitives.
fn power(points: &[Point], from: usize, of: impl Fn(&Point) -> f64) -> f64 {
    let large = points.iter().filter(|p| p.primitives >= from && p.frames > 0);
    exponent(&large.map(|p| (p.primitives as f64, of(p))).collect::<Vec<_>>())
}

/// Returns the additional host time per frame, in percent of the time with 13 GPs and 5 renderers.
fn more_host_time(points: &[Point], primitives: usize, machine: (usize, usize)) -> Option<f64> {
    let other_ms = host_ms(points, primitives, machine)?;
    Some((other_ms / host_ms(points, primitives, (13, 5))? - 1.0) * 100.0)
}

/// Returns the host time per frame in milliseconds, or `None` if no frame was shown.
fn host_ms(points: &[Point], primitives: usize, (n_gps, n_renderers): (usize, usize)) -> Option<f64> {
    let mut shown = points.iter().filter(|p| p.frames > 0);
    let point = shown.find(|p| (p.primitives, p.n_gps, p.n_renderers) == (primitives, n_gps, n_renderers))?;
    Some(point.host_ms)
}

fn table(text: &mut String, points: &[Point]) {
    text.push_str(
        "| triangles | GPs | renderers | host ms a frame | latency, fields | frames/s |\n|---|---|---|---|---|---|\n",
    );
    for p in points.iter().filter(|p| p.frames == 0) {
        let _ = writeln!(text, "| {} | {} | {} | no frame was shown | | |", p.primitives, p.n_gps, p.n_renderers);
    }
    for p in points.iter().filter(|p| p.frames > 0) {
        let _ = writeln!(
            text,
            "| {} | {} | {} | {:.2} | {:.2} | {:.2} |",
            p.primitives, p.n_gps, p.n_renderers, p.host_ms, p.latency_fields, p.updates_hz
        );
    }
}

/// Writes a chart of the host time for each number of triangles, with logarithmic axes. Each row is one scene size, and
/// each column is a tenth of a decade of host time.
fn chart(text: &mut String, points: &[Point]) {
    let least = points.iter().filter(|p| p.frames > 0).map(|p| p.host_ms).fold(f64::INFINITY, f64::min).log10().floor();
    for p in points.iter().filter(|p| p.frames > 0) {
        let column = ((p.host_ms.log10() - least) * 10.0).round() as usize;
        let _ = writeln!(text, "{:>9} |{}* {:.2} ms", p.primitives, " ".repeat(column), p.host_ms);
    }
    let _ = writeln!(
        text,
        "{:>9} +{} log10(host ms a frame), from {:.0e} ms",
        "triangles",
        "-".repeat(50),
        10_f64.powf(least)
    );
}

fn main() -> Result<(), ExperimentError> {
    print!("{}", markdown(&by_triangles()?, &by_machine()?, &applications()?));
    Ok(())
}
