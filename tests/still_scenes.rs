//! A still scene looks the same on every machine, under every pipeline: as an ideal renderer of one process draws it.
//!
//! Sizes reach from one slave to 49 and from one renderer to 20, with the sizes between at which messages of a region used
//! to be drawn into another slave's. Only pixels at which two primitives have the same depth to the last bit may differ, and
//! only by showing another of these primitives: the oracle knows them.
//!
//! `PXPL5_MODELS=FOLDER cargo test --test still_scenes` draws every model of a folder too; with `PXPL5_PICTURES=FOLDER` all
//! pictures and the oracle's are written there, to be looked at.

use pxpl5::oracle::IdealPicture;
use pxpl5::scene::config::FIT_DISTANCE_RADII;
use pxpl5::scene::{self, HeadMotion, HeadPath, Scene, Sway};
use pxpl5::{
    Experiment, ExperimentError, KeyValue, Level, MachineConfig, Measured, Outcome, PipelineEntry, PipelineSettings,
    Report, SurfaceId, Time, registry,
};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// Processors, the master included, and renderers.
const SIZES: [(usize, usize); 6] = [(2, 1), (2, 20), (7, 3), (13, 5), (34, 20), (50, 20)];

/// Slats binds four field regions to a renderer, so it takes five; and it needs no master.
const SIZES_OF_SLATS: [(usize, usize); 4] = [(1, 5), (7, 5), (13, 20), (50, 20)];

/// Primitives that a pipeline is given of a scene, of all of which it draws evenly spread ones, and fields after which all of
/// a still picture has been drawn.
///
/// Just-in-time pixels leave out strips whose beam has passed, so that more than they can draw would never be seen.
/// A slave has as many strip times of 508 us as there are slaves, in which it transforms everything for each strip
/// (scanline, 21.7 us a primitive) or interpolates it (dual, 7 us), and a field of 16.7 ms for its transforms. One renderer
/// has 508 us to draw and copy five regions, which leaves 230 us for triangles of 6.45 us: seven for each column.
/// An overloaded Slats that takes an even number of fields for each picture would draw the same lines for ever.
/// Rendering Control with one slave has 8 MB for all commands.
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
        "slats" => (417, 40),
        "frameless" => (450, if slaves == 1 { 90 } else { 30 }),
        "jitp-field" | "jitp-field-racing" => (450.min(by_renderers), 12),
        "jitp-scanline" | "jitp-scanline-racing" => ((10 * slaves).min(by_renderers).min(300), 12),
        _ => ((20 * slaves).min(by_renderers).min(200), 12),
    }
}

/// The scene at time zero with at most `most` of its primitives, evenly spread, before a head that stands
/// where `motion.path = "still"` has it.
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

/// The built-in scenes, and the models of the folder that was named.
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

/// Strips of eight lines: of one line, a single slave could not draw any in time. By code it takes longer: a sphere 78 us, the beginning
/// of each pass more than 100 us (docs/gp-timing.md); so strips have 32 lines where levels are compared, and 2.0 ms each.
fn settings(entry: &PipelineEntry, lines: u64) -> PipelineSettings {
    if entry.family == "jitp" { with_strips(lines) } else { PipelineSettings::default() }
}

/// Lines of a strip where pictures are held against the oracle, and where they are compared between levels.
const LINES: u64 = 8;
const LINES_AT_BOTH_LEVELS: u64 = 32;

fn run(entry: &PipelineEntry, size: (usize, usize), scene: &Arc<Scene>, fields: u64) -> Outcome {
    run_at(Level::Transaction, (entry, LINES), size, scene, fields)
}

