//! Every number of the timing model, with unit, source and standing.
//!
//! Unit: clocks of the processor (25 ns at 40 MHz). Standing: *published* (in a manual or in commented period code),
//! *derived*, or *assumed* with the range that is allowed.

/// How well a number is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// Printed in a source.
    Published,
    /// Follows from published figures.
    Derived,
    /// Recollection or judgement; the source says which published figure supports it.
    Assumed,
}

/// A reason for which the processor stands still. The order is that of [`FREEZES`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u8)]
#[non_exhaustive]
pub enum Freeze {
    /// Row 1.
    InstructionMiss,
    /// Row 1, the surcharge while the data cache is busy.
    InstructionMissBehindData,
    /// Row 2.
    LoadMissUse,
    /// Row 3.
    FloatingLoadMiss,
    /// Row 4.
    TransferDuringMiss,
    /// Row 5.
    AccessDuringMiss,
    /// Row 6.
    LoadUse,
    /// Row 7.
    FloatingLoadUse,
    /// Row 8.
    ConditionUse,
    /// Row 9.
    MultiplierFirstSource,
    /// Row 10, adder and single-precision multiplier.
    ScalarBusy,
    /// Row 10, double-precision multiply.
    ScalarDoubleMultiplyBusy,
    /// Row 10, surcharge for a change of precision.
    ScalarPrecisionChange,
    /// Row 10, surcharge for a pipelined instruction with a destination.
    ScalarThenPipelined,
    /// Row 11.
    DoubleMultiply,
    /// Row 12.
    TlbMiss,
    /// Row 13.
    LoadPipeFull,
    /// Row 14.
    PipelinedLoadHit,
    /// Row 15.
    StorePipeFull,
    /// Row 16.
    AddressPipeFull,
    /// Row 17.
    LoadAfterStoreHit,
    /// Row 18.
    DelayedBranchNotTaken,
    /// Row 19, bc and bnc.
    BranchTaken,
    /// Row 19, bte and btne.
    CompareBranchTaken,
    /// Row 20.
    IndirectBranch,
    /// Row 21.
    ControlStore,
    /// Row 22, use in adder or multiplier.
    GraphicsToFloating,
    /// Row 22, use in the graphics unit.
    GraphicsToGraphics,
    /// Row 23.
    FlushAfterFlush,
    /// Row 24.
    StoreThenOverwrite,
    /// Row 25, not in Intel's table.
    SeedUse,
}

/// Number of rows of [`FREEZES`].
pub const N_FREEZES: usize = 31;

/// One row of the freeze table.
#[derive(Clone, Copy, Debug)]
pub struct FreezeRow {
    /// The row.
    pub id: Freeze,
    /// Number in Intel's list as recollected, with a letter where one number has several costs.
    pub number: &'static str,
    /// When it applies.
    pub condition: &'static str,
    /// The constant part of the cost, in clocks.
    pub clocks: u32,
    /// What is added to the constant part, or how it shrinks.
    pub variable: &'static str,
    /// How well it is known.
    pub standing: Standing,
    /// Why it is believed.
    pub source: &'static str,
}

const fn row(
    id: Freeze,
    number: &'static str,
    clocks: u32,
    condition: &'static str,
    variable: &'static str,
    source: &'static str,
) -> FreezeRow {
    FreezeRow { id, number, condition, clocks, variable, standing: Standing::Assumed, source }
}

const LIST: &str = "recollection of the instruction-timing list in Intel's manual";
const ROOT: &str = "the list; a measured square root of 48.4 clocks needs it";
const LOADS: &str = "the list; period matrix code issues an extra operation because loads need time";

