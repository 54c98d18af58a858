//! Tests of six faces that Pixel-Planes 5 draws for a display that follows the head's rotation: times, rates and
//! correctness.

mod cells;
mod code;
mod ideal;
mod turning;

use address_recalculation::{AddressRecalculationPipeline, CubeFace, DisplayMemory, FaceSet, TexelAddress};
use glam::{DVec3, Mat4, Vec3};
use pphigs::oracle::ideal_picture;
use pphigs::{DisplayList, EyeView, FrameView, Picture, RegionBinning, Shading};
use pxpl5_geometry::Viewport;
use pxpl5_gp::Stage;
use pxpl5_machine::{Machine, MachineConfig, Record};
use pxpl5_renderer::Layout;
use pxpl5_run::{
    Experiment, ExperimentError, FacePipeline, FacePolicy, Head, Outcome, Pipeline, Pixels, Registry, RenderingControl,
    display_list,
};
use pxpl5_scene::{HeadMotion, Scene, SceneParts, Sphere, Structure, builtin};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Eye, Lines, PeriodNumber, RegionGrid};
use rayon::prelude::*;
use rendering_control::cube::face_view;
use std::sync::Arc;
use tracking::motion::{Motion, Pan, Slide};
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;

const FULL: FacePipeline = FacePipeline::new(FacePolicy::Full);
const OBJECTS: FacePipeline = FacePipeline::new(FacePolicy::Objects);

/// Returns a machine with changed parameters. The policies have a threshold of 90/512 degrees and cells of 5 m. The
/// expected values of these tests depend on both.
fn machine(preset: &str, pipeline: &FacePipeline, numbers: &[(&str, u64)]) -> MachineConfig {
    let preset = MachineConfig::preset(preset).expect("listed");
    let mut config = pipeline.adapt(Registry::of_papers().machine_of(preset));
    for (path, value) in [("priority.theta_deg", 90.0 / 512.0), ("priority.cell_m", 5.0)] {
        config.set(path, value).expect("a number of the policy");
    }
    // The tests compute distances for one inner ring, and for rings that double.
    for (path, value) in [("priority.inner_rings", 1), ("priority.ring_growth", 2)].iter().chain(numbers) {
        config.set(path, *value).expect("a number of the machine");
    }
    config
}

fn head(motion: impl Motion + Send + Sync + 'static) -> Head {
    Head::new(Arc::new(motion), TrackerConfig::ideal(), PredictorKind::None, 1).expect("in range")
}

fn display(record: &Record) -> &AddressRecalculationPipeline {
    record.display_of_kind().expect("the display arp")
}

fn memory(record: &Record, k: usize) -> &DisplayMemory {
    &display(record).memories(Eye::Left)[k]
}

fn assert_no_faults(record: &Record) {
    assert_eq!(record.display().faults(), (0, None));
}

/// Experiment E1: the latency of rotation does not depend on the number of triangles in a ball.
#[test]
fn the_rotation_latency_does_not_depend_on_the_number_of_triangles() {
    let run = |pipeline: FacePipeline, n: usize| {
        let scene = builtin(&format!("sphere:{n}")).expect("even");
        let config = machine("small-hmd", &pipeline, &[]);
        let fields = if n > 10_000 { 240 } else { 60 };
        let experiment = Experiment::new(config, pipeline, scene).fields(fields).pixels(Pixels::Off);
        experiment.head(head(Pan::at(200.0))).run().expect("it runs")
    };
    let outcomes = [10, 100, 1_000, 100_000].map(|n| run(FULL, n));
    // Four memories need a comparator of two more stages than one memory. The policy `cells` does not affect rotation
    // otherwise.
    let of_cells = [10, 100_000].map(|n| run(cells::CELLS, n));
    for (latency, of_cells) in outcomes[0].rotation_latencies()[..55].iter().zip(of_cells[0].rotation_latencies()) {
        assert_eq!(of_cells.pipeline, latency.pipeline + Span(50_000));
        assert_eq!(of_cells.scan, latency.scan);
    }
    assert_eq!(of_cells[0].rotation_latencies()[..55], of_cells[1].rotation_latencies()[..55]);
    let turns = outcomes.each_ref().map(|outcome| outcome.rotation_latencies()[..55].to_vec());
    assert!(turns[1..].iter().all(|other| *other == turns[0]));
    for latency in &turns[0] {
        // The host sends nine words at 5 MB/s. The display has 8 + 16 stages of 25 ns, because one memory needs no
        // comparator. From the field's first pixel to its middle there are 132 whole lines of 780 pixels of 11/135 us.
        assert_eq!((latency.host, latency.pipeline), (Span(7_200_000), Span(600_000)));
        let parts: u64 = latency.parts().iter().map(|(_, span)| span.0).sum();
        assert_eq!(latency.total(), Span(parts));
        let to_the_middle = (120.0 * 780.0 + 320.0) * 11e6 / 135.0;
        assert!((latency.scan.0 as f64 - to_the_middle).abs() <= 1.0, "{latency:?}");
    }
    let translation = outcomes.each_ref().map(|outcome| outcome.latency_ms().mean);
    // Small balls wait for retraces only. The large ball waits for its TRANSFORM.
    assert!(translation[..3].iter().all(|small| translation[3] > 4.0 * small), "{translation:?}");
    outcomes.iter().for_each(|outcome| assert_no_faults(outcome.record()));
}

