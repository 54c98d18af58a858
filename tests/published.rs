//! Tests of the published figures. Free checks must agree within the printed digits, and misses have the recorded size
//! (FIXME(accuracy)). ACCURACY.md, which explains the causes, must contain the results of these runs.

use pxpl5::Level;
use pxpl5::figures::{
    Bench, FigureRow, FigureTable, Figures, WITHOUT_CLOSED_FORM, alternatives_with, markdown, run_all_in_order,
};
use std::convert::Infallible;
use std::ops::Deref;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU64, Ordering};

static BENCH: LazyLock<Bench> = LazyLock::new(|| Bench::new(Level::Transaction));
static FIGURES: LazyLock<Measured> = LazyLock::new(Measured::all);

/// All figures, and what was reported while they were measured.
struct Measured {
    figures: Figures,
    /// Reported rows in the order of the reports.
    reported: Vec<(FigureTable, FigureRow)>,
    /// Number of reports of progress, and the number of all steps in the last report.
    steps: [u64; 2],
}

impl Measured {
    fn all() -> Self {
        let (reports, of) = (AtomicU64::new(0), AtomicU64::new(0));
        let finished = |_, all| {
            reports.fetch_add(1, Ordering::Relaxed);
            of.store(all, Ordering::Relaxed);
        };
        let mut reported = Vec::new();
        let figures = run_all_in_order(&BENCH, finished, |table, row| reported.push((table, row.clone())));
        let figures = figures.expect("every experiment runs on its preset");
        Self { figures, reported, steps: [reports, of].map(AtomicU64::into_inner) }
    }
}

impl Deref for Measured {
    type Target = Figures;

    fn deref(&self) -> &Figures {
        &self.figures
    }
}

fn row(id: &str) -> &'static FigureRow {
    FIGURES.rows.iter().find(|row| row.id == id).expect("listed")
}

/// Returns the rows that have a closed form, and so an interval.
fn varied() -> impl Iterator<Item = &'static FigureRow> {
    FIGURES.rows.iter().filter(|row| !WITHOUT_CLOSED_FORM.contains(&row.id))
}

#[track_caller]
fn within(id: &str, low: f64, high: f64) {
    let simulated = row(id).simulated;
    assert!((low..=high).contains(&simulated), "figure {id}: {simulated} is not in {low} to {high}");
}

#[test]
fn rows_are_reported_once_in_the_order_of_the_tables() {
    let mut expected = Vec::new();
    let Ok(()) = FIGURES.each_row(|table, row| {
        // Rows of the main table are reported before the closed forms are computed.
        let row = match table {
            FigureTable::Main => FigureRow { interval: None, analytic: None, ..row.clone() },
            _ => row.clone(),
        };
        expected.push((table, row));
        Ok::<_, Infallible>(())
    });
    for (reported, expected) in FIGURES.reported.iter().zip(&expected) {
        assert_eq!(format!("{reported:?}"), format!("{expected:?}"));
    }
    assert_eq!(FIGURES.reported.len(), expected.len());
    assert_eq!(FIGURES.steps[0], FIGURES.steps[1], "each step is reported once");
}

#[test]
fn a_region_is_copied_in_780_us() {
    within("1", 779.9, 780.1);
}

#[test]
fn both_eyes_are_copied_in_31_2_ms() {
    within("2", 31.15, 31.25);
}

#[test]
fn with_copy_as_the_only_limit_the_latency_is_the_three_fields_of_the_theory() {
    within("3", 49.5, 50.5);
}

#[test]
fn a_trivial_stereo_scene_takes_1_percent_more_than_measured() {
    within("4", 56.5, 56.5 * 1.015);
    within("4b", 29.9, 30.0);
}

#[test]
fn with_equal_stage_times_the_machine_keeps_30_hz_and_has_a_latency_of_four_fields() {
    within("5", 66.7 * 0.98, 66.7 * 1.02);
    assert!(row("5").details.iter().any(|d| d.unit == "Hz" && (29.9..30.0).contains(&d.value)));
}

