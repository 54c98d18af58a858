//! Writer of ACCURACY.md and docs/interpretations.md: the texts are Markdown files with marks, which the writer replaces
//! by tables and numbers.

use super::Interpretation;
use super::value::{EARLIER, LATER, WHOLE};
use super::{
    Alternatives, Basis, Effect, FigureGroup, FigureRow, Figures, Headline, MISS_PERCENT, Measurement, TOPICS, all,
    has_file,
};
use crate::edges::NEAR_FIELDS;
use crate::interpretations::{ALIKE, FigureFit, Fit, Interpretations, figures as ranked_figures};
use crate::intervals::{Interval, SAMPLES};
use crate::levels::deviation_percent;
use pxpl5_sim::figures::column::{PROVENANCE, PUBLISHED, SIMULATED, error};
use pxpl5_sim::figures::{filled, four, range};

/// The texts of both documents.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Documents {
    /// ACCURACY.md: tables, misses, and definitions.
    pub accuracy: String,
    /// docs/interpretations.md: open questions, effects of parameters, and reasons.
    pub interpretations: String,
    /// The chapter "Time" of docs/numerics.md.
    pub time: String,
}

/// Mark before the chapter "Time" of docs/numerics.md. The chapter ends the page.
pub const TIME_MARK: &str = "<!-- time: made by pxpl5 figures -->\n";

impl Documents {
    /// Returns a page with its chapter "Time" replaced by this one.
    pub fn with_time(&self, page: &str) -> String {
        let before = page.split(TIME_MARK).next().unwrap_or(page);
        format!("{before}{TIME_MARK}{}", self.time)
    }
}

/// Writes both documents.
pub fn documents(figures: &Figures, alternatives: &Alternatives) -> Documents {
    let rows: Vec<&FigureRow> = figures.rows().collect();
    let of_code: Vec<&FigureRow> = alternatives.of_code.iter().collect();
    let of_table = Headline::of(rows.iter().copied().filter(|row| of_code.iter().any(|other| other.id == row.id)));
    let code_headline = format!(
        "Over the first three tables, the mean error is {:.1} % with the timing table ({} rows) and {:.1} % with the code ({} rows).",
        of_table.mean_error_percent(),
        of_table.free.rows + of_table.interpretation.rows,
        Headline::of(of_code.iter().copied()).mean_error_percent(),
        Headline::of(of_code.iter().copied()).free.rows + Headline::of(of_code.iter().copied()).interpretation.rows,
    );
    let accuracy = filled(
        include_str!("accuracy.md.in"),
        &[
            ("headline", headline(figures)),
            ("miss", MISS_PERCENT.to_string()),
            ("tables", tables(figures)),
            ("wait", under_wait(&rows, &alternatives.other_rule)),
            ("fields", fields(&rows)),
            ("misses", misses(&rows)),
            ("definitions", definitions()),
            ("code_headline", code_headline),
            ("code", moved_by_code(&rows, &of_code)),
            ("others", figures.groups.iter().filter(|group| group.document.is_some()).map(other).collect()),
        ],
    );
    let described = rows.iter().filter(|row| !has_file(row.id));
    let reasoned = all().filter(|figure| !figure.reason.is_empty());
    let ranking = &alternatives.interpretations;
    let interpretations = filled(
        include_str!("interpretations.md.in"),
        &[
            ("count", ranking.analytic.len().to_string()),
            ("ranking", ranked(ranking)),
            ("confidence", confidence(ranking)),
            ("left_out", left_out(ranking)),
            ("application", of_application(&alternatives.application)),
            ("host", host(&alternatives.host)),
            ("fifo", fifo(&alternatives.fifo)),
            ("samples", SAMPLES.to_string()),
            ("sensitivity", sensitivity(&figures.intervals)),
            ("unmoved", unmoved(&figures.intervals)),
            ("provenance", by_text("reason", reasoned.map(|figure| (figure.id, format!("{}.", figure.reason))))),
            ("about", about()),
            ("experiments", by_text("experiment", described.map(|row| (row.id, row.experiment.to_owned())))),
        ],
    );
    let time = filled(include_str!("time.md.in"), &[("edges", edges(&rows))]);
    Documents { accuracy, interpretations, time }
}

