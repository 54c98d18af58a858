//! What pixels show that were looked up in faces around an eye: positions that memories were drawn from, in the direction that was
//! latched.

use crate::drawn::{FacesSeen, Moment};
use glam::DQuat;
use pxpl5_run::{Cause, Estimator, FaceHistory, HeadViews, LatchedHead, Outcome};
use pxpl5_sim::Time;
use pxpl5_wire::{PeriodNumber, ViewNumber};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt;
use tracking::Pose;

/// Memories and orientations of a run.
pub(crate) struct TurnedFaces<'a> {
    history: FaceHistory,
    latched: LatchedHead,
    head: &'a HeadViews,
    without: Option<Cause>,
    turns: RefCell<Turns<'a>>,
}

/// Orientations by the report that they rest on and the instant that they were predicted for.
struct Turns<'a> {
    estimator: Estimator<'a>,
    /// The last report that the estimator was asked about: it goes forward alone.
    asked: Time,
    known: BTreeMap<(Time, Time), DQuat>,
}

impl fmt::Debug for TurnedFaces<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TurnedFaces").field("latched", &self.latched).finish_non_exhaustive()
    }
}

impl<'a> TurnedFaces<'a> {
    /// `None` where the display takes no faces.
    pub(crate) fn of_run(outcome: &Outcome, head: &'a HeadViews) -> Option<Self> {
        let history = FaceHistory::of(outcome)?;
        let latched = LatchedHead::of(outcome)?;
        Some(Self { history, latched, head, without: None, turns: RefCell::new(Turns::new(head, None)) })
    }

    /// The same with the orientations that a run without a cause of error would have had.
    pub(crate) fn without(self, cause: Cause) -> Self {
        let without = Some(cause);
        Self { without, turns: RefCell::new(Turns::new(self.head, without)), ..self }
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
        let (report, aimed_at) = self.latched.turned_by(self.head, x, y, field)?;
        let orientation = self.turns.borrow_mut().at(self.head, self.without, report, aimed_at);
        let seen = self.history.at(field).filter_map(|shown| {
            let Moment { pose, objects_at } = moment(shown.note.view)?;
            let pose = Pose { orientation, ..pose };
            Some((Moment { pose, objects_at }, shown.note.structures.clone()))
        });
        let memories: Vec<_> = seen.collect();
        (!memories.is_empty()).then_some(FacesSeen { memories, aimed_at })
    }
}

impl<'a> Turns<'a> {
    fn new(head: &'a HeadViews, without: Option<Cause>) -> Self {
        Self { estimator: Estimator::new(head, without), asked: Time::ZERO, known: BTreeMap::new() }
    }

    fn at(&mut self, head: &'a HeadViews, without: Option<Cause>, report: Time, aimed_at: Time) -> DQuat {
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
