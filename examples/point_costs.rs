//! Compares the estimated cost of each point of a sweep with its measured CPU time on one thread.
//!
//! `cargo run --release --example point_costs -- OUT SWEEP.toml...` writes OUT/NAME/rows.jsonl for each sweep, for
//! `pxpl5 plot`, and OUT/costs.md, the table of docs/guide/sweep-times.md. `scripts/costs` runs all steps.

use cpu_time::ThreadTime;
use pxpl5::Fingerprint;
use pxpl5::sweep::{Store, Sweep, SweepRow};
use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Duration;

const USAGE: &str = "usage: point_costs OUT SWEEP.toml...";

/// Quantities that are written for each point, with definitions.
const QUANTITIES: [(&str, &str); 4] = [
    ("cost.estimated_ms", "milliseconds that the point was estimated to take on one thread"),
    ("cost.measured_ms", "milliseconds of CPU that it took on one thread"),
    ("cost.ratio", "measured for estimated"),
    ("cost.percent", "share of its pipeline's points, in per cent, whose ratio is no greater"),
];

/// Estimated and measured cost of a point that could be simulated.
struct Cost {
    row: SweepRow,
    /// Name of the pipeline, with a note if its head is tracked.
    group: String,
    estimated_s: f64,
    measured_s: f64,
    percent: f64,
}

impl Cost {
    fn ratio(&self) -> f64 {
        self.measured_s / self.estimated_s
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let (out, files) = args.split_first().filter(|(_, files)| !files.is_empty()).ok_or(USAGE)?;
    let mut all = Vec::new();
    for file in files {
        let sweep = Sweep::load(file)?;
        let mut costs = measured(&sweep)?;
        rank(&mut costs);
        let name = Path::new(file).file_stem().unwrap_or_default();
        write(&sweep, &costs, &Path::new(out).join(name))?;
        all.extend(costs);
    }
    let table = table(&all)?;
    print!("{table}");
    // The page has only the line of all points, because its picture shows the pipelines.
    let lines: Vec<&str> = table.lines().collect();
    let short = [&lines[..2], &lines[lines.len() - 1..]].concat();
    std::fs::write(Path::new(out).join("costs.md"), short.join("\n") + "\n")?;
    Ok(())
}

/// Measures all points that can be simulated, one after the other.
fn measured(sweep: &Sweep) -> Result<Vec<Cost>, Box<dyn Error>> {
    let mut costs = Vec::new();
    // Scenes are loaded first, so that no point includes the loading time.
    let estimates = sweep.costs(&(0..sweep.space().points()).collect::<Vec<_>>());
    for (point, estimated_s) in (0..).zip(estimates) {
        // CPU time is measured, because other work on the host does not affect it.
        let begin = ThreadTime::try_now()?;
        let rows = sweep.rows(&[point], Duration::MAX);
        let measured_s = begin.try_elapsed()?.as_secs_f64();
        for (row, _) in rows.into_iter().filter(|(row, _)| row.is_done()) {
            let plan = sweep.plan(point)?;
            let head = if plan.head.is_some() { ", tracked head" } else { "" };
            let group = format!("{}{head}", plan.pipeline.name());
            costs.push(Cost { row, group, estimated_s, measured_s, percent: 0.0 });
        }
    }
    Ok(costs)
}

/// Computes, for each point, the percentage of its group with the same or a smaller ratio.
fn rank(costs: &mut [Cost]) {
    let mut ratios: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for cost in costs.iter() {
        ratios.entry(cost.group.clone()).or_default().push(cost.ratio());
    }
    for cost in costs {
        let of_group = &ratios[&cost.group];
        let below = of_group.iter().filter(|ratio| **ratio <= cost.ratio()).count();
        cost.percent = 100.0 * below as f64 / of_group.len() as f64;
    }
}

/// Writes the points as the folder of a sweep, with the costs as measured quantities.
fn write(sweep: &Sweep, costs: &[Cost], folder: &Path) -> Result<(), Box<dyn Error>> {
    let mut header = sweep.header()?;
    header.config_hash = Fingerprint::of(format!("costs of {}", header.config_hash).as_bytes()).to_string();
    header.measure = QUANTITIES.into_iter().map(|(name, about)| (name.to_owned(), about.to_owned())).collect();
    let _ = std::fs::remove_dir_all(folder);
    let mut store = Store::open(folder, header, false)?;
    for cost in costs {
        let values = [cost.estimated_s * 1e3, cost.measured_s * 1e3, cost.ratio(), cost.percent];
        let named = QUANTITIES.into_iter().zip(values).map(|((name, _), value)| (name.to_owned(), Some(value)));
        let row = SweepRow { measured: named.collect(), trace_hash: None, ..cost.row.clone() };
        store.append(&row, cost.measured_s)?;
    }
    Ok(store.finish()?)
}

/// Returns a table of the ratios with a line for each pipeline.
fn table(costs: &[Cost]) -> Result<String, std::fmt::Error> {
    let mut groups: BTreeMap<&str, Vec<&Cost>> = BTreeMap::new();
    for cost in costs {
        groups.entry(&cost.group).or_default().push(cost);
    }
    let mut text = "| pipeline | points | ms a point, least to greatest | least | 10 % | median | 90 % | greatest | within a factor of 2 |\n\
                    |---|---|---|---|---|---|---|---|---|\n"
        .to_owned();
    for (name, of_group) in groups {
        line(&mut text, name, &of_group)?;
    }
    line(&mut text, "all", &costs.iter().collect::<Vec<_>>())?;
    Ok(text)
}

fn line(text: &mut String, name: &str, costs: &[&Cost]) -> std::fmt::Result {
    let mut ratios: Vec<f64> = costs.iter().map(|cost| cost.ratio()).collect();
    ratios.sort_by(f64::total_cmp);
    let at = |share: f64| ratios[(share * (ratios.len() - 1) as f64).round() as usize];
    let near = ratios.iter().filter(|ratio| (0.5..=2.0).contains(*ratio)).count();
    let least = costs.iter().map(|cost| cost.measured_s).fold(f64::MAX, f64::min) * 1e3;
    let most = costs.iter().map(|cost| cost.measured_s).fold(0.0, f64::max) * 1e3;
    let [p0, p10, p50, p90, p100] = [0.0, 0.1, 0.5, 0.9, 1.0].map(at);
    let share = 100.0 * near as f64 / ratios.len() as f64;
    writeln!(
        text,
        "| {name} | {} | {least:.1} to {most:.0} | {p0:.2} | {p10:.2} | {p50:.2} | {p90:.2} | {p100:.2} | {share:.0} % |",
        ratios.len()
    )
}
