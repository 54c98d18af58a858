//! Axes of charts: range, marks and labels.

use super::{readable, ticks};
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use std::ops::Range;

/// Scale of an axis.
#[derive(Clone, Debug, PartialEq)]
pub enum AxisScale {
    /// Linear scale from 0 to a little more than the greatest drawn number.
    FromZero,
    /// Linear scale from the smallest to the greatest drawn number, with some room beyond both.
    Fitted,
    /// Logarithmic scale in powers of ten. Zero and negative numbers have no position.
    Decades,
    /// Scale with one position for each name. The first name has position 0.
    Names(Vec<String>),
}

/// An axis of a chart, with a range that contains all drawn numbers.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    scale: AxisScale,
    /// Ends of the range: exponents of ten on a logarithmic axis, plain values on any other axis.
    pub(super) ends: (f64, f64),
}

impl Axis {
    /// Creates an axis whose range contains all elements of `numbers`, except NaN and numbers that the scale cannot
    /// show.
    pub(super) fn reaching(scale: &AxisScale, numbers: impl Iterator<Item = f64>) -> Self {
        let blank = Self { scale: scale.clone(), ends: (0.0, 1.0) };
        let places = numbers.map(|number| blank.place(number)).filter(|place| place.is_finite());
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |ends, p| (ends.0.min(p), ends.1.max(p)));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        let ends = match scale {
            AxisScale::FromZero => (0.0, widened(0.0, high.max(0.0)).1),
            AxisScale::Fitted => widened(low, high),
            AxisScale::Decades => (low.floor(), high.ceil().max(low.floor() + 1.0)),
            AxisScale::Names(names) => (-0.5, names.len().max(1) as f64 - 0.5),
        };
        Self { ends, ..blank }
    }

    /// Returns the position of a number on the axis (its logarithm on a logarithmic axis), or NaN if the number has no
    /// position.
    pub(super) fn place(&self, number: f64) -> f64 {
        match &self.scale {
            AxisScale::Decades if number > 0.0 => number.log10(),
            AxisScale::Decades => f64::NAN,
            _ => number,
        }
    }

    pub(super) fn marks(&self) -> Vec<f64> {
        let (low, high) = self.ends;
        match &self.scale {
            AxisScale::Decades => (low as i32..=high as i32).map(f64::from).collect(),
            AxisScale::Names(names) => (0..names.len()).map(|i| i as f64).collect(),
            _ => {
                let steps = ticks(high - low);
                let step = steps.get(1).copied().unwrap_or(high - low);
                let first = (low / step).ceil();
                let values = (0..=10).map(|i| readable((first + f64::from(i)) * step));
                values.take_while(|value| *value <= high).collect()
            }
        }
    }

    pub(super) fn label(&self, place: f64) -> String {
        match &self.scale {
            AxisScale::Decades => 10f64.powi(place as i32).to_string(),
            AxisScale::Names(names) => names.get(place as usize).cloned().unwrap_or_default(),
            _ => place.to_string(),
        }
    }
}

/// Makes the axis usable in the crate `plotters`, which receives positions on the axis instead of values.
impl Ranged for Axis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, place: &f64, (first, last): (i32, i32)) -> i32 {
        let (low, high) = self.ends;
        first + ((place - low) / (high - low) * f64::from(last - first)).round() as i32
    }

    fn key_points<H: KeyPointHint>(&self, _: H) -> Vec<f64> {
        self.marks()
    }

    fn range(&self) -> Range<f64> {
        self.ends.0..self.ends.1
    }
}

/// Extends a range by a twentieth of its length on both sides, so that no point lies on the edge of the chart. A range
/// of length zero is extended too.
fn widened(low: f64, high: f64) -> (f64, f64) {
    let room = if high > low { (high - low) / 20.0 } else { (high.abs() / 10.0).max(1e-9) };
    (low - room, high + room)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fitted_axis_has_round_marks_between_its_ends() {
        let axis = Axis::reaching(&AxisScale::Fitted, [13.0, 27.0].into_iter());
        assert_eq!(axis.ends, (12.3, 27.7));
        assert_eq!(axis.marks(), [14.0, 16.0, 18.0, 20.0, 22.0, 24.0, 26.0]);
    }

    /// Tests a logarithmic axis for the values 0.1 to 60, which must reach from 0.1 to 100. Values of 0 or less have no
    /// place on the axis.
    #[test]
    fn decades_end_at_powers_of_ten() {
        let axis = Axis::reaching(&AxisScale::Decades, [0.1, 60.0, 0.0, -3.0, f64::NAN].into_iter());
        assert_eq!(axis.ends, (-1.0, 2.0));
        assert_eq!(axis.marks().iter().map(|place| axis.label(*place)).collect::<Vec<_>>(), ["0.1", "1", "10", "100"]);
        assert!(axis.place(0.0).is_nan());
    }

    #[test]
    fn an_axis_without_values_is_drawn() {
        for scale in [AxisScale::FromZero, AxisScale::Fitted, AxisScale::Decades, AxisScale::Names(Vec::new())] {
            let axis = Axis::reaching(&scale, std::iter::empty());
            assert!(axis.ends.0 < axis.ends.1, "{scale:?}");
        }
    }

    #[test]
    fn on_an_axis_of_names_the_names_are_one_step_apart() {
        let names = AxisScale::Names(vec!["whole".to_owned(), "split".to_owned()]);
        let axis = Axis::reaching(&names, [0.0, 1.0].into_iter());
        assert_eq!((axis.ends, axis.label(1.0)), ((-0.5, 1.5), "split".to_owned()));
    }
}
