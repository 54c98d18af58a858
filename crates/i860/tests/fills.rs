//! Tests of a busy memory: fills of instruction lines during freezes, stores and reads of other rows, loads of 16
//! bytes, and the address pipe. Each program is short enough to count its clocks by hand. The comments have these
//! counts.
//!
//! Memory of the tests: the first 8 bytes take 11 clocks if a row is opened, and 8 clocks in the open row. Each further
//! 8 bytes take 2 clocks. A write takes 9 or 3 clocks. The words of a line of 8 instructions that is requested at clock
//! 0 arrive in pairs at 11, 13, 15 and 17.

use i860::timing::{DramTiming, Freeze, FreezeRules};
use i860::{Config, Cpu, Ram, RunEnd, assemble};

const CODE: u32 = 0x1000;
/// Address in another DRAM row than the code.
const DATA: u32 = 0x8000;

fn dram() -> DramTiming {
    DramTiming {
        first_hit: 8,
        first_miss: 11,
        next: 2,
        write_hit: 3,
        write_miss: 9,
        page_bytes: 4096,
        refresh_interval: 0,
        dma_interval: 0,
        ..DramTiming::PAPERS
    }
}

fn clocks(rows: &[Freeze], source: &str) -> u64 {
    let program = assemble("fills.s", CODE, &format!("{source}\nend:")).unwrap_or_else(|e| panic!("{e}"));
    let freezes = rows.iter().fold(FreezeRules::none(), |rules, row| rules.with(*row));
    let mut ram = Ram::new(0, 0x20000);
    ram.load(CODE, &program.bytes).expect("fits");
    let mut cpu = Cpu::at(Config { freezes, dram: dram(), ..Config::cycle() }, CODE);
    cpu.state.r[4] = DATA;
    assert_eq!(cpu.run(&mut ram, program.symbol("end"), 1000), RunEnd::Stopped, "{source}");
    assert_eq!(cpu.profile().clocks(), cpu.clocks(), "every clock has a cause");
    cpu.clocks()
}

/// Intel's list, row 1: "+ remaining READY#s of the block if a jump or another freeze occurs meanwhile".
#[test]
fn row_1_a_second_freeze_during_a_line_fill_lasts_until_the_end_of_the_fill() {
    let source = "adds 1, r5, r5\nbc end\nnop\nnop\nnop\nnop\nnop\nnop";
    // The first word arrives at clock 11, and adds ends at 12. bc would wait until 13, so it waits for the line until
    // 17 and ends at 18. Six more instructions end at 24.
    assert_eq!(clocks(&[Freeze::InstructionMiss, Freeze::ConditionUse], source), 24);
    // Without the freeze, adds ends at 12 and bc at 13. The words that arrive at 13, 15 and 17 end at 15, 17 and 19.
    assert_eq!(clocks(&[Freeze::InstructionMiss], source), 19);
    // After the line's last word, the freeze has its normal length. Six nops end at 17, and adds ends at 18. bc waits
    // until 19 and ends at 20.
    let late = "nop\nnop\nnop\nnop\nnop\nnop\nadds 1, r5, r5\nbc end";
    assert_eq!(clocks(&[Freeze::InstructionMiss, Freeze::ConditionUse], late), 20);
}

/// The constant part of a freeze row at the end of an instruction also waits for the rest of the line.
#[test]
fn row_1_a_branch_within_a_line_being_filled_waits_for_the_rest_of_the_line() {
    let source = "bnc on\nnop\nnop\non: nop\nnop\nnop\nnop\nnop";
    // The first word arrives at clock 11, bnc ends at 12, and the taken branch at 13 waits until 17. Five nops follow.
    assert_eq!(clocks(&[Freeze::InstructionMiss, Freeze::BranchTaken], source), 22);
}

/// The data of a read occupy the bus up to the last transfer, so a write follows after these data.
#[test]
fn a_store_waits_for_the_last_word_of_a_fill() {
    let source = "st.l r5, 0(r4)\nst.l r5, 8(r4)\nst.l r5, 16(r4)\nst.l r5, 24(r4)\nnop\nnop\nnop\nnop";
    // The first store is requested at clock 12 and begins after the line, at 17. The first store opens a row and ends
    // at 26. The fourth store is issued at 15. It waits until one clock after the first store has left the pipe, at 27.
    // Four nops follow.
    assert_eq!(clocks(&[Freeze::InstructionMiss, Freeze::StorePipeFull], source), 31);
}

