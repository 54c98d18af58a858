//! Tests of every row of the freeze table. A row must have its cost if it applies, and no cost one instruction later.
//!
//! A program runs twice: without any row, and with the tested row. The difference is the cost of the row. Expected
//! clocks do not come from the table under test. Each test quotes Intel's list ("the list", the instruction-timing
//! table of the i860 Programmer's Reference Manual, from memory). For a row with memory accesses, the wait is a sum of
//! DRAM parameters. `anchors.rs` compares the rows together with published counts.

use i860::timing::{DramTiming, FREEZES, Freeze, FreezeRules};
use i860::{Config, Cpu, Ram, RunEnd, assemble};
use pxpl5_sim::parameters::{ParameterTable, Value};

const CODE: u32 = 0x1000;
const DATA: u32 = 0x8000;

fn dram() -> DramTiming {
    DramTiming { refresh_interval: 0, ..DramTiming::PAPERS }
}

fn clocks_with(rules: FreezeRules, source: &str) -> u64 {
    let program = assemble("freeze.s", CODE, &format!("{source}\nend:")).unwrap_or_else(|e| panic!("{e}"));
    let mut ram = Ram::new(0, 0x20000);
    ram.load(CODE, &program.bytes).expect("fits");
    let mut cpu = Cpu::at(Config { freezes: rules, dram: dram(), ..Config::cycle() }, CODE);
    cpu.state.r[4] = DATA;
    let outcome = cpu.run(&mut ram, program.symbol("end"), 1000);
    assert_eq!(outcome, RunEnd::Stopped, "{source}");
    assert_eq!(cpu.profile().clocks(), cpu.clocks(), "every clock has a cause");
    cpu.clocks()
}

fn cost(row: Freeze, source: &str) -> u64 {
    cost_beside(FreezeRules::none(), row, source)
}

fn cost_beside(others: FreezeRules, row: Freeze, source: &str) -> u64 {
    clocks_with(others.with(row), source) - clocks_with(others, source)
}

/// A program in which the constant part of a row occurs once, with the row and the other rows that must apply.
struct Sample {
    row: Freeze,
    beside: FreezeRules,
    source: String,
}

fn sample(row: Freeze, source: impl Into<String>) -> Sample {
    Sample { row, beside: FreezeRules::none(), source: source.into() }
}

fn sample_beside(other: Freeze, row: Freeze, source: impl Into<String>) -> Sample {
    Sample { beside: FreezeRules::none().with(other), ..sample(row, source) }
}

