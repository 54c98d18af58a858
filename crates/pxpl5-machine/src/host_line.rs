//! A line from the host to a display that does not go over the ring.

use pxpl5_sim::Time;
use pxpl5_wire::Word;
use std::fmt::Debug;
use std::sync::Arc;

/// What a host says to the first display by a line of its own, such as the orientations of a head: nothing on the ring delays it.
pub trait HostLine: Debug {
    /// When the next words have come after an instant; `None` when none will.
    fn next(&self, after: Time) -> Option<Time>;

    /// The words that have come at an instant that [`HostLine::next`] named. It is asked in the order of time.
    fn words(&mut self, now: Time) -> Arc<[Word]>;
}
