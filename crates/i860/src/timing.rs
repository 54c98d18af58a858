//! Every number of the timing model.
//!
//! Clocks are processor clocks: 25 ns at 40 MHz. *Intel's list* is the table of instruction timings in the programmer's
//! manual, from memory.

pub use crate::freeze::{FREEZES, Freeze, FreezeRow, FreezeRules, N_FREEZES};
use parameters::ParameterTable;

parameters::parameter_table! {
    /// The constant part of each row of [`FREEZES`], in the same order.
    /// Where no published figure narrows a value, its range is one clock less to one clock more, because the list is
    /// quoted from memory.
    pub struct FreezeClocks {
        /// Cost of freeze row 1a: instruction-cache miss.
        instruction_miss: 0, "clocks", Assumed, 0..=0, "Intel's list, recollected: the wait is all";
        /// Cost of freeze row 1b: instruction-cache miss while a data-cache fill runs.
        instruction_miss_behind_data: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 2: use of an integer-load destination that missed.
        load_miss_use: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 3: fld miss.
        floating_load_miss: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 4: call, calli, ixfr, fxfr, ld.c, st.c while a data-cache fill runs.
        transfer_during_miss: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 5: load, store or pfld while a data-cache fill runs.
        access_during_miss: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 6: destination of ld, ld.c, call, calli, fxfr used by the next instruction.
        load_use: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 7: destination of fld, pfld, ixfr used within two instructions.
        floating_load_use: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected; period matrix code issues an extra operation because loads need time";
        /// Cost of freeze row 8: bc, bnc, bc.t, bnc.t right after addu, adds, subu, subs or a compare.
        condition_use: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 9: multiplier operation whose first source is the result of the operation before.
        multiplier_first_source: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 10a: floating-point operation or fst while a scalar fadd, fsub, fix, ftrunc, famov,
        /// fmlow, fmul.ss or fmul.sd is in flight.
        scalar_busy: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected; a measured square root of 48.4 clocks needs it";
        /// Cost of freeze row 10b: floating-point operation or fst while a scalar fmul.dd is in flight.
        scalar_double_multiply_busy: 3, "clocks", Assumed, 2..=4 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 10c: added to row 10a or 10b when the precision changes.
        scalar_precision_change: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 10d: added to row 10a or 10b when the new operation is pipelined and has a destination.
        scalar_then_pipelined: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 11: multiplier operation right after a double-precision multiply.
        double_multiply: 1, "clocks", Assumed, 1..=1 in 0..=1_000_000, "Intel's list, recollected; the published peak of 60 MFLOPS double at 40 MHz needs it";
        /// Cost of freeze row 12: TLB miss (only with address translation on).
        tlb_miss: 5, "clocks", Assumed, 4..=6 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 13: pfld with three outstanding.
        load_pipe_full: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 14: pfld that hits the data cache.
        pipelined_load_hit: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 15: store miss with three stores waiting, or with a write-back pending.
        store_pipe_full: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 16: bus request with three outstanding.
        address_pipe_full: 0, "clocks", Assumed, 0..=0, "Intel's list, recollected: the wait is all";
        /// Cost of freeze row 17: ld or fld right after a store that hit.
        load_after_store_hit: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 18: bc.t, bnc.t or bla not taken.
        delayed_branch_not_taken: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected; a taken bnc.t costs no more than its slot in period code";
        /// Cost of freeze row 19a: bc or bnc taken.
        branch_taken: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 19b: bte or btne taken.
        compare_branch_taken: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 20: bri, calli.
        indirect_branch: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 21: st.c to any control register.
        control_store: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 22a: graphics result used by the next adder or multiplier operation.
        graphics_to_floating: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 22b: graphics result used by the next graphics operation (not fmov.dd).
        graphics_to_graphics: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 23: flush after flush.
        flush_after_flush: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 24: fst or pst, then a pipelined operation that overwrites the stored register.
        store_then_overwrite: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Cost of freeze row 25: result of frcp or frsqr used by the next instruction.
        seed_use: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list leaves the seeds out of row 10; a three-way root of 39 clocks allows 0 to 2";
    }
}

