//! Tests that no input of a user makes the processor panic or run without end.

use i860::state::{TRAP_VECTOR, psr};
use i860::{Config, Cpu, Ram, RunEnd, TrapCause, assemble};
use proptest::prelude::*;

fn run_words(words: &[u32], registers: &[u32; 8], budget: u64) -> (Cpu, RunEnd) {
    let mut ram = Ram::new(0, 0x10000);
    ram.load_words(0x1000, words).expect("fits");
    let mut cpu = Cpu::at(Config::cycle(), 0x1000);
    for (n, value) in registers.iter().enumerate() {
        cpu.state.r[n + 1] = *value;
        cpu.state.f[n + 2] = *value;
    }
    let outcome = cpu.run(&mut ram, None, budget);
    (cpu, outcome)
}

/// Random words. Major opcodes and floating-point codes are equally likely, so most words are instructions.
fn likely_word() -> impl Strategy<Value = u32> {
    let core = (0u32..64, 0u32..0x0400_0000).prop_map(|(op, low)| op << 26 | low);
    let floating = (0u32..2048, 0u32..0x8000).prop_map(|(low, high)| 0x12 << 26 | (high << 11 & 0x03FF_F800) | low);
    prop_oneof![core, floating]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_words_end_with_a_trap_or_at_the_budget(
        words in prop::collection::vec(likely_word(), 1..40),
        registers: [u32; 8],
    ) {
        let (cpu, outcome) = run_words(&words, &registers, 500);
        prop_assert!(matches!(outcome, RunEnd::Trapped(_) | RunEnd::Exhausted));
        prop_assert!(cpu.instructions() <= 503, "{}", cpu.instructions());
        prop_assert_eq!(cpu.profile().clocks(), cpu.clocks());
        prop_assert_eq!((cpu.state.r[0], cpu.state.f[0], cpu.state.f[1]), (0, 0, 0));
    }

    #[test]
    fn timing_never_changes_the_results_of_a_program(
        words in prop::collection::vec(likely_word(), 1..40),
        registers: [u32; 8],
    ) {
        let (timed, outcome) = run_words(&words, &registers, 300);
        let mut ram = Ram::new(0, 0x10000);
        ram.load_words(0x1000, &words).expect("fits");
        let mut plain = Cpu::at(Config::functional(), 0x1000);
        plain.state.r[1..9].copy_from_slice(&registers);
        plain.state.f[2..10].copy_from_slice(&registers);
        prop_assert_eq!(plain.run(&mut ram, None, 300), outcome);
        prop_assert_eq!(plain.state, timed.state);
    }
}

#[track_caller]
fn trap_of(source: &str) -> (Cpu, TrapCause, u32) {
    let program = assemble("t.s", 0x1000, source).unwrap_or_else(|e| panic!("{e}"));
    let (cpu, outcome) = run_words(&program.words(), &[0x8000, 3, 0, 0, 0, 0, 0, 0], 100);
    let RunEnd::Trapped(trap) = outcome else { panic!("{outcome:?}") };
    assert_eq!((cpu.state.pc, cpu.state.fir), (TRAP_VECTOR, trap.pc));
    (cpu, trap.cause, trap.pc)
}

#[test]
fn an_unaligned_access_traps_without_any_effect() {
    let (cpu, cause, pc) = trap_of("mov 7, r9\nfld.d 8(r2)++, f8");
    assert_eq!((cause, pc), (TrapCause::Unaligned { address: 11, size: 8 }, 0x1004));
    assert_eq!((cpu.state.r[9], cpu.state.r[2], cpu.state.f[8]), (7, 3, 0));
}

#[test]
fn an_access_outside_memory_traps_and_keeps_the_address_register() {
    let (cpu, cause, pc) = trap_of("mov 0x100000, r9\nfld.d 8(r9)++, f8");
    assert_eq!((cause, pc), (TrapCause::DataAccess { address: 0x10_0008 }, 0x1004));
    assert_eq!((cpu.state.r[9], cpu.state.psr & psr::TRAPS), (0x10_0000, psr::DAT));
}

