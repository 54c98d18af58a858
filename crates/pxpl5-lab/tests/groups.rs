//! Tests of the figures by topic. Each figure is measured in a run that could have given another value.

use pxpl5_lab::figures::{Bench, FigureRow, figure_groups};
use pxpl5_run::Level;
use std::sync::LazyLock;

static ROWS: LazyLock<Vec<FigureRow>> = LazyLock::new(|| {
    let groups = figure_groups(&Bench::new(Level::Transaction)).expect("every figure has a value");
    groups.into_iter().flat_map(|group| group.rows).collect()
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
        assert!(row.interval.is_none_or(|[low, high]| low <= row.simulated && row.simulated <= high), "{}", row.id);
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

/// Tests the renderer's rate: 40 MHz divided by the 258 or 292 clocks of the array's programs. Clearing and shading of
/// regions add up to one percent. Commands other than triangles add a third of a percent: four for each of 20 regions
/// among 26,000 commands.
#[test]
fn a_renderer_draws_as_many_triangles_as_its_programs_clocks_allow() {
    for (id, clocks) in [("R4", 258.0), ("R4b", 292.0)] {
        let most = 40e6 / clocks;
        within(id, [0.98 * most, 1.004 * most]);
    }
}

/// Tests the i860's rate. The peak is two operations per clock at 40 MHz. The loop's own instructions keep the measured
/// rate below the peak.
#[test]
fn the_i860_reaches_between_78_and_80_million_operations_per_second() {
    within("R7", [78.0, 79.99]);
}

/// Tests that the depth of the FIFO and the number of channels of a sender change the triangle rates.
#[test]
fn the_fifo_and_the_senders_channels_move_the_rate_of_the_machine() {
    for id in ["R1", "R2", "R3"] {
        let [low, high] = row(id).interval.expect("varied");
        assert!(high > low, "{id}: {low} to {high}");
    }
}

/// Tests the interval of the rig's total latency. The beam takes 239 lines of 63.56 us from the first line of a field
/// to the last. In this test nothing else changes the latency.
#[test]
fn the_interval_of_the_total_latency_of_the_rig_is_the_scan_time_between_the_photodiode_lines() {
    let [low, high] = row("R6").interval.expect("varied");
    assert!((high - low - 239.0 * 0.063_556).abs() < 0.01, "{low} to {high}");
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
