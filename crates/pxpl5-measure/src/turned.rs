//! What pixels show that were looked up in faces around an eye: positions that memories were drawn from, in the direction that was
//! latched.

use crate::drawn::{FacesSeen, Moment};
use glam::DQuat;
use pxpl5_run::{Cause, Estimator, FaceHistory, HeadViews, LatchedHead, Settled};
use pxpl5_sim::Time;
use pxpl5_wire::{PeriodNumber, ViewNumber};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;
use tracking::Pose;

/// Memories and orientations of a run.
pub(crate) struct TurnedFaces {
    history: FaceHistory,
    latched: LatchedHead,
    head: Arc<HeadViews>,
    without: Option<Cause>,
    turns: RefCell<Turns>,
}

/// Orientations by the report that they rest on and the instant that they were predicted for.
struct Turns {
    estimator: Estimator,
    /// The last report that the estimator was asked about: it goes forward alone.
    asked: Time,
    known: BTreeMap<(Time, Time), DQuat>,
}

impl fmt::Debug for TurnedFaces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TurnedFaces").field("latched", &self.latched).finish_non_exhaustive()
    }
}

impl TurnedFaces {
    /// `None` where the display takes no faces.
    pub(crate) fn begin(run: &Settled<'_>, head: &Arc<HeadViews>) -> Option<Self> {
        let history = FaceHistory::held(run.record, run.notes)?;
        let latched = LatchedHead::of_run(run)?;
        let turns = RefCell::new(Turns::new(head, None));
        Some(Self { history, latched, head: Arc::clone(head), without: None, turns })
    }

    /// Takes what is held of the updates that were shown.
    pub(crate) fn take(&mut self, run: &Settled<'_>) {
        self.history = FaceHistory::held(run.record, run.notes).unwrap_or_default();
    }

    /// Forgets orientations that rest on reports before an instant.
    pub(crate) fn forget_before(&mut self, instant: Time) {
        self.turns.get_mut().known.retain(|(report, _), _| *report >= instant);
    }

    /// Orientations that it holds.
    #[cfg(test)]
    pub(crate) fn held(&self) -> usize {
        self.turns.borrow().known.len()
    }

    /// Turns to the orientations that a run without a cause of error would have had.
    pub(crate) fn leave_out(&mut self, cause: Cause) {
        self.without = Some(cause);
        self.turns = RefCell::new(Turns::new(&self.head, self.without));
    }

    /// The views that memories show in a field.
    pub(crate) fn views_at(&self, field: PeriodNumber) -> Vec<ViewNumber> {
        self.history.at(field).map(|shown| shown.note.view).collect()
    }

    /// What a pixel was looked up in; `None` before anything came.
    pub(crate) fn drawn(
        &self,
        x: u32,
        y: u32,
        field: PeriodNumber,
        moment: impl Fn(ViewNumber) -> Option<Moment>,
    ) -> Option<FacesSeen> {
        let (report, aimed_at) = self.latched.turned_by(&self.head, x, y, field)?;
        let orientation = self.turns.borrow_mut().at(&self.head, self.without, report, aimed_at);
        let seen = self.history.at(field).filter_map(|shown| {
            let Moment { pose, objects_at } = moment(shown.note.view)?;
            let pose = Pose { orientation, ..pose };
            Some((Moment { pose, objects_at }, shown.note.structures.clone()))
        });
        let memories: Vec<_> = seen.collect();
        (!memories.is_empty()).then_some(FacesSeen { memories, aimed_at })
    }
}

impl Turns {
    fn new(head: &Arc<HeadViews>, without: Option<Cause>) -> Self {
        Self { estimator: Estimator::new(head, without), asked: Time::ZERO, known: BTreeMap::new() }
    }

    fn at(&mut self, head: &Arc<HeadViews>, without: Option<Cause>, report: Time, aimed_at: Time) -> DQuat {
        if let Some(known) = self.known.get(&(report, aimed_at)) {
            return *known;
        }
        if report < self.asked {
            self.estimator = Estimator::new(head, without);
        }
        self.asked = report;
        let orientation = self.estimator.pose(report, aimed_at).orientation;
        self.known.insert((report, aimed_at), orientation);
        orientation
    }
}
