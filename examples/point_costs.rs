//! Compares the estimated cost of each point of a sweep with its measured CPU time on one thread.
//!
//! `cargo run --release --example point_costs -- OUT SWEEP.toml...` writes OUT/NAME/rows.jsonl for each sweep, for
//! `pxpl5 plot`, OUT/costs.md, the table of docs/guide/sweep-times.md, and OUT/point-costs.svg, its figure of the first
//! sweep. `scripts/costs` runs all steps.

mod panels;

use cpu_time::ThreadTime;
use panels::{AXIS, Panel};
use pxpl5::Fingerprint;
use pxpl5::sweep::{Store, Sweep, SweepRow};
use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Duration;

const USAGE: &str = "usage: point_costs OUT SWEEP.toml...";

/// Quantities that are written for each point, with definitions.
const QUANTITIES: [(&str, &str); 3] = [
    ("cost.estimated_ms", "milliseconds that the point was estimated to take on one thread"),
    ("cost.measured_ms", "milliseconds of CPU that it took on one thread"),
    ("cost.ratio", "measured for estimated"),
];

/// Estimated and measured cost of a point that could be simulated.
struct Cost {
    row: SweepRow,
    /// Name of the pipeline, with a note if its head is tracked.
    group: String,
    estimated_s: f64,
    measured_s: f64,
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
        let costs = measured(&sweep)?;
        let name = Path::new(file).file_stem().unwrap_or_default();
        write(&sweep, &costs, &Path::new(out).join(name))?;
        if all.is_empty() {
            std::fs::write(Path::new(out).join("point-costs.svg"), drawing(&ratios_of_groups(&costs))?)?;
        }
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
            costs.push(Cost { row, group, estimated_s, measured_s });
        }
    }
    Ok(costs)
}

/// Writes the points as the folder of a sweep, with the costs as measured quantities.
fn write(sweep: &Sweep, costs: &[Cost], folder: &Path) -> Result<(), Box<dyn Error>> {
    let mut header = sweep.header()?;
    header.config_hash = Fingerprint::of(format!("costs of {}", header.config_hash).as_bytes()).to_string();
    header.measure = QUANTITIES.into_iter().map(|(name, about)| (name.to_owned(), about.to_owned())).collect();
    let _ = std::fs::remove_dir_all(folder);
    let mut store = Store::open(folder, header, false)?;
    for cost in costs {
        let values = [cost.estimated_s * 1e3, cost.measured_s * 1e3, cost.ratio()];
        let named = QUANTITIES.into_iter().zip(values).map(|((name, _), value)| (name.to_owned(), Some(value)));
        let row = SweepRow { measured: named.collect(), trace_hash: None, ..cost.row.clone() };
        store.append(&row, cost.measured_s)?;
    }
    Ok(store.finish()?)
}

/// Returns the ratios of each group, from the least to the greatest.
fn ratios_of_groups(costs: &[Cost]) -> BTreeMap<&str, Vec<f64>> {
    let mut groups: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for cost in costs {
        groups.entry(&cost.group).or_default().push(cost.ratio());
    }
    groups.values_mut().for_each(|ratios| ratios.sort_by(f64::total_cmp));
    groups
}

/// Returns the least ratio, the ratio at 10, 50 and 90 % of the points, and the greatest ratio.
fn percentiles(ratios: &[f64]) -> [f64; 5] {
    [0.0, 0.1, 0.5, 0.9, 1.0].map(|share| ratios[(share * (ratios.len() - 1) as f64).round() as usize])
}

/// Returns a table of the ratios with a line for each pipeline.
fn table(costs: &[Cost]) -> Result<String, std::fmt::Error> {
    let mut text = "| pipeline | points | ms a point, least to greatest | least | 10 % | median | 90 % | greatest | within a factor of 2 |\n\
                    |---|---|---|---|---|---|---|---|---|\n"
        .to_owned();
    for (name, ratios) in ratios_of_groups(costs) {
        let of_group = costs.iter().filter(|cost| cost.group == name);
        line(&mut text, name, &ratios, of_group.map(|cost| cost.measured_s * 1e3))?;
    }
    let mut ratios: Vec<f64> = costs.iter().map(Cost::ratio).collect();
    ratios.sort_by(f64::total_cmp);
    line(&mut text, "all", &ratios, costs.iter().map(|cost| cost.measured_s * 1e3))?;
    Ok(text)
}

fn line(text: &mut String, name: &str, ratios: &[f64], ms: impl Iterator<Item = f64>) -> std::fmt::Result {
    let near = ratios.iter().filter(|ratio| (0.5..=2.0).contains(*ratio)).count();
    let (least, most) = ms.fold((f64::MAX, 0.0_f64), |(least, most), ms| (least.min(ms), most.max(ms)));
    let [p0, p10, p50, p90, p100] = percentiles(ratios);
    let share = 100.0 * near as f64 / ratios.len() as f64;
    writeln!(
        text,
        "| {name} | {} | {least:.1} to {most:.0} | {p0:.2} | {p10:.2} | {p50:.2} | {p90:.2} | {p100:.2} | {share:.0} % |",
        ratios.len()
    )
}

/// Returns a figure with the ratios of each group: the median as a dot, a thick line from 10 to 90 % of the points, and
/// a thin line from the least to the greatest. Ratios within a factor of two have a grey ground.
fn drawing(groups: &BTreeMap<&str, Vec<f64>>) -> Result<String, std::fmt::Error> {
    let panel = Panel {
        title: "dot: median; thick: 10 to 90 % of the points; grey: within a factor of 2",
        axis: "measured / estimated CPU time",
        at: [176.0, 66.0],
        length: 560.0,
        ends: [0.05, 20.0],
        marks: &[0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0],
        rows: (groups.len(), 24.0),
    };
    let mut svg =
        panels::begin(panel.bottom() + AXIS, "Measured time of the points of a sweep, relative to the estimate", &[]);
    let [half, twice] = [0.5, 2.0].map(|ratio| panel.across(ratio));
    let [top, bottom] = [panel.at[1], panel.bottom()];
    writeln!(svg, r##"<path d="M{half:.1} {top}H{twice:.1}V{bottom}H{half:.1}z" fill="#eef1f4"/>"##)?;
    panel.frame(&mut svg)?;
    for (row, (name, ratios)) in groups.iter().enumerate() {
        let ([p0, p10, p50, p90, p100], y) = (percentiles(ratios), panel.middle(row));
        panel.name(&mut svg, row, name)?;
        let [from, to] = [p10, p90].map(|ratio| panel.across(ratio));
        writeln!(svg, r##"<path d="M{from:.1} {y}H{to:.1}" stroke="#7fb3d9" stroke-width="9"/>"##)?;
        panel.dot(&mut svg, y, [p0, p50, p100], "#0072b2", &format!("median {p50:.2}, {} points", ratios.len()))?;
    }
    svg += "</svg>\n";
    Ok(svg)
}