fn samples() -> Vec<Sample> {
    let line_later = "nop\n".repeat(40);
    vec![
        sample_beside(Freeze::InstructionMiss, Freeze::InstructionMissBehindData, next_line_behind_load(1)),
        sample(Freeze::LoadMissUse, "ld.l 0(r4), r5\nadds r5, r0, r6"),
        sample(Freeze::FloatingLoadMiss, "fld.d 0(r4), f8"),
        sample(Freeze::TransferDuringMiss, "ld.l 0(r4), r5\nixfr r6, f8"),
        sample(Freeze::AccessDuringMiss, "ld.l 0(r4), r5\nld.l 4(r4), r6"),
        sample(Freeze::LoadUse, "ld.l 0(r4), r5\nadds r5, r0, r6"),
        sample(Freeze::FloatingLoadUse, "fld.d 0(r4), f8\npfadd.ss f8, f10, f12"),
        sample(Freeze::ConditionUse, "adds 1, r5, r5\nbc end"),
        sample(Freeze::MultiplierFirstSource, "pfadd.ss f8, f9, f10\npfmul.ss f10, f9, f11"),
        sample(Freeze::ScalarBusy, "fadd.ss f8, f9, f10\nfadd.ss f2, f3, f4"),
        sample(Freeze::ScalarDoubleMultiplyBusy, "fmul.dd f8, f10, f12\nfadd.dd f2, f4, f6"),
        sample_beside(Freeze::ScalarBusy, Freeze::ScalarPrecisionChange, "fadd.ss f8,f9,f10\nfadd.dd f2,f4,f6"),
        sample_beside(Freeze::ScalarBusy, Freeze::ScalarThenPipelined, "fadd.ss f8,f9,f10\npfmul.ss f2,f3,f4"),
        sample(Freeze::DoubleMultiply, "pfmul.dd f8, f10, f12\npfmul.dd f8, f10, f12"),
        sample(Freeze::TlbMiss, "adds 1, r0, r5\nst.c r5, dirbase\nld.l 0(r4), r6"),
        sample(Freeze::LoadPipeFull, "pfld.d 8(r4)++, f8\n".repeat(4)),
        sample(Freeze::PipelinedLoadHit, format!("ld.l 0(r4), r5\n{line_later}pfld.d 8(r4), f8")),
        sample(Freeze::StorePipeFull, stores(4)),
        sample(Freeze::LoadAfterStoreHit, format!("ld.l 0(r4), r5\n{line_later}st.l r5, 4(r4)\nld.l 8(r4), r6")),
        sample(Freeze::DelayedBranchNotTaken, "bc.t end\nnop"),
        sample(Freeze::BranchTaken, "bnc end\nnop"),
        sample(Freeze::CompareBranchTaken, "bte r0, r0, end\nnop"),
        sample(Freeze::IndirectBranch, "mov end, r5\nbri r5\nnop"),
        sample(Freeze::ControlStore, "st.c r0, fsr"),
        sample(Freeze::GraphicsToFloating, "fiadd.ss f8, f9, f10\npfadd.ss f10, f2, f3"),
        sample(Freeze::GraphicsToGraphics, "fiadd.ss f8, f9, f10\nfiadd.ss f10, f2, f3"),
        sample(Freeze::FlushAfterFlush, "flush 0(r4)\nflush 32(r4)"),
        sample(Freeze::StoreThenOverwrite, "fst.l f8, 0(r4)\npfadd.ss f2, f3, f8"),
        sample(Freeze::SeedUse, "frcp.ss f8, f9\nfmul.ss f9, f9, f10"),
    ]
}

/// Returns a program that executes a load and then a loop of `turns` turns with two clocks each. The program continues
/// in the next cache line.
fn next_line_behind_load(turns: u64) -> String {
    format!(".align 32\nmov {turns}, r7\nld.l 0(r4), r5\nl: adds -1, r7, r7\nbtne r0, r7, l\nnop\nnop\nnop\nnop\nnop")
}

fn stores(n: u64) -> String {
    (0..n).map(|k| format!("st.l r5, {}(r4)\n", 8 * k)).collect()
}

/// Every number of the table has its effect exactly once. With five more clocks in a row, the program of the row takes
/// five more clocks.
#[test]
fn every_freeze_row_costs_its_parameter() {
    for Sample { row, beside, source } in samples() {
        let rules = beside.with(row);
        let mut dearer = rules;
        let name = FREEZES[row as usize].clocks.name;
        let Ok(Value::Whole(clocks)) = rules.clocks.get(name) else { panic!("{name} is whole") };
        dearer.clocks.set(name, Value::Whole(clocks + 5)).expect("it is in the table");
        assert_eq!(clocks_with(dearer, &source) - clocks_with(rules, &source), 5, "{row:?}");
    }
}

/// Rows 1a and 16 of Intel's list consist only of waiting: their constant part is 0.
#[test]
fn every_freeze_row_with_a_constant_part_has_a_test_program() {
    let sampled: Vec<_> = samples().iter().map(|sample| sample.row).collect();
    let constant = FREEZES.iter().filter(|row| row.clocks.limits != (Value::Whole(0), Value::Whole(0)));
    assert_eq!(sampled, constant.map(|row| row.id).collect::<Vec<_>>());
    let waits = FREEZES.iter().filter(|row| !sampled.contains(&row.id));
    assert_eq!(waits.map(|row| row.number).collect::<Vec<_>>(), ["1a", "16"]);
}

