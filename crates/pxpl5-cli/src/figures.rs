//! The command `pxpl5 figures`, which compares every published figure with a simulation.

mod args;
mod documented;
mod table;

pub(crate) use args::FiguresArgs;

use crate::error::CliError;
use crate::numbers::count_of;
use crate::output::OutputFile;
use crate::progress::Progress;
use crate::terminal::print;
use args::{ADDRESS_RECALCULATION, VOLUMETRIC};
use pxpl5::Level;
use pxpl5::figures::{
    AlternativeQuery, Alternatives, Basis, Documents, FigureQuery, FigureRow, FigureSettings, Figures, Headline,
    Measurement, TOPICS, all, documents,
};
use pxpl5::views::charts::{AxisScale, Chart, ChartAxes, ChartPoint, ChartSeries, ChartSize, SeriesStyle};
use serde_json::json;
use std::fs;
use std::path::Path;
use table::{fresh, titled};

pub(crate) fn run(args: FiguresArgs) -> Result<(), CliError> {
    match args.group.as_deref() {
        Some(name @ (ADDRESS_RECALCULATION | VOLUMETRIC)) => return documented::run(name, &args),
        Some(name) => return of_group(name, &args),
        None if args.out.is_some() => {
            return Err(CliError::usage(format!("--out: expected --group {ADDRESS_RECALCULATION} or {VOLUMETRIC}")));
        }
        None => {}
    }
    if !args.only.is_empty() {
        return chosen(&args);
    }
    let is_document = args.answer.json || args.write.is_some() || args.check.is_some();
    // The plain table leaves out the intervals, because a reader waits for it.
    let intervals = is_document || args.chart.is_some() || args.intervals;
    let settings = FigureSettings::new(Level::Transaction);
    let query = FigureQuery { settings: settings.clone(), intervals, only: Vec::new() };
    // Open the output first, so that a bad path fails before the simulations.
    admit(&query, &args)?;
    let file = args.write.as_deref().map(|path| OutputFile::open(path, "--write")).transpose()?;
    let chart_file = args.chart.as_deref().map(|path| OutputFile::open(path, "--chart")).transpose()?;
    // Rows are printed as they come, unless the output needs their intervals or is JSON.
    let figures = measured(&query, args.answer.quiet || intervals, args.answer.quiet)?;
    let rows: Vec<FigureRow> = figures.rows().cloned().collect();
    chart_file.map(|file| file.write(chart(&rows).svg().as_bytes())).transpose()?;
    // Only the documents and the JSON output have the figures under other assumptions.
    if is_document {
        let progress = Progress::new("figures under other assumptions", args.answer.quiet);
        let alternatives = progress.run(&AlternativeQuery { settings })?;
        let texts = documents(&figures, &alternatives);
        file.map(|file| file.write(texts.accuracy.as_bytes())).transpose()?;
        if let Some(folder) = &args.pages {
            pages(folder, &texts, args.check.is_some())?;
        }
        // `--check` fails if a document of the repository is stale.
        args.check.as_deref().map(|path| fresh(path, &texts.accuracy, "figures")).transpose()?;
        if args.answer.json {
            return print(&json_text(&figures, &alternatives));
        }
    }
    if args.answer.quiet {
        return Ok(());
    }
    if intervals {
        figures.groups.iter().try_for_each(|group| print(&titled(group.title, &group.rows)))?;
    }
    documented::print_volumes()?;
    print(&format!("\n{}\n", figures.headline()))?;
    if intervals { Ok(()) } else { print(WITHOUT_INTERVALS) }
}

/// Measures figures. Prints each row as soon as it is measured, unless `is_silent`.
fn measured(query: &FigureQuery, is_silent: bool, is_quiet: bool) -> Result<Figures, CliError> {
    let mut table = "";
    let mut printed = Ok(());
    let progress = Progress::new("figures", is_quiet);
    if is_silent {
        return progress.run(query);
    }
    let progress = progress.keeping("the rows that were printed are complete").on_row(|bar, title, row| {
        let before = std::mem::replace(&mut table, title);
        let gap = if before.is_empty() { "" } else { "\n" };
        let head = if before == title { String::new() } else { format!("{gap}{title}\n{}\n", FigureRow::HEADER) };
        if printed.is_ok() {
            printed = bar.above(|| print(&format!("{head}{row}\n")));
        }
    });
    let figures = progress.run(query)?;
    printed.map(|()| figures)
}

fn admit(query: &FigureQuery, args: &FiguresArgs) -> Result<(), CliError> {
    args.answer.budget.admit_study(query, "measure some of them with --only")
}

/// Measures and prints figures without their intervals, and counts the misses.
fn some(only: Vec<&'static Measurement>, args: &FiguresArgs) -> Result<(), CliError> {
    let query = FigureQuery { settings: FigureSettings::new(Level::Transaction), intervals: false, only };
    admit(&query, args)?;
    let figures = measured(&query, args.answer.json || args.answer.quiet, args.answer.quiet)?;
    let rows: Vec<&FigureRow> = figures.rows().collect();
    if args.answer.json {
        return print(&format!("{:#}\n", json!({ "schema": SCHEMA, "figures": rows })));
    }
    let missed = rows.iter().filter(|row| !row.is_met).count();
    if args.answer.quiet { Ok(()) } else { print(&format!("\n{}, {missed} missed\n", count_of(rows.len(), "row"))) }
}

