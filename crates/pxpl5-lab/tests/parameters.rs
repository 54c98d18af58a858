//! Tests that every listed parameter can be set by its path, within its limits, and has an effect.

use crate::support;
use pxpl5_lab::{ExperimentFile, Plan, tracking_parameters};
use pxpl5_machine::MachineConfig;
use pxpl5_measure::Measured;
use pxpl5_run::{Pixels, Registry};
use pxpl5_sim::parameters::{Parameter, Value};

const TRACKERS: [&str; 8] =
    ["optical", "fastrak", "fastrak-polled", "flock", "flock-patched", "3space", "3space-patched", "ideal"];

const SMALL: [&str; 4] = ["pipeline=slats", "machine.preset=slats", "scene=full-screen:2", "fields=24"];

fn file(settings: &[&str]) -> ExperimentFile {
    let mut file = ExperimentFile::new();
    for assignment in SMALL.iter().chain(settings) {
        file.set_text(assignment, "--set").expect("known");
    }
    file
}

fn plan(settings: &[&str]) -> Plan {
    file(settings).resolve().expect("an experiment")
}

fn refusal(settings: &[&str]) -> String {
    file(settings).resolve().expect_err("it is refused").to_string()
}

fn hash(plan: &Plan) -> String {
    plan.experiment(plan.load_scene().expect("built in")).config_hash().to_string()
}

#[test]
fn setting_each_machine_parameter_to_its_own_value_changes_nothing() {
    let machine = Registry::of_papers().machine_of(MachineConfig::small_hmd());
    for Parameter { path, value, .. } in machine.parameters().into_iter().filter(|parameter| !parameter.read_only) {
        let mut same = machine.clone();
        same.set(&path, value).expect("listed");
        assert_eq!(same.check(), Ok(()), "{path}");
        assert_eq!((&same, same.overrides().len()), (&machine, 0), "{path}");
    }
}

#[test]
fn setting_each_key_of_an_experiment_to_its_own_value_changes_nothing() {
    for tracker in TRACKERS {
        let tracker = format!("head.tracker={tracker}");
        // A parameter of the filter that the user has set is not tuned.
        let head = ["head.motion=pan:40", &tracker, "head.filter=given"];
        let plain = plan(&head);
        for Parameter { path, value, .. } in plain.parameters().into_iter().filter(|parameter| !parameter.read_only) {
            let same = plan(&[&head[..], &[&format!("{path}={value}")]].concat());
            assert_eq!((same.fingerprint(), hash(&same)), (plain.fingerprint(), hash(&plain)), "{tracker}, {path}");
        }
    }
}

#[test]
fn every_read_only_parameter_is_refused_as_read_only() {
    let listed = plan(&[]).parameters().into_iter().chain(tracking_parameters());
    let read_only: Vec<Parameter> = listed.filter(|parameter| parameter.read_only).collect();
    assert!(read_only.iter().any(|parameter| parameter.path == "i860.chip.page_bytes"));
    for Parameter { path, value, .. } in read_only {
        let found = refusal(&["head.motion=still", &format!("{path}={value}")]);
        let expected = format!("--set: {path} is {value} in every machine");
        assert!(found.starts_with(&expected) && found.ends_with("cannot be set"), "{found}");
    }
}

#[test]
fn the_tables_of_the_i860_are_set_by_paths_that_end_with_the_name_of_the_parameter() {
    let mut machine = MachineConfig::slats();
    machine.set("i860.dram.page_bytes", 2_048).expect("the memory's");
    assert_eq!((machine.i860.dram.page_bytes, machine.i860.freezes), (2_048, MachineConfig::slats().i860.freezes));
    machine.set("i860.freezes.tlb_miss", 6).expect("a freeze");
    assert_eq!(machine.i860.freezes.clocks.tlb_miss, 6);
    let error = machine.set("i860.dram.page_byte", 1).expect_err("misspelt").to_string();
    assert!(error.contains("did you mean `i860.dram.page_bytes`"), "{error}");
}

/// Returns the trace hash of a run at the cycle level, and the sum of all of its TRANSFORM times in ms.
fn traced(settings: &[&str]) -> (String, f64) {
    let plan = plan(&[&["level=cycle"], settings].concat());
    let experiment = plan.experiment(plan.load_scene().expect("built in")).pixels(Pixels::Off);
    let outcome = experiment.run().expect("it is small");
    let stages = outcome.stages();
    let spans = stages.iter().filter(|span| span.stage == pxpl5_gp::Stage::Transform);
    let total_ms: f64 = spans.filter_map(|span| Some((span.end? - span.begin).as_ms())).sum();
    (outcome.report().trace_hash, total_ms)
}

/// Tests that slower memory slows the code that reads it. If every access takes ten times as long, TRANSFORM is slower.
/// Runs without executed code do not depend on these parameters.
#[test]
fn a_slower_memory_makes_a_run_of_code_slower() {
    let (hash_of_papers, papers_ms) = traced(&[]);
    let slow = ["i860.dram.first_hit=80", "i860.dram.first_miss=110"];
    let (hash_of_slow, slow_ms) = traced(&slow);
    assert_ne!(hash_of_papers, hash_of_slow);
    assert!(slow_ms > papers_ms, "{slow_ms} ms with a slow memory, {papers_ms} ms with the papers'");
    let plain = plan(&[]);
    assert_ne!(hash(&plan(&slow)), hash(&plain));
    assert_eq!(plan(&slow).machine.overrides().len(), 2);
}

