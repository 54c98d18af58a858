//! Memoization of clocks changes only the host's time. `crates/pphigs/tests/memo.rs` has the same test with the
//! triangle kernels.

use i860::state::Mode;
use i860::timing::{DramTiming, FREEZES, Freeze, FreezeRules};
use i860::{AddressProfile, Config, Cpu, DecodedPrograms, Program, Ram, RunEnd, assemble, decode};
use proptest::prelude::*;
use pxpl5_sim::parameters::ParameterTable;
use std::sync::Arc;

const CODE: u32 = 0x1000;
const MEMORY: usize = 0x1_0000;

/// Two processors: one with memoization and one that counts every clock.
struct Twins([(Cpu, Ram); 2]);

impl Twins {
    fn new(config: Config, words: &[u32], registers: &[u32; 32]) -> Twins {
        Twins([true, false].map(|memoise| {
            let mut ram = Ram::new(0, MEMORY);
            ram.load_words(CODE, words).expect("fits");
            let mut cpu = Cpu::at(Config { memoise, ..config }, CODE);
            cpu.state.r[1..].copy_from_slice(&registers[1..]);
            cpu.state.f[2..].copy_from_slice(&registers[2..]);
            (cpu, ram)
        }))
    }

    /// Executes one step, or at most `instructions` instructions. If the execution has left the program, the program
    /// starts again.
    fn go(&mut self, instructions: u64) -> Result<(), TestCaseError> {
        let [memoised, counted] = self.0.each_mut().map(|(cpu, ram)| {
            let outcome = match instructions {
                0 => format!("{:?}", cpu.step(ram)),
                budget => format!("{:?}", cpu.run(ram, Some(CODE + 4 * (budget as u32 % 32)), budget)),
            };
            if cpu.state.pc as usize >= MEMORY {
                cpu.state.pc = CODE;
            }
            (outcome, cpu.state.clone(), cpu.clocks(), cpu.profile())
        });
        prop_assert_eq!(memoised, counted);
        prop_assert_eq!(self.0[1].0.repeated_instructions(), 0);
        Ok(())
    }
}

fn core_word(opcodes: &'static [u32], low: impl Strategy<Value = u32>) -> impl Strategy<Value = u32> {
    (prop::sample::select(opcodes), low).prop_map(|(op, low)| op << 26 | low)
}

/// Random instructions of all kinds. Many access memory near r4 to r7, or branch to words nearby.
fn likely_word() -> impl Strategy<Value = u32> {
    let any = (0u32..64, 0u32..1 << 26).prop_map(|(op, low)| op << 26 | low);
    let floating = (0u32..2048, 0u32..1 << 15).prop_map(|(low, high)| 0x12 << 26 | (high << 11 & 0x03FF_F800) | low);
    let integer = core_word(&[0x20, 0x21, 0x24, 0x25, 0x28, 0x29, 0x2C, 0x30, 0x31, 0x34, 0x3C], 0u32..1 << 26);
    let place = (4u32..8, 0u32..32, 0u32..32, 0u32..32, 0u32..6);
    let place = place.prop_map(|(base, a, b, n, low)| base << 21 | a << 16 | b << 11 | n << 4 | low);
    let access = core_word(&[0x01, 0x03, 0x05, 0x07, 0x09, 0x0B, 0x0D], place);
    let branch = core_word(&[0x1A, 0x1C, 0x1D, 0x1E, 0x1F], (-12i32..12).prop_map(|by| by as u32 & 0x03FF_FFFF));
    let compare = (prop::sample::select(vec![0x14u32, 0x16, 0x2D]), 0u32..32, 0u32..32, -12i32..12);
    let compare =
        compare.prop_map(|(op, a, b, by)| op << 26 | b << 21 | (by as u32 & 0xF800) << 5 | a << 11 | by as u32 & 0x7FF);
    let word = prop_oneof![1 => any, 6 => floating, 3 => integer, 4 => access, 1 => branch, 1 => compare];
    word.prop_filter("an instruction", |word| decode(*word).is_ok())
}

fn registers() -> impl Strategy<Value = [u32; 32]> {
    let value = prop_oneof![any::<u32>(), 0u32..256, (0u32..512).prop_map(|n| 0x4000 + 16 * n)];
    let bases = prop::array::uniform4((0u32..0x800).prop_map(|n| 0x4000 + 16 * n));
    (prop::array::uniform32(value), bases).prop_map(|(mut all, bases)| {
        all[4..8].copy_from_slice(&bases);
        all
    })
}

