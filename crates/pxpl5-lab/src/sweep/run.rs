//! Simulating the points of a sweep on all cores.

use super::points::Points;
use super::shard::Shard;
use super::{Store, Sweep, SweepError, SweepRow};
use crossbeam_channel::{Sender, bounded};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::Instant;

/// How to run a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunOptions {
    /// The share to run.
    pub shard: Shard,
    /// Points at a time.
    pub threads: usize,
}

/// Rows that may wait to be written; more would only delay what a kill loses.
const WAITING_ROWS: usize = 64;

/// Simulates the points of a shard that the store does not hold yet; `finished` hears of every row once it is stored.
///
/// # Errors
///
/// [`SweepError::Io`] when a row cannot be stored; the points in hand are finished first and lost.
pub fn run(
    sweep: &Sweep,
    store: &mut Store,
    options: RunOptions,
    mut finished: impl FnMut(&SweepRow),
) -> Result<(), SweepError> {
    let work = Work {
        sweep,
        shard: options.shard,
        finished: store.held(),
        next: AtomicU64::new(0),
        stop: AtomicBool::new(false),
    };
    let (sender, rows) = bounded(WAITING_ROWS);
    thread::scope(|scope| {
        let points = usize::try_from(sweep.space().points()).unwrap_or(usize::MAX);
        for _ in 0..options.threads.clamp(1, points.max(1)) {
            let sender = sender.clone();
            scope.spawn(|| work.run(sender));
        }
        drop(sender);
        let result = rows.iter().try_for_each(|(row, seconds)| {
            store.append(&row, seconds)?;
            finished(&row);
            Ok(())
        });
        work.stop.store(true, Ordering::Relaxed);
        drop(rows);
        result
    })
}

/// The points that are missing, which all threads take from, one at a time.
struct Work<'a> {
    sweep: &'a Sweep,
    shard: Shard,
    /// Points that were finished before.
    finished: Points,
    /// Number of the next point that somebody may take.
    next: AtomicU64,
    stop: AtomicBool,
}

impl Work<'_> {
    /// What one thread does: it simulates points until there are no more, or nobody wants their rows.
    fn run(&self, rows: Sender<(SweepRow, f64)>) {
        while !self.stop.load(Ordering::Relaxed) {
            let Some(point) = self.take() else { break };
            let begin = Instant::now();
            let row = self.sweep.row(point);
            if rows.send((row, begin.elapsed().as_secs_f64())).is_err() {
                break;
            }
        }
    }

    /// A point of the shard that nobody has simulated or taken; `None` when there are no more.
    fn take(&self) -> Option<u64> {
        let all = self.sweep.space().points();
        let mut taken =
            std::iter::from_fn(|| Some(self.next.fetch_add(1, Ordering::Relaxed)).filter(|point| *point < all));
        taken.find(|point| self.shard.holds(*point) && !self.finished.holds(*point))
    }
}
