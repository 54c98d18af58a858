//! Messages between host, master, slaves and renderers, as words on the ring.

use crate::rules::EyeDrawing;
use pphigs::FrameView;
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

/// A token. While a slave holds the token, it may send its commands of one region to one renderer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Token {
    pub(crate) drawing: EyeDrawing,
    pub(crate) region: RegionId,
    /// Index of the renderer that draws the region.
    pub(crate) renderer: u16,
    /// Number of slaves that have not sent their bins yet, including the slave that holds the token.
    pub(crate) slaves_left: u16,
    /// Destination of the region's pixels after the region's last commands. The last slave adds the command for this
    /// destination.
    pub(crate) end: RegionEnd,
}

/// Destination of a region's pixels after the region's last commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RegionEnd {
    /// The region stays in pixel memory, and the renderer waits for a copy command.
    Held,
    /// The region goes to the renderer's backing store and stays there until the master sends a copy command.
    Stored,
    /// The region goes through the backing store to its frame buffer. The master sends no copy command.
    Copied,
}

impl RegionEnd {
    const ALL: [Self; 3] = [Self::Held, Self::Stored, Self::Copied];

    /// Returns the path in the region's copy command, or `None` if the region needs no copy command.
    pub(crate) const fn way(self) -> Option<CopyPath> {
        match self {
            Self::Held => None,
            Self::Stored => Some(CopyPath::IntoBacking),
            Self::Copied => Some(CopyPath::ThroughBacking),
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum StageOrder {
    /// From host to all graphics processors: view and edits of a frame.
    Send(FrameView),
    /// From master to slaves: apply the edits of a frame.
    Edit(PictureNumber),
    /// From slave to master: the edits of a frame are applied.
    Edited(PictureNumber),
    /// From master to host: all slaves have applied the edits of a frame.
    EditsDone(PictureNumber),
    /// From master to slaves: TRANSFORM of a drawing (the picture of one eye) may begin.
    Transform(EyeDrawing),
    /// From slave to master: a drawing is transformed. The message contains the number of entries in each region's bin.
    Transformed(EyeDrawing, Vec<u32>),
    /// From master to slave, or from slave to slave: a token.
    Token(Token),
    /// From the last slave to the master: all commands of a region have been accepted.
    Accepted(Token),
    /// From renderer to master: a region has arrived in the frame buffer at the ring port `frame_buffer`.
    Copied { frame_buffer: NodeId },
}

impl StageOrder {
    pub(crate) fn message(&self) -> (u32, Body) {
        let words = self.words();
        (words.len() as u32, Body::Words(words))
    }

    fn words(&self) -> Arc<[Word]> {
        match self {
            Self::Send(view) => [vec![SEND], view.to_words()].concat().into(),
            Self::Edit(frame) => numbered(EDIT, frame.0).into(),
            Self::Edited(frame) => numbered(EDITED, frame.0).into(),
            Self::EditsDone(frame) => numbered(EDITS_DONE, frame.0).into(),
            Self::Transform(drawing) => numbered(TRANSFORM, drawing.0).into(),
            Self::Transformed(drawing, entries) => [&numbered(TRANSFORMED, drawing.0)[..], entries].concat().into(),
            Self::Token(token) => token.words(TOKEN).into(),
            Self::Accepted(token) => token.words(ACCEPTED).into(),
            Self::Copied { frame_buffer } => [COPY_ACKNOWLEDGEMENT, 0, 0, Word::from(frame_buffer.0)].into(),
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
        match words.first() {
            Some(&SEND) => FrameView::from_words(&words[1..]).ok().map(Self::Send),
            Some(&EDIT) => number_of(words).map(PictureNumber).map(Self::Edit),
            Some(&EDITED) => number_of(words).map(PictureNumber).map(Self::Edited),
            Some(&EDITS_DONE) => number_of(words).map(PictureNumber).map(Self::EditsDone),
            Some(&TRANSFORM) => number_of(words).map(EyeDrawing).map(Self::Transform),
            Some(&TRANSFORMED) => number_of(words).map(|n| Self::Transformed(EyeDrawing(n), words[3..].to_vec())),
            Some(&TOKEN) => Token::read(words).map(Self::Token),
            Some(&ACCEPTED) => Token::read(words).map(Self::Accepted),
            Some(&COPY_ACKNOWLEDGEMENT) => words.get(3).map(|node| Self::Copied { frame_buffer: NodeId(*node as u16) }),
            _ => None,
        }
    }
}

fn numbered(tag: Word, number: u64) -> [Word; 3] {
    [tag, number as Word, (number >> 32) as Word]
}

fn number_of(words: &[Word]) -> Option<u64> {
    let low = *words.get(1)?;
    let high = *words.get(2)?;
    Some(u64::from(low) | u64::from(high) << 32)
}

impl Token {
    fn words(self, tag: Word) -> [Word; 6] {
        let regions = u32::from(self.region.0) | u32::from(self.renderer) << 16;
        [
            tag,
            self.drawing.0 as Word,
            (self.drawing.0 >> 32) as Word,
            regions,
            u32::from(self.slaves_left),
            self.end as Word,
        ]
    }

    fn read(words: &[Word]) -> Option<Self> {
        let [_, low, high, regions, slaves_left, end] = *words else { return None };
        Some(Self {
            drawing: EyeDrawing(u64::from(low) | u64::from(high) << 32),
            region: RegionId(regions as u16),
            renderer: (regions >> 16) as u16,
            slaves_left: slaves_left as u16,
            end: *RegionEnd::ALL.get(end as usize)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_sim::Time;
    use pxpl5_wire::ViewNumber;

    fn through_words(order: &StageOrder) -> StageOrder {
        let (_, body) = order.message();
        let received = Received { arrived: Time::ZERO, source: NodeId(1), body };
        StageOrder::read(&received, NodeId(0)).expect("our own words")
    }

    #[test]
    fn every_order_survives_its_words() {
        let token = Token {
            drawing: EyeDrawing(1 << 33),
            region: RegionId(19),
            renderer: 4,
            slaves_left: 12,
            end: RegionEnd::Stored,
        };
        let view = FrameView { number: ViewNumber(3), eyes: Vec::new(), edits: Vec::new() };
        let orders = [
            StageOrder::Send(view),
            StageOrder::Edit(PictureNumber(1)),
            StageOrder::Edited(PictureNumber(2)),
            StageOrder::EditsDone(PictureNumber(1 << 40)),
            StageOrder::Transform(EyeDrawing(3)),
            StageOrder::Transformed(EyeDrawing(4), vec![7; 20]),
            StageOrder::Token(token),
            StageOrder::Accepted(token),
            StageOrder::Copied { frame_buffer: NodeId(20) },
        ];
        orders.iter().for_each(|order| assert_eq!(&through_words(order), order));
    }

    #[test]
    fn unknown_words_are_a_fault_that_shows_them() {
        let received = Received { arrived: Time::ZERO, source: NodeId(7), body: Body::Words([0xBAD].into()) };
        let fault = StageOrder::read(&received, NodeId(3)).expect_err("not an order");
        assert_eq!(fault.to_string(), "node 3: unexpected message [bad] from node 7");
    }
}
