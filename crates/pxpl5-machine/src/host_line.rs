use pxpl5_sim::Time;
use pxpl5_wire::Body;
use std::fmt::Debug;

/// A connection from the host to the first display that bypasses the ring, for example for orientations of the head.
///
/// Messages on the ring never delay messages of a host line.
pub trait HostLine: Debug {
    /// Returns the time of the first arrival after the instant `after`, or `None` if no more messages follow.
    fn next(&self, after: Time) -> Option<Time>;

    /// Returns the messages that arrive at the instant `now`, each with an index into the ports of the display.
    ///
    /// The machine calls this method with the instants from [`HostLine::next`], in ascending order.
    fn messages(&mut self, now: Time) -> Vec<(usize, Body)>;
}