#[test]
fn with_long_stages_the_latency_is_three_transforms_and_one_to_two_copies() {
    within("6", 90.6, 106.2);
}

#[test]
fn application_scenes_have_the_measured_latency_in_fields() {
    for (id, mean, sd) in [("7", 4.61, 0.589), ("7b", 4.47, 0.502), ("7c", 8.13, 2.48)] {
        within(id, mean * 0.95, mean * 1.05);
        let found = row(id).details.iter().find(|detail| detail.name == "standard deviation").expect("listed").value;
        assert!((found / sd - 1.0).abs() < 0.25, "figure {id}: deviation {found}, published {sd}");
    }
}

#[test]
fn the_bins_hold_7_700_triangles_that_cover_the_screen() {
    // Each of the 12 slaves has the same number of triangles: 7,704 is the first multiple of 12 that is not below the
    // published number.
    within("16", 7_700.0, 7_704.0);
    within("16b", 1.5, 2.5);
    within("16c", 293.0 * 0.97, 293.0 * 1.03);
}

#[test]
fn the_triangles_of_the_model_scenes_touch_fewer_than_1_3_regions_on_average() {
    // FIXME(accuracy): the published value is 1.3. The mig alone gives 1.4, and the head gives 1.02.
    within("8", 1.1, 1.25);
}

#[test]
fn slats_always_has_a_latency_of_one_field() {
    within("9", 0.999_999, 1.000_001);
    assert!(row("9").details.iter().all(|d| (d.value - 1.0).abs() < 1e-6), "least and greatest too");
    within("9b", 59.9, 60.0);
}

#[test]
fn twenty_field_regions_take_eleven_region_times_and_ten_field_regions_take_five() {
    within("10", 10.99, 11.01);
    within("11", 3.85, 3.95);
}

#[test]
fn the_limit_used_for_fitting_is_reproduced_exactly() {
    within("14", 100.0, 100.0);
}

#[test]
fn the_code_of_slats_draws_four_triangles_more_than_published_without_the_copy_optimisation() {
    // The published value is 110, to which nothing is fitted.
    within("12", 113.0, 115.0);
}

#[test]
fn the_copy_optimisation_raises_the_limit_by_fourteen_triangles_more_than_published() {
    // FIXME(accuracy): the published value is 140.
    within("13", 157.0, 159.0);
}

#[test]
fn the_first_copy_of_a_full_field_begins_after_about_12_8_ms() {
    within("15", 12.6, 13.0);
}

#[test]
fn with_a_photodiode_low_on_the_screen_the_rig_measures_the_published_latency() {
    // The published range is 54 to 57 ms. The position of the photodiode is not published. Both copies take 31.2 ms.
    // The wait for the retrace is 8.3 ms on average over all phases. A field has 240 lines of 63.6 us.
    let [first, last] = row("17").unprinted.expect("the line is not printed");
    assert!((last - first - 239.0 * 0.063_556).abs() < 0.05, "{first} to {last}");
    assert!(first > 31.2 + 8.3 - 1.0 && first < 54.0 && last > 54.0, "{first} to {last}");
    assert!((first..last).contains(&row("17").simulated) && row("17").is_met);
}

#[test]
fn the_error_at_90_ms_is_1_8_times_the_error_at_50_ms() {
    // The ratio of the latencies, apart from the curvature of the motion within each latency.
    within("18", 1.75, 1.8);
}

#[test]
fn tracker_and_rendering_latencies_equal_the_sum_of_the_measured_parts() {
    for (id, rendering) in [("19", row("4").simulated), ("19b", row("9").simulated * 1001.0 / 60.0)] {
        let of = |name: &str| row(id).details.iter().find(|detail| detail.name == name).expect("listed").value;
        assert!((of("tracking") + of("rendering") - row(id).simulated).abs() < 1e-9, "{id}");
        assert!((of("rendering") / rendering - 1.0).abs() < 0.05, "{id}: {} and {rendering}", of("rendering"));
    }
}