/// Freeze rules with all rows, with one row, with all rows except one, or with random rows.
fn rules() -> impl Strategy<Value = FreezeRules> {
    let row = 0..FREEZES.len() as u32;
    prop_oneof![Just(!0u32), row.clone().prop_map(|n| 1 << n), row.prop_map(|n| !(1 << n)), any::<u32>()]
        .prop_map(rules_of)
}

fn rules_of(bits: u32) -> FreezeRules {
    let on = FREEZES.iter().enumerate().filter(|(n, _)| bits >> n & 1 != 0);
    on.fold(FreezeRules::none(), |rules, (_, row)| rules.with(row.id))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn memoised_random_programs_take_the_counted_clocks_for_each_cause(
        words in prop::collection::vec(likely_word(), 1..60),
        registers in registers(),
        freezes in rules(),
        runs in prop::collection::vec(prop_oneof![Just(0u64), 1u64..30, 1u64..400], 20..60),
    ) {
        let mut twins = Twins::new(Config { freezes, ..Config::cycle() }, &words, &registers);
        for instructions in runs {
            twins.go(instructions)?;
        }
        let [(_, memoised), (_, counted)] = &twins.0;
        prop_assert!(memoised == counted, "memory");
    }
}

/// Bytes of a way of the instruction cache. Lines at this distance are in the same set.
const WAY: usize = 0x800;

/// Pieces of code that replace each other in the instruction cache. Each piece ends with a branch to another piece.
fn pieces() -> impl Strategy<Value = Vec<u32>> {
    let piece = (prop::collection::vec(likely_word(), 0..24), any::<prop::sample::Index>());
    prop::collection::vec(piece, 3..7).prop_map(|pieces| {
        let count = pieces.len();
        let mut all = vec![0; count * WAY / 4];
        for (n, (words, next)) in pieces.into_iter().enumerate() {
            let begin = n * WAY / 4;
            let branch = begin + words.len();
            all[begin..branch].copy_from_slice(&words);
            let by = (next.index(count) * WAY / 4) as i32 - (branch as i32 + 1);
            all[branch] = 0x1A << 26 | by as u32 & 0x03FF_FFFF;
            all[branch + 1] = 0xA000_0000;
        }
        all
    })
}

/// Values of r4 to r7 that point into more data than the cache holds, or into the code.
fn far_registers() -> impl Strategy<Value = [u32; 32]> {
    let data = (0u32..0x400).prop_map(|n| 0x8000 + 16 * n);
    let code = (0u32..0x180).prop_map(|n| CODE + 16 * n);
    let bases = prop::array::uniform4(prop_oneof![9 => data, 1 => code]);
    (registers(), bases).prop_map(|(mut all, bases)| {
        all[4..8].copy_from_slice(&bases);
        all
    })
}

/// Random memory timings, some of them so fast that no wait occurs.
fn memories() -> impl Strategy<Value = DramTiming> {
    let reads = (0u64..12, 0u64..16, 0u64..5);
    let writes = (0u64..5, 0u64..14);
    let stolen = prop::sample::select(vec![(0u64, 0u64), (50, 8), (625, 8)]);
    (reads, writes, stolen, prop::sample::select(vec![64u64, 4096])).prop_map(|(reads, writes, stolen, page_bytes)| {
        let (first_hit, first_miss, next) = reads;
        let (write_hit, write_miss) = writes;
        let (refresh_interval, refresh_clocks) = stolen;
        let new = DramTiming { first_hit, first_miss, next, write_hit, write_miss, page_bytes, ..DramTiming::PAPERS };
        DramTiming { refresh_interval, refresh_clocks, ..new }
    })
}

