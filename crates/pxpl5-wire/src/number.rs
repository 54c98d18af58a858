//! Numbers of periods, pictures and views. The three counts are independent of each other.
//!
//! | number | counts | counted by |
//! |---|---|---|
//! | [`PeriodNumber`] | periods of a display: fields of NTSC video, refreshes of the high-resolution monitor | the display's clock |
//! | [`PictureNumber`] | pictures of a pipeline: frames, fields, batches of blocks | the pipeline's firmware |
//! | [`ViewNumber`] | poses and edits received from the host | the program that requests the views |
//!
//! A picture is shown in a period, and shows a view. How the three counts are related depends on the pipeline:
//! [`PictureNumber::drawn_for`], [`PictureNumber::period_drawn_for`], [`ViewNumber::taken_for`] and
//! [`ViewNumber::picture_taken_for`].

use crate::Word;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Declares a number type that counts from 0. Arithmetic combines only numbers of the same type. Text and data files
/// contain only the number, without the name of the type.
macro_rules! count_from_zero {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub u64);

        impl $name {
            pub const FIRST: Self = Self(0);

            /// Returns the next number. The greatest number of the type is returned unchanged.
            #[must_use]
            pub const fn next(self) -> Self {
                self.after(1)
            }

            /// Returns the number that is lower by `count`. Returns `None` if the result would be negative.
            pub const fn before(self, count: u64) -> Option<Self> {
                match self.0.checked_sub(count) {
                    Some(number) => Some(Self(number)),
                    None => None,
                }
            }

            /// Returns the number that is higher by `count`. The result is at most the greatest number of the type.
            #[must_use]
            pub const fn after(self, count: u64) -> Self {
                Self(self.0.saturating_add(count))
            }

            /// Returns the distance from the number `earlier` to this number. Returns 0 if `earlier` is the greater
            /// number.
            pub const fn since(self, earlier: Self) -> u64 {
                self.0.saturating_sub(earlier.0)
            }

            pub fn onwards(self) -> impl Iterator<Item = Self> {
                (self.0..).map(Self)
            }

            /// Iterates over the numbers from this number up to, but not including, `end`.
            pub fn until(self, end: Self) -> impl DoubleEndedIterator<Item = Self> + Clone {
                (self.0..end.0).map(Self)
            }

            /// Returns the number as two ring words, the low word first.
            pub const fn to_words(self) -> [Word; 2] {
                [self.0 as Word, (self.0 >> 32) as Word]
            }

            /// Makes a number from its low word and its high word.
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
    /// The number of a display period.
    ///
    /// A period is the time from one tick of the display's clock to the next. Number n begins at tick n, and tick 0 is
    /// the start of simulated time. A period of NTSC video is a field. A retrace has the number of the field that
    /// begins with it. A period of the high-resolution frame buffer is a refresh.
    PeriodNumber
}

count_from_zero! {
    /// The number of a picture.
    ///
    /// A picture is everything that a pipeline draws for one moment and shows together, on all surfaces. Each pipeline
    /// counts its pictures from 0. A picture of Rendering Control is a frame with both eyes. A picture of Slats or
    /// just-in-time pixels is a field and has the number of its period. A picture of frameless rendering is a batch of
    /// blocks.
    PictureNumber
}

count_from_zero! {
    /// The number of a view.
    ///
    /// A view is one pose of the head, with edits of the scene, as received from the host. The program that requests
    /// the views also assigns their numbers. Rendering Control and frameless rendering request one view for each
    /// picture. Slats requests one view for each transmission. Just-in-time pixels request a fixed number of views for
    /// each field.
    ViewNumber
}

impl PictureNumber {
    /// Returns the number of the picture that is drawn for a period. The result is valid only in pipelines that draw
    /// one picture for every period: Slats and just-in-time pixels. The picture and the period have equal numbers.
    pub const fn drawn_for(period: PeriodNumber) -> Self {
        Self(period.0)
    }

    /// Returns the number of the period for which a picture is drawn. The result is valid only in pipelines that draw
    /// one picture for every period.
    pub const fn period_drawn_for(self) -> PeriodNumber {
        PeriodNumber(self.0)
    }
}

impl ViewNumber {
    /// Returns the number of the view that a picture shows. The result is valid only in pipelines that request one view
    /// for every picture: Rendering Control and frameless rendering. The view and the picture have equal numbers.
    pub const fn taken_for(picture: PictureNumber) -> Self {
        Self(picture.0)
    }

    /// Returns the number of the picture that shows a view. The result is valid only in pipelines that request one view
    /// for every picture.
    pub const fn picture_taken_for(self) -> PictureNumber {
        PictureNumber(self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn period_numbers_saturate_instead_of_wrapping() {
        assert_eq!(PeriodNumber::FIRST.before(1), None);
        assert_eq!(PeriodNumber(5).before(2), Some(PeriodNumber(3)));
        assert_eq!(PeriodNumber(u64::MAX).next(), PeriodNumber(u64::MAX));
        assert_eq!(PeriodNumber(3).since(PeriodNumber(5)), 0);
        assert_eq!(PeriodNumber(5).since(PeriodNumber(3)), 2);
    }

    #[test]
    fn a_range_includes_its_start_and_excludes_its_end() {
        let range: Vec<_> = PictureNumber(2).until(PictureNumber(4)).collect();
        assert_eq!(range, [PictureNumber(2), PictureNumber(3)]);
        assert_eq!(PictureNumber(4).until(PictureNumber(2)).count(), 0);
        assert_eq!(PictureNumber(7).onwards().nth(1), Some(PictureNumber(8)));
    }

    #[test]
    fn a_number_is_split_into_low_and_high_words() {
        assert_eq!(ViewNumber((5 << 32) + 6).to_words(), [6, 5]);
        assert_eq!(ViewNumber::from_words(6, 5), ViewNumber((5 << 32) + 6));
    }

    #[test]
    fn a_number_prints_as_plain_digits_with_the_requested_width() {
        assert_eq!(format!("{:>4}|{:04}", PeriodNumber(12), PictureNumber(7)), "  12|0007");
    }
}
