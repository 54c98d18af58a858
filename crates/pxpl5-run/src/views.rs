use pphigs::FrameView;
use pxpl5_sim::Time;
use pxpl5_wire::ViewNumber;
use std::sync::Arc;
use tracking::Pose;

/// Function that returns a view.
///
/// The arguments are the number of the view and the time of the request.
pub type Views = Arc<dyn Fn(ViewNumber, Time) -> FrameView + Send + Sync>;

/// Function that returns a view for a later instant.
///
/// The arguments are the number of the view, the time of the request, and the instant for which the view is drawn.
pub type ViewsWanted = Arc<dyn Fn(ViewNumber, Time, Time) -> FrameView + Send + Sync>;

/// Function that predicts the head's pose.
///
/// The arguments are the time of the request and the instant for which the pose is predicted. From call to call, the
/// time of the request must not decrease.
pub type Poses = Arc<dyn Fn(Time, Time) -> Pose + Send + Sync>;

/// Function that returns the arrival time of the first tracker report after an instant, or `None` if no later report
/// exists.
pub type ReportTimes = Arc<dyn Fn(Time) -> Option<Time> + Send + Sync>;

/// Function that returns the time at which a host begins its next frame.
///
/// The argument is the instant at which the host is ready. `None` means that the host begins no more frames.
pub type FrameStarts = Arc<dyn Fn(Time) -> Option<Time> + Send + Sync>;
