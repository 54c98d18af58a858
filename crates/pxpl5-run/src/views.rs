//! The functions that a pipeline asks for views.

use pphigs::FrameView;
use pxpl5_sim::Time;
use pxpl5_wire::ViewNumber;
use std::sync::Arc;
use tracking::Pose;

/// The view of a number whose pose is sampled at a time.
pub type Views = Arc<dyn Fn(ViewNumber, Time) -> FrameView + Send + Sync>;

/// The view that firmware with a clock of its own asks for: number, the instant up to which the host's tracking data have
/// reached it, and the moment that the view is drawn for.
pub type ViewsWanted = Arc<dyn Fn(ViewNumber, Time, Time) -> FrameView + Send + Sync>;

/// The pose that a host knows of at an instant, for another one: in rising order of the first.
pub type Poses = Arc<dyn Fn(Time, Time) -> Pose + Send + Sync>;

/// When the first report of the tracker after an instant reaches the host; `None` if none will.
pub type ReportTimes = Arc<dyn Fn(Time) -> Option<Time> + Send + Sync>;

/// When a host that waits for its pipeline and is ready for a frame begins it, at that instant or later; `None` for never.
pub type FrameStarts = Arc<dyn Fn(Time) -> Option<Time> + Send + Sync>;
