//! Writer of the CSV tables and SVG charts of a comparison.

use pxpl5::Cause;
use pxpl5::compare::{Comparison, ComparisonRow};
use pxpl5::tracking::predict::PredictorKind;
use pxpl5::views::charts::{ChartAxes, Curve, MarkedPoint, curve_chart, point_chart};
use pxpl5::views::results::csv_table;
use serde_json::Value;

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

/// Returns the rows of pipelines with at least one evaluated pixel.
fn evaluated(comparison: &Comparison) -> impl Iterator<Item = &ComparisonRow> {
    comparison.pipelines.iter().filter(|row| row.was_evaluated())
}

fn over_time(comparison: &Comparison) -> String {
    let axes = axes(comparison, "Error over time, first motion", "time, s", "mean error over the picture, px");
    curves(comparison, &axes, |row| row.by_field.iter().map(|field| (field.time_s, field.mean_px)).collect())
}

fn distribution(comparison: &Comparison) -> String {
    let axes = axes(comparison, "Distribution of the error", "error, px", "pixels with at most this error, %");
    curves(comparison, &axes, |row| {
        row.error.distribution_px.iter().enumerate().map(|(percent, px)| (*px, percent as f64)).collect()
    })
}

fn curves(comparison: &Comparison, axes: &ChartAxes, points: impl Fn(&ComparisonRow) -> Vec<(f64, f64)>) -> String {
    let curves = evaluated(comparison).map(|row| Curve { name: row.pipeline.clone(), points: points(row) });
    curve_chart(axes, &curves.collect::<Vec<_>>())
}

fn over_latency(comparison: &Comparison) -> String {
    let axes = axes(
        comparison,
        "Error over latency",
        "mean from head to light, ms",
        "mean error, px (with interval; hollow: pictures not shown)",
    );
    points(comparison, &axes, |row| row.head_to_light_ms.mean)
}

fn over_prediction(comparison: &Comparison) -> String {
    let axes = axes(
        comparison,
        "Error over prediction interval",
        "mean prediction interval, ms",
        "mean error, px (with interval; hollow: pictures not shown)",
    );
    points(comparison, &axes, |row| row.prediction_interval_ms.mean)
}

fn points(comparison: &Comparison, axes: &ChartAxes, across: impl Fn(&ComparisonRow) -> f64) -> String {
    // Rows without a latency, such as the reference, are not drawn.
    let placed = evaluated(comparison).filter(|row| across(row).is_finite());
    let points = placed.map(|row| {
        let error = &row.error.mean_px;
        MarkedPoint {
            name: if row.shows_all() { row.pipeline.clone() } else { format!("{} (not all shown)", row.pipeline) },
            at: (across(row), error.mean),
            interval: (error.low, error.high),
            is_hollow: !row.shows_all(),
        }
    });
    point_chart(axes, &points.collect::<Vec<_>>())
}

fn axes(comparison: &Comparison, title: &str, across: &str, up: &str) -> ChartAxes {
    let title = format!("{title}: {} on {}", comparison.scene, comparison.machine);
    ChartAxes { title, across: across.to_owned(), up: up.to_owned() }
}

