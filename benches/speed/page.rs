//! Formats the tables and inserts them into documents.

use crate::cases::{OptimizationRow, Row};
use crate::timing::Fallible;
use std::fmt::Write;
use std::path::Path;
use std::process::Command;

/// Formats a number with three significant digits. Large numbers have all digits of their whole part.
pub(crate) fn digits(number: f64) -> String {
    match number.abs() {
        large if large >= 1e4 => {
            let whole = format!("{:.0}", number);
            let groups: Vec<&str> =
                whole.as_bytes().rchunks(3).rev().map(|group| std::str::from_utf8(group).unwrap_or("")).collect();
            groups.join(",")
        }
        large if large >= 100.0 => format!("{number:.0}"),
        large if large >= 10.0 => format!("{number:.1}"),
        _ => format!("{number:.2}"),
    }
}

pub(crate) fn of_goals(rows: &[Row]) -> String {
    let mut text = "| work | goal | measured | median above best | |\n|---|---|---|---|---|\n".to_owned();
    for row in rows {
        let Row { work, goal, unit, measured, spread, .. } = row;
        let missed = if row.is_missed() { "**missed**" } else { "" };
        let most = if row.is_rate { "at least" } else { "at most" };
        let goal = goal.map_or("-".to_owned(), |goal| format!("{most} {}{unit}", digits(goal)));
        let spread = if spread.is_nan() { "-".to_owned() } else { format!("{:.0} %", spread * 100.0) };
        let _ = writeln!(text, "| {work} | {goal} | {}{unit} | {spread} | {missed} |", digits(*measured));
    }
    text
}

/// Returns the lines that README shows. Their goals are in docs/speed.md.
pub(crate) fn of_summary(rows: &[Row]) -> String {
    let mut text = "| work | measured |\n|---|---|\n".to_owned();
    for Row { summary, unit, measured, .. } in rows {
        if let Some(summary) = summary {
            let _ = writeln!(text, "| {summary} | {}{unit} |", digits(*measured));
        }
    }
    text
}

pub(crate) fn of_optimizations(rows: &[OptimizationRow]) -> String {
    let mut text =
        "| optimization | work | with it, ms a field | without, ms a field | times |\n|---|---|---|---|---|\n"
            .to_owned();
    for OptimizationRow { saving, work, with_ms, without_ms } in rows {
        let times = without_ms / with_ms;
        let _ = writeln!(text, "| {saving} | {work} | {} | {} | {times:.2} |", digits(*with_ms), digits(*without_ms));
    }
    text
}

/// Replaces the text between the marks of a table in a document.
pub(crate) fn replace(path: &Path, name: &str, table: &str) -> Fallible<()> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let begin = format!("<!-- speed: {name} -->\n");
    let end = "<!-- end of speed -->";
    let missing = |mark: &str| format!("{}: expected {mark:?}, found none", path.display());
    let (before, rest) = text.split_once(&begin).ok_or_else(|| missing(&begin))?;
    let (_, after) = rest.split_once(end).ok_or_else(|| missing(end))?;
    Ok(std::fs::write(path, format!("{before}{begin}\n{}\n\n{end}{after}", table.trim_end()))?)
}

/// Returns a sentence about the host, the date and the conditions of the measurement.
pub(crate) fn conditions(rounds: usize, load_before: &str) -> String {
    format!(
        "Measured by `scripts/speed` on {} with {}, {}\n\
         and the profile {}. Values are CPU times of the process, the best of {rounds} alternating rounds. Load averages,\n\
         with the measuring process, were {load_before} at the start and {} at the end.",
        date(),
        machine(),
        compiler(),
        profile(),
        load_average()
    )
}

pub(crate) fn load_average() -> String {
    let loads = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    loads.split(' ').next().filter(|load| !load.is_empty()).unwrap_or("unknown").to_owned()
}

fn machine() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model =
        info.lines().find_map(|line| line.strip_prefix("model name")).map(|rest| rest.trim_matches([' ', '\t', ':']));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{} ({cores} threads)", model.unwrap_or("unknown processor"))
}

fn compiler() -> String {
    said_by("rustc", "--version")
}

/// Returns the name of Cargo's profile, from the folder of the program: `target/PROFILE/examples`.
fn profile() -> String {
    let name = std::env::current_exe().ok().and_then(|path| Some(path.parent()?.parent()?.file_name()?.to_owned()));
    name.map_or_else(|| "unknown".to_owned(), |name| format!("`{}`", name.display()))
}

/// Returns today's date in UTC.
fn date() -> String {
    said_by("date", "-u +%F")
}

/// Returns the output of a command, or an empty text if the command is missing.
fn said_by(command: &str, arguments: &str) -> String {
    let output = Command::new(command).args(arguments.split(' ')).output();
    output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned()).unwrap_or_default()
}
