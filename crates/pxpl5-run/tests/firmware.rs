//! Short runs of each firmware on small machines: a still scene is shown as an ideal renderer draws it, and pictures come as the rules of the
//! papers have them.

use glam::Vec3;
use pxpl5_gp::{Account, Fault, OutOfMemory, Stage};
use pxpl5_machine::{MachineConfig, RunError};
use pxpl5_run::{
    Experiment, ExperimentError, FinishedRegions, KeyValue, Outcome, Pipeline, PipelineSettings, Pixels, Registry,
    RenderingControl, Slats,
};
use pxpl5_scene::{HeadMotion, HeadPath, Scene, Sway, builtin};
use pxpl5_sim::Time;
use pxpl5_wire::{RegionId, SurfaceId};
use std::sync::Arc;

/// Spheres or triangles before a head that stands.
fn still(name: &str) -> Arc<Scene> {
    let scene = builtin(name).expect("built in");
    let (target, radius) = scene.bounding_sphere();
    let mut parts = scene.posed(&scene.edits_at(0)).into_parts();
    parts.structures.iter_mut().for_each(|structure| structure.hinge = None);
    let eye = target + Vec3::Z * (radius * 3.0);
    parts.motion = HeadMotion::new(HeadPath::Still { eye, target }, Sway::none()).expect("in range");
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
    for surface in (0..outcome.pipeline().eyes() as u16).map(SurfaceId) {
        let ideal = outcome.ideal_picture(surface, Time::ZERO).expect("drawn");
        let picture = outcome.pipeline().picture(outcome.record(), surface).expect("shown");
        let background = picture.get_pixel(0, 0);
        assert!(picture.pixels().any(|pixel| pixel != background), "{what}: something is drawn");
        assert_eq!(ideal.differences(&picture).first(), None, "{what}, {surface:?}");
    }
}

/// A field that is drawn in time is shown at the retrace after the one at which it began (TR94): each field has a picture, and of one
/// that is late the last complete one is shown again, where there is a backup.
#[test]
fn slats_shows_each_field_a_field_after_it_began() {
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

/// With more than a field's time of primitives each picture takes two fields or more, and what is shown stays whole.
#[test]
fn slats_goes_on_when_fields_are_late() {
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

/// When RENDER of each frame ended, over all eyes, beside the instant from which the frame before it is shown: its buffer is free then.
fn rendered_and_free(outcome: &Outcome) -> Vec<(Time, Time)> {
    let shown = outcome.pictures().iter().map(|picture| (picture.picture.next(), picture.shown_at));
    let stages = outcome.stages();
    let ends = |frame| stages.iter().filter(move |s| s.stage == Stage::Render && s.picture == frame).map(|s| s.end);
    shown.filter_map(|(frame, free)| Some((ends(frame).max()??, free))).collect()
}

/// Three renderers hold three regions of a frame until its buffer is free, so that RENDER waits; what is put into their backing stores
/// lets it go on.
#[test]
fn regions_that_are_stored_let_render_end_before_the_buffer_is_free() {
    let scene = still("sphere:10");
    for finished in FinishedRegions::ALL {
        let pipeline = RenderingControl { finished, ..RenderingControl::stereo() };
        let outcome = run(Arc::new(pipeline), machine("small-hmd", 2, 3), &scene, 24);
        let frames = rendered_and_free(&outcome);
        let early = frames.iter().filter(|(rendered, free)| rendered < free).count();
        assert_eq!(early > 0, finished == FinishedRegions::Store, "{finished:?}: {early} of {}", frames.len());
    }
}

/// TR94: 7,700 triangles that cover the screen on 12 slaves, 642 each, in 20 bins of 4 bytes a pointer. As many for the next frame wait until
/// those are drawn.
#[test]
fn bins_of_rendering_control_hold_642_triangles_that_cover_the_screen_and_no_more() {
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

#[test]
fn just_in_time_pixels_show_what_the_oracle_draws() {
    let registry = Registry::of_papers();
    let scene = still("sphere:10");
    for name in ["jitp-field", "jitp-field-racing", "jitp-scanline", "jitp-dual-screen", "jitp-dual-view-racing"] {
        let entry = registry.pipeline(name).expect("listed");
        let mut settings = PipelineSettings::default();
        settings.set("strip_rows", KeyValue::Whole(8));
        for (n_gps, n_renderers) in [(3, 5), (6, 20)] {
            let pipeline = (entry.build)(&settings);
            let outcome = run(pipeline, machine(entry.preset, n_gps, n_renderers), &scene, 10);
            assert_ideal(&outcome, &format!("{name} with {n_gps} and {n_renderers}"));
        }
    }
}
