//! Tests of the processor: calls of i860 code, memory and breakpoints.

use super::*;

fn processor() -> Processor {
    Processor::new(NodeId(3), 1 << 16, CodeVersion::Scheduled, i860::Config::cycle())
}

fn program(source: &str) -> Arc<Program> {
    Arc::new(i860::assemble("test", 0x1000, source).expect("it assembles"))
}

#[test]
fn a_call_returns_with_its_result_and_takes_its_clocks() {
    let mut processor = processor();
    let double = program("start: adds r16, r16, r17\n bri r1\n nop");
    let cold = processor.call(&double, "start", &[(16, 21)], 10).expect("it returns");
    assert_eq!(processor.register(17), 42);
    let warm = processor.call(&double, "start", &[(16, 5)], 10).expect("it returns");
    assert_eq!(processor.register(17), 10);
    // Three instructions and the clock of an indirect branch.
    assert_eq!(warm, Processor::CLOCK * 4);
    assert!(cold > warm, "the first call fills the instruction cache");
}

#[test]
fn a_trap_names_the_board_and_the_address() {
    let wild = program("start: nop\n ld.l 0(r16), r17\n bri r1\n nop");
    let error = processor().call(&wild, "start", &[(16, 0x2002)], 10).expect_err("unaligned");
    assert_eq!(
        error.to_string(),
        "graphics processor at node 3: trap at 0x00001004: 0x00002002 is not a multiple of 4"
    );
}

#[test]
fn an_endless_loop_ends_with_its_budget() {
    let forever = program("start: br start\n nop");
    let error = processor().call(&forever, "start", &[], 1_000).expect_err("endless");
    assert!(matches!(error, ProcessorFault::Endless { gp: NodeId(3), budget: 1_000, .. }), "{error}");
}

#[test]
fn loading_a_program_again_restores_words_that_the_program_has_overwritten() {
    let mut processor = processor();
    // Stores the word at `other` over the word at `here`, and executes `here` afterwards.
    let changing = program(
        "start: orh 0, r0, r18\n or 0x1018, r18, r18\n ld.l 0(r18), r19\n bri r1\n adds 1, r17, r17\n nop\n\
         other: adds 5, r17, r17\n change: orh 0, r0, r18\n or 0x1010, r18, r18\n st.l r19, 0(r18)\n bri r1\n nop",
    );
    let other = program("start: adds r16, r16, r17\n bri r1\n nop");
    for _ in 0..3 {
        processor.call(&changing, "start", &[(17, 10)], 20).expect("it returns");
        assert_eq!(processor.register(17), 11, "as it was loaded");
        processor.call(&changing, "change", &[], 20).expect("it returns");
        processor.call(&changing, "start", &[(17, 10)], 20).expect("it returns");
        assert_eq!(processor.register(17), 15, "as it changed itself");
        processor.call(&other, "start", &[(16, 21)], 10).expect("it returns");
        assert_eq!(processor.register(17), 42);
    }
}

/// Tests that the caches never hold the addresses of the ring interface. A second read of such an address takes longer
/// than a second read of any other address.
#[test]
fn the_ring_window_is_not_cached() {
    let mut processor = Processor::new(NodeId(3), 1 << 20, CodeVersion::Compiled, i860::Config::cycle());
    let load = program("start: ld.l 0(r16), r17\n adds r17, r0, r18\n bri r1\n nop");
    let mut read_twice = |address| {
        let mut read = || processor.call(&load, "start", &[(16, address)], 10).expect("it returns");
        // Fill the cache lines of code and data.
        let _cold = [read(), read()];
        [read(), read()]
    };
    // Four instructions, one freeze between the first and the second, and the clock of an indirect branch.
    let held = Processor::CLOCK * 6;
    assert_eq!(read_twice(window::WINDOW - 32), [held; 2]);
    for address in [window::WINDOW, window::RING_MEMORY.end - 4] {
        let [first, second] = read_twice(address);
        assert!(first > held && second > held, "{first:?}, {second:?} at {address:#x}");
    }
}

#[test]
fn code_versions_have_the_names_used_in_experiment_files() {
    let versions = [CodeVersion::Unoptimised, CodeVersion::Compiled, CodeVersion::Scheduled];
    assert_eq!(versions.map(CodeVersion::name), ["unoptimised", "compiled", "scheduled"]);
    assert!(format!("{:?}", processor()).contains("Scheduled"));
}

#[test]
fn outputs_use_whole_cache_lines_at_both_ends_of_the_free_memory() {
    let mut processor = processor();
    let end = 1 << 16;
    assert_eq!(processor.place_output(0, 1_001, 100), Ok(1_024));
    // The output begins at the last cache line that starts at least 100 bytes before the end.
    assert_eq!(processor.place_output(1, 1_001, 100), Ok(65_408));
    // The bytes from 1,124 to 1,152 are the rest of a cache line.
    let room = end - 1_152;
    let no_room = |context, needed_bytes, available_bytes| {
        Err(ProcessorFault::NoRoom { gp: NodeId(3), context, needed_bytes, available_bytes })
    };
    assert_eq!(processor.place_output(1, 1_001, room + 1), no_room(1, room + 1, room));
    assert_eq!(processor.place_output(1, 1_001, room), Ok(1_152), "one may take the place of its own last output");
    assert_eq!(processor.place_output(0, 1_001, 129), no_room(0, 129, 128));
    assert_eq!(processor.place_output(0, 1_001, 128), Ok(1_024));
    assert_eq!(processor.place_output(1, 70_000, 1), Ok(65_504), "context 0 says where it begins");
    assert_eq!(processor.place_output(0, 70_000, 1), no_room(0, 1, 0));
}

