//! Tests of the published figures. The rows have the published sizes, and misses have the recorded ones
//! (FIXME(accuracy)). ACCURACY.md, which explains the causes, must contain the results of these runs.
//!
//! Intervals and other interpretations take minutes, so no test measures them by day. Intervals are then read from
//! ACCURACY.md, which .ci/run compares with new measurements. By night (PXPL5_ALL_CASES), the tests measure them too, and
//! compare all documents.

use crate::support::runs_all_cases;
use pxpl5::figures::{
    AlternativeQuery, Basis, Documents, FigureQuery, FigureRow, FigureSettings, Figures, Varied, all, at_all_levels,
    documents,
};
use pxpl5::{Level, Study, Watcher};
use pxpl5_sim::figures::column::{PUBLISHED, SIMULATED, error};
use std::collections::BTreeSet;
use std::fmt::Display;
use std::ops::Deref;
use std::sync::LazyLock;

static FIGURES: LazyLock<Measured> = LazyLock::new(Measured::all);
static DOCUMENTS: LazyLock<Documents> = LazyLock::new(|| {
    let query = AlternativeQuery { settings: FigureSettings::new(Level::Transaction) };
    documents(&FIGURES, &query.run(&mut ()).expect("every experiment runs on its preset"))
});

/// All figures, and what was reported while they were measured.
struct Measured {
    figures: Figures,
    reports: Reports,
}

#[derive(Default)]
struct Reports {
    /// Reported rows with the titles of their groups, in the order of the reports.
    rows: Vec<(&'static str, String)>,
    /// Numbers of finished steps and of all steps, in the order of the reports.
    steps: Vec<[u64; 2]>,
}

impl Watcher for Reports {
    fn progress(&mut self, done: u64, of: u64) {
        self.steps.push([done, of]);
    }

    fn row(&mut self, table: &'static str, row: &dyn Display) {
        self.rows.push((table, row.to_string()));
    }
}

impl Measured {
    fn all() -> Self {
        let query = FigureQuery {
            settings: FigureSettings::new(Level::Transaction),
            intervals: runs_all_cases(),
            only: Vec::new(),
        };
        let mut reports = Reports::default();
        let figures = query.run(&mut reports).expect("every experiment runs on its preset");
        Self { figures, reports }
    }
}

impl Deref for Measured {
    type Target = Figures;

    fn deref(&self) -> &Figures {
        &self.figures
    }
}

fn row(id: &str) -> &'static FigureRow {
    FIGURES.row(id).expect("listed")
}

/// Returns the cells of a figure's row in ACCURACY.md: number, statement, published, simulated without its unit, error,
/// interval, provenance.
fn committed(id: &str) -> Vec<&'static str> {
    let line = include_str!("../ACCURACY.md").lines().find(|line| line.starts_with(&format!("| {id} |")));
    line.expect("in the table").trim_matches('|').split('|').map(str::trim).collect()
}

fn detail(id: &str, name: &str) -> f64 {
    row(id).details.iter().find(|detail| detail.name == name).expect("listed").value
}

fn by_formula() -> impl Iterator<Item = &'static FigureRow> {
    all().filter(|figure| figure.varied == Varied::ByFormula).map(|figure| row(figure.id))
}

#[track_caller]
fn within(id: &str, low: f64, high: f64) {
    let simulated = row(id).simulated;
    assert!((low..=high).contains(&simulated), "figure {id}: {simulated} is not in {low} to {high}");
}

#[test]
fn rows_are_reported_once_in_the_order_of_the_tables() {
    let rows = FIGURES.groups.iter().flat_map(|group| group.rows.iter().map(|row| (group.title, row)));
    // Rows of Pixel-Planes 5 are reported before their intervals are computed.
    let bare = |row: &FigureRow| FigureRow { interval: None, analytic: None, ..row.clone() }.to_string();
    let expected: Vec<_> = rows.map(|(title, row)| (title, bare(row))).collect();
    assert_eq!(FIGURES.reports.rows, expected);
}