/// The freeze rules. Simultaneous freezes cost the longest; cache misses add.
///
/// "Since" counts clocks, so an instruction in between that itself froze shortens the wait by its whole time.
pub const FREEZES: [FreezeRow; N_FREEZES] = [
    row(
        Freeze::InstructionMiss,
        "1a",
        0,
        "instruction-cache miss",
        "+ clocks from the request to the needed 8 bytes; later words of the line as they arrive; leaving the line waits for all of it",
        LIST,
    ),
    row(Freeze::InstructionMissBehindData, "1b", 2, "instruction-cache miss while a data-cache fill runs", "", LIST),
    row(
        Freeze::LoadMissUse,
        "2",
        1,
        "use of an integer-load destination that missed",
        "+ read clocks - clocks since the load",
        LIST,
    ),
    row(Freeze::FloatingLoadMiss, "3", 1, "fld miss", "+ clocks from the request to the needed 8 bytes", LIST),
    row(
        Freeze::TransferDuringMiss,
        "4",
        1,
        "call, calli, ixfr, fxfr, ld.c, st.c while a data-cache fill runs",
        "+ clocks to the needed 8 bytes",
        LIST,
    ),
    row(
        Freeze::AccessDuringMiss,
        "5",
        1,
        "load, store or pfld while a data-cache fill runs",
        "+ clocks to the end of the line",
        LIST,
    ),
    row(
        Freeze::LoadUse,
        "6",
        1,
        "destination of ld, ld.c, call, calli, fxfr used by the next instruction",
        "- clocks since",
        LIST,
    ),
    row(
        Freeze::FloatingLoadUse,
        "7",
        2,
        "destination of fld, pfld, ixfr used within two instructions",
        "- clocks since",
        LOADS,
    ),
    row(Freeze::ConditionUse, "8", 1, "bc, bnc, bc.t, bnc.t right after addu, adds, subu, subs or a compare", "", LIST),
    row(
        Freeze::MultiplierFirstSource,
        "9",
        1,
        "multiplier operation whose first source is the result of the operation before",
        "",
        LIST,
    ),
    row(
        Freeze::ScalarBusy,
        "10a",
        2,
        "floating-point operation or fst while a scalar fadd, fsub, fix, ftrunc, famov, fmlow, fmul.ss or fmul.sd is in flight",
        "- clocks since",
        ROOT,
    ),
    row(Freeze::ScalarDoubleMultiplyBusy, "10b", 3, "the same behind a scalar fmul.dd", "- clocks since", LIST),
    row(Freeze::ScalarPrecisionChange, "10c", 1, "added to 10a or 10b when the precision changes", "", LIST),
    row(
        Freeze::ScalarThenPipelined,
        "10d",
        1,
        "added to 10a or 10b when the new operation is pipelined and has a destination",
        "",
        LIST,
    ),
    row(
        Freeze::DoubleMultiply,
        "11",
        1,
        "multiplier operation right after a double-precision multiply",
        "",
        "the list; the published peak of 60 MFLOPS double at 40 MHz needs it",
    ),
    row(Freeze::TlbMiss, "12", 5, "TLB miss (translation on)", "+ two reads of the page tables", LIST),
    row(Freeze::LoadPipeFull, "13", 1, "pfld with three outstanding", "+ clocks until the first returns", LIST),
    row(Freeze::PipelinedLoadHit, "14", 2, "pfld that hits the data cache", "+ clocks to finish all bus cycles", LIST),
    row(
        Freeze::StorePipeFull,
        "15",
        1,
        "store miss with three stores waiting, or with a write-back pending",
        "+ clocks to the end of the next write",
        LIST,
    ),
    row(Freeze::AddressPipeFull, "16", 0, "bus request with three outstanding", "+ clocks until the first ends", LIST),
    row(Freeze::LoadAfterStoreHit, "17", 1, "ld or fld right after a store that hit", "", LIST),
    row(
        Freeze::DelayedBranchNotTaken,
        "18",
        1,
        "bc.t, bnc.t or bla not taken",
        "",
        "the list; a taken bnc.t costs no more than its slot in period code",
    ),
    row(Freeze::BranchTaken, "19a", 1, "bc or bnc taken", "", LIST),
    row(Freeze::CompareBranchTaken, "19b", 2, "bte or btne taken", "", LIST),
    row(Freeze::IndirectBranch, "20", 1, "bri, calli", "", LIST),
    row(Freeze::ControlStore, "21", 2, "st.c", "", LIST),
    row(
        Freeze::GraphicsToFloating,
        "22a",
        1,
        "graphics result used by the next adder or multiplier operation",
        "",
        LIST,
    ),
    row(
        Freeze::GraphicsToGraphics,
        "22b",
        1,
        "graphics result used by the next graphics operation (not fmov.dd)",
        "",
        LIST,
    ),
    row(Freeze::FlushAfterFlush, "23", 2, "flush after flush", "- clocks since", LIST),
    row(
        Freeze::StoreThenOverwrite,
        "24",
        1,
        "fst or pst, then a pipelined operation that overwrites the stored register",
        "",
        LIST,
    ),
    row(
        Freeze::SeedUse,
        "25",
        1,
        "result of frcp or frsqr used by the next instruction",
        "",
        "Intel's list leaves the seeds out of row 10; a three-way root of 39 clocks allows 0 to 2",
    ),
];

