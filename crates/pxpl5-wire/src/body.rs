use crate::{NodeId, PeriodNumber, PictureNumber, RegionGrid, RegionId, TriangleBatch, Word};
use serde::{Deserialize, Serialize};
use std::fmt::Debug;
use std::sync::Arc;

/// A message from one ring port to another.
#[derive(Clone, Debug)]
pub struct Message {
    pub source: NodeId,
    pub destination: NodeId,
    /// Length of the message in words, 1 to [`crate::MAX_MESSAGE_WORDS`].
    pub words: u32,
    pub body: Body,
}

/// The content of a message on the ring.
#[derive(Clone, Debug)]
pub enum Body {
    /// Commands for a renderer, in the order in which the renderer executes them.
    Commands(CommandList),
    /// Pixels of a part of a region, sent to a frame buffer.
    Pixels(RegionPixels),
    /// Words sent from program to program. The firmware defines the meaning of the words.
    Words(Arc<[Word]>),
}

/// A list of commands for a renderer, in order.
#[derive(Clone, Debug)]
pub struct CommandList {
    /// Kinds of the commands, in order. Successive commands of one kind form one entry. The execution time of the list
    /// depends only on these entries.
    pub runs: Vec<CommandRun>,
    /// Region context on which all commands of this list work. A region context is a part of pixel memory.
    pub context: u8,
    /// Parameters of each copy command in the list, in order.
    pub copies: Vec<CopyOrder>,
    /// Source of the command words, computed on demand. `None` means that no reader needs the pixels of the picture.
    pub content: Option<CommandContent>,
}

/// The command words of a message, computed on demand. All messages of a region share one source, which computes the
/// words.
#[derive(Clone, Debug)]
pub struct CommandContent {
    words: Arc<dyn CommandWords>,
    part: u32,
    frame_buffer: Option<NodeId>,
}

impl CommandContent {
    /// Makes the content of one message. The source `words` computes the words of several messages, and `part` is the
    /// number of this message, counted from 0.
    pub const fn new(words: Arc<dyn CommandWords>, part: u32) -> Self {
        Self { words, part, frame_buffer: None }
    }

    /// Returns this content with a mark: the frame buffer that will show the drawn picture. Only observers use the
    /// mark.
    #[must_use]
    pub fn for_frame_buffer(self, frame_buffer: NodeId) -> Self {
        Self { frame_buffer: Some(frame_buffer), ..self }
    }

    /// Returns the region for which the message's commands draw. Returns `None` if the source of the words does not
    /// state the region.
    pub fn place(&self) -> Option<RegionPlace> {
        let place = self.words.place()?;
        Some(RegionPlace { frame_buffer: place.frame_buffer.or(self.frame_buffer), ..place })
    }

    /// Appends the words of all commands of the message to `out`. Every call appends the same words.
    pub fn append_words(&self, out: &mut Vec<Word>) {
        self.words.append_words(self.part, out);
    }

    /// Passes the commands of the message to `out`, and may leave out primitives that touch no pixel of the region.
    /// Returns true if the passed commands may contain a primitive ([`CommandWords::append_visible`]).
    pub fn append_visible(&self, out: &mut dyn CommandSink) -> bool {
        self.words.append_visible(self.part, out)
    }
}

/// The region of a picture for which renderer commands draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RegionPlace {
    /// Ring port of the frame buffer that will receive the region. `None` if no program has stated the frame buffer.
    pub frame_buffer: Option<NodeId>,
    /// Lines of the video frame that the rows of the picture fill.
    pub lines: Lines,
    pub grid: RegionGrid,
    pub region: RegionId,
}

/// The parameters of a copy command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct CopyOrder {
    pub target: CopyTarget,
    /// Region context that holds the pixels. A region context is a part of pixel memory.
    pub context: u8,
    /// Path that the colours take to the frame buffer.
    pub way: CopyPath,
    pub content: CopyContent,
    /// Port that receives a notification of [`COPY_ACKNOWLEDGEMENT_WORDS`] words after the last pixel has arrived.
    /// `None` if no notification is sent.
    pub acknowledge: Option<NodeId>,
}

