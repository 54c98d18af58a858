//! Messages between host, master, slaves and renderers, as words on the ring.

use crate::drawn::Sent;
use crate::rules::Drawing;
use pxpl5_gp::{Fault, Received};
use pxpl5_wire::{Body, COPY_ACKNOWLEDGEMENT, CopyPath, NodeId, PictureNumber, RegionId, Word};
use std::sync::Arc;

const SEND: Word = 1;
const EDIT: Word = 2;
const EDITED: Word = 3;
const TRANSFORM: Word = 4;
const TRANSFORMED: Word = 5;
const TOKEN: Word = 6;
const ACCEPTED: Word = 7;
const EDITS_DONE: Word = 8;

/// The token of a region, which passes from slave to slave. The slave that holds the token may send a bin of the region
/// to a renderer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Token {
    pub(crate) drawing: Drawing,
    /// Number of the region. The numbers continue through all views of the drawing.
    pub(crate) region: RegionId,
    pub(crate) renderer: u16,
    /// Number of slaves that must still send their bins, including the holder of the token.
    pub(crate) slaves_left: u16,
    /// Number of tokens of this drawing. There is one token for each region that is drawn.
    pub(crate) of: u16,
    /// Action of the renderer after the last commands of the region. The last slave sends the command for this action.
    pub(crate) end: RegionEnd,
}

/// Action of a renderer after the last commands of a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RegionEnd {
    /// The renderer keeps the region in pixel memory and waits for a copy command.
    Held,
    /// The renderer moves the region to its backing store, where the region waits for a copy command.
    Stored,
    /// The renderer copies the region to the frame buffer, through its backing store.
    Copied,
}

impl RegionEnd {
    const ALL: [Self; 3] = [Self::Held, Self::Stored, Self::Copied];

