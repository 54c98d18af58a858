//! Tests of the optimizations: with each of them disabled, the trace and the visible pixels stay the same.

use crate::support::ntsc;
use pxpl5::{
    Experiment, Eye, Jitp, Level, Machine, MachineConfig, Optimization, PeriodNumber, Pixels, RenderingControl, Slats,
    Viewpoint, scene, scene::Scene,
};
use pxpl5_framebuffer::ScannedField;
use std::collections::BTreeSet;

/// Returns the Mig with at most `triangles` of its 417 triangles.
fn mig(triangles: usize) -> Scene {
    scene::builtin("mig").and_then(|mig| mig.decimated(triangles)).expect("so many")
}

/// Returns three pipelines, each with a scene that leaves some regions empty. Strips have eight lines, because the
/// thirteen beam times of a single line, 0.8 ms, are too short for a pass by code.
fn experiments() -> [Experiment; 3] {
    let jitp = Jitp { strip_rows: 8, ..Jitp::new(Viewpoint::Strip, true) };
    [
        Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), mig(417)),
        Experiment::new(MachineConfig::slats(), Slats::split(), mig(60)),
        Experiment::new(MachineConfig::small_hmd(), jitp, mig(30)),
    ]
}

fn after(experiment: &Experiment, fields: u64) -> Machine {
    let mut machine = experiment.build().expect("the presets are valid");
    let end = machine.record().tick(PeriodNumber(fields));
    machine.run_until(end).expect("it runs");
    machine.finish_pixels();
    machine
}

/// Returns the pixels of every displayed field, eye by eye.
fn seen(machine: &Machine, fields: u64) -> Vec<ScannedField> {
    let boards = Eye::BOTH.into_iter().filter_map(|eye| ntsc(machine.record()).boards().get(eye.index()));
    boards.flat_map(|board| (0..fields).filter_map(|field| board.seen(PeriodNumber(field)))).collect()
}

fn pictures(machine: &Machine, fields: u64) -> Vec<image::RgbImage> {
    seen(machine, fields).iter().map(ScannedField::picture).collect()
}

fn colours(picture: &image::RgbImage) -> usize {
    picture.pixels().map(|pixel| pixel.0).collect::<BTreeSet<_>>().len()
}

fn assert_same(experiment: &Experiment, saving: Optimization, fields: u64) {
    let with = after(experiment, fields);
    let without = after(&experiment.clone().without(saving), fields);
    assert_eq!(without.record().trace_hash(), with.record().trace_hash(), "{saving} in {experiment:?}");
    let seen = [&with, &without].map(|machine| pictures(machine, fields));
    assert!(seen[0] == seen[1], "{saving} in {experiment:?}");
    // The ring also counts messages that ended after its last event.
    let words = [with, without].map(|machine| machine.into_record().ring().stats().words);
    assert_eq!(words[0], words[1], "{saving} in {experiment:?}");
    // The first fields are empty.
    assert!(fields < 10 || seen[0].iter().any(|picture| colours(picture) > 2), "nothing was seen in {experiment:?}");
}

#[test]
fn the_trace_is_the_same_without_polls_of_idle_boards() {
    for experiment in experiments() {
        assert_same(&experiment.pixels(Pixels::Lazy), Optimization::IdleBoards, 3);
    }
}

#[test]
fn computing_the_end_of_transfers_in_closed_form_does_not_change_the_trace() {
    for experiment in experiments() {
        assert_same(&experiment.pixels(Pixels::Lazy), Optimization::Transfers, 10);
    }
}

#[test]
fn skipped_empty_regions_have_the_same_pixels_as_drawn_ones() {
    for experiment in experiments() {
        assert_same(&experiment.pixels(Pixels::All), Optimization::EmptyRegions, 10);
    }
}

#[test]
fn memoised_code_takes_the_simulated_clocks() {
    for experiment in experiments() {
        assert_same(&experiment.level(Level::Cycle).pixels(Pixels::Lazy), Optimization::RepeatedCode, 10);
    }
}

#[test]
fn computing_pixels_changes_no_time() {
    for experiment in experiments() {
        let [off, all] = [Pixels::Off, Pixels::All].map(|pixels| after(&experiment.clone().pixels(pixels), 10));
        assert_eq!(off.record().trace_hash(), all.record().trace_hash());
    }
}

/// All optimizations are disabled at once, also with code on the graphics processors.
#[test]
fn disabling_all_optimizations_at_once_does_not_change_the_trace() {
    let [_, slats, _] = experiments();
    let slats = slats.level(Level::Cycle).pixels(Pixels::All);
    let without = Optimization::ALL.into_iter().fold(slats.clone(), Experiment::without);
    assert_eq!(after(&without, 2).record().trace_hash(), after(&slats, 2).record().trace_hash());
}

/// Checks the tests themselves: a disabled optimization increases the number of events.
#[test]
fn a_disabled_optimization_costs_more_events() {
    let [_, slats, _] = experiments();
    let slats = slats.pixels(Pixels::Off);
    let with = after(&slats, 3).events();
    assert!(after(&slats.clone().without(Optimization::IdleBoards), 3).events() > 10 * with);
    assert!(after(&slats.clone().without(Optimization::Transfers), 3).events() > 10 * with);
}
