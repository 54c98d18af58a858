//! The command `pxpl5 run`, which runs one experiment and reports the results.

use crate::error::CliError;
use crate::interrupt;
use crate::numbers::{count_of, number, whole};
use crate::one_picture;
use crate::output::{OutputFolder, png, timeline};
use crate::progress::Progress;
use crate::scenes;
use crate::settings::SettingArgs;
use crate::simulate::{How, Simulated, simulate};
use crate::table::{Comparison, percentiles, table};
use crate::terminal::{AnswerArgs, json_text, print, warn};
use clap::Args;
use pxpl5::lab::near_edges;
use pxpl5::tracking::predict::Training;
use pxpl5::tracking::time::PS_PER_MS;
use pxpl5::views::results::{origin_lines, quantities_csv};
use pxpl5::{
    ExperimentFile, HeadReport, KeptRecords, Level, Measured, Optimization, Origin, Outcome, PictureTimes, Plan,
    Report, Results, SurfaceId, WARM_UP_PERIODS, WARM_UP_PICTURES, WhatIf, WhatIfQuery,
};
use std::fmt::Write;
use std::path::PathBuf;

/// Run one experiment and print its report.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 run --pipeline slats --scene mig --triangles 140 --copy whole
  pxpl5 run --pipeline rendering-control --scene head --machine large --fields 300 --out out/head
  pxpl5 run experiments/figure-04.toml --seed 7 --json
  pxpl5 run --pipeline jitp-scanline-racing --scene full-screen:4 --head pan:200 --tracker fastrak
  pxpl5 run --pipeline slats --scene mig --triangles 100 --set gp.triangle_ns=30000
  pxpl5 run --pipeline slats --scene mig --triangles 50 --level cycle
  pxpl5 run --pipeline rendering-control --scene head --fields 900 --picture 57 --out out/head

Exit code 0: The run succeeded. Exit code 1: The run failed, or it showed no picture after the first four and so has no latency. The report
and all files are written also without a latency, with null for missing results. Exit code 2: The command line or a file is wrong.")]
pub(crate) struct RunArgs {
    #[command(flatten)]
    settings: SettingArgs,
    /// Number of worker threads for --pixels all; default: one for each core; with 0 the simulating thread computes
    /// the pixels.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u64>(0, 1024))]
    threads: Option<u64>,
    /// Disable an optimization of the simulator to measure its effect: idle-boards, transfers, empty-regions or
    /// repeated-code; may be repeated.
    #[arg(long, value_name = "OPTIMIZATION")]
    without: Vec<Optimization>,
    /// Write report.json, results.csv, pictures.csv, experiment.toml, timeline.svg and the last pictures into this
    /// folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Also print the effect of 10 % more of each resource, from seven more runs.
    #[arg(long)]
    what_if: bool,
    /// Also explain one picture: its times and waits, beside those of other pictures. The timeline shows it.
    #[arg(long, value_name = "N", conflicts_with = "json")]
    picture: Option<u64>,
    /// Also print the definitions of latency and of a picture that is due.
    #[arg(long)]
    explain: bool,
    #[command(flatten)]
    answer: AnswerArgs,
}

