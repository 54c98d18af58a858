//! Consistency of a report's numbers: a quantity has the same value in every place.

use crate::support::experiment;
use glam::DQuat;
use image::{Rgb, RgbImage};
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{
    CriticalPath, LatencyCurve, Measure, Measured, QUANTITIES, Results, TooHeavy, Utilisation, side_by_side,
};
use pxpl5_run::{
    DuePictures, Estimates, Experiment, FacePipeline, FacePolicy, FaceSource, Head, Outcome, Pipeline, Pixels, Slats,
};
use pxpl5_scene::builtin;
use pxpl5_wire::PeriodNumber;
use std::sync::Arc;
use tracking::Pose;
use tracking::motion::{Pan, from_fn};
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;

const FIELD_HZ: f64 = 60_000.0 / 1_001.0;

fn head() -> Head {
    Head::new(Arc::new(Pan::at(20.0)), TrackerConfig::ideal(), PredictorKind::ConstantVelocity, 1).expect("in range")
}

fn run(pipeline: &str, scene: &str, fields: u64) -> Outcome {
    experiment(pipeline, scene).head(head()).fields(fields).run().expect("it runs")
}

fn value(results: &Results, name: &str) -> Option<f64> {
    Measure::named(name).expect("a quantity").of(results)
}

/// A running machine has the same utilisation and critical path at its end as the report of the finished run.
#[test]
fn at_the_end_of_a_run_the_partial_shares_equal_the_shares_in_the_report() {
    for pipeline in ["rendering-control", "slats"] {
        let mut stepper = experiment(pipeline, "sphere:10").fields(60).stepper().expect("it fits");
        assert_eq!(Utilisation::so_far(&stepper), None, "no time has passed");
        assert_eq!(CriticalPath::so_far(&stepper), None, "no picture was shown");
        stepper.run_to(stepper.end());
        let utilisation = Utilisation::so_far(&stepper).expect("time has passed");
        let path = CriticalPath::so_far(&stepper).expect("pictures were shown");
        let report = stepper.finish().expect("it runs").report();
        assert_eq!(Some(utilisation), report.utilisation);
        let of_report = report.critical_path.expect("pictures were shown");
        assert_eq!(path.limited_by, of_report.limited_by);
        assert!((path.parts.iter().map(|part| part.share).sum::<f64>() - 1.0).abs() < 1e-9);
    }
}

#[test]
fn every_quantity_equals_the_number_of_that_name_in_the_report() {
    let results = Results::of_run(run("rendering-control", "sphere:10", 60));
    let (_, report) = results.run.as_ref().expect("a run");
    let due = report.due.expect("pictures are due");
    let head = report.head.as_ref().expect("a head");
    let counted = [
        ("pictures_due", due.due),
        ("pictures_shown", due.shown),
        ("pictures_late", due.late),
        ("pictures_incomplete", due.incomplete),
        ("pictures_missed", due.missed),
        ("missed_retraces", due.due - due.shown),
        ("late_regions", report.late_regions as u64),
        ("pictures", report.pictures as u64),
        ("events", report.events),
        ("error_px.n", head.error.evaluated),
    ];
    for (name, expected) in counted {
        assert_eq!(value(&results, name), Some(expected as f64), "{name}");
    }
    // Both eyes are shown in the same pictures, so the mean over both is the mean of their means.
    let to_swap = report.latency_by_eye_ms.iter().filter(|latency| latency.until == "swap" && latency.of != "pair");
    let of_eyes: Vec<f64> = to_swap.map(|latency| latency.statistics.statistics.mean).collect();
    assert_eq!(of_eyes.len(), 2);
    let measured = [
        ("tracking_and_rendering_ms", head.end_to_end.tracking_ms + (of_eyes[0] + of_eyes[1]) / 2.0),
        ("latency_ms.mean", report.latency_ms.statistics.mean),
        ("latency_ms.sd", report.latency_ms.statistics.sd),
        ("latency_ms.min", report.latency_ms.statistics.min),
        ("latency_ms.max", report.latency_ms.statistics.max),
        ("latency_fields.mean", report.latency_ms.statistics.mean * FIELD_HZ * 1e-3),
        ("missed_share", (due.due - due.shown) as f64 / due.due as f64),
        ("head_to_light_ms.mean", head.end_to_end.total_ms),
        ("error_px.mean", head.error.pixels.mean),
        ("error_px.p50", head.error.pixels.p50),
        ("error_px.p90", head.error.pixels.p90),
        ("error_px.p99", head.error.pixels.p99),
        ("error_px.max", head.error.pixels.max),
        ("error_deg.mean", head.error.degrees.mean),
        ("updates_hz", report.updates_hz.expect("pictures were shown")),
    ];
    for (name, expected) in measured {
        let found = value(&results, name).expect(name);
        assert!((found - expected).abs() < 1e-9, "{name}: {found} for {expected}");
    }
    assert!(due.shown > 0 && report.pictures > 0 && report.events > 0);
}

