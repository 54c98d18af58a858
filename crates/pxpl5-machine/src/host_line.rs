//! A line to a display that does not go over the ring.

use pxpl5_sim::Time;
use pxpl5_wire::Body;
use std::fmt::Debug;

/// What comes to the first display by a line of its own, such as the orientations of a head from the host: nothing on the ring delays
/// it.
pub trait HostLine: Debug {
    /// When the next messages have come after an instant; `None` when none will.
    fn next(&self, after: Time) -> Option<Time>;

    /// What has come at an instant that [`HostLine::next`] named, in order, each with the number of the display's port that it came
    /// to. It is asked in the order of time.
    fn messages(&mut self, now: Time) -> Vec<(usize, Body)>;
}
