//! Machines that nobody built: every pipeline on every display that it draws for, with numbers of boards and parameters from all over
//! what is allowed. What ARCHITECTURE.md promises is so on them too.
//!
//! Each case follows from a number, so that a failure names it; `PXPL5_FUZZ=100` tries a hundred times as many,
//! `PXPL5_FUZZ_FROM` begins elsewhere.

use pxpl5::firmware::NodeId;
use pxpl5::{
    Experiment, ExperimentError, ExperimentFile, MachineConfig, Measured, Outcome, Pixels, RunError, Saving, Time,
    Transfer, Workstation, registry,
};
use std::collections::BTreeMap;

/// SplitMix64: a stream of numbers that follows from its begin.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ z >> 31
    }

    fn between(&mut self, least: u64, most: u64) -> u64 {
        least + self.next() % (most - least + 1)
    }

    fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.between(0, list.len() as u64 - 1) as usize]
    }
}

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |text| text.parse().unwrap_or_else(|_| panic!("{name}={text}")))
}

/// An experiment and what it was made of; `None` where the machine refuses its numbers or has not what the pipeline needs.
fn case(round: u64) -> Option<(Experiment, String)> {
    let mut dice = Dice(round << 8 | 7);
    let registry = registry();
    let mut file = ExperimentFile::new();
    let mut told = Vec::new();
    let mut set = |text: String| {
        let accepted = file.set_text(&text, "case").is_ok();
        told.push(if accepted { text } else { format!("({text})") });
    };
    let pipelines = registry.pipelines();
    set(format!("pipeline={}", pipelines[(round % pipelines.len() as u64) as usize].name));
    if dice.between(0, 3) == 0 {
        let displays = registry.displays();
        set(format!("display={}", displays[dice.between(0, displays.len() as u64 - 1) as usize].name));
    }
    set(format!("scene={}", dice.of(&["full-screen:2", "mig", "molecules", "typical:40", "sphere:60"])));
    set(format!("triangles={}", dice.between(4, 40)));
    set(format!("fields={}", dice.between(9, 18)));
    set(format!("machine.n_gps={}", dice.of(&[2, 3, 4, 7, 13, 31])));
    set(format!("machine.n_renderers={}", dice.of(&[1, 2, 3, 5, 9, 20])));
    set(format!("seed={}", dice.between(1, 9)));
    if dice.between(0, 2) == 0 {
        set(format!("head.motion=synthetic:{}", dice.between(1, 9)));
    }
    let mut parameters = MachineConfig::small_hmd().parameters();
    parameters.retain(|parameter| !parameter.read_only);
    for _ in 0..dice.between(0, 5) {
        let parameter = &parameters[dice.between(0, parameters.len() as u64 - 1) as usize];
        // Half of them lie in the range of the sources, half anywhere.
        let bounds = dice.of(&[parameter.info.range, parameter.info.limits]);
        let (Some(least), Some(most)) = (bounds.0.whole(), bounds.1.whole()) else { continue };
        let size = dice.between(1, 24);
        set(format!("machine.{}={}", parameter.path, (least + dice.next() % (1 << size)).min(most)));
    }
    let told = format!("{round}: {}", told.join(" "));
    let plan = file.resolve().ok()?;
    let experiment = plan.experiment(plan.load_scene().ok()?).pixels(Pixels::Off).record_traffic(true);
    experiment.build().is_ok().then_some((experiment, told))
}

/// What came of it, however it ended; a machine that stands still has ended too, but must not.
fn outcome(experiment: &Experiment, told: &str) -> (Outcome, Option<RunError>) {
    match experiment.run() {
        Ok(outcome) => (outcome, None),
        Err(ExperimentError::TooShort { partial, .. }) => (*partial, None),
        Err(ExperimentError::Run { error, partial }) => (*partial, Some(error)),
        Err(error) => panic!("{told}: {error}"),
    }
}