/// An eye's picture passes TRANSFORM, RENDER and COPY in this order. The first two are different work and take
/// different times.
#[test]
fn parts_of_a_picture_add_up() {
    let results = Results::of_run(run("rendering-control", "sphere:10", 60));
    let of = |name: &str| value(&results, name).expect(name);
    assert!((of("copies_ms") - of("first_copy_ms") - of("last_copy_ms")).abs() < 1e-9);
    assert!(of("first_copy_ms") > 0.0 && of("last_copy_ms") > 0.0);
    assert!((of("transform_ms") - of("render_ms")).abs() > 1e-6);
    let stages = of("transform_ms") + of("render_ms");
    assert!(of("transform_ms") > 0.0 && of("render_ms") > 0.0 && stages < of("eye_ms"), "{stages} {}", of("eye_ms"));
}

#[test]
fn missing_results_are_null() {
    let results = Results::of_run(run("slats", "sphere:10", 60));
    for name in ["eye_ms", "eye_latency_ms.mean", "rotation_ms"] {
        assert_eq!(value(&results, name), None, "{name}");
    }
    let closed_form = Results::of_closed_form(results.summary.clone());
    assert_eq!(value(&closed_form, "events"), None);
    assert_eq!(value(&closed_form, "latency_ms.mean"), value(&results, "latency_ms.mean"));
}

#[test]
fn a_quantity_is_found_by_its_full_name_and_a_wrong_name_gives_the_nearest() {
    for quantity in &QUANTITIES {
        let measure = Measure::named(quantity.name).expect("listed");
        assert_eq!((measure.name(), measure.definition()), (quantity.name, quantity.definition));
    }
    let error = Measure::named("latency_ms.meen").expect_err("no quantity");
    assert_eq!(error.to_string(), "there is no quantity `latency_ms.meen`; did you mean `latency_ms.mean`?");
    assert_ne!(Measure::named("events"), Measure::named("pictures"));
    assert_eq!(Measure::named("events"), Measure::named("events"));
    let usual: Vec<&str> = Measure::usual().iter().map(Measure::name).collect();
    let latency = |unit: &str| ["mean", "sd", "min", "max"].map(|of| format!("latency_{unit}.{of}"));
    let expected = [latency("fields").to_vec(), latency("ms").to_vec()].concat();
    assert_eq!(usual[..8], expected);
    assert_eq!(usual[8..], ["updates_hz", "missed_retraces"]);
}

