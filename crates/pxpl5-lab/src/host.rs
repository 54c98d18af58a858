//! The computer that experiments run on: its clock, and threads that compute pixels apart from simulated time.

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded};
use pxpl5_machine::{PixelWorker, SameThread};
use pxpl5_run::Host;
use pxpl5_wire::PixelSource;
use std::sync::{Arc, LazyLock};
use std::thread::JoinHandle;
use std::time::Instant;

/// This computer: a clock, and worker threads for pixels.
#[derive(Clone, Copy, Debug)]
pub struct Workstation {
    threads: usize,
}

impl Workstation {
    /// Regions that may wait for a worker thread; more would only hold memory. Where so many wait, the thread that simulates computes the
    /// next one itself.
    pub const WAITING_REGIONS: usize = 256;

    /// With a worker thread for each core.
    #[must_use]
    pub fn new() -> Self {
        Self::with_threads(std::thread::available_parallelism().map_or(1, usize::from))
    }

    /// With so many worker threads; 0: the thread that simulates computes the pixels.
    #[must_use]
    pub const fn with_threads(threads: usize) -> Self {
        Self { threads }
    }
}

impl Default for Workstation {
    fn default() -> Self {
        Self::new()
    }
}

/// The moment from which seconds are counted.
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

/// A pool of threads that compute pixels, which the simulating thread joins when it has nothing else to do.
#[derive(Debug)]
struct PixelThreads {
    regions: Sender<Arc<dyn PixelSource>>,
    waiting: Receiver<Arc<dyn PixelSource>>,
    threads: Vec<JoinHandle<u64>>,
    /// Regions that the simulating thread computed.
    own: u64,
}

impl PixelThreads {
    fn start(threads: usize) -> Self {
        let (regions, waiting) = bounded(Workstation::WAITING_REGIONS);
        let threads = (0..threads).map(|_| start_thread(waiting.clone())).collect();
        Self { regions, waiting, threads, own: 0 }
    }
}

/// A thread that computes regions until there will be no more, and counts them.
fn start_thread(waiting: Receiver<Arc<dyn PixelSource>>) -> JoinHandle<u64> {
    std::thread::spawn(move || compute_all(&waiting))
}

/// Computes regions until there will be no more; how many.
fn compute_all(waiting: &Receiver<Arc<dyn PixelSource>>) -> u64 {
    waiting.iter().fold(0, |regions, region| {
        let _ = region.pixels();
        regions + 1
    })
}

impl PixelWorker for PixelThreads {
    fn compute(&mut self, region: &Arc<dyn PixelSource>) {
        // Nobody waits for room: where no more regions may wait, there is work for this thread.
        if let Err(TrySendError::Full(region)) = self.regions.try_send(Arc::clone(region)) {
            let _ = region.pixels();
            self.own += 1;
        }
    }

    /// # Panics
    ///
    /// When a worker panicked: a bug of ours.
    fn finish(self: Box<Self>) -> u64 {
        let Self { regions, waiting, threads, own } = *self;
        drop(regions);
        let own = own + compute_all(&waiting);
        threads.into_iter().map(|thread| thread.join().expect("a pixel worker panicked")).sum::<u64>() + own
    }
}