#[test]
fn every_published_row_names_its_source_and_every_missed_row_names_its_cause() {
    for row in &FIGURES.rows {
        assert!(row.source.contains("TR94") || row.source.contains("I3D95"), "{}", row.id);
        assert!(row.is_met || !row.cause.is_empty(), "figure {} misses without a cause", row.id);
    }
}

#[test]
fn the_joint_sample_of_machines_covers_the_values_of_the_presets() {
    // The presets are not part of the sample, so the range of the sample could miss their values.
    for interval in &FIGURES.intervals {
        let [low, high] = interval.joint;
        assert!(
            (low..=high).contains(&interval.nominal),
            "figure {}: {} in {low} to {high}",
            interval.id,
            interval.nominal
        );
    }
}

#[test]
fn simulated_values_are_within_the_analytic_interval_or_3_percent_of_it() {
    // The interval was computed at the other level, so agreement is not trivial.
    for row in varied() {
        let [low, high] = row.interval.expect("every figure with a closed form has one");
        assert!((0.97 * low..=1.03 * high).contains(&row.simulated), "figure {}", row.id);
    }
    for row in WITHOUT_CLOSED_FORM.map(row) {
        assert_eq!(row.analytic, None, "figure {}", row.id);
        match row.interval {
            // The measuring rig also has its photodiode on the first and on the last line of the screen.
            Some([low, high]) if row.id == "17" => assert!(low < row.simulated && row.simulated < high),
            // For runs with a tracker, the depth of the FIFO and the channels of a sender are varied in simulated runs.
            Some([low, high]) => {
                assert!(["19", "19b"].contains(&row.id) && low <= row.simulated && row.simulated <= high)
            }
            None => assert!(["8", "18"].contains(&row.id), "{}: nothing was varied", row.id),
        }
    }
}

#[test]
fn every_figure_is_within_reach_of_some_parameters_and_interpretations() {
    let out_of_reach: Vec<&str> = FIGURES.rows.iter().filter(|row| row.is_out_of_reach()).map(|row| row.id).collect();
    assert_eq!(out_of_reach, [""; 0]);
}

#[test]
fn the_analytic_level_agrees_with_the_transaction_level() {
    // The closed form and the simulation agree within 3 %. Both use the same views of the head, for more than half of
    // the views of figures 7 and 7b.
    let bench = Bench::new(Level::Analytic).with_mig(6, 150);
    for row in varied() {
        let value = bench.measure(row.id).expect("it runs").value;
        assert!((value / row.simulated - 1.0).abs() < 0.03, "figure {}: {value} and {}", row.id, row.simulated);
    }
}

#[test]
fn accuracy_md_equals_the_document_computed_from_the_current_figures() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/ACCURACY.md");
    let kept = std::fs::read_to_string(path).expect("ACCURACY.md is part of the project");
    let alternatives = alternatives_with(&BENCH, |_, _| {}).expect("every experiment runs on its preset");
    assert!(kept == markdown(&FIGURES, &alternatives), "ACCURACY.md is stale: run `pxpl5 figures --write ACCURACY.md`");
}

#[test]
fn with_faces_the_latency_of_a_rotation_is_equal_for_10_and_10_000_triangles() {
    let rows = &FIGURES.families[0].rows;
    let of_e1: Vec<_> = rows.iter().filter(|row| row.experiment == "E1").collect();
    assert_eq!((of_e1[0].id, of_e1[0].simulated), ("A4", 0.0), "picoseconds");
    // These rows differ from the papers by more than the printed digits.
    let missed: Vec<_> = rows.iter().filter(|row| !row.is_met).map(|row| row.id).collect();
    assert_eq!(missed, ["A12", "A12"]);
}
