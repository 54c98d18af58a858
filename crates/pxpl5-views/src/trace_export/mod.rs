//! A run as a trace for viewers: the Perfetto trace format and Chrome's JSON, both opened by ui.perfetto.dev.
//!
//! [`Trace::of`] collects tracks from what was observed; [`perfetto`] and [`chrome`] write them. Record messages with
//! [`Experiment::record_traffic`](pxpl5_run::Experiment::record_traffic), else tracks and counters of the ring and the
//! FIFOs are left out.
//!
//! | group | tracks |
//! |---|---|
//! | host, each GP | a track for each of its stages; messages in and out |
//! | each renderer | messages in and out; counter: words of whole commands that wait in its FIFO |
//! | each surface of a display, such as a frame buffer | messages into its port; regions as they arrive; swaps as instants |
//! | ring | counter: occupied channels |
//! | video, of each display | its periods with the picture they show; retraces as instants |
//!
//! Flow arrows lead from a picture's SEND through its stages to the first period that shows it. A display that has not as
//! many ports as surfaces has groups for both.
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
mod groups;
mod model;
mod perfetto;
mod protobuf;
mod slices;

pub use chrome::chrome;
pub use model::{Events, Flow, Slice, Step, Trace, Track};
pub use perfetto::perfetto;
