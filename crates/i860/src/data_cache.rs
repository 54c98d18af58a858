//! The data cache: its cache lines, line fills, and the write-backs of replaced dirty lines.

use crate::block::AccessingUnit;
use crate::bus::Bus;
use crate::cache::DataTags;
use crate::common::Common;
use crate::dram::Transfer;
use crate::store_pipe::StorePipe;
use crate::timing::ChipSizes;

const BUS_BYTES: u32 = ChipSizes::PAPERS.bus_bytes as u32;
/// Number of 8-byte bus transfers that fill one cache line.
const BEATS: u32 = ChipSizes::PAPERS.line_bytes as u32 / BUS_BYTES;

#[derive(Clone, Debug)]
pub(crate) struct DataCache(DataTags);

impl DataCache {
    pub(crate) fn new() -> DataCache {
        DataCache(DataTags::new())
    }

    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    #[inline]
    pub(crate) fn holds(&self, address: u32) -> bool {
        self.0.holds(address)
    }

    /// Finds the first access that misses the cache. The search begins with access `from`, and ends before instruction
    /// or pair `limit`. An access that always uses the bus counts as a miss. Stores that hit mark their cache lines as
    /// dirty.
    ///
    /// After a miss, returns the indices of the access and of its instruction or pair. Without a miss, returns the
    /// index of the first access that was not checked, and `None`.
    #[inline]
    pub(crate) fn held(
        &mut self,
        addresses: &[u32],
        accessing: &[AccessingUnit],
        from: usize,
        limit: usize,
    ) -> (usize, Option<usize>) {
        let count = addresses.len().min(accessing.len());
        let (addresses, accessing) = (&addresses[..count], &accessing[..count]);
        let mut next = from;
        // Continue while the accesses hit.
        while next < count {
            let unit = accessing[next];
            let number = usize::from(unit.number);
            if number >= limit {
                break;
            }
            if unit.leaves_cache {
                return (next, Some(number));
            }
            if !self.0.access(addresses[next], unit.is_store) {
                return (next, Some(number));
            }
            next += 1;
        }
        (next, None)
    }

    /// Returns true if the data cache contains the cache line of `address`. A store also marks the line as dirty.
    #[inline]
    pub(crate) fn access(&mut self, address: u32, stores: bool) -> bool {
        self.0.access(address, stores)
    }

    /// Starts a bus transfer for a load of `size` bytes. Returns `None` if the cache contains the bytes, so that no
    /// transfer is necessary.
    #[inline]
    pub(crate) fn load<B: Bus>(
        &mut self,
        address: u32,
        size: u32,
        stores: &mut StorePipe,
        common: &mut Common,
        bus: &B,
    ) -> Option<Transfer> {
        if self.holds(address) {
            return None;
        }
        // Read devices and the ring window without a line fill.
        let transfer = match bus.is_cacheable(address) {
            true => self.fill_line(address, stores, common),
            false => common.read_data(address, size.div_ceil(BUS_BYTES)),
        };
        common.data_fill_end = transfer.last;
        Some(transfer)
    }

    /// Fills the cache line of `address`, and returns the bus transfer. The requested bytes arrive first. A replaced
    /// dirty line is written back after the fill.
    fn fill_line(&mut self, address: u32, stores: &mut StorePipe, common: &mut Common) -> Transfer {
        common.profile.data_misses += 1;
        let transfer = common.read_data(address, BEATS);
        // Every fill takes a random number, even if a way is empty.
        let random = common.chance.next();
        if let Some(victim) = self.0.fill(address, random) {
            stores.write_back(transfer.last, victim, common);
        }
        transfer
    }

    pub(crate) fn flush(&mut self, address: u32, stores: &mut StorePipe, common: &mut Common) {
        if self.0.clean(address) {
            stores.write_back(common.now, address, common);
        }
    }
}
