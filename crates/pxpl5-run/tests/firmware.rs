//! Short runs of each firmware on small machines. A still scene must look like the ideal picture, and pictures must
//! follow the rules of the papers.

use glam::Vec3;
use pphigs::{Picture, RegionBinning, Shading, Share};
use pxpl5_geometry::Viewport;
use pxpl5_gp::{Account, Fault, OutOfMemory, Stage};
use pxpl5_machine::{MachineConfig, PRESETS, Preset, RunError};
use pxpl5_renderer::Layout;
use pxpl5_run::{
    Experiment, ExperimentError, FinishedRegions, Outcome, Pipeline, Pixels, RenderingControl, SceneViews, Slats,
    ViewSource, display_list,
};
use pxpl5_scene::{HeadMotion, Hmd, HmdConfig, Scene, builtin};
use pxpl5_sim::Time;
use pxpl5_wire::{
    FieldParity, Lines, MAX_MESSAGE_WORDS, NodeId, PictureNumber, RegionGrid, RegionId, SurfaceId, ViewNumber,
};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Returns spheres or triangles in front of a still head.
fn still(name: &str) -> Arc<Scene> {
    let scene = builtin(name).expect("built in");
    let (target, radius) = scene.bounding_sphere();
    let mut parts = scene.posed(&scene.edits_at(0)).into_parts();
    parts.structures.iter_mut().for_each(|structure| structure.hinge = None);
    let eye = target + Vec3::Z * (radius * 3.0);
    parts.motion = HeadMotion::still(eye, target).expect("in range");
    Arc::new(Scene::new(parts).expect("whole"))
}

fn machine(preset: &str, n_gps: usize, n_renderers: usize) -> MachineConfig {
    MachineConfig { n_gps, n_renderers, ..MachineConfig::preset(preset).expect("a preset") }
}

fn run(pipeline: Arc<dyn Pipeline>, config: MachineConfig, scene: &Arc<Scene>, fields: u64) -> Outcome {
    let config = pipeline.adapt(config);
    let experiment = Experiment::with(config, pipeline, Arc::clone(scene)).fields(fields).pixels(Pixels::Lazy);
    experiment.run().expect("it runs")
}

fn assert_ideal(outcome: &Outcome, what: &str) {
    for surface in (0..outcome.pipeline().properties().eyes as u16).map(SurfaceId) {
        let ideal = outcome.ideal_picture(surface, Time::ZERO).expect("drawn");
        let picture = outcome.pipeline().picture(outcome.record(), surface).expect("shown");
        let background = picture.get_pixel(0, 0);
        assert!(picture.pixels().any(|pixel| pixel != background), "{what}: something is drawn");
        assert_eq!(ideal.differences(&picture).first(), None, "{what}, {surface:?}");
    }
}

/// A field that is drawn in time is shown at the retrace after its start (TR94), so each field has a picture. With a
/// backup, the last complete picture replaces a late one.
#[test]
fn slats_shows_each_field_one_field_after_its_start() {
    let scene = still("sphere:10");
    for (name, pipeline) in [("whole", Slats::whole()), ("split", Slats::split()), ("backup", Slats::backup())] {
        for n_gps in [1, 2, 4] {
            let what = format!("{name} with {n_gps}");
            let outcome = run(Arc::new(pipeline), machine("slats-optimised", n_gps, 6), &scene, 20);
            assert_ideal(&outcome, &what);
            let shown: Vec<_> = outcome.pictures().iter().filter(|picture| picture.is_shown()).collect();
            assert!(shown.len() >= 15, "{what}: {}", shown.len());
            for pair in shown.windows(2) {
                assert_eq!(pair[1].picture, pair[0].picture.next(), "{what}");
                let fields = (pair[1].shown_at.0 - pair[0].shown_at.0) as f64 * 1e-9 / outcome.field_ms();
                assert!((fields - 1.0).abs() < 1e-6, "{what}: {fields} fields");
            }
            for picture in shown {
                let fields = (picture.shown_at.0 - picture.transform_at.0) as f64 * 1e-9 / outcome.field_ms();
                assert!(fields > 0.9 && fields < 1.0 + 1e-6, "{what}: {fields} fields from TRANSFORM to the retrace");
            }
        }
    }
}

/// With primitives for more than a field's time, each picture takes two fields or more, and only complete pictures are
/// shown.
#[test]
fn slats_continues_after_late_fields() {
    let scene = still("molecules");
    for (name, pipeline) in [("split", Slats::split()), ("backup", Slats::backup())] {
        let outcome = run(Arc::new(pipeline), machine("slats-optimised", 2, 20), &scene, 60);
        let pictures = outcome.pictures();
        assert!(pictures.len() >= 2, "{name}");
        for pair in pictures.windows(2) {
            assert!(pair[1].picture.0 >= pair[0].picture.0 + 2, "{name}: {pair:?}");
        }
    }
}

