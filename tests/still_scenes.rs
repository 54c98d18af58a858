//! Tests that a still scene looks the same on every machine and under every pipeline, and equals the ideal picture.
//!
//! Sizes range from one slave to 49 and from one renderer to 20. They include the sizes at which messages of a region
//! were once drawn into another slave's region. Pixels may differ only if two primitives have exactly the same depth
//! there, and then show one of these primitives. The ideal renderer reports such ties.
//!
//! `PXPL5_MODELS=FOLDER cargo test -p pxpl5 --test main still_scenes` also draws every model of a folder. With
//! `PXPL5_PICTURES=FOLDER`, all pictures and ideal pictures are written into a folder for inspection.

use crate::support;
use pxpl5::display::Coverage;
use pxpl5::oracle::IdealPicture;
use pxpl5::scene::config::FIT_DISTANCE_RADII;
use pxpl5::scene::{self, HeadMotion, HeadPath, Scene, Sway};
use pxpl5::{
    Experiment, KeyValue, Level, MachineConfig, Measured, Outcome, PipelineEntry, PipelineProperties, PipelineSettings,
    SurfaceId, Time, registry,
};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// Numbers of processors, including the master, and of renderers.
const SIZES: [(usize, usize); 6] = [(2, 1), (2, 20), (7, 3), (13, 5), (34, 20), (50, 20)];

/// Numbers of processors and renderers for Slats. Slats binds four field regions to a renderer, so it takes five
/// renderers. It needs no master.
const SIZES_OF_SLATS: [(usize, usize); 4] = [(1, 5), (7, 5), (13, 20), (50, 20)];

/// Returns the number of primitives that a pipeline draws, evenly spread over the scene, and the number of fields until
/// a still picture is complete.
///
/// Just-in-time pixels leave out strips whose beam has passed, so too many primitives would never be visible. A slave
/// has as many strip times of 508 us as the machine has slaves. In this time, it transforms all primitives for each
/// strip (scanline, 21.7 us a primitive) or interpolates them (dual, 7 us). It has a field of 16.7 ms for the
/// transforms. One renderer has 508 us to draw and copy five regions. This leaves 230 us for triangles of 6.45 us:
/// seven for each column. An overloaded Slats that takes an even number of fields for each picture would always draw
/// the same lines. A single processor of Slats draws two pictures of 250 triangles in three fields, so it draws the
/// lines of both fields; from 300 triangles on, it begins every second field. Rendering Control with one slave has 8 MB
/// for all commands.
fn load(pipeline: &str, (gps, renderers): (usize, usize), covers_the_screen: bool) -> (usize, u64) {
    let slaves = gps.saturating_sub(1);
    let by_renderers = match renderers {
        1 if covers_the_screen => 4,
        1 => 100,
        _ => usize::MAX,
    };
    match pipeline {
        "rendering-control" if slaves == 1 => (10_000, 150),
        "rendering-control" => (20_000, 60),
        "slats" if gps == 1 => (250, 40),
        "slats" => (417, 40),
        "frameless" => (450, if slaves == 1 { 90 } else { 30 }),
        "jitp-field" | "jitp-field-racing" => (450.min(by_renderers), 12),
        "jitp-scanline" | "jitp-scanline-racing" => ((10 * slaves).min(by_renderers).min(300), 12),
        _ => ((20 * slaves).min(by_renderers).min(200), 12),
    }
}

/// Returns the scene at time zero with at most `most` of its primitives, evenly spread. The head stands still at the
/// position of `head.path = "still"`.
fn still(scene: &Scene, most: usize) -> Scene {
    let all = scene.triangles().len() + scene.spheres().len();
    let mut parts = scene.posed(&scene.edits_at(0)).into_parts();
    let kept = |number: usize| most >= all || (number + 1) * most / all > number * most / all;
    let n_triangles = parts.triangles.len();
    let triangles_before = |end: usize| (0..end).filter(|i| kept(*i)).count();
    let spheres_before = |end: usize| (0..end).filter(|i| kept(n_triangles + *i)).count();
    for structure in &mut parts.structures {
        let Range { start, end } = structure.triangles;
        structure.triangles = triangles_before(start)..triangles_before(end);
        let Range { start, end } = structure.spheres;
        structure.spheres = spheres_before(start)..spheres_before(end);
        structure.hinge = None;
    }
    parts.triangles = (0..).zip(parts.triangles).filter(|(i, _)| kept(*i)).map(|(_, t)| t).collect();
    parts.spheres = (n_triangles..).zip(parts.spheres).filter(|(i, _)| kept(*i)).map(|(_, s)| s).collect();
    let (target, radius) = scene.bounding_sphere();
    let eye = target + glam::Vec3::Z * (radius * FIT_DISTANCE_RADII as f32);
    parts.motion = HeadMotion::new(HeadPath::Still { eye, target }, Sway::none()).expect("in range");
    Scene::new(parts).expect("what is kept is whole")
}

