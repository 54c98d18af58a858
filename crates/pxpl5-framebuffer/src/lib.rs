//! The frame buffer of Pixel-Planes 5: two buffers, NTSC video, and what a viewer sees.
//!
//! ```text
//!   ring --Pixels--> port --+--> buffer 0 (even and odd field) --+
//!                           +--> buffer 1 (even and odd field) --+--> scan --> SeenField
//!   software --SwapRequested--> at the next retrace ------------^      ^
//!   sync generator --Retrace-------------------------------------------+
//! ```
//!
//! # Behaviour
//!
//! 1. A region comes as messages of 1,024 pixels (the last may be shorter), row by row. The port takes every word
//!    as it comes; the words of a message have arrived at a distance of one word time, the last at the time of the
//!    [`FrameBufferEvent::Pixels`]. When all messages are there the region has arrived
//!    ([`FrameBufferOutput::RegionArrived`]).
//! 2. A target names buffer, region and lines: rows of a [`Lines::Frame`](pxpl5_wire::Lines) picture are lines of
//!    the frame; row `r` of a field picture is line `2 r` (even) or `2 r + 1` (odd).
//! 3. At a retrace, and only there, the buffer asked for last is displayed ([`FrameBufferOutput::Swapped`]). A
//!    request that arrives at the instant of a retrace waits for the next one.
//! 4. Field `n` scans the even lines of the displayed buffer when `n` is even, and else the odd ones. A pixel shows
//!    what is in the buffer when the beam is there: of a word that arrives at that instant the new value, of a later
//!    one the old. So a region that comes too late is seen torn, word by word, and listed by
//!    [`SeenField::late_regions`].
//!    A line that is overwritten by another region of the same place before the beam has shown all of it is counted
//!    ([`FrameBufferStats::lines_never_shown`]). Regions are compared with those of the same cut alone.
//! 5. Two boards scan in lock-step because the wiring gives both the same retraces.
//! 6. What cannot be done (pixels for another board, a region outside of the frame, a message twice) is a counted
//!    fault without effect: [`FrameBuffer::faults`].
//!
//! Pixels are never computed here until somebody asks for a picture; a [`SeenField`] holds what it needs and can
//! be evaluated later or in another thread. At each retrace the board forgets what cannot be seen any more.
//!
//! # Timing
//!
//! All numbers stand in [`VideoTiming`] and [`PortTiming`]; [`Video`] gives the exact instants, from zero:
//!
//! | instant | time |
//! |---|---|
//! | retrace `n` | floor(`n` x 1001/60000 s) |
//! | line `k` of the uninterrupted line clock | floor(`k` x 4004/63 us) |
//! | first visible line of an even field | 22 lines after its retrace |
//! | first visible line of an odd field | 22.5 lines after its retrace |
//! | pixel `x` of a line | (140 + `x`) pixel periods of 11/135 us after its start |
//!
//! The half line is what interlaces the fields on a screen: the first line of an odd field is scanned half a line
//! later in its field, and so half a line pitch lower.
//!
//! **Not modelled:** the colour encoder and its subcarrier, gamma, the phosphor, the 9 pre-equalising and
//! synchronising lines apart from their time, two transfers at a time into one board (the port forbids them; if
//! they overlap, the one that began last is on top), contention of scan and port for the video RAM.
//!
//! Sources: TR94 (resolution, two buffers of two fields, two boards in lock-step), NTSC (field, line). Where the
//! blanking lies is assumed.

#![warn(missing_docs)]

mod board;
mod buffer;
mod config;
mod error;
mod ntsc;
mod picture;
mod port;
mod region;
mod scans;
mod seen;
mod stats;
mod timing;
mod video;

pub use board::FrameBuffer;
pub use config::FrameBufferConfig;
pub use error::FrameBufferConfigError;
pub use image::RgbImage;
pub use ntsc::{NtscDisplay, seen_at};
pub use port::{Faults, FrameBufferEvent, FrameBufferFault, FrameBufferOutput};
pub use seen::{BufferContents, SeenField, SeenLateRegion};
pub use stats::FrameBufferStats;
pub use timing::{PortTiming, VideoTiming};
pub use video::Video;