type Column = (&'static str, fn(&ComparisonRow) -> String);

const COLUMNS: [Column; 36] = [
    ("pipeline", |row| row.pipeline.clone()),
    ("settings", |row| row.settings.clone()),
    ("latency_ms.mean", |row| number(row.latency_ms.mean)),
    ("latency_ms.sd", |row| number(row.latency_ms.sd)),
    ("head_to_light_ms.mean", |row| number(row.head_to_light_ms.mean)),
    ("head_to_light_ms.sd", |row| number(row.head_to_light_ms.sd)),
    ("head_to_light_percentiles_ms.p50", |row| number(row.head_to_light_percentiles_ms.p50)),
    ("head_to_light_percentiles_ms.p95", |row| number(row.head_to_light_percentiles_ms.p95)),
    ("head_to_light_percentiles_ms.p99", |row| number(row.head_to_light_percentiles_ms.p99)),
    ("turn_to_light_ms.mean", |row| number(row.turn_to_light_ms.mean)),
    ("turn_to_light_ms.sd", |row| number(row.turn_to_light_ms.sd)),
    ("tracking_and_rendering_ms.mean", |row| number(row.tracking_and_rendering_ms.mean)),
    ("prediction_interval_ms.mean", |row| number(row.prediction_interval_ms.mean)),
    ("prediction_interval_ms.sd", |row| number(row.prediction_interval_ms.sd)),
    ("updates_hz.mean", |row| number(row.updates_hz.mean)),
    ("not_shown", |row| count(row.not_shown)),
    ("due", |row| count(row.due)),
    ("late_regions", |row| count(row.late_regions)),
    ("error.mean_px.mean", |row| number(row.error.mean_px.mean)),
    ("error.mean_px.low", |row| number(row.error.mean_px.low)),
    ("error.mean_px.high", |row| number(row.error.mean_px.high)),
    ("error.mean_px.n", |row| row.error.mean_px.n.to_string()),
    ("error.mean_px.method", |row| written(serde_json::to_value(row.error.mean_px.method))),
    ("error.pixels.p50", |row| number(row.error.pixels.p50)),
    ("error.pixels.p90", |row| number(row.error.pixels.p90)),
    ("error.pixels.p95", |row| number(row.error.pixels.p95)),
    ("above_best_px.low", |row| number(row.above_best_px.map_or(f64::NAN, |above| above.low))),
    ("above_best_px.high", |row| number(row.above_best_px.map_or(f64::NAN, |above| above.high))),
    ("error.outside_share", |row| number(row.error.outside_share.unwrap_or(f64::NAN))),
    ("covered_share", |row| number(row.covered_share.unwrap_or(f64::NAN))),
    ("error.pixels.p99", |row| number(row.error.pixels.p99)),
    ("error.n", |row| row.error.n.to_string()),
    ("seeds", |row| row.seeds.to_string()),
    ("triangles_possible", |row| row.triangles_possible.map_or_else(String::new, |n| n.to_string())),
    ("has_no_limit", |row| row.has_no_limit.to_string()),
    ("failure", |row| row.failure.clone().unwrap_or_default()),
];

/// Returns the text of rows.csv, with one line for each pipeline. The columns have the names of comparison.json. The
/// last columns hold the error under each predictor and by each cause. A cell is empty if no pixels were evaluated, or
/// if the comparison did not include predictors or causes.
fn rows_csv(comparison: &Comparison) -> String {
    let causes: Vec<Option<Cause>> = Cause::ALL.into_iter().map(Some).chain([None]).collect();
    // Names of columns equal the JSON paths of the same numbers.
    let of_predictors =
        PredictorKind::ALL.map(|kind| format!("predictors.{}.mean_px", written(serde_json::to_value(kind))));
    let of_causes = causes.iter().map(|cause| {
        let cause = cause.map_or_else(|| "interaction".to_owned(), |cause| written(serde_json::to_value(cause)));
        format!("causes.{cause}.px.mean")
    });
    let columns = COLUMNS.iter().map(|(name, _)| (*name).to_owned()).chain(of_predictors).chain(of_causes);
    // Numbers that a row lacks become empty cells.
    let rows = comparison.pipelines.iter().map(|row| {
        let predictor =
            |kind: PredictorKind| row.predictors.iter().find(|mean| mean.kind == kind).map(|mean| mean.mean_px);
        let cause =
            |cause: &Option<Cause>| row.causes.iter().find(|share| share.cause == *cause).map(|share| share.px.mean);
        let numbers = PredictorKind::ALL.into_iter().map(predictor).chain(causes.iter().map(cause));
        let numbers = numbers.map(|value| value.map_or_else(String::new, number));
        COLUMNS.iter().map(|(_, value)| value(row)).chain(numbers).collect::<Vec<String>>()
    });
    csv_table(columns.collect::<Vec<String>>(), rows)
}

fn written(name: serde_json::Result<Value>) -> String {
    name.ok().and_then(|name| name.as_str().map(str::to_owned)).unwrap_or_default()
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

fn count(value: Option<impl ToString>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

fn number(value: f64) -> String {
    if value.is_finite() { value.to_string() } else { String::new() }
}
