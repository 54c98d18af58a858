//! `pxpl5 compare`: every way to fight latency side by side.

use crate::error::CliError;
use crate::options::registry;
use crate::output::OutputFolder;
use crate::terminal;
use pxpl5::compare::{Comparison, Row, compare_with, edge_pictures, motion, predictor, tracker};
use pxpl5::views::charts::{LatencyCurve, error_chart};
use pxpl5::{Head, MachineConfig, scene};
use std::fmt::Write as _;
use std::io::Cursor;
use std::path::PathBuf;
use std::sync::Arc;

/// What is compared.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 compare --motion pan:200 --scene mig --tracker fastrak
  pxpl5 compare --motion head.csv --predict none --out out/compare
  pxpl5 compare --motion synthetic:1 --fields 600 --no-triangles --json

To run one of them alone, with pictures: pxpl5 run --pipeline jitp-scanline-racing --head pan:200.")]
pub(crate) struct CompareArgs {
    /// How the head moves: still, pan:DEG_PER_S, pendulum, synthetic:SEED, or a recording FILE.csv with the columns
    /// time_s,x,y,z,qw,qx,qy,qz.
    #[arg(long, default_value = "synthetic:1", value_name = "MOTION", allow_hyphen_values = true)]
    motion: String,
    /// A built-in scene (see `pxpl5 scenes`) or a model file: .ply, .obj, .pdb.
    #[arg(long, default_value = "full-screen:4", value_name = "NAME|FILE")]
    scene: String,
    /// optical, fastrak, flock, flock-patched, 3space or ideal.
    #[arg(long, default_value = "optical")]
    tracker: String,
    /// none, velocity, acceleration or kalman.
    #[arg(long, default_value = "kalman")]
    predict: String,
    /// Preset of the machine (see `pxpl5 machines`).
    #[arg(long, default_value = "small-hmd", value_name = "PRESET")]
    machine: String,
    /// NTSC fields to simulate (1/60 s each).
    #[arg(long, default_value_t = 300, value_name = "N")]
    fields: u64,
    /// Seed of the tracker's noise and of the host's polling.
    #[arg(long, default_value_t = 1, value_name = "S")]
    seed: u64,
    /// Do not search for the most triangles that each pipeline can draw in time.
    #[arg(long)]
    no_triangles: bool,
    /// Write comparison.json, error.svg (90 ms against 50 ms) and the pictures of a vertical edge into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Speed of the pan of the pictures, degrees per second.
    #[arg(long, default_value_t = 200.0, value_name = "DEG_PER_S", allow_negative_numbers = true)]
    edge_pan: f64,
    /// Print JSON: an object whose `pipelines` lists a row each.
    #[arg(long)]
    json: bool,
    /// Print nothing but errors (and the object of --json).
    #[arg(long, short)]
    quiet: bool,
}

/// Runs the comparison.
///
/// # Errors
///
/// What is wrong with an option, or why a file cannot be written.
pub(crate) fn run(args: CompareArgs) -> Result<(), CliError> {
    let config = MachineConfig::preset(&args.machine).map_err(CliError::usage)?;
    let moving = motion(&args.motion).map_err(CliError::usage)?;
    let tracker = tracker(&args.tracker).map_err(CliError::usage)?;
    let predictor = predictor(&args.predict).map_err(CliError::usage)?;
    let scene = Arc::new(load(&args.scene)?);
    let head = Arc::new(Head::new(moving, tracker, predictor, args.seed).map_err(CliError::usage)?);
    let mut folder = args.out.as_deref().map(OutputFolder::open).transpose()?;
    let bar = terminal::progress(0, "pipelines", args.quiet);
    let finished = |done, of| {
        bar.set_length(of);
        bar.set_position(done);
    };
    let comparison = compare_with(&registry(), &config, &scene, &head, args.fields, !args.no_triangles, finished)?;
    bar.finish_and_clear();
    let json = serde_json::to_string_pretty(&comparison).map_err(CliError::failure)? + "\n";
    if let Some(folder) = &mut folder {
        folder.put("comparison.json", json.as_bytes())?;
        folder.put("error.svg", nominal_chart(&args, &head).as_bytes())?;
        pictures(&config, args.edge_pan, folder)?;
    }
    folder.map(OutputFolder::commit).transpose()?;
    match (args.json, args.quiet) {
        (true, _) => terminal::print(&json),
        (false, true) => Ok(()),
        (false, false) => terminal::print(&table(&comparison, &args)),
    }
}

