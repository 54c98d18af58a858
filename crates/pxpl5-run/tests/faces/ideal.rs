//! Tests of an ideal renderer of faces: its faces equal the machine's to the last bit, and only the times differ.

use super::{FULL, after, assert_no_faults, cells, display, head, machine, memory, texels};
use address_recalculation::Latch;
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, FacePipeline, FacePolicy, FaceSource, Pipeline, Pixels};
use pxpl5_scene::builtin;
use pxpl5_wire::display::Display;
use tracking::motion::{Pan, Slide, Still};

const IDEAL: FacePipeline = {
    let mut ideal = FULL;
    ideal.source = FaceSource::Ideal;
    ideal
};

fn ideal(policy: FacePolicy) -> FacePipeline {
    FacePipeline { source: FaceSource::Ideal, ..FacePipeline::new(policy) }
}

/// Nothing moves in these scenes. With one slave, primitives come in the order of the display list. Ties are then
/// resolved as in the ideal renderer.
#[test]
fn the_machine_and_the_ideal_renderer_fill_memories_with_the_same_bits() {
    let one_slave = [("n_gps", 2), ("n_renderers", 1)];
    let packed = [one_slave[0], one_slave[1], ("arp.depth_bits", 16), ("arp.colour_bits", 16)];
    let runs =
        [("gallery", &one_slave[..]), ("sphere:1000", &one_slave), ("room", &one_slave), ("molecules", &one_slave)];
    for (name, numbers) in runs.into_iter().chain([("room", &packed[..])]) {
        let numbers = [numbers, &[("arp.face_texels", 128)]].concat();
        let run = |pipeline: FacePipeline, fields: u64| {
            let config = machine("small-hmd", &pipeline, &numbers);
            let still = head(Still(tracking::Pose::IDENTITY));
            after(&Experiment::new(config, pipeline, builtin(name).expect("built in")).head(still), fields)
                .into_record()
        };
        let [drawn, ideal] = [run(FULL, 400), run(IDEAL, 4)];
        [&drawn, &ideal].into_iter().for_each(assert_no_faults);
        assert!(memory(&drawn, 0).stats().swaps > 0, "{name}: the machine has drawn it");
        let [drawn, ideal] = [&drawn, &ideal].map(|record| memory(record, 0).shown_faces());
        let shown = texels(128).filter(|texel| drawn.texel(*texel).is_some()).count();
        let wrong: Vec<_> = texels(128).filter(|texel| drawn.texel(*texel) != ideal.texel(*texel)).collect();
        assert!(shown > 100 && wrong.is_empty(), "{name}: {} of {shown}, {:?}", wrong.len(), wrong.first());
    }
}

/// Every retrace shows the updates that were drawn an instant before, in the memories that the policy found due.
#[test]
fn an_update_is_shown_at_the_retrace_for_which_it_is_drawn() {
    for policy in [FacePolicy::Full, FacePolicy::Objects, FacePolicy::Cells, FacePolicy::CellsWarped] {
        let pipeline = ideal(policy);
        let config = machine("small-hmd", &pipeline, &[("arp.face_texels", 128)]);
        let experiment = Experiment::new(config, pipeline, builtin("gallery").expect("built in")).fields(60);
        let outcome = experiment.pixels(Pixels::Off).head(head(Slide::right_at(1.0))).run().expect("it runs");
        let record = outcome.record();
        assert_no_faults(record);
        let notes = outcome.requested_updates();
        let swaps = &record.observation().swaps;
        // Updates for the retrace at the end of the run are not shown any more.
        let shown: Vec<_> = notes.iter().filter(|note| note.due_at < outcome.end()).collect();
        assert!(shown.len() > 10 && swaps.len() >= shown.len() - 4, "{policy:?}: {} {}", shown.len(), swaps.len());
        for (note, swap) in shown.iter().zip(swaps) {
            assert_eq!(note.due_at.0 + 1, record.tick(swap.tick).0, "{policy:?}");
            assert_eq!(display(record).nodes()[note.memory], swap.port, "{policy:?}");
        }
        let missed: u64 =
            (0..4).filter_map(|k| Some(display(record).memories(pxpl5_wire::Eye::Left).get(k)?.stats().missed)).sum();
        assert_eq!(missed, 0, "{policy:?}");
        if policy == FacePolicy::Full {
            let hz = outcome.updates_hz().expect("there were updates");
            assert!((hz - 60.0 / 1.001).abs() < 1e-3, "{hz}");
            assert!(outcome.latency_ms().max <= 1e-9, "{:?}", outcome.latency_ms());
        }
    }
}

#[test]
fn the_rotation_latency_is_the_same_with_ideal_faces_and_with_faces_drawn_by_the_machine() {
    for latch in [Latch::Field, Latch::Line, Latch::Pixel] {
        let turns = [FULL, IDEAL].map(|pipeline| {
            let pipeline = FacePipeline { latch, ..pipeline };
            let config = machine("small-hmd", &pipeline, &[("arp.face_texels", 128)]);
            let experiment = Experiment::new(config, pipeline, builtin("sphere:100").expect("even")).fields(30);
            let outcome = experiment.pixels(Pixels::Off).head(head(Pan::at(200.0))).run().expect("it runs");
            outcome.rotation_latencies()[2..].to_vec()
        });
        assert_eq!(turns[0], turns[1], "{latch:?}");
    }
}

fn texels_of(config: &MachineConfig) -> String {
    let settings = config.settings();
    settings.iter().find(|(path, _)| path == "arp.face_texels").expect("a number of the display").1.to_string()
}

#[test]
fn faces_have_512_texels_by_default_on_a_machine_of_any_size() {
    let config = IDEAL.adapt(MachineConfig::preset("small-hmd").expect("listed"));
    assert_eq!(texels_of(&config), "512");
    assert_eq!(texels_of(&machine("small-hmd", &IDEAL, &[("arp.face_texels", 256)])), "256");
    assert_eq!(texels_of(&IDEAL.adapt(machine("small-hmd", &cells::CELLS, &[]))), "256");
}