#[test]
fn every_step_is_reported_once() {
    let steps = &FIGURES.reports.steps;
    let all = steps.len() as u64 - 1;
    assert_eq!(*steps, (0..=all).map(|done| [done, all]).collect::<Vec<_>>());
}

#[test]
fn each_figure_has_one_number_a_reason_for_its_provenance_and_a_definition_if_it_is_a_latency() {
    let ids: Vec<&str> = all().map(|figure| figure.id).collect();
    assert_eq!(ids.iter().collect::<BTreeSet<_>>().len(), ids.len(), "{ids:?}");
    for figure in all() {
        let reason = if let Basis::Derived(from) | Basis::Fitted(from) = figure.basis { from } else { figure.reason };
        assert!(!reason.is_empty(), "{} has a provenance without a reason", figure.id);
        let is_latency = figure.unit == "fields" || (figure.unit == "ms" && figure.section == "Rendering Control");
        // Times of copies and of polls, and the rates of trackers, are no latencies of a picture.
        let is_defined = is_latency && !["2", "T1"].contains(&figure.id) || figure.id.starts_with("19");
        assert_eq!(figure.latency.is_some(), is_defined, "{}", figure.id);
    }
}

/// Rows that a choice decides, which was made by comparison with figures, are no free checks: samples of each eye (4, 7),
/// the frame (6), machine and culling (7), and a clump's buffer (13).
#[test]
fn rows_that_follow_from_choices_inputs_or_other_rows_are_not_free() {
    let of = |wanted: fn(Basis) -> bool| {
        all().filter(|figure| wanted(figure.basis)).map(|figure| figure.id).collect::<Vec<_>>()
    };
    assert_eq!(of(|basis| matches!(basis, Basis::Interpretation(_))), ["4", "6", "7", "7b", "7c", "12", "13"]);
    let derived =
        ["2", "4b", "17b", "9", "9b", "15", "18", "19", "19b", "R7", "J1", "J1b", "J2", "J2b", "J3", "J5", "T1"];
    assert_eq!(of(|basis| matches!(basis, Basis::Derived(_))), derived);
    assert_eq!(of(|basis| matches!(basis, Basis::Fitted(_))), ["1", "16", "14"]);
    assert_eq!(of(|basis| matches!(basis, Basis::Rule(_))), ["16b", "16c", "10", "11"]);
}

#[test]
fn figures_have_the_published_sizes_or_the_recorded_misses() {
    for (id, low, high) in [
        // A region of 780 us, both eyes in 31.2 ms, and three fields with COPY as the only limit.
        ("1", 779.999, 780.001),
        ("2", 31.15, 31.25),
        ("3", 3.0 * 1001.0 / 60.0 - 0.3, 3.0 * 1001.0 / 60.0 + 0.3),
        // FIXME(accuracy): the published value is 56.5. By TR94's rules, TRANSFORM begins while two eyes wait for COPY.
        ("4", 56.5 * 1.052, 56.5 * 1.062),
        ("4b", 29.969, 29.971),
        // FIXME(accuracy): the published value is 90.6 to 106.2, from one to two copies more. COPY begins during RENDER.
        ("6", 75.0, 90.6),
        // FIXME(accuracy): the published value is 1.3. The mig alone gives 1.4, and the head gives 1.02.
        ("8", 1.1, 1.25),
        ("9", 0.999_999, 1.000_001),
        ("9b", 59.939, 59.941),
        // At each end of twenty copies, one board idles for a region. The changes between renderers take less than 2 us.
        ("10", 11.0, 11.0026),
        ("11", 3.8985, 3.9015),
        // FIXME(accuracy): the published value is 140. With a FIFO for a whole message, a clump waits less.
        ("13", 140.001, f64::INFINITY),
        // The limit to which the time of a triangle was fitted.
        ("14", 100.0, 100.0),
        ("15", 12.6, 13.0),
        // Each of the 12 slaves has the same number of triangles: 7,704 is the first multiple of 12 that is not below
        // the published number.
        ("16", 7_700.0, 7_704.0),
        ("16b", 1.5, 2.5),
        ("16c", 293.0 * 0.97, 293.0 * 1.03),
        // The ratio of the latencies, apart from the curvature of the motion within each latency.
        ("18", 1.75, 1.8),
    ] {
        within(id, low, high);
    }
}

