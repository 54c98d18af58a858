//! The views of a tracked head: predicted poses, and records of the poses that a pipeline requested.

use crate::dry_run::SeenTimes;
use crate::facing;
use crate::head::{Head, HeadPlace};
use crate::report_schedule::{Arrivals, Coming, Contents, ReportSchedule};
use crate::scene_views::view;
use crate::views::ViewSource;
use glam::{DQuat, DVec3};
use pphigs::FrameView;
use pxpl5_scene::{Hmd, Scene};
use pxpl5_sim::Time;
use pxpl5_wire::ViewNumber;
use std::fmt;
use std::iter::Peekable;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tracking::Pose;
use tracking::predict::Predictor;
use tracking::tracker::TrackerReport;

/// A pose that a pipeline requested, with the tracker report that it is based on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledPose {
    /// Number of the view for which the pose was requested, as counted by the pipeline.
    pub number: ViewNumber,
    /// Instant of the request. The pose depends only on reports that had arrived by this instant.
    pub reports_until: Time,
    /// Measurement time of the newest report that the pose uses. `None` before the first report.
    pub measured_at: Option<Time>,
    /// Arrival time at the host of the newest report that the pose uses. `None` before the first report.
    pub arrived_at: Option<Time>,
    /// Instant for which the picture is drawn, chosen by the head's [`Aim`](crate::Aim). Moving objects are drawn at
    /// their positions at this instant.
    pub objects_at: Time,
    /// Instant for which the pose was predicted. `None` without prediction: the newest report was used unchanged.
    pub predicted_for: Option<Time>,
    /// Pose of the head in the scene's coordinates.
    pub pose: Pose,
}

/// A predictor that receives tracker reports as simulated time advances.
///
/// The content of a report is computed only after its arrival, because the motion can depend on a user's input during
/// the run.
pub(crate) struct Follower {
    arrivals: Peekable<Arrivals>,
    contents: Contents,
    predictor: Box<dyn Predictor + Send>,
    newest: Option<Coming>,
}

impl Follower {
    pub(crate) fn new(arrivals: Arrivals, contents: Contents, predictor: Box<dyn Predictor + Send>) -> Self {
        Self { arrivals: arrivals.peekable(), contents, predictor, newest: None }
    }

    fn of_head(head: &Head, until: Time) -> Self {
        Self::new(head.arrivals(until), head.contents(), head.build_predictor())
    }

    /// Passes all reports that arrived by `reports_until` to the predictor. A report cannot be taken back, so an
    /// earlier `reports_until` changes nothing.
    fn follow(&mut self, reports_until: Time) {
        while self.arrivals.next_if(|coming| coming.arrives <= reports_until).is_some() {
            let Some(report) = self.contents.next() else { return };
            self.take(&report);
        }
    }

    fn take(&mut self, report: &TrackerReport) {
        let accepted = self.predictor.counts().accepted;
        self.predictor.observe(report);
        if self.predictor.counts().accepted > accepted {
            self.newest = Some(Coming::of(*report));
        }
    }

    /// Returns the predicted pose at `at`, in the tracker's coordinates, or `start` before the first report.
    pub(crate) fn pose(&mut self, reports_until: Time, at: Time, start: &Pose) -> Pose {
        self.follow(reports_until);
        if self.newest.is_none() { *start } else { self.predictor.predict(at.0) }
    }
}

/// The views that a tracked head provides for a pipeline, with records of the requested poses.
pub struct HeadViews {
    head: Arc<Head>,
    scene: Arc<Scene>,
    hmd: Hmd,
    eyes: usize,
    until: Time,
    schedule: Mutex<ReportSchedule>,
    seen_times: Option<SeenTimes>,
    /// Pose of the viewer in the scene for the pose `anchor` of the motion.
    base: Pose,
    anchor: Pose,
    /// Pose of the motion at time zero.
    start: Pose,
    state: Mutex<(Follower, Vec<SampledPose>)>,
    /// Predictor of poses alone, whose requests have other times than the requests for views.
    turns: Mutex<Follower>,
}

impl fmt::Debug for HeadViews {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("HeadViews").field("head", &self.head).field("until", &self.until).finish_non_exhaustive()
    }
}

impl HeadViews {
    pub(crate) fn new(
        head: Arc<Head>,
        scene: &Arc<Scene>,
        (hmd, eyes): (Hmd, usize),
        until: Time,
        seen_times: Option<SeenTimes>,
    ) -> Self {
        let start = head.motion.pose(0);
        let (anchor, begin) = match head.place {
            HeadPlace::Scene => (start, scene.motion().pose(0)),
            HeadPlace::World => (start, start),
            HeadPlace::Content => facing::content(head.motion.as_ref(), scene, &hmd, until),
        };
        let base = Pose { orientation: begin.orientation.normalize(), ..begin };
        let schedule = Mutex::new(ReportSchedule::new(head.arrivals(until)));
        let state = Mutex::new((Follower::of_head(&head, until), Vec::new()));
        let turns = Mutex::new(Follower::of_head(&head, until));
        Self {
            head,
            scene: Arc::clone(scene),
            hmd,
            eyes,
            until,
            schedule,
            seen_times,
            base,
            anchor,
            start,
            state,
            turns,
        }
    }

