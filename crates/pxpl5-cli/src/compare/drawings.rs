//! The files of a comparison: tables for other programs, and drawings of what was run.

use pxpl5::compare::{Comparison, ComparisonRow};
use pxpl5::views::charts::{ChartAxes, Curve, MarkedPoint, curve_chart, point_chart};
use pxpl5::views::results::csv_table;

/// Names and contents.
pub(super) fn files(comparison: &Comparison) -> [(&'static str, String); 6] {
    [
        ("rows.csv", rows_csv(comparison)),
        ("errors.csv", errors_csv(comparison)),
        ("error-over-time.svg", over_time(comparison)),
        ("error-distribution.svg", distribution(comparison)),
        ("error-over-latency.svg", over_latency(comparison)),
        ("error-over-prediction.svg", over_prediction(comparison)),
    ]
}

/// The rows of which something was judged.
fn judged(comparison: &Comparison) -> impl Iterator<Item = &ComparisonRow> {
    comparison.pipelines.iter().filter(|row| row.is_judged())
}

fn over_time(comparison: &Comparison) -> String {
    let seed = comparison.seeds.first().copied().unwrap_or_default();
    let axes = axes(comparison, &format!("Error over time, seed {seed}"), "time, s", "mean error over the picture, px");
    curves(comparison, &axes, |row| row.by_field.iter().map(|field| (field.time_s, field.mean_px)).collect())
}

fn distribution(comparison: &Comparison) -> String {
    let axes = axes(comparison, "Distribution of the error", "error, px", "pixels with at most this error, %");
    curves(comparison, &axes, |row| {
        row.error.distribution_px.iter().enumerate().map(|(percent, px)| (*px, percent as f64)).collect()
    })
}

fn curves(comparison: &Comparison, axes: &ChartAxes, points: impl Fn(&ComparisonRow) -> Vec<(f64, f64)>) -> String {
    let curves = judged(comparison).map(|row| Curve { name: row.pipeline.clone(), points: points(row) });
    curve_chart(axes, &curves.collect::<Vec<_>>())
}

fn over_latency(comparison: &Comparison) -> String {
    let axes = axes(
        comparison,
        "Error over latency",
        "mean from head to light, ms",
        "mean error, px (95 % of the seeds' means)",
    );
    points(comparison, &axes, |row| row.head_to_light_ms.mean)
}

fn over_prediction(comparison: &Comparison) -> String {
    let axes = axes(
        comparison,
        "Error over prediction interval",
        "mean from the newest measurement to the instant drawn for, ms",
        "mean error, px (95 % of the seeds' means)",
    );
    points(comparison, &axes, |row| row.prediction_interval_ms.mean)
}

fn points(comparison: &Comparison, axes: &ChartAxes, across: impl Fn(&ComparisonRow) -> f64) -> String {
    let points = judged(comparison).map(|row| {
        let error = &row.error.mean_px;
        MarkedPoint { name: row.pipeline.clone(), at: (across(row), error.mean), interval: (error.low, error.high) }
    });
    point_chart(axes, &points.collect::<Vec<_>>())
}

fn axes(comparison: &Comparison, title: &str, across: &str, up: &str) -> ChartAxes {
    let title = format!("{title}: {} on {}", comparison.scene, comparison.machine);
    ChartAxes { title, across: across.to_owned(), up: up.to_owned() }
}

/// Columns of the table of rows, and what stands in them.
type Column = (&'static str, fn(&ComparisonRow) -> String);

const COLUMNS: [Column; 26] = [
    ("pipeline", |row| row.pipeline.clone()),
    ("settings", |row| row.settings.clone()),
    ("latency_ms_mean", |row| number(row.latency_ms.mean)),
    ("latency_ms_sd", |row| number(row.latency_ms.sd)),
    ("head_to_light_ms_mean", |row| number(row.head_to_light_ms.mean)),
    ("head_to_light_ms_sd", |row| number(row.head_to_light_ms.sd)),
    ("turn_to_light_ms_mean", |row| number(row.turn_to_light_ms.mean)),
    ("turn_to_light_ms_sd", |row| number(row.turn_to_light_ms.sd)),
    ("prediction_interval_ms_mean", |row| number(row.prediction_interval_ms.mean)),
    ("prediction_interval_ms_sd", |row| number(row.prediction_interval_ms.sd)),
    ("updates_hz", |row| number(row.updates_hz.mean)),
    ("not_shown", |row| row.not_shown.to_string()),
    ("due", |row| row.due.to_string()),
    ("best_predictor", |row| row.best_predictor().map_or_else(String::new, |best| best.kind.name().to_owned())),
    ("best_predictor_px", |row| row.best_predictor().map_or_else(String::new, |best| number(best.mean_px))),
    ("late_regions", |row| row.late_regions.to_string()),
    ("error_px_mean", |row| number(row.error.mean_px.mean)),
    ("error_px_low", |row| number(row.error.mean_px.low)),
    ("error_px_high", |row| number(row.error.mean_px.high)),
    ("seeds_judged", |row| row.error.mean_px.n.to_string()),
    ("error_px_p50", |row| number(row.error.pixels.p50)),
    ("error_px_p90", |row| number(row.error.pixels.p90)),
    ("error_px_p99", |row| number(row.error.pixels.p99)),
    ("pixels_judged", |row| row.error.n.to_string()),
    ("triangles_possible", |row| row.triangles_possible.map_or_else(String::new, |n| n.to_string())),
    ("failure", |row| row.failure.clone().unwrap_or_default()),
];

/// A row for each pipeline; the causes of its error are the last columns. What was not judged is empty.
fn rows_csv(comparison: &Comparison) -> String {
    let causes = comparison.pipelines.iter().map(|row| &row.causes).max_by_key(|causes| causes.len());
    let names: Vec<String> = causes
        .into_iter()
        .flatten()
        .map(|share| format!("error_px_by_{}", share.cause.map_or("interaction", pxpl5::Cause::name).replace('-', "_")))
        .collect();
    let columns = COLUMNS.iter().map(|(name, _)| (*name).to_owned()).chain(names.iter().cloned());
    let rows = comparison.pipelines.iter().map(|row| {
        let mut cells: Vec<String> = COLUMNS.iter().map(|(_, value)| value(row)).collect();
        cells.extend(
            (0..names.len()).map(|i| row.causes.get(i).map_or_else(String::new, |share| number(share.px.mean))),
        );
        cells
    });
    csv_table(columns, rows)
}

/// A row for each field of each pipeline, of the first seed.
fn errors_csv(comparison: &Comparison) -> String {
    let rows = judged(comparison).flat_map(|row| {
        row.by_field.iter().map(|field| {
            [
                row.pipeline.clone(),
                field.field.to_string(),
                number(field.time_s),
                number(field.mean_px),
                number(field.centre_px),
            ]
        })
    });
    csv_table(["pipeline", "field", "time_s", "error_px_mean", "error_px_centre"], rows)
}

/// What is no number is empty.
fn number(value: f64) -> String {
    if value.is_finite() { value.to_string() } else { String::new() }
}
