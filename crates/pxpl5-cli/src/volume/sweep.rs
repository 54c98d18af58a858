//! The command `pxpl5 volume sweep`, which draws a volume at every point of a parameter space. The output folder, the
//! rows and `--resume` work as in `pxpl5 sweep`.

use super::settings::{SMALLER, load};
use super::space::VolumeSpace;
use crate::budget::BudgetArgs;
use crate::error::CliError;
use crate::estimate::{Estimate, VolumeWork};
use crate::leaves::plain;
use crate::numbers::whole;
use crate::sweep::{report_failures, report_rows_path, shard};
use crate::terminal::progress;
use crate::version::VERSION;
use clap::Args;
use pxpl5::Fingerprint;
use pxpl5::scene::Scene;
use pxpl5::sweep::{Header, Shard, Status, Store, SweepRow, hash_of_model};
use pxpl5::volume::spatialgl::{CommandBuffer, OneThread, Threads};
use pxpl5::volume::{Volume, VolumeSettings};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::num::NonZero;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// Draw a volume at every point of a parameter space.
///
/// Each finished point appends a row to rows.jsonl. A point that cannot be drawn has a row with the reason; the
/// command fails only if no point can be drawn.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 volume sweep experiments/volumes/sweep.toml --out out/volumes
  pxpl5 volume sweep experiments/volumes/sweep.toml --out out/volumes --resume     after an interruption
  pxpl5 volume sweep experiments/volumes/sweep.toml --out out/one --shard 1/4      one of four shares; see `pxpl5 merge`