/// The report states the number of primitives that would be in time. It does so only if a formula exists and the number
/// is smaller than the scene.
#[test]
fn a_size_that_fits_is_named_only_if_it_is_smaller_than_the_scene() {
    fn all(experiment: &Experiment) -> u64 {
        experiment.scene().primitives() as u64
    }
    let by = |primitives_in_time| Estimates { fields_needed: |_| None, primitives_in_time };
    let scene = Arc::new(builtin("molecules").expect("built in"));
    assert!(!scene.triangles().is_empty() && !scene.spheres().is_empty(), "of both kinds");
    let experiment = Experiment::with(MachineConfig::slats(), Arc::new(Slats::split()), scene);
    let n = all(&experiment);
    let fewer = format!("(triangles = {})", n - 1);
    let cases = [
        (by(|_| Some(0)), Some(0), "not even one"),
        (by(|experiment| Some(all(experiment) - 1)), Some(n - 1), fewer.as_str()),
        (by(|experiment| Some(all(experiment))), None, "`limit`"),
        (by(|experiment| Some(all(experiment) + 1)), None, "`limit`"),
        (by(|_| None), None, "`limit`"),
    ];
    let (first_period, last_period) = (PeriodNumber(4), PeriodNumber(11));
    let due = DuePictures {
        first_period,
        last_period,
        periods_a_picture: 1,
        due: 8,
        shown: 5,
        late: 1,
        incomplete: 2,
        missed: 0,
        pictures: 5,
    };
    for (estimates, expected, advice) in cases {
        let mut experiment = experiment.clone();
        experiment.estimates = Some(estimates);
        let heavy = TooHeavy::of(&experiment, &due).expect("late ones");
        assert_eq!([heavy.pictures_due, heavy.missed_retraces, heavy.primitives], [8, 3, n]);
        assert!(heavy.primitives_in_time == expected && heavy.advice.contains(advice), "{heavy}");
        let begin = format!("TOO HEAVY: with {n} primitives 3 of 8 pictures due were not shown in time; ");
        assert!(heavy.to_string().starts_with(&begin), "{heavy}");
        assert_eq!(TooHeavy::of(&experiment, &DuePictures { shown: 8, late: 0, incomplete: 0, ..due }), None);
    }
}

#[test]
fn the_hash_of_a_report_covers_events_and_settings() {
    let outcome = run("slats", "sphere:10", 40);
    let report = outcome.report();
    assert!(report.trace_hash.len() == 16 && report.trace_hash.chars().all(|digit| digit.is_ascii_hexdigit()));
    assert_eq!(report.trace_hash, run("slats", "sphere:10", 40).report().trace_hash);
    assert_ne!(report.trace_hash, outcome.record().trace_hash().to_string());
}

/// A distant sphere is drawn once, into the slowest memory. One update has no rate, regardless of the length of the
/// run.
#[test]
fn a_single_update_has_no_rate() {
    for fields in [60, 200] {
        let motion = Arc::new(tracking::motion::Still(Pose::IDENTITY));
        let still = Head::new(motion, TrackerConfig::ideal(), PredictorKind::None, 1).expect("in range");
        let run = experiment("arp-priority", "sphere:1000").fields(fields).head(still).run();
        let report = run.expect("it shows something").report();
        let memories = report.arp.expect("faces").memories;
        let updates: Vec<u64> = memories.iter().map(|memory| memory.updates).collect();
        assert_eq!((updates, report.shown), (vec![0, 0, 0, 1], 1), "{fields}");
        assert_eq!(report.updates_hz, None, "{fields}");
        let rates = memories.iter().map(|memory| (memory.updates_hz, memory.period_frames));
        assert!(rates.eq([(None, None); 4]), "{fields}: {memories:?}");
    }
}

