//! Who computes pixels while the simulation goes on: apart from simulated time, handed in by whoever runs the machine.

use pxpl5_wire::PixelSource;
use std::fmt::Debug;
use std::sync::Arc;

/// Somebody who computes the pixels of regions.
pub trait PixelWorker: Debug {
    /// Takes a region; it may be computed at any time until [`PixelWorker::finish`].
    fn compute(&mut self, region: &Arc<dyn PixelSource>);

    /// Waits until everything is computed; the number of regions.
    fn finish(self: Box<Self>) -> u64;
}

/// Computes pixels at once, on the thread that simulates.
#[derive(Debug, Default)]
pub struct SameThread {
    regions: u64,
}

impl PixelWorker for SameThread {
    fn compute(&mut self, region: &Arc<dyn PixelSource>) {
        let _ = region.pixels();
        self.regions += 1;
    }

    fn finish(self: Box<Self>) -> u64 {
        self.regions
    }
}