/// Some pictures may never be complete: what is seen at the end counts here, not when it came.
fn run_at(
    level: Level,
    (entry, lines): (&PipelineEntry, u64),
    size: (usize, usize),
    scene: &Arc<Scene>,
    fields: u64,
) -> Outcome {
    let pipeline = (entry.build)(&settings(entry, lines));
    match Experiment::with(machine(entry, size), pipeline, Arc::clone(scene)).fields(fields).level(level).run() {
        Ok(outcome) => outcome,
        Err(ExperimentError::TooShort { partial, .. }) => *partial,
        Err(error) => panic!("{} on {size:?} with {}: {error}", entry.name, scene.name()),
    }
}

/// The oracle's pictures by what they depend on: a pipeline's shading and layout, scene, primitives and eye.
type Ideals = Mutex<BTreeMap<(String, usize, u16), Arc<IdealPicture>>>;
static IDEALS: Ideals = Mutex::new(BTreeMap::new());

fn ideal(outcome: &Outcome, scene: &Scene, surface: u16) -> Arc<IdealPicture> {
    let primitives = scene.triangles().len() + scene.spheres().len();
    let pipeline = outcome.pipeline();
    let drawn =
        format!("{} {} {} {}", scene.name(), pipeline.layout().plan().name, pipeline.shading() as u8, pipeline.eyes());
    let key = (drawn, primitives, surface);
    let known = IDEALS.lock().unwrap_or_else(PoisonError::into_inner).get(&key).cloned();
    known.unwrap_or_else(|| {
        let fresh = Arc::new(outcome.ideal_picture(SurfaceId(surface), Time::ZERO).expect("it has that eye"));
        IDEALS.lock().unwrap_or_else(PoisonError::into_inner).insert(key, Arc::clone(&fresh));
        fresh
    })
}

/// What is wrong with the pictures of a run, if anything.
fn faults(entry: &PipelineEntry, size: (usize, usize), whole: &Scene) -> Vec<String> {
    let covers_the_screen = whole.name().starts_with("full-screen");
    let (most, fields) = load(entry.name, size, covers_the_screen);
    let scene = Arc::new(still(whole, most));
    let outcome = run(entry, size, &scene, fields);
    let mut faults = Vec::new();
    for surface in 0..outcome.pipeline().eyes() as u16 {
        let ideal = ideal(&outcome, &scene, surface);
        let picture = outcome.picture(SurfaceId(surface)).expect("pixels are on");
        let wrong = ideal.differences(&picture);
        let name = format!("{}-{}-{}-{}-{surface}", entry.name, scene.name().replace([':', '/'], "-"), size.0, size.1);
        if let Ok(folder) = std::env::var("PXPL5_PICTURES") {
            picture.save(format!("{folder}/{name}.png")).expect("writable");
            ideal.image().save(format!("{folder}/{name}-ideal.png")).expect("writable");
        }
        println!("{name}: {} ties, {} wrong", ideal.ties().len(), wrong.len());
        if let Some([x, y]) = wrong.first() {
            faults.push(format!("{name}: {} pixels, the first at {x}, {y}", wrong.len()));
        }
    }
    faults
}

fn all_sizes(of: impl Fn(&PipelineEntry) -> bool) {
    let registry = registry();
    let mut wrong = Vec::new();
    for entry in registry.pipelines().iter().filter(|entry| of(entry)) {
        let sizes: &[(usize, usize)] = if entry.family == "slats" { &SIZES_OF_SLATS } else { &SIZES };
        for scene in &scenes() {
            sizes.iter().for_each(|size| wrong.extend(faults(entry, *size, scene)));
        }
    }
    assert!(wrong.is_empty(), "not as the oracle draws them:\n{}", wrong.join("\n"));
}

#[test]
fn rendering_control_shows_what_the_oracle_draws() {
    all_sizes(|entry| entry.family == "rendering-control");
}

#[test]
fn slats_and_frameless_rendering_show_what_the_oracle_draws() {
    all_sizes(|entry| ["slats", "frameless"].contains(&entry.family));
}

#[test]
fn just_in_time_pixels_show_what_the_oracle_draws() {
    all_sizes(|entry| entry.family == "jitp");
}