pub(crate) fn run(args: RunArgs) -> Result<(), CliError> {
    let plan = plan(args.settings.gather()?)?;
    warn(&plan.warnings(), args.answer.quiet);
    // Open the output first, so that a bad path fails before the run.
    let folder = args.out.as_deref().map(|out| OutputFolder::of_run(out, "run")).transpose()?;
    // Files list every picture. The report alone needs only statistics, whose size does not grow with the run.
    let keep =
        if folder.is_some() || args.picture.is_some() { KeptRecords::Everything } else { KeptRecords::Statistics };
    let (without, budget, quiet) = (&args.without[..], args.answer.budget, args.answer.quiet);
    let question = if args.what_if { Some(question(&plan)?) } else { None };
    question.iter().try_for_each(|question| args.answer.budget.admit_study(question, "simulate fewer fields"))?;
    let how = How { threads: args.threads, without, keep, budget, quiet, ..How::default() };
    let Simulated { outcome, too_short } = simulate(&plan, how)?;
    let results = Results::of_run(outcome);
    let Some((outcome, report)) = &results.run else { return Err(no_events()) };
    // After Ctrl-C, the report of the fields so far is the result, and replaces no files of a whole run.
    let is_whole = !interrupt::flag().is_stopped();
    // A file from a folder of results says whether the run repeats those results.
    let changes = plan.origin.changes(&Origin::of(outcome.experiment())).filter(|_| is_whole);
    warn(changes.as_slice(), args.answer.quiet);
    warn(out_of_view(report).as_slice(), args.answer.quiet);
    warn(&near_edges(outcome), args.answer.quiet);
    // A run without a latency still writes its files and its report, and then ends with an error.
    let picture = args.picture.filter(|_| is_whole).map(|number| one_picture::find(outcome, number));
    let drawn = picture.as_ref().and_then(|found| found.as_ref().ok().copied());
    let written = folder.filter(|_| is_whole).map(|folder| write(folder, &plan, &results, drawn)).transpose()?;
    let picture = picture.transpose()?;
    let more = question
        .filter(|_| is_whole)
        .map(|question| Progress::new("resources", args.answer.quiet).run(&question))
        .transpose()?;
    if args.answer.json {
        print(&with_more(report, more.as_deref())?)?;
    } else if !args.answer.quiet {
        print(&text((&plan, &results, report), args.explain, written))?;
        print(&picture.map(|times| one_picture::text(outcome, report, times)).unwrap_or_default())?;
        print(&more.map(|more| more_text(&more)).unwrap_or_default())?;
    }
    // The exit code shows scripts that the report lacks a latency.
    match too_short {
        Some(error) => Err(error),
        None if report.shown == 0 => Err(nothing_shown(report)),
        None if report.latency_ms.statistics.n == 0 => Err(nothing_measured(report)),
        None => Ok(()),
    }
}

/// Returns the question of the effect of 10 % more of each resource of the machine, one resource at a time.
fn question(plan: &Plan) -> Result<WhatIfQuery, CliError> {
    let experiment = plan.experiment(scenes::load(plan, true)?);
    Ok(WhatIfQuery { registry: plan.registry.clone(), experiment })
}

fn more_text(more: &[WhatIf]) -> String {
    let mut text = String::new();
    let level = more.first().map_or("", |more| more.level);
    let heads = ["10 % more of", "setting", "latency, ms", "updates, Hz"];
    let _ = writeln!(text, "\n{:<32} {:<42} {:<16} {} ({level} level)", heads[0], heads[1], heads[2], heads[3]);
    more.iter().for_each(|more| {
        let _ = writeln!(text, "{more}");
    });
    text
}

fn with_more(report: &Report, more: Option<&[WhatIf]>) -> Result<String, CliError> {
    let Some(more) = more else { return json_text(report) };
    let mut value = serde_json::to_value(report).map_err(CliError::failure)?;
    value["what_if"] = serde_json::to_value(more).map_err(CliError::failure)?;
    json_text(&value)
}

/// Returns the error for a run in which every picture missed its deadline. A longer run would not help.
fn nothing_shown(report: &Report) -> CliError {
    let advice = report.too_heavy.as_ref().map_or("draw fewer primitives (--triangles)", |heavy| &heavy.advice);
    CliError::failure(format!(
        "no complete picture was shown in {}: {} came after their deadline; {advice}",
        count_of(report.fields, "field"),
        count_of(report.late_regions, "region")
    ))
}