parameters::parameter_table! {
    /// Timing of the memory behind the bus: one bank of page-mode DRAM on 64 bits.
    /// The defaults are the middle of what is known of boards of the period.
    pub struct DramTiming {
        /// Time from a request to the first 8 bytes if the DRAM row is already open.
        first_hit: 8, "clocks", Assumed, 5..=10 in 0..=1_000_000, "line fill of about 14 clocks on boards of the period";
        /// Time from a request to the first 8 bytes if the DRAM row must be opened.
        first_miss: 11, "clocks", Assumed, 8..=16 in 0..=1_000_000, "line fill of about 16 to 18 clocks when the row changes";
        /// Time between successive 8-byte transfers of a line, and between overlapped requests to the open row.
        next: 2, "clocks", Assumed, 2..=4 in 0..=1_000_000, "the bus needs 2 clocks per transfer (160 MB/s at 40 MHz)";
        /// Time of one write of up to 8 bytes to the open row.
        write_hit: 3, "clocks", Assumed, 2..=4 in 0..=1_000_000, "page-mode write, 2 to 3 clocks per 8 bytes";
        /// Time of one write of up to 8 bytes if the DRAM row must be opened.
        write_miss: 9, "clocks", Assumed, 6..=12 in 0..=1_000_000, "6 to 8 clocks more than in the open row";
        /// Size of a DRAM row (the NENE# pin reports whether two addresses share a row).
        page_bytes: 4096, "bytes", Assumed, 1024..=16384 in 8..=MAX, "64 bits of 1M x 1 or 256K x 4 parts: 512 to 1,024 columns";
        /// Time between DRAM refreshes; 0 for no refresh.
        refresh_interval: 625, "clocks", Assumed, 0..=625 in 0..=MAX, "15.6 us at 40 MHz";
        /// Time for which a refresh blocks the memory. A refresh closes the row.
        refresh_clocks: 8, "clocks", Assumed, 0..=12 in 0..=1_000_000, "one row cycle";
        /// Time between 8-byte transfers of other bus masters (the ring interface); 0 for no transfers.
        dma_interval: 0, "clocks", Assumed, 0..=80 in 0..=MAX, "a ring channel at full rate moves 8 bytes every 4 clocks; default: ring idle";
        /// Time for which a transfer of another bus master blocks the memory. The transfer closes the row.
        dma_clocks: 3, "clocks", Assumed, 0..=6 in 0..=1_000_000, "one page-mode write";
    }
}

parameters::parameter_table! {
    /// Sizes of caches, TLB, bus and pipes on the chip. These sizes cannot be set.
    pub struct ChipSizes {
        /// Size of the instruction cache.
        instruction_cache_bytes: 4096, "bytes", Published, 4096..=4096, "Intel's manual";
        /// Size of the data cache.
        data_cache_bytes: 8192, "bytes", Published, 8192..=8192, "Intel's manual";
        /// Line size of both caches.
        line_bytes: 32, "bytes", Published, 32..=32, "Intel's manual";
        /// Associativity of both caches.
        cache_ways: 2, "lines", Published, 2..=2, "Intel's manual";
        /// Number of translations in the TLB.
        tlb_entries: 64, "entries", Published, 64..=64, "Intel's manual";
        /// Associativity of the TLB.
        tlb_ways: 4, "entries", Assumed, 2..=8, "recollection of Intel's manual";
        /// Size of a page, which one translation covers.
        page_bytes: 4096, "bytes", Published, 4096..=4096, "Intel's manual: the page tables are those of the 386";
        /// Bytes of one bus transfer.
        bus_bytes: 8, "bytes", Published, 8..=8, "Intel's manual";
        /// Bus requests that may be outstanding at a time.
        bus_depth: 3, "requests", Assumed, 1..=3, "the address pipe of the external bus";
        /// Stores that may wait at a time.
        store_depth: 3, "stores", Assumed, 2..=3, "two inside and one on the bus";
        /// Pipelined loads that may be outstanding at a time.
        load_depth: 3, "loads", Published, 3..=3, "Intel's manual: the load pipe has three stages";
    }
}

/// Path prefixes of the tables that can be set.
const FREEZES_PATH: &str = "i860.freezes";
const DRAM_PATH: &str = "i860.dram";

/// Path prefix of the on-chip sizes, which are listed but cannot be set.
pub const CHIP_PATH: &str = "i860.chip";

/// Configuration of a processor: timing, seeds and optimization.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// True if clocks are counted. Without timing only instructions are counted.
    pub timing: bool,
    /// Freeze rules that apply, and their costs.
    pub freezes: FreezeRules,
    /// Timing of the memory behind the bus.
    pub dram: DramTiming,
    /// Table of the results of frcp and frsqr.
    pub seeds: crate::SeedTable,
    /// Start of the pseudo-random sequence of the cache replacement.
    pub replacement_seed: u16,
    /// True if the clocks of repeated code that hits the caches are reused instead of counted again, as in FastSim
    /// (Schnarr and Larus, 1998).
    /// This optimization changes only the host's time and is on by default.
    pub memoise: bool,
}

impl Config {
    /// Returns cycle timing with all freeze rules and the default memory.
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

    /// Returns all tables of timing numbers, each with its path prefix.
    #[must_use]
    pub fn tables(&self) -> [(&'static str, &dyn ParameterTable); 3] {
        [(FREEZES_PATH, &self.freezes.clocks), (DRAM_PATH, &self.dram), (CHIP_PATH, &ChipSizes::PAPERS)]
    }

    /// Returns the tables whose numbers can be set: all except the on-chip sizes.
    pub fn tables_mut(&mut self) -> [(&'static str, &mut dyn ParameterTable); 2] {
        [(FREEZES_PATH, &mut self.freezes.clocks), (DRAM_PATH, &mut self.dram)]
    }

    /// Returns the settings outside the tables that change results and differ from [`Config::cycle`], as keys and
    /// values.
    /// Names of experiments include them. Memoization changes no result and is left out.
    #[must_use]
    pub fn unusual_settings(&self) -> Vec<(&'static str, String)> {
        // The pattern names every field, so that a new one cannot be forgotten.
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

    /// Returns a configuration that counts no clocks. Programs compute the same results as with [`Config::cycle`].
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
