//! Data on the ring: words, messages, addresses, and the number formats of expressions.
//!
//! The crates of boards do not depend on each other, so what two of them share is defined here:
//!
//! - [`Message`]: at most [`MAX_MESSAGE_WORDS`] words from one [`NodeId`] to another;
//! - [`Body`]: the content of a message: renderer commands, pixels of a region, or words that firmware defines;
//! - [`Linear`] and [`Quadratic`]: the expressions that a renderer evaluates at every pixel;
//! - [`mod@format`]: the fixed-point formats of these expressions;
//! - [`PeriodNumber`], [`PictureNumber`], [`ViewNumber`]: the counts of periods, pictures and views;
//! - [`RegionGrid`]: the division of a picture into regions of at most 128 x 128 pixels.
//!
//! Bodies are *lazy*: their words are computed only when a picture is read. A message always has its length and the
//! sequence of its command kinds. Simulated times need no more, because a SIMD array takes the same number of cycles
//! for all data.
//!
//! **Not modelled:** routing headers and check words. Instead, the ring adds a fixed overhead to each message.
//!
//! Sources: TR94 (message length, regions), F89 (expressions, region size).

mod body;
pub mod display;
mod expression;
pub mod format;
mod number;
mod region;
mod video;

pub use body::{
    Body, COPY_ACKNOWLEDGEMENT, COPY_ACKNOWLEDGEMENT_WORDS, CommandContent, CommandList, CommandRun, CommandSink,
    CommandWords, CopyContent, CopyOrder, CopyPath, CopyTarget, FieldParity, Lines, Message, PixelSource, RegionPixels,
    RegionPlace, SWAP_REQUEST, read_swap_request, swap_request,
};
pub use expression::{LANES, Linear, LinearLanes, Quadratic, TriangleBatch};
pub use number::{PeriodNumber, PictureNumber, ViewNumber};
pub use region::{Eye, RegionGrid, RegionId, SurfaceId};
pub use video::{Video, VideoNumbers, frame_line};

/// One word of the ring: 32 bits, since 160 million words a second are 5 gigabits (TR94, F89).
pub type Word = u32;

/// Greatest length of a message in words. The value is derived: a region of a field has 128 x 120 = 15 x 1,024 pixels.
pub const MAX_MESSAGE_WORDS: u32 = 1024;

/// Width and height of a renderer's pixel array, in pixels (F89).
pub const REGION_SIZE: u32 = 128;

/// Number of a board's port on the ring.
///
/// Ports are numbered in the direction in which messages travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
pub struct NodeId(pub u16);

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
