//! Tests of long runs that keep statistics only. The number of records, and the work for them per field, do not grow with
//! the length of the run. tests/long_runs.rs of pxpl5-measure compares the results with those of a run that keeps
//! everything.

use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, Frameless, Head, KeptRecords, Pipeline, Pixels, RenderingControl, Slats};
use pxpl5_scene::Scene;
use std::sync::Arc;
use tracking::motion::Synthetic;
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;

/// Number of records below which a run discards nothing. By default, runs discard records eight times less often.
const MIN_RECORDS: usize = 4_096;

/// Returns the first value in a sample, and the second value with `PXPL5_ALL_CASES=1`, as in scripts/nightly.
fn sample_or_all<T>(sample: T, all: T) -> T {
    if std::env::var_os("PXPL5_ALL_CASES").is_some() { all } else { sample }
}

fn scene(name: &str, triangles: usize) -> Scene {
    let scene = pxpl5_scene::builtin(name).expect("built in");
    if triangles > 0 { scene.decimated(triangles).expect("it has so many") } else { scene }
}

fn experiment(machine: MachineConfig, pipeline: impl Pipeline, scene: Scene, fields: u64) -> Experiment {
    Experiment::with(machine, Arc::new(pipeline), Arc::new(scene))
        .fields(fields)
        .pixels(Pixels::Off)
        .least_records(MIN_RECORDS)
}

fn tracked() -> Head {
    let motion = Arc::new(Synthetic::recorded_use(2));
    Head::new(motion, TrackerConfig::fastrak(), PredictorKind::Kalman, 1).expect("in range")
}

/// Returns counts of a run. The counts are the largest numbers of records and of pending events at any stop, all
/// records that were read, all events, and the poses in memory at the end.
fn work(experiment: &Experiment, fields: u64) -> [u64; 5] {
    let mut most = [0, 0];
    let watched = experiment.clone().fields(fields).keep(KeptRecords::Statistics).run_stopping(&[], |_, run| {
        most[0] = most[0].max(run.record().observation().records() as u64);
        most[1] = most[1].max(run.machine().pending_events() as u64);
        Ok(())
    });
    let outcome = watched.expect("it runs");
    let poses = outcome.head().map_or(0, |head| head.sampled().len() as u64);
    [most[0], most[1], outcome.tally().records_read, outcome.record().events(), poses]
}

/// A live page reads recorded messages, so its run keeps the records of the last periods.
#[test]
fn recent_records_of_an_observed_run_do_not_grow_with_its_length() {
    let most = |fields| {
        let experiment = experiment(MachineConfig::slats(), Slats::split(), scene("mig", 60), 1).fields(fields);
        let mut stepper = experiment.keep(KeptRecords::Recent).record_traffic(true).stepper().expect("it can be built");
        let mut most = 0;
        while stepper.now() < stepper.end() {
            stepper.step_period();
            let observation = stepper.record().observation();
            let traffic = observation.traffic.as_ref().expect("recorded");
            most = most.max(observation.records() + traffic.records());
        }
        assert!(!stepper.last_latencies(8).is_empty(), "the last pictures are known");
        (most, stepper.record().trace_hash())
    };
    let [(short, _), (long, hash)] = [600, 1_800].map(most);
    // Old records are discarded in passes. The next pass begins at twice the number of records that the last pass has
    // left. This number varies with the visible part of the scene. Without passes, the number of records would be three
    // times as large.
    assert!(long <= short + short / 4, "{long} records, {short} in a third of the time");
    let everything = experiment(MachineConfig::slats(), Slats::split(), scene("mig", 60), 1).fields(1_800);
    assert_eq!(hash, everything.run().expect("it runs").record().trace_hash());
}

#[test]
fn twenty_times_the_fields_need_no_more_memory_and_twenty_times_the_events() {
    let small = MachineConfig::small_hmd;
    let slats = experiment(MachineConfig::slats(), Slats::split(), scene("mig", 60), 1);
    for (name, experiment, fields) in [
        ("slats behind a tracker", slats.clone().head(tracked()), sample_or_all(100, 300)),
        ("slats", slats, sample_or_all(100, 300)),
        (
            "rendering control",
            experiment(small(), RenderingControl::mono(), scene("mig", 12), 1),
            sample_or_all(250, 800),
        ),
        (
            "frameless",
            experiment(small(), Frameless { block: 64, ..Frameless::new() }, scene("full-screen:4", 0), 1),
            sample_or_all(60, 150),
        ),
    ] {
        let [_, _, _, events, _] = work(&experiment, fields);
        let [records_5, waiting_5, read_5, _, poses_5] = work(&experiment, 5 * fields);
        let [records_20, waiting_20, read_20, events_20, poses_20] = work(&experiment, 20 * fields);
        // A run that ends just before a pass has twice as many records as a run that ends just after the pass.
        assert!(poses_20 <= 2 * poses_5, "{name}: {poses_20} poses, {poses_5} in a quarter of the time");
        // The sway of the head changes the visible part of the scene a little. Up to 60 fields may lie between two
        // passes.
        assert!(
            records_20 <= records_5 + records_5 / 20,
            "{name}: {records_20} records, {records_5} in a quarter of the time"
        );
        assert!(waiting_20 <= 2 * waiting_5, "{name}: {waiting_20} events wait, {waiting_5} in a quarter of the time");
        let reads = read_20 as f64 / (4 * read_5) as f64;
        assert!(reads < 1.25, "{name}: {reads} times the records read for each field");
        let growth = events_20 as f64 / (20 * events) as f64;
        assert!((growth - 1.0).abs() < 0.02, "{name}: {growth} times the events a field");
    }
}
