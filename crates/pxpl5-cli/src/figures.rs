//! The command `pxpl5 figures`, which compares every published figure with a simulation.

use crate::budget::BudgetArgs;
use crate::error::CliError;
use crate::estimate::Study;
use crate::interrupt;
use crate::output::OutputFile;
use crate::terminal::{print, progress};
use clap::Args;
use pxpl5::Level;
use pxpl5::figures::{
    Alternatives, Basis, Bench, FIGURES, FigureRow, FigureTable, Figures, alternatives_with, markdown,
    mean_error_percent, run_all_in_order,
};
use pxpl5::views::charts::{AxisScale, Chart, ChartAxes, ChartPoint, ChartSeries, ChartSize, SeriesStyle};
use pxpl5_sim::figures::column::range;
use pxpl5_sim::figures::significant;
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};

/// Simulate every published figure, and compare the result with the published value.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 figures
  pxpl5 figures --intervals              takes twice as long
  pxpl5 figures --only 4,7               these figures, without their intervals
  pxpl5 figures --json
  pxpl5 figures --write ACCURACY.md
  pxpl5 figures --chart errors.svg       errors with their intervals
  pxpl5 figures --check ACCURACY.md      fails if the file is out of date")]
pub(crate) struct FiguresArgs {
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Write the document with all figures (ACCURACY.md) to this file.
    #[arg(long, value_name = "FILE", conflicts_with = "check")]
    write: Option<PathBuf>,
    /// Fail if this file differs from the document that --write would write.
    #[arg(long, value_name = "FILE")]
    check: Option<PathBuf>,
    /// Print also the interval of each figure while unpublished parameters vary.
    #[arg(long)]
    intervals: bool,
    /// Write a chart of the errors and their intervals (SVG) to this file.
    #[arg(long, value_name = "FILE")]
    chart: Option<PathBuf>,
    /// Measure only these figures of the main table, separated by commas. Each row is printed as soon as it is
    /// measured.
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',', conflicts_with_all = ["write", "check", "json", "chart", "intervals"])]
    only: Vec<String>,
    #[command(flatten)]
    budget: BudgetArgs,
}

pub(crate) fn run(args: FiguresArgs) -> Result<(), CliError> {
    // Open the output first, so that a bad path fails before the simulations.
    if !args.only.is_empty() {
        return chosen(&args.only);
    }
    args.budget.admit_study(Study::Figures, "measure some of them with --only")?;
    let file = args.write.as_deref().map(|path| OutputFile::open(path, "--write")).transpose()?;
    let chart_file = args.chart.as_deref().map(|path| OutputFile::open(path, "--chart")).transpose()?;
    let is_document = args.json || args.write.is_some() || args.check.is_some();
    let bench = Bench::new(Level::Transaction);
    // The plain table leaves out the intervals, because a reader waits for it.
    let has_intervals = is_document || args.chart.is_some() || args.intervals;
    let bench = if has_intervals { bench } else { bench.without_intervals() };
    // Rows are printed as they come, unless the output needs their intervals or is JSON.
    let mut printer = RowPrinter::default();
    let mut printed = Ok(());
    interrupt::keeps("nothing was written, and the rows that were printed are complete".to_owned());
    let bar = progress(0, "figures", false);
    let print_row = |table, row: &FigureRow| {
        if !has_intervals && printed.is_ok() {
            printed = bar.above(|| printer.row(table, row));
        }
    };
    let figures = run_all_in_order(&bench, |done, of| bar.advance(done, of), print_row).map_err(CliError::failure);
    bar.clear();
    let figures = figures?;
    printed?;
    chart_file.map(|file| file.write(chart(&figures.rows).svg().as_bytes())).transpose()?;
    // Only the document and the JSON output have the figures under other assumptions.
    if is_document {
        let bar = progress(0, "figures under other assumptions", false);
        let alternatives = alternatives_with(&bench, |done, of| bar.advance(done, of)).map_err(CliError::failure);
        bar.clear();
        let alternatives = alternatives?;
        let document = markdown(&figures, &alternatives);
        file.map(|file| file.write(document.as_bytes())).transpose()?;
        // `--check` fails if the repository's document is stale.
        args.check.as_deref().map(|path| fresh(path, &document, "figures")).transpose()?;
        if args.json {
            return print(&json_text(&figures, &alternatives));
        }
    }
    if has_intervals {
        figures.each_row(|table, row| printer.row(table, row))?;
    }
    printer.end_table()?;
    if has_intervals { Ok(()) } else { print(WITHOUT_INTERVALS) }
}

const WITHOUT_INTERVALS: &str =
    "\nThe intervals of the figures are in ACCURACY.md. Option --intervals computes them.\n";