The file has `scene`, `triangles`, `title`, `measure` and any setting by its path. The key `measure` lists numbers of the report
pxpl5-volume/1, such as lit_voxels or model_ms.gpu.ms. The tables [sweep.grid] and [sweep.together] and the key sweep.seeds are those of
files for `pxpl5 sweep`.")]
pub(super) struct SweepArgs {
    /// File with a table `sweep`.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Folder for rows.jsonl, times.jsonl and results.csv.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Keep the finished points and draw only the others.
    #[arg(long)]
    resume: bool,
    /// Draw only share I of N disjoint shares of the points.
    #[arg(long, value_name = "I/N", value_parser = shard, default_value = "1/1")]
    shard: Shard,
    /// Number of worker threads for each volume; default: one for each core. Volumes are drawn one after the other.
    #[arg(long, value_name = "N", value_parser = whole::<u64>(1, 1024))]
    threads: Option<u64>,
    /// Set any key of the file for all points; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
    #[command(flatten)]
    budget: BudgetArgs,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

pub(super) fn run(args: SweepArgs) -> Result<(), CliError> {
    let space = VolumeSpace::load(&args.file, &args.sets)?;
    let definitions = definitions(&space)?;
    let mut store = Store::open(&args.out, header(&space, definitions)?, args.resume)?;
    let threads = args.threads.and_then(|threads| NonZero::new(threads as usize)).map_or_else(Threads::all, Threads);
    let ours: Vec<u64> = (0..space.points).filter(|point| args.shard.holds(*point)).collect();
    let bar = progress(ours.len() as u64, "volumes", args.quiet);
    let mut scenes = Scenes::default();
    // Draw every point of this shard that has no row yet. Volumes use all threads, so they follow each other.
    for point in &ours {
        if !store.holds(*point) {
            let begun = Instant::now();
            let row = row(&space, *point, &mut scenes, (&threads, args.budget));
            store.append(&row, begun.elapsed().as_secs_f64())?;
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    let total = ours.len() as u64;
    let failed = report_failures(&store, args.shard, total, "drawn")?;
    report_rows_path(&args.out, total, args.quiet)?;
    store.finish()?;
    if failed >= total { Err(CliError::failure("no point could be drawn")) } else { Ok(()) }
}

/// Returns the measured quantities with their definitions.
///
/// # Errors
///
/// Fails if a report lacks one of the quantities.
fn definitions(space: &VolumeSpace) -> Result<BTreeMap<String, String>, CliError> {
    // A tiny volume without primitives yields a report with all names.
    let mut settings = VolumeSettings::paper();
    for (path, text) in [("display.slices", "4"), ("display.width", "8"), ("display.height", "8")] {
        settings.set(path, text, "a dark volume")?;
    }
    let dark = Volume::draw_commands(&settings, "dark", CommandBuffer::default(), &OneThread)?;
    let report = serde_json::to_value(dark.report()).map_err(CliError::failure)?;
    let known = |name: &str| {
        let top = name.split('.').next().unwrap_or_default();
        let is_number = value_of(&report, name).is_some_and(|value| value.is_number() || value.is_null());
        // Quantities that only some volumes have are null in the report of an empty volume.
        let is_of_some = report.get(top).is_some_and(Value::is_null);
        name != "host_seconds" && (is_number || is_of_some)
    };
    for name in &space.measure {
        if !known(name) {
            let numbers = report.as_object().into_iter().flatten().filter(|(_, value)| value.is_number());
            let names: Vec<&str> =
                numbers.map(|(name, _)| name.as_str()).filter(|name| *name != "host_seconds").collect();
            let names = names.join(", ");
            return Err(CliError::usage(format!("measure: expected numbers of the report ({names}), found {name}")));
        }
    }
    Ok(space.measure.iter().map(|name| (name.clone(), "as in the report pxpl5-volume/1".to_owned())).collect())
}

/// Returns the value in a JSON report at a path of names separated by dots.
fn value_of<'a>(report: &'a Value, path: &str) -> Option<&'a Value> {
    path.split('.').try_fold(report, |value, name| value.get(name))
}

fn header(space: &VolumeSpace, measure: BTreeMap<String, String>) -> Result<Header, CliError> {
    let json_of = |value: &toml::Value| serde_json::to_value(value).unwrap_or_default();
    let settings: BTreeMap<&String, Value> =
        space.settings.iter().map(|(path, value)| (path, json_of(value))).collect();
    let axes: Vec<Value> = space
        .axes
        .iter()
        .map(|axis| {
            let steps: Vec<Vec<Value>> = (0..axis.len()).map(|n| axis.step(n).iter().map(json_of).collect()).collect();
            json!({ "paths": axis.paths, "steps": steps })
        })
        .collect();
    // The hash also covers the scenes of model files, so that a changed file is not resumed.
    let version = VERSION;
    let inputs: Vec<String> =
        scene_files(space).iter().map(|path| format!("{}={}", path.display(), hash_of_model(path))).collect();
    // The hash covers everything that determines the rows.
    let named = json!([version, settings, axes, measure, inputs]).to_string();
    let seed = space.settings.get("seed").and_then(toml::Value::as_integer).unwrap_or(1);
    serde_json::from_value(json!({
        "schema": Header::SCHEMA,
        "version": version,
        "machine": "perspecta",
        "config_hash": Fingerprint::of(named.as_bytes()).to_string(),
        "level": "volume",
        "seed": seed,
        "title": space.title,
        "points": space.points,
        "measure": measure,
        "settings": settings,
        "axes": axes,
    }))
    .map_err(CliError::failure)
}

/// Returns the paths of all model files that points of the sweep name.
fn scene_files(space: &VolumeSpace) -> Vec<PathBuf> {
    let of_axes = space.axes.iter().flat_map(|axis| {
        let at = axis.paths.iter().position(|path| path == "scene");
        at.into_iter().flat_map(move |at| (0..axis.len()).map(move |n| plain(&axis.step(n)[at])))
    });
    let all = space.settings.get("scene").map(plain).into_iter().chain(of_axes);
    all.map(PathBuf::from).filter(|path| path.is_file()).collect()
}

/// A cache of loaded scenes by name and number of primitives.
#[derive(Default)]
struct Scenes(BTreeMap<(String, Option<u64>), Arc<Scene>>);

impl Scenes {
    fn get(&mut self, name: &str, triangles: Option<u64>) -> Result<Arc<Scene>, CliError> {
        let key = (name.to_owned(), triangles);
        if let Some(scene) = self.0.get(&key) {
            return Ok(Arc::clone(scene));
        }
        let scene = load(name, triangles)?;
        self.0.insert(key, Arc::clone(&scene));
        Ok(scene)
    }
}

/// Draws the volume at a point and returns its row. An error is stored in the row.
fn row(space: &VolumeSpace, point: u64, scenes: &mut Scenes, how: (&Threads, BudgetArgs)) -> SweepRow {
    let own = space.of_point(point);
    let parameters: BTreeMap<String, Value> =
        own.iter().map(|(path, value)| (path.clone(), serde_json::to_value(value).unwrap_or_default())).collect();
    let mut all = space.settings.clone();
    all.extend(own);
    let empty = SweepRow {
        point,
        status: Status::Failed,
        parameters,
        measured: BTreeMap::new(),
        config_hash: None,
        trace_hash: None,
        error: None,
    };
    // Errors become part of the row, so that the other points go on.
    match drawn(&all, point, scenes, how) {
        Ok(volume) => {
            let report = serde_json::to_value(volume.report()).unwrap_or_default();
            let of = |name: &String| (name.clone(), value_of(&report, name).and_then(Value::as_f64));
            let named: Vec<String> = all.iter().map(|(path, value)| format!("{path}={}", plain(value))).collect();
            SweepRow {
                status: Status::Done,
                measured: space.measure.iter().map(of).collect(),
                config_hash: Some(Fingerprint::of(named.join("\n").as_bytes()).to_string()),
                trace_hash: report["volume_hash"].as_str().map(str::to_owned),
                ..empty
            }
        }
        Err(error) => SweepRow { error: Some(error.message().to_owned()), ..empty },
    }
}

fn drawn(
    all: &BTreeMap<String, toml::Value>,
    point: u64,
    scenes: &mut Scenes,
    (threads, budget): (&Threads, BudgetArgs),
) -> Result<Volume, CliError> {
    let mut settings = VolumeSettings::paper();
    let place = format!("point {point}");
    for (path, value) in all.iter().filter(|(path, _)| *path != "scene" && *path != "triangles") {
        settings.set(path, &plain(value), &place)?;
    }
    let name = all.get("scene").map_or_else(|| "mig".to_owned(), plain);
    // `scene` and `triangles` are not settings of the volume.
    let triangles = match all.get("triangles").map(plain) {
        None => None,
        Some(text) => Some(text.parse::<u64>().ok().filter(|count| *count > 0).ok_or_else(|| {
            CliError::usage(format!("{place}: triangles: expected a whole number from 1 on, found {text}"))
        })?),
    };
    let scene = scenes.get(&name, triangles)?;
    settings.swept_display()?;
    // Each point has to fit the budget by itself.
    let one = VolumeWork::of(&settings, &scene, threads.0.get()).estimate();
    let seconds = one.seconds / threads.0.get() as f64;
    budget.admit_estimate(Estimate { seconds, ..one }, SMALLER)?;
    Ok(Volume::draw(&settings, &scene, threads)?)
}
