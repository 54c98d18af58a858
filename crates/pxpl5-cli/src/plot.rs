//! The command `pxpl5 plot`, which plots a sweep or a comparison for publication.

mod drawing;
mod formats;
mod question;

use crate::error::CliError;
use crate::numbers::{are, count_of};
use crate::output::OutputFolder;
use crate::rows::{self, ResultRows, RowsKind};
use crate::terminal::{json_text, print, print_error};
use crate::version::{VERSION, commit};
use formats::Format;
use pxpl5::views::charts::AxisScale;
use pxpl5::views::results::csv_table;
use question::{Group, Question};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Plot the results of a sweep or a comparison with intervals, and write the numbers to a second file.
///
/// The command writes three files: the figure, FIG.csv and FIG.json. For every point, FIG.csv has the mean, the
/// standard deviation, the number of values (n) and the confidence interval of the mean. The interval is Student's t
/// interval; for positive values it is computed from their logarithms. Rows of a comparison keep the interval and the
/// method of that comparison. FIG.json states the results and options from which the figure was made.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 plot out/slats --x triangles --y missed_retraces --by copy --where code=1994 --out fig.svg
  pxpl5 plot out/gps --x machine.n_gps --y latency_fields.mean --band seed --by pipeline --out fig.svg
  pxpl5 plot out/compare --x head_to_light_ms.mean --y error.mean_px.mean --by pipeline --y-scale log --out fig.svg

An axis that varies must be named by --x, --by or --band; otherwise, the command fails. A row without a result does not count as 0. The
column `missing` counts such rows, and a point without any number is not drawn. A hollow mark stands for runs with pictures that were
due and not shown: its mean is of the others. FIG.csv has the sums of `pictures_due`, `missed_retraces` and `samples` (evaluated pixels).")]
pub(crate) struct PlotArgs {
    /// Results of `pxpl5 sweep --out` or `pxpl5 compare --out`: the folder, or its rows.jsonl or comparison.json.
    #[arg(value_name = "DIR|FILE")]
    results: PathBuf,
    #[command(flatten)]
    question: Question,
    /// File of the figure: .svg; with the feature `print` also .png (300 dots per inch) and .pdf.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Width of the figure in millimetres: 84 is one column of most journals, 174 two columns.
    #[arg(long, value_name = "MM", default_value_t = 84.0, value_parser = width)]
    width: f64,
    /// Scale of the x axis.
    #[arg(long, value_name = "SCALE", value_enum, default_value_t = ScaleName::Even)]
    x_scale: ScaleName,
    /// Scale of the y axis.
    #[arg(long, value_name = "SCALE", value_enum, default_value_t = ScaleName::Even)]
    y_scale: ScaleName,
    /// Label of the x axis; default: the column's name.
    #[arg(long, value_name = "TEXT")]
    x_label: Option<String>,
    /// Label of the y axis; default: the column's name.
    #[arg(long, value_name = "TEXT")]
    y_label: Option<String>,
    /// Title above the figure; default: none.
    #[arg(long, value_name = "TEXT", default_value = "")]
    title: String,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

/// Scale of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum ScaleName {
    /// Linear, from the smallest number to the largest.
    Even,
    /// Linear, from 0.
    Zero,
    /// Logarithmic, in powers of ten; numbers that are not above 0 are left out.
    Log,
}

impl ScaleName {
    const fn scale(self) -> AxisScale {
        match self {
            Self::Even => AxisScale::Fitted,
            Self::Zero => AxisScale::FromZero,
            Self::Log => AxisScale::Decades,
        }
    }
}

const WIDTHS_MM: (f64, f64) = (40.0, 400.0);

fn width(text: &str) -> Result<f64, String> {
    let (low, high) = WIDTHS_MM;
    let found = text.parse().ok().filter(|mm: &f64| (low..=high).contains(mm));
    found.ok_or(format!("expected {low} to {high} millimetres, found {text}"))
}

