//! Tests of the figures by topic. Each figure is measured in a run that could have given another value.

use pxpl5_lab::figures::{FigureRow, FigureSettings, TOPICS};
use pxpl5_run::Level;
use std::sync::LazyLock;

static ROWS: LazyLock<Vec<FigureRow>> = LazyLock::new(|| {
    let settings = FigureSettings::new(Level::Transaction);
    let figures = TOPICS.iter().skip(3).flat_map(|topic| topic.figures);
    figures.map(|figure| figure.measured_row(&settings).expect("every figure has a value")).collect()
});

fn row(id: &str) -> &'static FigureRow {
    ROWS.iter().find(|row| row.id == id).unwrap_or_else(|| panic!("no row {id}"))
}

fn within(id: &str, [low, high]: [f64; 2]) {
    let FigureRow { simulated, unit, .. } = row(id);
    assert!((low..=high).contains(simulated), "{id}: {simulated} {unit}, expected {low} to {high}");
}

#[test]
fn every_row_is_written_with_its_experiment() {
    for row in ROWS.iter() {
        assert!(row.simulated.is_finite() && !row.experiment.is_empty(), "{}", row.id);
        assert!(row.is_met || !row.cause.is_empty(), "{} is missed without a word", row.id);
    }
}

/// JITP prints its errors, of which half of the last digit is allowed: 3.3 degrees and 33 px, 0.013 degrees and 0.13 px.
/// 240 visible lines need 240 transforms of every triangle's corners, compared with one transform per field.
///
/// A renderer draws 40 MHz divided by the 292 clocks of the array's program. Clearing and shading of regions add up to one
/// percent. Commands other than triangles add a third of a percent: four for each of 20 regions among 26,000 commands.
///
/// The i860's peak is two operations per clock at 40 MHz. The loop's own instructions keep the measured rate below the
/// peak.
#[test]
fn figures_lie_in_the_intervals_of_the_papers_and_of_closed_forms() {
    let most = 40e6 / 292.0;
    for (id, interval) in [
        ("J1", [3.25, 3.35]),
        ("J1b", [32.5, 33.5]),
        ("J2", [0.0125, 0.0135]),
        ("J2b", [0.125, 0.135]),
        ("J3", [63.555, 63.556]),
        ("J4", [98.0, 100.0]),
        ("J5", [239.99, 240.01]),
        ("R4b", [0.98 * most, 1.004 * most]),
        ("R7", [78.0, 79.99]),
    ] {
        within(id, interval);
    }
}

/// Tests that a FIFO without room for a message lowers the rate of the machine.
#[test]
fn a_small_fifo_lowers_the_rate_of_the_machine() {
    let small = FigureSettings::new(Level::Transaction).with_changes([("renderer.fifo_words".to_owned(), 256)]);
    for id in ["R1", "R2", "R3"] {
        let rate = small.measure(id).expect("it runs").value;
        assert!(rate < row(id).simulated, "{id}: {rate}");
    }
}

/// Tests the rate of spheres. Each touches about 1.3 regions, the exact root takes 504 clocks and a paraboloid 268, and 20
/// renderers with equal loads would draw 20 x 40 MHz / clocks / 1.3 of them.
#[test]
fn a_paraboloid_is_faster_than_a_root_and_both_are_faster_than_the_recollected_rate() {
    let settings = FigureSettings::new(Level::Transaction);
    let clocks = |clocks: u64| settings.with_changes([("renderer.phong_sphere_clocks".to_owned(), clocks)]);
    let [root, paraboloid] = [504, 268].map(|n| clocks(n).measure("R8").expect("it runs").value);
    // FIXME(accuracy): the recollected rate of 700,000 is lower than both.
    assert!(700e3 < root && root < paraboloid, "{root} to {paraboloid}");
    assert!(root < 20.0 * 40e6 / 504.0 / 1.3 && paraboloid < 20.0 * 40e6 / 268.0 / 1.3);
}

/// Tests the wait for the host's operating system, which polls every 30 ms. A report waits at most for one poll: 30 ms
/// are 1.798 fields. The mean wait is half of this time.
#[test]
fn polling_adds_at_most_one_poll_and_half_a_poll_on_average() {
    within("T1", [1.75, 1.799]);
    let mean = row("T1").details.iter().find(|detail| detail.name == "mean of all reports").expect("stated");
    assert!((mean.value - 0.899).abs() < 0.05, "{}", mean.value);
}

/// Tests the filter's delay: 3.75 ms + dt (1 - a) / a with the gain a and dt = 1/120 s.
#[test]
fn the_filter_of_the_fastrak_is_as_late_as_its_closed_form() {
    for (id, gain) in [("T2", 0.95), ("T3", 0.05)] {
        let formula = 3.75 + 1e3 / 120.0 * (1.0 - gain) / gain;
        within(id, [formula - 1e-3, formula + 1e-3]);
        assert!(row(id).is_met, "{id}");
    }
}