/// Primitives of which pictures are compared between levels: few, so that code keeps up with the beam.
const AT_BOTH_LEVELS: usize = 30;

/// Other times, and the same pictures to the bit. One slave draws, so that ties fall as in the display list. Of the variants of one
/// family that draws faces the first stands for all.
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
        let began = std::time::Instant::now();
        let drawn = (entry, LINES_AT_BOTH_LEVELS);
        let [table, code] =
            [Level::Transaction, Level::Cycle].map(|level| run_at(level, drawn, size, &scene, fields.min(60)));
        assert_ne!(table.report().trace_hash, code.report().trace_hash, "{} takes other times", entry.name);
        for surface in (0..table.pipeline().eyes() as u16).map(SurfaceId) {
            let [expected, found] = [&table, &code].map(|outcome| outcome.picture(surface).expect("pixels are on"));
            let background = expected.get_pixel(0, 0);
            assert!(expected.pixels().any(|pixel| pixel != background), "{}: something is drawn", entry.name);
            let other = expected.pixels().zip(found.pixels()).filter(|(a, b)| a != b).count();
            assert_eq!(other, 0, "{}: pixels of surface {}", entry.name, surface.index());
        }
        println!("{} {:?}", entry.name, began.elapsed());
    }
}

/// Whether a pipeline draws pictures of what an eye sees. Faces of a cube are held against the oracle face by face, in
/// crates/pxpl5-run/tests/faces.rs, and what is seen of them against a literal display.
fn draws_pictures(entry: &PipelineEntry) -> bool {
    (entry.build)(&PipelineSettings::default()).draws_faces().is_none()
}

/// A pipeline that is not tested here would be one that nobody has held against the oracle.
#[test]
fn every_pipeline_is_drawn() {
    let families = ["rendering-control", "slats", "frameless", "jitp"];
    let registry = registry();
    let mut pictures = registry.pipelines().iter().filter(|entry| draws_pictures(entry));
    assert!(pictures.all(|entry| families.contains(&entry.family)));
}

/// Strips of a field that does not race come a field before their beam, and never while the field two before it has still to
/// be shown: on machines with many slaves they would come earlier than that.
#[test]
fn no_pipeline_overwrites_lines_that_have_still_to_be_shown() {
    let full = Arc::new(scene::builtin("full-screen:4").expect("built in"));
    let registry = registry();
    let all_but_frameless = registry.pipelines().iter().filter(|entry| entry.family != "frameless");
    for entry in all_but_frameless.filter(|entry| draws_pictures(entry)) {
        for size in [(7, 5), (13, 5), (34, 20), (50, 20)] {
            for strip_rows in [1, 8, 128] {
                let settings = with_strips(strip_rows);
                let experiment = Experiment::with(machine(entry, size), (entry.build)(&settings), Arc::clone(&full));
                let outcome = experiment.fields(40).pixels(pxpl5::Pixels::Off).run();
                let report = match outcome {
                    Ok(outcome) => outcome.report(),
                    Err(ExperimentError::TooShort { partial, .. }) => partial.report(),
                    Err(error) => panic!("{}: {error}", entry.name),
                };
                check_never_shown(&report, &format!("{} on {size:?}, strips of {strip_rows}", entry.name));
                if entry.family != "jitp" {
                    break;
                }
            }
        }
    }
}

/// A line that came after its beam is never shown either.
fn check_never_shown(report: &Report, what: &str) {
    let never_shown = report.lines_never_shown().expect("NTSC counts them");
    println!("{what}: {never_shown} lines never shown, {} regions late", report.late_regions);
    if report.late_regions == 0 {
        assert_eq!(never_shown, 0, "{what}");
    }
}

fn with_strips(rows: u64) -> PipelineSettings {
    let mut settings = PipelineSettings::default();
    settings.set("strip_rows", KeyValue::Whole(rows));
    settings
}
