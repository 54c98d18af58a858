//! Writer of the Perfetto trace format.

use super::model::{Events, Slice, Step, Trace, Track};
use super::protobuf::Message;
use pxpl5_sim::Time;
use std::io::{self, Write};

/// Numbers of fields and of enumerators from the published `.proto` files.
mod proto {
    pub(super) const TRACE_PACKET: u32 = 1;
    pub(super) const PACKET_TIMESTAMP: u32 = 8;
    pub(super) const PACKET_SEQUENCE_ID: u32 = 10;
    pub(super) const PACKET_TRACK_EVENT: u32 = 11;
    pub(super) const PACKET_SEQUENCE_FLAGS: u32 = 13;
    pub(super) const PACKET_TRACK_DESCRIPTOR: u32 = 60;
    pub(super) const INCREMENTAL_STATE_CLEARED: u64 = 1;
    pub(super) const DESCRIPTOR_UUID: u32 = 1;
    pub(super) const DESCRIPTOR_NAME: u32 = 2;
    pub(super) const DESCRIPTOR_PARENT: u32 = 5;
    pub(super) const DESCRIPTOR_COUNTER: u32 = 8;
    pub(super) const DESCRIPTOR_CHILD_ORDERING: u32 = 11;
    pub(super) const DESCRIPTOR_RANK: u32 = 12;
    pub(super) const ORDERING_EXPLICIT: u64 = 3;
    pub(super) const COUNTER_UNIT: u32 = 3;
    pub(super) const UNIT_COUNT: u64 = 2;
    pub(super) const EVENT_ANNOTATION: u32 = 4;
    pub(super) const EVENT_TYPE: u32 = 9;
    pub(super) const EVENT_TRACK: u32 = 11;
    pub(super) const EVENT_NAME: u32 = 23;
    pub(super) const EVENT_COUNTER_VALUE: u32 = 30;
    pub(super) const EVENT_FLOW: u32 = 47;
    pub(super) const EVENT_LAST_FLOW: u32 = 48;
    pub(super) const SLICE_BEGIN: u64 = 1;
    pub(super) const SLICE_END: u64 = 2;
    pub(super) const INSTANT: u64 = 3;
    pub(super) const COUNTER: u64 = 4;
    pub(super) const ANNOTATION_NUMBER: u32 = 3;
    pub(super) const ANNOTATION_TEXT: u32 = 6;
    pub(super) const ANNOTATION_NAME: u32 = 10;
}
use proto::*;

/// Identifier of the sequence of packets. All packets are in one sequence, because a trace has a single writer.
const SEQUENCE: u64 = 1;

/// Writes a trace in the Perfetto format.
///
/// # Errors
///
/// Returns any error of the writer `out`.
pub fn perfetto(trace: &Trace, mut out: impl Write) -> io::Result<()> {
    // Descriptors of tracks come before their events.
    for packet in descriptors(trace) {
        write(&mut out, packet)?;
    }
    let tracks = trace.tracks.iter().enumerate();
    let mut events: Vec<(u64, Message)> =
        tracks.flat_map(|(i, track)| events(track_uuid(trace, i), &track.events)).collect();
    events.push((0, origin(trace)));
    // The sort is stable, so an end stays before a begin of the same time on the same track.
    events.sort_by_key(|event| event.0);
    for (ns, event) in events {
        let packet = Message::default().number(PACKET_TIMESTAMP, ns).message(PACKET_TRACK_EVENT, &event);
        write(&mut out, packet)?;
    }
    out.flush()
}

fn write(out: &mut impl Write, packet: Message) -> io::Result<()> {
    let packet = packet.number(PACKET_SEQUENCE_ID, SEQUENCE);
    out.write_all(&Message::default().message(TRACE_PACKET, &packet).0)
}

const fn ns(time: Time) -> u64 {
    time.0 / 1_000
}

/// Returns the identifier of a group's track. Tracks of groups have the lowest identifiers, from 1 on, because zero is
/// not a valid identifier.
const fn group_uuid(group: usize) -> u64 {
    group as u64 + 1
}

