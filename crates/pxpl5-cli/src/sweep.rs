//! The command `pxpl5 sweep`, which runs an experiment at every point of a parameter space.

use crate::budget::BudgetArgs;
use crate::error::CliError;
use crate::numbers::{are, count_of, whole};
use crate::options::registry;
use crate::progress::Progress;
use crate::slurm::{self, Jobs, quoted};
use crate::terminal::{print, print_error, warn};
use clap::Args;
use pxpl5::ExperimentFile;
use pxpl5::sweep::{Header, ROWS_FILE, RunOptions, Shard, Store, Sweep, SweepQuery, Swept};
use std::path::{Path, PathBuf};

/// Run an experiment at every point of a parameter space.
///
/// Each finished point appends a row to rows.jsonl. A point that cannot be simulated has a row with the reason; the
/// command fails only if no point can be simulated. The file does not depend on threads, shards or interruptions.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 sweep experiments/sweep-slats.toml --out out/slats
  pxpl5 sweep experiments/sweep-slats.toml --out out/slats --resume        after an interruption
  pxpl5 sweep experiments/sweep-slats.toml --out out/slats-1 --shard 1/8   one of eight shares; see `pxpl5 merge`
  pxpl5 sweep experiments/sweep-slats.toml --out out/slats --slurm jobs    writes jobs for Slurm; start them with bash jobs/submit.sh")]
pub(crate) struct SweepArgs {
    #[command(flatten)]
    folder: SweepFolderArgs,
    /// Run nothing, but write scripts into DIR that submit the sweep to Slurm. They submit an array of tasks with
    /// estimated time and memory, and a job that joins their rows in --out.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["resume", "shard"])]
    slurm: Option<PathBuf>,
    /// Number of tasks in the Slurm array; default: estimated for about a quarter of an hour per task.
    #[arg(long, value_name = "N", requires = "slurm", value_parser = whole::<u64>(1, 1_000_000))]
    tasks: Option<u64>,
    /// Number of points simulated in parallel; default: one for each core, but only one in a Slurm task.
    #[arg(long, value_name = "N", value_parser = whole::<u64>(1, 1024))]
    threads: Option<u64>,
    /// Refuse a sweep that would take more memory than this, in MB of 10^6 bytes.
    #[arg(long, value_name = "MB", value_parser = whole::<u64>(1, 1_000_000_000))]
    max_memory: Option<u64>,
    /// Refuse a sweep that would take longer than this, in seconds; default: no limit, because a sweep can be
    /// interrupted and resumed.
    #[arg(long, value_name = "S", value_parser = whole::<u64>(1, 1_000_000_000))]
    max_seconds: Option<u64>,
}

/// The file of a sweep, and the folder that stores its rows.
#[derive(Args, Debug)]
pub(crate) struct SweepFolderArgs {
    /// File of settings. Its table `sweep` describes the points.
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// Folder for rows.jsonl, times.jsonl and results.csv.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Keep the finished points and run only the others.
    #[arg(long)]
    resume: bool,
    /// Run only shard I of N. Each of the N shards has its own points.
    #[arg(long, value_name = "I/N", value_parser = shard, default_value = "1/1")]
    pub(crate) shard: Shard,
    /// Set any key of the file for all points; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) sets: Vec<String>,
    /// Print nothing but errors.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

fn shard(text: &str) -> Result<Shard, String> {
    let parts = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
    let shard = parts.and_then(|(number, of)| Shard::new(number, of));
    shard.ok_or_else(|| format!("expected a share such as 2/8, from 1/8 to 8/8, found `{text}`"))
}

pub(crate) fn run(args: SweepArgs) -> Result<(), CliError> {
    let mut file = ExperimentFile::with(registry()).and_load(&args.folder.file)?;
    for assignment in &args.folder.sets {
        file.set_text(assignment, "--set")?;
    }
    let sweep = Sweep::new(file)?;
    warn(&supposed(&sweep), args.folder.quiet);
    // With --slurm nothing is simulated.
    if let Some(folder) = &args.slurm {
        return write_jobs(&args, &sweep, folder);
    }
    let header = sweep.header()?;
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = args.threads.map_or(cores, |threads| threads as usize);
    args.admit(&sweep, threads)?;
    args.folder.run(
        &sweep,
        header,
        &SweepCommand { name: "sweep", verb: "simulated", parallel: threads, threads: args.threads },
    )
}

/// Words and numbers that differ between the commands `pxpl5 sweep` and `pxpl5 volume sweep`.
#[derive(Debug)]
pub(crate) struct SweepCommand {
    pub(crate) name: &'static str,
    /// Participle for the work at a point, for example "simulated".
    pub(crate) verb: &'static str,
    pub(crate) parallel: usize,
    pub(crate) threads: Option<u64>,
}

impl SweepFolderArgs {
    /// Runs the points without a stored row, and stores their rows. Ctrl-C ends the sweep, and prints the command that
    /// resumes it.
    ///
    /// Fails if no point can be simulated.
    pub(crate) fn run(&self, sweep: &impl Swept, header: Header, command: &SweepCommand) -> Result<(), CliError> {
        // The store keeps finished rows, so that Ctrl-C loses only the points in progress.
        let mut store = Store::open(&self.out, header, self.resume)?;
        let total = self.shard.share_of(sweep.space().points());
        let kept = format!("the finished points are kept. To continue:\n  {}", self.again(command));
        let options = RunOptions { shard: self.shard, threads: command.parallel };
        let progress = Progress::new("points", self.quiet).keeping(&kept).on_row(|_, _, _| ());
        if progress.run(&SweepQuery::new(sweep, &mut store, options))? < total {
            return Ok(());
        }
        // A sweep succeeds if at least one point could be simulated.
        let failed = report_failures(&mut store, self.shard, total, command.verb)?;
        if !self.quiet {
            print(&format!("{} in {}.\n", are(total, "point"), self.out.join(ROWS_FILE).display()))?;
        }
        store.finish()?;
        if failed >= total { Err(CliError::failure(format!("no point could be {}", command.verb))) } else { Ok(()) }
    }