#[test]
fn with_equal_stage_times_the_machine_keeps_30_hz_and_has_a_latency_of_nearly_four_fields() {
    // FIXME(accuracy): the published greatest value is four fields, 66.7. COPY begins with the first finished region.
    within("5", 64.0, 66.7 * 0.97);
    assert!(row("5").details.iter().any(|d| d.unit == "Hz" && (29.9..30.0).contains(&d.value)));
}

#[test]
fn application_scenes_have_the_measured_latency_in_whole_fields_and_about_a_field_less_in_exact_ones() {
    for (id, mean, sd) in [("7", 4.61, 0.589), ("7b", 4.47, 0.502), ("7c", 8.13, 2.48)] {
        let whole = detail(id, "whole retraces");
        assert!((whole / mean - 1.0).abs() < 0.06, "figure {id}: {whole} retraces");
        // FIXME(accuracy): exact fields are what TR94's own conversions ask for.
        within(id, mean - 1.2, mean - 0.5);
        let found = detail(id, "their deviation");
        assert!((found / sd - 1.0).abs() < 0.25, "figure {id}: deviation {found}, published {sd}");
    }
}

#[test]
fn slats_always_has_a_latency_of_one_field() {
    for name in ["least", "greatest"] {
        assert!((detail("9", name) - 1.0).abs() < 1e-6, "{name}");
    }
}

#[test]
fn the_rig_measures_the_published_latency_only_with_a_photodiode_low_on_the_screen() {
    // The published range is 54 to 57 ms. The position of the photodiode is not published. Both copies take 31.2 ms.
    // The wait for the retrace is 8.3 ms on average over all phases. A field has 240 lines of 63.6 us.
    let [first, last] = row("17").unprinted.expect("the line is not printed");
    assert!((last - first - 239.0 * 0.063_556).abs() < 0.05, "{first} to {last}");
    assert!(first > 31.2 + 8.3 - 1.0 && first < 54.0 && last > 54.0, "{first} to {last}");
    // FIXME(accuracy): the middle of the screen is assumed, and it misses the range.
    assert!((first..last).contains(&row("17").simulated) && !row("17").is_met);
}

/// I3D95 found the same range inside. The model's full pipeline is slower than a frame on demand.
#[test]
fn the_measurement_from_inside_is_that_of_the_trivial_scene() {
    assert_eq!(row("17b").simulated, row("4").simulated);
    assert!(detail("17b", "outside less inside") < 0.0);
    assert_eq!(detail("17b", "outside, on demand"), row("17").simulated);
}

#[test]
fn tracker_and_rendering_latencies_equal_the_sum_of_the_measured_parts() {
    for (id, rendering) in [("19", row("4").simulated), ("19b", row("9").simulated * 1001.0 / 60.0)] {
        let of = |name: &str| detail(id, name);
        assert!((of("tracking") + of("rendering") - row(id).simulated).abs() < 1e-9, "{id}");
        assert!((of("rendering") / rendering - 1.0).abs() < 0.05, "{id}: {} and {rendering}", of("rendering"));
    }
}

#[test]
fn every_missed_row_names_its_cause() {
    for row in FIGURES.rows() {
        assert!(!row.source.is_empty() && !row.experiment.is_empty(), "{}", row.id);
        assert!(row.is_met || !row.cause.is_empty(), "figure {} misses without a cause", row.id);
    }
}

#[test]
fn the_joint_sample_of_machines_covers_the_values_of_the_presets() {
    // The presets are not part of the sample, so the range of the sample could miss their values.
    assert_eq!(FIGURES.intervals.is_empty(), !runs_all_cases());
    for interval in &FIGURES.intervals {
        let [low, high] = interval.joint;
        assert!((low..=high).contains(&interval.nominal), "figure {}: {}", interval.id, interval.nominal);
    }
}

