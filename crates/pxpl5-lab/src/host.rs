//! The computer on which experiments run, with its clock and its threads for pixels outside simulated time.

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded};
use pxpl5_machine::{PixelWorker, SameThread};
use pxpl5_run::Host;
use pxpl5_wire::PixelSource;
use std::sync::{Arc, LazyLock};
use std::thread::JoinHandle;
use std::time::Instant;

/// The computer on which experiments run, with its clock and worker threads for pixels.
#[derive(Clone, Copy, Debug)]
pub struct Workstation {
    threads: usize,
}

impl Workstation {
    /// Maximum number of regions that wait for a worker thread. More waiting regions would only use memory. If the
    /// queue is full, the simulating thread computes the pixels of the next region itself.
    pub const WAITING_REGIONS: usize = 256;

    /// Creates a host with one worker thread for each core of the computer.
    pub fn new() -> Self {
        Self::with_threads(std::thread::available_parallelism().map_or(1, usize::from))
    }

    /// Creates a host with `threads` worker threads. With 0 threads, the simulating thread computes the pixels.
    pub const fn with_threads(threads: usize) -> Self {
        Self { threads }
    }
}

impl Default for Workstation {
    fn default() -> Self {
        Self::new()
    }
}

/// Zero of the host's clock: the first use of the clock.
static BEGIN: LazyLock<Instant> = LazyLock::new(Instant::now);

impl Host for Workstation {
    fn seconds(&self) -> Option<f64> {
        Some(BEGIN.elapsed().as_secs_f64())
    }

    fn pixel_worker(&self) -> Box<dyn PixelWorker> {
        match self.threads {
            0 => Box::new(SameThread::default()),
            threads => Box::new(PixelThreads::start(threads)),
        }
    }
}

/// A pool of threads that compute pixels. At the end of a run, the simulating thread helps until no region waits.
#[derive(Debug)]
struct PixelThreads {
    regions: Sender<Arc<dyn PixelSource>>,
    waiting: Receiver<Arc<dyn PixelSource>>,
    threads: Vec<JoinHandle<u64>>,
    /// Number of regions whose pixels the simulating thread computed.
    own: u64,
}

impl PixelThreads {
    fn start(threads: usize) -> Self {
        let (regions, waiting) = bounded(Workstation::WAITING_REGIONS);
        let threads = (0..threads).map(|_| start_thread(waiting.clone())).collect();
        Self { regions, waiting, threads, own: 0 }
    }
}

/// Starts a thread that computes the pixels of regions until the queue closes. The thread returns the number of its
/// regions.
fn start_thread(waiting: Receiver<Arc<dyn PixelSource>>) -> JoinHandle<u64> {
    std::thread::spawn(move || compute_all(&waiting))
}

fn compute_all(waiting: &Receiver<Arc<dyn PixelSource>>) -> u64 {
    waiting.iter().fold(0, |regions, region| {
        let _ = region.pixels();
        regions + 1
    })
}

impl PixelWorker for PixelThreads {
    fn compute(&mut self, region: &Arc<dyn PixelSource>) {
        // The simulating thread never waits for space in the queue. If the queue is full, this thread computes the
        // region itself.
        if let Err(TrySendError::Full(region)) = self.regions.try_send(Arc::clone(region)) {
            let _ = region.pixels();
            self.own += 1;
        }
    }

    /// Computes the pixels of all waiting regions and ends the worker threads. Returns the number of all computed
    /// regions. Panics if a worker thread has panicked because of a bug.
    fn finish(self: Box<Self>) -> u64 {
        let Self { regions, waiting, threads, own } = *self;
        // Closing the queue ends the workers once it is empty.
        drop(regions);
        let own = own + compute_all(&waiting);
        threads.into_iter().map(|thread| thread.join().expect("a pixel worker panicked")).sum::<u64>() + own
    }
}