/// Which rows apply, and their constant parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FreezeRules {
    enabled: u32,
    clocks: [u32; N_FREEZES],
    /// Whether row 8 covers and, andnot, or and xor (open question; default no).
    pub logicals_delay_branches: bool,
}

impl FreezeRules {
    /// All rows of [`FREEZES`].
    #[must_use]
    pub fn all() -> FreezeRules {
        let clocks = FREEZES.map(|row| row.clocks);
        FreezeRules { enabled: (1 << N_FREEZES) - 1, clocks, logicals_delay_branches: false }
    }

    /// No row: one clock per instruction or pair.
    #[must_use]
    pub fn none() -> FreezeRules {
        FreezeRules { enabled: 0, ..FreezeRules::all() }
    }

    /// The same rules with one row switched off.
    #[must_use]
    pub fn without(mut self, id: Freeze) -> FreezeRules {
        self.enabled &= !(1 << id as u32);
        self
    }

    /// The same rules with one row switched on.
    #[must_use]
    pub fn with(mut self, id: Freeze) -> FreezeRules {
        self.enabled |= 1 << id as u32;
        self
    }

    /// The same rules with another constant part of one row.
    #[must_use]
    pub fn with_clocks(mut self, id: Freeze, clocks: u32) -> FreezeRules {
        self.clocks[id as usize] = clocks;
        self
    }

    /// Whether a row applies.
    #[inline]
    #[must_use]
    pub fn applies(&self, id: Freeze) -> bool {
        self.enabled & 1 << id as u32 != 0
    }

    /// Constant part of a row in clocks, 0 when it is off.
    #[inline]
    #[must_use]
    pub fn clocks(&self, id: Freeze) -> u64 {
        if self.applies(id) { u64::from(self.clocks[id as usize]) } else { 0 }
    }
}

/// Memory behind the bus: one bank of page-mode DRAM on 64 bits. Clocks of the processor.
///
/// All values are assumed. Ranges allowed by what is known of boards of the period: see [`DRAM_RANGES`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DramTiming {
    /// Request to the first 8 bytes, row already open.
    pub first_hit: u32,
    /// Request to the first 8 bytes, row to be opened.
    pub first_miss: u32,
    /// Between successive 8 bytes of a line, and between overlapped requests to the open row.
    pub next: u32,
    /// One write of up to 8 bytes to the open row.
    pub write_hit: u32,
    /// One write, row to be opened.
    pub write_miss: u32,
    /// Bytes of a row (what the NENE# pin compares).
    pub page_bytes: u32,
    /// Clocks between refreshes, 0 for none.
    pub refresh_interval: u32,
    /// Clocks that a refresh holds the memory; it closes the row.
    pub refresh_clocks: u32,
    /// Clocks between transfers of 8 bytes of other bus masters (ring interface), 0 for none.
    pub dma_interval: u32,
    /// Clocks that such a transfer holds the memory; it closes the row.
    pub dma_clocks: u32,
}

/// A parameter of [`DramTiming`]: name, least, default, most, reason.
#[derive(Clone, Copy, Debug)]
pub struct DramRange {
    /// Field name.
    pub name: &'static str,
    /// Least value allowed.
    pub least: u32,
    /// Value of [`DramTiming::board`].
    pub default: u32,
    /// Greatest value allowed.
    pub most: u32,
    /// Where it comes from.
    pub source: &'static str,
}