/// Returns the times of COPY of every update whose 6 (N/128)^2 regions all have primitives.
fn copies(texels: u64, packed: bool) -> (Vec<Span>, u64) {
    let bits = if packed { 16 } else { 24 };
    let numbers = [("arp.face_texels", texels), ("arp.depth_bits", bits), ("arp.colour_bits", bits)];
    let config = machine("design-maximum", &FULL, &numbers);
    let experiment = Experiment::new(config, FULL, builtin("room").expect("built in")).fields(90).pixels(Pixels::Off);
    let outcome = experiment.run().expect("it runs");
    assert_no_faults(outcome.record());
    let stages = outcome.stages();
    let spans = stages.iter().filter(|span| span.stage == Stage::Copy).filter_map(|span| Some(span.end? - span.begin));
    let regions = memory(outcome.record(), 0).stats().regions;
    (spans.collect(), regions / stages.iter().filter(|span| span.stage == Stage::Copy).count() as u64)
}

/// The expected time of the ports: 32 messages of 1,024 words, 50 ns a word and 0.8 us a message.
#[test]
fn copying_all_regions_takes_only_the_time_of_the_ports() {
    let message_ns = 1_024 * 50 + 800;
    for (texels, packed, messages, published_ms) in
        [(128, false, 32, 9.98), (256, false, 32, 39.94), (512, false, 32, 159.7), (256, true, 16, 39.94 / 2.0)]
    {
        let regions = 6 * (texels / 128) * (texels / 128);
        let port_ms = (regions * messages * message_ns) as f64 * 1e-6;
        assert!((port_ms - published_ms).abs() < 0.05, "{port_ms} {published_ms}");
        let (copies, of_each) = copies(texels, packed);
        assert!(of_each.abs_diff(regions) <= 1, "{of_each} regions of {regions}");
        let fastest = copies.iter().map(|span| span.as_ms()).fold(f64::INFINITY, f64::min);
        // From the first to the last region of an update, the port is always busy, except for a wait before the last
        // region.
        assert!(copies.iter().skip(1).all(|span| span.as_ms() >= 0.999 * port_ms || texels == 512), "{copies:?}");
        assert!(fastest >= 0.5 * port_ms && fastest <= 1.05 * port_ms, "{texels}: {fastest} {port_ms}");
    }
}

/// Balls of 1 m radius ahead, whose nearest points are 2, 13, 27 and 46 m away. For a viewer who walks past at 1 m/s,
/// the borders of the memories are 10.87, 21.73 and 43.46 m. The balls are therefore objects of memories 0 to 3.
fn balls() -> Scene {
    let places = [3.0, 14.0, 28.0, 47.0];
    let ball = |z: f32| Sphere { centre: Vec3::new(0.0, 0.0, -z), radius: 1.0, colour: [200, 120, 40] };
    let structure = |i: usize| Structure {
        name: format!("ball {i}"),
        vertices: 0..0,
        triangles: 0..0,
        spheres: i..i + 1,
        frame: pxpl5_scene::Frame::World,
        hinge: None,
        culls_back_faces: false,
    };
    let motion = *builtin("room").expect("built in").motion();
    let parts = SceneParts {
        spheres: places.map(ball).to_vec(),
        structures: (0..4).map(structure).collect(),
        motion,
        ..SceneParts::of("balls", Vec::new(), Vec::new())
    };
    Scene::new(parts).expect("in range")
}

