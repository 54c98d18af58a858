//! The published figures and the simulated values as a Markdown document. Its text is in document.md.in, whose marks
//! are replaced by numbers and rows of tables.

use super::definitions::{SEGMENTS, definitions};
use super::experiments::{CellFit, EXPERIMENT_FRAMES, Experiments, NamedWalk, SizeLimit, SlowRendererResult};
use super::fit::RATES_HZ;
use super::interpretations::{Interpretations, LeftOutRate, RankedRules, ThresholdRow, Tried};
use super::row::verdict;
use super::rules::Rules;
use crate::pictures::OF_FIGURES;
use address_recalculation::priority::PriorityTiming;
use pxpl5_sim::figures::column::{NUMBER, error};
use pxpl5_sim::figures::four;
use pxpl5_sim::figures::{self, Basis, Definition, FigureRow, TableColumn, filled, lines};
use std::fmt::Write as _;

/// Returns the text of docs/address-recalculation.md: the rows with the provenance of each number, then the detailed
/// tables.
pub fn markdown(all: &Experiments, rows: &[FigureRow]) -> String {
    let shapes = |is_shape: bool| rows.iter().filter(move |row| (row.basis == Basis::Shape) == is_shape);
    let met = |is_shape: bool| shapes(is_shape).filter(|row| row.is_met).count().to_string();
    let [cut, uncut] = SEGMENTS.map(|segments| segments.map(|count| count as f64));
    let ours = [0, 2].map(|walk: usize| {
        let memories = all.walks[walk].report.memories.iter();
        memories.map(|memory| memory.segments).collect::<Vec<f64>>()
    });
    // Mean number of draws per second that a section needs at the printed rates.
    let per_section = |segments: &[f64]| {
        let draws: f64 = segments.iter().zip(RATES_HZ).map(|(segments, rate)| segments * rate).sum();
        draws / sum(segments)
    };
    let usual = all.interpretations.usual();
    let [with, without] = [per_section(&cut), per_section(&uncut)];
    filled(
        include_str!("document.md.in"),
        &[
            ("frames", EXPERIMENT_FRAMES.to_string()),
            ("met", met(false)),
            ("numbers", shapes(false).count().to_string()),
            ("shapes", shapes(true).count().to_string()),
            ("shown", met(true)),
            ("rows", table(rows)),
            ("missed", missed(rows)),
            ("definitions", figures::table(&DEFINITIONS, definitions().iter().filter(|one| one.id.starts_with('A')))),
            ("published_rates", rates(&RATES_HZ)),
            ("fits", fits(all)),
            ("best", best(&all.interpretations)),
            ("usual", Rules::USUAL.text()),
            ("rank", usual.map_or_else(String::new, |(rank, _)| rank.to_string())),
            (
                "usual_left_out",
                usual.map_or_else(String::new, |(_, rules)| format!("{:.1}", rules.mean_left_out_percent)),
            ),
            ("usual_error", usual.map_or_else(String::new, |(_, rules)| format!("{:.1}", rules.mean_error_percent))),
            ("cell", format!("{:.1}", all.fits[0].cell_m)),
            ("product", format!("{:.2}", all.fits[0].cell_m * PriorityTiming::PAPERS.theta_deg)),
            ("thresholds", thresholds(all)),
            ("segments", all.segments.to_string()),
            ("walks", lines(all.walks.iter().map(walk))),
            ("sum_cut", sum(&cut).to_string()),
            ("sum_uncut", sum(&uncut).to_string()),
            ("missing", format!("{:.0}", sum(&uncut) - sum(&cut))),
            ("our_sum_cut", format!("{:.0}", sum(&ours[0]))),
            ("our_sum_uncut", format!("{:.0}", sum(&ours[1]))),
            ("draws_cut", format!("{with:.1}")),
            ("draws_uncut", format!("{without:.1}")),
            ("saving", format!("{:.1}", 100.0 * (1.0 - with / without))),
            ("slowed", slowed(all)),
            ("size_limits", size_limits(&all.size_limits)),
            ("bend", format!("{:.1}", all.lens_px[0])),
            ("bend_seen", format!("{:.2}", all.lens_px[1])),
            ("pictures", lines(OF_FIGURES.map(|(id, figures, names)| [id.into(), figures.into(), names.join(", ")]))),
        ],
    )
}

