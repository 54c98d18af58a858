//! The keys of an experiment file, with their explanations.

use super::ExperimentFile;
use super::head::COLUMNS;
use super::hmd;
use super::motion::PathChoice;
use super::origin;
use super::text::toml_value;
use super::tracking_numbers::{is_tracking_parameter, tracking_parameters};
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Aim, Every, FIELDS_RANGE, HeadPlace, Level, Pixels, Registry, Reprojection};
use pxpl5_sim::parameters::{Key, KeyValue, KeyValues, SettingError, names};
use std::collections::BTreeMap;
use toml::Value;
use tracking::motion::{Axes, Columns, End, Jumps};

/// A key of an experiment file, with an explanation for the user.
#[derive(Clone, Debug)]
pub struct FileKey {
    /// Path of the key in an experiment file, such as `head.path`.
    pub path: String,
    /// Meaning and valid values of the key, for the user.
    pub about: String,
    /// Pipeline families to which the key applies. An empty list means all pipelines.
    pub applies_to: Vec<&'static str>,
}

impl FileKey {
    fn of(path: &str, about: String) -> Self {
        Self { path: path.to_owned(), about, applies_to: Vec::new() }
    }
}

/// Range of a coordinate of a model, m.
const MODEL_M: KeyValues = KeyValues::Real(-1e4, 1e4);

const RATE_HZ: KeyValues = KeyValues::Real(1e-3, 1e4);

