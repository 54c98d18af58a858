//! The table that `pxpl5 compare` prints on the terminal.

use crate::numbers::{count_of, dash, number};
use crate::terminal::laid_out;
use pxpl5::Cause;
use pxpl5::compare::{Comparison, ComparisonRow, IntervalMethod, MeanInterval};
use std::fmt::Write as _;

/// Name and unit of a column, and its cell in a row.
type Column = (&'static str, &'static str, fn(&ComparisonRow) -> String);

const COLUMNS: [Column; 19] = [
    ("to light", "ms", |row| number(row.head_to_light_ms.mean, 2)),
    ("sd", "ms", |row| number(row.head_to_light_ms.sd, 2)),
    ("95 %", "ms", |row| number(row.head_to_light_percentiles_ms.p95, 2)),
    ("turn", "ms", |row| number(row.turn_to_light_ms.mean, 2)),
    ("figure 19", "ms", |row| number(row.tracking_and_rendering_ms.mean, 2)),
    ("predicts", "ms", |row| number(row.prediction_interval_ms.mean, 2)),
    ("updates", "Hz", |row| number(row.updates_hz.mean, 2)),
    ("not shown", "", |row| {
        row.missed_retraces.zip(row.pictures_due).map_or_else(dash, |(missed, due)| format!("{missed} of {due}"))
    }),
    ("error", "px", |row| number(row.error.mean_px.mean, 2)),
    ("interval", "px", |row| interval(&row.error.mean_px)),
    ("above best", "px", |row| match row.above_best_px {
        Some(above) if above.mean == 0.0 => "best".to_owned(),
        above => above.as_ref().map_or_else(dash, interval),
    }),
    ("50 %", "px", |row| number(row.error.pixels.p50, 2)),
    ("95 %", "px", |row| number(row.error.pixels.p95, 2)),
    ("error", "deg", |row| number(row.error.mean_deg.mean, 2)),
    ("outside", "%", |row| share(row.error.outside_share)),
    ("scene", "%", |row| share(row.covered_share)),
    ("n", "", |row| row.error.n.to_string()),
    (BEST_WITH, "px", |row| {
        row.best_predictor().map_or_else(dash, |best| format!("{} {:.2}", best.kind.name(), best.mean_px))
    }),
    ("triangles", "possible", |row| match row.triangles_possible {
        Some(n) => n.to_string(),
        None if row.has_no_limit => "no limit".to_owned(),
        None => dash(),
    }),
];

const BEST_WITH: &str = "best with";

pub(super) fn text(comparison: &Comparison) -> String {
    let mut text = heading(comparison);
    text.push_str(&rows(comparison));
    text.push_str(&best(comparison));
    text.push_str(&intervals(comparison));
    text.push_str(&imprecise(comparison));
    if comparison.pipelines.iter().any(|row| !row.causes.is_empty()) {
        text.push_str(&causes(comparison));
    }
    text.push_str(
        "\nto light: time from the head's pose until the middle of the picture is lit; turn: the same for an orientation that a display with\n\
         faces reads at scan-out; figure 19: sum of two means as in the papers, from the pose to its report and from an eye's TRANSFORM to\n\
         the swap, without the wait for the pipeline, SEND, EDIT and the scan; predicts: time from the newest measurement to the instant\n\
         for which a picture is drawn; updates: new pictures per second (frameless rendering: passes over all blocks of the screen,\n\
         docs/guide/counted-pictures.md); error: mean over all evaluated pixels, at most the\n\
         picture's diagonal each; interval: range of the mean; above best: range of the difference to the row with the least error, which\n\
         is narrower because both have the same motion; outside: pixels whose content has left the picture; scene: part of the picture\n\
         that the scene covers; n: evaluated pixels; best with (--predictors): the predictor with\n\
         the least error for the first seed; - : no sample was evaluated; ! : some due pictures were not shown, so the error covers only the\n\
         others; + : evaluated from a later field on than the other rows. Rows with a mark are never the best.\n",
    );
    text
}

/// Returns a sentence for each method of confidence intervals. The sentence lists the rows that use the method.
fn intervals(comparison: &Comparison) -> String {
    let confidence = percent(comparison.confidence);
    let mut text = String::new();
    for method in IntervalMethod::ALL {
        let rows = comparison.pipelines.iter().filter(|row| row.was_evaluated() && row.error.mean_px.method == method);
        let names: Vec<&str> = rows.map(|row| row.pipeline.as_str()).collect();
        if !names.is_empty() {
            let _ = writeln!(text, "Intervals of {confidence} %, {}: {}.", method.words(), names.join(", "));
        }
    }
    text
}

/// Converts a share from 0 to 1 into percent. The result is rounded to six decimals, because the product of the share
/// and 100 can have rounding errors.
fn percent(share: f64) -> f64 {
    (share * 1e8).round() / 1e6
}

/// Returns sentences about the number of seeds of each row. The text is empty without the option `--until-precision`.
fn imprecise(comparison: &Comparison) -> String {
    let Some(width) = &comparison.until_precision else { return String::new() };
    let rows = |precise: bool| {
        let rows = comparison
            .pipelines
            .iter()
            .filter(move |row| row.is_precise == Some(precise) && row.error.mean_px.width().is_some());
        rows.map(|row| format!("{} ({})", row.pipeline, count_of(row.seeds, "seed"))).collect::<Vec<_>>().join(", ")
    };
    let mut text = String::new();
    for (precise, is) in [(true, "narrower"), (false, "not narrower")] {
        if !rows(precise).is_empty() {
            let _ = writeln!(text, "Intervals {is} than {width}: {}.", rows(precise));
        }
    }
    if !rows(true).is_empty() {
        text.push_str("Seeds were added until the interval was narrow. It is narrow more often where the mean is too small, by up to 3 %.\n");
    }
    text
}

