//! The Perfetto trace format.

use super::protobuf::Message;
use super::{Events, Slice, Step, Trace, Track};
use pxpl5_sim::Time;
use std::io::{self, Write};

/// Field numbers and enumerators of the published `.proto` files.
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

/// The only writer of packets.
const SEQUENCE: u64 = 1;

/// Writes a trace in the Perfetto format.
///
/// # Errors
///
/// When the writer fails.
pub fn perfetto(trace: &Trace, mut out: impl Write) -> io::Result<()> {
    for packet in descriptors(trace) {
        write(&mut out, packet)?;
    }
    let mut events: Vec<(u64, Message)> =
        trace.tracks.iter().enumerate().flat_map(|(i, track)| events(trace, i, track)).collect();
    events.push((0, origin(trace)));
    // The sort is stable: on a track, an end stays before a begin of the same time.
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

/// Tracks of groups come first; zero means none.
const fn group_uuid(group: usize) -> u64 {
    group as u64 + 1
}

fn track_uuid(trace: &Trace, track: usize) -> u64 {
    group_uuid(trace.groups.len() + track)
}

fn descriptors(trace: &Trace) -> Vec<Message> {
    let groups = trace.groups.iter().enumerate().map(|(i, name)| {
        let group = Message::default().number(DESCRIPTOR_UUID, group_uuid(i)).text(DESCRIPTOR_NAME, name);
        group.number(DESCRIPTOR_CHILD_ORDERING, ORDERING_EXPLICIT).number(DESCRIPTOR_RANK, i as u64)
    });
    let tracks = trace.tracks.iter().enumerate().map(|(i, track)| {
        let descriptor = Message::default()
            .number(DESCRIPTOR_UUID, track_uuid(trace, i))
            .text(DESCRIPTOR_NAME, &track.name)
            .number(DESCRIPTOR_PARENT, group_uuid(track.group))
            .number(DESCRIPTOR_RANK, i as u64);
        let Events::Counter(_) = track.events else { return descriptor };
        descriptor.message(DESCRIPTOR_COUNTER, &Message::default().number(COUNTER_UNIT, UNIT_COUNT))
    });
    let packet = |(i, descriptor)| {
        let packet = Message::default().message(PACKET_TRACK_DESCRIPTOR, &descriptor);
        if i == 0 { packet.number(PACKET_SEQUENCE_FLAGS, INCREMENTAL_STATE_CLEARED) } else { packet }
    };
    groups.chain(tracks).enumerate().map(packet).collect()
}

fn events(trace: &Trace, number: usize, track: &Track) -> Vec<(u64, Message)> {
    let event = |kind| Message::default().number(EVENT_TYPE, kind).number(EVENT_TRACK, track_uuid(trace, number));
    match &track.events {
        Events::Slices(slices) => slices
            .iter()
            .flat_map(|slice| [(ns(slice.begin), begin(event(SLICE_BEGIN), slice)), (ns(slice.end), event(SLICE_END))])
            .collect(),
        Events::Instants(instants) => {
            instants.iter().map(|(time, name)| (ns(*time), event(INSTANT).text(EVENT_NAME, name))).collect()
        }
        Events::Counter(values) => {
            let value = |value: i64| event(COUNTER).number(EVENT_COUNTER_VALUE, value.cast_unsigned());
            values.iter().map(|(time, v)| (ns(*time), value(*v))).collect()
        }
    }
}

fn begin(event: Message, slice: &Slice) -> Message {
    let mut event = event.text(EVENT_NAME, &slice.name);
    if let Some(flow) = slice.flow {
        let field = if flow.step == Step::Last { EVENT_LAST_FLOW } else { EVENT_FLOW };
        event = event.fixed64(field, flow.id);
    }
    let Some(picture) = slice.picture else { return event };
    let picture = Message::default().text(ANNOTATION_NAME, "picture").number(ANNOTATION_NUMBER, picture);
    event.message(EVENT_ANNOTATION, &picture)
}

/// An instant at time zero that carries what the trace can be made again from; on the last group's own track.
fn origin(trace: &Trace) -> Message {
    let event = Message::default().number(EVENT_TYPE, INSTANT).number(EVENT_TRACK, group_uuid(trace.groups.len() - 1));
    trace.origin.iter().fold(event.text(EVENT_NAME, "origin"), |event, (key, value)| {
        event.message(EVENT_ANNOTATION, &Message::default().text(ANNOTATION_NAME, key).text(ANNOTATION_TEXT, value))
    })
}
