//! Tests that profiles account for every clock, by cause and by label.

use i860::timing::{Freeze, FreezeRules};
use i860::{AddressProfile, Config, Cpu, Ram, RunEnd, assemble};

fn run(source: &str, freezes: FreezeRules) -> (Cpu, i860::Program) {
    let program = assemble("p.s", 0x1000, source).unwrap_or_else(|e| panic!("{e}"));
    let mut ram = Ram::new(0, 0x10000);
    ram.load(0x1000, &program.bytes).expect("fits");
    let mut cpu = Cpu::at(Config { freezes, ..Config::cycle() }, 0x1000);
    cpu.watch(Some(AddressProfile::new(0x1000, program.words().len())));
    assert_eq!(cpu.run(&mut ram, program.symbol("end"), 1000), RunEnd::Stopped);
    (cpu, program)
}

/// A loop of three turns. Each turn takes four clocks: adds, btne, and two more clocks if btne is taken. One
/// instruction precedes the loop, and two instructions follow.
const LOOP: &str = "start: mov 3, r5\nloop: adds -1, r5, r5\nbtne r0, r5, loop\nlast: nop\nnop\nend: nop";

#[test]
fn the_clocks_of_a_label_cover_the_code_up_to_the_next_label() {
    let (cpu, program) = run(LOOP, FreezeRules::none().with(Freeze::CompareBranchTaken));
    let labels: Vec<(&str, u32)> = program.labels.iter().map(|(name, at)| (name.as_str(), *at)).collect();
    let by_label = cpu.watched().expect("watched").by_label(&labels);
    assert_eq!(by_label, [("start", 1), ("loop", 3 * 2 + 2 * 2), ("last", 2), ("end", 0)]);
    assert_eq!(by_label.iter().map(|(_, clocks)| clocks).sum::<u64>(), cpu.clocks());
}

#[test]
fn every_clock_is_counted_as_an_issue_or_for_one_cause_of_waiting() {
    let (cpu, _) = run(LOOP, FreezeRules::all());
    let profile = cpu.profile();
    assert_eq!(profile.clocks(), cpu.clocks());
    assert_eq!((profile.instructions, profile.issue), (1 + 3 * 2 + 2, 1 + 3 * 2 + 2));
    assert_eq!(profile.frozen_by(Freeze::CompareBranchTaken), 2 * 2);
    assert!(profile.to_string().contains("row 19b"));
}

#[test]
fn clearing_a_profile_does_not_stop_the_clock() {
    let (mut cpu, _) = run(LOOP, FreezeRules::all());
    let before = cpu.clocks();
    cpu.clear_profile();
    assert_eq!((cpu.profile().clocks(), cpu.clocks()), (0, before));
}
