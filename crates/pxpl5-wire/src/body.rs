//! Messages and what their words mean.

use crate::{NodeId, PeriodNumber, PictureNumber, RegionGrid, RegionId, TriangleBatch, Word};
use serde::{Deserialize, Serialize};
use std::fmt::Debug;
use std::sync::Arc;

/// One message on one channel of the ring.
#[derive(Clone, Debug)]
pub struct Message {
    /// The port of the board that sends it.
    pub source: NodeId,
    /// The port of the board that it is for.
    pub destination: NodeId,
    /// Length in words, 1 to [`crate::MAX_MESSAGE_WORDS`].
    pub words: u32,
    /// What the words mean.
    pub body: Body,
}

/// What a message carries.
#[derive(Clone, Debug)]
pub enum Body {
    /// Commands for a renderer, in the order in which it executes them.
    Commands(CommandList),
    /// Part of a region's pixels on the way to a frame buffer.
    Pixels(RegionPixels),
    /// Words between two programs, defined by the firmware.
    Words(Arc<[Word]>),
}

/// Commands for a renderer, in order.
#[derive(Clone, Debug)]
pub struct CommandList {
    /// The kinds of the commands in order, run by run; this alone decides the time.
    pub runs: Vec<CommandRun>,
    /// The region context of pixel memory on which all commands of this list work.
    pub context: u8,
    /// One order for every command that copies a region, in their order.
    pub copies: Vec<CopyOrder>,
    /// The command words, produced on demand; `None` where nobody will look at pixels.
    pub content: Option<CommandContent>,
}

/// The words of a message's commands, produced on demand. Messages that belong together, those of a region, share who makes them.
#[derive(Clone, Debug)]
pub struct CommandContent {
    words: Arc<dyn CommandWords>,
    part: u32,
}

impl CommandContent {
    /// One part, numbered from 0, of what somebody makes.
    #[must_use]
    pub const fn new(words: Arc<dyn CommandWords>, part: u32) -> Self {
        Self { words, part }
    }

    /// Appends the words, always the same ones.
    pub fn append_words(&self, out: &mut Vec<Word>) {
        self.words.append_words(self.part, out);
    }

    /// Hands over the commands that can touch their region ([`CommandWords::append_touching`]).
    pub fn append_touching(&self, out: &mut dyn CommandSink) -> bool {
        self.words.append_touching(self.part, out)
    }
}

/// What a copy command asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct CopyOrder {
    /// Where the region goes.
    pub target: CopyTarget,
    /// The region context that holds it.
    pub context: u8,
    /// The way of its colours.
    pub way: CopyWay,
    /// What of its pixels is sent.
    pub content: CopyContent,
    /// Who is told, by a message of [`COPY_ACKNOWLEDGEMENT_WORDS`], when the last pixel has arrived.
    pub acknowledge: Option<NodeId>,
}

/// What of a region's pixels a copy sends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum CopyContent {
    /// A word a pixel: its colour.
    #[default]
    Colour,
    /// Two words a pixel: the colours of all pixels, then their depths of 24 bits.
    ColourAndDepth,
    /// A word a pixel: the upper half of its depth above its colour in 5, 6 and 5 bits.
    Packed,
}

impl CopyContent {
    /// Words that a pixel takes: on the ring, and of 32 bits in the backing store.
    #[must_use]
    pub const fn words(self) -> u32 {
        match self {
            Self::Colour | Self::Packed => 1,
            Self::ColourAndDepth => 2,
        }
    }

    /// The words of a region, made of its pixels' colours (0x00RRGGBB) and, where they are sent, their depths of 24 bits.
    #[must_use]
    pub fn of(self, colours: Arc<[Word]>, depths: impl FnOnce() -> Vec<Word>) -> Arc<[Word]> {
        match self {
            Self::Colour => colours,
            Self::ColourAndDepth => colours.iter().copied().chain(depths()).collect(),
            Self::Packed => colours.iter().zip(depths()).map(packed).collect(),
        }
    }
}

/// A colour in 5, 6 and 5 bits below the upper 16 of 24 bits of depth.
fn packed((colour, depth): (&Word, Word)) -> Word {
    (depth >> 8) << 16 | (colour >> 8 & 0xF800) | (colour >> 5 & 0x07E0) | (colour >> 3 & 0x001F)
}

/// The way of a region's colours from pixel memory to the frame buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum CopyWay {
    /// Straight from pixel memory: the commands that follow wait until the last pixel has arrived.
    FromPixelMemory,
    /// Into the backing store, and from there to the frame buffer as soon as no other region of this renderer is on its way,
    /// beside the commands that follow.
    ThroughBacking,
    /// Into the backing store, where they stay until a command [`CopyWay::FromBacking`] of the same target.
    IntoBacking,
    /// From the backing store, where an earlier command [`CopyWay::IntoBacking`] has put them.
    FromBacking,
}

