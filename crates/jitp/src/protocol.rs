//! Messages between host, master and slaves, as words on the ring.

use pphigs::FrameView;
use pxpl5_gp::{Fault, Received};
use pxpl5_sim::Time;
use pxpl5_wire::{Body, NodeId, PeriodNumber, PictureNumber, Word};

const FIELD: Word = 0x1F1E_1D00;
const STRIP: Word = 0x1F1E_1D01;
const BLOCKS: Word = 0x1F1E_1D02;
const REPORT: Word = 0x1F1E_1D03;
const DONE: Word = 0x1F1E_1D04;

/// Number of words of a tracker report: a header, two times, a position and a quaternion, with 64 bits for each number.
pub(crate) const REPORT_WORDS: u32 = 20;

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum DrawingOrder {
    /// Order to transform the display list for one view, or for the views at the start and at the end of a field.
    Field { field: PeriodNumber, views: Vec<FrameView> },
    /// Order to draw a strip. If `view` is `None`, the strip uses the views of its field.
    Strip { field: PeriodNumber, strip: u32, deadline: Time, view: Option<FrameView> },
    /// Order to draw a batch of blocks. The first block is drawn in the step `step` of the random sequence.
    Blocks { update: PictureNumber, step: u64, view: FrameView },
    /// A tracker report from the host. The master may use all reports that the host received before `reports_until`.
    Report { reports_until: Time },
    /// The slave has finished an order and is ready for the next order.
    Done { slave: u32 },
}

impl DrawingOrder {
    pub(crate) fn message(&self) -> (u32, Body) {
        let words = self.words();
        (words.len() as u32, Body::Words(words.into()))
    }

    pub(crate) fn words(&self) -> Vec<Word> {
        let mut words = Vec::new();
        // The first word states the kind of order. A 64-bit number takes two words, the low word first.
        match self {
            Self::Field { field, views } => {
                let [field_low, field_high] = field.to_words();
                words.extend([FIELD, field_low, field_high, views.len() as Word]);
                for view in views {
                    push_view(&mut words, view);
                }
            }
            Self::Strip { field, strip, deadline, view } => {
                let [field_low, field_high] = field.to_words();
                words.extend([STRIP, field_low, field_high, *strip, low(deadline.0), high(deadline.0)]);
                view.iter().for_each(|view| push_view(&mut words, view));
            }
            Self::Blocks { update, step, view } => {
                let [update_low, update_high] = update.to_words();
                words.extend([BLOCKS, update_low, update_high, low(*step), high(*step)]);
                push_view(&mut words, view);
            }
            Self::Report { reports_until } => {
                words.extend([REPORT, low(reports_until.0), high(reports_until.0)]);
                words.resize(REPORT_WORDS as usize, 0);
            }
            Self::Done { slave } => words.extend([DONE, *slave]),
        }
        words
    }

    pub(crate) fn head_words(&self) -> usize {
        match self {
            Self::Field { .. } => 4,
            Self::Strip { .. } => 6,
            Self::Blocks { .. } => 5,
            Self::Report { .. } | Self::Done { .. } => self.words().len(),
        }
    }

    pub(crate) fn read(received: &Received, node: NodeId) -> Result<Self, Fault> {
        let order = match &received.body {
            Body::Words(words) => Self::from_words(words),
            Body::Commands(_) | Body::Pixels(_) => None,
        };
        order.ok_or_else(|| Fault::Protocol { node, found: format!("from node {}", received.source.0) })
    }