/// The whole report, without what the host makes of it, and how the run ended.
fn report(experiment: &Experiment, told: &str) -> (serde_json::Value, Option<String>) {
    let (outcome, error) = outcome(experiment, told);
    let mut report = serde_json::to_value(outcome.report()).expect("it is data");
    let fields = report.as_object_mut().expect("an object");
    fields.remove("host_seconds");
    // How many events were scheduled in vain depends on ties and savings.
    fields.remove("events");
    (report, error.map(|error| error.to_string()))
}

/// When a message occupied a channel, the port that sends and the port that receives: rule 3 and the table of `pxpl5_ring`.
fn occupied(transfer: &Transfer, outcome: &Outcome) -> (Time, Time) {
    let ring = &outcome.record().config().ring;
    let n_nodes = u64::from(outcome.record().ring().n_nodes());
    let hops = (n_nodes + u64::from(transfer.destination.0) - u64::from(transfer.source.0)) % n_nodes;
    let on_the_way = hops * ring.hop_ns * 1_000;
    let begin = transfer.begin.0 - ring.overhead_words * ring.word_ns * 1_000 - on_the_way;
    (Time(begin), Time(transfer.end.0 - on_the_way))
}

/// The most intervals at one instant; what ends at an instant makes room for what begins there.
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

/// Words take their time, there are only so many channels, a port receives one message at a time, FIFOs hold what they can.
fn assert_the_ring_is_a_ring(outcome: &Outcome, told: &str) {
    let config = outcome.record().config();
    let traffic = outcome.record().observation().traffic.as_ref().expect("it was recorded");
    let mut channels = Vec::new();
    let mut ports: BTreeMap<(&str, u16), Vec<(Time, Time)>> = BTreeMap::new();
    for transfer in &traffic.transfers {
        let (begin, end) = occupied(transfer, outcome);
        let least = (config.ring.overhead_words + u64::from(transfer.words)) * config.ring.word_ns * 1_000;
        assert!(end.0 - begin.0 >= least, "{told}: {transfer:?}");
        channels.push((begin, end));
        ports.entry(("receives", transfer.destination.0)).or_default().push((begin, end));
        ports.entry(("sends", transfer.source.0)).or_default().push((begin, end));
    }
    assert!(most_at_once(&channels) as u64 <= config.ring.channels, "{told}");
    for ((what, port), intervals) in &ports {
        let most = if *what == "sends" { config.ring.source_channels } else { 1 };
        assert!(most_at_once(intervals) as u64 <= most, "{told}: port {port} {what}");
    }
    for renderer in 0..outcome.record().renderers().len() {
        for (time, words) in traffic.fifo_words(renderer) {
            let holds = 0..=config.renderer.fifo_words as i64;
            assert!(holds.contains(&words), "{told}: renderer {renderer} at {time:?}: {words} words");
        }
    }
}

/// Words of an order to a display at most; a region has 16 pixels at least.
const ORDER_WORDS: u32 = 2;

/// What displays count, where they count it, is what came to them; and they could use all of it.
fn assert_every_region_arrives_once(outcome: &Outcome, told: &str) {
    let observation = outcome.record().observation();
    let traffic = observation.traffic.as_ref().expect("it was recorded");
    for display in outcome.record().displays() {
        let counted = |name: &str| display.counters().iter().find(|counter| counter.name == name).map(|c| c.count);
        let is_its = |port: NodeId| display.nodes().contains(&port);
        // Orders to swap are no pixels, and shorter than any that are.
        let is_pixels = |transfer: &&Transfer| is_its(transfer.destination) && transfer.words > ORDER_WORDS;
        let messages = traffic.transfers.iter().filter(is_pixels).count() as u64;
        let regions = observation.arrivals.iter().filter(|arrival| is_its(arrival.target.frame_buffer)).count() as u64;
        assert_eq!(counted("messages").unwrap_or(messages), messages, "{told}: {}", display.name());
        assert_eq!(counted("regions").unwrap_or(regions), regions, "{told}: {}", display.name());
        assert_eq!(display.faults(), (0, None), "{told}: {}", display.name());
    }
}

