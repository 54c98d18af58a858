//! The one window of a run over which its results are computed: latencies, pictures due, errors and rates.
//!
//! Start-up is over when [`WARM_UP_PERIODS`] have passed and [`WARM_UP_PICTURES`](crate::WARM_UP_PICTURES) pictures were begun, whichever comes later. The
//! window begins then, with the turn of the next picture: the periods up to and with the one in which it is due. No failure behind the
//! first periods is left out: if a picture due in the first half of the run was not shown, the window begins with the first such picture.
//! Those before it may owe their time to queues that were still empty. The pictures of start-up have no latency and no error in any case.
//! The window ends with the last period that was over, and a period earlier where no picture is due.

use crate::picture_ends::{PictureEnd, PictureEnds};
use pxpl5_wire::PeriodNumber;
use serde::Serialize;

/// Periods of the display at the start of a run that are not evaluated: the first views are on their way, and the first pictures
/// were ordered when their time had nearly passed (assumed).
pub const WARM_UP_PERIODS: u64 = 8;

/// The rule by which the window of a run is found, for readers of a report.
pub const WINDOW_DEFINITION: &str = "latencies, pictures due, errors and rates are over one window: from the 9th period of the display, or \
    from the turn of the fifth picture if that is later, to the last period that was over; where a picture due in the first half of the \
    run was not shown, from the first such picture, since those before it may owe their time to queues that were still empty; the first \
    four pictures have no latency and no error";

/// The periods of the first display over which all results of a run are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ResultWindow {
    /// First period of the window.
    pub first_period: PeriodNumber,
    /// Last period of the window.
    pub last_period: PeriodNumber,
    /// The period of the first picture behind start-up; `None` where the run shows no picture behind it.
    #[serde(skip)]
    steady_from: Option<PeriodNumber>,
}

impl ResultWindow {
    /// Finds the window of a run that is over, of which `reached` is the first period that was not simulated to its end.
    ///
    /// `every` is the number of periods from one picture due to the next; `None` where none is ever due. `planned` is the first
    /// period behind the run as it was asked for, and decides where its first half ends. `None` if the run has no period behind
    /// start-up, or too few for a picture that is due.
    pub(crate) fn of(
        ends: &PictureEnds,
        every: Option<u64>,
        reached: PeriodNumber,
        planned: PeriodNumber,
    ) -> Option<Self> {
        let begun = Self::begun(ends, every, reached, planned);
        // Where no picture is due, one that is seen in the last period may not be whole before a later one.
        let end = if every.is_some() { reached.0 } else { reached.0.checked_sub(1)? };
        let periods = end.checked_sub(begun.first_period.0)?;
        let every = every.unwrap_or(1).max(1);
        let whole = periods / every * every;
        let last_period = PeriodNumber((begun.first_period.0 + whole).checked_sub(1)?);
        (whole > 0).then_some(Self { last_period, ..begun })
    }

    /// The window of a run that goes on, all of whose pictures are known in the periods before `known`. Its end is that of the run.
    pub(crate) fn begun(ends: &PictureEnds, every: Option<u64>, known: PeriodNumber, planned: PeriodNumber) -> Self {
        let steady_from = ends.steady_from();
        let middle = WARM_UP_PERIODS + planned.0.saturating_sub(WARM_UP_PERIODS) / 2;
        let start = ends.first_from(0).unwrap_or_default().min(middle);
        // Where start-up takes more than half of the run, what is due is counted from the first picture on.
        let steady = steady_from.map(|period| period.0).filter(|period| *period < middle).unwrap_or(start);
        let first = every.map_or(steady.max(WARM_UP_PERIODS), |every| {
            let every = every.max(1);
            let start = start.max(WARM_UP_PERIODS + every - 1);
            let of_first_half = known.0.min(middle);
            first_due(ends, every, [start, steady], of_first_half) + 1 - every
        });
        let last_period = PeriodNumber(planned.0.saturating_sub(1));
        Self { first_period: PeriodNumber(first), last_period, steady_from }
    }

    /// Returns true if a period lies in the window.
    #[must_use]
    pub fn holds(&self, period: PeriodNumber) -> bool {
        (self.first_period..=self.last_period).contains(&period)
    }

    /// Returns true if a picture that is shown from a period on lies in the window, behind those of start-up.
    #[must_use]
    pub fn holds_picture(&self, period: PeriodNumber) -> bool {
        self.steady_from.is_some_and(|steady| steady <= period) && self.holds(period)
    }

    /// Periods of the window.
    #[must_use]
    pub const fn periods(&self) -> u64 {
        self.last_period.0 + 1 - self.first_period.0
    }
}

/// The period in which the first picture that is counted is due: the first that was not shown, from `start` on and before `end`; else the
/// first at or behind `steady`.
fn first_due(ends: &PictureEnds, every: u64, [start, steady]: [u64; 2], end: u64) -> u64 {
    // The first picture there says in which periods pictures are due.
    let anchor = ends.first_from(start).unwrap_or(start);
    let first = start + (anchor - start) % every;
    let failed = (first..end).step_by(every as usize).find(|due| ends.best(*due, every) != Some(PictureEnd::Shown));
    failed.unwrap_or(first + steady.saturating_sub(first).div_ceil(every) * every)
}
