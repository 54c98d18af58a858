//! Freezes: hazards that stop the issue of instructions, their rules, and their delays in clocks.

use pxpl5_sim::parameters::{ParameterInfo, ParameterTable};

/// One row of the freeze table [`FREEZES`]: a condition that stops the issue of instructions, and its delay.
#[derive(Clone, Copy, Debug)]
pub struct FreezeRow {
    pub id: Freeze,
    /// Number of the row in Intel's list of instruction timings, as the authors remember the list. A letter follows if
    /// the row of Intel's list has several delays.
    pub number: &'static str,
    /// Description of the condition that stops the issue of instructions.
    pub condition: &'static str,
    /// Description of the variable part of the delay, which is added to the constant part or subtracted from it.
    pub variable: &'static str,
    /// Description of the constant part of the delay: value, range and source. The value itself is in the field of
    /// [`FreezeClocks`] with the same position.
    pub clocks: &'static ParameterInfo,
}

pxpl5_sim::parameters::parameter_table! {
    /// The constant part of the delay of each row of [`FREEZES`], in the same order. Intel's list is quoted as the
    /// authors remember it, so a value that no published figure narrows has a range of one clock less to one clock
    /// more.
    pub struct FreezeClocks {
        /// Delay by row 1a of the freeze table: a miss of the instruction cache.
        instruction_miss: 0, "clocks", Assumed, 0..=0, "Intel's list, recollected: the wait is all";
        /// Delay by row 1b of the freeze table: instruction-cache miss while a cache-line fill of the data cache is
        /// running.
        instruction_miss_behind_data: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 2 of the freeze table: an instruction uses the destination of an integer load that missed the
        /// data cache.
        load_miss_use: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 3 of the freeze table: an fld misses the data cache.
        floating_load_miss: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 4 of the freeze table: call, calli, ixfr, fxfr, ld.c or st.c while a cache-line fill of the
        /// data cache is running.
        transfer_during_miss: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 5 of the freeze table: load, store or pfld while a cache-line fill of the data cache is
        /// running.
        access_during_miss: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 6 of the freeze table: an instruction uses the destination of the previous instruction, which
        /// is ld, ld.c, call, calli or fxfr.
        load_use: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 7 of the freeze table: one of the next two instructions uses the destination of an fld, pfld or
        /// ixfr.
        floating_load_use: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected; period matrix code issues an extra operation because loads need time";
        /// Delay by row 8 of the freeze table: bc, bnc, bc.t or bnc.t right after addu, adds, subu, subs or a compare.
        condition_use: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 9 of the freeze table: a multiplier operation has the result of the previous operation as its
        /// first source.
        multiplier_first_source: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 10a of the freeze table: a floating-point operation or fst is issued before the end of a scalar
        /// fadd, fsub, fix, ftrunc, famov, fmlow, fmul.ss or fmul.sd.
        scalar_busy: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected; a measured square root of 48.4 clocks needs it";
        /// Delay by row 10b of the freeze table: a floating-point operation or fst is issued before the end of a scalar
        /// fmul.dd.
        scalar_double_multiply_busy: 3, "clocks", Assumed, 2..=4 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 10c of the freeze table, in addition to row 10a or 10b: the new operation has another
        /// precision.
        scalar_precision_change: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 10d of the freeze table, in addition to row 10a or 10b: the new operation is pipelined and has
        /// a destination.
        scalar_then_pipelined: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 11 of the freeze table: a multiplier operation right after a double-precision multiply.
        double_multiply: 1, "clocks", Assumed, 1..=1 in 0..=1_000_000, "Intel's list, recollected; the published peak of 60 MFLOPS double at 40 MHz needs it";
        /// Delay by row 12 of the freeze table: TLB miss. This row applies only while address translation is on.
        tlb_miss: 5, "clocks", Assumed, 4..=6 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 13 of the freeze table: a pfld is issued while three earlier pfld are outstanding.
        load_pipe_full: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 14 of the freeze table: a pfld hits the data cache.
        pipelined_load_hit: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 15 of the freeze table: a store misses while three stores wait or a write-back is pending.
        store_pipe_full: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 16 of the freeze table: a bus request is issued while three requests are outstanding.
        address_pipe_full: 0, "clocks", Assumed, 0..=0, "Intel's list, recollected: the wait is all";
        /// Delay by row 17 of the freeze table: ld or fld right after a store that hit the data cache.
        load_after_store_hit: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 18 of the freeze table: a bc.t, bnc.t or bla is not taken.
        delayed_branch_not_taken: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected; a taken bnc.t costs no more than its slot in period code";
        /// Delay by row 19a of the freeze table: a bc or bnc is taken.
        branch_taken: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 19b of the freeze table: a bte or btne is taken.
        compare_branch_taken: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 20 of the freeze table: a bri or calli is executed.
        indirect_branch: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 21 of the freeze table: an st.c to any control register is executed.
        control_store: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 22a of the freeze table: the next adder or multiplier operation uses a result of the graphics
        /// unit.
        graphics_to_floating: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 22b of the freeze table: the next graphics operation uses a result of the graphics unit (except
        /// by fmov.dd).
        graphics_to_graphics: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 23 of the freeze table: a flush right after another flush.
        flush_after_flush: 2, "clocks", Assumed, 1..=3 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 24 of the freeze table: a pipelined operation overwrites the register that the previous
        /// instruction, fst or pst, stores.
        store_then_overwrite: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list, recollected";
        /// Delay by row 25 of the freeze table: an instruction uses the result of the previous instruction, which is
        /// frcp or frsqr.
        seed_use: 1, "clocks", Assumed, 0..=2 in 0..=1_000_000, "Intel's list leaves the seeds out of row 10; a three-way root of 39 clocks allows 0 to 2";
    }
}

macro_rules! freezes {
    ($($id:ident $number:literal $condition:literal $variable:literal;)*) => {
        /// A hazard that stops the issue of instructions. The variants have the order of [`FREEZES`].
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(u8)]
        #[non_exhaustive]
        pub enum Freeze {
            $(#[doc = concat!("Row ", $number, ": ", $condition, ".")] $id,)*
        }

        pub const N_FREEZES: usize = [$($number),*].len();

        /// The freeze rules. Of several simultaneous freezes, only the longest counts. The clocks of cache misses are
        /// added.
        ///
        /// In the texts, "since" counts clocks. If an instruction in between was frozen, the wait is shorter by the
        /// clocks of this freeze.
        pub const FREEZES: [FreezeRow; N_FREEZES] = [$(FreezeRow {
            id: Freeze::$id,
            number: $number,
            condition: $condition,
            variable: $variable,
            clocks: &FreezeClocks::INFOS[Freeze::$id as usize],
        },)*];
    };
}

freezes! {
    InstructionMiss "1a" "instruction-cache miss" "+ clocks from the request to the needed 8 bytes; later words of the line as they arrive; leaving the line waits for all of it";
    InstructionMissBehindData "1b" "instruction-cache miss while a data-cache fill runs" "";
    LoadMissUse "2" "use of an integer-load destination that missed" "+ read clocks - clocks since the load";
    FloatingLoadMiss "3" "fld miss" "+ clocks from the request to the needed 8 bytes";
    TransferDuringMiss "4" "call, calli, ixfr, fxfr, ld.c, st.c while a data-cache fill runs" "+ clocks to the needed 8 bytes";
    AccessDuringMiss "5" "load, store or pfld while a data-cache fill runs" "+ clocks to the end of the line";
    LoadUse "6" "destination of ld, ld.c, call, calli, fxfr used by the next instruction" "- clocks since";
    FloatingLoadUse "7" "destination of fld, pfld, ixfr used within two instructions" "- clocks since";
    ConditionUse "8" "bc, bnc, bc.t, bnc.t right after addu, adds, subu, subs or a compare" "";
    MultiplierFirstSource "9" "multiplier operation whose first source is the result of the operation before" "";
    ScalarBusy "10a" "floating-point operation or fst while a scalar fadd, fsub, fix, ftrunc, famov, fmlow, fmul.ss or fmul.sd is in flight" "- clocks since";
    ScalarDoubleMultiplyBusy "10b" "the same behind a scalar fmul.dd" "- clocks since";
    ScalarPrecisionChange "10c" "added to 10a or 10b when the precision changes" "";
    ScalarThenPipelined "10d" "added to 10a or 10b when the new operation is pipelined and has a destination" "";
    DoubleMultiply "11" "multiplier operation right after a double-precision multiply" "";
    TlbMiss "12" "TLB miss (translation on)" "+ two reads of the page tables";
    LoadPipeFull "13" "pfld with three outstanding" "+ clocks until the first returns";
    PipelinedLoadHit "14" "pfld that hits the data cache" "+ clocks to finish all bus cycles";
    StorePipeFull "15" "store miss with three stores waiting, or with a write-back pending" "+ clocks to the end of the next write";
    AddressPipeFull "16" "bus request with three outstanding" "+ clocks until the first ends";
    LoadAfterStoreHit "17" "ld or fld right after a store that hit" "";
    DelayedBranchNotTaken "18" "bc.t, bnc.t or bla not taken" "";
    BranchTaken "19a" "bc or bnc taken" "";
    CompareBranchTaken "19b" "bte or btne taken" "";
    IndirectBranch "20" "bri, calli" "";
    ControlStore "21" "st.c" "";
    GraphicsToFloating "22a" "graphics result used by the next adder or multiplier operation" "";
    GraphicsToGraphics "22b" "graphics result used by the next graphics operation (not fmov.dd)" "";
    FlushAfterFlush "23" "flush after flush" "- clocks since";
    StoreThenOverwrite "24" "fst or pst, then a pipelined operation that overwrites the stored register" "";
    SeedUse "25" "result of frcp or frsqr used by the next instruction" "";
}

/// The enabled rows of the freeze table, and the constant parts of the delays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FreezeRules {
    enabled: u32,
    /// Constant parts of the delays in all rows of the freeze table, including disabled rows.
    pub clocks: FreezeClocks,
    /// If true, row 8 of the freeze table also applies after and, andnot, or and xor. Row 8 delays a conditional branch
    /// after an operation that sets CC. Intel's list does not decide this question. The default is false.
    pub logicals_delay_branches: bool,
}

