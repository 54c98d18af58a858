//! Tests of variants that the papers name as future work: Slats with a backup field, with several graphics processors
//! and with more renderers. Rendering Control is tested on the larger machines.

use pxpl5::limit::LimitQuery;
use pxpl5::scene::builtin;
use pxpl5::{
    Experiment, ExperimentFile, MachineConfig, Measured, Outcome, Pixels, RegionBinning, RenderingControl, Slats,
    Study, TestScene,
};

fn run(slats: Slats, scene: &str) -> Outcome {
    let scene = builtin(scene).expect("built in");
    let experiment = Experiment::new(MachineConfig::slats(), slats, scene).fields(20).pixels(Pixels::Off);
    experiment.run().expect("it runs")
}

fn limit(gps: usize, renderers: usize, slats: Slats, scene: TestScene) -> u32 {
    let config = MachineConfig { n_gps: gps, n_renderers: renderers, ..MachineConfig::slats() };
    let mut query = LimitQuery::of_papers(config, slats).expect("Slats is known");
    query.criterion.scene = scene;
    query.run(&mut ()).expect("it runs").triangles
}

#[test]
fn a_complete_field_goes_to_the_other_buffer_and_is_shown() {
    let outcome = run(Slats::backup(), "full-screen:60");
    assert_eq!(outcome.report().missed_retraces, Some(0));
    // Even and odd lines each change buffers every second field, so two fields come from one buffer and two from the
    // other.
    let buffers: Vec<u8> = outcome.observation().arrivals.iter().map(|arrival| arrival.target.buffer).collect();
    assert!(buffers.contains(&0) && buffers.contains(&1));
}

/// With a backup, the requests for a field take two messages more than a split copy. The limit of a split copy is 190
/// triangles.
#[test]
fn with_a_backup_140_triangles_have_no_late_region() {
    let outcome = run(Slats::backup(), "full-screen:140");
    assert_eq!(outcome.report().late_regions, 0);
}

/// Bins save work of the renderers and cost work of the processors. With a single processor, which is the limit itself,
/// bins lower the limit. With eight processors the renderers are the limit, as long as each draws every triangle in
/// each of its four regions of a field.
#[test]
fn sending_triangles_only_to_the_regions_that_they_touch_raises_the_limit_of_the_renderers() {
    let touched = Slats { binning: RegionBinning::Touched, ..Slats::split() };
    let of = |gps, slats| limit(gps, 5, slats, TestScene::Typical);
    let [all, binned] = [Slats::split(), touched].map(|slats| of(8, slats));
    // A typical triangle touches less than two of the ten regions of a field, so bins are worth at least twice.
    assert!(binned > 2 * all, "{binned} and {all}");
    let [all, binned] = [Slats::split(), touched].map(|slats| of(1, slats));
    assert!(binned < all, "{binned} and {all}");
}

/// A finished region leaves through the backing store. Colours take a block of 32 bits, and depths take another block.
#[test]
fn a_backing_store_too_small_for_a_region_is_refused() {
    for (pipeline, bits) in [("rendering-control", 32), ("arp-full", 64)] {
        let with = |bits: u64| {
            let text = format!(
                "pipeline = \"{pipeline}\"\nscene = \"sphere:60\"\nfields = 40\n[machine.renderer]\nbacking_bits = {bits}\n"
            );
            let plan = ExperimentFile::parse(&text, "test").expect("TOML").resolve().expect("it has a meaning");
            plan.experiment(plan.load_scene().expect("built in")).pixels(Pixels::Off)
        };
        let error = with(bits - 1).build().map(drop).expect_err("no region would ever leave").to_string();
        let expected = format!("renderer.backing_bits: expected {bits} at least");
        assert!(error.contains(&expected) && error.ends_with(&format!("found {}", bits - 1)), "{error}");
        let outcome = with(bits).run().expect("it runs");
        assert!(outcome.pictures().iter().any(|times| times.is_shown()), "{pipeline} with {bits} bits");
    }
}

#[test]
fn every_machine_named_by_the_papers_runs() {
    // Machines have up to 50 GPs and 20 renderers (I3D95). Full input FIFOs must not block the pixels of their own
    // boards.
    for machine in ["small-hmd", "medium", "large"] {
        let config = MachineConfig::preset(machine).expect("listed");
        let head = builtin("head").expect("built in");
        let experiment = Experiment::new(config, RenderingControl::stereo(), head).fields(120).pixels(Pixels::Off);
        let outcome = experiment.run().expect("it runs");
        let last = outcome.steady_pictures().last().expect("some were shown");
        let fields = outcome.end().since(last.shown_at).as_ms() / 16.683;
        // Two eyes of 59,592 triangles take the 12 slaves of the smallest machine 13 fields, and several frames are in
        // progress.
        assert!(fields < 30.0, "{machine} shows nothing for {fields} fields");
    }
}
