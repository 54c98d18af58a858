//! The cycle level: graphics processors whose time comes from i860 code over the data of every triangle.

use pxpl5::limit::test_scene;
use pxpl5::{
    CodeVersion, Experiment, ExperimentError, Level, MachineConfig, Measured, Outcome, PictureNumber, Pixels,
    RenderingControl, Slats, TestScene, Workstation, scene,
};
use pxpl5_gp::Stage;

const CLUMP: u32 = 30;

/// A clump of triangles that are wholly inside the guard band, so that none is left to the clipper.
fn slats(machine: &str) -> Experiment {
    slats_on(MachineConfig::preset(machine).expect("listed"))
}

fn slats_on(machine: MachineConfig) -> Experiment {
    let small = test_scene(TestScene::Typical, CLUMP);
    Experiment::new(machine, Slats::split(), small).fields(12).pixels(Pixels::Off).level(Level::Cycle)
}

fn rendering_control() -> Experiment {
    let mig = scene::builtin("mig").expect("built in");
    Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), mig)
        .fields(24)
        .pixels(Pixels::Off)
        .level(Level::Cycle)
}

fn hash(experiment: &Experiment) -> String {
    experiment.run().expect("it runs").report().trace_hash
}

/// Mean time of TRANSFORM of the pictures after the first ones, in microseconds.
fn transform_us(outcome: &Outcome) -> f64 {
    let stages = outcome.stages();
    let spans = stages.iter().filter(|span| span.stage == Stage::Transform && span.picture > PictureNumber(2));
    let times: Vec<_> = spans.filter_map(|span| Some((span.end? - span.begin).as_ms() * 1e3)).collect();
    times.iter().sum::<f64>() / times.len() as f64
}

#[test]
fn both_pipelines_give_the_same_trace_whatever_the_ties_and_the_pixels() {
    for experiment in [slats("slats-optimised"), rendering_control()] {
        let expected = hash(&experiment);
        assert_eq!(experiment.run().expect("it runs").report().level, "cycle");
        for seed in 0..5 {
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

/// Time of TRANSFORM of a clump, without the beginning of the pass and the message behind it.
fn clump_us(preset: &str) -> f64 {
    machine_us(MachineConfig::preset(preset).expect("listed"))
}

fn machine_us(machine: MachineConfig) -> f64 {
    let gp = MachineConfig::slats().gp;
    transform_us(&slats_on(machine).run().expect("it runs")) - (gp.pass_ns + gp.message_ns) as f64 * 1e-3
}

/// The presets of 1994 and of 1995 have the same code and other times in the table, so that nothing of these times is the table's.
#[test]
fn the_codes_are_in_the_order_of_their_making() {
    let [compiled, of_1995, scheduled] = ["slats", "slats-1995", "slats-optimised"].map(clump_us);
    assert!((compiled - of_1995).abs() < 1e-6, "{compiled:.3} us and {of_1995:.3} us for the same code");
    let machine = MachineConfig { code: Some(CodeVersion::Unoptimised), ..MachineConfig::slats() };
    let straight = machine_us(machine);
    assert!(scheduled < compiled && compiled < straight, "{scheduled:.0}, {compiled:.0}, {straight:.0} us");
    // I3D95 expected a factor of about 3 of code that fits the instruction cache.
    let factor = compiled / scheduled;
    assert!((2.0..4.0).contains(&factor), "{compiled:.0} us and {scheduled:.0} us: a factor of {factor:.2}");
}

/// Times of TRANSFORM of thirty triangles and two eyes, with two times per triangle in the table.
fn transforms_us(code: Option<CodeVersion>, triangle_ns: [u64; 2]) -> [f64; 2] {
    triangle_ns.map(|triangle_ns| {
        let mut machine = MachineConfig { code, ..MachineConfig::slats() };
        machine.set("gp.triangle_ns", triangle_ns).expect("known");
        let full = scene::builtin("full-screen:30").expect("built in");
        let experiment = Experiment::new(machine, Slats::split(), full).fields(12).level(Level::Cycle);
        transform_us(&experiment.pixels(Pixels::Off).run().expect("it runs"))
    })
}

#[test]
fn a_time_per_triangle_that_is_set_holds_where_no_code_runs() {
    let us = transforms_us(None, [20_000, 21_000]);
    // Thirty triangles, two eyes, one microsecond each.
    assert!((us[1] - us[0] - 60.0).abs() < 1e-6, "{us:?}");
}

/// A nanosecond more in the table once decided whether the code ran at all; now it counts for triangles that are clipped,
/// for which there is no code: a nanosecond each at most.
#[test]
fn a_nanosecond_in_the_table_does_not_choose_the_code() {
    let us = transforms_us(MachineConfig::slats().code, [21_700, 21_701]);
    assert!((0.0..=0.060 + 1e-6).contains(&(us[1] - us[0])), "{us:?}");
}

#[test]
fn the_analytic_level_is_refused_by_an_experiment() {
    let error = slats("slats").level(Level::Analytic).run().expect_err("no events");
    assert!(matches!(error, ExperimentError::Level), "{error}");
    assert!(error.to_string().starts_with("level: expected transaction or cycle, found analytic"));
}
