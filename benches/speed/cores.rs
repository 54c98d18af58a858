//! Measures the gain from more cores: independent work on one thread and on all threads, in turns, in wall-clock time.

use crate::timing::Fallible;
use pxpl5::Study;
use pxpl5::figures::{FigureQuery, FigureSettings};
use pxpl5::sweep::{RunOptions, Shard, Store, Sweep, SweepQuery};
use pxpl5::{ExperimentFile, Level};
use std::fmt::Write;
use std::hint::black_box;
use std::path::Path;
use std::thread;
use std::time::Instant;

/// Settings of a sweep whose points take some tenths of a second each.
const SPACE: &str = "
pipeline = \"slats\"
scene = \"typical:140\"
triangles = 140
fields = 960
measure = [\"latency_ms.mean\"]
[sweep]
seeds = 96
";

/// Work for a number of threads: name, number of rounds, goal as a part of the ideal factor, and function.
type Work<'a> = (&'a str, usize, Option<f64>, Box<dyn Fn(usize) -> Fallible<()> + 'a>);

/// Returns a table of the speed-up on all threads. The first line, in which threads share nothing, shows the largest
/// possible speed-up.
pub(crate) fn table(rounds: usize) -> Fallible<String> {
    let threads = thread::available_parallelism()?.get();
    let folder = std::env::temp_dir().join(format!("pxpl5-speed-{}", std::process::id()));
    let works: [Work<'_>; 3] = [
        ("arithmetic, without memory", rounds, None, Box::new(arithmetic)),
        ("a sweep of 96 points of Slats", rounds, Some(0.95), Box::new(|threads| sweep(&folder, threads))),
        ("all figures (`pxpl5 figures`)", rounds.min(2), Some(0.95), Box::new(figures)),
    ];
    let mut text =
        format!("| work | 1 thread, s | {threads} threads, s | times faster | goal | |\n|---|---|---|---|---|---|\n");
    for (name, rounds, goal, work) in &works {
        let mut best = [f64::INFINITY; 2];
        for _ in 0..*rounds {
            for (threads, best) in [1, threads].into_iter().zip(&mut best) {
                let begin = Instant::now();
                work(threads)?;
                *best = best.min(begin.elapsed().as_secs_f64());
            }
        }
        let [one, all] = best;
        let goal = goal.map(|part| part * threads as f64);
        let missed = if goal.is_some_and(|goal| one / all < goal) { "**missed**" } else { "" };
        let goal = goal.map_or("-".to_owned(), |goal| format!("at least {goal:.2}"));
        writeln!(text, "| {name} | {one:.2} | {all:.2} | {:.2} | {goal} | {missed} |", one / all)?;
    }
    Ok(text)
}

/// Computes the same sums on all threads, with equal shares.
fn arithmetic(threads: usize) -> Fallible<()> {
    const STEPS: u64 = 800_000_000;
    thread::scope(|scope| {
        for thread in 0..threads as u64 {
            scope.spawn(move || {
                let step = |sum: u64, i: u64| black_box(sum.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ i);
                black_box((0..STEPS / threads as u64).fold(thread, step))
            });
        }
    });
    Ok(())
}

fn sweep(folder: &Path, threads: usize) -> Fallible<()> {
    let sweep = Sweep::new(ExperimentFile::parse(SPACE, "space")?)?;
    let mut store = Store::open(folder, sweep.header()?, false)?;
    SweepQuery::new(&sweep, &mut store, RunOptions { shard: Shard::ALL, threads }).run(&mut ())?;
    let failed = store.failed(Shard::ALL).count();
    drop(store);
    std::fs::remove_dir_all(folder)?;
    (failed == 0).then_some(()).ok_or_else(|| format!("{failed} points have no row").into())
}

fn figures(threads: usize) -> Fallible<()> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let query = FigureQuery { settings: FigureSettings::new(Level::Transaction), intervals: true, only: Vec::new() };
    black_box(pool.install(|| query.run(&mut ()))?);
    Ok(())
}