/// Returns how near each figure comes to another retrace, and what happens there.
fn edges(rows: &[&FigureRow]) -> String {
    let near = |row: &&FigureRow| {
        let detail = |name: &str| row.details.iter().find(|detail| detail.name == name).map(|detail| detail.value);
        let (later, earlier) = (detail(LATER)?, detail(EARLIER)?);
        let fields = match row.unit {
            "ms" => row.simulated / FIELD_MS,
            "fields" => row.simulated,
            _ => f64::NAN,
        };
        let effect = match (later.is_finite(), fields.is_finite()) {
            (false, _) => "nothing".to_owned(),
            (true, true) => format!("+1 field, {:+.0} %", 100.0 / fields),
            (true, false) => "one triangle less".to_owned(),
        };
        let mark = if later.min(earlier) < NEAR_FIELDS { " **near**" } else { "" };
        Some([
            row.id.to_owned(),
            SIMULATED.1(row),
            format!("{}{mark}", four(later)),
            effect,
            if earlier.is_finite() { four(earlier) } else { "-".to_owned() },
        ])
    };
    let headings = ["#", "simulated", "a retrace later after", "effect", "a retrace earlier before"];
    rows_of(&headings, rows.iter().filter_map(near))
}

/// Duration of an NTSC field in ms.
const FIELD_MS: f64 = 1001.0 / 60.0;

/// Returns a Markdown table from its headings and the cells of its rows.
fn rows_of(headings: &[&str], rows: impl IntoIterator<Item = impl AsRef<[String]>>) -> String {
    let line = |cells: String| format!("| {cells} |\n");
    let rows: String = rows.into_iter().map(|row| line(row.as_ref().join(" | "))).collect();
    format!("{}|{}\n{rows}", line(headings.join(" | ")), "---|".repeat(headings.len()))
}

fn headline(figures: &Figures) -> String {
    let Headline { free, interpretation } = figures.headline();
    let rows = figures.rows().count();
    let whole = Headline::of(&in_whole_fields(figures));
    format!(
        "Of {rows} published figures, {} are **free** checks: their mean error is **{:.1} %**, and {} of them are missed.\n\
         Another {} are decided by an **interpretation**: their mean error is **{:.1} %** with {} misses, or {:.1} % with {} misses\n\
         if TR94 counted whole fields.",
        free.rows,
        free.mean_error_percent,
        free.misses,
        interpretation.rows,
        interpretation.mean_error_percent,
        interpretation.misses,
        whole.interpretation.mean_error_percent,
        whole.interpretation.misses,
    )
}

fn in_whole_fields(figures: &Figures) -> Vec<FigureRow> {
    let counted = |row: &FigureRow| {
        let whole = row.details.iter().find(|detail| detail.name == WHOLE)?;
        let figure = all().find(|figure| figure.id == row.id)?;
        Some(FigureRow { basis: row.basis, ..figure.row(whole.value.into()) })
    };
    figures.rows().map(|row| counted(row).unwrap_or_else(|| row.clone())).collect()
}

/// Returns the rows that the other rule for finished regions changes, with their results under it.
fn under_wait(rows: &[&FigureRow], other_rule: &[FigureRow]) -> String {
    let changed = other_rule.iter().filter(|other| {
        let row = rows.iter().find(|row| row.id == other.id);
        row.is_some_and(|row| four(row.simulated) != four(other.simulated))
    });
    changed.map(|other| format!("{} ({})", other.id, four(other.simulated))).collect::<Vec<_>>().join(", ")
}

fn tables(figures: &Figures) -> String {
    let mut text = String::new();
    for group in figures.groups.iter().filter(|group| group.document.is_none()) {
        let mut above = (String::new(), "");
        let rows = group.rows.iter().map(|row| {
            let provenance = PROVENANCE.1(row);
            let paper = row.source.rsplit_once(", ").map_or("", |(paper, _)| paper);
            // A source, or a provenance of several words, is not repeated in the next row.
            let is_repeated = provenance == above.0 && provenance.contains(' ');
            let source = if paper == above.1 { String::new() } else { format!(" ({paper})") };
            above = (provenance.clone(), paper);
            [
                row.id.to_owned(),
                format!("{}{source}", row.statement),
                PUBLISHED.1(row),
                SIMULATED.1(row).replacen(&format!(" {}", row.unit), "", 1),
                format!("{}{}", error(row), if row.is_met { "" } else { " **miss**" }),
                row.interval.map_or_else(|| "-".to_owned(), range)
                    + if row.is_out_of_reach() { ", **out of reach**" } else { "" },
                if is_repeated { "the same".to_owned() } else { provenance },
            ]
        });
        let headings = ["#", "figure", "published", "simulated", "error", "interval", "provenance"];
        text += &format!("## {}\n\n{}\n", group.title, rows_of(&headings, rows));
    }
    text
}