#[test]
fn simulated_values_are_within_the_interval_or_3_percent_of_it() {
    for figure in all() {
        let Some((low, high)) = committed(figure.id)[5].split_once(" to ") else {
            assert_eq!((figure.varied, committed(figure.id)[5]), (Varied::Nothing, "-"), "figure {}", figure.id);
            continue;
        };
        // The interval of a formula was computed at another level, so agreement is not trivial.
        let is_formula = figure.varied == Varied::ByFormula;
        assert_eq!(row(figure.id).analytic.is_some(), is_formula && runs_all_cases(), "figure {}", figure.id);
        let [low, high] =
            [low, high.trim_end_matches(", **out of reach**")].map(|end| end.parse::<f64>().expect("a number"));
        within(figure.id, 0.97 * low, 1.03 * high);
    }
}

#[test]
fn all_figures_of_rendering_control_and_slats_but_two_are_within_reach_of_some_parameters_and_interpretations() {
    let out_of_reach = at_all_levels().map(|figure| figure.id).filter(|id| committed(id)[5].contains("out of reach"));
    // FIXME(accuracy): COPY begins during RENDER (6), and a stage is missing if fields are exact (7).
    assert_eq!(out_of_reach.collect::<Vec<_>>(), ["6", "7"]);
}

#[test]
fn the_analytic_level_agrees_with_the_transaction_level() {
    let settings = FigureSettings::new(Level::Analytic).with_mig(6, 150);
    for row in by_formula() {
        let value = settings.measure(row.id).expect("it runs").value;
        assert!((value / row.simulated - 1.0).abs() < 0.04, "figure {}: {value} and {}", row.id, row.simulated);
    }
}

#[test]
fn the_rows_of_accuracy_md_have_the_current_results() {
    for figure in all() {
        let row = row(figure.id);
        let cells = committed(figure.id);
        let simulated = SIMULATED.1(row).replacen(&format!(" {}", row.unit), "", 1);
        assert_eq!([cells[2], cells[3]], [PUBLISHED.1(row).trim_end(), &simulated], "figure {}", figure.id);
        assert_eq!(cells[4].trim_end_matches(" **miss**"), error(row), "figure {}", figure.id);
        assert_eq!(cells[4].ends_with("**miss**"), !row.is_met, "figure {}", figure.id);
    }
    // The bars of tables are no words.
    let words = include_str!("../ACCURACY.md").split_whitespace().filter(|word| word.contains(char::is_alphanumeric));
    let words = words.count();
    assert!(words <= 3_000, "ACCURACY.md has {words} words, and is to be read at once");
}

/// By day, .ci/run compares the documents.
#[test]
fn the_documents_equal_those_computed_from_the_current_figures() {
    if !runs_all_cases() {
        return;
    }
    let read = |path: &str| {
        std::fs::read_to_string(format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))).expect("part of the project")
    };
    let numerics = read("docs/numerics.md");
    for (path, text) in [
        ("ACCURACY.md", &DOCUMENTS.accuracy),
        ("docs/interpretations.md", &DOCUMENTS.interpretations),
        ("docs/numerics.md", &DOCUMENTS.with_time(&numerics)),
    ] {
        assert!(read(path) == *text, "{path} is stale: run `pxpl5 figures --write ACCURACY.md --pages docs`");
    }
}

#[test]
fn with_faces_the_latency_of_a_rotation_is_equal_for_10_and_10_000_triangles() {
    let rows = &FIGURES.groups.last().expect("address recalculation").rows;
    let of_e1: Vec<_> = rows.iter().filter(|row| row.experiment == "E1").collect();
    assert_eq!((of_e1[0].id, of_e1[0].simulated), ("A4", 0.0), "picoseconds");
    // The rows A12 differ from the papers by more than the printed digits.
    // FIXME(accuracy): the curve of fig. 1 rises everywhere. From 100 to 1,000 triangles, latency falls by 6 us.
    let missed: Vec<_> = rows.iter().filter(|row| !row.is_met).map(|row| row.id).collect();
    assert_eq!(missed, ["fig. 1", "A12", "A12"]);
    let growth = rows.iter().find(|row| row.id == "fig. 1").expect("listed").simulated;
    assert!(growth > 0.5 * 16.683, "at least one of both eyes is shown a field later: {growth} ms");
}
