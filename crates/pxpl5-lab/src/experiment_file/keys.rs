//! The keys of an experiment file.

use crate::config::{MachineConfig, nearest};

/// A key and what it says.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Its path.
    pub path: &'static str,
    /// What it sets and what it takes.
    pub about: &'static str,
    /// The pipelines to which it applies, where it is not all.
    pub applies_to: Option<&'static str>,
}

const fn key(path: &'static str, about: &'static str) -> Key {
    Key { path, about, applies_to: None }
}

const fn of(pipeline: &'static str, path: &'static str, about: &'static str) -> Key {
    Key { path, about, applies_to: Some(pipeline) }
}

/// All keys but the machine's parameters, which are `machine.` and a path of [`MachineConfig::set`].
pub const KEYS: &[Key] = &[
    key("title", "a line for people"),
    key(
        "pipeline",
        "rendering-control, slats, frameless, or jitp-field, jitp-scanline, jitp-dual-screen, jitp-dual-view, each with or without -racing",
    ),
    of("rendering-control", "mono", "one picture instead of a stereo pair: true or false"),
    of("rendering-control", "shading", "phong or gouraud"),
    of("slats", "copy", "whole (all regions before the retrace) or split (bottom regions after it)"),
    of("slats", "binning", "all (every clump to every region) or touched"),
    of("slats", "code", "1994, 1995 or optimised: times per primitive, where not those of the machine"),
    of("jitp", "strip_rows", "lines of a strip: 1 to 128"),
    of("frameless", "block", "width and height of a block: 4 to 128 pixels"),
    of("frameless", "batch", "blocks drawn with one view; 0 for as many as keep ring and processors equally busy"),
    of("frameless", "order_seed", "seed of the order of the blocks"),
    key("scene", "a built-in scene or a model file (.ply, .obj, .pdb), relative to the experiment file"),
    key("triangles", "keep the first so many primitives of the scene, triangles before spheres"),
    key("motion.path", "scene (the scene's own), still, look, pan or orbit"),
    key("motion.sway", "0 to 10: scale of the head's sway"),
    key("motion.distance", "metres from the scene's centre: still, look, orbit"),
    key("motion.deg_per_s", "rate of turn: pan, orbit"),
    key(
        "head.motion",
        "still, pan:DEG_PER_S, pendulum, synthetic:SEED or a recording FILE.csv, seen through a tracker",
    ),
    key("head.tracker", "optical, fastrak, flock, flock-patched, 3space or ideal"),
    key("head.predict", "none, velocity, acceleration or kalman"),
    key("head.display", "plain, or vdrt (the raster is shifted by what the pose was wrong)"),
    key("seed", "seed of the head motion's sway, or of the tracker's noise"),
    key("fields", "NTSC fields to simulate"),
    key("pixels", "off, lazy or all"),
    key("level", "analytic (sweeps of rendering-control and slats only), transaction or cycle"),
    key("machine.preset", "a preset of `pxpl5 machines`"),
    key("measure", "list of the quantities that go into tables and sweep rows"),
    key("output.pictures", "write the last pictures as PNG: true or false"),
    key("output.timeline", "write a timeline as SVG: true or false"),
    key("output.csv", "write the measured quantities as CSV: true or false"),
    key("published.figure", "number of the published figure that this reproduces"),
    key("published.source", "paper"),
    key("published.quantity", "the measured quantity to be compared"),
    key("published.value", "its published value"),
];

/// The key of this path, or one that stands for a machine parameter.
pub(super) fn find(path: &str) -> Option<Key> {
    KEYS.iter().find(|key| key.path == path).copied()
}

/// A path as it is kept: a parameter of the machine may be written without `machine.`.
pub(super) fn canonical(path: &str) -> String {
    let first = path.split('.').next().unwrap_or_default();
    let own = first == "machine" || KEYS.iter().any(|key| key.path.split('.').next() == Some(first));
    if own { path.to_owned() } else { format!("machine.{path}") }
}

/// Whether a machine has such a parameter.
pub(super) fn is_machine_parameter(path: &str) -> bool {
    path.strip_prefix("machine.").is_some_and(|path| MachineConfig::small_hmd().set(path, 1).is_ok())
}

/// The valid path with the fewest changes to a wrong one, written as the wrong one was.
pub(super) fn nearest_key(found: &str) -> String {
    let own = KEYS.iter().map(|key| key.path.to_owned());
    let boards = ["n_gps", "n_renderers"].map(str::to_owned).into_iter();
    let parameters: Vec<String> =
        boards.chain(MachineConfig::small_hmd().parameters().into_iter().map(|p| p.path)).collect();
    let long = parameters.iter().map(|path| format!("machine.{path}"));
    let all: Vec<String> = own.chain(long).chain(parameters.iter().cloned()).collect();
    nearest(found, all.iter().map(String::as_str)).unwrap_or_default().to_owned()
}
