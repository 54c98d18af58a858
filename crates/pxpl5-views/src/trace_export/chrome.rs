//! Writer of Chrome's trace event format (JSON).

use super::model::{Events, Slice, Step, Trace, Track};
use pxpl5_sim::Time;
use serde_json::{Map, Value, json};
use std::io::{self, Write};

/// Writes a trace as Chrome's JSON: an object with `traceEvents`, one event per line, and the origin in `otherData`.
///
/// # Errors
///
/// Returns any error of the writer `out`.
pub fn chrome(trace: &Trace, mut out: impl Write) -> io::Result<()> {
    let origin: Map<String, Value> = trace.origin.iter().map(|(key, value)| ((*key).into(), json!(value))).collect();
    write!(out, "{{\"displayTimeUnit\":\"ns\",\"otherData\":{},\n\"traceEvents\":[", Value::Object(origin))?;
    let mut separator = "\n";
    for event in names(trace).into_iter().chain(trace.tracks.iter().enumerate().flat_map(|(i, t)| events(i, t))) {
        write!(out, "{separator}{event}")?;
        separator = ",\n";
    }
    writeln!(out, "\n]}}")?;
    out.flush()
}

/// Returns a time in microseconds as exact text with six decimals. A JSON library would round the number.
fn us(ps: u64) -> String {
    format!("{}.{:06}", ps / 1_000_000, ps % 1_000_000)
}

fn names(trace: &Trace) -> Vec<String> {
    let groups = trace.groups.iter().enumerate().flat_map(|(i, name)| {
        let name = json!({"name": "process_name", "ph": "M", "pid": i + 1, "args": {"name": name}});
        [name, json!({"name": "process_sort_index", "ph": "M", "pid": i + 1, "args": {"sort_index": i}})]
    });
    let tracks = trace.tracks.iter().enumerate().map(|(i, track)| {
        json!({"name": "thread_name", "ph": "M", "pid": track.group + 1, "tid": i + 1, "args": {"name": track.name}})
    });
    groups.chain(tracks).map(|event| event.to_string()).collect()
}

/// Returns an event of the trace as a JSON object. `rest` is the text of additional members of this object.
fn event(place: &str, kind: &str, time: Time, name: &str, rest: &str) -> String {
    format!(r#"{{"name":{},"ph":"{kind}","ts":{},{place}{rest}}}"#, json!(name), us(time.0))
}

fn events(number: usize, track: &Track) -> Vec<String> {
    let place = format!(r#""pid":{},"tid":{}"#, track.group + 1, number + 1);
    match &track.events {
        Events::Slices(slices) => slices.iter().flat_map(|slice| slice_events(&place, slice)).collect(),
        Events::Instants(instants) => {
            instants.iter().map(|(time, name)| event(&place, "i", *time, name, r#","s":"p""#)).collect()
        }
        Events::Counter(values) => {
            values.iter().map(|(time, value)| counter_event(&place, *time, &track.name, *value)).collect()
        }
    }
}

fn counter_event(place: &str, time: Time, name: &str, value: i64) -> String {
    event(place, "C", time, name, &format!(r#","args":{{"value":{value}}}"#))
}

fn slice_events(place: &str, slice: &Slice) -> Vec<String> {
    let args = slice.picture.map_or_else(String::new, |picture| format!(r#","args":{{"picture":{picture}}}"#));
    let rest = format!(r#","dur":{}{args}"#, us((slice.end - slice.begin).0));
    let mut events = vec![event(place, "X", slice.begin, &slice.name, &rest)];
    // A flow event binds the slice to the flow of its picture.
    if let Some(flow) = slice.flow {
        let (kind, bound) = match flow.step {
            Step::First => ("s", ""),
            Step::Middle => ("t", ""),
            Step::Last => ("f", r#","bp":"e""#),
        };
        let rest = format!(r#","cat":"picture","id":{}{bound}"#, flow.id);
        events.push(event(place, kind, slice.begin, "picture", &rest));
    }
    events
}
