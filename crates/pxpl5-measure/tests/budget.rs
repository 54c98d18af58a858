//! Stages of the latency from pose to light, and causes of the error.

use glam::DVec3;
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{Budget, ErrorCauses, LatencyPercentiles, Percentiles, PixelErrors, Showing};
use pxpl5_run::{
    Cause, Experiment, Frameless, Head, Jitp, Outcome, Pipeline, Pixels, RenderingControl, Slats, Viewpoint,
};
use pxpl5_scene::builtin;
use std::sync::Arc;
use tracking::motion::{Motion, Slide, Still, Synthetic};
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;
use tracking::{Pose, time::PS_PER_MS};

fn run(pipeline: &Arc<dyn Pipeline>, head: Option<Head>, fields: u64) -> Outcome {
    let scene = Arc::new(builtin("sphere:10").expect("even"));
    let experiment = Experiment::with(MachineConfig::small_hmd(), Arc::clone(pipeline), scene).fields(fields);
    let experiment = experiment.pixels(Pixels::Off);
    head.into_iter().fold(experiment, Experiment::head).run().expect("it runs")
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
        // The report has their percentiles. Without a change of the load, all pictures are lit when the dry run says.
        let found = LatencyPercentiles::of(&outcome);
        let expected = Percentiles::of(totals.into_iter());
        assert_near(found.head_to_light.p50, expected.p50, name);
        assert_near(found.head_to_light.p95, expected.p95, name);
        assert_eq!((found.head_to_light.n, found.latency.n), (n as u64, outcome.latency_ms().n), "{name}");
        assert!(found.aim_miss.n == 0 || found.aim_miss.max == 0.0, "{name}: {found:?}");
        // The report takes 3.75 ms to the first character, and 47 bytes at 115,200 baud.
        assert!((budget.tracking_ms - 3.75 - 4.08).abs() < 0.01, "{}", budget.tracking_ms);
    }
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
/// late or too early are wrong by the way of d. The middle of the picture is lit at the right instant, so it has no other
/// error.
#[test]
fn a_wrong_prediction_interval_adds_the_way_of_the_head_in_its_error() {
    let slats = Arc::new(Slats::split()) as Arc<dyn Pipeline>;
    let exact = TrackerConfig::ideal().with_latency_ps(40 * PS_PER_MS);
    let outcome = run(&slats, Some(head(Slide::right_at(1.0), exact, PredictorKind::ConstantVelocity)), 90);
    let mean_px = |later_ms| PixelErrors::misaimed(&outcome, Showing::Plain, later_ms).centre_px.mean;
    assert_near(mean_px(0), PixelErrors::of(&outcome).centre_px.mean, "the right interval");
    let [late, later, early] = [20, 40, -20].map(mean_px);
    assert!((later / late - 2.0).abs() < 0.02 && (early / late - 1.0).abs() < 0.02, "{late} {later} {early}");
}

#[test]
fn a_still_head_has_no_error_of_any_cause() {
    let slats = Arc::new(Slats::split()) as Arc<dyn Pipeline>;
    let still = head(Still(Pose::at(DVec3::ZERO)), TrackerConfig::ideal(), PredictorKind::ConstantVelocity);
    let outcome = run(&slats, Some(still), 60);
    let causes = ErrorCauses::of(&outcome, Showing::Plain, &PixelErrors::of(&outcome)).expect("evaluated");
    assert!(causes.whole_px.abs() < 1e-6 && causes.parts_px.iter().all(|part| part.px.abs() < 1e-6), "{causes:?}");
}