/// Runs a walk at 1 m/s past the balls, with renderers whose clock runs at a fraction of 40 MHz.
fn walk(pipeline: FacePipeline, clock_hz: u64) -> Outcome {
    let numbers = [("arp.face_texels", 128), ("renderer.clock_hz", clock_hz)];
    let experiment = Experiment::new(machine("small-hmd", &pipeline, &numbers), pipeline, balls());
    experiment.fields(240).pixels(Pixels::Off).head(head(Slide::right_at(1.0))).run().expect("it runs")
}

/// Returns, for each memory, the share of retraces that its updates missed, among all shown and missed ones.
fn missed(outcome: &Outcome) -> [f64; 4] {
    std::array::from_fn(|k| {
        let stats = memory(outcome.record(), k).stats();
        stats.missed as f64 / (stats.missed + stats.swaps) as f64
    })
}

/// Experiment E8: if renderers are too slow, the memories that are drawn least often are the first to miss their
/// retraces. Rotation keeps its latency.
#[test]
fn with_slow_renderers_slow_memories_miss_first_and_rotation_keeps_its_latency() {
    let outcomes = [40_000_000, 2_000_000, 1_000_000, 500_000].map(|clock_hz| walk(OBJECTS, clock_hz));
    let misses = outcomes.each_ref().map(missed);
    for outcome in &outcomes {
        assert_no_faults(outcome.record());
        assert_eq!(outcome.rotation_latencies(), outcomes[0].rotation_latencies());
    }
    assert_eq!(misses[0], [0.0; 4], "a machine that is fast enough misses nothing");
    // While the slowest memories miss up to half of their retraces, a slower memory always misses more retraces. With
    // even slower renderers, memory 0 still misses the fewest.
    assert!(misses[..3].iter().all(|missed| missed.is_sorted()) && misses[2][2] > 5.0 * misses[2][1], "{misses:?}");
    assert!(misses[3][1..].iter().all(|missed| *missed > 2.0 * misses[3][0]), "{misses:?}");
    assert!(misses.iter().any(|missed| missed[3] > 0.2 && missed[0] < missed[3] / 2.0), "{misses:?}");
}

#[test]
fn objects_belong_to_the_slowest_memory_that_keeps_them_correct() {
    let outcome = walk(OBJECTS, 40_000_000);
    let notes = outcome.requested_updates();
    let held = |k: usize| notes.iter().rfind(|note| note.memory == k).map(|note| note.structures.to_vec());
    for k in 0..4 {
        let expected: Vec<bool> = (0..4).map(|structure| structure == k).collect();
        assert_eq!(held(k), Some(expected), "memory {k}");
    }
    let updates: Vec<usize> = (0..4).map(|k| notes.iter().filter(|note| note.memory == k).count()).collect();
    assert!(updates.windows(2).all(|pair| pair[0] > pair[1]), "{updates:?}");
}

fn after(experiment: &Experiment, fields: u64) -> Machine {
    let mut machine = experiment.build().expect("valid");
    let end = machine.record().tick(PeriodNumber(fields));
    machine.run_until(end).expect("it runs");
    machine.finish_pixels();
    machine
}

fn ball() -> Experiment {
    let config = machine("small-hmd", &FULL, &[("arp.face_texels", 128)]);
    Experiment::new(config, FULL, builtin("sphere:1000").expect("even"))
}

#[test]
fn optimizations_and_pixels_change_no_time_and_no_texel() {
    let lazy = after(&ball(), 16);
    let faces = memory(lazy.record(), 0).shown_faces();
    assert!(texels(128).filter(|texel| faces.texel(*texel).is_some()).count() > 50, "something was drawn");
    let all = after(&ball().pixels(Pixels::All), 16);
    assert!(memory(all.record(), 0).shown_faces() == faces);
    let off = after(&ball().pixels(Pixels::Off), 16);
    let hash = lazy.record().trace_hash();
    pxpl5_machine::Optimization::ALL.into_par_iter().for_each(|optimization| {
        let without = after(&ball().without(optimization), 16);
        assert_eq!(without.record().trace_hash(), hash, "{optimization}");
        assert!(memory(without.record(), 0).shown_faces() == faces, "{optimization}");
    });
    for other in [all, off] {
        assert_eq!(other.record().trace_hash(), hash);
    }
}

