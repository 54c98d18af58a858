//! `pxpl5 sweep`.

use crate::error::CliError;
use crate::options::registry;
use crate::terminal::{complain, print, progress};
use clap::Args;
use pxpl5::ExperimentFile;
use pxpl5::sweep::{ROWS_FILE, RunOptions, Shard, Status, Store, Sweep};
use std::path::PathBuf;

/// Run an experiment at every point of a space of settings.
///
/// Rows are appended to rows.jsonl as points are finished; a point that cannot be simulated has a row that says why.
/// The file is the same whatever the threads, shards and interruptions.
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

fn shard(text: &str) -> Result<Shard, String> {
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
    let mut store = Store::open(&args.out, sweep.header()?, args.resume)?;
    let points: Vec<u64> = (0..sweep.space().points()).filter(|point| args.shard.holds(*point)).collect();
    let held = points.iter().filter(|point| store.holds(**point)).count();
    let total = points.len();
    let bar = progress(total as u64, "points", args.quiet);
    bar.set_position(held as u64);
    bar.reset_eta();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let options = RunOptions { shard: args.shard, threads: args.threads.map_or(cores, |threads| threads as usize) };
    pxpl5::sweep::run(&sweep, &mut store, options, |_| bar.inc(1))?;
    bar.finish_and_clear();
    summarise(&args, &store, total)?;
    Ok(store.finish()?)
}

fn summarise(args: &SweepArgs, store: &Store, total: usize) -> Result<(), CliError> {
    let path = args.out.join(ROWS_FILE);
    let failed: Vec<_> = store.rows().values().filter(|row| row.status == Status::Failed).collect();
    if let Some(first) = failed.first() {
        let error = first.error.as_deref().unwrap_or_default();
        let count = failed.len();
        let point = first.point;
        complain(&format!("pxpl5: {count} of {total} points could not be simulated; point {point}: {error}\n"));
    }
    if args.quiet { Ok(()) } else { print(&format!("{total} points are in {}.\n", path.display())) }
}
