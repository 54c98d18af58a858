//! Writer of the CSV tables and SVG charts of a comparison.

use pxpl5::compare::{Comparison, ComparisonRow};
use pxpl5::views::charts::{ChartAxes, ChartPoint, ChartSeries, curve_chart};
use pxpl5::views::results::{csv_of, csv_table};

pub(super) fn files(comparison: &Comparison) -> [(&'static str, String); 6] {
    [
        ("rows.csv", csv_of(&comparison.pipelines)),
        ("errors.csv", errors_csv(comparison)),
        ("error-over-time.svg", over_time(comparison)),
        ("error-distribution.svg", distribution(comparison)),
        ("error-over-latency.svg", over_latency(comparison)),
        ("error-over-prediction.svg", over_prediction(comparison)),
    ]
}

/// Returns the rows of pipelines with at least one evaluated pixel.
fn evaluated(comparison: &Comparison) -> impl Iterator<Item = &ComparisonRow> {
    comparison.pipelines.iter().filter(|row| row.was_evaluated())
}

fn over_time(comparison: &Comparison) -> String {
    let axes = axes(comparison, "Error over time, first motion", "time, s", "mean error over the picture, px");
    curves(comparison, axes, |row| row.by_field.iter().map(|field| (field.time_s, field.mean_px)).collect())
}

fn distribution(comparison: &Comparison) -> String {
    let axes = axes(comparison, "Distribution of the error", "error, px", "pixels with at most this error, %");
    curves(comparison, axes, |row| {
        row.error.distribution_px.iter().enumerate().map(|(percent, px)| (*px, percent as f64)).collect()
    })
}

fn curves(comparison: &Comparison, axes: ChartAxes, points: impl Fn(&ComparisonRow) -> Vec<(f64, f64)>) -> String {
    let curves = evaluated(comparison).map(|row| ChartSeries::line(&row.pipeline, &points(row)));
    curve_chart(axes, curves.collect())
}

fn over_latency(comparison: &Comparison) -> String {
    let axes = axes(
        comparison,
        "Error over latency",
        "mean from head to light, ms",
        "mean error, px (with interval; hollow: pictures not shown)",
    );
    points(comparison, axes, |row| row.head_to_light_ms.mean)
}

fn over_prediction(comparison: &Comparison) -> String {
    let axes = axes(
        comparison,
        "Error over prediction interval",
        "mean prediction interval, ms",
        "mean error, px (with interval; hollow: pictures not shown)",
    );
    points(comparison, axes, |row| row.prediction_interval_ms.mean)
}

fn points(comparison: &Comparison, axes: ChartAxes, across: impl Fn(&ComparisonRow) -> f64) -> String {
    // Rows without a latency, such as the reference, are not drawn.
    let placed = evaluated(comparison).filter(|row| across(row).is_finite());
    let points = placed.map(|row| {
        let error = &row.error.mean_px;
        let (at, interval, is_hollow) = ((across(row), error.mean), (error.low, error.high), !row.shows_all());
        let name = if is_hollow { format!("{} (not all shown)", row.pipeline) } else { row.pipeline.clone() };
        ChartSeries::point(&name, ChartPoint { at, interval, is_hollow })
    });
    curve_chart(axes, points.collect())
}

fn axes(comparison: &Comparison, title: &str, across: &str, up: &str) -> ChartAxes {
    let title = format!("{title}: {} on {}", comparison.scene, comparison.machine);
    ChartAxes { title, across: across.to_owned(), up: up.to_owned() }
}

/// Returns the text of errors.csv. Each line holds the errors of one pipeline in one display field, for the first seed.
fn errors_csv(comparison: &Comparison) -> String {
    let rows = evaluated(comparison).flat_map(|row| {
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

fn number(value: f64) -> String {
    if value.is_finite() { value.to_string() } else { String::new() }
}
