//! Results of the pictures of a run, by display period.

use pxpl5_wire::PeriodNumber;

/// Number of pictures at the start of a run that are not evaluated, because the pipeline is not full yet. TR94 discards
/// the first frames too.
pub const WARM_UP_PICTURES: usize = 4;

/// The possible results of a picture that was begun, from best to worst.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PictureResult {
    /// The picture was complete and in time.
    Shown,
    /// The picture was complete before its period ended, but not in time.
    Late,
    /// The picture was incomplete when its period ended.
    Incomplete,
}

impl PictureResult {
    /// Returns the result of a picture. `is_whole` is true if the picture was complete when its period ended.
    /// `is_in_time` is true if every part of the picture arrived in time.
    #[must_use]
    pub const fn of(is_whole: bool, is_in_time: bool) -> Self {
        match (is_whole, is_in_time) {
            (true, true) => Self::Shown,
            (true, false) => Self::Late,
            (false, _) => Self::Incomplete,
        }
    }
}

/// Results of the pictures of each display period. A period takes one byte, so 10^7 fields take 10 MB.
#[derive(Clone, Debug, Default)]
pub(crate) struct PictureResults {
    /// One code for each period: 0 if the period has no picture, otherwise 1 plus the index of the period's best result
    /// in the list `PictureResult::ALL`.
    of_periods: Vec<u8>,
    begun: usize,
    steady_from: Option<PeriodNumber>,
}

impl PictureResults {
    const ALL: [PictureResult; 3] = [PictureResult::Shown, PictureResult::Late, PictureResult::Incomplete];

    /// Records the result of a picture, for the period in which the picture should be seen. Pictures must be recorded
    /// in the order of their periods.
    pub(crate) fn note(&mut self, period: PeriodNumber, end: PictureResult) {
        self.begun += 1;
        if self.begun > WARM_UP_PICTURES {
            self.steady_from.get_or_insert(period);
        }
        let place = period.0 as usize;
        if self.of_periods.len() <= place {
            self.of_periods.resize(place + 1, 0);
        }
        // A period keeps the best of its results: the lowest code.
        let best = &mut self.of_periods[place];
        let code = end as u8 + 1;
        *best = if *best == 0 { code } else { code.min(*best) };
    }

    /// Returns the period of the first picture after the first [`WARM_UP_PICTURES`] pictures. Returns `None` if no such
    /// picture was begun.
    pub(crate) const fn steady_from(&self) -> Option<PeriodNumber> {
        self.steady_from
    }

    /// Returns the best result of the pictures in `every` successive periods, of which `last` is the last period.
    pub(crate) fn best(&self, last: u64, every: u64) -> Option<PictureResult> {
        let end = (last as usize + 1).min(self.of_periods.len());
        let of_periods = self.of_periods.get((last + 1).saturating_sub(every) as usize..end)?;
        let best = of_periods.iter().copied().filter(|code| *code > 0).min()?;
        Self::ALL.get(usize::from(best) - 1).copied()
    }

    /// Returns the first period at or after `start` that has a picture.
    pub(crate) fn first_from(&self, start: u64) -> Option<u64> {
        let behind = self.of_periods.get(start as usize..)?;
        behind.iter().position(|code| *code > 0).map(|place| start + place as u64)
    }

    /// Counts the periods, from `first` to `last`, in which a picture was shown in time.
    pub(crate) fn periods_shown(&self, [first, last]: [PeriodNumber; 2]) -> u64 {
        let periods = first.until(last.next());
        periods.filter(|period| self.best(period.0, 1) == Some(PictureResult::Shown)).count() as u64
    }
}