/// The display has faces of 512 texels, 24 bits of colour and of depth, and one memory, so it has 24 stages of 25 ns.
#[test]
fn a_display_with_faces_is_reported_with_its_memory() {
    let pipeline = FacePipeline { source: FaceSource::Ideal, ..FacePipeline::new(FacePolicy::Full) };
    let config = pipeline.adapt(MachineConfig::small_hmd());
    let scene = builtin("sphere:100").expect("even");
    let experiment = Experiment::new(config, pipeline, scene).fields(40).head(head()).pixels(Pixels::Off);
    let report = experiment.run().expect("it runs").report();
    let faces = report.arp.expect("faces");
    assert_eq!((faces.face_texels, faces.pipeline_ns.round()), (512, 600.0));
    let counted = |name: &str| report.display_counters.iter().find(|counter| counter.name == name).map(|c| c.count);
    assert_eq!(Some(faces.matrix_loads), counted("matrix loads"));
    assert_eq!(Some(faces.matrix_refused), counted("matrices refused"));
    assert!(faces.matrix_loads >= 39, "{}", faces.matrix_loads);
    let [memory] = &faces.memories[..] else { panic!("{faces:?}") };
    assert_eq!(memory.bytes, 2 * 6 * 512 * 512 * 6);
    let (period, hz) = memory.period_frames.zip(memory.updates_hz).expect("updates were shown");
    assert!((hz * period - FIELD_HZ).abs() < 1e-6, "{memory:?}");
    assert_eq!((memory.segments, memory.missed), (1, 0));
    let whole = faces.rotation_latency_ms.expect("a head").mean;
    let parts: f64 = faces.rotation_latency_parts_ms.iter().map(|part| part.statistics.mean).sum();
    assert!(whole > 0.0 && (whole - parts).abs() < 1e-9, "{whole} {parts}");
    // The ideal renderer draws before each retrace. Up to this retrace, translation has the same latency, so a step is
    // older by at most a field.
    let step = memory.translation_latency_ms.expect("updates were shown").mean;
    let parts: f64 = memory.translation_latency_parts_ms.iter().map(|(_, mean)| mean).sum();
    assert!(
        (step - parts).abs() < 1e-9 && step > 0.0 && step < whole + 1e3 / FIELD_HZ + 1e-6,
        "{step} {parts} {whole}"
    );
}

/// The first point shows the pose of the start. Each field until the end has one point.
#[test]
fn a_latency_curve_has_a_point_for_each_field_from_the_first_picture() {
    let curve = LatencyCurve::of(&Pan::at(40.0), 90, 2, 3.0);
    let times: Vec<f64> = curve.points.iter().map(|point| point.0).collect();
    assert_eq!((curve.latency_ms, times.len() as f64), (90, ((2.0 - 0.09) * FIELD_HZ).ceil()));
    for (n, time) in times.iter().enumerate() {
        assert!((time - 0.09 - n as f64 / FIELD_HZ).abs() < 1e-9, "{n}: {time}");
    }
    assert_eq!(LatencyCurve::of(&Pan::at(40.0), 3_000, 2, 3.0).mean_px(), 0.0);
    assert!(LatencyCurve::of(&Pan::at(40.0), 2_000, 2, 3.0).points.is_empty());
}

#[test]
fn the_picture_moves_for_the_latency_after_the_head_has_stopped() {
    // The head rotates for one second and then stops.
    let stopping = from_fn(|seconds| Pose::facing(DQuat::from_rotation_y(0.5 * seconds.min(1.0))));
    let curve = LatencyCurve::of(&stopping, 90, 2, 3.0);
    for (time, pixels) in &curve.points {
        assert_eq!(*pixels > 1e-6, *time < 1.0 + 0.09, "{time}: {pixels}");
    }
}

#[test]
fn pictures_are_joined_side_by_side_on_black() {
    let left = RgbImage::from_pixel(2, 3, Rgb([1, 2, 3]));
    let right = RgbImage::from_pixel(4, 1, Rgb([4, 5, 6]));
    let both = side_by_side(&left, &right);
    assert_eq!(both.dimensions(), (6, 3));
    for (x, y, pixel) in both.enumerate_pixels() {
        let expected = if x < 2 {
            [1, 2, 3]
        } else if y < 1 {
            [4, 5, 6]
        } else {
            [0; 3]
        };
        assert_eq!(pixel.0, expected, "{x} {y}");
    }
}