fn load(name: &str) -> Result<scene::Scene, CliError> {
    let is_file = [".ply", ".obj", ".pdb"].iter().any(|end| name.to_ascii_lowercase().ends_with(end));
    if is_file { scene::load(name).map_err(CliError::failure) } else { scene::builtin(name).map_err(CliError::usage) }
}

/// Longest stretch of a motion that a chart shows, seconds.
const CHART_S: u64 = 30;

/// As in I3D95: the error in the middle of the picture against time, for its two latencies.
fn nominal_chart(args: &CompareArgs, head: &Head) -> String {
    let seconds = (args.fields / 60).clamp(2, CHART_S);
    let curves = [90, 50].map(|ms| LatencyCurve::of(head.motion(), ms, seconds, 1.0));
    error_chart(&format!("{}: 90 ms (Rendering Control) and 50 ms (Slats), no prediction", args.motion), &curves)
}

fn pictures(config: &MachineConfig, deg_per_s: f64, folder: &mut OutputFolder) -> Result<(), CliError> {
    let plates = edge_pictures(config, deg_per_s)?;
    for (name, picture) in [
        ("edge-conventional-computed.png", &plates.conventional),
        ("edge-conventional-seen.png", &plates.conventional_seen),
        ("edge-just-in-time-computed.png", &plates.just_in_time),
        ("edge-just-in-time-seen.png", &plates.just_in_time_seen),
    ] {
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, image::ImageFormat::Png).map_err(CliError::failure)?;
        folder.put(name, bytes.get_ref())?;
    }
    Ok(())
}

fn table(comparison: &Comparison, args: &CompareArgs) -> String {
    let Comparison { scene, triangles, tracker, predictor, fields, machine, .. } = comparison;
    let mut text = format!(
        "{scene} ({triangles} triangles) on {machine}, {} for {fields} fields, {tracker}, prediction {predictor}\n\n",
        args.motion
    );
    let _ = writeln!(
        text,
        "{:<24} {:>9} {:>9} {:>8} {:>7} {:>9} {:>9} {:>9} {:>10}",
        "pipeline", "machine", "to light", "updates", "missed", "error", "99 %", "error", "triangles"
    );
    let _ = writeln!(
        text,
        "{:<24} {:>9} {:>9} {:>8} {:>7} {:>9} {:>9} {:>9} {:>10}",
        "", "ms", "ms", "Hz", "", "px", "px", "deg", "possible"
    );
    comparison.pipelines.iter().for_each(|row| text.push_str(&line(row)));
    text
}

/// A number, or a dash for one that is not known.
fn shown(value: f64, is_known: bool) -> String {
    if is_known { format!("{value:.2}") } else { "-".to_owned() }
}

fn line(row: &Row) -> String {
    if let Some(failure) = &row.failure {
        return format!("{:<24} {failure}\n", row.pipeline);
    }
    let judged = row.error.judged > 0;
    let timed = row.end_to_end.pictures > 0;
    format!(
        "{:<24} {:>9} {:>9} {:>8} {:>7} {:>9} {:>9} {:>9} {:>10}\n",
        row.pipeline,
        shown(row.latency_ms, row.latency_ms > 0.0),
        shown(row.end_to_end.total_ms, timed),
        row.updates_hz.map_or_else(|| "-".to_owned(), |hz| format!("{hz:.2}")),
        row.missed_retraces,
        shown(row.error.pixels.mean, judged),
        shown(row.error.pixels.p99, judged),
        shown(row.error.degrees.mean, judged),
        row.triangles_possible.map_or_else(|| "-".to_owned(), |n| n.to_string())
    )
}