const WITHOUT_INTERVALS: &str =
    "\nThe intervals of the figures are in ACCURACY.md. Option --intervals computes them.\n";

fn pages(folder: &Path, texts: &Documents, is_check: bool) -> Result<(), CliError> {
    let numerics = folder.join("numerics.md");
    let page = fs::read_to_string(&numerics).map_err(|e| CliError::failure(format!("{}: {e}", numerics.display())))?;
    for (path, text) in
        [(folder.join("interpretations.md"), texts.interpretations.clone()), (numerics, texts.with_time(&page))]
    {
        if is_check {
            fresh(&path, &text, "figures")?;
        } else {
            OutputFile::open(&path, "--pages")?.write(text.as_bytes())?;
        }
    }
    Ok(())
}

/// Measures and prints the figures of one topic of Pixel-Planes 5.
fn of_group(name: &str, args: &FiguresArgs) -> Result<(), CliError> {
    let names = TOPICS.iter().map(|topic| topic.name).chain([ADDRESS_RECALCULATION, VOLUMETRIC]);
    let topic = TOPICS.iter().find(|topic| topic.name == name).ok_or_else(|| {
        CliError::usage(format!("--group: expected {}, found {name}", names.collect::<Vec<_>>().join(", ")))
    })?;
    if args.write.is_some() || args.check.is_some() || args.out.is_some() {
        return Err(CliError::usage(format!("--group {name} has no document and no pictures of its own")));
    }
    some(topic.figures.iter().collect(), args)
}

/// Measures and prints the figures with these numbers.
fn chosen(args: &FiguresArgs) -> Result<(), CliError> {
    let find = |number: &String| {
        let known = || all().map(|figure| figure.id).collect::<Vec<_>>().join(", ");
        let figure = all().find(|figure| figure.id == number.as_str());
        figure.ok_or_else(|| CliError::usage(format!("--only: expected numbers among {}, found {number}", known())))
    };
    // All numbers are checked before the first experiment runs.
    some(args.only.iter().map(find).collect::<Result<_, _>>()?, args)
}

const SCHEMA: &str = "pxpl5-figures/3";

fn json_text(figures: &Figures, alternatives: &Alternatives) -> String {
    let object = json!({
        "schema": SCHEMA,
        "headline": figures.headline(),
        "groups": figures.groups,
        "figures_with_times_of_code": alternatives.of_code,
        "headline_with_times_of_code": Headline::of(&alternatives.of_code),
        "figures_with_the_other_rule": alternatives.other_rule,
        "fifo_sizes": alternatives.fifo,
        "host_times": alternatives.host,
        "intervals": figures.intervals,
    });
    format!("{object:#}\n")
}

const CHART_MM: f64 = 165.0;

/// Returns a chart of the errors of all rows and of their intervals, in percent of the published values.
fn chart(rows: &[FigureRow]) -> Chart {
    let series = |name: &str, is_free: bool| {
        // Each row keeps the position of its number, so that the two series share the axis.
        let chosen = rows.iter().enumerate().filter(|(_, row)| (row.basis == Basis::Free) == is_free);
        let points = chosen.map(|(place, row)| ChartPoint {
            at: (place as f64, row.error_percent.unwrap_or(f64::NAN)),
            interval: row.interval.map_or((f64::NAN, f64::NAN), |ends| relative(ends, row.published)),
            is_hollow: !is_free,
        });
        ChartSeries { name: name.to_owned(), points: points.collect(), style: SeriesStyle::Points }
    };
    Chart {
        axes: ChartAxes {
            title: "Simulated against published figures".to_owned(),
            across: "figure of ACCURACY.md".to_owned(),
            up: "error, per cent".to_owned(),
        },
        across: AxisScale::Names(rows.iter().map(|row| row.id.to_owned()).collect()),
        up: AxisScale::Fitted,
        series: vec![series("free check", true), series("a parameter or rule was chosen for the figure", false)],
        size: ChartSize::Column { width_mm: CHART_MM },
    }
}

/// Returns the ends of an interval as differences from a published value, in percent of this value.
fn relative([low, high]: [f64; 2], published: f64) -> (f64, f64) {
    let percent = |value: f64| 100.0 * (value - published) / published;
    (percent(low), percent(high))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(id: &'static str, basis: Basis, interval: Option<[f64; 2]>) -> FigureRow {
        FigureRow { basis, interval, ..FigureRow::new(id, "", "ms", [50.0, 51.0], [49.0, 51.0]) }
    }

    #[test]
    fn the_chart_has_each_row_once_with_its_interval_in_percent() {
        let chart = chart(&[row("1", Basis::Free, Some([45.0, 60.0])), row("2b", Basis::Rule("chosen"), None)]);
        assert_eq!(chart.across, AxisScale::Names(vec!["1".to_owned(), "2b".to_owned()]));
        let [free, chosen] = [0, 1].map(|series| &chart.series[series].points);
        assert_eq!((free.len(), free[0].at, free[0].interval), (1, (0.0, 2.0), (-10.0, 20.0)));
        assert_eq!((chosen.len(), chosen[0].at), (1, (1.0, 2.0)));
        assert!(chosen[0].interval.0.is_nan(), "a figure that was not varied has no interval");
    }
}