impl FreezeRules {
    /// Returns rules with all rows of the freeze table [`FREEZES`] enabled.
    pub fn all() -> FreezeRules {
        let enabled = (1 << N_FREEZES) - 1;
        FreezeRules { enabled, clocks: FreezeClocks::PAPERS, logicals_delay_branches: false }
    }

    /// Returns rules with all rows of the freeze table disabled: each instruction or pair takes one clock.
    pub fn none() -> FreezeRules {
        FreezeRules { enabled: 0, ..FreezeRules::all() }
    }

    /// Returns a copy of the rules in which row `id` of the freeze table is disabled.
    pub fn without(mut self, id: Freeze) -> FreezeRules {
        self.enabled &= !(1 << id as u32);
        self
    }

    /// Returns a copy of the rules in which row `id` of the freeze table is enabled.
    pub fn with(mut self, id: Freeze) -> FreezeRules {
        self.enabled |= 1 << id as u32;
        self
    }

    /// Returns a text with the numbers of the enabled rows of the freeze table, in order. The text also states if row 8
    /// applies after logical operations.
    pub(crate) fn names(&self) -> String {
        let applying = FREEZES.iter().filter(|row| self.applies(row.id)).map(|row| row.number);
        let logicals = self.logicals_delay_branches.then_some("logicals delay branches");
        applying.chain(logicals).collect::<Vec<_>>().join(" ")
    }

    pub fn applies(&self, id: Freeze) -> bool {
        self.enabled & 1 << id as u32 != 0
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Costs {
    enabled: u32,
    /// Constant part of the delay in each row, in clocks, or 0 if the row is disabled.
    clocks: [u64; N_FREEZES],
    pub(crate) logicals_delay_branches: bool,
}

impl Costs {
    pub(crate) fn new(rules: &FreezeRules) -> Costs {
        let mut clocks = [0; N_FREEZES];
        for (row, entry) in FREEZES.iter().zip(rules.clocks.entries()) {
            if rules.applies(row.id) {
                clocks[row.id as usize] = entry.value.whole().unwrap_or_default();
            }
        }
        Costs { enabled: rules.enabled, clocks, logicals_delay_branches: rules.logicals_delay_branches }
    }

    #[inline]
    pub(crate) fn applies(&self, id: Freeze) -> bool {
        self.enabled & 1 << id as u32 != 0
    }

    /// Returns the constant part of the delay in row `id` of the freeze table, in clocks, or 0 if the row is disabled.
    #[inline]
    pub(crate) fn clocks(&self, id: Freeze) -> u64 {
        self.clocks[id as usize]
    }
}