/// Keys that exist for every registry of pipelines and displays.
const COMMON: &[Key] = &[
    Key::new("model.x", "place of the middle of the scene in its world, to the right", MODEL_M).with_unit("m"),
    Key::new("model.y", "place of the middle of the scene in its world, upwards", MODEL_M).with_unit("m"),
    Key::new("model.z", "place of the middle of the scene in its world, backwards", MODEL_M).with_unit("m"),
    Key::new("model.size", "length of the longest side of the scene", KeyValues::Real(1e-3, 1e4)).with_unit("m"),
    Key::new("model.turn", "turn of the scene about the vertical axis, to the left", KeyValues::Real(-360.0, 360.0))
        .with_unit("deg"),
    Key::new("model.room", "add the scene `room`, whose walls surround the viewer", KeyValues::Flag).with_default("false"),
    Key::new("title", "title of the experiment, for readers", KeyValues::ANY),
    Key::new(
        "scene",
        "a built-in scene (`pxpl5 scenes` lists them) or a model file (.ply, .obj, .stl, .pdb, .gltf, .glb); in a file, relative to it",
        KeyValues::ANY,
    ),
    Key::new(
        "triangles",
        "decimate the scene to at most this number of primitives, with a similar shape",
        KeyValues::Whole(1, u32::MAX as u64),
    ),
    Key::new(
        "fit",
        "move and scale a model file so that both eyes see all of it; without, its coordinates are metres",
        KeyValues::Flag,
    )
    .with_default("true"),
    Key::new("cull", "drop triangles that face away from the eye, in all structures of the scene", KeyValues::Flag)
        .with_default("false"),
    Key::new(
        "head.path",
        "motion in front of the scene, where scene is the scene's own; with head.motion, only its start pose",
        KeyValues::Names(&const { names(&PathChoice::ALL) }),
    )
    .with_default("scene"),
    Key::new("head.sway", "scale of the head's sway on this path", KeyValues::Real(0.0, 10.0))
        .with_default("1 for look, that of the scene for scene, else 0"),
    Key::new(
        "head.distance",
        "distance from the scene's centre, for still, look and orbit",
        KeyValues::Real(1e-9, 1e9),
    )
    .with_unit("m")
    .with_default("the scene fills the view"),
    Key::new("head.deg_per_s", "rate of turn, for pan and orbit", KeyValues::Real(-1e9, 1e9))
        .with_unit("deg/s")
        .with_default("the mean of recorded head motion"),
    Key::new(
        "head.motion",
        "motion of a tracked head from the start pose of head.path on: still, pan:DEG_PER_S, slide:M_PER_S, sine:DEG:HZ, \
         pendulum, synthetic:SEED, walk:M_PER_S or walk:M_PER_S:SEED along the scene's path, a real head \
         (recorded:vive-tracked, recorded:vive-dev), or a recording (.csv, .txt, .tum, .jsonl: time_s,x,y,z,qw,qx,qy,qz, EuRoC, TUM, a \
         pose log, or any table with head.columns); in a file, relative to it",
        KeyValues::ANY,
    ),
    Key::new(
        "head.end",
        "behaviour after the end of a recording: error (a longer run is refused), hold or loop",
        KeyValues::Names(&const { names(&End::NAMES) }),
    ),
    Key::new("head.axes", "axes of a recording", KeyValues::Names(&const { names(&Axes::NAMES) }))
        .with_default("by the file format"),
    Key::new(
        "head.jumps",
        "lines of a recording in which the head moves faster than 8 m/s or turns faster than 2,000 deg/s",
        KeyValues::Names(&const { names(&Jumps::NAMES) }),
    )
    .with_default("keep, with a warning"),
    Key::new("head.train", "motion on which the predictor is tuned: any head.motion that is not along a path", KeyValues::ANY)
        .with_default("another synthetic motion; head.motion itself for all others"),
    Key::new("head.tracker", crate::head_parts::TRACKERS, KeyValues::ANY).with_default("optical"),
    Key::new("head.added_latency", "time added to the latency of the tracker", KeyValues::Real(0.0, 1000.0))
        .with_unit("ms")
        .with_default("0"),
    Key::new("head.predict", "none, velocity, acceleration or kalman", KeyValues::ANY).with_default("kalman"),
    Key::new(
        "head.aim",
        "instant for which a view is predicted, within the time in which it is shown",
        KeyValues::Names(&const { names(&Aim::ALL) }),
    )
    .with_default("middle"),
    Key::new(
        "head.place",
        "what the poses of head.motion count from: scene (the motion begins where the scene's own motion begins), world \
             (the poses are metres in the scene's coordinates) or content (the head faces the scene as long as it can)",
        KeyValues::Names(&const { names(&HeadPlace::ALL) }),
    )
    .with_default("scene; content for a model file"),
    Key::new(
        "head.filter",
        "numbers of the predictor: tuned (for the pipeline's prediction interval and the motion, with other noise than in \
         the run) or given (those of tracking.filter)",
        KeyValues::Names(&["tuned", "given"]),
    ),
    Key::new(
        "head.evaluate_at",
        "distance from the eye at which pixel errors are evaluated",
        KeyValues::Real(0.001, 1e6),
    )
    .with_unit("m")
    .with_default("the distance of the scene's content"),
    Key::new(
        "head.raster",
        "plain, vdrt (the raster is shifted by the error of the pose), or a device that moves pictures to the newest pose \
         by shift, rotation (timewarp) or depth",
        KeyValues::Names(&["plain", "vdrt", "shift", "rotation", "depth"]),
    )
    .with_default("plain"),
    Key::new(
        super::reprojection::EVERY,
        "how often a device takes the newest pose: field, strip of 128 lines, or line",
        KeyValues::Names(&const { names(&Every::ALL) }),
    )
    .with_default("field"),
    Key::new(
        super::reprojection::LATENCY,
        "time from the pose to the first light of the pixels that it moves",
        KeyValues::Whole(Reprojection::LATENCY_US.0, Reprojection::LATENCY_US.1),
    )
    .with_unit("us")
    .with_default("2000 per field, 500 per strip, 100 per line"),
    Key::new(
        "seed",
        "seed of the head motion's sway, or of the tracker's noise",
        KeyValues::Whole(0, super::plan::MAX_SEED),
    )
    .with_default("1"),
    Key::new(
        "fields",
        "periods of the display to simulate: NTSC fields",
        KeyValues::Whole(FIELDS_RANGE.0, FIELDS_RANGE.1),
    )
    .with_default("120"),
    Key::new("pixels", "which pixels are computed", KeyValues::Names(&const { names(&Pixels::ALL) }))
        .with_default("lazy"),
    Key::new(
        "level",
        "detail of the model of the processors: analytic (sweeps of pipelines with a closed form only), transaction, \
             cycle, or auto (the cheapest of them within a bound)",
        KeyValues::Names(&[Level::Analytic.name(), Level::Transaction.name(), Level::Cycle.name(), super::plan::AUTO]),
    )
    .with_default("transaction"),
    Key::new("within", "bound of the deviation from the cycle level, for the level auto", KeyValues::NUMBER)
        .with_unit("%")
        .with_default("5"),
    Key::new("limit.rate_hz", "goal of the quantity triangles_possible: at least this many updates a second", RATE_HZ)
        .with_default("the goal with which the pipeline was published"),
    Key::new(
        "limit.latency_fields",
        "goal of the quantity triangles_possible: at most this mean latency, in fields",
        KeyValues::Real(1e-3, 1e6),
    ),
    Key::new("machine.preset", "a preset of `pxpl5 machines`", KeyValues::ANY)
        .with_default("the machine of the pipeline's paper"),
    Key::new(
        "machine.code",
        "i860 code that the processors run at the cycle level, or none (the table's times)",
        KeyValues::Names(&const { names(&super::plan::CODES) }),
    ),
    Key::new(
        "machine.times",
        "times of primitives in the table: papers (published or fitted) or code (those of the i860 code); without it, code \
                    for the presets slats and slats-optimised, and papers for the others",
        KeyValues::Names(&const { names(&super::plan::TIMES) }),
    ),
    Key::new("measure", "list of the quantities that go into tables and sweep rows", KeyValues::ANY),
    Key::new("output.pictures", "write the last pictures as PNG", KeyValues::Flag).with_default("true"),
    Key::new("output.timeline", "write a timeline as SVG", KeyValues::Flag).with_default("true"),
    Key::new("output.csv", "write the measured quantities as CSV", KeyValues::Flag).with_default("true"),
    Key::new(
        "published.figure",
        "number of the published figure that the experiment reproduces",
        KeyValues::Whole(0, 999),
    ),
    Key::new("published.source", "paper", KeyValues::ANY),
    Key::new("published.quantity", "measured quantity that is compared with the published value", KeyValues::ANY),
    Key::new("published.value", "published value of the quantity", KeyValues::NUMBER),
];