#[test]
fn freeze_rows_and_parameters_have_the_same_order() {
    for (n, row) in FREEZES.iter().enumerate() {
        let name = row.clocks.name.replace('_', "");
        assert_eq!((row.id as usize, format!("{:?}", row.id).to_lowercase()), (n, name));
    }
}

/// Row 1 of Intel's list, I-cache miss: "clocks from ADS# to READY# of the needed word".
#[test]
fn row_1_an_instruction_miss_waits_for_the_word_needed() {
    let t = dram();
    assert_eq!(cost(Freeze::InstructionMiss, ".rept 8\nnop\n.endr"), t.first_miss);
    let second_line = t.first_miss + t.first_hit;
    assert_eq!(cost(Freeze::InstructionMiss, ".rept 9\nnop\n.endr"), second_line);
}

/// Row 1 of Intel's list: "+ remaining READY#s of the block if a jump [occurs] meanwhile".
#[test]
fn row_1_leaving_the_line_early_waits_for_the_rest_of_it() {
    let t = dram();
    let there_and_back = "br away\nnop\nback: br end\nnop\n.align 32\naway: br back\nnop";
    // br and its delay slot take two clocks while the line arrives. The last word of the line arrives 3 x next after
    // the first.
    let rest = 3 * t.next - 2;
    let second_line = t.first_hit + 3 * t.next - 2;
    assert_eq!(cost(Freeze::InstructionMiss, there_and_back), t.first_miss + rest + second_line);
}

#[test]
fn row_1_a_cached_line_costs_nothing() {
    let t = dram();
    let twice = "adds 1, r0, r8\nloop: bte r8, r9, end\nmov r8, r9\nbr loop\nnop";
    assert_eq!(cost(Freeze::InstructionMiss, twice), t.first_miss);
}

/// Row 1 of Intel's list: "+2 if D-cache busy".
#[test]
fn row_1b_an_instruction_miss_behind_a_data_fill_costs_two_more_clocks() {
    let t = dram();
    let others = FreezeRules::none().with(Freeze::InstructionMiss);
    // The data lie in another DRAM row and come after the instructions. The next line is needed after the first word of
    // the instructions, mov, ld, the turns of the loop and four nops.
    let fill = 2 * (t.first_miss + 3 * t.next);
    let turns_until_full = (fill - t.first_miss - 6).div_ceil(2);
    let row = Freeze::InstructionMissBehindData;
    assert_eq!(cost_beside(others, row, &next_line_behind_load(1)), 2);
    assert_eq!(cost_beside(others, row, &next_line_behind_load(turns_until_full - 1)), 2);
    assert_eq!(cost_beside(others, row, &next_line_behind_load(turns_until_full + 1)), 0);
}

/// Row 2 of Intel's list, use of the destination of an integer load that missed: "1 + read clocks - instructions
/// executed since the load".
#[test]
fn row_2_an_instruction_that_uses_a_missed_load_waits_for_the_loaded_word() {
    let t = dram();
    let read = t.first_miss;
    assert_eq!(cost(Freeze::LoadMissUse, "ld.l 0(r4), r5\nadds r5, r0, r6"), 1 + read);
    assert_eq!(cost(Freeze::LoadMissUse, "ld.l 0(r4), r5\nnop\nnop\nadds r5, r0, r6"), 1 + read - 2);
    let nops = "nop\n".repeat(t.first_miss as usize);
    assert_eq!(cost(Freeze::LoadMissUse, &format!("ld.l 0(r4), r5\n{nops}adds r5, r0, r6")), 1);
    assert_eq!(cost(Freeze::LoadMissUse, &format!("ld.l 0(r4), r5\n{nops}nop\nadds r5, r0, r6")), 0);
    assert_eq!(cost(Freeze::LoadMissUse, "ld.l 0(r4), r5\nadds r7, r0, r6"), 0);
}

