//! A run as a trace for viewers: the Perfetto trace format and Chrome's JSON, both opened by ui.perfetto.dev.
//!
//! [`Trace::of`] collects tracks from what was observed; [`perfetto`] and [`chrome`] write them. Record messages with
//! [`Experiment::record_traffic`](crate::Experiment::record_traffic), else tracks and counters of the ring and the
//! FIFOs are left out.
//!
//! | group | tracks |
//! |---|---|
//! | host, each GP | a track for each of its stages; messages in and out |
//! | each renderer | messages in and out; counter: words of whole commands that wait in its FIFO |
//! | each frame buffer | regions as they arrive; swaps as instants |
//! | ring | counter: occupied channels |
//! | video | fields with the picture they show; retraces as instants |
//!
//! Flow arrows lead from a picture's SEND through its stages to the first field that shows it.
//!
//! Time is simulated time. Chrome's JSON has microseconds with six decimals, which is exact; Perfetto's timestamps are
//! nanoseconds, rounded down. The slices of a track never overlap: a message that reaches its port up to a few hops
//! before the one before it has left is drawn from that one's end.
//!
//! Sources: the published `.proto` files of the Perfetto project (`TracePacket`, `TrackDescriptor`, `TrackEvent`) and
//! the description of Chrome's trace event format. **Not written:** interned strings, clock snapshots.

mod chrome;
mod collect;
mod flows;
mod perfetto;
mod protobuf;

pub use chrome::chrome;
pub use perfetto::perfetto;

use pxpl5_sim::Time;

/// A run as tracks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trace {
    /// What it can be made again from.
    pub origin: Vec<(&'static str, String)>,
    /// Boards and other groups of tracks.
    pub groups: Vec<String>,
    /// The tracks.
    pub tracks: Vec<Track>,
}

/// A line of a trace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Track {
    /// Index of its group.
    pub group: usize,
    /// Its name.
    pub name: String,
    /// What happens on it, in order of time.
    pub events: Events,
}

/// What happens on a track.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Events {
    /// Slices that do not overlap.
    Slices(Vec<Slice>),
    /// Instants with names.
    Instants(Vec<(Time, String)>),
    /// Values from a time on.
    Counter(Vec<(Time, i64)>),
}

/// Something that takes time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slice {
    /// Its name.
    pub name: String,
    /// Begin.
    pub begin: Time,
    /// End.
    pub end: Time,
    /// The frame, field or update that it belongs to.
    pub picture: Option<u64>,
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
    /// At its begin.
    First,
    /// On its way.
    Middle,
    /// At its end.
    Last,
}
