//! A run as tracks, before it is written.

use pxpl5_sim::Time;
use pxpl5_wire::PictureNumber;

/// A run as tracks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trace {
    /// What it can be made again from.
    pub origin: Vec<(&'static str, String)>,
    /// Names of boards and other groups of tracks.
    pub groups: Vec<String>,
    /// The tracks, those of a group one after the other.
    pub tracks: Vec<Track>,
}

/// A line of a trace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Track {
    /// Index of its group.
    pub group: usize,
    /// What stands left of it.
    pub name: String,
    /// What happens on it, in order of time.
    pub events: Events,
}

/// What happens on a track.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Events {
    /// Slices that do not overlap.
    Slices(Vec<Slice>),
    /// Instants, each with the name that stands at it.
    Instants(Vec<(Time, String)>),
    /// Values from a time on.
    Counter(Vec<(Time, i64)>),
}

/// Something that takes time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slice {
    /// What stands in it.
    pub name: String,
    /// The instant at which it begins.
    pub begin: Time,
    /// When it is over.
    pub end: Time,
    /// The frame, field or update that it belongs to.
    pub picture: Option<PictureNumber>,
    /// Its place in a flow.
    pub flow: Option<Flow>,
}

/// A place on the way of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flow {
    /// Number of the flow: one more than the picture's.
    pub id: u64,
    /// Where on the way.
    pub step: Step,
}

/// Where on its way a flow is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Where the message sets out.
    First,
    /// Between begin and end.
    Middle,
    /// Where the message has arrived.
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