/// A row cannot be closed while its data are still being read.
#[test]
fn a_read_of_another_row_waits_for_the_last_word_of_a_fill() {
    let source = "ld.l 0(r4), r5\nadds r5, r0, r6\nnop\nnop\nnop\nnop\nnop\nnop";
    // The load is requested at clock 12, begins at 17, and its data arrive at 28. The next instruction waits one more
    // clock, until 29, and ends at 30. Six nops follow.
    assert_eq!(clocks(&[Freeze::InstructionMiss, Freeze::LoadMissUse], source), 36);
}

/// Intel's list, row 3: the instruction waits for the data. A bus of 64 bits needs two transfers for 16 bytes.
#[test]
fn row_3_a_miss_of_16_bytes_waits_for_both_transfers() {
    // The load is issued at clock 1. The first 8 bytes arrive at 12 and the next at 14. Intel's list adds one clock.
    assert_eq!(clocks(&[Freeze::FloatingLoadMiss], "fld.q 0(r4), f8"), 15);
    assert_eq!(clocks(&[Freeze::FloatingLoadMiss], "fld.d 0(r4), f8"), 13);
}

/// Intel's list, row 16, address pipe full: "until next address can issue", for any instruction that issues an address.
#[test]
fn row_16_a_store_waits_while_the_address_pipe_has_three_requests() {
    let source = "pfld.d 8(r4)++, f8\npfld.d 8(r4)++, f8\npfld.d 8(r4)++, f8\nst.l r5, 0(r4)";
    // The requests are at clocks 1, 2 and 3, and the data of the first arrive at 12. The store is issued at 4.
    assert_eq!(clocks(&[Freeze::AddressPipeFull], source), 12);
}

#[test]
fn row_16_an_instruction_fill_waits_while_the_address_pipe_has_three_requests() {
    let loads = "pfld.d 8(r7)++, f8\n".repeat(3);
    let source = format!("mov 0x1800, r7\nnop\nnop\nnop\nnop\n{loads}nop");
    // mov and the nops end at clock 16. The loads of the open row are requested at 17, 18 and 19, and their data arrive
    // at 25, 27 and 29. The next line is needed at 19. Without the freeze row, its first word follows these data on the
    // bus, at 31. With the freeze row, the line is requested at 25 and arrives at 33.
    assert_eq!(clocks(&[Freeze::InstructionMiss], &source), 32);
    assert_eq!(clocks(&[Freeze::InstructionMiss, Freeze::AddressPipeFull], &source), 34);
}

/// Pushes 1 + 2 into the adder's pipe, executes an operation, then reads the sum from the pipe.
fn sum_behind(operation: &str) -> f32 {
    let source = format!(
        "orh 0x3F80, r0, r5\nixfr r5, f2\norh 0x4000, r0, r5\nixfr r5, f3\n\
         pfadd.ss f2, f3, f0\npfmul.ss f2, f3, f0\nl: {operation}\nm: pfadd.ss f0, f0, f0\npfadd.ss f0, f0, f0\n\
         pfadd.ss f0, f0, f10\nend:"
    );
    let program = assemble("pipes.s", CODE, &source).unwrap_or_else(|e| panic!("{e}"));
    let mut ram = Ram::new(0, 0x20000);
    ram.load(CODE, &program.bytes).expect("fits");
    let mut cpu = Cpu::at(Config::cycle(), CODE);
    assert_eq!(cpu.run(&mut ram, program.symbol("end"), 1000), RunEnd::Stopped);
    f32::from_bits(cpu.state.f[10])
}

/// According to the manual, a scalar operation uses the pipe of its unit and destroys the results in the pipe.
#[test]
fn a_scalar_operation_clears_the_pipe_of_its_unit() {
    for keeps in ["nop", "fmul.ss f2, f3, f4", "frcp.ss f2, f4", "fiadd.ss f2, f3, f4"] {
        assert_eq!(sum_behind(keeps).to_bits(), 3f32.to_bits(), "{keeps}");
    }
    for destroys in ["fadd.ss f2, f3, f4", "fsub.ss f2, f3, f4", "famov.ss f2, f4", "fix.sd f2, f4"] {
        assert!(sum_behind(destroys).is_nan(), "{destroys}");
    }
}
