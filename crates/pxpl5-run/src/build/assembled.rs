//! A machine with its programs, and the records of its run.

use crate::head_views::HeadViews;
use pxpl5_machine::Machine;
use pxpl5_sim::Time;
use std::sync::Arc;

#[derive(Debug)]
pub(crate) struct Assembled {
    pub(crate) machine: Machine,
    pub(crate) head: Option<Arc<HeadViews>>,
}

impl Assembled {
    /// Returns the number of records in memory, including recorded messages and requested head poses.
    pub(crate) fn records(&self) -> usize {
        let observation = self.machine.record().observation();
        let traffic = observation.traffic.as_ref().map_or(0, |traffic| traffic.records());
        observation.records() + traffic + self.head.as_ref().map_or(0, |head| head.records())
    }

    /// Discards the machine's observations before `instant` and the requested head poses before `of_head`. The results
    /// of discarded records must already be part of the statistics of the run.
    pub(crate) fn discard_before(&mut self, instant: Time, of_head: Time) {
        self.machine.discard_before(instant);
        self.head.iter().for_each(|head| head.discard_before(of_head));
    }
}