/// Tests that the configured clocks apply to all blocks of code: those whose clocks are cached, and those that are
/// counted each time.
#[test]
fn memoised_and_counted_code_give_the_same_trace_for_any_memory_timing() {
    let plan = plan(&["level=cycle", "i860.dram.first_hit=80", "i860.freezes.load_use=3"]);
    let experiment = plan.experiment(plan.load_scene().expect("built in")).pixels(Pixels::Off);
    let counted = experiment.clone().without(pxpl5_machine::Optimization::RepeatedCode).run().expect("it is small");
    assert_eq!(experiment.run().expect("it is small").report().trace_hash, counted.report().trace_hash);
}

/// Returns the mean latency from head to display in ms. The optical tracker reports a thousand times a second, so the
/// age of a report at the host equals the tracker's latency to a millisecond.
fn head_to_light_ms(latency_ms: u64) -> f64 {
    let latency = format!("tracking.optical.latency={latency_ms}");
    let plan = plan(&["head.motion=pan:40", "head.predict=none", "tracking.optical.rate=1000", "fields=60", &latency]);
    support::run(&plan).expect("it is small").report().head.expect("a head").end_to_end.total_ms
}

#[test]
fn a_later_tracker_lengthens_head_to_light_by_the_same_time() {
    let longer = head_to_light_ms(50) - head_to_light_ms(20);
    assert!((longer - 30.0).abs() < 1.0, "{longer} ms for 30 ms");
}

/// Returns the mean time in ms from the head's pose until its report arrives at the host.
fn tracking_ms(settings: &[&str]) -> f64 {
    let head = ["head.motion=pan:40", "head.predict=none", "fields=240"];
    let plan = plan(&[&head[..], settings].concat());
    support::run(&plan).expect("it is small").report().head.expect("a head").end_to_end.tracking_ms
}

/// Tests the wait for a poll. Reports wait for half a polling period on average. If one poll finds several reports, the
/// newest waits for less.
#[test]
fn the_polling_of_the_operating_system_delays_the_fastrak() {
    let patched = tracking_ms(&["head.tracker=fastrak"]);
    let [usual, longer] = ["20", "100"].map(|poll| {
        let poll = format!("tracking.host.poll={poll}");
        tracking_ms(&["head.tracker=fastrak-polled", &poll])
    });
    assert!(usual > patched && usual < patched + 20.0, "{patched} ms patched, {usual} ms polled every 20 ms");
    assert!(longer != usual, "{longer} ms polled every 100 ms");
}

#[test]
fn an_impossible_tracker_parameter_is_refused_with_the_expected_range() {
    let rows = "\
head.motion=still tracking.optical.rate=0 | --set: tracking.optical.rate must be 1 to 10000, found 0
head.motion=still tracking.optical.rate=60.5 | --set: tracking.optical.rate must be a whole number
head.motion=still tracking.filter.baseline=17 | --set: tracking.filter.baseline must be 1 to 16
head.motion=still tracking.fastrak.rate=60 | tracking.fastrak.rate does not apply to head.tracker = optical
head.motion=still head.tracker=fastrak tracking.host.poll=20 | tracking.host.poll does not apply to head.tracker = fastrak, whose host is patched and does not poll; fastrak-polled
head.motion=still head.tracker=flock tracking.host.byte_bits=11 | tracking.host.byte_bits does not apply to head.tracker = flock, whose latency includes the cable
tracking.optical.rate=60 | head.motion is missing
i860.dram.first_hit=1000001 | i860.dram.first_hit must be 0 to 1000000, found 1000001
";
    for (settings, says) in rows.lines().map(|row| row.split_once(" | ").expect(row)) {
        let found = refusal(&settings.split(' ').collect::<Vec<_>>());
        assert!(found.contains(says), "{settings}: {found}");
    }
    let error = ExperimentFile::new().set_text("tracking.optcal.rate=60", "--set").expect_err("misspelt").to_string();
    assert!(error.contains("did you mean `tracking.optical.rate`"), "{error}");
}

#[test]
fn a_written_file_has_the_parameters_of_its_tracker() {
    let first = plan(&["head.motion=pan:40", "head.tracker=fastrak", "tracking.host.byte_bits=11"]);
    let text = first.settings().to_string();
    let second = support::plan(&text);
    assert_eq!((&first, first.fingerprint(), hash(&first)), (&second, second.fingerprint(), hash(&second)));
    let of_line = second.parameters().into_iter().find(|parameter| parameter.path == "tracking.host.byte_bits");
    assert_eq!(of_line.map(|parameter| parameter.value), Some(Value::Whole(11)));
    assert_ne!(hash(&first), hash(&plan(&["head.motion=pan:40", "head.tracker=fastrak"])));
}
