//! Tests of random machines: every pipeline on every display that it supports, with numbers of boards and parameters
//! from the whole allowed range. The promises of ARCHITECTURE.md must hold on all of them.
//!
//! Reports of random runs must be consistent. Counts add up, rates are possible, means lie between least and greatest,
//! and pictures that were not shown have no values. Each case follows from a number, which a failure prints.
//! `PXPL5_FUZZ=100` tries a hundred times as many cases, and `PXPL5_FUZZ_FROM` begins at another number. `PXPL5_FUZZ=50
//! cargo test -p pxpl5 --test main reports` checks 1,000 reports.

use crate::support;
use pxpl5::firmware::NodeId;
use pxpl5::{
    Experiment, ExperimentError, ExperimentFile, MachineConfig, Measured, Optimization, Outcome, Pixels, RunError,
    Statistics, Time, Transfer, WARM_UP_PERIODS, Workstation, registry,
};
use pxpl5_sim::SplitMix64;
use serde_json::Value;
use std::collections::BTreeMap;

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |text| text.parse().unwrap_or_else(|_| panic!("{name}={text}")))
}

/// Smallest and largest length and load of random runs.
#[derive(Clone, Copy)]
struct Sizes {
    fields: (u64, u64),
    triangles: (u64, u64),
}

/// Sizes of runs with a few pictures.
const SHORT: Sizes = Sizes { fields: (9, 18), triangles: (4, 40) };

/// Sizes of runs with a window of results. Many of these runs are too heavy for their machine.
const REPORTED: Sizes = Sizes { fields: (1, 60), triangles: (1, 600) };

/// Returns an experiment and its description. Returns `None` if the machine refuses its numbers, or lacks boards for
/// the pipeline.
fn case(round: u64, sizes: Sizes) -> Option<(Experiment, String)> {
    let mut random = SplitMix64::new(round << 8 | 7);
    let registry = registry();
    let mut file = ExperimentFile::new();
    let mut settings = Vec::new();
    let mut set = |text: String| {
        let accepted = file.set_text(&text, "case").is_ok();
        settings.push(if accepted { text } else { format!("({text})") });
    };
    let pipelines = registry.pipelines();
    set(format!("pipeline={}", pipelines[(round % pipelines.len() as u64) as usize].name));
    if random.between(0, 3) == 0 {
        let displays = registry.displays();
        set(format!("display={}", displays[random.between(0, displays.len() as u64 - 1) as usize].name));
    }
    set(format!("scene={}", random.element(&["full-screen:2", "mig", "molecules", "typical:40", "sphere:60"])));
    set(format!("triangles={}", random.between(sizes.triangles.0, sizes.triangles.1)));
    set(format!("fields={}", random.between(sizes.fields.0, sizes.fields.1)));
    set(format!("machine.n_gps={}", random.element(&[2, 3, 4, 7, 13, 31])));
    set(format!("machine.n_renderers={}", random.element(&[1, 2, 3, 5, 9, 20])));
    set(format!("seed={}", random.between(1, 9)));
    if random.between(0, 2) == 0 {
        set(format!("head.motion=synthetic:{}", random.between(1, 9)));
    }
    let mut parameters = MachineConfig::small_hmd().parameters();
    parameters.retain(|parameter| !parameter.read_only);
    for _ in 0..random.between(0, 5) {
        let parameter = &parameters[random.between(0, parameters.len() as u64 - 1) as usize];
        // Half of the values lie in the range of the sources, and half anywhere within the limits.
        let bounds = random.element(&[parameter.info.range, parameter.info.limits]);
        let (Some(least), Some(most)) = (bounds.0.whole(), bounds.1.whole()) else { continue };
        let size = random.between(1, 24);
        set(format!("machine.{}={}", parameter.path, (least + random.bits() % (1 << size)).min(most)));
    }
    let description = format!("{round}: {}", settings.join(" "));
    let plan = file.resolve().ok()?;
    let experiment = plan.experiment(plan.load_scene().ok()?).pixels(Pixels::Off).record_traffic(true);
    experiment.build().is_ok().then_some((experiment, description))
}

/// Returns the outcome of a run, also of one that failed, with its error. The callers reject a deadlock.
fn outcome(experiment: &Experiment, case: &str) -> (Outcome, Option<RunError>) {
    match experiment.run() {
        Ok(outcome) => (outcome, None),
        Err(ExperimentError::TooShort { partial, .. }) => (*partial, None),
        Err(ExperimentError::Run { error, partial }) => (*partial, Some(error)),
        Err(error) => panic!("{case}: {error}"),
    }
}