fn heading(comparison: &Comparison) -> String {
    let Comparison { scene, triangles, machine, boards, fields, seeds, head, hmd, .. } = comparison;
    let head: Vec<String> = head.iter().map(|(key, value)| format!("{key} {value}")).collect();
    format!(
        "{scene} ({}) on {machine} ({}, {}); {}; {}, {}\n{hmd}\n",
        count_of(*triangles, "triangle"),
        count_of(boards[0], "GP"),
        count_of(boards[1], "renderer"),
        head.join(", "),
        count_of(*fields, "field"),
        count_of(seeds.len(), "seed")
    )
}

/// Returns the table. A failed row shows its reason instead of numbers. The column with the best predictor is left out if
/// the comparison ran no predictors.
fn rows(comparison: &Comparison) -> String {
    let has_predictors = comparison.pipelines.iter().any(|row| !row.predictors.is_empty());
    let columns = || COLUMNS.iter().filter(|(name, ..)| has_predictors || *name != BEST_WITH);
    let line = |name: &str, cell: &dyn Fn(&Column) -> String| -> Vec<String> {
        std::iter::once(name.to_owned()).chain(columns().map(cell)).collect()
    };
    let mut lines =
        vec![line("pipeline", &|(name, ..)| (*name).to_owned()), line("", &|(_, unit, _)| (*unit).to_owned())];
    let (ran, failed): (Vec<_>, Vec<_>) = comparison.pipelines.iter().partition(|row| row.failure.is_none());
    lines.extend(ran.into_iter().map(|row| line(&name(comparison, row), &|(_, _, cell)| cell(row))));
    let failed =
        failed.into_iter().map(|row| format!("{}: {}\n", row.pipeline, row.failure.as_deref().unwrap_or_default()));
    format!("\n{}{}", laid_out(&lines, 1), failed.collect::<String>())
}

/// Returns the name of a row, followed by symbols that refer to the remarks below the table.
fn name(comparison: &Comparison, row: &ComparisonRow) -> String {
    let missing = if row.shows_all() { "" } else { "!" };
    let late = if comparison.starts_late(row) { "+" } else { "" };
    format!("{}{missing}{late}", row.pipeline)
}

fn best(comparison: &Comparison) -> String {
    let Some(best) = comparison.best() else {
        return "\nNo row showed every picture that was due.\n".to_owned();
    };
    // References are never the best, even if their error is smaller.
    let references: Vec<&str> =
        comparison.pipelines.iter().filter(|row| !row.is_ranked()).map(|row| row.pipeline.as_str()).collect();
    let without =
        if references.is_empty() { String::new() } else { format!(" (not ranked: {})", references.join(", ")) };
    let least: Vec<String> = comparison
        .least()
        .iter()
        .map(|row| format!("{} {} px", row.pipeline, number(row.error.mean_px.mean, 2)))
        .collect();
    let has_no_interval =
        |row: &ComparisonRow| row.above_best_px.is_some_and(|above| above.mean > 0.0 && above.width().is_none());
    let alike = match best.above_best_px {
        _ if comparison.pipelines.iter().any(has_no_interval) => {
            " (without an interval, for which two seeds are needed, this may be chance)".to_owned()
        }
        Some(_) if least.len() > 1 => format!(" (no difference at {} %)", percent(comparison.confidence)),
        _ => String::new(),
    };
    format!(
        "\nLeast error of the pipelines that showed every picture{without}: {}{alike}; all over the fields from {} on.\n",
        least.join(", "),
        comparison.evaluated_from,
    )
}

fn causes(comparison: &Comparison) -> String {
    let heads = Cause::ALL.iter().map(|cause| cause.name()).chain(["interaction", "all"]);
    let mut lines = vec![std::iter::once("error by cause, px").chain(heads).map(str::to_owned).collect::<Vec<_>>()];
    // Rows without an evaluation have no causes.
    for row in comparison.pipelines.iter().filter(|row| !row.causes.is_empty()) {
        let px = row.causes.iter().map(|share| share.px.mean).chain([row.error.mean_px.mean]);
        lines.push(std::iter::once(row.pipeline.clone()).chain(px.map(|px| number(px, 2))).collect());
    }
    let mut text = format!("\n{}", laid_out(&lines, 1));
    // A wrong prediction interval is no cause of this error, but shows how exact the interval must be.
    let rows = || comparison.pipelines.iter().filter(|row| !row.prediction_interval_errors.is_empty());
    let Some(first) = rows().next() else { return text };
    let heads = first.prediction_interval_errors.iter().map(|one| format!("{:+}", one.later_ms));
    let mut lines = vec![std::iter::once("prediction interval error, ms".to_owned()).chain(heads).collect::<Vec<_>>()];
    lines.extend(rows().map(|row| {
        let px = row.prediction_interval_errors.iter().map(|one| number(one.mean_px, 2));
        std::iter::once(row.pipeline.clone()).chain(px).collect()
    }));
    text.push_str(&format!("\n{}", laid_out(&lines, 1)));
    text
}

fn share(value: Option<f64>) -> String {
    number(value.map_or(f64::NAN, |share| share * 100.0), 1)
}

fn interval(mean: &MeanInterval) -> String {
    if mean.low.is_finite() { format!("{:.2} to {:.2}", mean.low, mean.high) } else { "-".to_owned() }
}
