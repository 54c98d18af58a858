//! A run that keeps only statistics gives the same report as a run that keeps everything, and its memory does not grow.

use glam::DVec3;
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{HeadSum, Measured, Report};
use pxpl5_run::{Aim, Experiment, Head, KeptRecords, Outcome, PipelineSettings, Pixels, Raster, Registry};
use pxpl5_scene::{Scene, builtin};
use rayon::prelude::*;
use std::sync::Arc;
use tracking::motion::{Motion, Pan, Pendulum, Synthetic, Walk};
use tracking::predict::PredictorKind;
use tracking::tracker::{TrackerConfig, TrackerFault};

/// Number of records below which a run discards nothing. By default, runs discard records eight times less often.
const MIN_RECORDS: usize = 4_096;

fn runs_all_cases() -> bool {
    std::env::var_os("PXPL5_ALL_CASES").is_some()
}

fn scene(name: &str, triangles: usize) -> Scene {
    let scene = builtin(name).expect("built in");
    if triangles > 0 { scene.decimated(triangles).expect("it has so many") } else { scene }
}

fn experiment(pipeline: &str, machine: MachineConfig, scene: Scene) -> Experiment {
    let pipeline = (Registry::of_papers().pipeline(pipeline).expect("listed").build)(&PipelineSettings::default());
    let config = pipeline.adapt(machine);
    let experiment = Experiment::with(config, pipeline, Arc::new(scene)).pixels(Pixels::Off);
    experiment.observed_by(Some(HeadSum::begin)).least_records(MIN_RECORDS)
}

fn head(motion: impl Motion + Send + Sync + 'static, tracker: TrackerConfig, kind: PredictorKind) -> Head {
    Head::new(Arc::new(motion), tracker, kind, 7).expect("in range")
}

fn synthetic() -> Synthetic {
    Synthetic::recorded_use(3)
}

/// Returns a walk of twenty metres back and forth, with a head that looks around.
fn walk() -> Walk {
    let corners = [DVec3::ZERO, DVec3::new(0.0, 0.0, -10.0), DVec3::new(1.0, 0.0, 0.0)];
    Walk::new(&corners, 0.6).expect("a way").with_glances(5)
}

/// Returns a tracker that is silent between two times of the run.
fn silent(from_s: f64, to_s: f64) -> TrackerConfig {
    let [from_ps, to_ps] = [from_s, to_s].map(|s| (s * 1e12) as u64);
    TrackerConfig { faults: vec![TrackerFault::Dropout { from_ps, to_ps }], ..TrackerConfig::fastrak() }
}

/// Returns experiments of every family of pipelines, with different trackers, predictors, rasters and aims.
///
/// They are long enough that records are discarded several times. Without `PXPL5_ALL_CASES=1`, the test runs every second
/// one. With it, each run is also longer, except the run of frameless rendering with its 300 pictures in each field: beyond 65,536 samples (`KEPT_SAMPLES`), the
/// statistics differ in the last digits.
fn experiments() -> Vec<Experiment> {
    let longer = if runs_all_cases() { 3 } else { 1 };
    let run = |(fields, experiment): (u64, Experiment)| {
        let has_few_pictures = experiment.pipeline().name() != "frameless";
        experiment.fields(if has_few_pictures { longer * fields } else { fields })
    };
    short_experiments().into_iter().map(run).collect()
}

