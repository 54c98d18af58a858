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

use pxpl5_wire::PeriodNumber;
use serde::Serialize;
use std::collections::BTreeMap;

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

/// Periods of the display at the start of a run that are not judged: the first views are on their way, and the first pictures
/// were ordered when their time had nearly passed (assumed).
pub const WARM_UP_PERIODS: u64 = 8;

/// Which periods are judged, for whoever reads a count.
pub const WINDOW_DEFINITION: &str = "counted from the 9th period of the display to the last one that was over; later where the first \
    picture comes later, and, where any picture was not shown, from the first that was not, since those before it may owe their \
    time to queues that were still empty; but never from behind the middle of the run";

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
}

/// What became of each picture due, `None` where there was none, with its period.
type Ends = Vec<(u64, Option<PictureEnd>)>;

impl DuePictures {
    /// Counts them. `pictures` gives the period in which each picture that was begun should be seen, and its end;
    /// `periods_a_picture` is the cadence, and `reached` the first period that was not over when the run ended.
    ///
    /// A picture that comes before it is due, but after the one before it was, is shown. `None` when no whole picture was due.
    #[must_use]
    pub fn count(
        pictures: impl Iterator<Item = (PeriodNumber, PictureEnd)>,
        periods_a_picture: u64,
        reached: PeriodNumber,
    ) -> Option<Self> {
        let periods = reached.0;
        let every = periods_a_picture.max(1);
        let middle = WARM_UP_PERIODS + periods.checked_sub(WARM_UP_PERIODS)? / 2;
        let mut begun: BTreeMap<u64, PictureEnd> = BTreeMap::new();
        for (period, end) in pictures.filter(|(period, _)| *period < reached) {
            let best = begun.entry(period.0).or_insert(end);
            *best = end.min(*best);
        }
        let first_picture = begun.keys().next().copied().unwrap_or_default();
        let start = first_picture.clamp(WARM_UP_PERIODS, middle).max(every - 1);
        let ends = ends_of_due(&begun, start, every, periods);
        let in_time_first = ends.iter().take_while(|(period, end)| *end == Some(PictureEnd::Shown) && *period < middle);
        let all_in_time = ends.iter().all(|(_, end)| *end == Some(PictureEnd::Shown));
        let left_out = if all_in_time { 0 } else { in_time_first.count() };
        Self::of_ends(&ends[left_out..], every)
    }

    fn of_ends(ends: &[(u64, Option<PictureEnd>)], every: u64) -> Option<Self> {
        let [(first_due, _), ..] = ends else { return None };
        let number_of = |wanted: Option<PictureEnd>| ends.iter().filter(|(_, end)| *end == wanted).count() as u64;
        let due = ends.len() as u64;
        let first_period = (first_due + 1).saturating_sub(every);
        Some(Self {
            first_period: PeriodNumber(first_period),
            last_period: PeriodNumber(first_period + due * every - 1),
            periods_a_picture: every,
            due,
            shown: number_of(Some(PictureEnd::Shown)),
            late: number_of(Some(PictureEnd::Late)),
            incomplete: number_of(Some(PictureEnd::Incomplete)),
            missed: number_of(None),
        })
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

    /// Pictures shown a second, where a period of the display takes so many milliseconds; `None` where none was.
    #[must_use]
    pub fn updates_hz(&self, period_ms: f64) -> Option<f64> {
        let window_ms = (self.due * self.periods_a_picture) as f64 * period_ms;
        (self.shown > 0).then_some(self.shown as f64 * 1e3 / window_ms)
    }
}

/// What became of the picture due in each `every`-th period from `start` on; the first picture there says in which.
fn ends_of_due(begun: &BTreeMap<u64, PictureEnd>, start: u64, every: u64, periods: u64) -> Ends {
    let anchor = begun.range(start..).next().map_or(start, |(period, _)| *period);
    let due = (start + (anchor - start) % every..periods).step_by(every as usize);
    due.map(|period| {
        let since_last = begun.range((period + 1).saturating_sub(every)..=period);
        (period, since_last.map(|(_, end)| *end).min())
    })
    .collect()
}
