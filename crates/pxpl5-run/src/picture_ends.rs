//! How the pictures of a run ended, period by period.

use pxpl5_wire::PeriodNumber;

/// Pictures at the start of a run that are not evaluated, because the pipeline is still filling (TR94 discards the first frames too).
pub const WARM_UP_PICTURES: usize = 4;

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

    /// Counts the periods, from the first to the last one, in which a picture was shown in time.
    pub(crate) fn periods_shown(&self, [first, last]: [PeriodNumber; 2]) -> u64 {
        let periods = first.until(last.next());
        periods.filter(|period| self.best(period.0, 1) == Some(PictureEnd::Shown)).count() as u64
    }
}