    /// Returns the path of the copy command that the last slave sends, or `None` if the region stays in pixel memory.
    pub(crate) const fn way(self) -> Option<CopyPath> {
        match self {
            Self::Held => None,
            Self::Stored => Some(CopyPath::IntoBacking),
            Self::Copied => Some(CopyPath::ThroughBacking),
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum StageOrder<S> {
    /// The host sends the view and the edits of a picture to all graphics processors.
    Send(S),
    /// The master orders the slaves to apply the edits of a picture and to transform its first drawing.
    Edit(PictureNumber),
    /// A slave reports to the master that the slave has applied the edits of a picture.
    Edited(PictureNumber),
    /// The master reports to the host that all slaves have applied the edits of a picture.
    EditsDone(PictureNumber),
    /// The master permits the slaves to begin TRANSFORM of a second or later drawing of a picture.
    Transform(Drawing),
    /// A slave reports to the master that the slave has transformed a drawing. The message contains the number of
    /// entries in each region's bin.
    Transformed(Drawing, Vec<u32>),
    /// The master or a slave sends a token to a slave.
    Token(Token),
    /// The last slave reports to the master that the renderer has accepted all commands of a region.
    Accepted(Token),
    /// A renderer reports to the master that a region has arrived in the frame buffer at the ring port `frame_buffer`.
    /// `picture` is the low word of the picture's number.
    Copied { picture: Word, frame_buffer: NodeId },
}

impl<S: Sent> StageOrder<S> {
    pub(crate) fn message(&self) -> (u32, Body) {
        let words: Arc<[Word]> = match self {
            // Tokens are the most frequent messages, so they are made without a vector.
            Self::Token(token) => token.words(TOKEN).into(),
            Self::Accepted(token) => token.words(ACCEPTED).into(),
            _ => self.words().into(),
        };
        (words.len() as u32, Body::Words(words))
    }

    fn words(&self) -> Vec<Word> {
        match self {
            Self::Send(sent) => [vec![SEND], sent.to_words()].concat(),
            Self::Edit(picture) => numbered(EDIT, picture.0),
            Self::Edited(picture) => numbered(EDITED, picture.0),
            Self::EditsDone(picture) => numbered(EDITS_DONE, picture.0),
            Self::Transform(drawing) => numbered(TRANSFORM, drawing.0),
            Self::Transformed(drawing, entries) => [&numbered(TRANSFORMED, drawing.0)[..], entries].concat(),
            Self::Token(token) => token.words(TOKEN).into(),
            Self::Accepted(token) => token.words(ACCEPTED).into(),
            Self::Copied { picture, frame_buffer } => {
                vec![COPY_ACKNOWLEDGEMENT, 0, *picture, Word::from(frame_buffer.0)]
            }
        }
    }

    pub(crate) fn read(received: &Received, at: NodeId) -> Result<Self, Fault> {
        let Body::Words(words) = &received.body else {
            return Err(Fault::Protocol { node: at, found: "of commands or pixels at a processor".to_owned() });
        };
        Self::from_words(words)
            .ok_or_else(|| Fault::Protocol { node: at, found: format!("{words:x?} from node {}", received.source.0) })
    }

    fn from_words(words: &[Word]) -> Option<Self> {
        match *words.first()? {
            SEND => S::from_words(&words[1..]).map(Self::Send),
            EDIT => number_of(words).map(PictureNumber).map(Self::Edit),
            EDITED => number_of(words).map(PictureNumber).map(Self::Edited),
            EDITS_DONE => number_of(words).map(PictureNumber).map(Self::EditsDone),
            TRANSFORM => number_of(words).map(Drawing).map(Self::Transform),
            // The entries of bins follow the tag and the number.
            TRANSFORMED => number_of(words).map(|n| Self::Transformed(Drawing(n), words[3..].to_vec())),
            TOKEN => Token::read(words).map(Self::Token),
            ACCEPTED => Token::read(words).map(Self::Accepted),
            COPY_ACKNOWLEDGEMENT => {
                let [_, _, picture, port] = *words else { return None };
                Some(Self::Copied { picture, frame_buffer: NodeId(port as u16) })
            }
            _ => None,
        }
    }
}

/// Encodes a message that consists of its kind (`tag`) and the number of a picture or of a drawing.
fn numbered(tag: Word, number: u64) -> Vec<Word> {
    vec![tag, number as Word, (number >> 32) as Word]
}

fn number_of(words: &[Word]) -> Option<u64> {
    let [_, low, high] = *words.first_chunk()?;
    Some(u64::from(low) | u64::from(high) << 32)
}

impl Token {
    fn words(self, tag: Word) -> [Word; 6] {
        let [low, high] = [self.drawing.0 as Word, (self.drawing.0 >> 32) as Word];
        let places = u32::from(self.region.0) | u32::from(self.renderer) << 16;
        let counts = u32::from(self.slaves_left) | u32::from(self.of) << 16;
        [tag, low, high, places, counts, self.end as Word]
    }

    fn read(words: &[Word]) -> Option<Self> {
        let [_, _, _, places, counts, end] = *words else { return None };
        Some(Self {
            drawing: Drawing(number_of(words)?),
            region: RegionId(places as u16),
            renderer: (places >> 16) as u16,
            slaves_left: counts as u16,
            of: (counts >> 16) as u16,
            end: *RegionEnd::ALL.get(end as usize)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pphigs::FrameView;
    use pxpl5_sim::Time;
    use pxpl5_wire::ViewNumber;

    fn through_words(order: &StageOrder<FrameView>) -> StageOrder<FrameView> {
        let (_, body) = order.message();
        let received = Received { arrived: Time::ZERO, source: NodeId(1), body };
        StageOrder::read(&received, NodeId(0)).expect("our own words")
    }

    #[test]
    fn every_order_is_decoded_from_its_words() {
        let drawing = Drawing(1 << 33);
        let token =
            Token { drawing, region: RegionId(95), renderer: 4, slaves_left: 12, of: 96, end: RegionEnd::Stored };
        let view = FrameView { number: ViewNumber(3), eyes: Vec::new(), edits: Vec::new() };
        let orders = [
            StageOrder::Send(view),
            StageOrder::Edit(PictureNumber(1)),
            StageOrder::Edited(PictureNumber(2)),
            StageOrder::EditsDone(PictureNumber(1 << 40)),
            StageOrder::Transform(Drawing(3)),
            StageOrder::Transformed(Drawing(4), vec![7; 96]),
            StageOrder::Token(token),
            StageOrder::Accepted(token),
            StageOrder::Copied { picture: 20, frame_buffer: NodeId(20) },
        ];
        orders.iter().for_each(|order| assert_eq!(&through_words(order), order));
    }

    #[test]
    fn unknown_words_are_a_fault_with_these_words() {
        let received = Received { arrived: Time::ZERO, source: NodeId(7), body: Body::Words([0xBAD].into()) };
        let fault = StageOrder::<FrameView>::read(&received, NodeId(3)).expect_err("not an order");
        assert_eq!(fault.to_string(), "node 3: unexpected message [bad] from node 7");
    }
}
