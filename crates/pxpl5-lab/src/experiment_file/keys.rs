//! The keys of an experiment file, with their explanations.

use super::head::COLUMNS;
use super::hmd;
use super::tracking_numbers::{is_tracking_parameter, tracking_parameters};
use pxpl5_machine::MachineConfig;
use pxpl5_run::Registry;
use pxpl5_sim::parameters::SettingError;
use tracking::motion::Columns;

/// A key of an experiment file, with an explanation for the user.
#[derive(Clone, Debug)]
pub struct FileKey {
    /// Path of the key, as written before the equals sign: `motion.path`.
    pub path: String,
    /// Meaning and valid values of the key, for the user.
    pub about: String,
    /// Pipeline families to which the key applies. An empty list means all pipelines.
    pub applies_to: Vec<&'static str>,
}

/// Keys that exist for every registry of pipelines and displays.
const COMMON: &[(&str, &str)] = &[
    ("title", "title of the experiment, for readers"),
    (
        "scene",
        "a built-in scene or a model file (.ply, .obj, .stl, .pdb, .gltf, .glb), relative to the experiment file",
    ),
    ("triangles", "decimate the scene to at most this number of primitives, with a similar shape"),
    (
        "fit",
        "move and scale a model file so that both eyes see all of it: true (default) or false (its coordinates are metres)",
    ),
    ("cull", "drop triangles that face away from the eye, in all structures of the scene: true or false (default)"),
    ("motion.path", "scene (the scene's own), still, look, pan or orbit"),
    ("motion.sway", "0 to 10: scale of the head's sway"),
    ("motion.distance", "metres from the scene's centre: still, look, orbit"),
    ("motion.deg_per_s", "rate of turn: pan, orbit"),
    (
        "head.motion",
        "still, pan:DEG_PER_S, slide:M_PER_S, sine:DEG:HZ, pendulum, synthetic:SEED, walk:M_PER_S or walk:M_PER_S:SEED along the scene's path, \
         or a recording (.csv, .txt, .tum, .jsonl), relative to the experiment file, seen through a tracker",
    ),
    ("head.end", "behaviour after the end of a recording: error (a longer run is refused), hold or loop"),
    ("head.axes", "axes of a recording: opengl, optical, euroc or robot; the default depends on the file format"),
    ("head.tracker", crate::head_names::TRACKERS),
    ("head.predict", "none, velocity, acceleration or kalman"),
    (
        "head.aim",
        "instant for which a view is predicted, within the time in which it is shown: middle, first-pixel, last-pixel or retrace",
    ),
    (
        "head.place",
        "what the poses of head.motion count from: scene (the motion begins where the scene's own motion begins; default) or world (the \
          poses are metres in the scene's coordinates)",
    ),
    (
        "head.filter",
        "numbers of the predictor: tuned (for the pipeline's prediction interval and the motion, with other noise than in the run) or \
          given (those of tracking.filter)",
    ),
    (
        "head.evaluate_at",
        "metres from the eye at which pixel errors are evaluated; default: the distance of the scene's content",
    ),
    (
        "head.raster",
        "plain, vdrt (the raster is shifted by the error of the pose), or a device that moves pictures to the newest pose by shift, \
         rotation (timewarp) or depth",
    ),
    (
        super::reprojection::EVERY,
        "how often a device takes the newest pose: field (default), strip of 128 lines, or line",
    ),
    (
        super::reprojection::LATENCY,
        "microseconds from the pose to the first light of the pixels that it moves, 0 to 100000; default 2000 per field, 500 per strip, 100 per line",
    ),
    ("seed", "seed of the head motion's sway, or of the tracker's noise"),
    ("fields", "periods of the display to simulate: NTSC fields"),
    ("pixels", "off, lazy or all"),
    ("level", "analytic (sweeps of pipelines with a closed form only), transaction or cycle"),
    ("machine.preset", "a preset of `pxpl5 machines`"),
    (
        "machine.code",
        "i860 code that the processors run at the cycle level: unoptimised, compiled, scheduled, or none (the table's times)",
    ),
    (
        "machine.times",
        "times of primitives in the table: papers (published or fitted), or code (those of the i860 code)",
    ),
    ("measure", "list of the quantities that go into tables and sweep rows"),
    ("output.pictures", "write the last pictures as PNG: true or false"),
    ("output.timeline", "write a timeline as SVG: true or false"),
    ("output.csv", "write the measured quantities as CSV: true or false"),
    ("published.figure", "number of the published figure that the experiment reproduces"),
    ("published.source", "paper"),
    ("published.quantity", "measured quantity that is compared with the published value"),
    ("published.value", "published value of the quantity"),
];