pub(super) fn common(name: &str) -> Option<&'static Key> {
    COMMON.iter().chain(&origin::KEYS).chain(hmd::KEYS.iter().map(|(key, ..)| key)).find(|key| key.name == name)
}

/// Beginnings of the keys whose values a plan writes as they were given. A value that is the default is left out.
const WRITTEN: [&str; 9] =
    ["title", "triangles", "fit", "cull", "model.", "head.distance", "head.sway", "limit.", "published."];

impl ExperimentFile {
    /// Returns the given values that a plan writes without a change.
    pub(super) fn given(&self) -> Result<BTreeMap<String, Value>, SettingError> {
        let mut given = BTreeMap::new();
        for key in COMMON.iter().filter(|key| WRITTEN.iter().any(|start| key.name.starts_with(start))) {
            let value = self.value(key)?.map(toml_value).filter(|value| value.to_string() != key.default);
            given.extend(value.map(|value| (key.name.to_owned(), value)));
        }
        Ok(given)
    }

    fn common(&self, name: &str) -> Result<Option<KeyValue>, SettingError> {
        common(name).map_or(Ok(None), |key| self.value(key))
    }

    pub(super) fn flag(&self, name: &str) -> Result<Option<bool>, SettingError> {
        Ok(self.common(name)?.and_then(|value| if let KeyValue::Flag(flag) = value { Some(flag) } else { None }))
    }

    pub(super) fn whole(&self, name: &str) -> Result<Option<u64>, SettingError> {
        Ok(self.common(name)?.and_then(|value| if let KeyValue::Whole(number) = value { Some(number) } else { None }))
    }

    pub(super) fn number(&self, name: &str) -> Result<Option<f64>, SettingError> {
        Ok(self.common(name)?.and_then(|value| if let KeyValue::Real(number) = value { Some(number) } else { None }))
    }
}