#[test]
fn rendering_control_shows_every_frame_whole_and_in_order() {
    let scene = still("sphere:10");
    let stereo = RenderingControl::stereo();
    let kinds = [
        ("stereo", stereo),
        ("mono", RenderingControl::mono()),
        ("store", RenderingControl { finished: FinishedRegions::Store, ..stereo }),
    ];
    for (name, pipeline) in kinds {
        for (n_gps, n_renderers) in [(2, 3), (4, 7), (5, 20)] {
            let what = format!("{name} with {n_gps} and {n_renderers}");
            let outcome = run(Arc::new(pipeline), machine("small-hmd", n_gps, n_renderers), &scene, 24);
            assert_ideal(&outcome, &what);
            let pictures = outcome.pictures();
            assert!(pictures.len() >= 3, "{what}: {}", pictures.len());
            for pair in pictures.windows(2) {
                assert_eq!(pair[1].picture, pair[0].picture.next(), "{what}");
                assert!(pair[1].shown_at > pair[0].shown_at, "{what}");
            }
        }
    }
}

/// Returns the times of the first and the last word of each COPY of a finished stereo run, in the order of drawing:
/// left eye, right eye, left eye.
fn copies(outcome: &Outcome) -> Vec<(Time, Time)> {
    let record = outcome.record();
    let message = record.ring().timing().occupancy(MAX_MESSAGE_WORDS);
    let mut copies: BTreeMap<(PictureNumber, SurfaceId), Vec<(Time, Time)>> = BTreeMap::new();
    for arrival in &record.observation().arrivals {
        let regions = copies.entry((arrival.target.picture, arrival.surface)).or_default();
        regions.push((arrival.begins_at(message), arrival.last_part_at));
    }
    let regions_of_eye = record.display().surfaces()[0].grid().regions() as usize;
    let whole = copies.into_values().filter(|regions| regions.len() == regions_of_eye);
    let span = |regions: Vec<(Time, Time)>| {
        let begin = regions.iter().map(|(begin, _)| *begin).min()?;
        Some((begin, regions.iter().map(|(_, end)| *end).max()?))
    };
    whole.filter_map(span).collect()
}

/// TR94: Rendering Control works on one eye after the other. At any time, only one frame buffer receives a copy,
/// although each frame buffer has a ring port of its own.
#[test]
fn copy_of_an_eye_begins_after_the_end_of_copy_of_the_previous_eye() {
    let light = builtin("full-screen:2").map(Arc::new).expect("built in");
    let heavy = still("sphere:10");
    for finished in FinishedRegions::ALL {
        let pipeline = RenderingControl { finished, ..RenderingControl::stereo() };
        for (n_gps, n_renderers) in [(2, 3), (13, 5), (13, 20), (13, 30)] {
            for (name, scene) in [("light", &light), ("heavy", &heavy)] {
                let what = format!("{finished:?}, {name} with {n_gps} and {n_renderers}");
                let outcome = run(Arc::new(pipeline), machine("small-hmd", n_gps, n_renderers), scene, 30);
                let copies = copies(&outcome);
                assert!(copies.len() >= 8, "{what}: {} copies", copies.len());
                for pair in copies.windows(2) {
                    assert!(pair[1].0 > pair[0].1, "{what}: {} before {}", pair[1].0, pair[0].1);
                }
                // Two copies of 15.6 ms cannot end in one field of 16.7 ms.
                for pair in outcome.pictures().windows(2) {
                    let fields = (pair[1].shown_at.0 - pair[0].shown_at.0) as f64 * 1e-9 / outcome.field_ms();
                    assert!(fields > 1.5, "{what}: {fields} fields from swap to swap");
                }
            }
        }
    }
}

/// COPY of both eyes takes 31.2 ms of the 33.4 ms of two fields. A light scene is thus shown every second field, with
/// any number of renderers. TRANSFORM of a frame begins at the earliest when COPY of the third previous eye has ended.
/// This instant is 31.2 ms after a swap and three frames before the swap of the new frame. Additional renderers only
/// make frames wait longer.
#[test]
fn a_scene_limited_by_copy_keeps_rate_and_latency_with_any_number_of_renderers() {
    let scene = builtin("typical:2000").map(Arc::new).expect("built in");
    for n_renderers in [18, 19, 20, 21, 30] {
        let config = machine("small-hmd", 13, n_renderers);
        let outcome = run(Arc::new(RenderingControl::stereo()), config, &scene, 60);
        let field_ps = outcome.field_ms() * 1e9;
        let most_ps = 6.0 * field_ps - 31.2e9;
        let pictures = outcome.steady_pictures();
        assert!(pictures.len() >= 20, "{n_renderers}: {}", pictures.len());
        for pair in pictures.windows(2) {
            let fields = (pair[1].shown_at.0 - pair[0].shown_at.0) as f64 / field_ps;
            assert!((fields - 2.0).abs() < 1e-6, "{n_renderers}: {fields} fields from swap to swap");
        }
        for picture in pictures {
            let latency_ps = (picture.shown_at.0 - picture.transform_at.0) as f64;
            assert!(latency_ps < most_ps && latency_ps > 3.0 * field_ps, "{n_renderers}: {latency_ps} ps");
        }
    }
}

