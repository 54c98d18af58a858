//! Messages and their contents.

use crate::{NodeId, PeriodNumber, PictureNumber, RegionGrid, RegionId, TriangleBatch, Word};
use serde::{Deserialize, Serialize};
use std::fmt::Debug;
use std::sync::Arc;

/// A message on one channel of the ring.
#[derive(Clone, Debug)]
pub struct Message {
    /// Port of the board that sends the message.
    pub source: NodeId,
    /// Port of the board that receives the message.
    pub destination: NodeId,
    /// Length in words, 1 to [`crate::MAX_MESSAGE_WORDS`].
    pub words: u32,
    /// Content of the message.
    pub body: Body,
}

/// The content of a message.
#[derive(Clone, Debug)]
pub enum Body {
    /// Commands for a renderer, in the order of their execution.
    Commands(CommandList),
    /// Part of a region's pixels, sent to a frame buffer.
    Pixels(RegionPixels),
    /// Words between two programs, defined by the firmware.
    Words(Arc<[Word]>),
}

/// Commands for a renderer, in order.
#[derive(Clone, Debug)]
pub struct CommandList {
    /// Kinds of the commands in order, as runs. The time of the list depends only on these.
    pub runs: Vec<CommandRun>,
    /// Region context of pixel memory on which all commands of this list work.
    pub context: u8,
    /// One order for every command that copies a region, in the order of the commands.
    pub copies: Vec<CopyOrder>,
    /// Command words, computed on demand; `None` if no pixel of the picture will be read.
    pub content: Option<CommandContent>,
}

/// The command words of a message, computed on demand. All messages of a region share one source of words.
#[derive(Clone, Debug)]
pub struct CommandContent {
    words: Arc<dyn CommandWords>,
    part: u32,
}

impl CommandContent {
    /// Makes the content of part `part` (from 0) of a source of command words.
    #[must_use]
    pub const fn new(words: Arc<dyn CommandWords>, part: u32) -> Self {
        Self { words, part }
    }

    /// Appends the words of the commands. Every call appends the same words.
    pub fn append_words(&self, out: &mut Vec<Word>) {
        self.words.append_words(self.part, out);
    }

    /// Passes the commands that can touch their region to `out` ([`CommandWords::append_visible`]).
    pub fn append_visible(&self, out: &mut dyn CommandSink) -> bool {
        self.words.append_visible(self.part, out)
    }
}

/// The parameters of a copy command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct CopyOrder {
    /// Place of the region in a frame buffer.
    pub target: CopyTarget,
    /// Region context of the pixel memory that holds the region.
    pub context: u8,
    /// Path of the colours to the frame buffer.
    pub way: CopyPath,
    /// Data that are sent for each pixel.
    pub content: CopyContent,
    /// Port that gets a message of [`COPY_ACKNOWLEDGEMENT_WORDS`] when the last pixel has arrived.
    pub acknowledge: Option<NodeId>,
}

/// The data that a copy sends for each pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum CopyContent {
    /// One word per pixel: its colour.
    #[default]
    Colour,
    /// Two words per pixel: the colours of all pixels, then their 24-bit depths.
    ColourAndDepth,
    /// One word per pixel: the upper 16 bits of its depth above its colour in 5, 6 and 5 bits.
    Packed,
}

impl CopyContent {
    /// Returns the words per pixel on the ring, which is also the number of 32-bit words in the backing store.
    #[must_use]
    pub const fn words(self) -> u32 {
        match self {
            Self::Colour | Self::Packed => 1,
            Self::ColourAndDepth => 2,
        }
    }

    /// Returns the words of a region, from the colours (0x00RRGGBB) and, if they are sent, the 24-bit depths of its
    /// pixels.
    #[must_use]
    pub fn of(self, colours: Arc<[Word]>, depths: impl FnOnce() -> Vec<Word>) -> Arc<[Word]> {
        match self {
            Self::Colour => colours,
            Self::ColourAndDepth => colours.iter().copied().chain(depths()).collect(),
            Self::Packed => colours.iter().zip(depths()).map(packed).collect(),
        }
    }
}

/// Returns a colour in 5, 6 and 5 bits below the upper 16 bits of a 24-bit depth.
fn packed((colour, depth): (&Word, Word)) -> Word {
    (depth >> 8) << 16 | (colour >> 8 & 0xF800) | (colour >> 5 & 0x07E0) | (colour >> 3 & 0x001F)
}

/// The path of a region's colours from pixel memory to the frame buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum CopyPath {
    /// Directly from pixel memory. The commands that follow wait until the last pixel has arrived.
    FromPixelMemory,
    /// Into the backing store, and from there to the frame buffer while the following commands execute. The second step
    /// waits while another region of this renderer is being sent.
    ThroughBacking,
    /// Into the backing store, where the colours stay until a [`CopyPath::FromBacking`] command of the same target.
    IntoBacking,
    /// From the backing store, after an earlier [`CopyPath::IntoBacking`] command of the same target.
    FromBacking,
}

/// Length of the message that tells a program that a region has been copied (assumed).
pub const COPY_ACKNOWLEDGEMENT_WORDS: u32 = 4;