/// Returns the error for a run in which all pictures belong to the warm-up. The number of fields that the error advises
/// has two pictures after the warm-up at the rate of this run.
fn nothing_measured(report: &Report) -> CliError {
    if let Some(heavy) = &report.too_heavy {
        return CliError::failure(format!("no picture after the warm-up was shown in time: {}", heavy.advice));
    }
    let every = report.fields.div_ceil(report.shown.max(1));
    let needed = WARM_UP_PERIODS.max((WARM_UP_PICTURES as u64 + 1) * every) + 2 * every;
    let moving =
        if report.arp.is_some() { " with a head that moves, because a still one needs no updates" } else { "" };
    CliError::failure(format!(
        "no picture has a latency: the warm-up takes {WARM_UP_PERIODS} fields and {WARM_UP_PICTURES} pictures, and the run has {} \
         with {}; simulate about {needed} fields{moving}",
        count_of(report.fields, "field"),
        count_of(report.shown, "picture")
    ))
}

fn text((plan, results, report): (&Plan, &Results, &Report), explain: bool, written: Option<PathBuf>) -> String {
    let comparison = comparison(plan, results);
    let mut text = String::new();
    // Warnings come first: a scene that is too heavy, then faults of a display.
    if let Some(heavy) = &report.too_heavy {
        let _ = writeln!(text, "{heavy}\n");
    }
    for fault in &report.display_faults {
        let _ = writeln!(text, "WRONG: {fault}\n");
    }
    text.push_str(&table(&[(report, comparison.as_ref())]));
    if explain {
        let _ = writeln!(text, "\nLatency: {}.", report.latency_ms.definition);
        let _ = writeln!(text, "Pictures due: {}.", report.due_definition);
    } else {
        text.push_str("\n--explain prints the definitions of latency and of pictures due.\n");
    }
    if let Some(lines) = report.lines_never_shown().filter(|lines| *lines > 0) {
        let _ = writeln!(text, "Lines that were overwritten before they had been shown: {lines}.");
    }
    // A run with a tracked head has a latency to light and an error in pixels.
    if let Some(head) = &report.head {
        let HeadReport { tracker, predictor, training, aim, display, end_to_end, error, .. } = head;
        let tuned = training.map_or_else(String::new, |on| {
            let Training { interval_ps, mean_deg, none_deg, velocity_deg, .. } = on;
            format!(
                ", tuned for {} ms: {mean_deg:.2} degrees there, {none_deg:.2} without prediction, {velocity_deg:.2} by velocity",
                interval_ps / PS_PER_MS
            )
        });
        let _ = writeln!(
            text,
            "Head to light: {} ms, n {} ({tracker}, prediction {predictor}{tuned}, aim {aim}); 50, 95, 99 %: {} ms.",
            number(end_to_end.total_ms, 2),
            end_to_end.n,
            percentiles(&report.percentiles_ms.head_to_light, 2),
        );
        let wrong = &report.percentiles_ms.prediction_interval_error;
        if wrong.max > 0.0 {
            let _ = writeln!(text, "Prediction interval: wrong by {:.2} ms, at most {:.2} ms.", wrong.mean, wrong.max);
        }
        let covered = error
            .covered_share
            .map_or_else(String::new, |share| format!("; the scene covers {:.1} % of the picture", share * 100.0));
        let _ = writeln!(
            text,
            "Pixel error (display {display}): mean {} px, median {} px, 95 % {} px, mean {} degrees, n {}, {:.1} % of it outside of the view{covered}.",
            number(error.pixels.mean, 2),
            number(error.pixels.p50, 2),
            number(error.pixels.p95, 2),
            number(error.degrees.mean, 3),
            error.pixels.n,
            error.outside as f64 / error.evaluated.max(1) as f64 * 100.0
        );
    }
    if report.arp.is_none() {
        let _ = writeln!(text, "{}.", report.hmd);
    }
    if let Some(utilisation) = &report.utilisation {
        let _ = writeln!(text, "\n{utilisation}.");
    }
    if let Some(path) = &report.critical_path {
        let _ = writeln!(text, "Limited by: {}.", path.limited_by);
        let others = path.parts.iter().skip(1).filter(|part| part.share >= 0.005);
        let others: Vec<String> =
            others.map(|part| format!("{} {:.0} %", part.resource.about(), part.share * 100.0)).collect();
        if !others.is_empty() {
            let _ = writeln!(text, "  then: {}.", others.join(", "));
        }
    }
    if let Some(path) = written {
        let _ = writeln!(text, "Written to {}.", path.display());
    }
    text
}

