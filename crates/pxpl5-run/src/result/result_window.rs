//! The result window: the display periods over which latencies, due pictures, errors and rates are computed.
//!
//! The window begins with the first due picture after the warm-up. The warm-up ends after [`WARM_UP_PERIODS`] display
//! periods and [`WARM_UP_PICTURES`](crate::WARM_UP_PICTURES) pictures.
//!
//! If a due picture in the first half of the run was not shown, the window begins with this picture. No failure is
//! therefore left out. Earlier pictures may have been in time only because queues were still empty. Pictures of the
//! warm-up never have a latency or an error.
//!
//! The window ends with the last complete period, or one period earlier if no picture is ever due.

use crate::result::picture_ends::{PictureResult, PictureResults};
use pxpl5_wire::PeriodNumber;
use serde::{Deserialize, Serialize};

/// Number of display periods at the start of a run that are not evaluated (assumed).
///
/// In these periods, the pipeline still fills.
pub const WARM_UP_PERIODS: u64 = 8;

/// The rule for the result window, as text in reports.
pub const WINDOW_DEFINITION: &str = "latencies, due pictures, errors and rates cover one window; it begins with the 9th period of the \
    display, or with the first period of the fifth picture if that is later, and it ends with the last complete period; if a picture \
    due in the first half of the run was not shown, it begins with the first such picture, because earlier pictures may have profited \
    from empty queues; the first four pictures have no latency and no error, and count as shown only if a later one was shown";

/// The display periods over which the results of a run are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ResultWindow {
    /// First display period of the result window.
    pub first_period: PeriodNumber,
    /// Last display period of the result window, inclusive.
    pub last_period: PeriodNumber,
    #[serde(skip)]
    steady_from: Option<PeriodNumber>,
}

impl ResultWindow {
    /// Returns the result window of a run that has ended. Returns `None` if the periods after the warm-up are too few
    /// for a due picture.
    ///
    /// `reached` is the first period that was not simulated to its end. `every` is the number of periods from one due
    /// picture to the next, or `None` if no picture is ever due. `planned` is the requested number of periods.
    pub(crate) fn of(
        ends: &PictureResults,
        every: Option<u64>,
        reached: PeriodNumber,
        planned: PeriodNumber,
    ) -> Option<Self> {
        let begun = Self::begun(ends, every, reached, planned);
        // Without due pictures, a picture that is seen in the last period may become complete in a later period.
        let end = if every.is_some() { reached.0 } else { reached.0.checked_sub(1)? };
        let periods = end.checked_sub(begun.first_period.0)?;
        let every = every.unwrap_or(1).max(1);
        // The window covers whole intervals between due pictures.
        let whole = periods / every * every;
        let last_period = PeriodNumber((begun.first_period.0 + whole).checked_sub(1)?);
        (whole > 0).then_some(Self { last_period, ..begun })
    }

    /// Returns the result window so far, for a run that continues to the period `planned`. All pictures before the
    /// period `recorded_to` must have been recorded.
    pub(crate) fn begun(
        ends: &PictureResults,
        every: Option<u64>,
        recorded_to: PeriodNumber,
        planned: PeriodNumber,
    ) -> Self {
        let steady_from = ends.steady_from();
        // The warm-up may take at most the first half of the requested run.
        let middle = WARM_UP_PERIODS + planned.0.saturating_sub(WARM_UP_PERIODS) / 2;
        let start = ends.first_from(0).unwrap_or_default().min(middle);
        // If the warm-up takes more than half of the run, due pictures are counted from the first picture on.
        let steady = steady_from.map(|period| period.0).filter(|period| *period < middle).unwrap_or(start);
        let first = every.map_or(steady.max(WARM_UP_PERIODS), |every| {
            let every = every.max(1);
            let start = start.max(WARM_UP_PERIODS + every - 1);
            let of_first_half = recorded_to.0.min(middle);
            first_due(ends, every, [start, steady], of_first_half) + 1 - every
        });
        let last_period = PeriodNumber(planned.0.saturating_sub(1));
        Self { first_period: PeriodNumber(first), last_period, steady_from }
    }

    /// Moves the start of the window to a later period if the window begins before `from`. The start moves by the
    /// smallest multiple of `every` periods with which the window begins at or after `from`.
    ///
    /// `every` is the number of periods from one due picture to the next. `None` counts as 1. Returns `None` if no
    /// period of the window remains.
    pub(crate) fn not_before(self, from: Option<PeriodNumber>, every: Option<u64>) -> Option<Self> {
        let every = every.unwrap_or(1).max(1);
        let later = from.map_or(0, |from| from.0.saturating_sub(self.first_period.0).div_ceil(every) * every);
        let first_period = PeriodNumber(self.first_period.0 + later);
        (first_period <= self.last_period).then_some(Self { first_period, ..self })
    }

    /// Returns true if the display period `period` lies in the result window.
    pub fn holds(&self, period: PeriodNumber) -> bool {
        (self.first_period..=self.last_period).contains(&period)
    }

    /// Returns true if a picture that is first shown in `period` lies in the result window and after the warm-up.
    pub fn holds_picture(&self, period: PeriodNumber) -> bool {
        self.steady_from.is_some_and(|steady| steady <= period) && self.holds(period)
    }

    /// Returns the number of display periods in the result window.
    pub const fn periods(&self) -> u64 {
        self.last_period.0 + 1 - self.first_period.0
    }
}

/// Returns the due period of the first picture in the result window.
///
/// This picture is the first picture between `start` and `end` that was due but not shown. If there is none, the
/// picture is the first due picture at or after `steady`.
fn first_due(ends: &PictureResults, every: u64, [start, steady]: [u64; 2], end: u64) -> u64 {
    // The first picture defines in which periods pictures are due.
    let anchor = ends.first_from(start).unwrap_or(start);
    let first = start + (anchor - start) % every;
    let failed = (first..end).step_by(every as usize).find(|due| ends.best(*due, every) != Some(PictureResult::Shown));
    failed.unwrap_or(first + steady.saturating_sub(first).div_ceil(every) * every)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(first: u64, last: u64) -> ResultWindow {
        let [first_period, last_period] = [first, last].map(PeriodNumber);
        ResultWindow { first_period, last_period, steady_from: None }
    }

    #[test]
    fn a_window_that_begins_later_keeps_whole_intervals_between_due_pictures() {
        let from = |period| Some(PeriodNumber(period));
        assert_eq!(window(9, 99).not_before(from(20), Some(3)), Some(window(21, 99)), "9 + 4 x 3");
        assert_eq!(window(9, 99).not_before(from(20), None), Some(window(20, 99)));
        assert_eq!(window(30, 99).not_before(from(20), Some(3)), Some(window(30, 99)), "the warm-up took longer");
        assert_eq!(window(9, 99).not_before(from(100), Some(1)), None);
        assert_eq!(window(9, 99).not_before(None, Some(3)), Some(window(9, 99)));
    }
}
