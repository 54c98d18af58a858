//! The command `pxpl5 volume sweep`, which draws a volume at each point of a parameter space. Output folder, rows,
//! shards and `--resume` are the same as for `pxpl5 sweep`.

use super::settings::{SMALLER, scene_choice};
use crate::budget::BudgetArgs;
use crate::error::CliError;
use crate::numbers::{plain, whole};
use crate::settings::table_of;
use crate::sweep::{SweepCommand, SweepFolderArgs};
use crate::version::VERSION;
use clap::Args;
use pxpl5::lab::estimate::Estimate;
use pxpl5::lab::volumes::VolumeQuery;
use pxpl5::sweep::{Header, PointResults, SceneCache, Shard, SweepSpace, Swept, leaves};
use pxpl5::volume::spatialgl::{CommandBuffer, OneThread, Threads};
use pxpl5::volume::{Volume, VolumeSettings};
use pxpl5::{Fingerprint, SettingError, StopFlag, Study, StudyError};
use pxpl5_sim::parameters::{PathSettings, assignment_of};
use serde_json::Value;
use std::collections::BTreeMap;
use std::num::NonZero;
use std::path::Path;

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
    #[command(flatten)]
    folder: SweepFolderArgs,
    /// Number of worker threads for each volume; default: one for each core. Volumes are drawn one after the other.
    #[arg(long, value_name = "N", value_parser = whole::<u64>(1, 1024))]
    threads: Option<u64>,
    #[command(flatten)]
    budget: BudgetArgs,
}

pub(super) fn run(args: SweepArgs) -> Result<(), CliError> {
    let threads = args.threads.and_then(|threads| NonZero::new(threads as usize)).map_or_else(Threads::all, Threads);
    let sweep = VolumeSweep::load(&args.folder.file, &args.folder.sets, threads, args.budget)?;
    let header = sweep.header()?;
    // A volume uses all threads, so volumes are drawn one after the other.
    let command = SweepCommand { name: "volume sweep", verb: "drawn", parallel: 1, threads: args.threads };
    args.folder.run(&sweep, header, &command)
}

const OWN: [&str; 2] = ["scene", "triangles"];

const MEASURED: [&str; 6] = [
    "fragments_accepted",
    "tile_occupancy_percent",
    "lit_voxels",
    "connected_percent",
    "volumes_hz_serial",
    "volumes_hz_overlapped",
];

/// A sweep of volumes: the settings that all points share, and the space of the varied settings.
#[derive(Debug)]
struct VolumeSweep {
    title: Option<String>,
    /// Paths of the measured quantities in the JSON report.
    measure: Vec<String>,
    settings: BTreeMap<String, toml::Value>,
    space: SweepSpace,
    scenes: SceneCache,
    threads: Threads,
    budget: BudgetArgs,
}

impl VolumeSweep {
    /// Reads an experiment file with a sweep of volumes. The settings in `sets` come from the command line and replace
    /// settings of the file.
    fn load(path: &Path, sets: &[String], threads: Threads, budget: BudgetArgs) -> Result<Self, CliError> {
        let (mut file, place) = table_of(path)?;
        let title = file.remove("title").map(|title| plain(&title));
        let measure = measure(file.remove("measure"), &place)?;
        let sweep = file.remove("sweep");
        let mut settings: BTreeMap<String, toml::Value> = leaves(file).into_iter().collect();
        // Settings of the command line override the file.
        for assignment in sets {
            let (path, value) = assignment_of(assignment, "--set")?;
            settings.insert(path.to_owned(), toml::Value::from(value));
        }
        // Every path must exist before any volume is drawn.
        let keys = VolumeSettings::paper().keys();
        let key_of = |path: &str, place: &str| known_key(&keys, path, place);
        settings.keys().try_for_each(|path| key_of(path, &place).map(|_| ()))?;
        let space = SweepSpace::read(sweep.as_ref(), (&place, &BTreeMap::new()), key_of)?;
        Ok(Self { title, measure, settings, space, scenes: SceneCache::default(), threads, budget })
    }

    fn header(&self) -> Result<Header, CliError> {
        let json_of = |value: &toml::Value| serde_json::to_value(value).unwrap_or_default();
        let definitions = self.definitions()?;
        let header = Header {
            schema: Header::SCHEMA.to_owned(),
            version: VERSION.to_owned(),
            machine: "perspecta".to_owned(),
            config_hash: String::new(),
            level: "volume".to_owned(),
            seed: self.settings.get("seed").and_then(toml::Value::as_integer).map_or(1, |seed| seed as u64),
            title: self.title.clone(),
            points: self.space.points(),
            measure: definitions,
            settings: self.settings.iter().map(|(path, value)| (path.clone(), json_of(value))).collect(),
            axes: self.space.records(),
        };
        // The hash also covers the contents of model files, so that a changed file is not resumed.
        let scenes = self.settings.get("scene").into_iter().chain(self.space.listed("scene")).map(plain);
        let files = scenes.filter_map(|name| Some((Fingerprint::of(&std::fs::read(&name).ok()?), name)));
        let inputs = files.map(|(contents, name)| (name, contents)).collect();
        Ok(header.with_hash("", self.measure.iter().map(String::as_str), &inputs))
    }