/// Returns the whole report without values that depend on the host, and the error of the run.
fn report(experiment: &Experiment, case: &str) -> (serde_json::Value, Option<String>) {
    let (outcome, error) = outcome(experiment, case);
    let mut report = serde_json::to_value(outcome.report()).expect("it is data");
    let fields = report.as_object_mut().expect("an object");
    fields.remove("host_seconds");
    // The number of events scheduled in vain depends on ties and optimizations.
    fields.remove("events");
    (report, error.map(|error| error.to_string()))
}

/// Returns the time span in which a message occupied a channel, the sending port and the receiving port (rule 3 and the
/// table of `pxpl5_ring`).
fn occupied(transfer: &Transfer, outcome: &Outcome) -> (Time, Time) {
    let ring = &outcome.record().config().ring;
    let n_nodes = u64::from(outcome.record().ring().n_nodes());
    let hops = (n_nodes + u64::from(transfer.destination.0) - u64::from(transfer.source.0)) % n_nodes;
    let on_the_way = hops * ring.hop_ns * 1_000;
    let begin = transfer.begin.0 - ring.overhead_words * ring.word_ns * 1_000 - on_the_way;
    (Time(begin), Time(transfer.end.0 - on_the_way))
}

/// Returns the largest number of intervals that overlap. An interval that ends at an instant does not overlap one that
/// begins then.
fn most_at_once(intervals: &[(Time, Time)]) -> usize {
    let mut edges: Vec<(Time, i64)> = intervals.iter().flat_map(|(begin, end)| [(*begin, 1), (*end, -1)]).collect();
    edges.sort_unstable();
    let mut now = 0;
    let sums = edges.into_iter().map(|(_, change)| {
        now += change;
        now
    });
    sums.max().unwrap_or(0) as usize
}

/// Checks the rules of the ring: words take their time, the number of channels is limited, a port receives one message
/// at a time, and no FIFO overflows.
fn assert_the_ring_is_a_ring(outcome: &Outcome, case: &str) {
    let config = outcome.record().config();
    let traffic = outcome.record().observation().traffic.as_ref().expect("it was recorded");
    let mut channels = Vec::new();
    let mut ports: BTreeMap<(&str, u16), Vec<(Time, Time)>> = BTreeMap::new();
    for transfer in &traffic.transfers {
        let (begin, end) = occupied(transfer, outcome);
        let least = (config.ring.overhead_words + u64::from(transfer.words)) * config.ring.word_ns * 1_000;
        assert!(end.0 - begin.0 >= least, "{case}: {transfer:?}");
        channels.push((begin, end));
        ports.entry(("receives", transfer.destination.0)).or_default().push((begin, end));
        ports.entry(("sends", transfer.source.0)).or_default().push((begin, end));
    }
    assert!(most_at_once(&channels) as u64 <= config.ring.channels, "{case}");
    for ((what, port), intervals) in &ports {
        let most = if *what == "sends" { config.ring.source_channels } else { 1 };
        assert!(most_at_once(intervals) as u64 <= most, "{case}: port {port} {what}");
    }
    for renderer in 0..outcome.record().renderers().len() {
        for (time, words) in traffic.fifo_words(renderer) {
            let holds = 0..=config.renderer.fifo_words as i64;
            assert!(holds.contains(&words), "{case}: renderer {renderer} at {time:?}: {words} words");
        }
    }
}

/// Largest number of words in an order to a display. A region has at least 16 pixels.
const ORDER_WORDS: u32 = 2;

/// Checks that displays count exactly the messages that arrived, and that they could use all of them.
fn assert_every_region_arrives_once(outcome: &Outcome, case: &str) {
    let observation = outcome.record().observation();
    let traffic = observation.traffic.as_ref().expect("it was recorded");
    for display in outcome.record().displays() {
        let counted = |name: &str| display.counters().iter().find(|counter| counter.name == name).map(|c| c.count);
        let is_its = |port: NodeId| display.nodes().contains(&port);
        // Orders to swap contain no pixels, and are shorter than any message with pixels.
        let is_pixels = |transfer: &&Transfer| is_its(transfer.destination) && transfer.words > ORDER_WORDS;
        let messages = traffic.transfers.iter().filter(is_pixels).count() as u64;
        let regions = observation.arrivals.iter().filter(|arrival| is_its(arrival.target.frame_buffer)).count() as u64;
        assert_eq!(counted("messages").unwrap_or(messages), messages, "{case}: {}", display.name());
        assert_eq!(counted("regions").unwrap_or(regions), regions, "{case}: {}", display.name());
        assert_eq!(display.faults(), (0, None), "{case}: {}", display.name());
    }
}

