//! Parallel simulation of the points of a sweep.

use super::point::row;
use super::shard::Shard;
use super::{Store, SweepRow, Swept};
use crate::error::StudyError;
use crate::estimate::Estimate;
use crate::study::Study;
use crossbeam_channel::{Sender, bounded};
use pxpl5_sim::{StopFlag, Watcher};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Instant;

/// Options for running a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunOptions {
    /// Shard (part) of the sweep to run.
    pub shard: Shard,
    /// Number of points that are simulated in parallel.
    pub threads: usize,
}

/// Maximum number of finished rows that wait to be written. A crash loses the waiting rows.
const WAITING_ROWS: usize = 64;

/// The simulation of the points of a shard that have no row yet.
#[derive(Debug)]
pub struct SweepQuery<'a, S> {
    /// The sweep.
    pub sweep: &'a S,
    /// The folder of the sweep.
    pub store: Mutex<&'a mut Store>,
    /// Shard and number of threads.
    pub options: RunOptions,
}

impl<'a, S: Swept> SweepQuery<'a, S> {
    /// Creates the simulation of the points of a shard that have no row in `store`.
    pub const fn new(sweep: &'a S, store: &'a mut Store, options: RunOptions) -> Self {
        Self { sweep, store: Mutex::new(store), options }
    }
}

impl<S: Swept> Study for SweepQuery<'_, S> {
    /// Number of points of the shard that have a row.
    type Report = u64;

    fn estimate(&self, threads: usize) -> Estimate {
        self.sweep.estimate(self.options.shard, threads)
    }

    /// Simulates the points and stores their rows. Simulations in progress end soon after a stop, and their points get
    /// no row.
    fn run(&self, watcher: &mut dyn Watcher) -> Result<u64, StudyError> {
        let (sweep, options, stop) = (self.sweep, self.options, watcher.stop());
        let mut store = self.store.lock().unwrap_or_else(PoisonError::into_inner);
        let all = options.shard.share_of(sweep.space().points());
        let mut done = store.finished(options.shard);
        watcher.progress(done, all);
        let work = Work {
            sweep,
            shard: options.shard,
            finished: store.held(),
            next: AtomicU64::new(0),
            ended: AtomicBool::new(false),
            stop: &stop,
        };
        let (sender, rows) = bounded(WAITING_ROWS);
        // Workers send rows to this thread, which owns the store.
        thread::scope(|scope| {
            let points = usize::try_from(sweep.space().points()).unwrap_or(usize::MAX);
            for _ in 0..options.threads.clamp(1, points.max(1)) {
                let sender = sender.clone();
                scope.spawn(|| work.run(sender));
            }
            drop(sender);
            // This thread alone writes into the store. On an error the workers stop after their current points.
            let result = rows.iter().try_for_each(|(row, seconds)| {
                store.append(&row, seconds)?;
                done += 1;
                watcher.progress(done, all);
                watcher.row("points", &row);
                Ok(())
            });
            work.ended.store(true, Ordering::Relaxed);
            drop(rows);
            result.map(|()| done)
        })
    }
}

/// Work that all threads of a sweep share. Each thread takes one unfinished point at a time.
struct Work<'a, S> {
    sweep: &'a S,
    shard: Shard,
    /// True for each point that was finished before this run of the sweep.
    finished: Vec<bool>,
    next: AtomicU64,
    /// True after a row could not be written, so that no further row can be written.
    ended: AtomicBool,
    stop: &'a StopFlag,
}

impl<S: Swept> Work<'_, S> {
    /// Simulates points on one thread, until no point is left or the receiver of the rows has closed.
    fn run(&self, rows: Sender<(SweepRow, f64)>) {
        while !self.ended.load(Ordering::Relaxed) && !self.stop.is_stopped() {
            let Some(point) = self.take() else { break };
            let begin = Instant::now();
            let row = row(self.sweep, point, self.stop);
            // A point that was stopped has no row.
            let is_stopped = self.stop.is_stopped();
            if is_stopped || rows.send((row, begin.elapsed().as_secs_f64())).is_err() {
                break;
            }
        }
    }

    /// Takes the next point of the shard that has no row and was not taken by another thread. Returns `None` if no
    /// point is left.
    fn take(&self) -> Option<u64> {
        let all = self.sweep.space().points();
        let mut taken =
            std::iter::from_fn(|| Some(self.next.fetch_add(1, Ordering::Relaxed)).filter(|point| *point < all));
        taken.find(|point| self.shard.holds(*point) && !self.finished[*point as usize])
    }
}