fn fields(rows: &[&FigureRow]) -> String {
    let of_fly_through = |figure: &Measurement| {
        let row = rows.iter().find(|row| row.id == figure.id)?;
        let detail = |name: &str| row.details.iter().find(|detail| detail.name == name).map_or(f64::NAN, |d| d.value);
        let with_sd = |mean, sd| format!("{} ({})", four(mean), significant_sd(sd));
        let percent = |mean: f64| format!("{:+.1} %", 100.0 * (mean / figure.value - 1.0));
        let whole = detail(WHOLE);
        Some([
            row.id.to_owned(),
            with_sd(figure.value, figure.deviation?),
            with_sd(row.simulated, detail(super::DEVIATION)),
            percent(row.simulated),
            with_sd(whole, detail("their deviation")),
            percent(whole),
        ])
    };
    rows_of(
        &["#", "published (sd)", "exact fields (sd)", "error", "whole fields (sd)", "error"],
        all().filter_map(of_fly_through),
    )
}

fn significant_sd(sd: f64) -> String {
    format!("{sd:.2}")
}

fn misses(rows: &[&FigureRow]) -> String {
    let mut causes: Vec<(String, Vec<String>)> = Vec::new();
    for row in rows.iter().filter(|row| !row.is_met) {
        let out = if row.is_out_of_reach() { ", out of reach" } else { "" };
        let missed = format!("**{}** ({}{out})", row.id, error(row));
        let cause = row.cause_or_unknown().trim_end_matches('.').to_owned();
        // Neighbours with the same cause share a line.
        match causes.last_mut().filter(|(last, _)| *last == cause) {
            Some((_, all)) => all.push(missed),
            None => causes.push((cause, vec![missed])),
        }
    }
    causes.iter().map(|(cause, missed)| format!("- {}: {cause}.\n\n", missed.join(", "))).collect()
}

fn definitions() -> String {
    let defined = all().filter_map(|figure| Some((figure.id, figure.latency?)));
    // Rows with the same definition share a line, with the sentences of their papers.
    let mut rows: Vec<[String; 5]> = Vec::new();
    for (id, super::LatencyDefinition { from, to, eyes, statistic, sentence }) in defined {
        let new = [id, from, to, &format!("{eyes}: {statistic}"), sentence].map(str::to_owned);
        match rows.iter_mut().find(|row| row[1..4] == new[1..4]) {
            Some([ids, .., sentences]) => {
                *ids += &format!(", {id}");
                if !sentences.contains(sentence) {
                    *sentences += &format!("; {id}: {sentence}");
                }
            }
            None => rows.push(new),
        }
    }
    rows_of(&["rows", "from", "to", "eyes, statistic", "what the paper says"], rows)
}

/// Least change of a figure, in percent, for which a document lists what changes it: the times of i860 code instead of
/// the timing table, or a parameter.
const MOVED_PERCENT: f64 = 0.5;

fn moved_by_code(rows: &[&FigureRow], of_code: &[&FigureRow]) -> String {
    let pairs = of_code.iter().filter_map(|code| Some((*rows.iter().find(|row| row.id == code.id)?, code)));
    let moved = pairs.filter(|(table, code)| deviation_percent(code.simulated, table.simulated) > MOVED_PERCENT);
    let cells = moved.map(|(table, code)| {
        let of_code = if code.simulated.is_finite() { error(code) } else { "-100.0 %".to_owned() };
        [table.id.to_owned(), PUBLISHED.1(table), four(table.simulated), error(table), four(code.simulated), of_code]
    });
    rows_of(&["#", "published", "table", "error", "code", "error"], cells)
}

