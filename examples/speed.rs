//! Writes docs/speed.md from what criterion has measured: machine, date, median and spread of every benchmark, and its ratio to the
//! first of its group, which was measured in the same process. `scripts/speed` measures first.
//!
//! `cargo run --example speed [-- TARGET-FOLDER]`

use serde_json::Value;
use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

/// A benchmark as criterion has left it.
struct Measured {
    name: String,
    /// When it was measured, to order a group as it was run.
    at: SystemTime,
    /// Median and its interval of 95 %, nanoseconds an element.
    median_ns: f64,
    low_ns: f64,
    high_ns: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let target = std::env::args().nth(1).unwrap_or_else(|| "target".to_owned());
    let folder = Path::new(&target).join("criterion");
    let mut groups: BTreeMap<String, Vec<Measured>> = BTreeMap::new();
    for benchmark in benchmarks_in(&folder)? {
        let (group, measured) = read(&benchmark)?;
        groups.entry(group).or_default().push(measured);
    }
    if groups.is_empty() {
        return Err(format!("{}: expected what `cargo bench` leaves there, found nothing", folder.display()).into());
    }
    groups.values_mut().for_each(|group| group.sort_by_key(|measured| measured.at));
    std::fs::write("docs/speed.md", page(&groups))?;
    Ok(())
}

/// Folders of the newest measurements.
fn benchmarks_in(folder: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut found = Vec::new();
    let mut left = vec![folder.to_owned()];
    while let Some(folder) = left.pop() {
        let entries = std::fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        for entry in entries {
            let path = entry?.path();
            if path.ends_with("new") && path.join("estimates.json").is_file() {
                found.push(path);
            } else if path.is_dir() {
                left.push(path);
            }
        }
    }
    Ok(found)
}

fn read(folder: &Path) -> Result<(String, Measured), Box<dyn Error>> {
    let estimates = folder.join("estimates.json");
    let benchmark: Value = serde_json::from_slice(&std::fs::read(folder.join("benchmark.json"))?)?;
    let numbers: Value = serde_json::from_slice(&std::fs::read(&estimates)?)?;
    let median = &numbers["median"];
    let interval = &median["confidence_interval"];
    let elements = benchmark["throughput"]["Elements"].as_f64().unwrap_or(1.0);
    let number = |value: &Value| value.as_f64().map(|ns| ns / elements).ok_or("no number in estimates.json");
    let group = benchmark["group_id"].as_str().unwrap_or_default().to_owned();
    let parts = [&benchmark["function_id"], &benchmark["value_str"]];
    let name = parts.iter().filter_map(|part| part.as_str()).collect::<Vec<_>>().join(", ");
    let measured = Measured {
        name,
        at: std::fs::metadata(&estimates)?.modified()?,
        median_ns: number(&median["point_estimate"])?,
        low_ns: number(&interval["lower_bound"])?,
        high_ns: number(&interval["upper_bound"])?,
    };
    Ok((group, measured))
}

fn page(groups: &BTreeMap<String, Vec<Measured>>) -> String {
    let mut page = format!(
        "# Speed\n\nWritten by `scripts/speed` from what `cargo bench` measured; not to be edited. {}, {}, {}.\n\n\
         Times are those of an element (a field, a triangle, a message: see the bench) where the bench says what one is, else of the \
         whole. The interval is that of the median, 95 %; ratios are to the first of the group, measured in the same process.\n\n\
         | group | what | median | interval | ratio |\n|---|---|---|---|---|\n",
        machine(),
        compiler(),
        date()
    );
    for (group, all) in groups {
        let first_ns = all.first().map_or(f64::NAN, |first| first.median_ns);
        for Measured { name, median_ns, low_ns, high_ns, .. } in all {
            let interval = format!("{} to {}", time(*low_ns), time(*high_ns));
            let _ = writeln!(
                page,
                "| {group} | {name} | {} | {interval} | {:.3} |",
                time(*median_ns),
                median_ns / first_ns
            );
        }
    }
    page
}

/// With a unit, three digits.
fn time(ns: f64) -> String {
    match ns {
        ns if ns < 1e3 => format!("{ns:.3} ns"),
        ns if ns < 1e6 => format!("{:.3} us", ns * 1e-3),
        ns if ns < 1e9 => format!("{:.3} ms", ns * 1e-6),
        ns => format!("{:.3} s", ns * 1e-9),
    }
}

fn machine() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model =
        info.lines().find_map(|line| line.strip_prefix("model name")).map(|rest| rest.trim_matches([' ', '\t', ':']));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{} ({cores} threads)", model.unwrap_or("unknown processor"))
}

fn compiler() -> String {
    let version = Command::new("rustc").arg("--version").output();
    version.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned()).unwrap_or_default()
}

/// Today, UTC (Hinnant's algorithm for the civil date of a day).
fn date() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let days = seconds / 86_400 + 719_468;
    let era = days / 146_097;
    let of_era = days % 146_097;
    let year = (of_era - of_era / 1_460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month + 2) / 5 + 1;
    let civil_month = if month < 10 { month + 3 } else { month - 9 };
    let civil_year = year + era * 400 + u64::from(civil_month <= 2);
    format!("{civil_year}-{civil_month:02}-{day:02}")
}
