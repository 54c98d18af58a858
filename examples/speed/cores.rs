//! What more cores are worth: independent work on one thread and on all of this machine, in turns, by the clock on the wall.

use crate::timing::Fallible;
use pxpl5::figures::{Bench, run_all};
use pxpl5::sweep::{RunOptions, Shard, Store, Sweep, run};
use pxpl5::{ExperimentFile, Level};
use std::fmt::Write;
use std::hint::black_box;
use std::path::Path;
use std::thread;
use std::time::Instant;

/// Runs of some tenths of a second.
const SPACE: &str = "
pipeline = \"slats\"
scene = \"typical:140\"
triangles = 140
fields = 960
measure = [\"latency_ms.mean\"]
[sweep]
seeds = 96
";

/// Work that is done with a number of threads, and how often.
type Work<'a> = (&'a str, usize, Option<f64>, Box<dyn Fn(usize) -> Fallible<()> + 'a>);

/// The table: how many times faster it is on all threads than on one. Nothing shares anything in the first line: more than it cannot be had.
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

/// The same sums, dealt out.
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
    run(&sweep, &mut store, RunOptions { shard: Shard::ALL, threads }, |_| {})?;
    let failed = store.failed(Shard::ALL).count();
    drop(store);
    std::fs::remove_dir_all(folder)?;
    (failed == 0).then_some(()).ok_or_else(|| format!("{failed} points have no row").into())
}

fn figures(threads: usize) -> Fallible<()> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    black_box(pool.install(|| run_all(&Bench::new(Level::Transaction)))?);
    Ok(())
}