/// Rendering Control copies into the buffer that is not shown.
fn assert_no_shown_buffer_is_written(outcome: &Outcome, told: &str) {
    let observation = outcome.record().observation();
    for (surface, _) in outcome.record().surfaces() {
        let swaps: Vec<Time> = observation.swaps_of(surface).map(|swap| outcome.record().tick(swap.tick)).collect();
        let arrivals = observation.arrivals.iter().filter(|arrival| arrival.surface == surface);
        let written = arrivals.map(|arrival| {
            let before = |instant: Time| swaps.iter().filter(|swap| **swap < instant).count();
            let (first, last) = (before(arrival.first_part_at), before(arrival.last_part_at));
            assert_eq!(first, last, "{told}: swapped while {:?} came", arrival.target.region);
            (u64::from(arrival.target.buffer) + first as u64) % 2
        });
        // The buffers take turns: which is hidden after how many swaps is the same from the first region to the last.
        let which: Vec<u64> = written.collect();
        assert!(which.iter().all(|buffer| *buffer == which[0]), "{told}: {surface:?}");
    }
}

/// All that is promised of a machine at work, once.
#[test]
fn a_ring_is_a_ring_and_every_region_arrives_on_machines_that_nobody_built() {
    let (mut ran, mut swapped) = (0, 0);
    each_case(60, |experiment, told| {
        let (outcome, error) = outcome(experiment, told);
        // A machine whose numbers a pipeline cannot live with says which: it never just stands still.
        assert!(!matches!(error, Some(RunError::Deadlock { .. } | RunError::Ring { .. })), "{told}: {error:?}");
        assert_the_ring_is_a_ring(&outcome, told);
        assert_every_region_arrives_once(&outcome, told);
        if told.contains("pipeline=rendering-control") {
            assert_no_shown_buffer_is_written(&outcome, told);
            swapped += outcome.record().observation().swaps.len();
        }
        ran += u64::from(!outcome.record().observation().arrivals.is_empty());
    });
    assert!(ran > 0 && swapped > 0, "{ran} ran, {swapped} swaps");
}

#[test]
fn no_number_of_a_report_depends_on_ties_savings_or_threads_on_machines_that_nobody_built() {
    each_case(10, |experiment, told| {
        let expected = report(experiment, told);
        for seed in 1..4 {
            assert_eq!(report(&experiment.clone().shuffle_ties(seed), told), expected, "{told}, ties {seed}");
        }
        // Polling every edge of the clock takes minutes where nothing happens; `tests/savings.rs` does without that one.
        for saving in Saving::ALL.into_iter().filter(|saving| *saving != Saving::IdleBoards) {
            assert_eq!(report(&experiment.clone().without(saving), told), expected, "{told}, without {saving}");
        }
    });
}

#[test]
fn no_pixel_depends_on_threads_on_machines_that_nobody_built() {
    each_case(6, |experiment, told| {
        let (lazy, _) = outcome(&experiment.clone().pixels(Pixels::Lazy), told);
        for threads in [0, 1, 3] {
            let host = Workstation::with_threads(threads);
            let (all, _) = outcome(&experiment.clone().pixels(Pixels::All).host(host), told);
            assert_eq!(all.record().trace_hash(), lazy.record().trace_hash(), "{told}, {threads} threads");
            for (surface, _) in lazy.record().surfaces() {
                assert!(all.picture(surface) == lazy.picture(surface), "{told}, {threads} threads: {surface:?}");
            }
        }
    });
}

/// So many machines that can be built, or as many times that as is asked for.
fn each_case(machines: u64, mut check: impl FnMut(&Experiment, &str)) {
    /// Of so many that are thought up one can be built at least.
    const TRIES: u64 = 20;
    let first = setting("PXPL5_FUZZ_FROM", 0);
    let machines = machines * setting("PXPL5_FUZZ", 1);
    let mut built = 0;
    for (experiment, told) in (first..first + TRIES * machines).filter_map(case).take(machines as usize) {
        if first > 0 {
            // What hangs has no last word.
            println!("{told}");
        }
        built += 1;
        check(&experiment, &told);
    }
    assert_eq!(built, machines, "machines of {TRIES} times as many could be built");
}