fn other(group: &FigureGroup) -> String {
    let document = group.document.unwrap_or_default();
    let printed = group.rows.iter().filter(|row| row.basis != Basis::Shape);
    let missed: Vec<&FigureRow> = printed.clone().filter(|row| !row.is_met).collect();
    let list = missed.iter().map(|row| {
        let [published, simulated] = [row.published, row.simulated].map(four);
        format!("- {} {}: {published}, ours {simulated} {}\n", row.id, row.statement, row.unit)
    });
    format!(
        "**{}** ([{document}]({document})). {} {} of {} rows with printed conditions are missed:\n\n{}\n\
         **Volumetric slices** have [a page of their own](docs/volumetric.md).\n",
        group.title,
        group.about,
        missed.len(),
        printed.count(),
        list.collect::<String>(),
    )
}

/// Number of interpretations in the document, those with equal figures counted once.
const BEST: usize = 4;

/// Returns the likeliest interpretations and the project's, without the figures that are equal in all of them.
fn ranked(ranking: &Interpretations) -> String {
    let cells = |fit: &Fit| fit.figures.iter().map(|figure| cell(fit, figure)).collect::<Vec<_>>();
    let mut shown: Vec<(String, &Fit, Vec<String>)> = Vec::new();
    for (place, fit) in ranking.ranked().iter().enumerate() {
        let values = cells(fit);
        let is_usual = fit.interpretation == Interpretation::USUAL;
        if is_usual || shown.len() < BEST && shown.iter().all(|(_, _, other)| *other != values) {
            let rank = (place + 1).to_string();
            shown.push((if is_usual { format!("**{rank}**") } else { rank }, fit, values));
        }
    }
    let differs = |column: &usize| shown.iter().any(|(_, _, values)| values[*column] != shown[0].2[*column]);
    let columns: Vec<usize> = (0..ranked_figures().count()).filter(differs).collect();
    let ids: Vec<&str> = ranked_figures().map(|figure| figure.id).collect();
    let figures = columns.iter().map(|column| ids[*column]);
    let headings: Vec<&str> = ["rank", "log L"].into_iter().chain(figures).chain(["interpretation"]).collect();
    let cells = |(rank, fit, values): &(String, &Fit, Vec<String>)| {
        let values = columns.iter().map(|column| values[*column].clone());
        let first = [rank.clone(), format!("{:.1}", fit.log_likelihood)];
        first.into_iter().chain(values).chain([fit.words.clone()]).collect::<Vec<_>>()
    };
    rows_of(&headings, shown.iter().map(cells))
}

fn cell(fit: &Fit, figure: &FigureFit) -> String {
    let sd = figure.simulated_sd.map_or(String::new(), |sd| format!(" ({})", significant_sd(sd)));
    let text = format!("{}{sd}", four(figure.simulated));
    if fit.unexplained.contains(&figure.id) { format!("**{text}**") } else { text }
}

fn confidence(ranking: &Interpretations) -> String {
    let fits = ranking.ranked();
    let alike = ranking.alike();
    let place = fits.iter().position(|fit| fit.interpretation == Interpretation::USUAL);
    let behind = place.map_or(f64::NAN, |place| fits[0].log_likelihood - fits[place].log_likelihood);
    format!(
        "Number of interpretations within a factor of {ALIKE:.1} of the greatest likelihood: {}. The project's, in bold, has a log L\n\
         {behind:.1} lower, because it follows the text where text and figures disagree: the likeliest ones count whole\n\
         fields, which contradicts TR94's own conversions.",
        alike.len(),
    )
}

fn left_out(ranking: &Interpretations) -> String {
    let rows = ranking.left_out.iter();
    let cells = grouped(rows.map(|one| (format!("{} ({:+.1} %)", one.id, one.error_percent), one.words.clone())));
    rows_of(&["figures and their errors", "chosen by the others"], cells)
}

/// Joins the names that have the same text.
fn grouped(rows: impl IntoIterator<Item = (String, String)>) -> Vec<[String; 2]> {
    let mut joined: Vec<[String; 2]> = Vec::new();
    for (name, text) in rows {
        match joined.iter_mut().find(|[_, other]| *other == text) {
            Some([names, _]) => *names += &format!(", {name}"),
            None => joined.push([name, text]),
        }
    }
    joined
}