#[test]
fn a_trap_in_a_pair_undoes_both_halves() {
    let (cpu, cause, pc) = trap_of("d.fnop\nnop\nd.fadd.ss f2, f3, f20\nld.l 4(r2), r9\nfnop\nnop\nfnop\nnop");
    assert_eq!((cause, pc), (TrapCause::Unaligned { address: 7, size: 4 }, 0x1008));
    assert_eq!((cpu.state.f[20], cpu.state.psr & (psr::DIM | psr::DS)), (0, psr::DIM | psr::DS));
}

#[test]
fn the_error_of_an_illegal_word_has_the_word_and_its_address() {
    let (_, cause, pc) = trap_of("nop\n.long 0x18000000");
    assert_eq!((cause, pc), (TrapCause::Illegal { word: 0x1800_0000 }, 0x1004));
}

#[test]
fn trap_instructions_set_their_status_bits() {
    assert_eq!(trap_of("trap").1, TrapCause::Instruction);
    assert_eq!(trap_of("mov -1, r9\naddu r9, r9, r9\nintovr").1, TrapCause::Overflow);
    assert_eq!(trap_of("mov 0x200000, r9\nbri r9\nnop").1, TrapCause::InstructionAccess);
}

#[test]
fn a_handler_returns_to_the_trapped_pair_in_dual_mode() {
    // The handler maps no memory. It sets r9 to an aligned address and returns to the address in fir.
    let program = assemble(
        "t.s", 0x1000,
        "mov 0x8002, r9\nnop\nd.fnop\nnop\nd.fnop\nadds 1, r10, r10\nd.fnop\nst.l r10, 0(r9)\nfnop\nadds 1, r10, r10\nfnop\nadds 1, r10, r10\nend: nop\nnop",
    ).unwrap_or_else(|e| panic!("{e}"));
    let handler = assemble("h.s", TRAP_VECTOR, "ld.c fir, r20\nbri r20\nmov 0x8004, r9").expect("correct");
    let mut low = Ram::new(0, 0x10000);
    low.load(0x1000, &program.bytes).expect("fits");
    let mut high = Ram::new(TRAP_VECTOR, 0x100);
    high.load(TRAP_VECTOR, &handler.bytes).expect("fits");
    let mut bus = TwoBanks { low, high };
    let mut cpu = Cpu::at(Config::cycle(), 0x1000);
    let end = program.symbol("end");
    assert!(matches!(cpu.run(&mut bus, end, 100), RunEnd::Trapped(_)));
    assert_eq!(cpu.run(&mut bus, end, 100), RunEnd::Stopped);
    assert_eq!((cpu.state.r[10], bus.low.words(0x8004, 1)), (3, Ok(vec![1])));
    assert_eq!(cpu.state.psr & psr::TRAPS, 0);
}

struct TwoBanks {
    low: Ram,
    high: Ram,
}

impl i860::Bus for TwoBanks {
    fn read(&mut self, address: u32, size: u32) -> Result<u64, i860::Unmapped> {
        self.low.read(address, size).or_else(|_| self.high.read(address, size))
    }

    fn write(&mut self, address: u32, size: u32, value: u64) -> Result<(), i860::Unmapped> {
        self.low.write(address, size, value)
    }
}

#[test]
fn an_interrupt_waits_until_interrupts_are_enabled() {
    let mut cpu = Cpu::at(Config::cycle(), 0x1000);
    assert!(!cpu.interrupt());
    cpu.state.psr |= psr::IM;
    assert!(cpu.interrupt());
    assert_eq!((cpu.state.pc, cpu.state.fir, cpu.state.psr & psr::PIM), (TRAP_VECTOR, 0x1000, psr::PIM));
}

#[test]
fn the_next_fetch_reads_the_words_that_a_store_wrote_into_code() {
    let source = "mov 2, r8
                  loop: mov l%patch, r9
                  patch: adds 1, r10, r10
                  mov 0x954A0010, r11          // adds 16, r10, r10
                  st.l r11, 0(r9)
                  adds -1, r8, r8
                  btne r0, r8, loop
                  end: nop";
    let program = assemble("t.s", 0x1000, source).unwrap_or_else(|e| panic!("{e}"));
    let mut ram = Ram::new(0, 0x10000);
    ram.load(0x1000, &program.bytes).expect("fits");
    let mut cpu = Cpu::at(Config::cycle(), 0x1000);
    assert_eq!(cpu.run(&mut ram, program.symbol("end"), 100), RunEnd::Stopped);
    assert_eq!(cpu.state.r[10], 17);
}
