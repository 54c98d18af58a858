//! The frame buffers of Pixel-Planes 5, each with two pixel buffers: NTSC video, or a panel that is described by
//! parameters.
//!
//! ```text
//!   ring --Pixels--> port --+--> buffer 0 (even and odd field) --+
//!                           +--> buffer 1 (even and odd field) --+--> scan --> ScannedField
//!   software --SwapRequested--> at the next retrace ------------^      ^
//!   sync generator --Retrace-------------------------------------------+
//! ```
//!
//! # Behaviour
//!
//! 1. A region arrives row by row, in messages of 1,024 pixels (the last one can be shorter). The port accepts every
//!    word immediately, one word time apart. [`FrameBufferEvent::Pixels`] is the arrival of a message's last word, and
//!    the last message of a region causes [`FrameBufferOutput::RegionArrived`].
//! 2. Its target ([`CopyTarget`](pxpl5_wire::CopyTarget)) states the buffer, the region and the lines. The rows of a
//!    [`Lines::Frame`](pxpl5_wire::Lines) picture are lines of the frame. Row `r` of a field picture is line `2 r`
//!    (even) or `2 r + 1` (odd).
//! 3. A retrace displays the buffer that software has requested last ([`FrameBufferOutput::Swapped`]). A request at the
//!    very instant of a retrace waits for the next one.
//! 4. Field `n` scans the even lines of the displayed buffer if `n` is even, else the odd lines. A pixel shows the word
//!    that is in the buffer when the beam reaches it, including one that arrives at this instant. If a region arrives
//!    too late, the viewer sees old pixels in one part of it and new ones in the rest ([`ScannedField::late_regions`]).
//! 5. [`FrameBufferStats::lines_never_shown`] counts lines that a newer region overwrites before the beam has shown all
//!    of their pixels. It compares only regions that fill exactly the same pixels.
//! 6. Two boards scan in lock-step because both receive the same retraces.
//! 7. An impossible event (pixels for another board, a region outside the frame, a repeated message) is a counted fault
//!    without effect: [`FrameBuffer::faults`].
//!
//! Pixels are computed only when a picture is read. A [`ScannedField`] holds all data for this, so it can happen later
//! or in another thread. At each retrace the board discards regions that no later scan can show.
//!
//! # Timing
//!
//! [`VideoTiming`] lists all timing parameters. [`Video`] computes the exact instants, from time
//! zero:
//!
//! | instant | time |
//! |---|---|
//! | retrace `n` | floor(`n` x 1001/60000 s) |
//! | line `k` of the uninterrupted line clock | floor(`k` x 4004/63 us) |
//! | first visible line of an even field | 22 lines after its retrace |
//! | first visible line of an odd field | 22.5 lines after its retrace |
//! | pixel `x` of a line | (140 + `x`) pixel periods of 11/135 us after its start |
//!
//! Odd fields begin in the middle of a line, which interlaces the two fields on a screen. Their first line is scanned
//! half a line time later, so it appears half a line pitch lower.
//!
//! **Not modelled:**
//!
//! - the colour encoder and its subcarrier, gamma and the phosphor
//! - the 9 pre-equalising and synchronising lines, except for their time
//! - two simultaneous transfers into one board (the port permits only one transfer at a time)
//! - conflicts between the scan and the port over the video RAM
//!
//! A [`Panel`] is a display of any size and rate, described by parameters, which keeps whole pictures.
//!
//! Sources: TR94 (resolution, two buffers of two fields, two boards in lock-step), NTSC (field, line). The position of
//! the blanking is assumed.

#![warn(missing_docs)]

mod board;
mod buffer;
mod config;
mod ntsc;
mod panel;
mod picture;
mod port;
mod region;
mod scanned;
mod scans;
mod timing;

pub use board::{FrameBuffer, FrameBufferStats};
pub use config::FrameBufferConfig;
pub use image::RgbImage;
pub use ntsc::{NtscDisplay, seen_at};
pub use panel::{HiResConfig, LcdConfig, OledConfig, Panel, PanelConfig, PanelNumbers};
pub use port::{Faults, FrameBufferEvent, FrameBufferFault, FrameBufferOutput};
pub use pxpl5_wire::Video;
pub use scanned::{BufferContents, ScannedField, ScannedLateRegion};
pub use timing::VideoTiming;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