/// Checks that Rendering Control copies only into the buffer that is not shown.
fn assert_no_shown_buffer_is_written(outcome: &Outcome, case: &str) {
    let observation = outcome.record().observation();
    for (surface, _) in outcome.record().surfaces() {
        let swaps: Vec<Time> = observation.swaps_of(surface).map(|swap| outcome.record().tick(swap.tick)).collect();
        let arrivals = observation.arrivals.iter().filter(|arrival| arrival.surface == surface);
        let written = arrivals.map(|arrival| {
            let before = |instant: Time| swaps.iter().filter(|swap| **swap < instant).count();
            let (first, last) = (before(arrival.first_part_at), before(arrival.last_part_at));
            assert_eq!(first, last, "{case}: swapped while {:?} came", arrival.target.region);
            (u64::from(arrival.target.buffer) + first as u64) % 2
        });
        // The buffers take turns, so the number of swaps determines which buffer is hidden during all regions of a
        // frame.
        let which: Vec<u64> = written.collect();
        assert!(which.iter().all(|buffer| *buffer == which[0]), "{case}: {surface:?}");
    }
}

/// Checks all promises about a machine during a run.
#[test]
fn the_rules_of_the_ring_hold_and_every_region_arrives_on_random_machines() {
    let (mut ran, mut swapped) = (0, 0);
    each_case(support::sample_or_all(24, 60), SHORT, |experiment, case| {
        let (outcome, error) = outcome(experiment, case);
        // A machine that a pipeline cannot use must be refused with a reason. Such a machine must never come to a
        // deadlock.
        assert!(!matches!(error, Some(RunError::Deadlock { .. } | RunError::Ring { .. })), "{case}: {error:?}");
        assert_the_ring_is_a_ring(&outcome, case);
        assert_every_region_arrives_once(&outcome, case);
        if case.contains("pipeline=rendering-control") {
            assert_no_shown_buffer_is_written(&outcome, case);
            swapped += outcome.record().observation().swaps.len();
        }
        ran += u64::from(!outcome.record().observation().arrivals.is_empty());
    });
    assert!(ran > 0 && swapped > 0, "{ran} ran, {swapped} swaps");
}

#[test]
fn no_number_of_a_report_depends_on_ties_optimizations_or_threads_on_random_machines() {
    each_case(5, SHORT, |experiment, case| {
        let expected = report(experiment, case);
        for seed in 1..4 {
            assert_eq!(report(&experiment.clone().shuffle_ties(seed), case), expected, "{case}, ties {seed}");
        }
        // Without the optimization `IdleBoards`, runs take minutes, so `tests/optimizations.rs` covers it.
        for saving in Optimization::ALL.into_iter().filter(|saving| *saving != Optimization::IdleBoards) {
            assert_eq!(report(&experiment.clone().without(saving), case), expected, "{case}, without {saving}");
        }
    });
}

#[test]
fn no_pixel_depends_on_threads_on_random_machines() {
    each_case(3, SHORT, |experiment, case| {
        let (lazy, _) = outcome(&experiment.clone().pixels(Pixels::Lazy), case);
        for threads in [0, 1, 3] {
            let host = Workstation::with_threads(threads);
            let (all, _) = outcome(&experiment.clone().pixels(Pixels::All).host(host), case);
            assert_eq!(all.record().trace_hash(), lazy.record().trace_hash(), "{case}, {threads} threads");
            for (surface, _) in lazy.record().surfaces() {
                assert!(all.picture(surface) == lazy.picture(surface), "{case}, {threads} threads: {surface:?}");
            }
        }
    });
}

fn number(value: &Value) -> Option<f64> {
    value.as_f64()
}

fn whole(value: &Value, what: &str, case: &str) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("{case}: {what}: {value}"))
}