    /// Returns the measured quantities with their definitions. Fails if a report lacks one of the quantities.
    fn definitions(&self) -> Result<BTreeMap<String, String>, CliError> {
        // A tiny volume without primitives yields a report with all names.
        let mut settings = VolumeSettings::paper();
        for (path, text) in [("display.slices", "4"), ("display.width", "8"), ("display.height", "8")] {
            settings.set(path, text, "a dark volume")?;
        }
        let dark = Volume::draw_commands(&settings, "dark", CommandBuffer::default(), &OneThread)?;
        let report = serde_json::to_value(dark.report()).map_err(CliError::failure)?;
        let is_measured = |name: &str| {
            let top = name.split('.').next().unwrap_or_default();
            let is_number = value_of(&report, name).is_some_and(|value| value.is_number() || value.is_null());
            // Quantities that only some volumes have are null in the report of an empty volume.
            let is_of_some = report.get(top).is_some_and(Value::is_null);
            name != "host_seconds" && (is_number || is_of_some)
        };
        if let Some(name) = self.measure.iter().find(|name| !is_measured(name)) {
            let numbers = report.as_object().into_iter().flatten().filter(|(_, value)| value.is_number());
            let names: Vec<&str> =
                numbers.map(|(name, _)| name.as_str()).filter(|name| *name != "host_seconds").collect();
            let names = names.join(", ");
            return Err(CliError::usage(format!("measure: expected numbers of the report ({names}), found {name}")));
        }
        Ok(self.measure.iter().map(|name| (name.clone(), "as in the report pxpl5-volume/1".to_owned())).collect())
    }

    fn draw(&self, all: &BTreeMap<String, toml::Value>, point: u64, stop: &StopFlag) -> Result<Volume, CliError> {
        let mut settings = VolumeSettings::paper();
        let place = format!("point {point}");
        // `scene` and `triangles` are not settings of the volume.
        for (path, value) in all.iter().filter(|(path, _)| !OWN.contains(&path.as_str())) {
            settings.set(path, &plain(value), &place)?;
        }
        let name = all.get("scene").map_or_else(|| "mig".to_owned(), plain);
        let triangles = match all.get("triangles").map(plain) {
            None => None,
            Some(text) => Some(text.parse::<u64>().ok().filter(|count| *count > 0).ok_or_else(|| {
                CliError::usage(format!("{place}: triangles: expected a whole number from 1 on, found {text}"))
            })?),
        };
        let scene = self.scenes.load(&scene_choice(&name, triangles))?;
        settings.swept_display()?;
        // Each point has to fit the budget by itself.
        let query = VolumeQuery { settings, scene, threads: self.threads };
        self.budget.admit_study(&query, SMALLER)?;
        Ok(query.run(&mut stop.clone())?)
    }
}

impl Swept for VolumeSweep {
    fn space(&self) -> &SweepSpace {
        &self.space
    }

    fn estimate(&self, _: Shard, _: usize) -> Estimate {
        Estimate::NOTHING
    }

    fn simulate(&self, point: u64, stop: &StopFlag) -> Result<PointResults, StudyError> {
        let mut all = self.settings.clone();
        all.extend(self.space.settings(point));
        let volume = self.draw(&all, point, stop).map_err(|error| SettingError::combination(error.message()))?;
        let report = serde_json::to_value(volume.report()).unwrap_or_default();
        let of = |name: &String| (name.clone(), value_of(&report, name).and_then(Value::as_f64));
        let named: Vec<String> = all.iter().map(|(path, value)| format!("{path}={}", plain(value))).collect();
        Ok(PointResults {
            measured: self.measure.iter().map(of).collect(),
            config_hash: Fingerprint::of(named.join("\n").as_bytes()).to_string(),
            trace_hash: report["volume_hash"].as_str().map(str::to_owned),
            level: None,
        })
    }
}

/// Returns the value of a JSON report at a path, in which dots separate the names.
fn value_of<'a>(report: &'a Value, path: &str) -> Option<&'a Value> {
    path.split('.').try_fold(report, |value, name| value.get(name))
}

fn measure(value: Option<toml::Value>, place: &str) -> Result<Vec<String>, SettingError> {
    let Some(value) = value else { return Ok(MEASURED.map(str::to_owned).to_vec()) };
    let names = value.as_array().and_then(|list| list.iter().map(|name| name.as_str().map(str::to_owned)).collect());
    names
        .filter(|names: &Vec<String>| !names.is_empty())
        .ok_or_else(|| SettingError::value("measure", "a list of names of the report's numbers", &value).at(place))
}

fn known_key(keys: &[String], path: &str, place: &str) -> Result<String, SettingError> {
    let all = || keys.iter().map(String::as_str).chain(OWN);
    if all().any(|key| key == path) {
        return Ok(path.to_owned());
    }
    Err(SettingError::unknown_path("key", path, all()).at(place))
}