/// Row 3 of Intel's list, fld miss: "1 + clocks ADS# to READY# (blocking)".
#[test]
fn row_3_only_a_floating_load_that_misses_the_cache_stops_the_processor() {
    let read = dram().first_miss;
    assert_eq!(cost(Freeze::FloatingLoadMiss, "fld.d 0(r4), f8"), 1 + read);
    assert_eq!(cost(Freeze::FloatingLoadMiss, "fld.d 0(r4), f8\nfld.d 24(r4), f8"), 1 + read);
}

/// Returns two instructions with this many nops between them.
fn apart(first: &str, nops: u64, next: &str) -> String {
    format!("{first}\n{}{next}", "nop\n".repeat(nops as usize))
}

fn cost_apart(row: Freeze, first: &str, nops: u64, next: &str) -> u64 {
    cost(row, &apart(first, nops, next))
}

fn pipelined_loads(n: usize) -> String {
    "pfld.d 8(r4)++, f8\n".repeat(n)
}

/// Row 4 of Intel's list, call, calli, ixfr, fxfr, ld.c, st.c while a data miss is in progress: "1 + clocks to first
/// READY#".
#[test]
fn row_4_transfers_wait_for_the_first_word_of_a_fill() {
    let read = dram().first_miss;
    for transfer in ["ixfr r6, f8", "fxfr f8, r6", "ld.c psr, r6", "st.c r0, fsr"] {
        let row = Freeze::TransferDuringMiss;
        assert_eq!(cost_apart(row, "ld.l 0(r4), r5", 0, transfer), 1 + read, "{transfer}");
        assert_eq!(cost_apart(row, "ld.l 0(r4), r5", read, transfer), 1);
        assert_eq!(cost_apart(row, "ld.l 0(r4), r5", read + 1, transfer), 0);
    }
}

/// Row 5 of Intel's list, ld, st, fld, fst, pfld while a data miss is in progress: "1 + clocks to last READY# of the
/// line".
#[test]
fn row_5_loads_and_stores_wait_until_a_line_fill_ends() {
    let t = dram();
    let line = t.first_miss + 3 * t.next;
    for access in ["ld.l 4(r4), r6", "st.l r6, 4(r4)", "fld.d 8(r4), f8", "fst.d f8, 8(r4)"] {
        let row = Freeze::AccessDuringMiss;
        assert_eq!(cost_apart(row, "ld.l 0(r4), r5", 0, access), 1 + line, "{access}");
        assert_eq!(cost_apart(row, "ld.l 0(r4), r5", line, access), 1);
        assert_eq!(cost_apart(row, "ld.l 0(r4), r5", line + 1, access), 0);
    }
}

/// Row 7 of Intel's list, destination of fld, pfld, ixfr used within the next two instructions: "2 in the 1st, 1 in the
/// 2nd".
#[test]
fn row_7_two_instructions_after_a_floating_load_wait_for_it() {
    for load in ["fld.d 0(r4), f8", "pfld.d 0(r4), f8", "ixfr r5, f8"] {
        for (gap, expected) in [(0, 2), (1, 1), (2, 0)] {
            let found = cost_apart(Freeze::FloatingLoadUse, load, gap, "pfadd.ss f8, f10, f12");
            assert_eq!(found, expected, "{load}, {gap} between");
        }
    }
    assert_eq!(cost(Freeze::FloatingLoadUse, "fld.q 0(r4), f8\npfadd.ss f11, f2, f3"), 2);
    assert_eq!(cost(Freeze::FloatingLoadUse, "fld.d 0(r4), f8\npfadd.ss f10, f2, f3"), 0);
}