#[test]
fn writing_over_a_program_changes_the_program() {
    let mut processor = processor();
    let [adds, doubles] = ["adds 1, r17, r17", "adds r17, r17, r17"]
        .map(|instruction| program(&format!("start: {instruction}\n bri r1\n nop")));
    processor.call(&adds, "start", &[(17, 20)], 10).expect("it returns");
    // Writes beside the program change nothing.
    for address in [0x0FF8, 0x100C] {
        processor.write(address, &[0, 0]).expect("there is memory");
        assert!(processor.is_as_loaded, "{address:#x}");
    }
    processor.call(&adds, "start", &[(17, 20)], 10).expect("it returns");
    assert_eq!(processor.register(17), 21);
    let words: Vec<Word> =
        doubles.bytes.chunks_exact(4).map(|word| Word::from_le_bytes([word[0], word[1], word[2], word[3]])).collect();
    for (address, words) in [(0x1008, &words[2..]), (0x1000, &words[..1])] {
        processor.is_as_loaded = true;
        processor.write(address, words).expect("there is memory");
        assert!(!processor.is_as_loaded, "{address:#x}");
    }
    processor.call(&adds, "start", &[(17, 20)], 10).expect("it returns");
    assert_eq!(processor.register(17), 40);
}

#[test]
fn breakpoints_change_neither_the_time_nor_the_instruction_limit_of_a_call() {
    let turns = program("start: nop\nagain: adds -1, r16, r16\n btne r0, r16, again\n bri r1\n nop");
    for budget in 1..12 {
        let [mut alone, mut watched] = [processor(), processor()];
        watched.break_at([0x1004].into());
        for _ in 0..2 {
            let [one, other] = [&mut alone, &mut watched].map(|it| it.call(&turns, "start", &[(16, 3)], budget));
            assert_eq!(one, other, "{budget} instructions");
        }
        assert_eq!(alone.clocks(), watched.clocks());
        assert_eq!((alone.take_hits().len(), watched.take_hits().is_empty()), (0, budget < 2));
    }
    let mut watched = processor();
    watched.call(&turns, "start", &[(16, 1)], 1_000).expect("it returns");
    watched.break_at([0x1004].into());
    watched.call(&turns, "start", &[(16, 100)], 1_000).expect("it returns");
    let hits = watched.take_hits();
    assert_eq!(hits.len(), KEPT_HITS);
    // The first instruction, then two instructions and the two clocks of a taken btne for each turn.
    let expected: Vec<Span> = (0..KEPT_HITS as u64).map(|turn| Processor::CLOCK * (1 + 4 * turn)).collect();
    assert_eq!(hits.iter().map(|hit| hit.into_call).collect::<Vec<_>>(), expected);
    assert_eq!(hits.iter().map(|hit| hit.state.r[16]).collect::<Vec<_>>(), (37..=100).rev().collect::<Vec<_>>());
    assert_eq!(watched.take_hits(), []);
}

#[test]
fn programs_are_listed_by_address_with_summed_clocks() {
    let mut processor = processor();
    let source = "start: bri r1\n nop";
    let at = |base| Arc::new(i860::assemble("at", base, source).expect("it assembles"));
    let [first, second, over_first] = [at(0x1000), at(0x2000), program("start: bri r1\n adds 1, r17, r17")];
    assert!(processor.program().is_none() && processor.programs().next().is_none());
    let mut clocks = 0;
    let mut called = |program: &Arc<Program>, expected: &[&Arc<Program>]| {
        let span = processor.call(program, "start", &[], 10).expect("it returns");
        clocks += span.0 / Processor::CLOCK.0;
        assert_eq!(processor.clocks(), clocks);
        assert!(processor.program().is_some_and(|last| Arc::ptr_eq(last, program)));
        let found: Vec<_> = processor.programs().map(Arc::as_ptr).collect();
        assert_eq!(found, expected.iter().map(|program| Arc::as_ptr(program)).collect::<Vec<_>>());
    };
    called(&first, &[&first]);
    called(&second, &[&second, &first]);
    called(&second, &[&second, &first]);
    called(&over_first, &[&over_first, &second]);
    let beyond = at(0xFFFC);
    let error = processor.call(&beyond, "start", &[], 10).expect_err("one word too many");
    assert_eq!(error.to_string(), "graphics processor at node 3: no memory for 2 words at 0x0000fffc");
}

#[test]
fn programs_that_do_not_fit_in_memory_are_refused() {
    let mut processor = processor();
    assert!(processor.write(0xFFFC, &[1]).is_ok());
    let error = processor.write(0xFFFC, &[1, 2]).expect_err("one word too many");
    assert_eq!(error.to_string(), "graphics processor at node 3: no memory for 2 words at 0x0000fffc");
}
