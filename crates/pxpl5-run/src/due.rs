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

use crate::result_window::{ResultWindow, WARM_UP_PICTURES};
use pxpl5_wire::PeriodNumber;
use serde::Serialize;

/// Fewest pictures in a window that have a rate.
pub(crate) const LEAST_UPDATES: u64 = 2;

/// What became of a picture that was begun, the best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PictureEnd {
    /// It was whole, and in time.
    Shown,
    /// It was whole before its period ended, but not in time.
    Late,
    /// It was not whole when its period ended.
    Incomplete,
}

impl PictureEnd {
    /// Of a picture all of which was, or was not, there when its period ended, and in time.
    #[must_use]
    pub const fn of(is_whole: bool, is_in_time: bool) -> Self {
        match (is_whole, is_in_time) {
            (true, true) => Self::Shown,
            (true, false) => Self::Late,
            (false, _) => Self::Incomplete,
        }
    }
}

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

/// What became of the pictures of each period: a byte for a period, so that 10^7 fields take 10 MB.
#[derive(Clone, Debug, Default)]
pub(crate) struct PictureEnds {
    /// Of each period, 0 for no picture, else one more than the place of the best end among all ends.
    of_periods: Vec<u8>,
    begun: usize,
    steady_from: Option<PeriodNumber>,
}

impl PictureEnds {
    const ALL: [PictureEnd; 3] = [PictureEnd::Shown, PictureEnd::Late, PictureEnd::Incomplete];

    /// Notes the end of a picture that should be seen in a period. Pictures come in the order of their periods.
    pub(crate) fn note(&mut self, period: PeriodNumber, end: PictureEnd) {
        self.begun += 1;
        if self.begun > WARM_UP_PICTURES {
            self.steady_from.get_or_insert(period);
        }
        let place = period.0 as usize;
        if self.of_periods.len() <= place {
            self.of_periods.resize(place + 1, 0);
        }
        let best = &mut self.of_periods[place];
        let code = end as u8 + 1;
        *best = if *best == 0 { code } else { code.min(*best) };
    }

    /// The period of the first picture behind [`WARM_UP_PICTURES`]; `None` where no more were begun.
    pub(crate) const fn steady_from(&self) -> Option<PeriodNumber> {
        self.steady_from
    }

    /// The best end of the pictures of `every` periods, the last of which is given.
    pub(crate) fn best(&self, last: u64, every: u64) -> Option<PictureEnd> {
        let end = (last as usize + 1).min(self.of_periods.len());
        let of_periods = self.of_periods.get((last + 1).saturating_sub(every) as usize..end)?;
        let best = of_periods.iter().copied().filter(|code| *code > 0).min()?;
        Self::ALL.get(usize::from(best) - 1).copied()
    }

    /// The first period at or behind `start` with a picture.
    pub(crate) fn first_from(&self, start: u64) -> Option<u64> {
        let behind = self.of_periods.get(start as usize..)?;
        behind.iter().position(|code| *code > 0).map(|place| start + place as u64)
    }

    /// Periods of a window in which a picture was shown in time.
    pub(crate) fn periods_shown(&self, window: &ResultWindow) -> u64 {
        let periods = window.first_period.until(window.last_period.next());
        periods.filter(|period| self.best(period.0, 1) == Some(PictureEnd::Shown)).count() as u64
    }
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
        let pictures = ends.periods_shown(window);
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
