//! `pxpl5 sweep`.

use crate::error::CliError;
use crate::options::registry;
use crate::terminal::{complain, print, progress, warn};
use clap::Args;
use pxpl5::sweep::{ROWS_FILE, RunOptions, Shard, Status, Store, Sweep};
use pxpl5::{ExperimentFile, Parameter};
use std::path::PathBuf;

/// Run an experiment at every point of a space of settings.
///
/// Rows are appended to rows.jsonl as points are finished; a point that cannot be simulated has a row that says why, and only when
/// none can the command fails. The file is the same whatever the threads, shards and interruptions.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 sweep experiments/sweep-slats.toml --out out/slats
  pxpl5 sweep experiments/sweep-slats.toml --out out/slats --resume        after an interruption
  pxpl5 sweep experiments/sweep-slats.toml --out out/slats-1 --shard 1/8   one of eight shares; see `pxpl5 merge`")]
pub(crate) struct SweepArgs {
    /// Experiment file with a table `sweep`.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Where rows.jsonl, times.jsonl and results.csv go.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Keep the points that are finished, and run the others.
    #[arg(long)]
    resume: bool,
    /// Run share I of N disjoint ones.
    #[arg(long, value_name = "I/N", value_parser = shard, default_value = "1/1")]
    shard: Shard,
    /// Points at a time; default: one a core.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    threads: Option<u64>,
    /// Set any key of the experiment file for all points; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

pub(crate) fn shard(text: &str) -> Result<Shard, String> {
    let parts = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
    let shard = parts.and_then(|(number, of)| Shard::new(number, of));
    shard.ok_or_else(|| format!("expected a share such as 2/8, from 1/8 to 8/8, found `{text}`"))
}

pub(crate) fn run(args: SweepArgs) -> Result<(), CliError> {
    let mut file = ExperimentFile::with(registry()).and_load(&args.file)?;
    for assignment in &args.sets {
        file.set_text(assignment, "--set")?;
    }
    let sweep = Sweep::new(file)?;
    warn(&supposed(&sweep), args.quiet);
    let mut store = Store::open(&args.out, sweep.header()?, args.resume)?;
    told_when_interrupted(&args)?;
    let held = store.rows().keys().filter(|point| args.shard.holds(**point)).count() as u64;
    let total = args.shard.share_of(sweep.space().points());
    let bar = progress(total, "points", args.quiet);
    bar.set_position(held);
    bar.reset_eta();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let options = RunOptions { shard: args.shard, threads: args.threads.map_or(cores, |threads| threads as usize) };
    pxpl5::sweep::run(&sweep, &mut store, options, |_| bar.inc(1))?;
    bar.finish_and_clear();
    let failed = summarise(&args, &store, total)?;
    store.finish()?;
    if failed >= total { Err(CliError::failure("no point could be simulated")) } else { Ok(()) }
}

/// What no source allows at the first or the last point.
fn supposed(sweep: &Sweep) -> Vec<Parameter> {
    let ends = [0, sweep.space().points() - 1].map(|point| sweep.plan(point).map(|plan| plan.out_of_range()));
    let mut all: Vec<Parameter> = ends.into_iter().flatten().flatten().collect();
    all.dedup();
    all
}

/// How a process that Ctrl-C ended is told from others: 128 and the number of the signal, as shells have it.
const INTERRUPTED: i32 = 130;

/// Ctrl-C ends the sweep and says how it goes on: finished rows are in the file already.
fn told_when_interrupted(args: &SweepArgs) -> Result<(), CliError> {
    let again = again(args);
    let handler = move || {
        complain(&format!("\npxpl5: interrupted; the finished points are kept. To go on:\n  {again}\n"));
        std::process::exit(INTERRUPTED);
    };
    ctrlc::set_handler(handler).map_err(|error| CliError::failure(format!("Ctrl-C cannot be listened for: {error}")))
}

/// The command that goes on with what this one began.
fn again(args: &SweepArgs) -> String {
    let mut words = vec!["pxpl5 sweep".to_owned(), quoted(&args.file.display().to_string())];
    words.extend(["--out".to_owned(), quoted(&args.out.display().to_string())]);
    if args.shard != Shard::ALL {
        words.extend(["--shard".to_owned(), format!("{}/{}", args.shard.number(), args.shard.of())]);
    }
    words.extend(args.threads.map(|threads| format!("--threads {threads}")));
    words.extend(args.sets.iter().map(|set| format!("--set {}", quoted(set))));
    words.push("--resume".to_owned());
    words.join(" ")
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let is_plain = word.chars().all(|c| c.is_alphanumeric() || "-_./=:,".contains(c)) && !word.is_empty();
    if is_plain { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

/// Says where the rows are, and how many of them hold nothing but a reason: so many are given.
fn summarise(args: &SweepArgs, store: &Store, total: u64) -> Result<u64, CliError> {
    let path = args.out.join(ROWS_FILE);
    let ours = store.rows().values().filter(|row| args.shard.holds(row.point));
    let failed: Vec<_> = ours.filter(|row| row.status == Status::Failed).collect();
    if let Some(first) = failed.first() {
        let error = first.error.as_deref().unwrap_or_default();
        let count = failed.len();
        let point = first.point;
        complain(&format!("pxpl5: {count} of {total} points could not be simulated; point {point}: {error}\n"));
    }
    if !args.quiet {
        print(&format!("{total} points are in {}.\n", path.display()))?;
    }
    Ok(failed.len() as u64)
}