/// Row 8 of Intel's list, bc, bnc right after addu, adds, subu, subs, pfeq, pfgt: "1".
#[test]
fn row_8_a_branch_waits_for_a_condition_just_set() {
    for setter in ["adds 1, r5, r5", "subu r5, r6, r7", "pfgt.ss f8, f9, f0"] {
        assert_eq!(cost(Freeze::ConditionUse, &format!("{setter}\nbc end")), 1, "{setter}");
        assert_eq!(cost(Freeze::ConditionUse, &format!("{setter}\nnop\nbc end")), 0);
    }
    assert_eq!(cost(Freeze::ConditionUse, "and 1, r5, r5\nbnc end"), 0);
    let mut rules = FreezeRules::none().with(Freeze::ConditionUse);
    rules.logicals_delay_branches = true;
    assert_eq!(clocks_with(rules, "and 1, r5, r5\nbnc end"), 3);
}

/// Row 10 of Intel's list, operation while a scalar one is in flight: "2 - instructions since".
#[test]
fn row_10_a_scalar_operation_occupies_the_floating_point_unit_for_two_more_clocks() {
    for scalar in ["fadd.ss f8, f9, f10", "fmul.ss f8, f9, f10", "famov.ss f8, f10"] {
        for next in ["fadd.ss f2, f3, f4", "fst.l f3, 0(r4)", "fiadd.ss f2, f3, f4", "pfadd.ss f2, f3, f0"] {
            for (gap, expected) in [(0, 2), (1, 1), (2, 0)] {
                let found = cost_apart(Freeze::ScalarBusy, scalar, gap, next);
                assert_eq!(found, expected, "{scalar} {next}, {gap} between");
            }
        }
    }
    assert_eq!(cost(Freeze::ScalarBusy, "frcp.ss f8, f10\nfadd.ss f2, f3, f4"), 0);
}

/// Row 10 of Intel's list: "+1 if precision changes; +1 if the new operation is pipelined with destination other than
/// f0".
#[test]
fn rows_10c_and_10d_only_lengthen_existing_waits() {
    let busy = FreezeRules::none().with(Freeze::ScalarBusy);
    for (gap, expected) in [(0, 1), (1, 1), (2, 0)] {
        let source = apart("fadd.ss f8,f9,f10", gap, "fadd.dd f2,f4,f6");
        assert_eq!(cost_beside(busy, Freeze::ScalarPrecisionChange, &source), expected, "{gap} between");
    }
    for (next, expected) in [("pfmul.ss f2,f3,f4", 1), ("pfadd.ss f2,f3,f0", 0), ("fadd.ss f2,f3,f4", 0)] {
        let source = apart("fadd.ss f8,f9,f10", 0, next);
        assert_eq!(cost_beside(busy, Freeze::ScalarThenPipelined, &source), expected, "{next}");
    }
}

/// Row 12 of Intel's list, TLB miss: "5 + two reads".
#[test]
fn row_12_a_tlb_miss_costs_five_clocks_and_the_time_of_two_reads() {
    let t = dram();
    let translation_on = "adds 1, r0, r5\nst.c r5, dirbase\n";
    let reads = t.first_miss + t.first_miss;
    for n_loads in [1, 3] {
        let source = format!("{translation_on}{}", "ld.l 0(r4), r6\n".repeat(n_loads));
        assert_eq!(cost(Freeze::TlbMiss, &source), 5 + reads, "{n_loads} loads");
    }
    assert_eq!(cost(Freeze::TlbMiss, "ld.l 0(r4), r6"), 0, "translation is off");
}

/// Row 13 of Intel's list, pfld with three outstanding: "1 + clocks until first returns".
#[test]
fn row_13_the_fourth_pipelined_load_waits_for_the_data_of_the_first_load() {
    let t = dram();
    assert_eq!(cost(Freeze::LoadPipeFull, &pipelined_loads(3)), 0);
    // The first load was requested after one clock. The fourth load is issued at clock 4 and then waits.
    assert_eq!(cost(Freeze::LoadPipeFull, &pipelined_loads(4)), t.first_miss + 1 - 4 + 1);
    let late = format!("{}{}{}", pipelined_loads(3), "nop\n".repeat(t.first_miss as usize - 3), pipelined_loads(1));
    assert_eq!(cost(Freeze::LoadPipeFull, &late), 0);
}