    fn from_words(words: &[Word]) -> Option<Self> {
        // A view is preceded by its length in words.
        Some(match words {
            [FIELD, a, b, count, rest @ ..] if *count > 0 => {
                let mut rest = rest;
                let views = (0..*count).map(|_| take_view(&mut rest)).collect::<Option<_>>()?;
                Self::Field { field: PeriodNumber::from_words(*a, *b), views }
            }
            [STRIP, a, b, strip, c, d, rest @ ..] => {
                let mut rest = rest;
                let view = if rest.is_empty() { None } else { Some(take_view(&mut rest)?) };
                Self::Strip {
                    field: PeriodNumber::from_words(*a, *b),
                    strip: *strip,
                    deadline: Time(long(*c, *d)),
                    view,
                }
            }
            [BLOCKS, a, b, c, d, rest @ ..] => {
                let mut rest = rest;
                Self::Blocks {
                    update: PictureNumber::from_words(*a, *b),
                    step: long(*c, *d),
                    view: take_view(&mut rest)?,
                }
            }
            [REPORT, a, b, ..] => Self::Report { reports_until: Time(long(*a, *b)) },
            [DONE, slave] => Self::Done { slave: *slave },
            _ => return None,
        })
    }
}

fn push_view(words: &mut Vec<Word>, view: &FrameView) {
    let of_view = view.to_words();
    words.push(of_view.len() as Word);
    words.extend(of_view);
}

fn take_view(words: &mut &[Word]) -> Option<FrameView> {
    let (length, rest) = words.split_first()?;
    let (view, rest) = rest.split_at_checked(*length as usize)?;
    *words = rest;
    FrameView::from_words(view).ok()
}

const fn low(v: u64) -> Word {
    v as Word
}

const fn high(v: u64) -> Word {
    (v >> 32) as Word
}

fn long(low: Word, high: Word) -> u64 {
    u64::from(low) | u64::from(high) << 32
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Mat4;
    use pphigs::EyeView;
    use pxpl5_wire::ViewNumber;

    fn view(number: u64) -> FrameView {
        let number = ViewNumber(number);
        let eye = EyeView { world_to_eye: Mat4::IDENTITY, head_to_eye: Mat4::IDENTITY, projection: Mat4::IDENTITY };
        FrameView { number, eyes: vec![eye], edits: Vec::new() }
    }

    impl DrawingOrder {
        fn views(&self) -> Vec<FrameView> {
            match self.clone() {
                Self::Field { views, .. } => views,
                Self::Strip { view, .. } => view.into_iter().collect(),
                Self::Blocks { view, .. } => vec![view],
                Self::Report { .. } | Self::Done { .. } => Vec::new(),
            }
        }
    }

    #[test]
    fn every_order_is_decoded_from_its_words() {
        let big = (1 << 40) + 3;
        for order in [
            DrawingOrder::Field { field: PeriodNumber(big), views: vec![view(1), view(2)] },
            DrawingOrder::Strip { field: PeriodNumber(big), strip: 239, deadline: Time(big), view: None },
            DrawingOrder::Strip { field: PeriodNumber(1), strip: 0, deadline: Time(2), view: Some(view(big)) },
            DrawingOrder::Blocks { update: PictureNumber(big), step: big + 1, view: view(3) },
            DrawingOrder::Report { reports_until: Time(big) },
            DrawingOrder::Done { slave: 11 },
        ] {
            let (words, body) = order.message();
            let of_views = order.words().len() - order.head_words();
            let views: usize = order.views().iter().map(|view| 1 + view.to_words().len()).sum();
            assert_eq!(of_views, views, "each with its length");
            let received = Received { arrived: Time(0), source: NodeId(1), body };
            assert_eq!(DrawingOrder::read(&received, NodeId(0)), Ok(order.clone()));
            assert!(words <= pxpl5_wire::MAX_MESSAGE_WORDS);
        }
    }

    #[test]
    fn truncated_words_are_a_fault_and_no_panic() {
        let (_, body) = DrawingOrder::Field { field: PeriodNumber(1), views: vec![view(1)] }.message();
        let Body::Words(words) = body else { panic!("orders are words") };
        for length in 0..words.len() {
            assert_eq!(DrawingOrder::from_words(&words[..length]), None, "{length}");
        }
    }

    #[test]
    fn a_field_without_a_view_is_refused() {
        let (_, body) = DrawingOrder::Field { field: PeriodNumber(1), views: Vec::new() }.message();
        let Body::Words(words) = body else { panic!("orders are words") };
        assert_eq!(DrawingOrder::from_words(&words), None);
    }
}
