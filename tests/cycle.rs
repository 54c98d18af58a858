//! Tests of the cycle level: the times of graphics processors come from i860 code that runs for every triangle.

use crate::support;
use jitp::JitpTiming;
use pxpl5::SlatsLighting;
use pxpl5::run::{FacePipeline, FacePolicy};
use pxpl5::{
    CodeVersion, Experiment, ExperimentError, Frameless, Interpolation, Jitp, Level, MachineConfig, Measured, Outcome,
    PictureNumber, Pipeline, Pixels, RenderingControl, Slats, TestScene, TraceHash, Viewpoint, Workstation, scene,
};
use pxpl5_gp::Stage;
use rayon::prelude::*;
use std::sync::Arc;

/// Number of triangles in a full clump.
const CLUMP: u32 = 30;
const PART_OF_A_CLUMP: u32 = 20;

/// Parameters of the table whose times come from code at the cycle level.
const TIMES_OF_CODE: [&str; 10] =
    ["message", "triangle", "bin_entry", "token_entry", "guard", "sphere", "edit", "pass", "structure", "sphere_view"];

fn slats(machine: &str) -> Experiment {
    slats_on(MachineConfig::preset(machine).expect("listed"), Slats::split(), CLUMP)
}

/// Returns Slats with a clump of triangles inside the guard band, so that no triangle is clipped.
fn slats_on(machine: MachineConfig, slats: Slats, triangles: u32) -> Experiment {
    let small = TestScene::Typical.with_triangles(triangles);
    Experiment::new(machine, slats, small).fields(12).pixels(Pixels::Off).level(Level::Cycle)
}

fn rendering_control() -> Experiment {
    let mig = scene::builtin("mig").expect("built in");
    Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), mig)
        .fields(24)
        .pixels(Pixels::Off)
        .level(Level::Cycle)
}

/// Returns the trace hash of a run, even if the run shows no picture after the warm-up.
fn hash(experiment: &Experiment) -> TraceHash {
    support::outcome(experiment.run(), "cycle level").record().trace_hash()
}

/// Returns the mean time of TRANSFORM after the first pictures, in microseconds.
fn transform_us(outcome: &Outcome) -> f64 {
    let stages = outcome.stages();
    let spans = stages.iter().filter(|span| span.stage == Stage::Transform && span.picture > PictureNumber(2));
    let times: Vec<_> = spans.filter_map(|span| Some((span.end? - span.begin).as_ms() * 1e3)).collect();
    times.iter().sum::<f64>() / times.len() as f64
}

#[test]
fn the_trace_at_the_cycle_level_does_not_depend_on_pixels_or_on_the_order_of_simultaneous_events() {
    for experiment in [slats("slats-optimised"), rendering_control()] {
        let expected = hash(&experiment);
        assert_eq!(experiment.run().expect("it runs").report().level, "cycle");
        for seed in 0..support::sample_or_all(3, 5) {
            assert_eq!(hash(&experiment.clone().shuffle_ties(seed)), expected, "ties in order {seed}");
        }
        assert_eq!(
            hash(&experiment.clone().pixels(Pixels::All).host(Workstation::with_threads(2))),
            expected,
            "with all pixels"
        );
        assert_ne!(hash(&experiment.clone().level(Level::Transaction)), expected, "other times");
        assert_ne!(experiment.config_hash(), experiment.level(Level::Transaction).config_hash());
    }
}

/// Returns the time of a triangle for two eyes: the additional time of more triangles in a clump. The constant time of
/// a pass and its messages cancels out.
fn triangle_us(preset: &str) -> f64 {
    machine_us(MachineConfig::preset(preset).expect("listed"), Slats::split())
}

fn machine_us(machine: MachineConfig, slats: Slats) -> f64 {
    let [less, more] = [PART_OF_A_CLUMP, CLUMP]
        .map(|triangles| transform_us(&slats_on(machine.clone(), slats, triangles).run().expect("it runs")));
    (more - less) / f64::from(CLUMP - PART_OF_A_CLUMP)
}