/// Row 14 of Intel's list, pfld that hits the data cache: "2 + clocks to finish all outstanding bus cycles".
#[test]
fn row_14_a_pipelined_load_that_hits_the_cache_waits_until_two_clocks_after_the_last_bus_cycle() {
    let t = dram();
    let line = t.first_miss + 3 * t.next;
    let row = Freeze::PipelinedLoadHit;
    assert_eq!(cost_apart(row, "ld.l 0(r4), r5", line + 10, "pfld.d 8(r4), f8"), 2);
    // The line ends `line` clocks after the issue of the load. One of these clocks is the issue of this instruction.
    assert_eq!(cost_apart(row, "ld.l 0(r4), r5", 0, "pfld.d 8(r4), f8"), line - 1 + 2);
}

/// Row 15 of Intel's list, store pipe full (2 internal and the bus) and a store misses: "1 + clocks to READY# of next
/// write".
#[test]
fn row_15_the_fourth_store_waits_until_the_first_store_is_written() {
    let t = dram();
    assert_eq!(cost(Freeze::StorePipeFull, &stores(3)), 0);
    // The first store is requested at clock 1 and ends at 1 + write_miss. The fourth store is issued at clock 4.
    assert_eq!(cost(Freeze::StorePipeFull, &stores(4)), t.write_miss + 1 - 4 + 1);
}

/// Row 16 of Intel's list, address pipe full: "until next address can issue".
#[test]
fn row_16_a_fourth_bus_request_waits_until_the_first_request_ends() {
    let t = dram();
    // Without row 13, pipelined loads use only the address pipe. The requests are at clocks 1, 2, 3 and then 4.
    assert_eq!(cost(Freeze::AddressPipeFull, &pipelined_loads(3)), 0);
    assert_eq!(cost(Freeze::AddressPipeFull, &pipelined_loads(4)), 1 + t.first_miss - 4);
}

