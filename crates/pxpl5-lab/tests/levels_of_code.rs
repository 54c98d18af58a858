//! Tests that the transaction level agrees with the cycle level, if the timing table holds the times of executed code.

use pxpl5_lab::figures::FigureSettings;
use pxpl5_lab::levels::deviation_percent;
use pxpl5_run::Level;
use rayon::prelude::*;

/// Figures that depend on the times of primitives. They include application scenes without back faces and limits of
/// Slats.
const MOVED: [&str; 6] = ["4", "7", "7b", "12", "14", "15"];

/// Maximum difference between the two levels in percent, which is the goal for the timing table.
const MAX_PERCENT: f64 = 5.0;

/// Measures every second figure. `PXPL5_ALL_CASES=1` measures all.
#[test]
fn with_the_times_of_the_code_both_levels_are_within_five_percent() {
    let at = |level: Level, id: &str| {
        let settings = FigureSettings::new(level).with_mig(1, 20).with_times_of_code();
        settings.measure(id).unwrap_or_else(|error| panic!("figure {id}: {error}")).value
    };
    let step = if std::env::var_os("PXPL5_ALL_CASES").is_some() { 1 } else { 2 };
    MOVED.par_iter().step_by(step).for_each(|id| {
        let [table, cycle] = [Level::Transaction, Level::Cycle].map(|level| at(level, id));
        assert!(table.is_finite() && cycle.is_finite(), "figure {id}: {table} and {cycle}");
        let deviation = deviation_percent(table, cycle);
        assert!(
            deviation <= MAX_PERCENT,
            "figure {id}: {table} with the table, {cycle} with the code, {deviation:.1} %"
        );
    });
}