const fn range(name: &'static str, least: u32, default: u32, most: u32, source: &'static str) -> DramRange {
    DramRange { name, least, default, most, source }
}

/// Allowed ranges of the memory parameters, in the order of the fields.
pub const DRAM_RANGES: [DramRange; 10] = [
    range("first_hit", 5, 8, 10, "line fill of about 14 clocks on boards of the period"),
    range("first_miss", 8, 11, 16, "line fill of about 16 to 18 clocks when the row changes"),
    range("next", 2, 2, 4, "the bus needs 2 clocks per transfer (160 MB/s at 40 MHz)"),
    range("write_hit", 2, 3, 4, "page-mode write, 2 to 3 clocks per 8 bytes"),
    range("write_miss", 6, 9, 12, "6 to 8 clocks more than in the open row"),
    range("page_bytes", 1024, 4096, 16384, "64 bits of 1M x 1 or 256K x 4 parts: 512 to 1,024 columns"),
    range("refresh_interval", 0, 625, 625, "15.6 us at 40 MHz"),
    range("refresh_clocks", 0, 8, 12, "one row cycle"),
    range("dma_interval", 0, 0, 80, "a ring channel at full rate moves 8 bytes every 4 clocks; default: ring idle"),
    range("dma_clocks", 0, 3, 6, "one page-mode write"),
];

impl DramTiming {
    /// The default board, the middle of the allowed ranges.
    #[must_use]
    pub fn board() -> DramTiming {
        DramTiming::from_values(DRAM_RANGES.map(|r| r.default))
    }

    /// From ten values in the order of the fields.
    #[must_use]
    pub fn from_values(v: [u32; 10]) -> DramTiming {
        let [first_hit, first_miss, next, write_hit, write_miss, page_bytes, ..] = v;
        let [.., refresh_interval, refresh_clocks, dma_interval, dma_clocks] = v;
        DramTiming {
            first_hit,
            first_miss,
            next,
            write_hit,
            write_miss,
            page_bytes,
            refresh_interval,
            refresh_clocks,
            dma_interval,
            dma_clocks,
        }
    }

    /// The ten values in the order of the fields.
    #[must_use]
    pub fn values(&self) -> [u32; 10] {
        let bus = [self.first_hit, self.first_miss, self.next, self.write_hit, self.write_miss];
        let [a, b, c, d, e] = bus;
        [a, b, c, d, e, self.page_bytes, self.refresh_interval, self.refresh_clocks, self.dma_interval, self.dma_clocks]
    }
}

/// What the processor is built with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// Whether clocks are counted at all; without, only instructions are.
    pub timing: bool,
    /// Freeze rules.
    pub freezes: FreezeRules,
    /// Memory.
    pub dram: DramTiming,
    /// Table of frcp and frsqr.
    pub seeds: crate::SeedTable,
    /// Start of the pseudo-random sequence of the cache replacement.
    pub replacement_seed: u16,
    /// Whether blocks that repeat with all they need in the caches take the clocks that were counted before instead of being
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
            dram: DramTiming::board(),
            seeds: crate::SeedTable::Truncated8,
            replacement_seed: 0xACE1,
            memoise: true,
        }
    }

    /// Functional model only.
    #[must_use]
    pub fn functional() -> Config {
        Config { timing: false, ..Config::cycle() }
    }
}

/// Instruction cache: bytes, line bytes, ways (published, Intel's manual).
pub const INSTRUCTION_CACHE: (u32, u32, u32) = (4096, 32, 2);
/// Data cache: bytes, line bytes, ways (published, Intel's manual).
pub const DATA_CACHE: (u32, u32, u32) = (8192, 32, 2);
/// TLB: entries, ways (64 published; 4 ways assumed).
pub const TLB: (u32, u32) = (64, 4);
/// Bytes of a page (published).
pub const PAGE_BYTES: u32 = 4096;
/// Bus requests that may be outstanding (assumed: the address pipe of the external bus).
pub const BUS_DEPTH: usize = 3;
/// Stores that wait, two inside and one on the bus (assumed).
pub const STORE_DEPTH: usize = 3;
/// Bytes per bus transfer (published).
pub const BUS_BYTES: u32 = 8;
