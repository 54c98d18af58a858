//! The poses that a pipeline asked for, and what became of each.

use crate::display_list::view;
use crate::head::Head;
use crate::rehearsal::Rehearsal;
use crate::report_schedule::{Arrivals, Coming, Contents, ReportSchedule};
use crate::views::{Poses, ReportTimes, Views, ViewsWanted};
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

/// A pose that a pipeline asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampled {
    /// The view that the pose is for, in the pipeline's own count.
    pub number: ViewNumber,
    /// Reports that had reached the host by then could be used.
    pub known: Time,
    /// When the newest report used was true; `None` before the first.
    pub measured_at: Option<Time>,
    /// When that report reached the host.
    pub arrived_at: Option<Time>,
    /// The moment that the view's picture is drawn for, by the head's [`Aim`](crate::Aim): moving objects stand where they are then.
    pub objects_at: Time,
    /// The same where the pose was predicted; `None` where the newest was taken as it is.
    pub predicted_for: Option<Time>,
    /// The pose in the scene's coordinates.
    pub pose: Pose,
}

/// What a pose of the predictor rests on.
#[derive(Clone, Copy, Debug, Default)]
struct Newest {
    measured_at: Option<Time>,
    arrived_at: Option<Time>,
}

/// Reports fed to a predictor as time goes on. Each is made when it has arrived: of a head that somebody moves no more is known.
pub(crate) struct Follower {
    arrivals: Peekable<Arrivals>,
    contents: Contents,
    predictor: Box<dyn Predictor + Send>,
    newest: Newest,
}

impl Follower {
    /// Follows what some reports say, as far as they come.
    pub(crate) fn new(arrivals: Arrivals, contents: Contents, predictor: Box<dyn Predictor + Send>) -> Self {
        Self { arrivals: arrivals.peekable(), contents, predictor, newest: Newest::default() }
    }

    /// Follows what reaches the host of a head before an instant.
    fn of_head(head: &Head, until: Time) -> Self {
        Self::new(head.arrivals(until), head.contents(), head.build_predictor())
    }

    /// Takes what had arrived by `known`; asked for earlier times it does not forget.
    fn follow(&mut self, known: Time) {
        while self.arrivals.next_if(|coming| coming.arrives <= known).is_some() {
            let Some(report) = self.contents.next() else { return };
            self.take(&report);
        }
    }

    fn take(&mut self, report: &TrackerReport) {
        let accepted = self.predictor.counts().accepted;
        self.predictor.observe(report);
        if self.predictor.counts().accepted > accepted {
            let Coming { arrives, measured } = Coming::of(*report);
            self.newest = Newest { measured_at: Some(measured), arrived_at: Some(arrives) };
        }
    }

    /// The pose at a time with what had arrived by `known`, in the tracker's coordinates; the start of the motion before the first
    /// report.
    pub(crate) fn pose(&mut self, known: Time, at: Time, start: &Pose) -> Pose {
        self.follow(known);
        if self.newest.measured_at.is_none() { *start } else { self.predictor.predict(at.0) }
    }
}

/// The views of a head as its tracker tells of them, with a record of each that was not given up.
pub struct HeadViews {
    head: Arc<Head>,
    scene: Arc<Scene>,
    hmd: Hmd,
    eyes: usize,
    /// When the run ends: what comes later is no report of it.
    until: Time,
    schedule: Mutex<ReportSchedule>,
    rehearsal: Option<Rehearsal>,
    /// Where the scene wants its viewer at time zero.
    base: Pose,
    start: Pose,
    state: Mutex<(Follower, Vec<Sampled>)>,
}

impl fmt::Debug for HeadViews {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("HeadViews").field("head", &self.head).field("until", &self.until).finish_non_exhaustive()
    }
}

impl HeadViews {
    /// Reports until `until`. The motion begins where the scene's own begins and goes on from there.
    pub(crate) fn new(
        head: Arc<Head>,
        scene: &Arc<Scene>,
        (hmd, eyes): (Hmd, usize),
        until: Time,
        rehearsal: Option<Rehearsal>,
    ) -> Self {
        let of_scene = scene.motion().pose(0);
        let base = Pose { orientation: of_scene.orientation.normalize(), ..of_scene };
        let start = head.motion.pose(0);
        let schedule = Mutex::new(ReportSchedule::new(head.arrivals(until)));
        let state = Mutex::new((Follower::of_head(&head, until), Vec::new()));
        Self { head, scene: Arc::clone(scene), hmd, eyes, until, schedule, rehearsal, base, start, state }
    }

    /// The functions that a pipeline is set up with.
    pub(crate) fn functions(this: &Arc<Self>) -> (Views, ViewsWanted, ReportTimes) {
        let [a, b, c] = [(); 3].map(|()| Arc::clone(this));
        (
            Arc::new(move |number, time| a.newest(number, time)),
            Arc::new(move |number, known, shown_at| b.view(number, known, shown_at)),
            Arc::new(move |after| c.report_after(after)),
        )
    }

