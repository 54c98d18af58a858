//! All constants of the timing model.
//!
//! Clocks are processor clocks: 25 ns at 40 MHz. *Intel's list* is the table of instruction timings in the programmer's
//! manual, as the authors remember it.

pub use crate::freeze::{FREEZES, Freeze, FreezeClocks, FreezeRow, FreezeRules, N_FREEZES};
use pxpl5_sim::parameters::ParameterTable;

pxpl5_sim::parameters::parameter_table! {
    /// Timing of the memory on the bus: one bank of page-mode DRAM with a data path of 64 bits. The defaults lie in the
    /// middle of the known values of i860 boards of about 1990.
    pub struct DramTiming {
        /// Time from a request to the arrival of the first 8 bytes if the DRAM row is already open.
        first_hit: 8, "clocks", Assumed, 5..=10 in 0..=1_000_000, "line fill of about 14 clocks on boards of the period";
        /// Time from a request to the arrival of the first 8 bytes if the DRAM row must be opened.
        first_miss: 11, "clocks", Assumed, 8..=16 in 0..=1_000_000, "line fill of about 16 to 18 clocks when the row changes";
        /// Time between successive 8-byte transfers of a cache line, and between overlapped requests to the open DRAM
        /// row.
        next: 2, "clocks", Assumed, 2..=4 in 0..=1_000_000, "the bus needs 2 clocks per transfer (160 MB/s at 40 MHz)";
        /// Time of one write of up to 8 bytes to the open DRAM row.
        write_hit: 3, "clocks", Assumed, 2..=4 in 0..=1_000_000, "page-mode write, 2 to 3 clocks per 8 bytes";
        /// Time of one write of up to 8 bytes if the DRAM row must be opened.
        write_miss: 9, "clocks", Assumed, 6..=12 in 0..=1_000_000, "6 to 8 clocks more than in the open row";
        /// Size of a DRAM row. The NENE# pin of the processor reports that two successive addresses share a DRAM row.
        page_bytes: 4096, "bytes", Assumed, 1024..=16384 in 8..=MAX, "64 bits of 1M x 1 or 256K x 4 parts: 512 to 1,024 columns";
        /// Time between DRAM refreshes. 0 means no refresh.
        refresh_interval: 625, "clocks", Assumed, 0..=625 in 0..=MAX, "15.6 us at 40 MHz";
        /// Time during which a refresh blocks the memory. A refresh also closes the open DRAM row.
        refresh_clocks: 8, "clocks", Assumed, 0..=12 in 0..=1_000_000, "one row cycle";
        /// Time between 8-byte transfers of other bus masters, such as the ring interface. 0 means no transfers.
        dma_interval: 0, "clocks", Assumed, 0..=80 in 0..=MAX, "a ring channel at full rate moves 8 bytes every 4 clocks; default: ring idle";
        /// Time during which a transfer of another bus master blocks the memory. The transfer also closes the open DRAM
        /// row.
        dma_clocks: 3, "clocks", Assumed, 0..=6 in 0..=1_000_000, "one page-mode write";
    }
}

pxpl5_sim::parameters::parameter_table! {
    /// Sizes of caches, TLB, bus queues and pipes on the chip. These sizes are fixed.
    pub struct ChipSizes {
        /// Size of the instruction cache.
        instruction_cache_bytes: 4096, "bytes", Published, 4096..=4096, "Intel's manual";
        /// Size of the data cache.
        data_cache_bytes: 8192, "bytes", Published, 8192..=8192, "Intel's manual";
        /// Size of a cache line in both caches.
        line_bytes: 32, "bytes", Published, 32..=32, "Intel's manual";
        /// Associativity of both caches: number of cache lines in each set.
        cache_ways: 2, "lines", Published, 2..=2, "Intel's manual";
        /// Number of entries in the TLB. Each entry translates the addresses of one page.
        tlb_entries: 64, "entries", Published, 64..=64, "Intel's manual";
        /// Associativity of the TLB: number of entries in each set.
        tlb_ways: 4, "entries", Assumed, 2..=8, "recollection of Intel's manual";
        /// Size of a memory page. One TLB entry translates the addresses of one page.
        page_bytes: 4096, "bytes", Published, 4096..=4096, "Intel's manual: the page tables are those of the 386";
        /// Number of bytes that one bus transfer carries.
        bus_bytes: 8, "bytes", Published, 8..=8, "Intel's manual";
        /// Greatest number of bus requests that can be outstanding at the same time.
        bus_depth: 3, "requests", Assumed, 1..=3, "the address pipe of the external bus";
        /// Greatest number of stores that can wait at the same time.
        store_depth: 3, "stores", Assumed, 2..=3, "two inside and one on the bus";
        /// Greatest number of pipelined loads that can be outstanding at the same time.
        load_depth: 3, "loads", Published, 3..=3, "Intel's manual: the load pipe has three stages";
    }
}

const FREEZES_PATH: &str = "i860.freezes";
const DRAM_PATH: &str = "i860.dram";

/// Prefix of the names of on-chip sizes in lists of parameters. Users cannot set these sizes.
pub const CHIP_PATH: &str = "i860.chip";

/// Configuration of a processor: timing rules, memory timing, and results of the reciprocal approximations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// True if the processor counts clocks. Otherwise it counts only instructions.
    pub timing: bool,
    /// Enabled rows of the freeze table, and their delays in clocks.
    pub freezes: FreezeRules,
    pub dram: DramTiming,
    /// Table from which `frcp` and `frsqr` take their results, approximations of reciprocals and reciprocal roots.
    pub seeds: crate::SeedTable,
    /// Seed of the pseudo-random sequence that chooses the cache line to replace.
    pub replacement_seed: u16,
    /// True if the clocks of repeated code are reused instead of counted again (as in FastSim; Schnarr and Larus,
    /// 1998). The code and its data must be in the caches. This is on by default and changes only the computing time.
    pub memoise: bool,
}

impl Config {
    /// Returns the configuration with all rows of the freeze table and the default memory timing.
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

    /// Returns all tables of timing parameters, each with the prefix of its parameter names.
    pub fn tables(&self) -> [(&'static str, &dyn ParameterTable); 3] {
        [(FREEZES_PATH, &self.freezes.clocks), (DRAM_PATH, &self.dram), (CHIP_PATH, &ChipSizes::PAPERS)]
    }

    /// Returns the tables whose values can be changed: all tables except the on-chip sizes.
    pub fn tables_mut(&mut self) -> [(&'static str, &mut dyn ParameterTable); 2] {
        [(FREEZES_PATH, &mut self.freezes.clocks), (DRAM_PATH, &mut self.dram)]
    }

    /// Returns the settings that differ from [`Config::cycle`] and change results, as keys and values, for names of
    /// experiments. Parameter tables are not part of the list; nor is memoization, because it changes no result.
    pub fn unusual_settings(&self) -> Vec<(&'static str, String)> {
        // The pattern lists every field, so that the compiler reports a new field that is not handled here.
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

    /// Returns a configuration without clocks. Programs compute the same results as with [`Config::cycle`].
    pub fn functional() -> Config {
        Config { timing: false, ..Config::cycle() }
    }
}
