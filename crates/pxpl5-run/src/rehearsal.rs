//! For which instants views are drawn, known from a run without prediction.

use crate::head::Head;
use crate::instants::Instants;
use pxpl5_sim::Time;
use pxpl5_wire::ViewNumber;

/// For which instants views are drawn, found by a run without prediction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rehearsal {
    /// The instant of each view that was shown, by the view's number.
    aimed_at: Instants,
    /// Mean time from the sample of a view to its instant, picoseconds.
    mean_lead_ps: u64,
}

impl Rehearsal {
    /// The instants of the views that were shown, and how long after its sample a view is shown on average, picoseconds.
    pub(crate) const fn new(aimed_at: Instants, mean_lead_ps: u64) -> Self {
        Self { aimed_at, mean_lead_ps }
    }

    /// The instant that a view is drawn for; of a view that was not shown, so long after its sample as the others on average.
    pub(crate) fn aimed_at(&self, number: ViewNumber, sampled_at: Time) -> Time {
        let expected = Time(sampled_at.0 + self.mean_lead_ps);
        self.aimed_at.of(number.0).filter(|at| *at >= sampled_at).unwrap_or(expected)
    }
}

/// What a run without prediction tells whoever predicts: the same for every predictor.
#[derive(Clone, Debug)]
pub struct Rehearsed {
    /// When each view is seen.
    pub(crate) rehearsal: Rehearsal,
    /// How far ahead views have to be predicted, and orientations that a display latches; `None` where nothing was.
    pub(crate) interval_ps: Option<u64>,
    pub(crate) turn_interval_ps: Option<u64>,
}

impl Rehearsed {
    /// A head whose predictor errs least so far ahead as the run had to predict: places over the interval of pictures; orientations too,
    /// or over that of a display that latches turns alone. `None` where there is no interval.
    pub(crate) fn tuned(&self, head: &Head) -> Option<Head> {
        let of_pictures = self.interval_ps.map(|interval_ps| head.tuned_for(interval_ps));
        match self.turn_interval_ps {
            Some(interval_ps) => Some(of_pictures.as_ref().unwrap_or(head).tuned_for_turns(interval_ps)),
            None => of_pictures,
        }
    }
}
