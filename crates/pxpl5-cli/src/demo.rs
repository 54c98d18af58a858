//! The command `pxpl5 demo`, which shows Rendering Control and Slats on built-in scenes. `pxpl5` without a command
//! does the same.

use crate::budget::BudgetArgs;
use crate::error::CliError;
use crate::output::{OutputFolder, timeline};
use crate::run::{comparison, pictures};
use crate::simulate::{How, simulate};
use crate::table::{Comparison, table};
use crate::terminal::print;
use crate::version::{VERSION, commit};
use clap::Args;
use pxpl5::{ExperimentFile, Measure, Outcome, Plan, Report, Results};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::PathBuf;

/// Show Rendering Control and Slats on built-in scenes.
#[derive(Args, Debug)]
#[command(after_help = "Example:
  pxpl5 demo --out /tmp/demo")]
pub(crate) struct DemoArgs {
    /// Folder for pictures and report.json.
    #[arg(long, value_name = "DIR", default_value = OUT)]
    out: PathBuf,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
    #[command(flatten)]
    budget: BudgetArgs,
}

const OUT: &str = "out";

impl Default for DemoArgs {
    fn default() -> Self {
        Self { out: OUT.into(), quiet: false, budget: BudgetArgs::default() }
    }
}

/// Three published measurements that take little time to simulate, with the settings of experiments/figure-*.toml.
/// TR94's trivial scene comes last, because its pictures show only a rectangle.
const EXPERIMENTS: [(&str, &str); 3] = [
    (
        "rendering-control-mig",
        r#"
        pipeline = "rendering-control"
        scene = "mig"
        cull = true
        fields = 360
        machine = { preset = "large" }
        published = { figure = 7, source = "TR94", quantity = "eye_latency_ms.mean", value = 76.91 }
        "#,
    ),
    (
        "slats-aircraft",
        r#"
        pipeline = "slats"
        scene = "aircraft"
        fields = 360
        published = { figure = 9, source = "TR94, I3D95", quantity = "latency_fields.mean", value = 1.0 }
        "#,
    ),
    (
        "rendering-control-full-screen-12",
        r#"
        pipeline = "rendering-control"
        scene = "full-screen:12"
        fields = 360
        published = { figure = 4, source = "TR94", quantity = "eye_latency_ms.mean", value = 56.5 }
        "#,
    ),
];

struct Run {
    name: &'static str,
    outcome: Outcome,
    report: Report,
    comparison: Option<Comparison>,
}

pub(crate) fn run(args: DemoArgs) -> Result<(), CliError> {
    let folder = OutputFolder::of_run(&args.out, "demo")?;
    let runs: Vec<Run> = EXPERIMENTS.iter().map(|(name, text)| one((name, text), &args)).collect::<Result<_, _>>()?;
    // Files are written even with --quiet.
    write(folder, &runs)?;
    if args.quiet {
        return Ok(());
    }
    let columns: Vec<_> = runs.iter().map(|run| (&run.report, run.comparison.as_ref())).collect();
    print(&format!("{}\n{}", table(&columns), closing(&runs, &args)))
}

fn one((name, text): (&'static str, &str), args: &DemoArgs) -> Result<Run, CliError> {
    let plan: Plan = ExperimentFile::parse(text, name)?.resolve()?;
    let how = How { quiet: args.quiet, budget: args.budget, ..How::default() };
    let results = Results::of_run(simulate(&plan, how)?.long_enough()?);
    let comparison = comparison(&plan, &results);
    let (outcome, report) = results.run.ok_or_else(|| CliError::failure("a run without events"))?;
    Ok(Run { name, outcome, report, comparison })
}

fn closing(runs: &[Run], args: &DemoArgs) -> String {
    let seconds: f64 = runs.iter().filter_map(|run| run.report.host_seconds).sum();
    let mut text = String::new();
    // Define the latency of each pipeline once.
    let mut explained = Vec::new();
    for report in runs.iter().map(|run| &run.report) {
        if !explained.contains(&&report.pipeline) {
            let _ = writeln!(text, "Latency of {}: {}.", report.pipeline, report.latency_ms.definition);
            explained.push(&report.pipeline);
        }
    }
    // A published quantity can differ from the latency above it, which is the latency of the whole picture.
    let mut defined = Vec::new();
    for quantity in runs.iter().filter_map(|run| Some(&run.comparison.as_ref()?.quantity)) {
        if let Ok(measure) = Measure::named(quantity)
            && !defined.contains(&measure)
        {
            let _ = writeln!(text, "Published {quantity}: {}.", measure.definition());
            defined.push(measure);
        }
    }
    let _ = writeln!(
        text,
        "Pictures, timelines and report.json are in {}. Simulated in {seconds:.2} s.",
        args.out.display()
    );
    text
}

fn write(mut folder: OutputFolder, runs: &[Run]) -> Result<(), CliError> {
    // Names of files start with the experiment, so that three runs share a folder.
    for run in runs {
        pictures(&mut folder, &format!("{}-", run.name), &run.outcome, &run.report)?;
        folder.put(&format!("{}-pictures.csv", run.name), pxpl5::views::results::csv(&run.outcome).as_bytes())?;
        folder.put(&format!("{}-timeline.svg", run.name), timeline(&run.outcome, &run.report, None).as_bytes())?;
    }
    let entry = |run: &Run| json!({"name": run.name, "report": run.report, "published": run.comparison});
    let runs: Vec<Value> = runs.iter().map(entry).collect();
    let all = json!({"schema": "pxpl5-demo/1", "version": VERSION, "commit": commit(), "runs": runs});
    folder.put("report.json", format!("{all:#}\n").as_bytes())?;
    folder.commit()
}