/// Returns the built-in scenes and the models of the given folder.
fn scenes() -> Vec<Scene> {
    let mut all: Vec<_> =
        ["mig", "molecules", "head", "full-screen:12"].map(|name| scene::builtin(name).expect("built in")).into();
    if let Some(folder) = std::env::var_os("PXPL5_MODELS") {
        let files = std::fs::read_dir(folder).expect("a folder").map(|file| file.expect("readable").path());
        all.extend(files.filter_map(|path| scene::load(&path).ok()));
    }
    all
}

fn machine(entry: &PipelineEntry, (gps, renderers): (usize, usize)) -> MachineConfig {
    let mut config = registry().machine_of(MachineConfig::preset(entry.preset).expect("a preset"));
    config.n_gps = gps;
    config.n_renderers = renderers;
    config
}

/// Returns settings with strips of several lines, because a single slave cannot draw strips of one line in time. At the
/// cycle level, a sphere takes 78 us, and the begin of each pass more than 100 us (docs/gp-timing.md). Strips have 32
/// lines, or 2.0 ms, in comparisons between levels.
fn settings(entry: &PipelineEntry, lines: u64) -> PipelineSettings {
    if entry.family == "jitp" { with_strips(lines) } else { PipelineSettings::default() }
}

/// Number of lines in a strip for comparisons with the ideal picture.
const LINES: u64 = 8;
const LINES_AT_BOTH_LEVELS: u64 = 32;

fn run(entry: &PipelineEntry, size: (usize, usize), scene: &Arc<Scene>, fields: u64) -> Outcome {
    run_at(Level::Transaction, (entry, LINES), size, scene, fields)
}

/// Runs a pipeline and returns the outcome. Some pictures may never be complete. Only the visible result at the end
/// counts, not its time.
fn run_at(
    level: Level,
    (entry, lines): (&PipelineEntry, u64),
    size: (usize, usize),
    scene: &Arc<Scene>,
    fields: u64,
) -> Outcome {
    let pipeline = (entry.build)(&settings(entry, lines));
    let experiment = Experiment::with(machine(entry, size), pipeline, Arc::clone(scene)).fields(fields).level(level);
    support::outcome(experiment.run(), format!("{} on {size:?} with {}", entry.name, scene.name()))
}

/// Ideal pictures by pipeline and scene, number of primitives, and eye.
type Ideals = Mutex<BTreeMap<(String, usize, u16), Arc<IdealPicture>>>;
static IDEALS: Ideals = Mutex::new(BTreeMap::new());

fn ideal(outcome: &Outcome, scene: &Scene, surface: u16) -> Arc<IdealPicture> {
    let primitives = scene.triangles().len() + scene.spheres().len();
    let PipelineProperties { layout, shading, eyes, .. } = outcome.pipeline().properties();
    let drawn = format!("{} {} {} {eyes}", scene.name(), layout.plan().name, shading as u8);
    let key = (drawn, primitives, surface);
    let cached = IDEALS.lock().unwrap_or_else(PoisonError::into_inner).get(&key).cloned();
    cached.unwrap_or_else(|| {
        let fresh = Arc::new(outcome.ideal_picture(SurfaceId(surface), Time::ZERO).expect("it has that eye"));
        IDEALS.lock().unwrap_or_else(PoisonError::into_inner).insert(key, Arc::clone(&fresh));
        fresh
    })
}

/// Returns descriptions of the faults in the pictures of a run.
fn faults(entry: &PipelineEntry, size: (usize, usize), whole: &Scene) -> Vec<String> {
    let covers_the_screen = whole.name().starts_with("full-screen");
    let (most, fields) = load(entry.name, size, covers_the_screen);
    let scene = Arc::new(still(whole, most));
    let outcome = run(entry, size, &scene, fields);
    let mut faults = Vec::new();
    for surface in 0..outcome.pipeline().properties().eyes as u16 {
        let ideal = ideal(&outcome, &scene, surface);
        let picture = outcome.picture(SurfaceId(surface)).expect("pixels are on");
        let wrong = ideal.differences(&picture);
        let name = format!("{}-{}-{}-{}-{surface}", entry.name, scene.name().replace([':', '/'], "-"), size.0, size.1);
        if let Ok(folder) = std::env::var("PXPL5_PICTURES") {
            picture.save(format!("{folder}/{name}.png")).expect("writable");
            ideal.image().save(format!("{folder}/{name}-ideal.png")).expect("writable");
        }
        if let Some([x, y]) = wrong.first() {
            faults.push(format!("{name}: {} pixels, the first at {x}, {y}", wrong.len()));
        }
    }
    faults
}

