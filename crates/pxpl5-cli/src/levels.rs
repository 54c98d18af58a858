//! `pxpl5 levels`.

use crate::error::CliError;
use crate::output::OutputFile;
use crate::terminal::{advance, print, progress};
use clap::Args;
use pxpl5::growth;
use pxpl5::levels::{LevelReport, compare_with};
use pxpl5::views::charts::{SpeedAndError, level_chart};
use serde_json::json;
use std::fmt::Write;
use std::path::PathBuf;

/// Run the same experiments at every level of modelling: speed against error.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 levels
  pxpl5 levels --json
  pxpl5 levels --chart docs/levels.svg
  pxpl5 levels --scaling docs/scaling.md")]
pub(crate) struct LevelsArgs {
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Write a chart of speed against error (SVG) to this file.
    #[arg(long, value_name = "FILE")]
    chart: Option<PathBuf>,
    /// Write the tables of growth with triangles and boards to this file instead.
    #[arg(long, value_name = "FILE")]
    scaling: Option<PathBuf>,
}

pub(crate) fn run(args: LevelsArgs) -> Result<(), CliError> {
    if let Some(path) = &args.scaling {
        let file = OutputFile::open(path, "--scaling")?;
        let bar = progress(3, "tables", false);
        let by_triangles = growth::by_triangles()?;
        bar.inc(1);
        let by_machine = growth::by_machine()?;
        bar.inc(1);
        let applications = growth::applications()?;
        bar.finish_and_clear();
        return file.write(growth::markdown(&by_triangles, &by_machine, &applications).as_bytes());
    }
    let chart = args.chart.as_deref().map(|path| OutputFile::open(path, "--chart")).transpose()?;
    let bar = progress(0, "figures at all levels", false);
    let reports = compare_with(|done, of| advance(&bar, done, of));
    bar.finish_and_clear();
    let reports = reports?;
    let published = || reports.iter().filter(|report| !report.times_of_code);
    if let Some(file) = chart {
        let levels: Vec<SpeedAndError> = published().map(speed_and_error).collect();
        file.write(level_chart(&levels).as_bytes())?;
    }
    print(&if args.json { json_text(&reports) } else { text(&reports) })
}

fn speed_and_error(report: &LevelReport) -> SpeedAndError {
    SpeedAndError {
        name: report.level.name().to_owned(),
        fields_per_host_second: report.fields_per_host_second,
        mean_error_percent: report.mean_error_percent,
    }
}

fn json_text(reports: &[LevelReport]) -> String {
    format!("{:#}\n", json!({"schema": "pxpl5-levels/1", "levels": reports}))
}

fn text(reports: &[LevelReport]) -> String {
    let mut text = format!(
        "{:<24} {:>10} {:>16} {:>10} {:>22}\n",
        "level", "fields/s", "configurations/s", "error", "deviation from cycle"
    );
    for report in reports {
        let [mean, worst] = report.deviation_percent;
        let times = if report.times_of_code { ", times of code" } else { "" };
        let name = format!("{}{times}", report.level.name());
        let _ = writeln!(
            text,
            "{name:<24} {:>10.0} {:>16.0} {:>8.1} % {mean:>8.1} %, most {worst:>4.1} %",
            report.fields_per_host_second, report.configurations_per_host_second, report.mean_error_percent
        );
    }
    text.push_str(
        "\nfields/s: simulated NTSC fields per second of this host, without pixels; error: mean of the free checks;\ndeviation: all figures from those of \
         the cycle level with the same times in the table (published or fitted, or those of the i860 code)\n",
    );
    text
}
