//! A machine with its programs, and the records of its run.

use crate::head_views::HeadViews;
use pxpl5_machine::Machine;
use pxpl5_sim::Time;
use std::sync::Arc;

/// A machine with its programs, and the records that are written during the run.
#[derive(Debug)]
pub(crate) struct Assembled {
    pub(crate) machine: Machine,
    pub(crate) head: Option<Arc<HeadViews>>,
}

impl Assembled {
    /// Returns the number of records of the run in memory: observations of the machine, recorded messages, and records
    /// of the head.
    pub(crate) fn records(&self) -> usize {
        let observation = self.machine.record().observation();
        let traffic = observation.traffic.as_ref().map_or(0, |traffic| traffic.records());
        observation.records() + traffic + self.head.as_ref().map_or(0, |head| head.records())
    }

    /// Discards observations of the machine before the time `instant`, and records of the head before the time
    /// `of_head`. No result that is computed later may need the discarded records.
    pub(crate) fn discard_before(&mut self, instant: Time, of_head: Time) {
        self.machine.discard_before(instant);
        self.head.iter().for_each(|head| head.discard_before(of_head));
    }
}