/// Measures and prints the figures with these numbers in the main table of ACCURACY.md.
fn chosen(numbers: &[String]) -> Result<(), CliError> {
    let all = FIGURES.map(|figure| figure.id).join(", ");
    let find = |number: &String| {
        let figure = FIGURES.iter().find(|figure| figure.id == number.as_str());
        figure.ok_or_else(|| CliError::usage(format!("--only: expected numbers among {all}, found {number}")))
    };
    // All numbers are checked before the first experiment runs.
    let figures = numbers.iter().map(find).collect::<Result<Vec<_>, _>>()?;
    let bench = Bench::new(Level::Transaction);
    print(HEADER)?;
    for figure in figures {
        let measured = bench.measure(figure.id).map_err(CliError::failure)?;
        print(&row_text(&figure.row(measured)))?;
    }
    Ok(())
}

/// Returns an error if the document on disk differs from the text that `subcommand` would write now.
pub(crate) fn fresh(path: &Path, document: &str, subcommand: &str) -> Result<(), CliError> {
    let kept = fs::read_to_string(path).map_err(|error| CliError::failure(format!("{}: {error}", path.display())))?;
    if kept == document {
        return Ok(());
    }
    let path = path.display();
    Err(CliError::failure(format!("{path} is stale: run `pxpl5 {subcommand} --write {path}`")))
}

fn json_text(figures: &Figures, alternatives: &Alternatives) -> String {
    let object = json!({
        "schema": "pxpl5-figures/2",
        "mean_error_percent_of_free_checks": mean_error_percent(&figures.rows),
        "figures": figures.rows,
        "figures_with_times_of_code": alternatives.of_code,
        "families": figures.families,
        "groups": figures.groups,
        "intervals": figures.intervals,
    });
    format!("{object:#}\n")
}

/// Printer of the tables of figures, row by row.
#[derive(Default)]
struct RowPrinter {
    table: Option<FigureTable>,
    /// Printed rows of the current table.
    rows: Vec<FigureRow>,
}

impl RowPrinter {
    /// Prints a row. A row of another table ends the current table and begins the other table.
    fn row(&mut self, table: FigureTable, row: &FigureRow) -> Result<(), CliError> {
        if self.table != Some(table) {
            self.end_table()?;
            self.table = Some(table);
            print(&format!("{}{HEADER}", title(table)))?;
        }
        self.rows.push(row.clone());
        print(&row_text(row))
    }

    fn end_table(&mut self) -> Result<(), CliError> {
        let Some(table) = self.table.take() else { return Ok(()) };
        let rows = std::mem::take(&mut self.rows);
        print(&count_text(&rows))?;
        if table != FigureTable::Main {
            return Ok(());
        }
        print(&format!("mean absolute error of the free checks: {:.1} %\n", mean_error_percent(&rows)))
    }
}

/// Returns the title of a table, with an empty line before it. The main table comes first and has no title.
fn title(table: FigureTable) -> String {
    match table {
        FigureTable::Main => String::new(),
        FigureTable::Group { title } => format!("\n{title}\n"),
        FigureTable::Family { title, document } => format!("\n{title} ({document})\n"),
    }
}

const HEADER: &str =
    "#           published    simulated  unit             error  interval               provenance what\n";

/// Formats rows as a table, and counts the rows whose simulated value misses the published value.
pub(crate) fn rows_text(rows: &[FigureRow]) -> String {
    let lines: String = rows.iter().map(row_text).collect();
    format!("{HEADER}{lines}{}", count_text(rows))
}

fn count_text(rows: &[FigureRow]) -> String {
    let missed = rows.iter().filter(|row| !row.is_met).count();
    format!("{} rows, {missed} missed\n", rows.len())
}

/// Formats one row of a table of figures. The cell of a missing published number is "-".
fn row_text(row: &FigureRow) -> String {
    let published = if row.published.is_nan() { "-".to_owned() } else { significant(row.published, DIGITS) };
    let error = row.error_percent.map_or_else(String::new, |error| format!("{error:+.1}%"));
    let interval = row.interval.map_or_else(String::new, range);
    let scene = row.scene.as_ref().map_or_else(String::new, |scene| format!(" ({scene})"));
    // An experiment is either described in words or has a name such as E1.
    let name = if row.experiment.contains(' ') { "" } else { row.experiment };
    format!(
        "{:<10} {published:>10} {:>12}  {:<13} {error:>8}  {interval:<22} {:<10} {}{}{scene}\n",
        format!("{name} {}", row.id).trim_start(),
        significant(row.simulated, DIGITS),
        row.unit,
        provenance(row.basis),
        if row.is_met { "" } else { "miss: " },
        row.statement
    )
}

const fn provenance(basis: Basis) -> &'static str {
    match basis {
        Basis::Interpretation => "interval",
        Basis::Shape => "shape",
        _ => basis.name(),
    }
}

const DIGITS: i32 = 6;

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
