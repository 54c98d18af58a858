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
    /// Pictures that were whole and in time, due or not, in the periods of the window. More than `shown` where pictures come more
    /// often than they are due.
    pub pictures: u64,
}

/// What became of the pictures of each period: a byte for a period, so that 10^7 fields take 10 MB.
#[derive(Clone, Debug, Default)]
pub(crate) struct PictureEnds {
    /// Of each period, 0 for no picture, else one more than the place of the best end among all ends.
    of_periods: Vec<u8>,
}

impl PictureEnds {
    const ALL: [PictureEnd; 3] = [PictureEnd::Shown, PictureEnd::Late, PictureEnd::Incomplete];

    /// A picture that should be seen in a period ended so.
    pub(crate) fn note(&mut self, period: PeriodNumber, end: PictureEnd) {
        let place = period.0 as usize;
        if self.of_periods.len() <= place {
            self.of_periods.resize(place + 1, 0);
        }
        let best = &mut self.of_periods[place];
        let code = end as u8 + 1;
        *best = if *best == 0 { code } else { code.min(*best) };
    }

    /// The best end of the pictures of some periods.
    fn best(&self, periods: std::ops::RangeInclusive<u64>) -> Option<PictureEnd> {
        let last = (*periods.end()).min((self.of_periods.len() as u64).checked_sub(1)?);
        let of_periods = self.of_periods.get(*periods.start() as usize..=last as usize)?;
        let best = of_periods.iter().copied().filter(|code| *code > 0).min()?;
        Self::ALL.get(usize::from(best) - 1).copied()
    }

    /// The first period at or behind `start` with a picture.
    fn first_from(&self, start: u64) -> Option<u64> {
        let behind = self.of_periods.get(start as usize..)?;
        behind.iter().position(|code| *code > 0).map(|place| start + place as u64)
    }
}

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
        let mut ends = PictureEnds::default();
        pictures.filter(|(period, _)| *period < reached).for_each(|(period, end)| ends.note(period, end));
        Self::of_ends(&ends, periods_a_picture, reached)
    }

    /// Counts them, from the ends of all pictures of periods before `reached`.
    pub(crate) fn of_ends(ends: &PictureEnds, periods_a_picture: u64, reached: PeriodNumber) -> Option<Self> {
        let every = periods_a_picture.max(1);
        let periods = reached.0;
        let middle = WARM_UP_PERIODS + periods.checked_sub(WARM_UP_PERIODS)? / 2;
        let first_picture = ends.first_from(0).filter(|period| *period < periods).unwrap_or_default();
        let start = first_picture.clamp(WARM_UP_PERIODS, middle).max(every - 1);
        // The first picture there says in which periods pictures are due.
        let anchor = ends.first_from(start).filter(|period| *period < periods).unwrap_or(start);
        let due = (start + (anchor - start) % every..periods).step_by(every as usize);
        let end_of = |period: u64| ends.best((period + 1).saturating_sub(every)..=period);
        let is_shown = |period: &u64| end_of(*period) == Some(PictureEnd::Shown);
        let in_time_first = due.clone().take_while(|period| is_shown(period) && *period < middle);
        let left_out = if due.clone().all(|period| is_shown(&period)) { 0 } else { in_time_first.count() };
        let mut judged = due.skip(left_out).peekable();
        let first_period = (*judged.peek()? + 1).saturating_sub(every);
        let mut counts = [0; 4];
        judged.for_each(|period| counts[end_of(period).map_or(3, |end| end as usize)] += 1);
        let [shown, late, incomplete, missed] = counts;
        let due: u64 = counts.iter().sum();
        let window = first_period..first_period + due * every;
        let pictures = window.filter(|period| ends.best(*period..=*period) == Some(PictureEnd::Shown)).count() as u64;
        Some(Self {
            first_period: PeriodNumber(first_period),
            last_period: PeriodNumber(first_period + due * every - 1),
            periods_a_picture: every,
            due,
            shown,
            late,
            incomplete,
            missed,
            pictures,
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

    /// Pictures shown a second in the window, where a period of the display takes so many milliseconds; `None` where none was.
    #[must_use]
    pub fn updates_hz(&self, period_ms: f64) -> Option<f64> {
        let window_ms = (self.due * self.periods_a_picture) as f64 * period_ms;
        (self.pictures > 0).then_some(self.pictures as f64 * 1e3 / window_ms)
    }
}
