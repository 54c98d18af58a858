//! What a host knows of its head at an instant: from the reports of the run, or as it would be without one cause of error.

use crate::head_views::{Follower, HeadViews};
use crate::report_schedule::Coming;
use pxpl5_sim::Time;
use serde::Serialize;
use std::fmt;
use std::sync::Arc;
use tracking::Pose;
use tracking::motion::Shifted;
use tracking::predict::ExactPredictor;
use tracking::time::PS_PER_S;
use tracking::tracker::{TrackerConfig, TrackerModel};

/// Why content is seen where it should not be. Each can be turned off in the reports and poses of a run that has ended; the
/// machine's times stay as they were.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// Reports are old when they come, and pictures when they are shown. Without it every measurement made up to the instant
    /// that a picture is drawn for is known.
    Latency,
    /// A picture is drawn for one instant and lights over many. Without it all of it is judged at that instant.
    ScanOut,
    /// The tracker's noise and bias. Without them reports say where the head was.
    Noise,
    /// What the predictor makes of the reports. Without it the newest one is carried on by the true motion.
    Prediction,
    /// The tracker measures, and the host's kernel looks, only now and then. Without it a measurement arrives at the very
    /// instant at which it is wanted.
    Sampling,
}

impl Cause {
    /// Every cause, in the order of tables.
    pub const ALL: [Self; 5] = [Self::Latency, Self::ScanOut, Self::Noise, Self::Prediction, Self::Sampling];

    /// Its name in tables and files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Latency => "latency",
            Self::ScanOut => "scan-out",
            Self::Noise => "noise",
            Self::Prediction => "prediction",
            Self::Sampling => "sampling",
        }
    }
}

/// Time over which a predictor is fed before it is asked, where each question has reports of its own, ps.
const FED_PS: u64 = 2 * PS_PER_S;

/// Answers where the head is thought to be, with what is known by an instant.
pub struct Estimator {
    views: Arc<HeadViews>,
    way: Way,
}

enum Way {
    /// Reports are fed to one predictor as time goes on.
    Following(Follower),
    /// The same, with all measurements up to the wanted instant.
    AtOnce(Follower),
    /// Every question has reports of its own, the newest of which arrives as it is asked.
    Fresh(TrackerModel),
}

impl fmt::Debug for Estimator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Estimator").field("views", &self.views).finish_non_exhaustive()
    }
}

impl Estimator {
    /// As the run's host, or without one cause of error. [`Cause::ScanOut`] is none of poses: it changes nothing here.
    #[must_use]
    pub fn new(views: &Arc<HeadViews>, without: Option<Cause>) -> Self {
        let head = views.head();
        let tracker = head.tracker().config().clone();
        let way = match without {
            None | Some(Cause::ScanOut) => Way::Following(views.follower()),
            Some(Cause::Noise) => Way::Following(follower_of(views, tracker.without_noise())),
            Some(Cause::Latency) => Way::AtOnce(follower_of(views, tracker.without_latency())),
            Some(Cause::Prediction) => {
                let exact = Box::new(ExactPredictor::new(Arc::clone(&head.motion), head.predictor().gate));
                Way::Following(Follower::new(views.arrivals(), head.contents(), exact))
            }
            Some(Cause::Sampling) => Way::Fresh(model_of(tracker.without_polling())),
        };
        Self { views: Arc::clone(views), way }
    }

    /// The pose in the scene at an instant, with what had arrived by `known`. To be asked in rising order of `known`.
    pub fn pose(&mut self, known: Time, at: Time) -> Pose {
        let start = self.views.start();
        let tracked = match &mut self.way {
            Way::Following(follower) => follower.pose(known, at, start),
            Way::AtOnce(follower) => follower.pose(known.max(at), at, start),
            Way::Fresh(tracker) => fresh(&self.views, tracker, known, at),
        };
        self.views.in_scene(&tracked)
    }
}

/// A tracker that leaves out something of one that was checked.
fn model_of(tracker: TrackerConfig) -> TrackerModel {
    TrackerModel::new(tracker).expect("less of what was checked by Head::new")
}

/// The run's predictor behind another tracker, for as long as the run's reports go.
fn follower_of(views: &HeadViews, tracker: TrackerConfig) -> Follower {
    let head = views.head();
    let model = model_of(tracker);
    let reports = || model.reports(Arc::clone(&head.motion), head.seed);
    let until = views.last_report().unwrap_or_default();
    let arrivals = reports().map(Coming::of).take_while(move |coming| coming.arrives <= until);
    Follower::new(Box::new(arrivals), Box::new(reports()), head.build_predictor())
}

/// A pose from reports the newest of which arrives at `known`: those of a head that is so much further in its motion as the newest
/// of the run had waited.
fn fresh(views: &HeadViews, tracker: &TrackerModel, known: Time, at: Time) -> Pose {
    let head = views.head();
    let from = known.0.saturating_sub(FED_PS);
    let arrivals = tracker.reports(head.motion(), head.seed).from(from).map(|report| report.arrives_ps);
    let Some(newest) = arrivals.take_while(|arrival| *arrival <= known.0).last() else {
        return *views.start();
    };
    let ahead_ps = known.0 - newest;
    let motion = Shifted { motion: head.motion(), by_ps: ahead_ps };
    let mut predictor = head.build_predictor();
    let reports = tracker.reports(&motion, head.seed).from(from);
    reports.take_while(|report| report.arrives_ps <= newest).for_each(|report| predictor.observe(&report));
    if predictor.counts().accepted == 0 { *views.start() } else { predictor.predict(at.0.saturating_sub(ahead_ps)) }
}