/// Checks every object with statistics in a report. Without values it has no numbers, and otherwise the numbers are in
/// order.
fn assert_statistics_are_in_order(path: &str, value: &Value, case: &str) {
    match value {
        Value::Object(fields) => {
            let of = |name: &str| fields.get(name).and_then(number);
            if let Some(n) = fields.get("n").and_then(Value::as_u64).filter(|_| fields.contains_key("mean")) {
                let names =
                    ["mean", "min", "p50", "p90", "p99", "max"].into_iter().filter(|name| fields.contains_key(*name));
                assert!(names.clone().all(|name| of(name).is_some() == (n > 0)), "{case}: {path}: {value}");
                // The mean of equal numbers may differ from them in its last digits.
                let near = |a: f64, b: f64| a <= b + 1e-9 * (a.abs() + b.abs() + 1e-3);
                let in_order: Vec<f64> = names.filter(|name| *name != "mean").filter_map(of).collect();
                assert!(in_order.windows(2).all(|pair| pair[0] <= pair[1]), "{case}: {path}: {value}");
                if let (Some(mean), Some(max)) = (of("mean"), of("max")) {
                    assert!(
                        near(mean, max) && near(of("min").unwrap_or(f64::NEG_INFINITY), mean),
                        "{case}: {path}: {value}"
                    );
                }
                if fields.contains_key("sd") {
                    assert_eq!(of("sd").is_some(), n > 1, "{case}: {path}: {value}");
                    assert!(of("sd").is_none_or(|sd| sd >= 0.0), "{case}: {path}: {value}");
                }
            }
            fields
                .iter()
                .for_each(|(key, value)| assert_statistics_are_in_order(&format!("{path}/{key}"), value, case));
        }
        Value::Array(values) => values.iter().for_each(|value| assert_statistics_are_in_order(path, value, case)),
        _ => {}
    }
}

/// Checks that every due picture has one result, that all counts cover the same window, and that no display shows more
/// than one picture a period.
fn assert_counts_add_up(report: &Value, field_ms: f64, case: &str) {
    let fields = whole(&report["fields"], "fields", case);
    let window = &report["window"];
    let of = |name: &str| whole(&report["due"][name], name, case);
    if window.is_null() {
        assert!(report["due"].is_null() && report["updates_hz"].is_null(), "{case}: {report}");
        assert_eq!(report["pictures"], 0, "{case}");
    } else {
        let [first, last] = ["first_period", "last_period"].map(|name| whole(&window[name], name, case));
        assert!(WARM_UP_PERIODS <= first && first <= last && last < fields, "{case}: {window}");
        if !report["due"].is_null() {
            assert_eq!([of("first_period"), of("last_period")], [first, last], "{case}");
            assert_eq!(last + 1 - first, of("due") * of("periods_a_picture"), "{case}: {}", report["due"]);
        }
    }
    if !report["due"].is_null() {
        let ends = of("shown") + of("late") + of("incomplete") + of("missed");
        assert_eq!(ends, of("due"), "{case}: {}", report["due"]);
        assert_eq!(report["missed_retraces"], of("due") - of("shown"), "{case}");
        assert!(report["updates_hz"].is_null() || of("shown") > 1, "{case}: one picture has no rate");
    }
    let pictures = whole(&report["pictures"], "pictures", case);
    assert!(pictures <= whole(&report["shown"], "shown", case), "{case}");
    assert_eq!(report["latency_ms"]["n"], pictures, "{case}");
    let rates = report["arp"]["memories"].as_array().into_iter().flatten().chain([report]);
    for rate in rates.filter_map(|of| number(&of["updates_hz"])) {
        assert!(pictures > 1 && rate > 0.0 && rate <= (1.0 + 1e-9) * 1e3 / field_ms, "{case}: {rate} Hz");
    }
}

