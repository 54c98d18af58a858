//! Tests of the closed form of Slats: times of structures and copies, and many machines at once.

use proptest::prelude::*;
use pxpl5_analytic::{FieldTimes, PerTriangle, SlatsModel};
use pxpl5_gp::GpTiming;
use pxpl5_machine::MachineConfig;
use pxpl5_run::Slats;

/// Time of a region (TR94), in nanoseconds.
const REGION_NS: f64 = 780_000.0;

/// Returns the times of a field of 30 triangles that cover ten regions.
fn field(program: Slats) -> FieldTimes {
    let model = SlatsModel::new(&MachineConfig::slats(), program).expect("in range");
    model.field(30.0, PerTriangle { entries: 10.0, clipped: 0.0 })
}

/// Both ports work at the same time, except for one region at each end. The change between renderers takes less than
/// 2 us in all.
#[test]
fn twenty_regions_over_two_ports_take_eleven_region_times() {
    let top = field(Slats::whole()).top;
    let found = top.end_ns - top.begin_ns - 11.0 * REGION_NS;
    assert!((0.0..2_000.0).contains(&found), "{found} ns more");
}

#[test]
fn ten_regions_take_five_region_times_when_both_ports_start_together() {
    let times = field(Slats::split());
    for copies in [times.top, times.bottom.expect("copies are split")] {
        let found = copies.end_ns - copies.begin_ns - 5.0 * REGION_NS;
        // The renderers of the two ports get their commands one message (38 word times) apart.
        assert!((0.0..2_000.0).contains(&found), "{found} ns more");
    }
}

/// Returns the model of Slats for a machine whose timing parameters are `numbers`.
fn model(gps: usize, renderers: usize, numbers: [u64; 5], split: bool) -> SlatsModel {
    let mut config = MachineConfig { n_gps: gps, n_renderers: renderers, ..MachineConfig::slats() };
    let [triangle_ns, message_ns, fifo_words, word_ns, hop_ns] = numbers;
    config.gp.triangle_ns = triangle_ns;
    config.gp.guard_ns = 3 * triangle_ns;
    config.gp.structure_ns = 5 * triangle_ns;
    config.gp.message_ns = message_ns;
    config.renderer.fifo_words = fifo_words;
    config.ring.word_ns = word_ns;
    config.ring.hop_ns = hop_ns;
    let program = if split { Slats::split() } else { Slats::whole() };
    SlatsModel::new(&config, program).expect("in range")
}

/// Tests the time that structures add to a field, as the difference between two timing tables.
///
/// The scene `mig` has six structures without spheres. The scene `molecules` has one structure with spheres. The
/// processor is the slowest part of both runs, so the difference is visible.
#[test]
fn the_time_of_a_structure_counts_for_both_eyes() {
    let rendered_ns = |scene: &str, gp: GpTiming| {
        let machine = MachineConfig { gp, ..MachineConfig::slats() };
        let model = SlatsModel::new(&machine, Slats::whole()).expect("in range");
        let scene = pxpl5_scene::builtin(scene).expect("built in");
        model.over(&scene).field(30.0, PerTriangle { entries: 10.0, clipped: 0.0 }).rendered_ns
    };
    let published = MachineConfig::slats().gp;
    let of_code = GpTiming { structure_ns: 90_000, sphere_view_ns: 7_000, ..published };
    let [structure, view] = [published.structure_ns, published.sphere_view_ns].map(|ns| ns as f64);
    let of_mig = 2.0 * 6.0 * (90_000.0 - structure);
    for (scene, expected_ns) in [("mig", of_mig), ("molecules", 2.0 * (97_000.0 - structure - view))] {
        let found_ns = rendered_ns(scene, of_code) - rendered_ns(scene, published);
        assert!((found_ns - expected_ns).abs() < 1e-3, "{scene}: {found_ns} ns");
    }
}

fn numbers() -> impl Strategy<Value = [u64; 5]> {
    (1_000u64..60_000, 0u64..90_000, 64u64..2_000, 10u64..200, 0u64..100)
        .prop_map(|(triangle, message, fifo, word, hop)| [triangle, message, fifo, word, hop])
}

proptest! {
    /// Tests that the model computes the same times, bit for bit, for many machines together and for each machine
    /// alone.
    #[test]
    fn machines_computed_together_give_the_same_results_as_machines_computed_one_by_one(
        gps in 1usize..5,
        renderers in 5usize..23,
        all in proptest::collection::vec(numbers(), 1..50),
        other in 0usize..40,
        split: bool,
        triangles in 1.0f64..400.0,
        entries in 1.0f64..12.0,
        clipped in 0.0f64..1.0,
    ) {
        let of = |(i, numbers): (usize, &[u64; 5])| model(gps, renderers, *numbers, split != (i == other));
        let models: Vec<SlatsModel> = all.iter().enumerate().map(of).collect();
        let each = PerTriangle { entries, clipped };
        let alone: Vec<FieldTimes> = models.iter().map(|model| model.field(triangles, each)).collect();
        prop_assert_eq!(SlatsModel::fields(&models, triangles, each), alone);
    }
}
