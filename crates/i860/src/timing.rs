//! Every number of the timing model.
//!
//! Clocks are those of the processor: 25 ns at 40 MHz. *Intel's list* is the table of instruction timings in the
//! programmer's manual, as it is remembered.

pub use crate::freeze::{FREEZES, Freeze, FreezeRow, FreezeRules, N_FREEZES};
use parameters::ParameterTable;

parameters::parameter_table! {
    /// The constant part of each row of [`FREEZES`], in its order. Where no published figure narrows it, the range is one
    /// clock either way, as far as the memory of a list may be wrong.
    pub struct FreezeClocks {
        /// Row 1a: instruction-cache miss.
        instruction_miss: 0, "clocks", Assumed, 0..=0, "Intel's list, recollected: the wait is all";
        /// Row 1b: instruction-cache miss while a data-cache fill runs.
        instruction_miss_behind_data: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 2: use of an integer-load destination that missed.
        load_miss_use: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 3: fld miss.
        floating_load_miss: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 4: call, calli, ixfr, fxfr, ld.c, st.c while a data-cache fill runs.
        transfer_during_miss: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 5: load, store or pfld while a data-cache fill runs.
        access_during_miss: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 6: destination of ld, ld.c, call, calli, fxfr used by the next instruction.
        load_use: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 7: destination of fld, pfld, ixfr used within two instructions.
        floating_load_use: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected; period matrix code issues an extra operation because loads need time";
        /// Row 8: bc, bnc, bc.t, bnc.t right after addu, adds, subu, subs or a compare.
        condition_use: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 9: multiplier operation whose first source is the result of the operation before.
        multiplier_first_source: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 10a: floating-point operation or fst while a scalar fadd, fsub, fix, ftrunc, famov, fmlow, fmul.ss or fmul.sd is in flight.
        scalar_busy: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected; a measured square root of 48.4 clocks needs it";
        /// Row 10b: the same behind a scalar fmul.dd.
        scalar_double_multiply_busy: 3, "clocks", Assumed, 2..=4 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 10c: added to 10a or 10b when the precision changes.
        scalar_precision_change: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 10d: added to 10a or 10b when the new operation is pipelined and has a destination.
        scalar_then_pipelined: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 11: multiplier operation right after a double-precision multiply.
        double_multiply: 1, "clocks", Assumed, 1..=1 in 0..=1_000_000, "Intel's list, recollected; the published peak of 60 MFLOPS double at 40 MHz needs it";
        /// Row 12: TLB miss (translation on).
        tlb_miss: 5, "clocks", Assumed, 4..=6 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 13: pfld with three outstanding.
        load_pipe_full: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 14: pfld that hits the data cache.
        pipelined_load_hit: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 15: store miss with three stores waiting, or with a write-back pending.
        store_pipe_full: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 16: bus request with three outstanding.
        address_pipe_full: 0, "clocks", Assumed, 0..=0, "Intel's list, recollected: the wait is all";
        /// Row 17: ld or fld right after a store that hit.
        load_after_store_hit: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 18: bc.t, bnc.t or bla not taken.
        delayed_branch_not_taken: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected; a taken bnc.t costs no more than its slot in period code";
        /// Row 19a: bc or bnc taken.
        branch_taken: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 19b: bte or btne taken.
        compare_branch_taken: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 20: bri, calli.
        indirect_branch: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 21: st.c, whatever it stores to.
        control_store: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 22a: graphics result used by the next adder or multiplier operation.
        graphics_to_floating: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 22b: graphics result used by the next graphics operation (not fmov.dd).
        graphics_to_graphics: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 23: flush after flush.
        flush_after_flush: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 24: fst or pst, then a pipelined operation that overwrites the stored register.
        store_then_overwrite: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Row 25: result of frcp or frsqr used by the next instruction.
        seed_use: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list leaves the seeds out of row 10; a three-way root of 39 clocks allows 0 to 2";
    }
}

parameters::parameter_table! {
    /// Memory behind the bus: one bank of page-mode DRAM on 64 bits. The defaults are the middle of what is known of boards
    /// of the period.
    pub struct DramTiming {
        /// Request to the first 8 bytes, row already open.
        first_hit: 8, "clocks", Assumed, 5..=10 in 0..=1_000_000, "line fill of about 14 clocks on boards of the period";
        /// Request to the first 8 bytes, row to be opened.
        first_miss: 11, "clocks", Assumed, 8..=16 in 0..=1_000_000, "line fill of about 16 to 18 clocks when the row changes";
        /// Between successive 8 bytes of a line, and between overlapped requests to the open row.
        next: 2, "clocks", Assumed, 2..=4 in 0..=1_000_000, "the bus needs 2 clocks per transfer (160 MB/s at 40 MHz)";
        /// One write of up to 8 bytes to the open row.
        write_hit: 3, "clocks", Assumed, 2..=4 in 0..=1_000_000, "page-mode write, 2 to 3 clocks per 8 bytes";
        /// One write, row to be opened.
        write_miss: 9, "clocks", Assumed, 6..=12 in 0..=1_000_000, "6 to 8 clocks more than in the open row";
        /// Bytes of a row (what the NENE# pin compares).
        page_bytes: 4096, "bytes", Assumed, 1024..=16384 in 8..=MAX, "64 bits of 1M x 1 or 256K x 4 parts: 512 to 1,024 columns";
        /// Between refreshes, 0 for none.
        refresh_interval: 625, "clocks", Assumed, 0..=625 in 0..=MAX, "15.6 us at 40 MHz";
        /// For which a refresh holds the memory; it closes the row.
        refresh_clocks: 8, "clocks", Assumed, 0..=12 in 0..=1_000_000, "one row cycle";
        /// Between transfers of 8 bytes of other bus masters (ring interface), 0 for none.
        dma_interval: 0, "clocks", Assumed, 0..=80 in 0..=MAX, "a ring channel at full rate moves 8 bytes every 4 clocks; default: ring idle";
        /// For which such a transfer holds the memory; it closes the row.
        dma_clocks: 3, "clocks", Assumed, 0..=6 in 0..=1_000_000, "one page-mode write";
    }
}