fn sum(numbers: &[f64]) -> f64 {
    numbers.iter().sum()
}

const COLUMNS: [TableColumn<FigureRow>; 7] = [
    ("", |row| row.experiment.to_owned()),
    NUMBER,
    ("statement", |row| row.statement.to_string()),
    ("published", |row| with_unit(row.published, row.unit)),
    ("ours", |row| four(row.simulated)),
    ("error", |row| match verdict(row) {
        "met" | "shape" => error(row),
        verdict => format!("{} {verdict}", error(row)),
    }),
    ("provenance", |row| match row.basis {
        Basis::Free => "checked".to_owned(),
        Basis::Shape => "shape".to_owned(),
        basis => basis.name().to_owned(),
    }),
];

const DEFINITIONS: [TableColumn<Definition>; 3] = [
    ("#", |one| one.id.to_owned()),
    ("what", |one| one.statement.to_string()),
    ("value", |one| with_unit(one.value, one.unit)),
];

/// Formats a number with its unit. A pure number has the unit 1, and a missing one none.
fn with_unit(value: f64, unit: &str) -> String {
    if unit == "1" || value.is_nan() { four(value) } else { format!("{} {unit}", four(value)) }
}

/// Returns the figures as a Markdown table.
pub fn table(rows: &[FigureRow]) -> String {
    figures::table(&COLUMNS, rows)
}

/// Returns as a Markdown list the rows whose simulated numbers miss the published numbers, with their known causes.
pub fn missed(rows: &[FigureRow]) -> String {
    let mut text = String::new();
    let mut causes: Vec<&str> = Vec::new();
    for row in rows.iter().filter(|row| !row.is_met) {
        let [published, simulated] = [row.published, row.simulated].map(four);
        let _ = writeln!(text, "- **{}** {}: {published} {}, ours {simulated}.\n", row.id, row.statement, row.unit);
        // Rows with the same cause share its sentences.
        let cause = row.cause_or_unknown();
        if !causes.contains(&cause) {
            causes.push(cause);
        }
    }
    text + &causes.join(" ")
}

fn joined(numbers: impl IntoIterator<Item = f64>, decimals: usize) -> String {
    numbers.into_iter().map(|number| format!("{number:.decimals$}")).collect::<Vec<_>>().join(", ")
}

fn rates(rates_hz: &[f64]) -> String {
    joined(rates_hz.iter().copied(), 2)
}

/// Returns the fitted cells with the relative errors of the update rates of display memories 1 to 3.
fn fits(all: &Experiments) -> String {
    lines(all.fits.iter().map(|CellFit { rules, cell_m, rates_hz }| {
        let error = |memory: usize| format!("{:+.1} %", 100.0 * (rates_hz[memory] / RATES_HZ[memory] - 1.0));
        [rules.text(), format!("{cell_m:.1} m"), rates(rates_hz), [1, 2, 3].map(error).join(", ")]
    }))
}

/// Returns the interpretations of table 1 of the paper CPR05 (update rates) as Markdown, ranked by their error.
pub fn interpretations(all: &Interpretations) -> String {
    let ranked = lines(all.ranked.iter().map(ranked));
    filled(include_str!("interpretations.md.in"), &[("ranked", ranked), ("best", best(all))])
}