fn track_uuid(trace: &Trace, track: usize) -> u64 {
    group_uuid(trace.groups.len() + track)
}

fn descriptors(trace: &Trace) -> Vec<Message> {
    let groups = trace.groups.iter().enumerate().map(|(i, name)| group_descriptor(i, name));
    let tracks = trace.tracks.iter().enumerate().map(|(i, track)| track_descriptor(trace, i, track));
    let mut packets: Vec<Message> = groups
        .chain(tracks)
        .map(|descriptor| Message::default().message(PACKET_TRACK_DESCRIPTOR, &descriptor))
        .collect();
    if let Some(first) = packets.first_mut() {
        *first = std::mem::take(first).number(PACKET_SEQUENCE_FLAGS, INCREMENTAL_STATE_CLEARED);
    }
    packets
}

fn group_descriptor(group: usize, name: &str) -> Message {
    Message::default()
        .number(DESCRIPTOR_UUID, group_uuid(group))
        .text(DESCRIPTOR_NAME, name)
        .number(DESCRIPTOR_CHILD_ORDERING, ORDERING_EXPLICIT)
        .number(DESCRIPTOR_RANK, group as u64)
}

fn track_descriptor(trace: &Trace, number: usize, track: &Track) -> Message {
    let descriptor = Message::default()
        .number(DESCRIPTOR_UUID, track_uuid(trace, number))
        .text(DESCRIPTOR_NAME, &track.name)
        .number(DESCRIPTOR_PARENT, group_uuid(track.group))
        .number(DESCRIPTOR_RANK, number as u64);
    match track.events {
        Events::Counter(_) => {
            descriptor.message(DESCRIPTOR_COUNTER, &Message::default().number(COUNTER_UNIT, UNIT_COUNT))
        }
        Events::Slices(_) | Events::Instants(_) => descriptor,
    }
}

fn event(kind: u64, track: u64) -> Message {
    Message::default().number(EVENT_TYPE, kind).number(EVENT_TRACK, track)
}

fn events(track: u64, events: &Events) -> Vec<(u64, Message)> {
    match events {
        Events::Slices(slices) => slices.iter().flat_map(|slice| ends(track, slice)).collect(),
        Events::Instants(instants) => {
            instants.iter().map(|(time, name)| (ns(*time), event(INSTANT, track).text(EVENT_NAME, name))).collect()
        }
        Events::Counter(values) => values.iter().map(|(time, value)| (ns(*time), counted(track, *value))).collect(),
    }
}

fn counted(track: u64, value: i64) -> Message {
    event(COUNTER, track).number(EVENT_COUNTER_VALUE, value.cast_unsigned())
}

/// Returns the two Perfetto events that mark the start and the end of a slice, which is an event with a duration.
fn ends(track: u64, slice: &Slice) -> [(u64, Message); 2] {
    [(ns(slice.begin), begin(track, slice)), (ns(slice.end), event(SLICE_END, track))]
}

fn begin(track: u64, slice: &Slice) -> Message {
    let mut event = event(SLICE_BEGIN, track).text(EVENT_NAME, &slice.name);
    if let Some(flow) = slice.flow {
        let field = if flow.step == Step::Last { EVENT_LAST_FLOW } else { EVENT_FLOW };
        event = event.fixed64(field, flow.id);
    }
    let Some(picture) = slice.picture else { return event };
    let picture = Message::default().text(ANNOTATION_NAME, "picture").number(ANNOTATION_NUMBER, picture.0);
    event.message(EVENT_ANNOTATION, &picture)
}

/// Returns an event at time zero that contains the origin of the trace. The event is on the track of the last group.
fn origin(trace: &Trace) -> Message {
    let event = event(INSTANT, group_uuid(trace.groups.len() - 1));
    trace.origin.iter().fold(event.text(EVENT_NAME, "origin"), |event, (key, value)| {
        event.message(EVENT_ANNOTATION, &Message::default().text(ANNOTATION_NAME, key).text(ANNOTATION_TEXT, value))
    })
}