    /// What its host knows of the head alone; the predictor is one of its own.
    pub(crate) fn poses(this: &Arc<Self>) -> Poses {
        let follower = Mutex::new(this.follower());
        let views = Arc::clone(this);
        Arc::new(move |known, at| {
            let mut follower = follower.lock().unwrap_or_else(PoisonError::into_inner);
            views.in_scene(&follower.pose(known, at, &views.start))
        })
    }

    /// When what a report says was true, by the report's arrival at the host; `None` where there is no such report.
    #[must_use]
    pub fn measured_at(&self, arrived: Time) -> Option<Time> {
        Some(self.schedule().from(arrived)?.measured)
    }

    /// The last report that had reached the host by an instant; `None` before the first.
    #[must_use]
    pub fn report_by(&self, instant: Time) -> Option<Time> {
        Some(self.schedule().by(instant)?.arrives)
    }

    /// The last report of the run; `None` where there is none.
    pub(crate) fn last_report(&self) -> Option<Time> {
        self.report_by(self.until)
    }

    /// Poses and reports that are held.
    pub(crate) fn records(&self) -> usize {
        self.state().1.len() + self.schedule().held()
    }

    /// Gives up poses that were asked for before an instant, and reports that were old then: nobody looks so far back.
    pub(crate) fn forget_before(&self, instant: Time) {
        self.state().1.retain(|sampled| sampled.known >= instant);
        self.schedule().forget_before(instant);
    }

    fn state(&self) -> MutexGuard<'_, (Follower, Vec<Sampled>)> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn schedule(&self) -> MutexGuard<'_, ReportSchedule> {
        self.schedule.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn newest(&self, number: ViewNumber, time: Time) -> FrameView {
        let shown_at = self.rehearsal.as_ref().map_or(time, |rehearsal| rehearsal.aimed_at(number, time));
        self.view(number, time, shown_at)
    }

    fn view(&self, number: ViewNumber, known: Time, shown_at: Time) -> FrameView {
        let (follower, sampled) = &mut *self.state();
        let pose = self.in_scene(&follower.pose(known, shown_at, &self.start));
        let Newest { measured_at, arrived_at } = follower.newest;
        let predicted_for = self.head.predicts().then_some(shown_at);
        sampled.push(Sampled { number, known, measured_at, arrived_at, predicted_for, objects_at: shown_at, pose });
        view(&self.scene, &self.hmd, self.eyes, number, shown_at, &pose.in_single_precision())
    }

    /// The first report that reaches the host at an instant or later.
    pub(crate) fn report_from(&self, instant: Time) -> Option<Time> {
        Some(self.schedule().from(instant)?.arrives)
    }

    /// The first report that reaches the host after an instant; `None` if none does.
    #[must_use]
    pub fn report_after(&self, after: Time) -> Option<Time> {
        Some(self.schedule().after(after)?.arrives)
    }

    /// A pose of the tracker in the scene: the motion's start is where the scene's own motion starts.
    pub(crate) fn in_scene(&self, tracked: &Pose) -> Pose {
        let turn: DQuat = self.base.orientation * self.start.orientation.conjugate();
        let way: DVec3 = turn * (tracked.position - self.start.position);
        Pose { position: self.base.position + way, orientation: (turn * tracked.orientation).normalize() }
    }

    /// Where the head truly is.
    #[must_use]
    pub fn truth(&self, time: Time) -> Pose {
        self.in_scene(&self.head.motion.pose(time.0))
    }

    /// The head that is tracked, with its tracker and predictor.
    #[must_use]
    pub fn head(&self) -> &Head {
        &self.head
    }

    /// The scene that the head looks at.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Where what has no place of its own is judged, metres: the distance that was said, else that from the head's start to the middle
    /// of the scene, at least 0.1.
    #[must_use]
    pub fn distance_m(&self) -> f64 {
        let (centre, _) = self.scene.bounding_sphere();
        self.head.judge_at_m().unwrap_or_else(|| self.base.position.distance(centre.as_dvec3()).max(0.1))
    }

    /// Every pose that was asked for and not given up ([`Keep`](crate::Keep)), in order of the numbers.
    #[must_use]
    pub fn sampled(&self) -> Vec<Sampled> {
        let mut all = self.state().1.clone();
        all.sort_by_key(|sampled| sampled.number);
        all
    }

    /// Somebody who follows the same reports from the first one on, with a predictor of his own.
    pub(crate) fn follower(&self) -> Follower {
        Follower::of_head(&self.head, self.until)
    }

    /// What reaches the host while the run goes on.
    pub(crate) fn arrivals(&self) -> Arrivals {
        self.head.arrivals(self.until)
    }

    pub(crate) const fn start(&self) -> &Pose {
        &self.start
    }
}