fn texels(size: u32) -> impl Iterator<Item = TexelAddress> {
    CubeFace::ALL.into_iter().flat_map(move |face| {
        (0..size).flat_map(move |row| (0..size).map(move |column| TexelAddress { face, column, row }))
    })
}

/// Compares a face of the machine with the ideal picture of the same view. Returns the number of texels that are not
/// empty.
fn compare_face(scene: &Scene, eye: DVec3, time: Time, faces: &FaceSet, face: CubeFace) -> usize {
    let size = faces.texels();
    let grid = RegionGrid { width: size, height: size, region_width: 128, region_height: 128 };
    let viewport = Viewport::new(grid, Lines::Frame).expect("a face");
    let layout = Layout::rendering_control_phong();
    let picture = Picture { viewport, shading: Shading::Phong, binning: RegionBinning::Touched, layout, pixels: true };
    // The faces have one guard texel on each side, and the near and far plane of the head-mounted display.
    let half_angle = (f64::from(size) / f64::from(size - 2)).atan();
    let projection = glam::DMat4::perspective_rh(2.0 * half_angle, 1.0, 0.05, 50.0).as_mat4();
    let place = Mat4::from_translation(-eye.as_vec3());
    let ahead = EyeView { world_to_eye: place, head_to_eye: Mat4::IDENTITY, projection };
    let edits = scene.edits_at(time.0);
    let edits = edits.iter().map(|edit| pphigs::ModelEdit { structure: edit.structure as u32, model: edit.model });
    let view =
        FrameView { number: pxpl5_wire::ViewNumber(0), eyes: vec![face_view(&ahead, face)], edits: edits.collect() };
    let list = DisplayList { is_matte: true, ..display_list(scene).expect("something to draw") };
    let ideal = ideal_picture(&list, &view, 0, &picture);
    let [red, green, blue] = list.background;
    let background = u32::from_be_bytes([0, red, green, blue]);
    let drawn = image::RgbImage::from_fn(size, size, |column, row| {
        let colour = faces.texel(TexelAddress { face, column, row }).map_or(background, |(colour, _)| colour);
        let [_, red, green, blue] = colour.to_be_bytes();
        image::Rgb([red, green, blue])
    });
    let wrong = ideal.differences(&drawn);
    let shown = texels(size).filter(|texel| texel.face == face && faces.texel(*texel).is_some()).count();
    // Projections that were rounded differently move an edge by less than a subpixel.
    assert!(
        wrong.len() * 500 <= shown,
        "{face:?}: {} of {shown} texels differ, first {:?}",
        wrong.len(),
        wrong.first()
    );
    shown
}

/// Every displayed face must equal a redraw from the position for which the face was drawn.
#[test]
fn the_faces_drawn_by_the_machine_equal_the_faces_of_an_ideal_renderer() {
    for (name, faces_with_something) in [("mig", 1), ("room", 6)] {
        let scene = builtin(name).expect("built in");
        let config = machine("small-hmd", &FULL, &[]);
        let outcome = Experiment::new(config, FULL, scene.clone()).fields(40).run().expect("it runs");
        assert_no_faults(outcome.record());
        let shown = outcome.pictures().last().expect("a picture");
        let sampled = shown.sampled_at.expect("it was sent");
        let motion: HeadMotion = scene.motion().with_seed(1);
        let eye = motion.pose(sampled.0).position;
        let faces = memory(outcome.record(), 0).shown_faces();
        let drawn = CubeFace::ALL.map(|face| compare_face(&scene, eye, sampled, &faces, face));
        assert!(drawn.iter().filter(|texels| **texels > 100).count() >= faces_with_something, "{name}: {drawn:?}");
    }
}

#[test]
fn a_display_of_faces_needs_a_pipeline_that_draws_them() {
    let config = machine("small-hmd", &FULL, &[]);
    let error = Experiment::new(config, RenderingControl::mono(), balls()).run().expect_err("no faces");
    let ExperimentError::Config(error) = error else { panic!("{error}") };
    let text = error.to_string();
    assert!(text.contains("display arp") && text.contains("arp-full") && text.contains("rendering-control"), "{text}");
}
