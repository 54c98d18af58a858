//! The store pipe: stores that wait for the bus, and write-backs of cache lines.

use crate::common::Common;
use crate::timing::{ChipSizes, Freeze};

const DEPTH: usize = ChipSizes::PAPERS.store_depth as usize;
const BUS_BYTES: u32 = ChipSizes::PAPERS.bus_bytes as u32;
const LINE_BEATS: u32 = ChipSizes::PAPERS.line_bytes as u32 / BUS_BYTES;

#[derive(Clone, Debug, Default)]
pub(crate) struct StorePipe {
    /// Clocks at which the latest stores leave the store pipe, the oldest first.
    ends: [u64; DEPTH],
    write_back_end: u64,
}

impl StorePipe {
    /// Sends a store to the bus. The processor waits first if the pipe is full or a write-back is pending.
    pub(crate) fn store(&mut self, address: u32, size: u32, common: &mut Common) {
        if common.costs.applies(Freeze::StorePipeFull) {
            self.wait_for_room(common);
        }
        // The store waits for its turn on the bus, and the pipe records the end of this wait.
        common.await_address_pipe();
        let end = common.bus.write(common.now, address, size.div_ceil(BUS_BYTES)).last;
        self.ends.rotate_left(1);
        self.ends[DEPTH - 1] = end;
    }

    fn wait_for_room(&self, common: &mut Common) {
        let blocked = self.ends[0].max(self.write_back_end);
        if blocked > common.now {
            let surcharge = common.costs.clocks(Freeze::StorePipeFull);
            common.freeze_until(blocked + surcharge, Freeze::StorePipeFull);
        }
    }

    pub(crate) fn write_back(&mut self, from: u64, address: u32, common: &mut Common) {
        self.write_back_end = common.bus.write(from, address, LINE_BEATS).last;
    }
}