/// Returns two results as Markdown: the best fit of one set of rules to all update rates, and the prediction of each
/// rate by a fit to the other rates.
fn best(all: &Interpretations) -> String {
    let every = all.ranked.iter().flat_map(|ranked| &ranked.tried);
    let best = every.min_by(|a, b| a.error_percent.total_cmp(&b.error_percent));
    let of_best = |text: fn(&Tried) -> String| best.map_or_else(String::new, text);
    filled(
        include_str!("best.md.in"),
        &[
            ("best_rules", of_best(|best| best.rules.text())),
            ("best_path", of_best(|best| best.situation.text().to_owned())),
            ("best_side", of_best(|best| format!("{:.2}", best.best.cell_m))),
            ("best_rates", of_best(|best| rates(&best.best.rates_hz))),
            ("best_error", of_best(|best| format!("{:.1}", best.error_percent))),
            ("left_out", lines(all.left_out.iter().map(left_out))),
        ],
    )
}

fn ranked(ranked: &RankedRules) -> [String; 4] {
    let RankedRules { rules, mean_error_percent, mean_left_out_percent, tried } = ranked;
    let each = tried.iter().map(|tried| format!("{:.1} % ({:.1} m)", tried.error_percent, tried.best.cell_m));
    let mark = if *rules == Rules::USUAL { "**" } else { "" };
    [
        format!("{mark}{}{mark}", rules.text()),
        format!("{mean_error_percent:.1} %"),
        format!("{mean_left_out_percent:.1} %"),
        each.collect::<Vec<_>>().join(" | "),
    ]
}

fn left_out(rate: &LeftOutRate) -> [String; 4] {
    let LeftOutRate { memory, rules, situation, trial, error_percent } = rate;
    [
        memory.to_string(),
        format!("{:.2} Hz", trial.rates_hz[*memory]),
        format!("{error_percent:+.1} %"),
        format!("{}; {}; {:.2} m", rules.text(), situation.text(), trial.cell_m),
    ]
}

fn thresholds(all: &Experiments) -> String {
    lines(all.thresholds.iter().map(|ThresholdRow { threshold, theta_deg, cell_m, at_once_px, frame_late_px }| {
        [
            (*threshold).to_owned(),
            format!("{theta_deg:.3}"),
            format!("{cell_m:.2} m"),
            format!("{:.0} m", 8.0 * cell_m),
            format!("{at_once_px:.1} px"),
            format!("{frame_late_px:.1} px"),
        ]
    }))
}

fn walk(walked: &NamedWalk) -> [String; 6] {
    let report = &walked.report;
    let tears = report.tears_texels.after.map_or_else(
        || "none".to_owned(),
        |tears| format!("{}, {}, {}", texels(tears.p50), texels(tears.p95), texels(tears.max)),
    );
    [
        walked.name.to_owned(),
        joined(report.memories.iter().map(|memory| memory.updates_hz), 2),
        format!("{:.0}", report.priority.draws_per_s),
        format!("{:.1} %", report.priority.saved_percent),
        tears,
        report.tears_texels.stretch.map_or_else(|| "-".to_owned(), |stretch| texels(stretch.max)),
    ]
}

/// Formats the width of a tear (gap between two memories) in texels. Widths below a millionth of a texel are rounding
/// errors and count as 0.
fn texels(width: f64) -> String {
    if width < 1e-6 { "0".to_owned() } else { format!("{width:.2}") }
}

fn slowed(all: &Experiments) -> String {
    lines(all.slowed.iter().map(|SlowRendererResult { triangles_per_s, rates_hz, missed }| {
        let missed: Vec<String> = missed.iter().map(u64::to_string).collect();
        [format!("{triangles_per_s:.0}"), joined(rates_hz.iter().copied(), 1), missed.join(", ")]
    }))
}

fn size_limits(limits: &[SizeLimit]) -> String {
    lines(limits.iter().map(|SizeLimit { angle, of_middle, of_nearest, .. }| {
        [angle.to_string(), format!("{of_middle:.2}"), format!("{of_nearest:.2}")]
    }))
}