/// Checks that each pixel of the grid is evaluated or counted with one reason. No pixel is evaluated if no due picture
/// was shown.
fn assert_errors_are_of_what_was_shown(report: &Value, case: &str) {
    let error = &report["head"]["error"];
    let of = |name: &str| whole(&error[name], name, case);
    let periods = match &report["window"] {
        Value::Null => 0,
        window => whole(&window["last_period"], "last", case) + 1 - whole(&window["first_period"], "first", case),
    };
    let all = ["evaluated", "behind", "empty", "incomplete", "before"].map(of).iter().sum::<u64>();
    assert_eq!(all, 25 * periods, "{case}: {error}");
    assert_eq!(error["pixels"]["n"], of("evaluated"), "{case}");
    let shown = report["due"]["shown"].as_u64().unwrap_or(1);
    assert!(shown > 0 || (of("evaluated"), of("behind")) == (0, 0), "{case}: {error}");
    let budget = &report["head"]["end_to_end"];
    let stages = ["tracking_ms", "waiting_ms", "sending_ms", "drawing_ms", "showing_ms", "scanning_ms", "lighting_ms"];
    let sum = stages.map(|stage| number(&budget[stage])).into_iter().sum::<Option<f64>>();
    let differs = sum.zip(number(&budget["head_to_light_ms"])).map_or(0.0, |(sum, total)| (sum - total).abs());
    assert!(sum.is_some() == (budget["n"] != 0) && differs < 1e-6, "{case}: {budget}");
    assert!(whole(&budget["n"], "n", case) <= whole(&report["pictures"], "pictures", case), "{case}");
}

/// Checks that the table of pictures has exactly the pictures in the report's latency.
fn assert_the_table_of_pictures_agrees(outcome: &Outcome, report: &Value, case: &str) {
    let text = pxpl5::views::results::csv(outcome);
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("names").split(',').collect();
    let rows: Vec<BTreeMap<&str, &str>> =
        lines.map(|line| names.iter().copied().zip(line.split(',')).collect()).collect();
    let complete = rows.iter().filter(|row| row["complete"] == "1");
    assert_eq!(report["shown"], complete.clone().count() as u64, "{case}");
    let steady = complete.filter(|row| row["steady"] == "1");
    let latency = |row: &BTreeMap<&str, &str>| row["latency_ps"].parse::<f64>().expect("a picture in time") * 1e-9;
    let latencies = Statistics::of(steady.map(latency));
    assert_eq!(report["latency_ms"]["n"], latencies.n, "{case}");
    for (name, expected) in [("mean", latencies.mean), ("min", latencies.min), ("max", latencies.max)] {
        let found = number(&report["latency_ms"][name]);
        assert_eq!(found.is_some(), latencies.n > 0, "{case}: {name}");
        assert!(found.is_none_or(|found| (found - expected).abs() < 1e-9), "{case}: {name} {found:?} {expected}");
    }
}

/// JSON and the table of pictures must agree, and contain nothing about pictures that were not shown.
#[test]
fn reports_of_random_runs_are_consistent() {
    let (mut shown, mut heavy, mut heads, mut without_window) = (0, 0, 0, 0);
    each_case(support::sample_or_all(20, 40), REPORTED, |experiment, case| {
        let (outcome, _) = outcome(&experiment.clone().record_traffic(false), case);
        let report = serde_json::to_value(outcome.report()).expect("it is data");
        assert_statistics_are_in_order("", &report, case);
        assert_counts_add_up(&report, outcome.field_ms(), case);
        if !report["head"].is_null() {
            assert_errors_are_of_what_was_shown(&report, case);
        }
        assert_the_table_of_pictures_agrees(&outcome, &report, case);
        shown += u64::from(report["latency_ms"]["n"] != 0);
        heavy += u64::from(report["due"]["shown"] == 0);
        heads += u64::from(!report["head"].is_null());
        without_window += u64::from(report["window"].is_null());
    });
    assert!(shown > 0 && heavy > 0 && heads > 0 && without_window > 0, "{shown} {heavy} {heads} {without_window}");
}

/// Calls `check` for a number of machines that can be built, times `PXPL5_FUZZ`.
fn each_case(machines: u64, sizes: Sizes, mut check: impl FnMut(&Experiment, &str)) {
    /// Number of random experiments of which at least one can be built.
    const TRIES: u64 = 20;
    let first = setting("PXPL5_FUZZ_FROM", 0);
    let machines = machines * setting("PXPL5_FUZZ", 1);
    let mut built = 0;
    for (experiment, case) in
        (first..first + TRIES * machines).filter_map(|round| case(round, sizes)).take(machines as usize)
    {
        if first > 0 {
            // A test that hangs prints nothing at its end, so the case is printed before it runs.
            println!("{case}");
        }
        built += 1;
        check(&experiment, &case);
    }
    assert_eq!(built, machines, "machines of {TRIES} times as many could be built");
}
