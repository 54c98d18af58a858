//! Counts of the pictures that were due in a run, by result.
//!
//! | word | meaning |
//! |---|---|
//! | due | a pipeline at its nominal rate shows a new picture in this period of the display |
//! | shown | the picture was complete and in time |
//! | late | the picture was complete before its period ended, but after its deadline |
//! | incomplete | the picture was begun, but not complete when its period ended |
//! | missed | the picture was never begun, or left out |
//!
//! A picture is evaluated when its period ends, so a longer run does not change the result.

use crate::result::picture_ends::{PictureResult, PictureResults};
use crate::result::result_window::ResultWindow;
use pxpl5_wire::PeriodNumber;
use serde::Serialize;

pub(crate) const MIN_UPDATES: u64 = 2;

/// Numbers of pictures that were due in the result window of a run.
///
/// Each due picture was shown, late, incomplete or missed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct DuePictures {
    /// First display period of the result window.
    pub first_period: PeriodNumber,
    /// Last display period of the result window, inclusive.
    pub last_period: PeriodNumber,
    /// Number of display periods from one due picture to the next.
    pub periods_a_picture: u64,
    /// Number of pictures due: the periods of the result window divided by `periods_a_picture`. If no picture after the
    /// warm-up was shown, pictures of the warm-up that were shown are left out.
    pub due: u64,
    /// Number of due pictures that were complete and in time.
    pub shown: u64,
    /// Number of due pictures that were complete before their period ended, but after their deadline.
    pub late: u64,
    /// Number of due pictures that were incomplete when their period ended.
    pub incomplete: u64,
    /// Number of due pictures that were never begun, or left out.
    pub missed: u64,
    /// Number of periods of the result window whose picture was complete and in time. Unlike `shown`, this number also
    /// counts periods in which no picture was due.
    pub pictures: u64,
}

impl DuePictures {
    /// Counts the due pictures of a run by result. Returns `None` if no complete picture was due, or if the run ended in
    /// its warm-up.
    ///
    /// Each item of `pictures` is a picture that was begun: its display period and its result, in order of periods.
    /// `periods_a_picture` is the number of periods from one due picture to the next. `reached` is the first period
    /// that was not over when the run ended.
    ///
    /// A picture also counts as shown if it is shown before its due period, but after the preceding due period.
    pub fn count(
        pictures: impl Iterator<Item = (PeriodNumber, PictureResult)>,
        periods_a_picture: u64,
        reached: PeriodNumber,
    ) -> Option<Self> {
        let mut ends = PictureResults::default();
        pictures.filter(|(period, _)| *period < reached).for_each(|(period, end)| ends.note(period, end));
        let window = ResultWindow::of(&ends, Some(periods_a_picture), reached, reached)?;
        Self::of_ends(&ends, periods_a_picture, &window)
    }

    pub(crate) fn of_ends(ends: &PictureResults, periods_a_picture: u64, window: &ResultWindow) -> Option<Self> {
        let periods_a_picture = periods_a_picture.max(1);
        let ResultWindow { first_period, last_period, .. } = *window;
        // Each due picture may be shown in any of the periods since the last due picture.
        let due = (first_period.0 + periods_a_picture - 1..=last_period.0).step_by(periods_a_picture as usize);
        let mut counts = [0; 4];
        due.for_each(|period| counts[ends.best(period, periods_a_picture).map_or(3, |end| end as usize)] += 1);
        let [shown, late, incomplete, missed] = counts;
        let due = counts.iter().sum();
        let pictures = ends.periods_shown([first_period, last_period]);
        let all = Self { first_period, last_period, periods_a_picture, due, shown, late, incomplete, missed, pictures };
        // Pictures of the warm-up have no latency. Without a later one, they do not count, and the run was too short, or
        // its scene is too heavy.
        let is_result = |period| window.holds_picture(period) && ends.periods_shown([period; 2]) > 0;
        if first_period.until(last_period.next()).any(is_result) {
            return Some(all);
        }
        all.is_too_heavy().then(|| Self { due: all.not_shown(), shown: 0, pictures: 0, ..all })
    }

    /// Returns the number of due pictures that were not shown: late, incomplete and missed pictures.
    pub const fn not_shown(&self) -> u64 {
        self.due - self.shown
    }

    /// Returns the share of due pictures that were not shown, from 0 to 1.
    pub const fn not_shown_share(&self) -> f64 {
        self.not_shown() as f64 / self.due as f64
    }

    /// Returns true if the scene is too heavy for the pipeline.
    ///
    /// This is the case if any due picture was late or incomplete, or if fewer than half of the due pictures were
    /// shown.
    pub const fn is_too_heavy(&self) -> bool {
        self.late + self.incomplete > 0 || 2 * self.shown < self.due
    }

    /// Returns the number of pictures shown per second, for a display period of `period_ms` milliseconds. Returns
    /// `None` if fewer than two pictures were shown.
    pub fn updates_hz(&self, period_ms: f64) -> Option<f64> {
        let window_ms = (self.due * self.periods_a_picture) as f64 * period_ms;
        (self.pictures >= MIN_UPDATES).then_some(self.pictures as f64 * 1e3 / window_ms)
    }
}