pub(crate) fn run(mut args: PlotArgs) -> Result<(), CliError> {
    let format = Format::of(&args.out)?;
    let folder = rows::folder_of(&args.results);
    let results = rows::of(folder)?.ok_or_else(|| no_rows(folder))?;
    if results.kind == RowsKind::Comparison && args.question.by.is_empty() {
        args.question.by.push("pipeline".to_owned());
    }
    let question = &args.question;
    let groups = question.groups(&results)?;
    // Failed points have no number. Nothing is drawn if no point has one.
    let missing: usize = groups.iter().map(|group| group.missing).sum();
    if groups.iter().all(|group| group.n == 0) {
        let y = &question.y;
        return Err(CliError::failure(format!(
            "none of {} has a number in column {y}; nothing was drawn",
            count_of(missing, "row")
        )));
    }
    // The SVG is drawn first; other formats are converted from it.
    let svg = drawing::chart(&args, &groups).svg();
    let figure = formats::bytes(&svg, format)?;
    write(&args, &results, (&figure, &csv(question, &groups)))?;
    // Rows without a number are reported, because the means leave them out.
    if missing > 0 {
        let (have, are) = if missing == 1 { ("has", "is") } else { ("have", "are") };
        let rows = count_of(missing, "row");
        print_error(&format!(
            "pxpl5: {rows} {have} no number in column {} and {are} left out of the means\n",
            question.y
        ));
    }
    if args.quiet {
        return Ok(());
    }
    let places = groups.iter().filter(|group| group.n > 0).count();
    print(&format!("{} drawn in {}; the numbers are beside it.\n", are(places as u64, "place"), args.out.display()))
}

fn no_rows(folder: &Path) -> CliError {
    let folder = folder.display();
    CliError::usage(format!(
        "{folder}: neither rows.jsonl nor comparison.json; expected what `pxpl5 sweep --out` or `pxpl5 compare --out` writes"
    ))
}

fn write(args: &PlotArgs, results: &ResultRows, (figure, csv): (&[u8], &str)) -> Result<(), CliError> {
    // The three files differ only in their extension.
    let name = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let parent = args.out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (Some(figure_name), Some(csv_name), Some(json_name)) =
        (name(&args.out), name(&args.out.with_extension("csv")), name(&args.out.with_extension("json")))
    else {
        return Err(CliError::usage(format!("{} is no file name", args.out.display())));
    };
    // FIG.json repeats the question and the settings of the results, so that the figure can be reproduced.
    let Question { x, y, by, band, only, .. } = &args.question;
    let only: Vec<String> = only.iter().map(|(name, value)| format!("{name}={value}")).collect();
    let origin = json!({
        "schema": "pxpl5-plot/1",
        "version": VERSION,
        "commit": commit(),
        "results": args.results.display().to_string(),
        "x": x, "y": y, "by": by, "band": band, "where": only,
        "interval": interval(args, results.kind),
        "about": results.about,
    });
    let origin = json_text(&origin)?;
    let mut folder = OutputFolder::beside(parent, "--out", rows::folder_of(&args.results))?;
    folder.put(&figure_name, figure)?;
    folder.put(&csv_name, csv.as_bytes())?;
    folder.put(&json_name, origin.as_bytes())?;
    folder.commit()
}

fn interval(args: &PlotArgs, kind: RowsKind) -> String {
    match kind {
        RowsKind::Sweep => {
            format!(
                "{} % of the mean, Student's t, of the logarithm if all are positive",
                args.question.confidence * 100.0
            )
        }
        RowsKind::Comparison => "as in the comparison: see `confidence` and each row's `method`".to_owned(),
    }
}

/// Returns the groups of rows as CSV, with columns of names before columns of numbers. The cell of a missing number is
/// empty.
fn csv(question: &Question, groups: &[Group]) -> String {
    let columns = ["mean", "sd", "n", "low", "high", "missing", "pictures_due", "missed_retraces", "samples"];
    let names = question.by.iter().cloned().chain([question.x.clone()]).chain(columns.map(str::to_owned));
    let number = |value: f64| if value.is_finite() { value.to_string() } else { String::new() };
    let count = |value: Option<u64>| value.map_or_else(String::new, |count| count.to_string());
    let rows = groups.iter().map(|group| {
        let numbers = [
            number(group.mean),
            number(group.sd),
            group.n.to_string(),
            number(group.interval.0),
            number(group.interval.1),
            group.missing.to_string(),
            count(group.counts.pictures_due),
            count(group.counts.missed_retraces),
            count(group.counts.samples),
        ];
        group.by.iter().cloned().chain([question::text(&group.x)]).chain(numbers).collect::<Vec<_>>()
    });
    csv_table(names, rows)
}