    /// Returns the measurement time of the first report that reaches the host at the instant `arrived` or later.
    /// Returns `None` if no such report exists.
    pub fn measured_at(&self, arrived: Time) -> Option<Time> {
        Some(self.schedule().from(arrived)?.measured)
    }

    /// Returns the arrival time of the last report that reached the host at `instant` or earlier. Returns `None` before
    /// the first report.
    pub fn report_by(&self, instant: Time) -> Option<Time> {
        Some(self.schedule().by(instant)?.arrives)
    }

    pub(crate) fn last_report(&self) -> Option<Time> {
        self.report_by(self.until)
    }

    pub(crate) fn records(&self) -> usize {
        self.state().1.len() + self.schedule().held()
    }

    /// Discards poses that were requested before `instant`, and reports that are no longer the newest at `instant`.
    pub(crate) fn discard_before(&self, instant: Time) {
        self.state().1.retain(|sampled| sampled.reports_until >= instant);
        self.schedule().discard_before(instant);
    }

    fn state(&self) -> MutexGuard<'_, (Follower, Vec<SampledPose>)> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn schedule(&self) -> MutexGuard<'_, ReportSchedule> {
        self.schedule.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn in_scene(&self, tracked: &Pose) -> Pose {
        let turn: DQuat = self.base.orientation * self.anchor.orientation.conjugate();
        let way: DVec3 = turn * (tracked.position - self.anchor.position);
        Pose { position: self.base.position + way, orientation: (turn * tracked.orientation).normalize() }
    }

    /// Returns the head's actual pose at a time, without tracker and prediction, in the scene's coordinates.
    pub fn truth(&self, time: Time) -> Pose {
        self.in_scene(&self.head.motion.pose(time.0))
    }

    /// Returns the head with its tracker and predictor.
    pub fn head(&self) -> &Head {
        &self.head
    }

    /// Returns the scene in which the head moves.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Returns the distance, in metres, at which pixel errors are evaluated if the position of a pixel's content is
    /// unknown.
    ///
    /// The default is the distance from the head's start to the centre of the scene, but at least 0.1 metres.
    pub fn distance_m(&self) -> f64 {
        let (centre, _) = self.scene.bounding_sphere();
        self.head.evaluate_at_m.unwrap_or_else(|| self.base.position.distance(centre.as_dvec3()).max(0.1))
    }

    /// Returns the records of the requested poses in memory, sorted by view number. [`KeptRecords`](crate::KeptRecords)
    /// decides how many records stay in memory.
    pub fn sampled(&self) -> Vec<SampledPose> {
        let mut all = self.state().1.clone();
        all.sort_by_key(|sampled| sampled.number);
        all
    }

    pub(crate) fn follower(&self) -> Follower {
        Follower::of_head(&self.head, self.until)
    }

    pub(crate) fn arrivals(&self) -> Arrivals {
        self.head.arrivals(self.until)
    }

    pub(crate) const fn start(&self) -> &Pose {
        &self.start
    }
}

impl ViewSource for HeadViews {
    fn newest(&self, number: ViewNumber, now: Time) -> FrameView {
        let shown_at = self.seen_times.as_ref().map_or(now, |seen_times| seen_times.aimed_at(number, now));
        self.view_at(number, now, shown_at)
    }

    fn view_at(&self, number: ViewNumber, reports_until: Time, shown_at: Time) -> FrameView {
        let (follower, sampled) = &mut *self.state();
        let pose = self.in_scene(&follower.pose(reports_until, shown_at, &self.start));
        let measured_at = follower.newest.map(|report| report.measured);
        let arrived_at = follower.newest.map(|report| report.arrives);
        let predicted_for = self.head.predicts().then_some(shown_at);
        let objects_at = shown_at;
        sampled.push(SampledPose { number, reports_until, measured_at, arrived_at, predicted_for, objects_at, pose });
        view(&self.scene, &self.hmd, self.eyes, number, shown_at, &pose.in_single_precision())
    }

    fn pose_at(&self, reports_until: Time, at: Time) -> Pose {
        let mut follower = self.turns.lock().unwrap_or_else(PoisonError::into_inner);
        self.in_scene(&follower.pose(reports_until, at, &self.start))
    }

    fn report_from(&self, instant: Time) -> Option<Time> {
        Some(self.schedule().from(instant)?.arrives)
    }
}