impl CommandList {
    /// Returns the length of all commands in words.
    #[must_use]
    pub fn words(&self) -> u32 {
        self.runs.iter().map(|run| run.count * run.words_each).sum()
    }
}

/// A run of `count` successive commands of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CommandRun {
    /// Operation code of the commands.
    pub opcode: u8,
    /// Length of one command in words.
    pub words_each: u32,
    /// Number of commands in the run.
    pub count: u32,
}

/// A source of command words, which computes them on demand.
pub trait CommandWords: Debug + Send + Sync {
    /// Appends the words of a part (one message) to `out`. Every call appends the same words.
    fn append_words(&self, part: u32, out: &mut Vec<Word>);

    /// Passes the commands of a part to `out`, possibly without primitives that touch no pixel of their region.
    /// Returns true if a primitive is among the commands. `out` receives whole commands; each command that draws sets
    /// Enable first.
    fn append_visible(&self, part: u32, out: &mut dyn CommandSink) -> bool {
        self.append_words(part, out.words());
        true
    }
}

/// A receiver of commands in order: words, and triangles without words where possible.
pub trait CommandSink {
    /// Returns the list to which words of commands are appended.
    fn words(&mut self) -> &mut Vec<Word>;

    /// Accepts triangles that come after the words so far. Returns false if their words must be appended instead.
    fn triangles(&mut self, batch: &TriangleBatch<'_>) -> bool;
}

impl CommandSink for Vec<Word> {
    fn words(&mut self) -> &mut Vec<Word> {
        self
    }

    fn triangles(&mut self, _: &TriangleBatch<'_>) -> bool {
        false
    }
}

/// Words computed in advance, as a single part.
impl CommandWords for Vec<Word> {
    fn append_words(&self, _: u32, out: &mut Vec<Word>) {
        out.extend_from_slice(self);
    }
}

/// The lines of a frame that a picture fills.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Lines {
    /// All lines of the frame.
    Frame,
    /// Every second line: the lines of one field.
    Field(FieldParity),
}

/// The two fields of an interlaced frame. Line 0 is the top line of the picture and belongs to the even field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FieldParity {
    /// Lines 0, 2, 4, ...
    Even,
    /// Lines 1, 3, 5, ...
    Odd,
}

impl FieldParity {
    /// Returns the parity of a field of NTSC video. Fields with even numbers scan even lines.
    #[must_use]
    pub const fn of_field(field: PeriodNumber) -> Self {
        if field.0.is_multiple_of(2) { Self::Even } else { Self::Odd }
    }

    /// Returns the first line of the field: 0 or 1.
    #[must_use]
    pub const fn first_line(self) -> u32 {
        self as u32
    }
}

/// The place of a region in a frame buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct CopyTarget {
    /// Port of the frame buffer.
    pub frame_buffer: NodeId,
    /// Number of the buffer, 0 or 1.
    pub buffer: u8,
    /// Lines of the frame that the rows of the grid fill.
    pub lines: Lines,
    /// Division of the picture into regions.
    pub grid: RegionGrid,
    /// Number of the region in the grid.
    pub region: RegionId,
    /// Picture that the region belongs to, as counted by its pipeline; see [`PictureNumber`]. Boards use it only to
    /// separate successive copies of a region. Observers use it to collect the regions of a picture.
    pub picture: PictureNumber,
}

/// Part of one region's pixels: message `part` of `parts`.
#[derive(Clone, Debug)]
pub struct RegionPixels {
    /// Place of the region in a display.
    pub target: CopyTarget,
    /// Pixels of the whole region.
    pub image: Arc<dyn PixelSource>,
    /// Number of this message within the region, from 0.
    pub part: u32,
    /// Number of messages of the whole region.
    pub parts: u32,
}

/// The pixels of a region, computed on demand.
pub trait PixelSource: Debug + Send + Sync {
    /// Returns one word 0x00RRGGBB per pixel, row by row, for `width * height` pixels of the region's rectangle.
    /// For a copy with depth the words are as [`CopyContent`] defines them.
    fn pixels(&self) -> Arc<[Word]>;
}

/// First word of the message that tells a program that a region has been copied.
pub const COPY_ACKNOWLEDGEMENT: Word = 0xC0_11_ED;

impl CopyTarget {
    /// Returns the words that tell a program that this region has been copied: tag, region, low word of the picture
    /// number, frame buffer.
    #[must_use]
    pub fn acknowledgement(&self) -> Arc<[Word]> {
        let words = [
            COPY_ACKNOWLEDGEMENT,
            Word::from(self.region.0),
            self.picture.to_words()[0],
            Word::from(self.frame_buffer.0),
        ];
        words.into()
    }
}

/// First word of the message that requests a swap at the next retrace. The buffer's number follows.
pub const SWAP_REQUEST: Word = 0x0005_3A9F;

/// Returns the words of a request to show `buffer` from the next retrace on.
#[must_use]
pub fn swap_request(buffer: u8) -> Arc<[Word]> {
    [SWAP_REQUEST, Word::from(buffer)].into()
}

/// Returns the requested buffer if the words are a swap request.
#[must_use]
pub fn read_swap_request(words: &[Word]) -> Option<u8> {
    match words {
        [SWAP_REQUEST, buffer] => u8::try_from(*buffer).ok(),
        _ => None,
    }
}