/// Returns the number of triangles of `full-screen:12` in one eye's picture that are on the screen, and the number that
/// were clipped.
fn on_screen_and_clipped(hmd: HmdConfig, grid: RegionGrid, lines: Lines) -> [(u64, u64); 2] {
    let scene = builtin("full-screen:12").map(Arc::new).expect("built in");
    let share = Share::new(Arc::new(display_list(&scene).expect("it has triangles")), 0, 1);
    let viewport = Viewport::new(grid, lines).expect("a picture");
    let (shading, layout) = (Shading::Phong, Layout::rendering_control_phong());
    let picture = Picture { viewport, shading, binning: RegionBinning::Touched, layout, pixels: false };
    let view = SceneViews::new(&scene, 1, Hmd::new(hmd).expect("in range"), 2).newest(ViewNumber(0), Time::ZERO);
    [0, 1].map(|eye| {
        let pass = share.transform(&view, eye, picture);
        (pass.stats().screen_triangles, pass.stats().clipped)
    })
}

/// The triangles of the papers' test scene are on the screen, and none of them takes time in the clipper.
#[test]
fn full_screen_triangles_are_never_clipped_by_the_near_plane() {
    let ntsc = RegionGrid::FRAME;
    let cut = |width, height| RegionGrid { width, height, ..ntsc };
    let of_preset = |preset: &Preset| {
        let machine = MachineConfig::preset(preset.name).expect("a preset");
        let display = machine.displays.first().expect("a display");
        let nodes: Vec<NodeId> = (0..display.ports(1) as u16).map(NodeId).collect();
        display.build(&nodes, pxpl5_sim::Span::from_ns(50)).expect("a display").surfaces()[0].grid()
    };
    let frames = PRESETS.iter().map(of_preset).chain([cut(1280, 1024), cut(1500, 1000), cut(240, 320)]);
    let frames = frames.map(|grid| (grid, Lines::Frame));
    let fields = [FieldParity::Even, FieldParity::Odd].map(|parity| (RegionGrid::FIELD, Lines::Field(parity)));
    for (grid, lines) in frames.chain(fields) {
        for eye_separation_m in [0.0, 0.054, 0.064, 0.074] {
            let (width_px, height_px) = (grid.width, Viewport::new(grid, lines).expect("a picture").frame_lines());
            let hmd = HmdConfig { eye_separation_m, width_px, height_px, ..HmdConfig::unc() };
            let found = on_screen_and_clipped(hmd, grid, lines);
            assert_eq!(found, [(12, 0); 2], "{width_px} x {height_px}, eyes {eye_separation_m} m apart");
        }
    }
}

/// Returns the end of RENDER of each frame, over all eyes, and the instant at which the previous frame is shown. At
/// this instant the buffer becomes free.
fn rendered_and_free(outcome: &Outcome) -> Vec<(Time, Time)> {
    let shown = outcome.pictures().iter().map(|picture| (picture.picture.next(), picture.shown_at));
    let stages = outcome.stages();
    let ends = |frame| stages.iter().filter(move |s| s.stage == Stage::Render && s.picture == frame).map(|s| s.end);
    shown.filter_map(|(frame, free)| Some((ends(frame).max()??, free))).collect()
}

/// Three renderers hold three regions of a frame until its buffer is free, so RENDER waits. With the backing stores in
/// use, RENDER continues.
#[test]
fn with_stored_regions_render_ends_before_the_buffer_is_free() {
    let scene = still("sphere:10");
    for finished in FinishedRegions::ALL {
        let pipeline = RenderingControl { finished, ..RenderingControl::stereo() };
        let outcome = run(Arc::new(pipeline), machine("small-hmd", 2, 3), &scene, 24);
        let frames = rendered_and_free(&outcome);
        let early = frames.iter().filter(|(rendered, free)| rendered < free).count();
        assert_eq!(early > 0, finished == FinishedRegions::Store, "{finished:?}: {early} of {}", frames.len());
    }
}

/// TR94: 7,700 triangles cover the screen. Each of the 12 slaves has 642 of them in 20 bins, at 4 bytes a pointer. The
/// bins of the next frame take the same space until the first are drawn.
#[test]
fn the_bins_of_a_slave_hold_642_triangles_that_cover_the_screen_and_a_643rd_triangle_is_a_fault() {
    let run = |triangles: u32| {
        let scene = builtin(&format!("full-screen:{triangles}")).expect("built in");
        let experiment = Experiment::new(machine("small-hmd", 2, 20), RenderingControl::mono(), scene);
        experiment.fields(24).pixels(Pixels::Off).run()
    };
    let Err(ExperimentError::TooShort { pictures, .. }) = run(642) else { panic!("a frame takes seven fields") };
    assert!(pictures > 2, "both contexts are filled again");
    let Err(ExperimentError::Run { error: RunError::Fault { fault: Fault::Memory(fault), .. }, .. }) = run(643) else {
        panic!("642 * 20 * 4 bytes are all that there are")
    };
    let OutOfMemory { account, region, needed_bytes, available_bytes, .. } = fault;
    assert_eq!((account, region), (Account::Bins(0), Some(RegionId(19))));
    assert_eq!((needed_bytes, available_bytes), (643 * 20 * 4, 642 * 20 * 4));
}