    fn again(&self, command: &SweepCommand) -> String {
        let mut words = vec![format!("pxpl5 {}", command.name), quoted(&self.file.display().to_string())];
        words.extend(["--out".to_owned(), quoted(&self.out.display().to_string())]);
        // Only options that differ from their defaults are repeated.
        if self.shard != Shard::ALL {
            words.extend(["--shard".to_owned(), format!("{}/{}", self.shard.number(), self.shard.of())]);
        }
        words.extend(command.threads.map(|threads| format!("--threads {threads}")));
        words.extend(self.sets.iter().map(|set| format!("--set {}", quoted(set))));
        words.push("--resume".to_owned());
        words.join(" ")
    }
}

impl SweepArgs {
    fn admit(&self, sweep: &Sweep, threads: usize) -> Result<(), CliError> {
        // The estimate of hundreds of points takes seconds, so a sweep without limits skips the estimate.
        if self.max_memory.is_none() && self.max_seconds.is_none() {
            return Ok(());
        }
        let estimate = sweep.estimate(self.folder.shard, threads);
        BudgetArgs::of(self.max_memory, self.max_seconds).admit_estimate(estimate, "sweep fewer points")
    }
}

fn write_jobs(args: &SweepArgs, sweep: &Sweep, folder: &Path) -> Result<(), CliError> {
    sweep.header()?;
    let threads = args.threads.unwrap_or(1);
    let jobs =
        Jobs { file: &args.folder.file, sets: &args.folder.sets, out: &args.folder.out, tasks: args.tasks, threads };
    let written = slurm::write(sweep, &jobs, folder)?;
    if args.folder.quiet { Ok(()) } else { print(&written.text()) }
}

/// Returns the warnings about unsupported settings at the first and the last point of the sweep.
fn supposed(sweep: &Sweep) -> Vec<String> {
    let ends = [0, sweep.space().points() - 1].map(|point| sweep.plan(point).map(|plan| plan.warnings()));
    let mut all: Vec<String> = ends.into_iter().flatten().flatten().collect();
    all.dedup();
    all
}

/// Prints the number of failed points of a shard (part of a sweep), and the error of the first failed point. Returns
/// the number of failed points.
fn report_failures(store: &mut Store, shard: Shard, total: u64, done: &str) -> Result<u64, CliError> {
    let failed = store.failed(shard).count() as u64;
    let first = store.failed(shard).next();
    if let Some(point) = first {
        let error = store.row(point)?.and_then(|row| row.error).unwrap_or_default();
        let all = count_of(total, "point");
        print_error(&format!("pxpl5: {failed} of {all} could not be {done}; point {point}: {error}\n"));
    }
    Ok(failed)
}