/// The presets of 1994 and of 1995 have the same code and different times in the table. Equal results prove that no
/// time comes from the table.
#[test]
fn scheduled_code_is_faster_than_compiled_code_and_compiled_code_faster_than_straight_code() {
    let [compiled, of_1995, scheduled] = ["slats", "slats-1995", "slats-optimised"].map(triangle_us);
    assert!((compiled - of_1995).abs() < 1e-6, "{compiled:.3} us and {of_1995:.3} us for the same code");
    let machine = MachineConfig { code: Some(CodeVersion::Unoptimised), ..MachineConfig::slats() };
    let straight = machine_us(machine, Slats::split());
    assert!(scheduled < compiled && compiled < straight, "{scheduled:.0}, {compiled:.0}, {straight:.0} us");
    // I3D95 expected a factor of about 3 for code that fits the instruction cache. With light on the GP, both versions
    // compute the same words.
    let lit = Slats { lighting: SlatsLighting::OnGp, ..Slats::split() };
    let [compiled, scheduled] =
        ["slats", "slats-optimised"].map(|preset| machine_us(MachineConfig::preset(preset).expect("listed"), lit));
    let factor = compiled / scheduled;
    assert!((2.0..4.0).contains(&factor), "{compiled:.0} us and {scheduled:.0} us: a factor of {factor:.2}");
}

/// All work is code: triangles, clipped triangles, spheres, edits, passes, tokens and messages. The table has no
/// effect.
#[test]
fn with_i860_code_the_times_of_the_table_have_no_effect() {
    let hash_on = |machine: &MachineConfig, pipeline: Arc<dyn Pipeline>, name: &str| {
        let scene = Arc::new(scene::builtin(name).expect("built in"));
        let experiment = Experiment::with(machine.clone(), pipeline, scene).fields(support::sample_or_all(6, 24));
        hash(&experiment.pixels(Pixels::Off).level(Level::Cycle))
    };
    let slats: Arc<dyn Pipeline> = Arc::new(Slats::split());
    let control: Arc<dyn Pipeline> = Arc::new(RenderingControl::stereo());
    let faces = |policy| Arc::new(FacePipeline::new(policy)) as Arc<dyn Pipeline>;
    let jitp = |viewpoint, racing| Arc::new(Jitp::new(viewpoint, racing)) as Arc<dyn Pipeline>;
    let cases = [
        ("slats", slats, "full-screen:30"),
        ("small-hmd", Arc::clone(&control), "mig"),
        // The walls of a room around the viewer reach behind the near plane, so triangles are clipped.
        ("small-hmd", Arc::clone(&control), "room"),
        ("small-hmd", control, "molecules"),
        ("small-hmd", faces(FacePolicy::Full), "molecules"),
        ("small-hmd", faces(FacePolicy::Objects), "gallery"),
        ("small-hmd", faces(FacePolicy::Cells), "gallery"),
        ("small-hmd", faces(FacePolicy::CellsWarped), "gallery"),
        ("small-hmd", jitp(Viewpoint::Field, false), "mig"),
        ("small-hmd", jitp(Viewpoint::Field, true), "molecules"),
        ("small-hmd", jitp(Viewpoint::Strip, false), "full-screen:30"),
        ("small-hmd", jitp(Viewpoint::Strip, true), "full-screen:30"),
        ("small-hmd", jitp(Viewpoint::Dual(Interpolation::Screen), true), "mig"),
        ("small-hmd", jitp(Viewpoint::Dual(Interpolation::View), false), "full-screen:30"),
        ("small-hmd", Arc::new(Frameless::new()), "molecules"),
    ];
    cases.into_par_iter().for_each(|(preset, pipeline, scene)| {
        let mut own = pipeline.adapt(MachineConfig::preset(preset).expect("listed"));
        own.add_firmware_table("jitp", Box::new(JitpTiming::PAPERS));
        let mut other = own.clone();
        for name in TIMES_OF_CODE {
            other.set(&format!("gp.{name}_ns"), 77_777).expect("known");
        }
        other.set("jitp.interpolate_ns", 77_777).expect("known");
        let [own, other] = [own, other].map(|machine| hash_on(&machine, Arc::clone(&pipeline), scene));
        assert_eq!(own, other, "{} with {scene}", pipeline.name());
    });
}

#[test]
fn the_analytic_level_is_refused_by_an_experiment() {
    let error = slats("slats").level(Level::Analytic).run().expect_err("no events");
    assert!(matches!(error, ExperimentError::Level), "{error}");
    assert!(error.to_string().starts_with("level: expected transaction or cycle, found analytic"));
}
