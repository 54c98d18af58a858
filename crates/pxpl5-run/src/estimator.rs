//! Estimates the head's pose from tracker reports after a run. The estimate can leave out one cause of error.

use crate::head_views::{Follower, HeadViews};
use crate::report_schedule::Coming;
use pxpl5_sim::Time;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;
use tracking::Pose;
use tracking::motion::AdvancedMotion;
use tracking::predict::ExactPredictor;
use tracking::time::PS_PER_S;
use tracking::tracker::{TrackerConfig, TrackerModel};

/// A cause of pixel errors.
///
/// After a run, an [`Estimator`] can compute poses as if one cause did not exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// Latency: reports arrive late at the host, and pictures are shown late. If this cause is turned off, the host has
    /// every measurement up to the instant for which a picture is drawn.
    Latency,
    /// Scan-out: a picture is drawn for one instant, but its lines light one after the other. If this cause is turned
    /// off, all lines light at the instant for which the picture was drawn.
    ScanOut,
    /// Noise and bias of the tracker. If this cause is turned off, reports contain the true pose.
    Noise,
    /// Errors of the predictor. If this cause is turned off, the predicted pose is the reported pose plus the true
    /// movement of the head since the measurement.
    Prediction,
    /// Sampling: the tracker measures, and the host polls, at intervals. If this cause is turned off, a report arrives
    /// exactly when the host predicts.
    Sampling,
}

impl Cause {
    /// All causes of error, in the order of their rows in tables.
    pub const ALL: [Self; 5] = [Self::Latency, Self::ScanOut, Self::Noise, Self::Prediction, Self::Sampling];

    /// Returns the name of the cause of error in tables and files.
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

pxpl5_sim::parameters::named!(Cause, "cause", Cause::ALL.map(|cause| (cause.name(), cause)));

/// Length of the series of reports that a predictor receives for one request, in picoseconds.
const FED_PS: u64 = 2 * PS_PER_S;

/// An estimator of the head's pose, from the tracker reports that a host has at an instant.
pub struct Estimator {
    views: Arc<HeadViews>,
    way: Way,
}

enum Way {
    Following(Follower),
    /// One predictor receives all measurements of the tracker up to the requested instant.
    AtOnce(Follower),
    /// Each request creates a predictor and a series of reports, the newest of which arrives at the instant of the
    /// request.
    Fresh(TrackerModel),
}

impl fmt::Debug for Estimator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Estimator").field("views", &self.views).finish_non_exhaustive()
    }
}

impl Estimator {
    /// Creates an estimator that gives the same poses as the run's host, but without one cause of error. The cause
    /// [`Cause::ScanOut`] does not affect poses, so the poses do not change.
    pub fn new(views: &Arc<HeadViews>, without: Option<Cause>) -> Self {
        let head = views.head();
        // Each cause is removed from the tracker or from the predictor, and the rest stays as in the run.
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

    /// Returns the predicted pose of the head at the instant `at`, in the scene's coordinates. The prediction uses only
    /// the reports that had arrived at the instant `reports_until`. From call to call, `reports_until` must not
    /// decrease.
    pub fn pose(&mut self, reports_until: Time, at: Time) -> Pose {
        let start = self.views.start();
        let tracked = match &mut self.way {
            Way::Following(follower) => follower.pose(reports_until, at, start),
            Way::AtOnce(follower) => follower.pose(reports_until.max(at), at, start),
            Way::Fresh(tracker) => fresh(&self.views, tracker, reports_until, at),
        };
        self.views.in_scene(&tracked)
    }
}

fn model_of(tracker: TrackerConfig) -> TrackerModel {
    TrackerModel::new(tracker).expect("less of what was checked by Head::new")
}

fn follower_of(views: &HeadViews, tracker: TrackerConfig) -> Follower {
    let head = views.head();
    let model = model_of(tracker);
    let reports = || model.reports(Arc::clone(&head.motion), head.seed);
    let until = views.last_report().unwrap_or_default();
    let arrivals = reports().map(Coming::of).take_while(move |coming| coming.arrives <= until);
    Follower::new(Box::new(arrivals), Box::new(reports()), head.build_predictor())
}

/// Returns the pose at `at`, as if a tracker report had arrived exactly at `reports_until`.
///
/// To make a report arrive at `reports_until`, the function shifts the motion by the age of the newest report at
/// `reports_until`.
fn fresh(views: &HeadViews, tracker: &TrackerModel, reports_until: Time, at: Time) -> Pose {
    let head = views.head();
    // Find the newest report of the run.
    let from = reports_until.0.saturating_sub(FED_PS);
    let arrivals = tracker.reports(head.motion(), head.seed).from(from).map(|report| report.arrives_ps);
    let Some(newest) = arrivals.take_while(|arrival| *arrival <= reports_until.0).last() else {
        return *views.start();
    };
    // Shift the motion by the age of that report, and feed a new predictor.
    let ahead_ps = reports_until.0 - newest;
    let motion = AdvancedMotion { motion: head.motion(), by_ps: ahead_ps };
    let mut predictor = head.build_predictor();
    let reports = tracker.reports(&motion, head.seed).from(from);
    reports.take_while(|report| report.arrives_ps <= newest).for_each(|report| predictor.observe(&report));
    if predictor.counts().accepted == 0 { *views.start() } else { predictor.predict(at.0.saturating_sub(ahead_ps)) }
}
