use pphigs::FrameView;
use pxpl5_sim::Time;
use pxpl5_wire::ViewNumber;
use std::fmt::Debug;
use tracking::Pose;

/// Source of the views and poses that firmware requests: a tracked head, or the scene's own head motion.
pub trait ViewSource: Debug + Send + Sync {
    /// Returns the newest view: its transforms, and the edits of moving structures. `now` is the time of the request.
    fn newest(&self, number: ViewNumber, now: Time) -> FrameView;

    /// Returns a view for the later instant `shown_at`, for firmware that computes the display time of a view. `now` is
    /// the time of the request.
    fn view_at(&self, number: ViewNumber, now: Time, shown_at: Time) -> FrameView;

    /// Returns the head's pose at the instant `at`, as predicted at the time `now` of the request, for displays that
    /// follow the head's rotation. From call to call, `now` must not decrease.
    fn pose_at(&self, now: Time, at: Time) -> Pose;

    /// Returns the arrival time at the host of the first tracker report that arrives at `instant` or later. Returns
    /// `None` if no such report exists.
    fn report_from(&self, instant: Time) -> Option<Time>;

    /// Returns the arrival time at the host of the first tracker report that arrives after `instant`.
    fn report_after(&self, instant: Time) -> Option<Time> {
        self.report_from(Time(instant.0.saturating_add(1)))
    }
}
