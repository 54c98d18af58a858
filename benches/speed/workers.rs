//! Estimates the speed-up by worker threads for pixels. The work of each region is measured alone, on one thread. From
//! these times, the schedule of 1 to 16 threads is simulated.

use crate::cases::head;
use crate::timing::Fallible;
use cpu_time::ThreadTime;
use pxpl5::device::PixelWorker;
use pxpl5::{Host, Pixels, Workstation};
use pxpl5_wire::PixelSource;
use std::collections::VecDeque;
use std::fmt::Write;
use std::sync::{Arc, Mutex};

/// CPU times in seconds: of the simulating thread before a region is handed over, and of the region's pixels.
type Piece = (f64, f64);

/// A host with a single thread, which records the times of all regions.
#[derive(Clone, Debug, Default)]
struct Noting(Arc<Mutex<Vec<Piece>>>);

impl Host for Noting {
    fn pixel_worker(&self) -> Box<dyn PixelWorker> {
        Box::new(NotingWorker { pieces: Arc::clone(&self.0), since: ThreadTime::now(), regions: 0 })
    }
}

#[derive(Debug)]
struct NotingWorker {
    pieces: Arc<Mutex<Vec<Piece>>>,
    since: ThreadTime,
    regions: u64,
}

impl PixelWorker for NotingWorker {
    fn compute(&mut self, region: &Arc<dyn PixelSource>) {
        let simulating = self.since.elapsed().as_secs_f64();
        let begin = ThreadTime::now();
        let _ = region.pixels();
        let piece = (simulating, begin.elapsed().as_secs_f64());
        self.pieces.lock().expect("no worker panics with it").push(piece);
        self.since = ThreadTime::now();
        self.regions += 1;
    }

    fn finish(self: Box<Self>) -> u64 {
        self.regions
    }
}

/// Returns the total time with a number of workers. The first free worker takes the first region of the queue, whose
/// length is limited. If the queue is full, the simulating thread computes the region itself. At the end of the
/// simulation, this thread becomes a worker too.
fn makespan(pieces: &[Piece], workers: usize) -> f64 {
    let mut free = vec![0.0_f64; workers];
    // Each waiting region has the time of its hand-over and the time of its pixels.
    let mut waiting: VecDeque<(f64, f64)> = VecDeque::new();
    let mut now = 0.0_f64;
    for (simulating, pixels) in pieces {
        now += simulating;
        take_until(now, &mut free, &mut waiting);
        if waiting.len() == Workstation::WAITING_REGIONS || workers == 0 {
            now += pixels;
        } else {
            waiting.push_back((now, *pixels));
        }
    }
    free.push(now);
    take_until(f64::INFINITY, &mut free, &mut waiting);
    free.into_iter().fold(now, f64::max)
}

/// Starts the waiting regions that can begin before `then`, each on the worker that is free first.
fn take_until(then: f64, free: &mut [f64], waiting: &mut VecDeque<(f64, f64)>) {
    while let (Some((handed_over, pixels)), Some(first)) =
        (waiting.front(), free.iter_mut().min_by(|a, b| a.total_cmp(b)))
    {
        let begin = handed_over.max(*first);
        if begin > then {
            return;
        }
        *first = begin + pixels;
        waiting.pop_front();
    }
}

/// Numbers of threads, including the simulating thread.
const THREADS: [usize; 7] = [1, 2, 3, 4, 6, 8, 16];

pub(crate) fn table() -> Fallible<String> {
    const FIELDS: u64 = 480;
    let noting = Noting::default();
    let pairs = head()?.fields(FIELDS).pixels(Pixels::All).host(noting.clone()).run()?.pictures().len();
    let pieces = noting.0.lock().map_err(|_| "a worker panicked")?.clone();
    let simulating: f64 = pieces.iter().map(|piece| piece.0).sum();
    let alone = makespan(&pieces, 0);
    let mut text = format!(
        "This table is computed from the times of {} regions in {pairs} stereo pairs of `head`, measured one by one. A pair\n\
         takes {:.2} ms of simulation and {:.2} ms of drawing. One thread simulates and puts regions into a queue of {}, from\n\
         which the others take them. When the queue is full, and at the end, it draws too. Goal for two threads: 7 ms.\n\n\
         | threads | ms a pair | faster than one | of what the simulating thread alone allows |\n|---|---|---|---|\n",
        pieces.len(),
        simulating / pairs as f64 * 1e3,
        (alone - simulating) / pairs as f64 * 1e3,
        Workstation::WAITING_REGIONS,
    );
    for threads in THREADS {
        let seconds = makespan(&pieces, threads - 1);
        writeln!(
            text,
            "| {threads} | {:.2} | {:.2} | {:.0} % |",
            seconds / pairs as f64 * 1e3,
            alone / seconds,
            simulating / seconds * 100.0
        )?;
    }
    Ok(text)
}
