//! Sources of pixels on an address recalculation display: head poses of the memories, and latched directions.

use crate::drawn::{FacesSeen, Moment};
use glam::DQuat;
use pxpl5_run::{Cause, Estimator, FaceHistory, FinalResults, HeadViews, OrientationTiming};
use pxpl5_sim::Time;
use pxpl5_wire::{PeriodNumber, ViewNumber};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;
use tracking::Pose;

pub(crate) struct LatchedFaces {
    history: FaceHistory,
    latched: OrientationTiming,
    head: Arc<HeadViews>,
    without: Option<Cause>,
    turns: RefCell<Turns>,
}

/// Predicted orientations of the head, stored by two times. The first is the time up to which the host used tracker
/// reports. The second is the instant for which the host predicted.
struct Turns {
    estimator: Estimator,
    /// Time of the last report passed to the estimator, which accepts reports only in ascending order.
    asked: Time,
    cached: BTreeMap<(Time, Time), DQuat>,
}

impl fmt::Debug for LatchedFaces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LatchedFaces").field("latched", &self.latched).finish_non_exhaustive()
    }
}

impl LatchedFaces {
    pub(crate) fn begin(run: &FinalResults<'_>, head: &Arc<HeadViews>) -> Option<Self> {
        let history = FaceHistory::held(run.record)?;
        let latched = OrientationTiming::of_run(run)?;
        let turns = RefCell::new(Turns::new(head, None));
        Some(Self { history, latched, head: Arc::clone(head), without: None, turns })
    }

    /// Replaces the list of display updates by the updates that the run still has in memory.
    pub(crate) fn take(&mut self, run: &FinalResults<'_>) {
        self.history = FaceHistory::held(run.record).unwrap_or_default();
    }

    pub(crate) fn discard_before(&mut self, instant: Time) {
        self.turns.get_mut().cached.retain(|(report, _), _| *report >= instant);
    }

    #[cfg(test)]
    pub(crate) fn held(&self) -> usize {
        self.turns.borrow().cached.len()
    }

    /// Replaces the head's orientations by the orientations that the run would have had without one cause of error.
    pub(crate) fn disable_cause(&mut self, cause: Cause) {
        self.without = Some(cause);
        self.turns = RefCell::new(Turns::new(&self.head, self.without));
    }

    pub(crate) fn views_at(&self, field: PeriodNumber) -> Vec<ViewNumber> {
        self.history.at(field).map(|shown| shown.note.view).collect()
    }

    /// Returns the display memories and the direction that a pixel was read from, or `None` before the first update.
    pub(crate) fn drawn(
        &self,
        x: u32,
        y: u32,
        field: PeriodNumber,
        moment: impl Fn(ViewNumber) -> Option<Moment>,
    ) -> Option<FacesSeen> {
        // Find the report and the instant from which this pixel's orientation was predicted.
        let (report, aimed_at) = self.latched.orientation_of_pixel(&self.head, x, y, field)?;
        let orientation = self.turns.borrow_mut().at(&self.head, self.without, report, aimed_at);
        // Each memory keeps its position but is seen in this orientation.
        let seen = self.history.at(field).filter_map(|shown| {
            let Moment { pose, objects_at, measured_at } = moment(shown.note.view)?;
            let pose = Pose { orientation, ..pose };
            Some((Moment { pose, objects_at, measured_at }, shown.note.structures.clone()))
        });
        let memories: Vec<_> = seen.collect();
        (!memories.is_empty()).then_some(FacesSeen { memories, aimed_at })
    }
}

impl Turns {
    fn new(head: &Arc<HeadViews>, without: Option<Cause>) -> Self {
        Self { estimator: Estimator::new(head, without), asked: Time::ZERO, cached: BTreeMap::new() }
    }

    fn at(&mut self, head: &Arc<HeadViews>, without: Option<Cause>, report: Time, aimed_at: Time) -> DQuat {
        if let Some(cached) = self.cached.get(&(report, aimed_at)) {
            return *cached;
        }
        if report < self.asked {
            self.estimator = Estimator::new(head, without);
        }
        self.asked = report;
        let orientation = self.estimator.pose(report, aimed_at).orientation;
        self.cached.insert((report, aimed_at), orientation);
        orientation
    }
}
