//! Numbers of periods, pictures and views: three counts that run side by side and are easily taken for each other.
//!
//! | number | counts | told by |
//! |---|---|---|
//! | [`PeriodNumber`] | periods of a display: fields of NTSC video, refreshes of the high-resolution monitor | the display's clock |
//! | [`PictureNumber`] | what a pipeline draws: frames, fields, batches of blocks | the pipeline's firmware |
//! | [`ViewNumber`] | poses and edits taken from the host | who asks the host |
//!
//! A picture is shown in a period and shows a view; which, only the pipeline can say, by
//! [`PictureNumber::drawn_for`], [`PictureNumber::period_drawn_for`], [`ViewNumber::taken_for`] and
//! [`ViewNumber::picture_taken_for`].

use crate::Word;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A number that counts from 0 and knows no arithmetic but that of its own kind. As text and as data it is the bare number.
macro_rules! count_from_zero {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub u64);

        impl $name {
            /// The first one: number 0.
            pub const FIRST: Self = Self(0);

            /// The one that follows; the last that can be counted follows itself.
            #[must_use]
            pub const fn next(self) -> Self {
                self.after(1)
            }

            /// The one that came `count` earlier; `None` before the first.
            #[must_use]
            pub const fn before(self, count: u64) -> Option<Self> {
                match self.0.checked_sub(count) {
                    Some(number) => Some(Self(number)),
                    None => None,
                }
            }

            /// The one that comes `count` later, at most the last that can be counted.
            #[must_use]
            pub const fn after(self, count: u64) -> Self {
                Self(self.0.saturating_add(count))
            }

            /// How many have come since an earlier one; 0 when that is later.
            #[must_use]
            pub const fn since(self, earlier: Self) -> u64 {
                self.0.saturating_sub(earlier.0)
            }

            /// This one and all that follow, without end.
            pub fn onwards(self) -> impl Iterator<Item = Self> {
                (self.0..).map(Self)
            }

            /// This one and those that follow, without `end`.
            pub fn until(self, end: Self) -> impl DoubleEndedIterator<Item = Self> + Clone {
                (self.0..end.0).map(Self)
            }

            /// Two words of the ring, the low one first.
            #[must_use]
            pub const fn to_words(self) -> [Word; 2] {
                [self.0 as Word, (self.0 >> 32) as Word]
            }

            /// The number whose low and high words these are.
            #[must_use]
            pub const fn from_words(low: Word, high: Word) -> Self {
                Self(low as u64 | (high as u64) << 32)
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                fmt::Display::fmt(&self.0, f)
            }
        }
    };
}

count_from_zero! {
    /// A period of a display, from one tick of its clock to the next; number n begins at tick n, and tick 0 is the start of
    /// simulated time. Of NTSC video it is a field (a retrace bears the number of the field that it begins), of the
    /// high-resolution frame buffer a refresh.
    PeriodNumber
}

count_from_zero! {
    /// A picture as its pipeline counts them from 0: all that is drawn for one moment and shown together, for every surface.
    /// A frame, both eyes, of Rendering Control, from its first; a field of Slats and of just-in-time pixels, which bears
    /// the number of the period that it is drawn for; a batch of blocks of frameless rendering, from its first.
    PictureNumber
}

count_from_zero! {
    /// A view: one pose of the head, and the edits with it, as the host gave them. Whoever asks the host numbers its
    /// questions: Rendering Control and frameless rendering one for each picture, Slats one for each transmission from 0,
    /// just-in-time pixels so many for each field.
    ViewNumber
}

impl PictureNumber {
    /// The picture that is drawn for a period, of a pipeline that draws one for every period (Slats, just-in-time pixels):
    /// it bears the period's number.
    #[must_use]
    pub const fn drawn_for(period: PeriodNumber) -> Self {
        Self(period.0)
    }

    /// The period that a picture of such a pipeline is drawn for; of others this says nothing.
    #[must_use]
    pub const fn period_drawn_for(self) -> PeriodNumber {
        PeriodNumber(self.0)
    }
}

impl ViewNumber {
    /// The view that is taken for a picture, of a pipeline that takes one for every picture (Rendering Control, frameless
    /// rendering): it bears the picture's number.
    #[must_use]
    pub const fn taken_for(picture: PictureNumber) -> Self {
        Self(picture.0)
    }

    /// The picture that a view of such a pipeline is taken for; of others this says nothing.
    #[must_use]
    pub const fn picture_taken_for(self) -> PictureNumber {
        PictureNumber(self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counting_ends_at_both_ends_instead_of_going_round() {
        assert_eq!(PeriodNumber::FIRST.before(1), None);
        assert_eq!(PeriodNumber(5).before(2), Some(PeriodNumber(3)));
        assert_eq!(PeriodNumber(u64::MAX).next(), PeriodNumber(u64::MAX));
        assert_eq!(PeriodNumber(3).since(PeriodNumber(5)), 0);
        assert_eq!(PeriodNumber(5).since(PeriodNumber(3)), 2);
    }

    #[test]
    fn a_range_has_its_begin_and_not_its_end() {
        let range: Vec<_> = PictureNumber(2).until(PictureNumber(4)).collect();
        assert_eq!(range, [PictureNumber(2), PictureNumber(3)]);
        assert_eq!(PictureNumber(4).until(PictureNumber(2)).count(), 0);
        assert_eq!(PictureNumber(7).onwards().nth(1), Some(PictureNumber(8)));
    }

    #[test]
    fn words_are_low_and_high() {
        assert_eq!(ViewNumber((5 << 32) + 6).to_words(), [6, 5]);
        assert_eq!(ViewNumber::from_words(6, 5), ViewNumber((5 << 32) + 6));
    }

    #[test]
    fn as_text_it_is_the_bare_number_with_its_width() {
        assert_eq!(format!("{:>4}|{:04}", PeriodNumber(12), PictureNumber(7)), "  12|0007");
    }
}