/// Freeze rules in which one row has so many clocks that every use of the row changes the total noticeably.
fn slow_rules() -> impl Strategy<Value = FreezeRules> {
    (rules(), 0..FREEZES.len(), 0u64..40).prop_map(|(mut rules, row, clocks)| {
        rules.clocks.set(FREEZES[row].clocks.name, clocks.into()).expect("the table has all rows");
        rules
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn memoised_code_larger_than_the_caches_takes_the_same_clocks(
        words in pieces(),
        registers in far_registers(),
        freezes in prop_oneof![2 => Just(FreezeRules::all()), 1 => slow_rules()],
        dram in prop_oneof![1 => Just(DramTiming::PAPERS), 1 => memories()],
        replacement_seed in any::<u16>(),
        runs in prop::collection::vec((prop_oneof![1 => Just(0u64), 3 => 100u64..800], far_registers()), 10..30),
    ) {
        let config = Config { freezes, dram, replacement_seed, ..Config::cycle() };
        let mut twins = Twins::new(config, &words, &registers);
        for (instructions, registers) in runs {
            for (cpu, _) in &mut twins.0 {
                cpu.state.r[4..8].copy_from_slice(&registers[4..8]);
            }
            twins.go(instructions)?;
        }
        let [(_, memoised), (_, counted)] = &twins.0;
        prop_assert!(memoised == counted, "memory");
    }
}

/// Repeatedly executes code of three times the size of the instruction cache. The code has stores that miss the data
/// cache.
#[test]
fn most_blocks_of_code_larger_than_the_caches_are_repeated_from_the_memo() {
    let body = "adds 1, r6, r6\n fadd.ss f8, f9, f10\n st.l r6, 0(r4)\n adds 32, r4, r4\n".repeat(768);
    let source = format!("{body}\nend: nop");
    let program = assemble("long.s", CODE, &source).unwrap_or_else(|e| panic!("{e}"));
    let mut ram = Ram::new(0, 1 << 18);
    ram.load(CODE, &program.bytes).expect("fits");
    let mut cpu = Cpu::at(Config::cycle(), CODE);
    for _ in 0..20 {
        cpu.state.pc = CODE;
        cpu.state.r[4] = 0x2_0000;
        assert_eq!(cpu.run(&mut ram, program.symbol("end"), 10_000), RunEnd::Stopped);
    }
    assert!(cpu.profile().instruction_misses > 20 * 200, "it does not fit");
    let (repeated, all) = (cpu.repeated_instructions(), cpu.instructions());
    assert!(10 * repeated > 8 * all, "{repeated} of {all}");
}

/// A loop of eight instructions in two lines of the cache.
const LOOP: &str = "
        mov     100, r5
loop:   fld.d   0(r4), f8
        fadd.ss f8, f9, f10
        fmul.ss f10, f10, f11
        st.l    r5, 8(r4)
        ld.l    8(r4), r6
        adds    -1, r5, r5
        xor     r6, r7, r7
        btne    r0, r5, loop
end:    nop";

fn run_loop(prepare: impl Fn(&mut Cpu)) -> (Cpu, Ram) {
    let program = assemble("loop.s", CODE, LOOP).unwrap_or_else(|e| panic!("{e}"));
    let mut ram = Ram::new(0, MEMORY);
    ram.load(CODE, &program.bytes).expect("fits");
    let mut cpu = Cpu::at(Config::cycle(), CODE);
    cpu.state.r[4] = 0x4000;
    prepare(&mut cpu);
    assert_eq!(cpu.run(&mut ram, program.symbol("end"), 10_000), RunEnd::Stopped);
    (cpu, ram)
}

/// The first turn misses the cache. In the second turn, the state of the cache has changed. Later turns are memoized
/// with the state after the previous turn. The last turn leaves the loop. At most ten of a hundred turns are counted.
#[test]
fn a_cached_loop_is_simulated_only_until_it_is_memoised() {
    let (cpu, _) = run_loop(|_| {});
    let repeated = cpu.repeated_instructions();
    assert!((8 * 90..=8 * 100).contains(&repeated), "{repeated} of 800");
}

#[test]
fn the_clocks_of_a_profile_by_address_add_up_to_the_clocks_of_the_run() {
    let (plain, _) = run_loop(|_| {});
    let (watched, _) = run_loop(|cpu| cpu.watch(Some(AddressProfile::new(CODE, 16))));
    assert_eq!(watched.profile(), plain.profile());
    let by_address: u64 = (0..16).map(|n| watched.watched().expect("watched").at(CODE + 4 * n).0).sum();
    assert_eq!(by_address, plain.clocks());
}

/// Random turns of processors that share decoded programs. A turn has the processor, its program and the number of
/// instructions.
fn turns() -> impl Strategy<Value = Vec<(usize, usize, u64)>> {
    prop::collection::vec((0usize..3, 0usize..2, 1u64..400), 20..60)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Programs can store into their own code, so each program is loaded again before its turn.
    #[test]
    fn processors_with_a_shared_memo_take_the_same_clocks_as_processors_without_a_memo(
        words in prop::collection::vec(prop::collection::vec(likely_word(), 1..60), 2),
        registers in prop::collection::vec(far_registers(), 3),
        freezes in rules(),
        turns in turns(),
    ) {
        let program = |words: &Vec<u32>| {
            let empty = assemble("empty.s", CODE, "").unwrap_or_else(|e| panic!("{e}"));
            Arc::new(Program { bytes: words.iter().flat_map(|word| word.to_le_bytes()).collect(), ..empty })
        };
        let programs: Vec<Arc<Program>> = words.iter().map(program).collect();
        let mut twins: Vec<Twins> = registers.iter().map(|all| Twins::new(Config { freezes, ..Config::cycle() }, &[], all)).collect();
        let mut decoded = DecodedPrograms::new();
        for (which, number, instructions) in turns {
            let program = &programs[number];
            let [memoised, counted] = &mut twins[which].0;
            for (cpu, ram) in [&mut *memoised, &mut *counted] {
                ram.load(CODE, &program.bytes).expect("fits");
                cpu.state.pc = CODE;
                cpu.state.mode = Mode::Single;
            }
            memoised.0.open(&mut decoded, Some(program));
            counted.0.invalidate_code();
            let ends = [&mut *memoised, &mut *counted].map(|(cpu, ram)| format!("{:?}", cpu.run(ram, None, instructions)));
            prop_assert_eq!(&ends[0], &ends[1]);
            let is_as_assembled = memoised.1.bytes()[CODE as usize..].starts_with(&program.bytes);
            let is_kept = memoised.0.close(&mut decoded, Some(program));
            prop_assert!(is_as_assembled || !is_kept, "what has changed is not shared");
            prop_assert_eq!(&memoised.0.state, &counted.0.state);
            prop_assert_eq!(memoised.0.profile(), counted.0.profile());
            prop_assert!(memoised.1 == counted.1, "memory");
        }
    }
}

fn two_loops() -> [Arc<Program>; 2] {
    let sources = [LOOP.to_owned(), LOOP.replace("adds    -1, r5, r5", "adds    -2, r5, r5")];
    sources.map(|source| Arc::new(assemble("loop.s", CODE, &source).unwrap_or_else(|e| panic!("{e}"))))
}

/// Two programs run in turn at the same addresses, with exchanged or discarded decoded code. Both ways must reach the
/// same state at the same clock.
#[test]
fn alternating_programs_are_decoded_once_and_take_the_same_clocks() {
    let programs = two_loops();
    let take_turns = |exchange: bool| {
        let mut ram = Ram::new(0, MEMORY);
        let mut cpu = Cpu::new(Config::cycle());
        let mut decoded = DecodedPrograms::new();
        for turn in 0..20 {
            let program = &programs[turn % 2];
            ram.load(CODE, &program.bytes).expect("fits");
            if exchange {
                cpu.open(&mut decoded, Some(program));
            } else {
                cpu.invalidate_code();
            }
            cpu.state.pc = CODE;
            cpu.state.r[4] = 0x4000;
            assert_eq!(cpu.run(&mut ram, program.symbol("end"), 10_000), RunEnd::Stopped);
            assert!(!exchange || cpu.close(&mut decoded, Some(program)), "memory holds it as it was assembled");
        }
        (cpu.state.clone(), cpu.profile(), cpu.repeated_instructions())
    };
    let (exchanged, forgotten) = (take_turns(true), take_turns(false));
    assert_eq!((&exchanged.0, &exchanged.1), (&forgotten.0, &forgotten.1));
    assert!(exchanged.2 > forgotten.2, "what was remembered is used again");
}

/// Returns the misses of the instruction cache and of the data cache.
fn misses(cpu: &Cpu) -> (u64, u64) {
    (cpu.profile().instruction_misses, cpu.profile().data_misses)
}

#[test]
fn the_memo_respects_caches_that_were_emptied_between_runs() {
    let (mut cpu, mut ram) = run_loop(|_| {});
    let before = misses(&cpu);
    cpu.empty_caches();
    cpu.state.pc = CODE;
    assert_eq!(cpu.run(&mut ram, Some(CODE + 36), 10_000), RunEnd::Stopped);
    assert_eq!(misses(&cpu), (2 * before.0, 2 * before.1));
    assert!(cpu.profile().frozen_by(Freeze::InstructionMiss) > 0);
}