/// Returns all keys except those of machine parameters. The key of a machine parameter is `machine.` followed by a path
/// of [`MachineConfig::set`].
pub(super) fn keys(registry: &Registry) -> Vec<FileKey> {
    let pipelines: Vec<&str> = registry.pipelines().iter().map(|entry| entry.name).collect();
    let displays: Vec<&str> = registry.displays().iter().map(|entry| entry.name).collect();
    // The names of pipelines and displays depend on the registry.
    let mut all = vec![
        FileKey::of("pipeline", pipelines.join(", ")),
        FileKey::of("display", format!("display for which the pipeline draws: {}", displays.join(", "))),
    ];
    all.extend(super::display::keys().map(|(path, about)| FileKey::of(path, about)));
    let of_all = COMMON.iter().chain(&origin::KEYS).chain(hmd::KEYS.iter().map(|(key, ..)| key));
    all.extend(of_all.map(|key| FileKey::of(key.name, key.help())));
    // One key for each column of a recording.
    let column =
        "name or number of the column of a recording; _ms, _us, _ns and _mm give the unit, which is otherwise s or m";
    all.extend(Columns::fields().map(|field| FileKey::of(&format!("{COLUMNS}{field}"), column.to_owned())));
    // Keys of pipelines state the families to which they apply.
    let of_pipelines = registry.keys().into_iter();
    all.extend(of_pipelines.map(|(key, applies_to)| FileKey { applies_to, ..FileKey::of(key.name, key.help()) }));
    all
}

/// Returns the full path of a key, or `None` for an unknown key. The prefix `machine.` is optional.
pub(super) fn canonical(registry: &Registry, path: &str) -> Option<String> {
    // A table `[display]` names its display with the key `preset`.
    let path = if path == "display.preset" { "display" } else { path };
    if is_key(registry, path) || is_machine_parameter(registry, path) || is_tracking_parameter(path) {
        return Some(path.to_owned());
    }
    let long = format!("machine.{path}");
    is_machine_parameter(registry, &long).then_some(long)
}

fn is_key(registry: &Registry, path: &str) -> bool {
    common(path).is_some() || keys(registry).iter().any(|key| key.path == path)
}

/// Returns true if the path is a machine parameter with any display of the registry.
fn is_machine_parameter(registry: &Registry, path: &str) -> bool {
    let Some(path) = path.strip_prefix("machine.") else { return false };
    parameters(registry).iter().any(|candidate| candidate == path)
}

/// Returns the paths of all parameters of a machine that has every display of the registry.
fn parameters(registry: &Registry) -> Vec<String> {
    machine(registry).settings().into_iter().map(|(path, _)| path).collect()
}

/// Returns a machine that has every display of the registry.
pub(super) fn machine(registry: &Registry) -> MachineConfig {
    let all_displays = registry.displays().iter().map(|entry| (entry.config)()).collect();
    MachineConfig { displays: all_displays, ..registry.machine_of(MachineConfig::small_hmd()) }
}

/// Creates the error of an invalid path, with the most similar valid path. The suggestion has the prefix `machine.`
/// only if the invalid path is closer to that form.
pub(super) fn unknown(registry: &Registry, found: &str) -> SettingError {
    // Published facts cannot be set.
    let facts = machine(registry).parameters().into_iter().filter(|parameter| parameter.read_only);
    let facts: Vec<String> = facts.map(|parameter| parameter.path).collect();
    let mut parameters = parameters(registry);
    parameters.retain(|path| !facts.contains(path));
    let long = parameters.iter().map(|path| format!("machine.{path}"));
    let own = keys(registry).into_iter().map(|key| key.path);
    let of_trackers = tracking_parameters().into_iter().filter(|parameter| !parameter.read_only);
    let of_trackers = of_trackers.map(|parameter| parameter.path);
    let all = own.chain(long).chain(parameters.iter().cloned()).chain(of_trackers);
    SettingError::unknown_path("key", found, all)
}
