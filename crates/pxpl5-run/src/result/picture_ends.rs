use pxpl5_wire::PeriodNumber;

/// Number of pictures at the start of a run that are not evaluated, because the pipeline is still filling.
///
/// I3D95 also discards the first frames.
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
    /// Returns the result of a picture. `is_whole` is true if the picture was complete when its display period ended.
    /// `is_in_time` is true if every part arrived before its deadline.
    pub const fn of(is_whole: bool, is_in_time: bool) -> Self {
        match (is_whole, is_in_time) {
            (true, true) => Self::Shown,
            (true, false) => Self::Late,
            (false, _) => Self::Incomplete,
        }
    }
}

#[derive(Clone, Debug, Default)]
pub(crate) struct PictureResults {
    /// Best result of each period: 0 without a picture, otherwise 1 plus the index in the list `PictureResult::ALL`.
    /// With one byte per period, 10^7 fields take 10 MB.
    of_periods: Vec<u8>,
    begun: usize,
    steady_from: Option<PeriodNumber>,
}

impl PictureResults {
    const ALL: [PictureResult; 3] = [PictureResult::Shown, PictureResult::Late, PictureResult::Incomplete];

    /// Records the result of a picture that should be seen in `period`. Pictures must be recorded in the order of their
    /// periods.
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

    /// Returns the period of the first picture after the warm-up, or `None` during the warm-up.
    pub(crate) const fn steady_from(&self) -> Option<PeriodNumber> {
        self.steady_from
    }

    /// Returns the best result in `every` periods, of which `last` is the last period. Shown is better than late, and
    /// late is better than incomplete.
    pub(crate) fn best(&self, last: u64, every: u64) -> Option<PictureResult> {
        let end = (last as usize + 1).min(self.of_periods.len());
        let of_periods = self.of_periods.get((last + 1).saturating_sub(every) as usize..end)?;
        let best = of_periods.iter().copied().filter(|code| *code > 0).min()?;
        Self::ALL.get(usize::from(best) - 1).copied()
    }

    pub(crate) fn first_from(&self, start: u64) -> Option<u64> {
        let behind = self.of_periods.get(start as usize..)?;
        behind.iter().position(|code| *code > 0).map(|place| start + place as u64)
    }

    pub(crate) fn periods_shown(&self, [first, last]: [PeriodNumber; 2]) -> u64 {
        let periods = first.until(last.next());
        periods.filter(|period| self.best(period.0, 1) == Some(PictureResult::Shown)).count() as u64
    }
}
