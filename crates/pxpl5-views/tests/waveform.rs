//! Tests of waveforms, which the reader of another author (the crate `vcd`) reads back.

use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, Outcome, Pixels, RenderingControl};
use pxpl5_scene::builtin;
use pxpl5_sim::Time;
use pxpl5_views::trace_export::{Events, Trace, vcd};
use std::collections::BTreeMap;
use std::sync::LazyLock;
use vcd::{Command, Parser, ScopeItem, Value};

static OUTCOME: LazyLock<Outcome> = LazyLock::new(|| {
    let scene = builtin("full-screen:30").expect("built in");
    let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene);
    experiment.fields(30).pixels(Pixels::Off).record_traffic(true).run().expect("runs")
});

/// Values of a signal with their times, by `scope.signal`. A picture's number, a counter and a bit are numbers.
type Signals = BTreeMap<String, Vec<(u64, Option<i64>)>>;

fn read(trace: &Trace, span: [Time; 2]) -> Signals {
    let mut bytes = Vec::new();
    vcd(trace, span, &mut bytes).expect("memory can be written");
    let mut parser = Parser::new(&bytes[..]);
    let header = parser.parse_header().expect("a header");
    assert_eq!(header.timescale, Some((1, vcd::TimescaleUnit::PS)));
    let mut names = BTreeMap::new();
    for scope in &header.items {
        let ScopeItem::Scope(scope) = scope else { continue };
        for item in &scope.items {
            let ScopeItem::Var(var) = item else { panic!("{item:?}") };
            names.insert(var.code, format!("{}.{}", scope.identifier, var.reference));
        }
    }
    let (mut signals, mut now) = (Signals::new(), None);
    for command in parser {
        let (id, value) = match command.expect("a command") {
            Command::Timestamp(time) => {
                assert!(now.is_none_or(|before| before < time), "time goes on");
                now = Some(time);
                continue;
            }
            Command::ChangeScalar(id, value) => (id, Some(i64::from(value == Value::V1))),
            Command::ChangeVector(id, bits) if bits.iter().all(|bit| bit != Value::X) => {
                (id, Some(bits.iter().fold(0, |sum, bit| 2 * sum + i64::from(bit == Value::V1))))
            }
            Command::ChangeVector(id, _) => (id, None),
            _ => continue,
        };
        signals.entry(names[&id].clone()).or_default().push((now.expect("a time"), value));
    }
    signals
}

#[test]
fn a_waveform_has_every_slice_counter_and_retrace_of_the_trace_to_the_picosecond() {
    let trace = Trace::of(&OUTCOME);
    let signals = read(&trace, [Time::ZERO, Time(u64::MAX)]);
    let mut kinds = [0; 3];
    for track in &trace.tracks {
        let name = format!("{}.{}", trace.groups[track.group], track.name).replace(' ', "_");
        let values = &signals[&name];
        match &track.events {
            Events::Slices(slices) => {
                // Slices without a duration are not visible, and slices that touch are one pulse.
                let mut expected: Vec<[u64; 2]> = Vec::new();
                for slice in slices.iter().filter(|slice| slice.begin < slice.end) {
                    match expected.last_mut().filter(|last| last[1] == slice.begin.0) {
                        Some(last) => last[1] = slice.end.0,
                        None => expected.push([slice.begin.0, slice.end.0]),
                    }
                }
                // A pulse is a 1 that repeats until the next 0.
                let mut pulses: Vec<[u64; 2]> = Vec::new();
                let mut since = None;
                for (time, value) in values {
                    match (since, value) {
                        (None, Some(1)) => since = Some(*time),
                        (Some(begin), Some(0)) => {
                            pulses.push([begin, *time]);
                            since = None;
                        }
                        _ => {}
                    }
                }
                assert_eq!(pulses, expected, "{name}");
                kinds[0] += pulses.len();
            }
            Events::Instants(instants) => {
                assert!(values.iter().map(|(time, _)| *time).eq(instants.iter().map(|(time, _)| time.0)), "{name}");
                kinds[1] += instants.len();
            }
            Events::Counter(counts) => {
                let last: BTreeMap<u64, i64> = counts.iter().map(|(time, value)| (time.0, *value)).collect();
                let expected: Vec<(u64, Option<i64>)> =
                    last.into_iter().map(|(time, value)| (time, Some(value))).collect();
                assert_eq!(*values, expected, "{name}");
                kinds[2] += values.len();
            }
        }
    }
    assert!(kinds.iter().all(|count| *count > 30), "{kinds:?}");
}

#[test]
fn a_waveform_of_one_span_begins_with_the_values_at_its_begin_and_ends_with_it() {
    let whole = read(&Trace::of(&OUTCOME), [Time::ZERO, Time(u64::MAX)]);
    let span = [Time(150_000_000_000), Time(200_000_000_000)];
    let part = read(&Trace::of(&OUTCOME).between(span), span);
    assert!(part.len() > 20);
    for (name, values) in &part {
        let is_within = |time: u64| (span[0].0..=span[1].0).contains(&time);
        assert!(values.iter().all(|(time, _)| is_within(*time)), "{name}");
        let changes = |values: &[(u64, Option<i64>)]| {
            let mut changes = values.to_vec();
            changes.dedup_by_key(|(_, value)| *value);
            changes.retain(|(time, _)| *time > span[0].0 && is_within(*time));
            changes
        };
        // Events have no values.
        if !name.ends_with("swaps") && !name.ends_with("retraces") {
            assert_eq!(changes(values), changes(&whole[name]), "{name}");
            let before = whole[name].iter().rev().find(|(time, _)| *time <= span[0].0);
            assert_eq!(values.first().map(|(_, value)| *value), before.map(|(_, value)| *value), "{name}");
        }
    }
}