/// The kind of data that a copy sends for each pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum CopyContent {
    /// One word per pixel: its colour.
    #[default]
    Colour,
    /// Two words per pixel: first the colours of all pixels, then the 24-bit depths of all pixels.
    ColourAndDepth,
    /// One word per pixel. The upper 16 bits are the upper 16 bits of the depth. The lower 16 bits are the colour: 5
    /// bits red, 6 bits green and 5 bits blue.
    Packed,
}

impl CopyContent {
    /// Returns the number of ring words for each pixel. The backing store needs the same number of 32-bit words.
    pub const fn words(self) -> u32 {
        match self {
            Self::Colour | Self::Packed => 1,
            Self::ColourAndDepth => 2,
        }
    }

    /// Returns the ring words of a region. `colours` are in the form 0x00RRGGBB. The function calls `depths` only if
    /// the copy sends depths. `depths` must return 24-bit values.
    pub fn of(self, colours: Arc<[Word]>, depths: impl FnOnce() -> Vec<Word>) -> Arc<[Word]> {
        match self {
            Self::Colour => colours,
            Self::ColourAndDepth => colours.iter().copied().chain(depths()).collect(),
            Self::Packed => colours.iter().zip(depths()).map(packed).collect(),
        }
    }
}

/// Returns a pixel as one word: the upper 16 bits of its 24-bit depth, then its colour in 5, 6 and 5 bits.
fn packed((colour, depth): (&Word, Word)) -> Word {
    (depth >> 8) << 16 | (colour >> 8 & 0xF800) | (colour >> 5 & 0x07E0) | (colour >> 3 & 0x001F)
}

/// The path of a region's colours from a renderer's pixel memory to the frame buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum CopyPath {
    /// The colours go directly from pixel memory to the frame buffer. The following commands wait until the last pixel
    /// has arrived.
    FromPixelMemory,
    /// The colours go into the renderer's backing store, and from there to the frame buffer while the following
    /// commands execute. The step from the backing store to the frame buffer waits while this renderer still sends
    /// another region.
    ThroughBacking,
    /// The colours go into the renderer's backing store and stay there until a [`CopyPath::FromBacking`] command for
    /// the same target.
    IntoBacking,
    /// The colours go from the renderer's backing store to the frame buffer. An earlier [`CopyPath::IntoBacking`]
    /// command for the same target has filled the store.
    FromBacking,
}

/// Length in words of the message that notifies a program that a region was copied. The length is assumed.
pub const COPY_ACKNOWLEDGEMENT_WORDS: u32 = 4;

impl CommandList {
    /// Returns the total length of all commands in words.
    pub fn words(&self) -> u32 {
        self.runs.iter().map(|run| run.count * run.words_each).sum()
    }

    /// Returns this list with a mark: the frame buffer that will show the drawn picture
    /// ([`CommandContent::for_frame_buffer`]).
    #[must_use]
    pub fn for_frame_buffer(self, frame_buffer: NodeId) -> Self {
        Self { content: self.content.map(|content| content.for_frame_buffer(frame_buffer)), ..self }
    }
}

/// A sequence of `count` successive commands of the same kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CommandRun {
    /// Operation code of the commands.
    pub opcode: u8,
    pub words_each: u32,
    pub count: u32,
}

/// A source that computes the words of renderer commands on demand.
pub trait CommandWords: Debug + Send + Sync {
    /// Appends the words of message `part` to `out`. Every call appends the same words.
    fn append_words(&self, part: u32, out: &mut Vec<Word>);

    /// Passes the whole commands of message number `part` to `out`, and may leave out primitives that touch no pixel of
    /// the region. Because the preceding command may be missing, each drawing command must set the Enable bits, which
    /// select the pixels in which it has an effect.
    ///
    /// Returns true if the passed commands may contain a primitive. The default implementation passes all commands and
    /// returns true.
    fn append_visible(&self, part: u32, out: &mut dyn CommandSink) -> bool {
        self.append_words(part, out.words());
        true
    }