/// Share of the picture below which a scene hardly has anything to do with the error.
pub(crate) const MIN_COVERED: f64 = 0.05;

fn out_of_view(report: &Report) -> Option<String> {
    let share = report.head.as_ref()?.error.covered_share.filter(|share| *share < MIN_COVERED)?;
    Some(format!(
        "the scene covers only {:.1} % of the picture, so the error is that of the background; --place content turns the head towards it",
        share * 100.0
    ))
}

/// Returns the plan of an experiment file. Fails for sweeps and for the analytic level.
fn plan(file: ExperimentFile) -> Result<Plan, CliError> {
    if file.is_sweep() {
        return Err(CliError::usage("this file describes a sweep: use `pxpl5 sweep FILE --out DIR`"));
    }
    let plan = file.resolve()?;
    if plan.level == Level::Analytic {
        return Err(no_events());
    }
    Ok(plan)
}

fn no_events() -> CliError {
    CliError::usage("level: a run needs transaction or cycle; the analytic level has no events and is for sweeps")
}

pub(crate) fn comparison(plan: &Plan, results: &Results) -> Option<Comparison> {
    let published = plan.published.as_ref()?;
    let source = published.source.clone().unwrap_or_default();
    let figure = published.figure.map_or_else(String::new, |figure| format!("figure {figure}, "));
    let simulated = published.quantity.of(results)?;
    Some(Comparison {
        quantity: published.quantity.name().to_owned(),
        published: published.value,
        simulated,
        error_percent: (simulated / published.value - 1.0) * 100.0,
        source: format!("{figure}{source}"),
    })
}

fn write(
    mut folder: OutputFolder,
    plan: &Plan,
    results: &Results,
    picture: Option<&PictureTimes>,
) -> Result<PathBuf, CliError> {
    let Some((outcome, report)) = &results.run else { return Err(no_events()) };
    // The experiment file reproduces the run from any folder.
    folder.put("report.json", json_text(report)?.as_bytes())?;
    folder.put(
        "experiment.toml",
        format!("{}{}", origin_lines(report, "# "), plan.settings_in(folder.path(), outcome.experiment())).as_bytes(),
    )?;
    // Files that the experiment's `output` keys turn off are left out.
    if plan.output.csv {
        folder.put("results.csv", quantities_csv(&plan.measure, results).as_bytes())?;
        folder.put("pictures.csv", pxpl5::views::results::csv(outcome).as_bytes())?;
    }
    #[cfg(feature = "parquet")]
    folder.put("pictures.parquet", &parquet(outcome)?)?;
    if plan.output.pictures {
        pictures(&mut folder, "", outcome, report)?;
    }
    if plan.output.timeline {
        folder.put("timeline.svg", timeline(outcome, report, picture.map(|times| times.picture)).as_bytes())?;
    }
    let path = folder.path().to_path_buf();
    folder.commit()?;
    Ok(path)
}

pub(crate) const INCOMPLETE: &str = "-incomplete";

/// Writes the last displayed picture of each surface. Each file name starts with `prefix`.
pub(crate) fn pictures(
    folder: &mut OutputFolder,
    prefix: &str,
    outcome: &Outcome,
    report: &Report,
) -> Result<(), CliError> {
    let surfaces: Vec<(SurfaceId, &str)> =
        outcome.record().surfaces().map(|(id, surface)| (id, surface.label)).collect();
    for (surface, label) in surfaces {
        if let Some(picture) = outcome.picture(surface) {
            let mark = if report.ends_complete { "" } else { INCOMPLETE };
            folder.put(&format!("{prefix}{label}{mark}.png"), &png(&picture, report)?)?;
        }
    }
    Ok(())
}

#[cfg(feature = "parquet")]
fn parquet(outcome: &Outcome) -> Result<Vec<u8>, CliError> {
    let mut bytes = Vec::new();
    pxpl5::views::results::parquet(outcome, &mut bytes).map_err(CliError::failure)?;
    Ok(bytes)
}