/// Rows of a constant number of clocks, each with the words of Intel's list, programs with this cost, and neighbouring
/// programs without it.
#[test]
fn rows_of_constant_clocks_cost_them_only_where_the_list_says() {
    let hit = apart("ld.l 0(r4), r5", 30, "st.l r5, 4(r4)");
    for (row, source, clocks) in [
        // Row 6, destination of ld, ld.c, call, calli, fxfr used by the next instruction: "1".
        (Freeze::LoadUse, "ld.l 0(r4), r5\nadds r5, r0, r6", 1),
        (Freeze::LoadUse, "ld.c psr, r5\nadds r5, r0, r6", 1),
        (Freeze::LoadUse, "fxfr f8, r5\nadds r5, r0, r6", 1),
        (Freeze::LoadUse, "call f\nadds r1, r0, r6\nf: nop\nnop", 1),
        (Freeze::LoadUse, "ld.l 0(r4), r5\nnop\nadds r5, r0, r6", 0),
        (Freeze::LoadUse, "ld.l 0(r4), r5\nadds r7, r0, r6", 0),
        // Row 9, multiplier operation whose fsrc1 is the result of the operation before: "1". The second source does
        // not wait, and r2p1 sends the first one to the adder.
        (Freeze::MultiplierFirstSource, "pfadd.ss f8, f9, f10\npfmul.ss f10, f9, f11", 1),
        (Freeze::MultiplierFirstSource, "pfadd.ss f8, f9, f10\npfmul.ss f9, f10, f11", 0),
        (Freeze::MultiplierFirstSource, "pfadd.ss f8, f9, f10\nnop\npfmul.ss f10, f9, f11", 0),
        (Freeze::MultiplierFirstSource, "pfadd.ss f8, f9, f10\nm12apm.ss f10, f9, f11", 1),
        (Freeze::MultiplierFirstSource, "pfadd.ss f8, f9, f10\nr2p1.ss f10, f9, f11", 0),
        // Row 10: "fmul.dd 3 - instructions since".
        (Freeze::ScalarDoubleMultiplyBusy, "fmul.dd f8, f10, f12\nfadd.dd f2, f4, f6", 3),
        (Freeze::ScalarDoubleMultiplyBusy, "fmul.dd f8, f10, f12\nnop\nnop\nfadd.dd f2, f4, f6", 1),
        (Freeze::ScalarDoubleMultiplyBusy, "fmul.dd f8, f10, f12\nnop\nnop\nnop\nfadd.dd f2, f4, f6", 0),
        // Row 11, multiplier operation after a double-precision multiply: "1". The 60 MFLOPS in double precision at 40
        // MHz in the data sheet mean one multiplication every second clock and one addition every clock.
        (Freeze::DoubleMultiply, "pfmul.dd f8, f10, f12\npfmul.dd f8, f10, f12", 1),
        (Freeze::DoubleMultiply, "pfmul.dd f8, f10, f12\npfadd.dd f8, f10, f12\npfmul.dd f8, f10, f12", 0),
        (Freeze::DoubleMultiply, "pfmul.dd f8, f10, f12\npfadd.dd f8, f10, f12", 0),
        (Freeze::DoubleMultiply, "pfmul.ss f8, f10, f12\npfmul.ss f8, f10, f12", 0),
        // Row 17, ld or fld right after a store that hit: "1". The last store missed.
        (Freeze::LoadAfterStoreHit, &apart(&hit, 0, "ld.l 8(r4), r6"), 1),
        (Freeze::LoadAfterStoreHit, &apart(&hit, 1, "ld.l 8(r4), r6"), 0),
        (Freeze::LoadAfterStoreHit, "st.l r5, 4(r4)\nld.l 8(r4), r6", 0),
        // Row 18, delayed conditional branch not taken: "1". A taken branch takes only the clock of its delay slot. For
        // example, the loop of a tree code of the period takes 106 clocks with such a branch (anchors.rs). The first
        // bla finds LCC clear, and the branch at `a` finds it set.
        (Freeze::DelayedBranchNotTaken, "bc.t end\nnop", 1),
        (Freeze::DelayedBranchNotTaken, "bnc.t end\nnop", 0),
        (Freeze::DelayedBranchNotTaken, "adds -1, r0, r5\nmov 9, r6\nbla r5, r6, end\nnop", 1),
        (Freeze::DelayedBranchNotTaken, "adds -1, r0, r5\nmov 9, r6\nbla r5, r6, a\nnop\na: bla r5, r6, end\nnop", 1),
        // Row 19, branch without slot taken: "1 bc, bnc; 2 bte, btne".
        (Freeze::BranchTaken, "bnc end\nnop", 1),
        (Freeze::BranchTaken, "bc end\nnop", 0),
        (Freeze::CompareBranchTaken, "bte r0, r0, end\nnop", 2),
        (Freeze::CompareBranchTaken, "btne r0, r0, end\nnop", 0),
        // Row 20, bri, calli: "1".
        (Freeze::IndirectBranch, "mov end, r5\nbri r5\nnop", 1),
        (Freeze::IndirectBranch, "mov end, r5\ncalli r5\nnop", 1),
        (Freeze::IndirectBranch, "br end\nnop", 0),
        // Row 21, st.c: "2".
        (Freeze::ControlStore, "st.c r0, fsr\nld.c fsr, r5", 2),
        (Freeze::ControlStore, "ld.c fsr, r5", 0),
        // Row 22, graphics result used by the next adder or multiplier operation: "1"; by the next graphics operation:
        // "1".
        (Freeze::GraphicsToFloating, "fiadd.ss f8, f9, f10\npfadd.ss f10, f2, f3", 1),
        (Freeze::GraphicsToFloating, "fiadd.ss f8, f9, f10\nnop\npfadd.ss f10, f2, f3", 0),
        (Freeze::GraphicsToFloating, "fiadd.ss f8, f9, f10\npfadd.ss f12, f2, f3", 0),
        (Freeze::GraphicsToGraphics, "fiadd.ss f8, f9, f10\nfiadd.ss f10, f2, f3", 1),
        (Freeze::GraphicsToGraphics, "fiadd.ss f8, f9, f10\npfadd.ss f10, f2, f3", 0),
        // Row 23, flush after flush: "2 - instructions between".
        (Freeze::FlushAfterFlush, "flush 0(r4)\nflush 32(r4)", 2),
        (Freeze::FlushAfterFlush, "flush 0(r4)\nnop\nflush 32(r4)", 1),
        (Freeze::FlushAfterFlush, "flush 0(r4)\nnop\nnop\nflush 32(r4)", 0),
        // Row 24, fst, pst, then a pipelined operation that overwrites the stored register: "1".
        (Freeze::StoreThenOverwrite, "fst.l f8, 0(r4)\npfadd.ss f2, f3, f8", 1),
        (Freeze::StoreThenOverwrite, "fst.l f8, 0(r4)\nnop\npfadd.ss f2, f3, f8", 0),
        (Freeze::StoreThenOverwrite, "fst.l f8, 0(r4)\npfadd.ss f2, f3, f9", 0),
        (Freeze::StoreThenOverwrite, "fst.l f8, 0(r4)\nfadd.ss f2, f3, f8", 0),
        // Intel's list has no row 25, because its row 10 does not include frcp and frsqr. A published code for three
        // reciprocal roots in 39 clocks is possible if the result can be used two instructions later.
        (Freeze::SeedUse, "frcp.ss f8, f9\nfmul.ss f9, f9, f10", 1),
        (Freeze::SeedUse, "frcp.ss f8, f9\nnop\nfmul.ss f9, f9, f10", 0),
    ] {
        assert_eq!(cost(row, source), clocks, "{row:?}: {source}");
    }
}

