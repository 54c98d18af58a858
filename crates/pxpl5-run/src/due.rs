//! Which pictures were due in a run, and what became of each of them.
//!
//! | word | meaning |
//! |---|---|
//! | due | a display's period in which a new picture should be seen, by the pipeline's own cadence |
//! | shown | it was there, whole and in time |
//! | late | it was whole before its period ended, but came after its time |
//! | incomplete | it was begun, and not whole when its period ended |
//! | missed | it was never begun, or left out |
//!
//! A picture is judged when its period ends, so that none is judged otherwise in a longer run.

use crate::picture_ends::{PictureEnd, PictureEnds};
use crate::result_window::ResultWindow;
use pxpl5_wire::PeriodNumber;
use serde::Serialize;

/// Fewest pictures in a window that have a rate.
pub(crate) const LEAST_UPDATES: u64 = 2;

/// The pictures that were due in a window of a run, each of which ended in one of four ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct DuePictures {
    /// First period of the window.
    pub first_period: PeriodNumber,
    /// Last period of the window.
    pub last_period: PeriodNumber,
    /// Periods from one picture that is due to the next.
    pub periods_a_picture: u64,
    /// Pictures due: the periods of the window over those of a picture.
    pub due: u64,
    /// Those that were whole and in time.
    pub shown: u64,
    /// Those that were whole before their period ended, but not in time.
    pub late: u64,
    /// Those that were not whole when their period ended.
    pub incomplete: u64,
    /// Those that were never begun, or left out.
    pub missed: u64,
    /// Pictures that were whole and in time, due or not, in the periods of the window. More than `shown` where pictures come more
    /// often than they are due.
    pub pictures: u64,
}

impl DuePictures {
    /// Counts them. `pictures` gives the period in which each picture that was begun should be seen, and its end, in the order of
    /// periods; `periods_a_picture` is the cadence, and `reached` the first period that was not over when the run ended.
    ///
    /// A picture that comes before it is due, but after the one before it was, is shown. `None` when no whole picture was due.
    #[must_use]
    pub fn count(
        pictures: impl Iterator<Item = (PeriodNumber, PictureEnd)>,
        periods_a_picture: u64,
        reached: PeriodNumber,
    ) -> Option<Self> {
        let mut ends = PictureEnds::default();
        pictures.filter(|(period, _)| *period < reached).for_each(|(period, end)| ends.note(period, end));
        let window = ResultWindow::of(&ends, Some(periods_a_picture), reached, reached)?;
        Some(Self::of_ends(&ends, periods_a_picture, &window))
    }

    /// Counts those of a window.
    pub(crate) fn of_ends(ends: &PictureEnds, periods_a_picture: u64, window: &ResultWindow) -> Self {
        let every = periods_a_picture.max(1);
        let ResultWindow { first_period, last_period, .. } = *window;
        let due = (first_period.0 + every - 1..=last_period.0).step_by(every as usize);
        let mut counts = [0; 4];
        due.for_each(|period| counts[ends.best(period, every).map_or(3, |end| end as usize)] += 1);
        let [shown, late, incomplete, missed] = counts;
        let due = counts.iter().sum();
        let pictures = ends.periods_shown([first_period, last_period]);
        Self { first_period, last_period, periods_a_picture: every, due, shown, late, incomplete, missed, pictures }
    }

    /// Pictures that were due and not shown: late, incomplete and missed.
    #[must_use]
    pub const fn not_shown(&self) -> u64 {
        self.due - self.shown
    }

    /// Their share of all that were due, 0 to 1.
    #[must_use]
    pub const fn not_shown_share(&self) -> f64 {
        self.not_shown() as f64 / self.due as f64
    }

    /// Whether the load is too heavy for the pipeline: pictures were begun that were not whole in time; or, where pictures have
    /// no time and only become fewer, fewer than half of those due were shown.
    #[must_use]
    pub const fn is_too_heavy(&self) -> bool {
        self.late + self.incomplete > 0 || 2 * self.shown < self.due
    }

    /// Returns the pictures shown a second, where a period of the display takes `period_ms`; `None` where fewer than two were
    /// shown, since a single one has no rate.
    #[must_use]
    pub fn updates_hz(&self, period_ms: f64) -> Option<f64> {
        let window_ms = (self.due * self.periods_a_picture) as f64 * period_ms;
        (self.pictures >= LEAST_UPDATES).then_some(self.pictures as f64 * 1e3 / window_ms)
    }
}
