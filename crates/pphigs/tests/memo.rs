//! Tests that memoizing the clocks of the triangle kernels changes only the host's time. crates/i860/tests/memo.rs
//! tests random programs.

use crate::kernel::{Bench, frame, triangles};
use i860::Config;
use i860::timing::{FREEZES, FreezeRow, FreezeRules};
use pxpl5_geometry::Viewport;
use pxpl5_geometry::kernel::Schedule;
use pxpl5_sim::parameters::ParameterTable;

fn kernel_with(config: Config, schedule: Schedule) -> Bench {
    let mut bench = Bench::new(frame(schedule), Viewport::FRAME, config, &triangles(12, 0.5, 4));
    bench.run();
    bench
}

fn assert_same_kernel(freezes: FreezeRules, schedule: Schedule) {
    let [memoised, counted] =
        [true, false].map(|memoise| kernel_with(Config { memoise, freezes, ..Config::cycle() }, schedule));
    assert_eq!(memoised.profile(), counted.profile(), "{schedule:?}");
    assert!(memoised.output() == counted.output() && memoised.cpu.state == counted.cpu.state);
}

/// Returns all rules that freeze the processor. The rule `row` takes so many clocks that its use is noticeable.
fn slower(row: &FreezeRow) -> FreezeRules {
    let mut rules = FreezeRules::all();
    rules.clocks.set(row.clocks.name, 10.into()).expect("the table has all rows");
    rules
}

fn assert_same_with_any_row_disabled(schedule: Schedule) {
    assert_same_kernel(FreezeRules::all(), schedule);
    for row in &FREEZES {
        assert_same_kernel(FreezeRules::all().without(row.id), schedule);
        assert_same_kernel(FreezeRules::none().with(row.id), schedule);
        assert_same_kernel(slower(row), schedule);
    }
}

#[test]
fn the_memoised_straight_kernel_takes_the_same_clocks_with_any_freeze_row_disabled() {
    assert_same_with_any_row_disabled(Schedule::Straight);
}

#[test]
fn the_memoised_compiled_kernel_takes_the_same_clocks_with_any_freeze_row_disabled() {
    assert_same_with_any_row_disabled(Schedule::Compiled);
}

#[test]
fn the_memoised_dual_kernel_takes_the_same_clocks_with_any_freeze_row_disabled() {
    assert_same_with_any_row_disabled(Schedule::Dual);
}