parameters::parameter_table! {
    /// Sizes of what is on the chip. They are those of the part and cannot be set.
    pub struct ChipSizes {
        /// Size of the instruction cache.
        instruction_cache_bytes: 4096, "bytes", Published, 4096..=4096, "Intel's manual";
        /// Size of the data cache.
        data_cache_bytes: 8192, "bytes", Published, 8192..=8192, "Intel's manual";
        /// Line of either cache.
        line_bytes: 32, "bytes", Published, 32..=32, "Intel's manual";
        /// Lines of a set of either cache.
        cache_ways: 2, "lines", Published, 2..=2, "Intel's manual";
        /// Translations that are held.
        tlb_entries: 64, "entries", Published, 64..=64, "Intel's manual";
        /// Translations of a set.
        tlb_ways: 4, "entries", Assumed, 2..=8, "recollection of Intel's manual";
        /// Memory that a translation covers.
        page_bytes: 4096, "bytes", Published, 4096..=4096, "Intel's manual: the page tables are those of the 386";
        /// Width of the bus: what a transfer moves.
        bus_bytes: 8, "bytes", Published, 8..=8, "Intel's manual";
        /// Bus requests that may be outstanding.
        bus_depth: 3, "requests", Assumed, 1..=3, "the address pipe of the external bus";
        /// Stores that wait at most.
        store_depth: 3, "stores", Assumed, 2..=3, "two inside and one on the bus";
        /// Pipelined loads that may be outstanding.
        load_depth: 3, "loads", Published, 3..=3, "Intel's manual: the load pipe has three stages";
    }
}

/// The first parts of the paths of the tables that can be set.
const FREEZES_PATH: &str = "i860.freezes";
const DRAM_PATH: &str = "i860.dram";

/// The first part of the paths of what is on the chip, which is listed and cannot be set.
pub const CHIP_PATH: &str = "i860.chip";

/// What the processor is built with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// Whether clocks are counted at all; without, only instructions are.
    pub timing: bool,
    /// Which freeze rules apply, and what they cost.
    pub freezes: FreezeRules,
    /// Times of the memory behind the bus.
    pub dram: DramTiming,
    /// Table of frcp and frsqr.
    pub seeds: crate::SeedTable,
    /// Start of the pseudo-random sequence of the cache replacement.
    pub replacement_seed: u16,
    /// Whether runs of code that repeat with all they need in the caches take the clocks that were counted before instead of being
    /// counted again, as FastSim does (Schnarr and Larus, 1998). Changes the host's time only; on by default, being faster.
    pub memoise: bool,
}

impl Config {
    /// Cycle timing with all rules and the default memory.
    #[must_use]
    pub fn cycle() -> Config {
        Config {
            timing: true,
            freezes: FreezeRules::all(),
            dram: DramTiming::PAPERS,
            seeds: crate::SeedTable::Truncated8,
            replacement_seed: 0xACE1,
            memoise: true,
        }
    }

    /// All numbers of the timing, each table with the first part of its paths, for lists of what a machine is made of.
    #[must_use]
    pub fn tables(&self) -> [(&'static str, &dyn ParameterTable); 3] {
        [(FREEZES_PATH, &self.freezes.clocks), (DRAM_PATH, &self.dram), (CHIP_PATH, &ChipSizes::PAPERS)]
    }

    /// The tables whose numbers can be set: all but that of what is on the chip.
    pub fn tables_mut(&mut self) -> [(&'static str, &mut dyn ParameterTable); 2] {
        [(FREEZES_PATH, &mut self.freezes.clocks), (DRAM_PATH, &mut self.dram)]
    }

    /// What stands in no table and changes results, where it is not as in [`Config::cycle`]: for names of experiments. Whether
    /// blocks are memoised changes none.
    #[must_use]
    pub fn unusual_settings(&self) -> Vec<(&'static str, String)> {
        let Config { timing, freezes, dram: _, seeds, replacement_seed, memoise: _ } = self;
        let usual = Config::cycle();
        let all = [
            ("i860.timing", *timing != usual.timing, timing.to_string()),
            ("i860.freezes", freezes.names() != usual.freezes.names(), freezes.names()),
            ("i860.seeds", *seeds != usual.seeds, seeds.name().to_owned()),
            ("i860.replacement_seed", *replacement_seed != usual.replacement_seed, replacement_seed.to_string()),
        ];
        all.into_iter().filter(|(_, differs, _)| *differs).map(|(key, _, value)| (key, value)).collect()
    }

    /// The same results without clocks.
    #[must_use]
    pub fn functional() -> Config {
        Config { timing: false, ..Config::cycle() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_lies_in_its_range() {
        for (name, table) in Config::cycle().tables() {
            assert_eq!(table.out_of_range(), [], "{name}");
            assert_eq!(table.check(), Ok(()), "{name}");
        }
    }
}
