//! With the times of the code in its table, the transaction level says what the cycle level does.

use pxpl5_lab::figures::Bench;
use pxpl5_lab::levels::deviation_percent;
use pxpl5_run::Level;

/// The figures that the times of primitives move, application scenes with culled structures and limits of Slats among them.
const MOVED: [&str; 6] = ["4", "7", "7b", "12", "14", "15"];

/// At most so far apart, percent: the goal of the table.
const MOST_PERCENT: f64 = 5.0;

#[test]
fn with_the_times_of_the_code_both_levels_are_within_five_percent() {
    let at = |level: Level, id: &str| {
        let bench = Bench::new(level).with_mig(1, 20).with_times_of_code();
        bench.measure(id).unwrap_or_else(|error| panic!("figure {id}: {error}")).value
    };
    for id in MOVED {
        let [table, cycle] = [Level::Transaction, Level::Cycle].map(|level| at(level, id));
        assert!(table.is_finite() && cycle.is_finite(), "figure {id}: {table} and {cycle}");
        let deviation = deviation_percent(table, cycle);
        assert!(
            deviation <= MOST_PERCENT,
            "figure {id}: {table} with the table, {cycle} with the code, {deviation:.1} %"
        );
    }
}
