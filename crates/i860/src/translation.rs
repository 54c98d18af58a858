//! Address translation: the TLB. The model leaves addresses unchanged and only counts the clocks of TLB misses.

use crate::cache::Tags;
use crate::common::Common;
use crate::timing::{ChipSizes, Freeze};

const PAGE_BYTES: u32 = ChipSizes::PAPERS.page_bytes as u32;
const WAYS: usize = ChipSizes::PAPERS.tlb_ways as usize;
const SETS: usize = ChipSizes::PAPERS.tlb_entries as usize / WAYS;

#[derive(Clone, Debug)]
pub(crate) struct Translation {
    /// Address of the page directory, or `None` while address translation is off.
    directory: Option<u32>,
    tlb: Tags<SETS, WAYS, PAGE_BYTES>,
}

impl Translation {
    pub(crate) fn new() -> Translation {
        Translation { directory: None, tlb: Tags::new() }
    }

    #[inline]
    pub(crate) fn is_on(&self) -> bool {
        self.directory.is_some()
    }

    /// Turns on address translation with the page directory at `directory`, or turns it off with `None`.
    pub(crate) fn set_directory(&mut self, directory: Option<u32>) {
        self.directory = directory;
    }

    pub(crate) fn clear(&mut self) {
        self.tlb.clear();
    }

    /// Counts the clocks of a TLB miss: the constant part, a read of the page directory, and a read of a page table.
    /// The model assumes that the page tables follow the directory in memory.
    #[inline]
    pub(crate) fn translate(&mut self, address: u32, common: &mut Common) {
        if let Some(directory) = self.directory
            && common.costs.applies(Freeze::TlbMiss)
            && !self.tlb.holds(address)
        {
            self.miss(address, directory, common);
        }
    }

    fn miss(&mut self, address: u32, directory: u32, common: &mut Common) {
        let random = common.chance.next();
        self.tlb.fill(address, random);
        common.charge(Freeze::TlbMiss);
        // The address of the page table is assumed. Only its DRAM row affects the time.
        let table = directory.wrapping_add((1 + (address >> 22)) * PAGE_BYTES);
        let first = common.bus.read(common.now, directory + (address >> 20 & 0xFFC), 1).first;
        let second = common.bus.read(first, table.wrapping_add(address >> 10 & 0xFFC), 1).first;
        common.freeze_until(second, Freeze::TlbMiss);
    }
}
