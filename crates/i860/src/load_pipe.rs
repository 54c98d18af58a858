//! The pipe of pipelined loads (`pfld`), whose data bypass the cache. The third `pfld` after a load writes the data of
//! this load to a register.

use crate::common::Common;
use crate::timing::{ChipSizes, Freeze};

const DEPTH: usize = ChipSizes::PAPERS.load_depth as usize;
const BUS_BYTES: u32 = ChipSizes::PAPERS.bus_bytes as u32;

#[derive(Clone, Debug, Default)]
pub(crate) struct LoadPipe {
    /// Clocks at which the data of the latest `pfld` instructions arrive, the oldest first.
    arrivals: [u64; DEPTH],
}

impl LoadPipe {
    /// Starts a pipelined load. If three loads are outstanding, the processor first waits for the data of the oldest.
    pub(crate) fn load(&mut self, address: u32, size: u32, is_in_cache: bool, common: &mut Common) {
        // The pipe has three stages, so the fourth load waits for the first.
        let oldest = self.arrivals[0];
        if oldest > common.now && common.costs.applies(Freeze::LoadPipeFull) {
            common.freeze_until(oldest + common.costs.clocks(Freeze::LoadPipeFull), Freeze::LoadPipeFull);
        }
        let arrival = match is_in_cache {
            true => from_cache(common),
            false => common.read_data(address, size.div_ceil(BUS_BYTES)).first,
        };
        self.arrivals.rotate_left(1);
        self.arrivals[DEPTH - 1] = arrival;
    }
}

/// Returns the clock at which data from the cache are ready. The data are ready only after the end of all earlier bus
/// cycles.
fn from_cache(common: &mut Common) -> u64 {
    if common.costs.applies(Freeze::PipelinedLoadHit) {
        let until = common.bus.idle_at().max(common.now) + common.costs.clocks(Freeze::PipelinedLoadHit);
        common.freeze_until(until, Freeze::PipelinedLoadHit);
    }
    common.now
}
