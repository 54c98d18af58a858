//! Content of a trace, before it is written.

use pxpl5_sim::Time;
use pxpl5_wire::PictureNumber;

/// A run as a set of tracks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trace {
    /// Origin of the trace: the facts from which the trace can be reproduced, as pairs of key and value.
    pub origin: Vec<(&'static str, String)>,
    /// Names of the groups of tracks: boards, surfaces, the ring and the video of displays.
    pub groups: Vec<String>,
    /// Tracks, sorted by group.
    pub tracks: Vec<Track>,
}

/// A named row of a trace viewer, with the events of this row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Track {
    /// Index of the track's group.
    pub group: usize,
    /// Name on the left of the track.
    pub name: String,
    /// Events, in order of time.
    pub events: Events,
}

/// The events of a track. All events of a track have the same kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Events {
    /// Events with a duration (slices), which do not overlap.
    Slices(Vec<Slice>),
    /// Events without a duration (instants), with their names.
    Instants(Vec<(Time, String)>),
    /// Values of a counter. Each value is valid from its time until the next value.
    Counter(Vec<(Time, i64)>),
}

/// An event with a duration. The formats of trace viewers call such an event a slice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slice {
    /// Name that the trace viewer shows inside the event.
    pub name: String,
    /// Time at which the event begins.
    pub begin: Time,
    /// Time at which the event ends.
    pub end: Time,
    /// Number of the frame, field or update to which the event belongs.
    pub picture: Option<PictureNumber>,
    /// Position of the event in a flow, a chain of arrows between events. `None` if the event is not in a flow.
    pub flow: Option<Flow>,
}

/// Position of an event in the flow of a picture, the chain of arrows from SEND to the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flow {
    /// Number of the flow, which is the picture's number plus 1.
    pub id: u64,
    /// Position of the event among the events of the flow: first, middle or last.
    pub step: Step,
}

/// Position of an event among the events of a flow, a chain of arrows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// First event of the flow.
    First,
    /// Event between the first and the last event of the flow.
    Middle,
    /// Last event of the flow.
    Last,
}

impl Trace {
    /// Returns the trace of the span from `begin` to `end`: slices that overlap it in full length, instants within it,
    /// and counters from their value at `begin`.
    pub fn between(mut self, [begin, end]: [Time; 2]) -> Self {
        for track in &mut self.tracks {
            match &mut track.events {
                Events::Slices(slices) => slices.retain(|slice| slice.end > begin && slice.begin < end),
                Events::Instants(instants) => instants.retain(|(time, _)| (begin..=end).contains(time)),
                Events::Counter(values) => {
                    values.retain(|(time, _)| *time <= end);
                    // The last value before the span is valid at its beginning.
                    let before = values.partition_point(|(time, _)| *time <= begin);
                    values.drain(..before.saturating_sub(1));
                    values.iter_mut().take(before.min(1)).for_each(|(time, _)| *time = begin);
                }
            }
        }
        self.tracks.retain(|track| !track.is_empty());
        self
    }
}

impl Track {
    pub(super) fn is_empty(&self) -> bool {
        match &self.events {
            Events::Slices(slices) => slices.is_empty(),
            Events::Instants(instants) => instants.is_empty(),
            Events::Counter(values) => values.is_empty(),
        }
    }
}