/// Length of the message that tells a program that a region has been copied (assumed).
pub const COPY_ACKNOWLEDGEMENT_WORDS: u32 = 4;

impl CommandList {
    /// Length in words of all commands.
    #[must_use]
    pub fn words(&self) -> u32 {
        self.runs.iter().map(|run| run.count * run.words_each).sum()
    }
}

/// `count` commands of one kind in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CommandRun {
    /// The commands' operation code.
    pub opcode: u8,
    /// Length of one command in words.
    pub words_each: u32,
    /// How many commands of this kind follow each other.
    pub count: u32,
}

/// Produces the words of commands when somebody needs them.
pub trait CommandWords: Debug + Send + Sync {
    /// Appends the words of a part, one of so many messages, to `out`: always the same ones.
    fn append_words(&self, part: u32, out: &mut Vec<Word>);

    /// Hands the same commands to somebody, or without primitives that touch no pixel of the region that they are sent to; says
    /// whether a primitive is among them. Whole commands, of which each that draws sets Enable first.
    fn append_touching(&self, part: u32, out: &mut dyn CommandSink) -> bool {
        self.append_words(part, out.words());
        true
    }
}

/// Takes commands in order: words, and triangles without them where it can.
pub trait CommandSink {
    /// The words of commands are appended here.
    fn words(&mut self) -> &mut Vec<Word>;

    /// Takes triangles that come behind the words so far. False where their words are to be appended instead.
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

/// Words that are given; they have one part.
impl CommandWords for Vec<Word> {
    fn append_words(&self, _: u32, out: &mut Vec<Word>) {
        out.extend_from_slice(self);
    }
}

/// Which lines of a frame a picture fills.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Lines {
    /// All lines of the screen, one under the other.
    Frame,
    /// The lines of one field.
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
    /// The parity of a field of NTSC video: even numbers scan even lines.
    #[must_use]
    pub const fn of_field(field: PeriodNumber) -> Self {
        if field.0.is_multiple_of(2) { Self::Even } else { Self::Odd }
    }

    /// First line of the field: 0 or 1.
    #[must_use]
    pub const fn first_line(self) -> u32 {
        self as u32
    }
}

/// Where in a frame buffer a region goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct CopyTarget {
    /// Port of the frame buffer.
    pub frame_buffer: NodeId,
    /// Which of the two buffers, 0 or 1.
    pub buffer: u8,
    /// The lines that the grid's rows stand for.
    pub lines: Lines,
    /// How the picture is cut.
    pub grid: RegionGrid,
    /// Which piece of the grid the region is.
    pub region: RegionId,
    /// The picture that the region is part of, in the count of the pipeline that draws it; see [`PictureNumber`]. Boards
    /// only tell one copy of a region from the next by it; observers join the regions of a picture.
    pub picture: PictureNumber,
}

/// Part of one region's pixels: message `part` of `parts`.
#[derive(Clone, Debug)]
pub struct RegionPixels {
    /// The place in a display that the pixels go to.
    pub target: CopyTarget,
    /// The whole region's pixels.
    pub image: Arc<dyn PixelSource>,
    /// Number of this message within the region, from 0.
    pub part: u32,
    /// Messages of the whole region.
    pub parts: u32,
}

/// Pixels of a region, computed when somebody looks.
pub trait PixelSource: Debug + Send + Sync {
    /// One word a pixel, 0x00RRGGBB, row by row, `width * height` of the region's rectangle; of a copy with depth
    /// ([`CopyContent`]) the words that it says.
    fn pixels(&self) -> Arc<[Word]>;
}

/// First word of the message that tells a program that a region has been copied.
pub const COPY_ACKNOWLEDGEMENT: Word = 0xC0_11_ED;

impl CopyTarget {
    /// The words that tell a program that this region has been copied: tag, region, low word of the picture, frame buffer.
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

/// First word of the message that asks a frame buffer to swap at the next retrace; the buffer's number follows.
pub const SWAP_REQUEST: Word = 0x0005_3A9F;

/// The words of a request to show `buffer` from the next retrace on.
#[must_use]
pub fn swap_request(buffer: u8) -> Arc<[Word]> {
    [SWAP_REQUEST, Word::from(buffer)].into()
}

/// The buffer that a message asks to show, if it is a request to swap.
#[must_use]
pub fn read_swap_request(words: &[Word]) -> Option<u8> {
    match words {
        [SWAP_REQUEST, buffer] => u8::try_from(*buffer).ok(),
        _ => None,
    }
}