    /// Returns the region for which the commands of all messages draw. The default is `None`, for a source that does
    /// not state the region.
    fn place(&self) -> Option<RegionPlace> {
        None
    }
}

/// A receiver of renderer commands in order. The commands come as words, or as batches of triangles
/// ([`TriangleBatch`]).
pub trait CommandSink {
    /// Returns the list to which a sender appends the words of commands.
    fn words(&mut self) -> &mut Vec<Word>;

    /// Offers a batch of triangles that follow the words appended so far. Returns true if the sink accepts the batch.
    /// If the result is false, the sender must append the words of the triangles to [`CommandSink::words`] instead.
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

/// A list of computed words also serves as a source for a single message.
impl CommandWords for Vec<Word> {
    fn append_words(&self, _: u32, out: &mut Vec<Word>) {
        out.extend_from_slice(self);
    }
}

/// The lines of a video frame that a picture fills: all lines, or the lines of one field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Lines {
    Frame,
    /// Every second line: the lines of one field.
    Field(FieldParity),
}

/// The two fields of an interlaced video frame, distinguished by their lines.
///
/// Line 0 is the top line of the picture and belongs to the even field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FieldParity {
    /// The field with lines 0, 2, 4, ...
    Even,
    /// The field with lines 1, 3, 5, ...
    Odd,
}

impl FieldParity {
    /// Returns the parity of a field of NTSC video. Fields with even numbers scan even lines.
    pub const fn of_field(field: PeriodNumber) -> Self {
        if field.0.is_multiple_of(2) { Self::Even } else { Self::Odd }
    }

    /// Returns the first line of the field: 0 or 1.
    pub const fn first_line(self) -> u32 {
        self as u32
    }
}

/// The destination of a region's pixels in a frame buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct CopyTarget {
    pub frame_buffer: NodeId,
    /// Number of the pixel buffer, 0 or 1.
    pub buffer: u8,
    /// Lines of the video frame that the rows of the picture fill.
    pub lines: Lines,
    pub grid: RegionGrid,
    pub region: RegionId,
    /// Number of the picture that contains the region, as counted by the pipeline ([`PictureNumber`]). Boards use it
    /// only to separate successive copies of a region, and observers to collect the regions of a picture.
    pub picture: PictureNumber,
}

/// A message with a part of a region's pixels. The region needs `parts` messages, and this message has the number
/// `part`.
#[derive(Clone, Debug)]
pub struct RegionPixels {
    pub target: CopyTarget,
    /// Pixels of the whole region, not only of this part.
    pub image: Arc<dyn PixelSource>,
    /// Number of this message within the region, counted from 0.
    pub part: u32,
    /// Number of messages that the whole region needs.
    pub parts: u32,
}

/// The pixels of a region, computed on demand.
pub trait PixelSource: Debug + Send + Sync {
    /// Returns one word 0x00RRGGBB for each of the `width * height` pixels of the region, row by row. For a copy with
    /// depth, the result has the words that [`CopyContent`] describes.
    fn pixels(&self) -> Arc<[Word]>;
}

/// First word of the message that notifies a program that a region was copied.
pub const COPY_ACKNOWLEDGEMENT: Word = 0xC0_11_ED;

impl CopyTarget {
    /// Returns the words of the message that notifies a program that this region was copied. The words are:
    /// [`COPY_ACKNOWLEDGEMENT`], number of the region, low word of the picture number, port of the frame buffer.
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

/// First word of a message that requests a buffer swap at the next retrace. The second word is the number of the
/// buffer.
pub const SWAP_REQUEST: Word = 0x0005_3A9F;

/// Returns the words of a message that requests buffer `buffer` to be shown from the next retrace on.
pub fn swap_request(buffer: u8) -> Arc<[Word]> {
    [SWAP_REQUEST, Word::from(buffer)].into()
}

/// Returns the number of the requested buffer if the words are a swap request, else `None`.
pub fn read_swap_request(words: &[Word]) -> Option<u8> {
    match words {
        [SWAP_REQUEST, buffer] => u8::try_from(*buffer).ok(),
        _ => None,
    }
}
