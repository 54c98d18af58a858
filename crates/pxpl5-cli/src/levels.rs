//! The command `pxpl5 levels`, which compares the speed and accuracy of the analytic, transaction and cycle level.

use crate::error::CliError;
use crate::numbers::dash;
use crate::output::OutputFile;
use crate::progress::Progress;
use crate::terminal::{AnswerArgs, json_text, laid_out};
use clap::Args;
use pxpl5::levels::{LevelQuery, LevelRecord, LevelReport};
use pxpl5::views::charts::{SpeedAndError, level_chart};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Compare the levels of modelling: speed, error, and advice on the use of each level.
///
/// Prints the last recorded measurement with its date. --measure measures again on this computer.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 levels
  pxpl5 levels --json
  pxpl5 levels --measure                                            measures everything again, on this computer
  pxpl5 levels --measure --write crates/pxpl5-cli/src/levels.json --chart levels.svg
  pxpl5 levels --measure --errors-only --experiments 1000           without speeds, which need an idle computer")]
pub(crate) struct LevelsArgs {
    /// Measure errors and speeds now, instead of printing the recorded measurement.
    #[arg(long)]
    measure: bool,
    /// Do not measure simulation speeds.
    #[arg(long, requires = "measure")]
    errors_only: bool,
    /// Number of random experiments from which the error against the cycle level is computed.
    #[arg(long, default_value_t = 200, value_name = "N", requires = "measure", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    experiments: u64,
    /// Write the measurement to this file (JSON).
    #[arg(long, value_name = "FILE", requires = "measure")]
    write: Option<PathBuf>,
    /// Write a chart of speed against error (SVG) to this file.
    #[arg(long, value_name = "FILE")]
    chart: Option<PathBuf>,
    #[command(flatten)]
    answer: AnswerArgs,
}

const RECORD: &str = include_str!("levels.json");

pub(crate) fn run(args: LevelsArgs) -> Result<(), CliError> {
    let open = |path: Option<&Path>, option| path.map(|path| OutputFile::open(path, option)).transpose();
    let chart = open(args.chart.as_deref(), "--chart")?;
    let written = open(args.write.as_deref(), "--write")?;
    // Without --measure the recorded numbers are used, because measuring takes long.
    let record = if args.measure { measured(&args)? } else { LevelRecord::read(RECORD).map_err(CliError::failure)? };
    if let Some(file) = written {
        file.write(json_text(&record)?.as_bytes())?;
    }
    if let Some(file) = chart {
        let points: Vec<SpeedAndError> = record.levels.iter().flat_map(points).collect();
        file.write(level_chart(&points).as_bytes())?;
    }
    args.answer.print(&json_text(&record)?, || text(&record))
}

fn measured(args: &LevelsArgs) -> Result<LevelRecord, CliError> {
    let study = LevelQuery { experiments: args.experiments, speeds: !args.errors_only };
    let progress = Progress::new("experiments and figures at all levels", args.answer.quiet);
    let record = progress.run_within(args.answer.budget, "take fewer --experiments", &study)?;
    // Speeds depend on the host, so the record describes the host.
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let host = format!("{}, {threads} threads", std::env::consts::ARCH);
    let seconds = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).ok();
    let date = seconds.map(|since| date_of(since.as_secs() / 86_400));
    Ok(LevelRecord { date, host: Some(host), ..record })
}

/// Converts days since 1 January 1970 to a date. The Gregorian calendar repeats every 146,097 days.
fn date_of(days: u64) -> String {
    // Years start in March in this calculation, so that a leap day is the last day of its year.
    let days = days + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (year, month) = (400 * era + year, if month < 10 { month + 3 } else { month - 9 });
    format!("{:04}-{month:02}-{day:02}", year + u64::from(month <= 2))
}

/// Returns one chart point for each value of the setting `pixels` with which a speed was measured.
fn points(report: &LevelReport) -> Vec<SpeedAndError> {
    let Some(mean_error_percent) = report.published_error_percent else { return Vec::new() };
    let speeds = report.speeds.iter().filter_map(|speed| {
        Some(SpeedAndError {
            name: format!("{}, pixels {}", report.name(), pixels(speed.pixels)),
            fields_per_host_second: speed.simulated_seconds_per_second? * NTSC_FIELDS,
            mean_error_percent,
        })
    });
    speeds.collect()
}

/// NTSC fields per second.
const NTSC_FIELDS: f64 = 60_000.0 / 1_001.0;

const fn pixels(pixels: pxpl5::Pixels) -> &'static str {
    match pixels {
        pxpl5::Pixels::Off => "off",
        pxpl5::Pixels::Lazy => "lazy",
        pxpl5::Pixels::All => "all",
    }
}

fn text(record: &LevelRecord) -> String {
    let heads = ["level", "published", "against the cycle level: median (5 to 95 %)", "pixels off", "lazy", "all"];
    let mut lines = vec![heads.map(str::to_owned).to_vec()];
    // One line for each level: errors, then the speed for each choice of pixels.
    for report in &record.levels {
        let published = report.published_error_percent.map_or_else(dash, |error| format!("{error:.1} %"));
        let from_cycle = report.from_cycle_percent.map_or_else(dash, |spread| {
            format!("{:.2} % ({:.2} to {:.2})", spread.median, spread.low_5, spread.high_95)
        });
        let speeds = [pxpl5::Pixels::Off, pxpl5::Pixels::Lazy, pxpl5::Pixels::All].map(|choice| {
            let speed = report.speeds.iter().find(|speed| speed.pixels == choice);
            let speed = speed.and_then(|speed| speed.simulated_seconds_per_second);
            speed.map_or_else(dash, |speed| format!("{speed:.1}"))
        });
        lines.push([vec![report.name().to_owned(), published, from_cycle], speeds.to_vec()].concat());
    }
    let mut text = laid_out(&lines, 1);
    text.push('\n');
    for report in &record.levels {
        let _ = writeln!(text, "{}: {}.", report.name(), report.advice());
    }
    // The last paragraph defines the columns.
    let when = record.date.as_deref().unwrap_or("on an unknown day");
    let host = record.host.as_deref().unwrap_or("an unknown machine");
    let _ = write!(
        text,
        "\npixels: simulated seconds per second; published: mean error of the free and interpretation rows. Against the cycle level: {} random experiments with Rendering Control (latency)\n\
         and Slats (time to the first copy). Computing pixels changes no simulated time. Measured {when} on {host}.\n",
        record.experiments
    );
    if let Some(note) = &record.note {
        let _ = writeln!(text, "{note}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_record_of_levels_is_read_and_its_text_has_the_advice_for_each_level() {
        let record = LevelRecord::read(RECORD).expect("the recorded levels");
        assert!(record.experiments >= 200 && record.levels.len() == 5);
        let text = text(&record);
        assert!(record.levels.iter().all(|report| text.contains(report.advice())), "{text}");
    }

    #[test]
    fn the_date_of_a_day_number_counts_from_1970() {
        let days = [0, 59, 11_016, 11_017, 19_782, 20_783];
        let expected = ["1970-01-01", "1970-03-01", "2000-02-29", "2000-03-01", "2024-02-29", "2026-11-26"];
        assert_eq!(days.map(date_of), expected);
    }
}
