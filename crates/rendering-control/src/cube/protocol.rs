//! Messages between host, master, slaves and renderers, as words on the ring.

use crate::cube::update::FaceUpdate;
use pxpl5_gp::{Fault, Received};
use pxpl5_wire::{Body, COPY_ACKNOWLEDGEMENT, NodeId, PictureNumber, RegionId, Word};

const SEND: Word = 0x101;
const EDIT: Word = 0x102;
const EDITED: Word = 0x103;
const TRANSFORMED: Word = 0x105;
const TOKEN: Word = 0x106;
const ACCEPTED: Word = 0x107;
const EDITS_DONE: Word = 0x108;

/// A token. While a slave holds the token, it may send its commands of one region to one renderer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Token {
    pub(crate) update: PictureNumber,
    /// Index of the region among the regions of all six faces.
    pub(crate) region: RegionId,
    /// Index of the renderer that draws the region.
    pub(crate) renderer: u16,
    /// Number of slaves that have not sent their bins yet, including the slave that receives the token.
    pub(crate) slaves_left: u16,
    /// Number of tokens of this update, one for each region with primitives.
    pub(crate) of: u16,
    /// True if the last slave adds the copy command. If false, the region stays in pixel memory, and the renderer waits
    /// for a copy command of the master.
    pub(crate) copies: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum UpdateOrder {
    /// Host to all graphics processors: an update.
    Send(FaceUpdate),
    /// Master to slaves: apply the edits of an update, then transform.
    Edit(PictureNumber),
    /// Slave to master: the edits of an update are applied.
    Edited(PictureNumber),
    /// Master to host: all slaves have applied the edits of an update.
    EditsDone(PictureNumber),
    /// Slave to master: the update is transformed. The message contains the number of entries in each region's bin.
    Transformed(PictureNumber, Vec<u32>),
    /// Master to slave, or slave to slave: a token.
    Token(Token),
    /// Last slave to master: all commands of a region were accepted.
    Accepted(Token),
    /// Renderer to master: a region of an update has arrived. `update` is the low word of the update's number.
    Copied { update: Word },
}

impl UpdateOrder {
    pub(crate) fn message(&self) -> (u32, Body) {
        let words = self.words();
        (words.len() as u32, Body::Words(words.into()))
    }

    fn words(&self) -> Vec<Word> {
        match self {
            Self::Send(update) => [vec![SEND], update.to_words()].concat(),
            Self::Edit(update) => numbered(EDIT, *update),
            Self::Edited(update) => numbered(EDITED, *update),
            Self::EditsDone(update) => numbered(EDITS_DONE, *update),
            Self::Transformed(update, entries) => [numbered(TRANSFORMED, *update), entries.clone()].concat(),
            Self::Token(token) => token.words(TOKEN),
            Self::Accepted(token) => token.words(ACCEPTED),
            Self::Copied { update } => vec![COPY_ACKNOWLEDGEMENT, 0, *update, 0],
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
            SEND => FaceUpdate::from_words(&words[1..]).map(Self::Send),
            EDIT => number_of(words).map(Self::Edit),
            EDITED => number_of(words).map(Self::Edited),
            EDITS_DONE => number_of(words).map(Self::EditsDone),
            // The entries of bins follow the tag and the number.
            TRANSFORMED => number_of(words).map(|update| Self::Transformed(update, words[3..].to_vec())),
            TOKEN => Token::read(words).map(Self::Token),
            ACCEPTED => Token::read(words).map(Self::Accepted),
            COPY_ACKNOWLEDGEMENT => words.get(2).map(|update| Self::Copied { update: *update }),
            _ => None,
        }
    }
}

fn numbered(tag: Word, update: PictureNumber) -> Vec<Word> {
    let [low, high] = update.to_words();
    vec![tag, low, high]
}

fn number_of(words: &[Word]) -> Option<PictureNumber> {
    let [_, low, high] = *words.first_chunk()?;
    Some(PictureNumber::from_words(low, high))
}

impl Token {
    fn words(self, tag: Word) -> Vec<Word> {
        let places = u32::from(self.region.0) | u32::from(self.renderer) << 16;
        let counts = u32::from(self.slaves_left) | u32::from(self.of) << 16;
        [numbered(tag, self.update), vec![places, counts, self.copies.into()]].concat()
    }

    fn read(words: &[Word]) -> Option<Self> {
        let [_, _, _, places, counts, copies] = *words else { return None };
        Some(Self {
            update: number_of(words)?,
            region: RegionId(places as u16),
            renderer: (places >> 16) as u16,
            slaves_left: counts as u16,
            of: (counts >> 16) as u16,
            copies: matches!(copies, 0 | 1).then_some(copies == 1)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pphigs::FrameView;
    use pxpl5_sim::Time;
    use pxpl5_wire::ViewNumber;

    fn through_words(order: &UpdateOrder) -> UpdateOrder {
        let (_, body) = order.message();
        let received = Received { arrived: Time::ZERO, source: NodeId(1), body };
        UpdateOrder::read(&received, NodeId(0)).expect("our own words")
    }

    #[test]
    fn every_order_survives_its_words() {
        let update = PictureNumber(1 << 33);
        let token = Token { update, region: RegionId(95), renderer: 4, slaves_left: 12, of: 96, copies: true };
        let view = FrameView { number: ViewNumber(3), eyes: Vec::new(), edits: Vec::new() };
        let structures = (0..70).map(|i| i % 3 == 0).collect();
        let sent = FaceUpdate { number: update, memory: 3, buffer: 1, together: 0b1011, view, structures, warp: None };
        let warped = FaceUpdate { warp: Some(crate::cube::warp::tests::warp()), ..sent.clone() };
        let orders = [
            UpdateOrder::Send(sent),
            UpdateOrder::Send(warped),
            UpdateOrder::Edit(PictureNumber(1)),
            UpdateOrder::Edited(PictureNumber(2)),
            UpdateOrder::EditsDone(update),
            UpdateOrder::Transformed(PictureNumber(4), vec![7; 96]),
            UpdateOrder::Token(token),
            UpdateOrder::Accepted(token),
            UpdateOrder::Copied { update: 20 },
        ];
        orders.iter().for_each(|order| assert_eq!(&through_words(order), order));
    }
}
