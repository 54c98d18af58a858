//! Rows of a picture that a display period lights: all rows, or the rows of one field.

use pxpl5_wire::PeriodNumber;
use pxpl5_wire::display::Display;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rows {
    pub(crate) first: u32,
    pub(crate) distance: u32,
}

impl Rows {
    pub(crate) const ALL: Self = Self { first: 0, distance: 1 };

    pub(crate) fn lit(display: &dyn Display, period: PeriodNumber) -> Self {
        let (first, distance) = display.rows_lit(period);
        Self { first, distance }
    }

    pub(crate) fn of(self, height: u32) -> impl Iterator<Item = u32> + Clone {
        (self.first..height).step_by(self.distance as usize)
    }

    pub(crate) const fn count(self, height: u32) -> u32 {
        height.saturating_sub(self.first).div_ceil(self.distance)
    }

    /// Returns row `number` of the lit rows, counted from 0, as a row of the picture.
    pub(crate) const fn row(self, number: u32) -> u32 {
        self.first + number * self.distance
    }

    /// Returns the lit row beside `row`. In an interlaced picture, each even row belongs together with the odd row
    /// below it, and only one of the two is lit.
    pub(crate) const fn beside(self, row: u32) -> u32 {
        row / self.distance * self.distance + self.first
    }

    /// Converts the vertical position `y` in pixels to a position among the lit rows, counted from 0. The middle of a
    /// lit row gives a whole number.
    pub(crate) fn number_at(self, y: f64) -> f64 {
        (y - 0.5 - f64::from(self.first)) / f64::from(self.distance)
    }

    pub(crate) fn nearest(self, y: f64, height: u32) -> u32 {
        let last = (height - 1 - self.first) / self.distance;
        self.row((self.number_at(y).round().max(0.0) as u32).min(last))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EVEN: Rows = Rows { first: 0, distance: 2 };
    const ODD: Rows = Rows { first: 1, distance: 2 };

    #[test]
    fn a_position_belongs_to_the_nearest_row_of_the_same_field() {
        for (y, rows, expected) in [(10.5, EVEN, 10), (11.4, EVEN, 10), (11.6, EVEN, 12), (10.5, ODD, 11)] {
            assert_eq!(rows.nearest(y, 480), expected, "{y} {rows:?}");
        }
        assert_eq!([ODD.nearest(-3.0, 480), EVEN.nearest(480.0, 480)], [1, 478]);
    }

    #[test]
    fn two_fields_share_the_rows_of_a_picture() {
        let rows: Vec<u32> = EVEN.of(7).chain(ODD.of(7)).collect();
        assert_eq!(rows, [0, 2, 4, 6, 1, 3, 5]);
        assert_eq!([EVEN.count(7), ODD.count(7), Rows::ALL.count(7)], [4, 3, 7]);
        for number in 0..3 {
            assert_eq!(ODD.number_at(f64::from(ODD.row(number)) + 0.5), f64::from(number));
        }
        assert_eq!([ODD.beside(4), ODD.beside(5), EVEN.beside(5), Rows::ALL.beside(5)], [5, 5, 4, 5]);
    }
}