/// Checks every pipeline of a kind with every size and every scene, but only with a third of the pairs of size and scene.
/// `PXPL5_ALL_CASES=1` checks all pairs.
fn all_sizes(of: impl Fn(&PipelineEntry) -> bool) {
    let registry = registry();
    let scenes = scenes();
    let mut wrong = Vec::new();
    for (number, entry) in registry.pipelines().iter().filter(|entry| of(entry)).enumerate() {
        let sizes: &[(usize, usize)] = if entry.family == "slats" { &SIZES_OF_SLATS } else { &SIZES };
        for (of_scene, scene) in scenes.iter().enumerate() {
            let is_run = |of_size: usize| (number + of_scene + of_size).is_multiple_of(3) || support::runs_all_cases();
            let sizes = sizes.iter().enumerate().filter(|(of_size, _)| is_run(*of_size));
            sizes.for_each(|(_, size)| wrong.extend(faults(entry, *size, scene)));
        }
    }
    assert!(wrong.is_empty(), "not as the oracle draws them:\n{}", wrong.join("\n"));
}

#[test]
fn rendering_control_shows_the_ideal_picture() {
    all_sizes(|entry| entry.family == "rendering-control");
}

#[test]
fn slats_and_frameless_rendering_show_the_ideal_picture() {
    all_sizes(|entry| ["slats", "frameless"].contains(&entry.family));
}

#[test]
fn just_in_time_pixels_show_the_ideal_picture() {
    all_sizes(|entry| entry.family == "jitp");
}

/// Number of primitives for comparisons between levels. It is small, so that code keeps up with the beam.
const AT_BOTH_LEVELS: usize = 30;

/// Times differ between the levels, but pictures must be equal to the bit. One slave draws, so that ties are resolved
/// in the order of the display list. One variant represents each family that draws faces.
#[test]
fn every_pipeline_shows_the_same_pictures_at_the_cycle_level() {
    let registry = registry();
    let molecules = scene::builtin("molecules").expect("built in");
    let mut families = BTreeSet::new();
    for entry in registry.pipelines() {
        if !families.insert(entry.family) && !draws_pictures(entry) {
            continue;
        }
        let size = if entry.family == "slats" { (1, 5) } else { (2, 20) };
        let (most, fields) = load(entry.name, size, false);
        let scene = Arc::new(still(&molecules, most.min(AT_BOTH_LEVELS)));
        let drawn = (entry, LINES_AT_BOTH_LEVELS);
        let [table, code] =
            [Level::Transaction, Level::Cycle].map(|level| run_at(level, drawn, size, &scene, fields.min(60)));
        assert_ne!(table.report().trace_hash, code.report().trace_hash, "{} takes other times", entry.name);
        for surface in (0..table.pipeline().properties().eyes as u16).map(SurfaceId) {
            let [expected, found] = [&table, &code].map(|outcome| outcome.picture(surface).expect("pixels are on"));
            let background = expected.get_pixel(0, 0);
            assert!(expected.pixels().any(|pixel| pixel != background), "{}: something is drawn", entry.name);
            let other = expected.pixels().zip(found.pixels()).filter(|(a, b)| a != b).count();
            assert_eq!(other, 0, "{}: pixels of surface {}", entry.name, surface.index());
        }
    }
}

/// Returns true if a pipeline draws pictures for the eye. Faces of a cube are compared with ideal faces in
/// crates/pxpl5-run/tests/faces, and their display is compared with a reference model.
fn draws_pictures(entry: &PipelineEntry) -> bool {
    (entry.build)(&PipelineSettings::default()).properties().coverage == Coverage::View
}

#[test]
fn every_pipeline_of_flat_pictures_is_covered_by_the_tests_of_still_scenes() {
    let families = ["rendering-control", "slats", "frameless", "jitp"];
    let registry = registry();
    let mut pictures = registry.pipelines().iter().filter(|entry| draws_pictures(entry));
    assert!(pictures.all(|entry| families.contains(&entry.family)));
}

/// Without beam racing, the strips of a field arrive one field before their beam. They must never arrive while the
/// field two before is still to be shown, although machines with many slaves could send them earlier.
#[test]
fn no_pipeline_overwrites_lines_before_they_are_shown() {
    let full = Arc::new(scene::builtin("full-screen:4").expect("built in"));
    let fields = support::sample_or_all(20, 40);
    let registry = registry();
    let all_but_frameless = registry.pipelines().iter().filter(|entry| entry.family != "frameless");
    for entry in all_but_frameless.filter(|entry| draws_pictures(entry)) {
        for size in [(7, 5), (13, 5), (34, 20), (50, 20)] {
            for strip_rows in [1, 8, 128] {
                let settings = with_strips(strip_rows);
                let experiment = Experiment::with(machine(entry, size), (entry.build)(&settings), Arc::clone(&full));
                let what = format!("{} on {size:?}, strips of {strip_rows}", entry.name);
                let run = experiment.fields(fields).pixels(pxpl5::Pixels::Off).run();
                let report = support::outcome(run, &what).report();
                // A line that arrived after its beam is never shown.
                let never_shown = report.lines_never_shown().expect("NTSC counts them");
                assert!(report.late_regions > 0 || never_shown == 0, "{what}: {never_shown}");
                if entry.family != "jitp" {
                    break;
                }
            }
        }
    }
}

fn with_strips(rows: u64) -> PipelineSettings {
    let mut settings = PipelineSettings::default();
    settings.set("strip_rows", KeyValue::Whole(rows));
    settings
}