/// Former names of keys, each with the current name.
const RENAMED: [(&str, &str); 3] =
    [("head.display", "head.raster"), ("head.evaluate_at", "head.evaluate_at"), ("display.preset", "display")];

/// Returns all keys except the keys of the machine's parameters. A parameter's key is `machine.` followed by a path of
/// [`MachineConfig::set`].
#[must_use]
pub(super) fn keys(registry: &Registry) -> Vec<FileKey> {
    let pipelines: Vec<&str> = registry.pipelines().iter().map(|entry| entry.name).collect();
    let displays: Vec<&str> = registry.displays().iter().map(|entry| entry.name).collect();
    // The names of pipelines and displays depend on the registry.
    let mut all = vec![
        common("pipeline", &pipelines.join(", ")),
        common("display", &format!("display for which the pipeline draws: {}", displays.join(", "))),
    ];
    all.extend(super::display::keys().map(|(path, about)| common(&path, about)));
    all.extend(COMMON.iter().map(|(path, about)| common(path, about)));
    all.extend(hmd::NUMBERS.iter().map(|(path, about, ..)| common(path, about)));
    // One key for each column of a recording.
    all.extend(Columns::fields().map(|field| FileKey {
        path: format!("{COLUMNS}{field}"),
        about: "name or number of the column of a recording; _ms, _us, _ns and _mm give the unit, which is otherwise s or m".to_owned(),
        applies_to: Vec::new(),
    }));
    // Keys of pipelines state the families to which they apply.
    let of_pipelines = registry.keys().into_iter();
    all.extend(of_pipelines.map(|(key, applies_to)| FileKey {
        path: key.name.to_owned(),
        about: key.about.to_owned(),
        applies_to,
    }));
    all
}

fn common(path: &str, about: &str) -> FileKey {
    FileKey { path: path.to_owned(), about: about.to_owned(), applies_to: Vec::new() }
}

/// Returns the full path of a key, or `None` for an unknown key. The prefix `machine.` is optional for a parameter of
/// the machine.
pub(super) fn canonical(registry: &Registry, path: &str) -> Option<String> {
    // Former names of keys are still accepted.
    let path = RENAMED.iter().find(|(before, _)| *before == path).map_or(path, |(_, now)| now);
    if is_key(registry, path) || is_machine_parameter(registry, path) || is_tracking_parameter(path) {
        return Some(path.to_owned());
    }
    let long = format!("machine.{path}");
    is_machine_parameter(registry, &long).then_some(long)
}

/// Returns true if the path is a key but not a parameter of the machine.
fn is_key(registry: &Registry, path: &str) -> bool {
    keys(registry).iter().any(|key| key.path == path)
}

/// Returns true if the path is a parameter of a machine with any display of the registry.
fn is_machine_parameter(registry: &Registry, path: &str) -> bool {
    let Some(path) = path.strip_prefix("machine.") else { return false };
    parameters(registry).iter().any(|known| known == path)
}

/// Returns the paths of all parameters of a machine with every registered display.
fn parameters(registry: &Registry) -> Vec<String> {
    let all_displays = registry.displays().iter().map(|entry| (entry.config)()).collect();
    let machine = MachineConfig { displays: all_displays, ..registry.machine_of(MachineConfig::small_hmd()) };
    machine.settings().into_iter().map(|(path, _)| path).collect()
}

/// Creates the error of an invalid path, with the most similar valid path. For a parameter of the machine, the
/// prefix `machine.` is added only if the invalid path is closer to that form.
pub(super) fn unknown(registry: &Registry, found: &str) -> SettingError {
    let parameters = parameters(registry);
    let long = parameters.iter().map(|path| format!("machine.{path}"));
    let own = keys(registry).into_iter().map(|key| key.path);
    let of_trackers = tracking_parameters().into_iter().map(|parameter| parameter.path);
    let all = own.chain(long).chain(parameters.iter().cloned()).chain(of_trackers);
    SettingError::unknown_path("key", found, all)
}