#[test]
fn simultaneous_freezes_cost_the_longest() {
    let source = "fadd.ss f8, f9, f10\nfld.l 0(r4), f2\nfadd.ss f2, f10, f11";
    let scalar = Freeze::ScalarBusy;
    let load = Freeze::FloatingLoadUse;
    assert_eq!((cost(scalar, source), cost(load, source)), (1, 2));
    let both = FreezeRules::none().with(scalar).with(load);
    assert_eq!(clocks_with(both, source) - clocks_with(FreezeRules::none(), source), 2);
}

/// Returns a pair of instructions right after an instruction that loads f8.
fn pair_behind_a_transfer(low: &str, high: &str) -> String {
    format!("d.fnop\nnop\nd.fnop\nixfr r5, f8\nd.{low}\n{high}\nfnop\nnop\nfnop\nnop")
}

#[test]
fn both_halves_of_a_pair_wait_together_for_the_longer_freeze() {
    let plain = pair_behind_a_transfer("pfadd.ss f0, f0, f0", "ld.l 0(r4), r6");
    let waiting = pair_behind_a_transfer("pfadd.ss f8, f0, f0", "ld.l 0(r4), r6");
    // Two single instructions take two clocks, and each of four pairs takes one clock. The pairs begin after the end of
    // the first word.
    assert_eq!(clocks_with(FreezeRules::none(), &plain), 2 + 4);
    let row = FreezeRules::none().with(Freeze::FloatingLoadUse);
    assert_eq!(clocks_with(row, &plain), 2 + 4);
    assert_eq!(clocks_with(row, &waiting), 2 + 4 + 2);
}

#[test]
fn a_disabled_freeze_row_costs_nothing() {
    let all_but = FreezeRules::all().without(Freeze::ConditionUse);
    // The branch is after the last word of the line. Before the last word, row 1 would make the freeze longer
    // (fills.rs).
    let source = format!("{}adds 1, r5, r5\nbc end", "nop\n".repeat(6));
    assert_eq!(clocks_with(FreezeRules::all(), &source) - clocks_with(all_but, &source), 1);
}