/// Returns a table with one line for each different text.
fn by_text(heading: &str, rows: impl IntoIterator<Item = (&'static str, String)>) -> String {
    rows_of(&["#", heading], grouped(rows.into_iter().map(|(id, text)| (id.to_owned(), text))))
}

fn of_application(effects: &[Effect]) -> String {
    let cell = |(_, mean, sd): (&str, f64, f64)| format!("{} ({sd:.3})", four(mean));
    let fly_throughs: Vec<&Measurement> = all().filter(|figure| figure.deviation.is_some()).collect();
    let printed =
        fly_throughs.iter().map(|figure| cell((figure.id, figure.value, figure.deviation.unwrap_or(f64::NAN))));
    let first = [vec!["printed".to_owned(), String::new()], printed.collect()].concat();
    // Means between none and 30 ms, and spreads between none and the mean, change less.
    let is_end = |effect: &&Effect| {
        let [mean, spread] = [0, 1].map(|place: usize| effect.changes[place].1);
        (mean == 0 || mean >= 30_000_000) && (spread == 0 || spread == mean)
    };
    let rows = effects.iter().filter(is_end).map(|effect| {
        let times = effect.changes.iter().map(|(_, ns)| format!("{} ms", ns / 1_000_000));
        times.chain(effect.figures.iter().copied().map(cell)).collect::<Vec<_>>()
    });
    let ids = fly_throughs.iter().map(|figure| figure.id);
    let headings: Vec<&str> = ["mean of the application", "evenly spread by +-"].into_iter().chain(ids).collect();
    rows_of(&headings, std::iter::once(first).chain(rows))
}

fn host(effects: &[Effect]) -> String {
    let cells = effects.iter().filter_map(|effect| {
        let ((path, value), (_, latency, _)) = (effect.changes.first()?, effect.figures.first()?);
        Some((format!("{} ms: {} ms", four(*value as f64 / 1e6), four(*latency)), format!("`{path}`")))
    });
    rows_of(&["value, and row 17 with it", "parameter"], grouped(cells))
}

fn fifo(effects: &[Effect]) -> String {
    let ids = effects.first().into_iter().flat_map(|effect| effect.figures.iter().map(|(id, ..)| *id));
    let row = |effect: &Effect| {
        let words = effect.changes.iter().map(|(_, words)| words.to_string());
        words.chain(effect.figures.iter().map(|(_, value, _)| four(*value))).collect::<Vec<_>>()
    };
    rows_of(&["words"].into_iter().chain(ids).collect::<Vec<_>>(), effects.iter().map(row))
}

/// Maximum number of parameters that the document lists for each figure.
const STRONGEST: usize = 3;

fn sensitivity(intervals: &[Interval]) -> String {
    // Intervals are listed in the order of the figures.
    let ordered = all().filter_map(|figure| intervals.iter().find(|interval| interval.id == figure.id));
    let joined = |list: Vec<String>| if list.is_empty() { "-".to_owned() } else { list.join(", ") };
    let cells = ordered.filter(|interval| is_moved(interval)).map(|i| {
        let effects = moving(i).take(STRONGEST);
        let effects =
            effects.map(|e| format!("`{}` ({}, {}; {:+.2})", e.path, four(e.ends[0]), four(e.ends[1]), e.elasticity));
        let rules = i.rules.iter().map(|(rule, value)| format!("{rule}: {}", four(*value)));
        let band = if i.likely[0] < i.likely[1] { range(i.likely) } else { "-".to_owned() };
        [i.id.to_owned(), band, joined(effects.collect()), joined(rules.collect())]
    });
    rows_of(&["#", "5 % to 95 %", "moved by", "rules"], cells)
}

/// Returns the effects of parameters that move a figure by at least half a percent.
fn moving(interval: &Interval) -> impl Iterator<Item = &crate::intervals::Effect> {
    interval.effects.iter().filter(|effect| deviation_percent(effect.ends[0], effect.ends[1]) >= MOVED_PERCENT)
}

fn is_moved(interval: &Interval) -> bool {
    moving(interval).next().is_some() || !interval.rules.is_empty()
}

fn unmoved(intervals: &[Interval]) -> String {
    let still = intervals.iter().filter(|interval| !is_moved(interval));
    still.map(|interval| interval.id).collect::<Vec<_>>().join(", ")
}

/// Returns what the experiments of a topic have in common.
fn about() -> String {
    let topics = TOPICS.iter().filter(|topic| !topic.about.is_empty());
    topics.map(|topic| format!("**{}.** {}\n\n", topic.title, topic.about)).collect()
}
