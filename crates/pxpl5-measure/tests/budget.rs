//! Stages of the latency from pose to light, and causes of the error.

use glam::DVec3;
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{Budget, ErrorCauses, Measured, Percentiles, PixelErrors, Showing};
use pxpl5_run::{
    Cause, Experiment, Frameless, Head, Jitp, Outcome, Pipeline, Pixels, RenderingControl, Slats, Viewpoint,
};
use pxpl5_scene::builtin;
use pxpl5_wire::PeriodNumber;
use std::sync::Arc;
use tracking::motion::{Motion, Slide, Still, Synthetic};
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;
use tracking::{Pose, time::PS_PER_MS};

fn experiment(pipeline: &Arc<dyn Pipeline>, scene: &str, fields: u64) -> Experiment {
    let scene = Arc::new(builtin(scene).expect("built in"));
    let experiment = Experiment::with(MachineConfig::small_hmd(), Arc::clone(pipeline), scene).fields(fields);
    experiment.pixels(Pixels::Off)
}

fn run(pipeline: &Arc<dyn Pipeline>, head: Option<Head>, fields: u64) -> Outcome {
    head.into_iter().fold(experiment(pipeline, "sphere:10", fields), Experiment::head).run().expect("it runs")
}

fn head(motion: impl Motion + Send + Sync + 'static, tracker: TrackerConfig, kind: PredictorKind) -> Head {
    Head::new(Arc::new(motion), tracker, kind, 1).expect("in range")
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn assert_near(found: f64, expected: f64, what: &str) {
    assert!((found - expected).abs() < 1e-6, "{what}: {found} {expected}");
}

/// Stages inside a pipeline must equal the stages of its pictures. All other stages have formulas.
#[test]
fn stages_from_head_to_light_add_up() {
    let pipelines = [
        Arc::new(RenderingControl::mono()) as Arc<dyn Pipeline>,
        Arc::new(Slats::split()),
        Arc::new(Jitp::new(Viewpoint::Strip, true)),
        Arc::new(Frameless::new()),
    ];
    for pipeline in pipelines {
        let name = pipeline.name();
        let head = head(Synthetic::recorded_use(1), TrackerConfig::fastrak(), PredictorKind::None);
        let outcome = run(&pipeline, Some(head), 90);
        let samples = outcome.head().expect("a head").sampled();
        let mut stages = [const { Vec::<f64>::new() }; 6];
        for times in outcome.complete_pictures() {
            let Some(sample) = samples.iter().find(|sample| sample.number == times.view) else { continue };
            let (Some(measured), Some(arrived), Some(copied)) =
                (sample.measured_at, sample.arrived_at, times.copied_at)
            else {
                continue;
            };
            let light = pipeline.light(outcome.record(), times);
            let ms = |time: pxpl5_sim::Time| time.0 as f64 / 1e9;
            stages[0].push(ms(arrived) - ms(measured));
            stages[1].push((ms(sample.reports_until) - ms(arrived)).max(0.0));
            stages[2].push(ms(times.transform_at) - ms(sample.reports_until).max(ms(arrived)));
            stages[3].push(ms(copied) - ms(times.transform_at));
            stages[4].push(ms(times.shown_at) - ms(copied));
            stages[5].push(ms(light) - ms(times.shown_at));
        }
        let budget = Budget::of(&outcome);
        let n = stages[0].len();
        assert!(n > 10 && budget.n == n as u64, "{name}: {n}");
        let of_stages = [
            budget.tracking_ms,
            budget.waiting_ms,
            budget.sending_ms,
            budget.drawing_ms,
            budget.showing_ms,
            budget.scanning_ms,
        ];
        of_stages.iter().zip(&stages).for_each(|(found, expected)| assert_near(*found, mean(expected), name));
        assert_near(budget.total_ms, of_stages.iter().sum(), name);
        let totals: Vec<f64> = (0..n).map(|i| stages.iter().map(|stage| stage[i]).sum()).collect();
        let found = Budget::totals_ms(&outcome);
        assert_eq!(found.len(), n);
        found.iter().zip(&totals).for_each(|(found, expected)| assert_near(*found, *expected, name));
        // The report has their percentiles.
        let found = outcome.report().percentiles_ms;
        let expected = Percentiles::of(totals.into_iter());
        assert_near(found.head_to_light.p50, expected.p50, name);
        assert_near(found.head_to_light.p95, expected.p95, name);
        assert_eq!((found.head_to_light.n, found.latency.n), (n as u64, outcome.latency_ms().n), "{name}");
        assert_eq!(found.prediction_interval_error.n, 0, "{name}: nothing is predicted");
        // The report takes 3.75 ms to the first character, and 47 bytes at 115,200 baud.
        assert!((budget.tracking_ms - 3.75 - 4.08).abs() < 0.01, "{}", budget.tracking_ms);
    }
}

/// Returns the time in milliseconds between the instant for which each picture was predicted and the middle of its light.
/// A picture is lit in `lit` periods, or until the next picture without such a number.
fn prediction_interval_errors_ms(outcome: &Outcome, lit: Option<u64>) -> Vec<f64> {
    let (display, window) = (outcome.record().display(), outcome.window().expect("a window"));
    let sampled = outcome.head().expect("a head").sampled();
    let pictures = outcome.pictures();
    let mut errors = Vec::new();
    for (number, times) in pictures.iter().enumerate() {
        let first = display.period_at(times.shown_at);
        if !times.is_shown() || !window.holds_picture(first) {
            continue;
        }
        let until_next = pictures.get(number + 1).map(|next| display.period_at(next.shown_at).0 - first.0);
        let of_pipeline = || outcome.pipeline().periods_a_picture(outcome.record()).unwrap_or(1);
        let periods = lit.or(until_next).unwrap_or_else(of_pipeline).max(1);
        let begin = display.first_light(0, first).expect("lit");
        let end = display.last_light(0, PeriodNumber(first.0 + periods - 1)).expect("lit");
        let pose = sampled.iter().rev().find(|pose| pose.number == times.view).expect("it was requested");
        let aimed_at = pose.predicted_for.expect("predicted");
        errors.push((begin.0.midpoint(end.0) as f64 - aimed_at.0 as f64).abs() / 1e9);
    }
    errors
}

/// Slats draws a constant load, so the dry run knows its times of display. Then Rendering Control draws 1,200 triangles
/// with the times that a dry run found for 10, so its pictures are lit later than predicted.
#[test]
fn the_error_of_a_prediction_interval_is_the_time_from_its_instant_to_the_middle_of_the_light() {
    let predicted = || head(Synthetic::recorded_use(1), TrackerConfig::fastrak(), PredictorKind::ConstantVelocity);
    let slats = run(&(Arc::new(Slats::split()) as Arc<dyn Pipeline>), Some(predicted()), 90);
    let control = Arc::new(RenderingControl::mono()) as Arc<dyn Pipeline>;
    let light = experiment(&control, "sphere:10", 90).head(predicted()).after_dry_run().expect("it runs");
    let mut heavy = experiment(&control, "full-screen:1200", 90).head(predicted());
    heavy.dry_run = light.dry_run;
    let heavy = heavy.run().expect("it runs");
    // A field of Slats is scanned once, and a picture of Rendering Control until the next one.
    let max = [(&slats, Some(1)), (&heavy, None)].map(|(outcome, lit)| {
        let expected = Percentiles::of(prediction_interval_errors_ms(outcome, lit).into_iter());
        let found = outcome.report().percentiles_ms.prediction_interval_error;
        assert!(found.n > 10 && found.n == expected.n, "{found:?} {expected:?}");
        assert_near(found.max, expected.max, "max");
        assert_near(found.mean, expected.mean, "mean");
        found.max
    });
    assert!(max[0] < slats.field_ms() && max[1] > 1.0, "{max:?}");
}

#[test]
fn without_a_head_no_stage_is_measured() {
    let outcome = run(&(Arc::new(Slats::split()) as Arc<dyn Pipeline>), None, 60);
    let budget = Budget::of(&outcome);
    assert!(budget.n == 0 && budget.total_ms.is_nan() && budget.tracking_ms.is_nan());
    assert_eq!(budget.n, Budget::default().n);
    assert!(Budget::totals_ms(&outcome).is_empty());
    assert_eq!(ErrorCauses::of(&outcome, Showing::Plain, &PixelErrors::of(&outcome)), None);
}

/// A head slides, and a tracker without noise reports it 40 ms late without prediction.
///
/// Noise contributes nothing, and latency contributes most. Each contribution equals the whole minus the error without
/// the cause.
#[test]
fn the_parts_of_an_error_by_cause_add_up_to_the_error() {
    let slats = Arc::new(Slats::split()) as Arc<dyn Pipeline>;
    let late = TrackerConfig::ideal().with_latency_ps(40 * PS_PER_MS);
    let outcome = run(&slats, Some(head(Slide::right_at(1.0), late, PredictorKind::None)), 90);
    let whole = PixelErrors::of(&outcome);
    let causes = ErrorCauses::of(&outcome, Showing::Plain, &whole).expect("there is a head, and pixels were evaluated");
    assert!(whole.evaluated > 0 && causes.whole_px == whole.pixels.mean && causes.whole_px > 5.0, "{causes:?}");
    assert_eq!(causes.parts_px.iter().map(|part| part.cause).collect::<Vec<_>>(), Cause::ALL);
    let part = |cause| causes.parts_px.iter().find(|part| part.cause == cause).expect("listed").px;
    for cause in Cause::ALL {
        let without = PixelErrors::without(&outcome, Showing::Plain, cause).pixels.mean;
        assert_near(part(cause), causes.whole_px - without, cause.name());
    }
    assert_near(part(Cause::Noise), 0.0, "noise");
    assert!(part(Cause::Latency) > 0.5 * causes.whole_px, "{causes:?}");
    let sum: f64 = causes.parts_px.iter().map(|part| part.px).sum();
    assert_near(causes.interaction_px, causes.whole_px - sum, "interaction");
}

/// A head slides, and a tracker without noise is predicted exactly by a velocity. Predictions for an instant that is d too
/// late or too early are wrong by the way of d, on the screen by focal length x way / distance. The middle of the picture
/// is lit at the right instant, so it has no other error.
#[test]
fn a_wrong_prediction_interval_adds_the_way_of_the_head_in_its_error() {
    // 640 pixels over 60 degrees, 1 m/s, and points at a distance of 2 m.
    let px_a_second = 320.0 / 30_f64.to_radians().tan() * 1.0 / 2.0;
    let slats = Arc::new(Slats::split()) as Arc<dyn Pipeline>;
    let exact = TrackerConfig::ideal().with_latency_ps(40 * PS_PER_MS);
    let sliding =
        head(Slide::right_at(1.0), exact, PredictorKind::ConstantVelocity).evaluated_at(2.0).expect("in range");
    let outcome = experiment(&slats, "room", 45).head(sliding).run().expect("it runs");
    for later_ms in [0_i64, 20, 40, -20] {
        let found = PixelErrors::with_prediction_interval_error(&outcome, Showing::Plain, later_ms).centre_px.mean;
        let expected = px_a_second * later_ms.unsigned_abs() as f64 / 1e3;
        assert!((found - expected).abs() < 0.06, "{later_ms} ms: {found} px, expected {expected}");
    }
}

#[test]
fn a_still_head_has_no_error_of_any_cause() {
    let slats = Arc::new(Slats::split()) as Arc<dyn Pipeline>;
    let still = head(Still(Pose::at(DVec3::ZERO)), TrackerConfig::ideal(), PredictorKind::ConstantVelocity);
    let outcome = run(&slats, Some(still), 60);
    let causes = ErrorCauses::of(&outcome, Showing::Plain, &PixelErrors::of(&outcome)).expect("evaluated");
    assert!(causes.whole_px.abs() < 1e-6 && causes.parts_px.iter().all(|part| part.px.abs() < 1e-6), "{causes:?}");
}
