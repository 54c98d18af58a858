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
        println!(
            "{:<4} {:>12.4} {:>12.4} {:<12} {:?} % {:?} {:?}",
            row.id, row.published, row.simulated, row.unit, row.error_percent, row.interval, row.details
        );
        assert!(row.simulated.is_finite() && !row.experiment.is_empty(), "{}", row.id);
        assert!(row.is_met || !row.cause.is_empty(), "{} is missed without a word", row.id);
    }
}

/// Tests the errors that JITP prints: 3.3 degrees and 33 px, 0.013 degrees and 0.13 px. Half of the last digit is
/// allowed.
#[test]
fn just_in_time_pixels_have_the_errors_of_the_paper() {
    within("J1", [3.25, 3.35]);
    within("J1b", [32.5, 33.5]);
    within("J2", [0.0125, 0.0135]);
    within("J2b", [0.125, 0.135]);
    within("J3", [63.555, 63.556]);
    within("J4", [98.0, 100.0]);
}

/// Tests the number of transforms. 240 visible lines need 240 transforms of every triangle's corners, compared with one
/// transform per field.
#[test]
fn one_transform_per_line_needs_240_times_the_transforms_of_one_transform_per_field() {
    within("J5", [239.99, 240.01]);
}

/// Tests the renderer's rate: 40 MHz divided by the 292 clocks of the array's program. Clearing and shading of regions add up to one percent. Commands other than triangles add a third of a percent: four for each of 20 regions
/// among 26,000 commands.
#[test]
fn a_renderer_draws_as_many_triangles_as_its_programs_clocks_allow() {
    let most = 40e6 / 292.0;
    within("R4b", [0.98 * most, 1.004 * most]);
}

/// Tests the i860's rate. The peak is two operations per clock at 40 MHz. The loop's own instructions keep the measured
/// rate below the peak.
#[test]
fn the_i860_reaches_between_78_and_80_million_operations_per_second() {
    within("R7", [78.0, 79.99]);
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
