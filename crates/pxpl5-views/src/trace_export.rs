//! A run as a trace for viewers: ui.perfetto.dev, or GTKWave and Surfer, which show waveforms.
//!
//! [`Trace::of`] collects tracks from the observations, and [`Trace::between`] keeps those of a time span. [`chrome`]
//! writes them in Chrome's JSON format, and [`vcd`] as a waveform. Tracks of messages and counters of
//! the ring and the FIFOs need [`Experiment::record_traffic`](pxpl5_run::Experiment::record_traffic).
//!
//! | group | tracks |
//! |---|---|
//! | host, each GP | a track for each of its stages; messages in and out |
//! | each renderer | messages in and out; counter: words of whole commands that wait in its FIFO |
//! | each surface of a display, such as a frame buffer | messages into its port; regions as they arrive; swaps as instants |
//! | ring | counter: occupied channels |
//! | video, of each display | its periods with the picture they show; retraces as instants |
//!
//! Flow arrows lead from a picture's SEND through its stages to the first period that shows the picture. If the numbers
//! of ports and surfaces of a display differ, ports and surfaces have separate groups.
//!
//! Time is simulated time in microseconds with six decimals, so times in picoseconds are exact. Slices (events with a
//! duration) of one track never overlap. A message may reach a port shortly before the previous message has left it.
//! The message is then drawn from the end of the previous message.
//!
//! Sources: the description of Chrome's trace event format, and IEEE 1364 for VCD.

mod chrome;
mod collect;
mod flows;
mod groups;
mod model;
mod slices;
mod vcd;

pub use chrome::chrome;
pub use model::{Events, Flow, Slice, Step, Trace, Track};
pub use vcd::vcd;
