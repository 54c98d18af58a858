//! Tests of a head that turns in front of faces that need no drawing.

use super::{FULL, OBJECTS, after, assert_no_faults, head, machine, memory, texels};
use address_recalculation::CubeFace;
use pxpl5_run::{Experiment, FacePipeline, FacePolicy, Pixels};
use pxpl5_scene::builtin;
use tracking::motion::{Pan, Still};

/// With the eye at rest, a ball that is far enough away is drawn once, into the slowest memory. Memory 0 stays empty.
#[test]
fn with_an_empty_memory_0_every_retrace_counts_as_a_new_picture_of_a_rotating_head() {
    let scene = builtin("sphere:1000").expect("even");
    let experiment = Experiment::new(machine("small-hmd", &OBJECTS, &[]), OBJECTS, scene).fields(60);
    let outcome = experiment.pixels(Pixels::Off).head(head(Pan::at(200.0))).run().expect("it has shown something");
    assert_no_faults(outcome.record());
    let swaps: Vec<u64> = (0..4).map(|k| memory(outcome.record(), k).stats().swaps).collect();
    assert_eq!(swaps, [0, 0, 0, 1]);
    assert_eq!((outcome.shown(), outcome.updates_hz()), (1, None), "the update of memory 3, which alone has no rate");
    assert!(outcome.latency_ms().mean.is_nan());
    assert!(outcome.turned_periods() > 50);
    assert_eq!(outcome.rotation_latencies().len(), 60);
}

/// The host computes for 50 ms and then sends. The update before it must end first, and retraces come every 16.7 ms. An
/// update more or less in 10 s changes the mean by half a percent.
#[test]
fn an_application_on_the_host_delays_every_update_of_all_faces() {
    let period_ms = |application_ns: u64| {
        let scene = builtin("sphere:10").expect("even");
        let config = machine("small-hmd", &FULL, &[("host.application_ns", application_ns)]);
        let outcome = Experiment::new(config, FULL, scene).fields(600).pixels(Pixels::Off).run().expect("it is shown");
        1_000.0 / outcome.updates_hz().expect("several updates")
    };
    let (alone, delayed) = (period_ms(0), period_ms(50_000_000));
    assert!((49.7..50.0 + alone + 16.7).contains(&delayed), "{alone} {delayed}");
}

/// The scene has a rectangle that is attached to the head.
#[test]
fn objects_fixed_to_the_head_are_drawn_in_its_direction() {
    for policy in [FacePolicy::Full, FacePolicy::Objects, FacePolicy::Cells] {
        let pipeline = FacePipeline::new(policy);
        let run = |deg_per_s: f64| {
            let scene = builtin("full-screen:2").expect("built in");
            let config = machine("small-hmd", &pipeline, &[("arp.face_texels", 128)]);
            let pipeline = pipeline.clone();
            let head = if deg_per_s == 0.0 { head(Still(tracking::Pose::IDENTITY)) } else { head(Pan::at(deg_per_s)) };
            // The head turns for half a second at 180 deg/s.
            after(&Experiment::new(config, pipeline, scene).head(head), 30).into_record()
        };
        let drawn_on = |deg_per_s: f64| {
            let faces = memory(&run(deg_per_s), 0).shown_faces();
            CubeFace::ALL.map(|face| texels(128).filter(|t| t.face == face && faces.texel(*t).is_some()).count())
        };
        let still = drawn_on(0.0);
        let turned = drawn_on(180.0);
        let most = |counts: [usize; 6]| CubeFace::ALL[(0..6).max_by_key(|face| counts[*face]).expect("six")];
        assert_eq!(most(still), CubeFace::NegZ, "{policy:?}: {still:?}");
        assert_eq!(most(turned), CubeFace::NegX, "{policy:?}: {turned:?}");
    }
}

/// A display that latches by line or by pixel gets an orientation for each line, or as many as the host's connection
/// can carry per line. The tracker reports once per field.
#[test]
fn a_host_predicts_an_orientation_for_every_line_or_as_many_orientations_as_its_link_can_carry() {
    use address_recalculation::Latch;
    let fields = if std::env::var_os("PXPL5_ALL_CASES").is_some() { 60 } else { 30 };
    for (latch, expected) in [(Latch::Field, 1.0), (Latch::Line, 240.0), (Latch::Pixel, 8.0 * 240.0)] {
        let pipeline = FacePipeline { latch, ..FULL };
        let scene = builtin("sphere:10").expect("even");
        let experiment = Experiment::new(machine("small-hmd", &pipeline, &[]), pipeline, scene).fields(fields);
        let tracker = tracking::tracker::TrackerConfig::optical_ceiling();
        let kind = tracking::predict::PredictorKind::Kalman;
        let head = pxpl5_run::Head::new(std::sync::Arc::new(Pan::at(200.0)), tracker, kind, 1).expect("in range");
        let outcome = experiment.pixels(Pixels::Off).head(head).run().expect("it runs");
        let counters = outcome.record().display().counters();
        let loads = counters.iter().find(|counter| counter.name == "matrix loads").expect("counted").count;
        assert!((loads as f64 / fields as f64 - expected).abs() < 0.05 * expected.max(2.0), "{latch:?}: {loads}");
        let refused = counters.iter().find(|counter| counter.name == "matrices refused").expect("counted").count;
        assert_eq!(refused, 0);
        let tuned = outcome.head().expect("tracked").head();
        let ahead_ms =
            |training: Option<&tracking::predict::Training>| training.expect("tuned").interval_ps / 1_000_000_000;
        // For turns, pictures are predicted by the 33 ms of the tracker and up to one field. For positions, TRANSFORM,
        // RENDER, COPY and the waits for retraces are additional.
        assert!((33..=60).contains(&ahead_ms(tuned.training_of_turns())), "{:?}", tuned.training_of_turns());
        assert!(ahead_ms(tuned.training()) > ahead_ms(tuned.training_of_turns()));
    }
}