fn short_experiments() -> Vec<(u64, Experiment)> {
    let small = MachineConfig::small_hmd;
    let fastrak = TrackerConfig::fastrak;
    let slats = |head| experiment("slats", MachineConfig::slats(), scene("mig", 60)).head(head);
    let control = |head| experiment("rendering-control", small(), scene("mig", 0)).head(head);
    let faces = |name, head| experiment(name, small(), scene("gallery", 0)).head(head);
    let strips = |name, head| experiment(name, small(), scene("full-screen:4", 0)).head(head);
    let [none, velocity, kalman] = [PredictorKind::None, PredictorKind::ConstantVelocity, PredictorKind::Kalman];
    vec![
        (500, slats(head(synthetic(), fastrak(), kalman))),
        (500, slats(head(Pan::at(60.0), TrackerConfig::flock_of_birds(), none).with_raster(Raster::Vdrt))),
        (500, slats(head(synthetic(), silent(5.0, 6.5), velocity))),
        // Every field is late.
        (500, experiment("slats", MachineConfig::slats(), scene("mig", 250)).head(head(synthetic(), fastrak(), none))),
        // The run lasts 18 seconds after the tracker's last report.
        (1_500, slats(head(synthetic(), silent(4.0, 22.0), velocity))),
        (500, control(head(synthetic(), fastrak(), velocity).with_aim(Aim::FirstPixel))),
        (500, control(head(walk(), TrackerConfig::optical_ceiling(), kalman).with_raster(Raster::Vdrt))),
        (500, control(head(synthetic(), TrackerConfig::polhemus_3space(), none)).on_demand()),
        (500, experiment("jitp-field", small(), scene("mig", 60)).head(head(synthetic(), fastrak(), kalman))),
        (200, strips("jitp-scanline-racing", head(Pendulum::rig(), fastrak(), none))),
        (200, strips("jitp-dual-view", head(synthetic(), fastrak(), kalman))),
        (150, strips("frameless", head(synthetic(), fastrak(), velocity))),
        (400, faces("arp-full", head(synthetic(), fastrak(), kalman))),
        (400, faces("arp-priority-line", head(synthetic(), TrackerConfig::flock_of_birds(), velocity))),
        (300, faces("arp-cells-warp-pixel", head(synthetic(), fastrak(), none))),
        (400, faces("arp-ideal", head(walk(), fastrak(), kalman))),
    ]
}

fn run(experiment: &Experiment, keep: KeptRecords) -> Outcome {
    experiment.clone().keep(keep).run().expect("it runs")
}

/// Returns all values of a report except the time on this computer. Numbers have enough digits to be distinguished.
fn report_json(outcome: &Outcome) -> String {
    let report = Report { host_seconds: None, ..outcome.report() };
    // A streaming observer reports the latency of translation even if the run has discarded records.
    for memory in report.arp.iter().flat_map(|faces| &faces.memories) {
        assert_eq!(memory.translation_latency_ms.is_some(), memory.updates > 0);
    }
    format!("{report:#?}")
}

fn assert_same(experiment: &Experiment) {
    let head = experiment.head.as_ref().expect("tracked");
    let name = format!("{}, {:?}", experiment.pipeline().name(), head);
    let everything = run(experiment, KeptRecords::Everything);
    let statistics = run(experiment, KeptRecords::Statistics);
    let passes = statistics.observation().discarded.passes;
    let [expected, found] = [&everything, &statistics].map(report_json);
    let other = expected.lines().zip(found.lines()).find(|(expected, found)| expected != found);
    assert_eq!(other, None, "{name}");
    assert_eq!(expected.len(), found.len(), "{name}");
    assert!(!everything.has_discarded_records(), "{name}: all records are in memory");
    let least_passes = if experiment.pipeline().name() == "frameless" { 1 } else { 2 };
    assert!(passes >= least_passes, "{name}: records were discarded {passes} times");
    let of_head = everything.report().head.expect("tracked");
    assert!(of_head.error.evaluated > 500 && of_head.end_to_end.n > 50, "{name}: the run has results");
    let [all, last] = [&everything, &statistics].map(|outcome| outcome.head().expect("tracked").sampled());
    assert!(4 * last.len() < 3 * all.len(), "{name}: {} poses of {} are held", last.len(), all.len());
    assert_eq!(last, all[all.len() - last.len()..], "{name}: the last ones");
}

#[test]
fn discarding_records_changes_no_result_of_a_head() {
    let step = if runs_all_cases() { 1 } else { 2 };
    experiments().par_iter().step_by(step).for_each(assert_same);
}

#[test]
fn a_report_warns_of_discarded_records_without_a_streaming_observer() {
    let experiment = experiments().swap_remove(0);
    let silent = run(&experiment.clone().observed_by(None), KeptRecords::Statistics).report();
    let warnings: Vec<&String> =
        silent.warnings.iter().filter(|warning| warning.contains("cover only the last pictures")).collect();
    assert_eq!(warnings.len(), 1, "{:?}", silent.warnings);
    for keep in [KeptRecords::Everything, KeptRecords::Statistics] {
        assert_eq!(run(&experiment, keep).report().warnings, experiment.warnings(), "{keep:?}");
    }
}
