//! Content of a trace, before it is written.

use pxpl5_sim::Time;
use pxpl5_wire::PictureNumber;

/// A run as a set of tracks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trace {
    /// Origin of the trace: the facts from which the trace can be reproduced, as pairs of key and value.
    pub origin: Vec<(&'static str, String)>,
    /// Names of the groups: boards, surfaces and others.
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
    /// Slices that do not overlap.
    Slices(Vec<Slice>),
    /// Instants with their names.
    Instants(Vec<(Time, String)>),
    /// Values of a counter. Each value is valid from its time until the next value.
    Counter(Vec<(Time, i64)>),
}

/// An event with a duration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slice {
    /// Name inside the slice.
    pub name: String,
    /// Time at which the slice begins.
    pub begin: Time,
    /// Time at which the slice ends.
    pub end: Time,
    /// Number of the frame, field or update to which the slice belongs.
    pub picture: Option<PictureNumber>,
    /// Position of the slice in a flow, a chain of arrows between slices. `None` if the slice is not in a flow.
    pub flow: Option<Flow>,
}

/// Position of a slice in the flow of a picture, the chain of arrows from SEND to the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flow {
    /// Number of the flow, which is the picture's number plus 1.
    pub id: u64,
    /// Position of the slice among the slices of the flow.
    pub step: Step,
}

/// Position of a slice among the slices of a flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// First slice of the flow.
    First,
    /// Slice between the first and the last.
    Middle,
    /// Last slice of the flow.
    Last,
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
