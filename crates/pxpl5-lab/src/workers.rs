//! Worker threads that compute pixels, apart from simulated time.

use crossbeam_channel::{Sender, bounded};
use pxpl5_wire::{PixelSource, RegionPixels};
use std::sync::Arc;
use std::thread::JoinHandle;

/// Regions that may wait for a worker; more would only hold memory.
const WAITING_REGIONS: usize = 256;

/// A pool of threads, or none: then pixels are computed at once by who asks.
#[derive(Debug)]
pub(crate) struct PixelWorkers {
    regions: Sender<Arc<dyn PixelSource>>,
    threads: Vec<JoinHandle<u64>>,
    /// Regions computed without a thread.
    computed_here: u64,
}

impl PixelWorkers {
    pub(crate) fn new(threads: usize) -> Self {
        let (regions, waiting) = bounded::<Arc<dyn PixelSource>>(WAITING_REGIONS);
        let worker = |_| {
            let waiting = waiting.clone();
            std::thread::spawn(move || {
                waiting.iter().fold(0, |regions, region| {
                    let _ = region.pixels();
                    regions + 1
                })
            })
        };
        Self { regions, threads: (0..threads).map(worker).collect(), computed_here: 0 }
    }

    /// Computes a region whose first part is on its way.
    pub(crate) fn compute(&mut self, pixels: &RegionPixels) {
        if pixels.part != 0 {
            return;
        }
        if self.threads.is_empty() {
            let _ = pixels.image.pixels();
            self.computed_here += 1;
        } else {
            // The workers live as long as this sender, so there is always a receiver.
            let _ = self.regions.send(Arc::clone(&pixels.image));
        }
    }

    /// Waits until everything is computed; the number of regions.
    ///
    /// # Panics
    ///
    /// When a worker panicked: a bug of ours.
    pub(crate) fn finish(self) -> u64 {
        drop(self.regions);
        let join = |thread: JoinHandle<u64>| thread.join().expect("a pixel worker panicked");
        self.computed_here + self.threads.into_iter().map(join).sum::<u64>()
    }
}
