use pxpl5_wire::PixelSource;
use std::fmt::Debug;
use std::sync::Arc;

/// A worker that computes the pixels of regions while the simulation runs.
pub trait PixelWorker: Debug {
    /// Accepts a region. The worker may compute the region's pixels at any time before [`PixelWorker::finish`] returns.
    fn compute(&mut self, region: &Arc<dyn PixelSource>);

    /// Waits until the pixels of all accepted regions are computed, and returns the number of these regions.
    fn finish(self: Box<Self>) -> u64;
}

/// A [`PixelWorker`] that computes pixels immediately, on the thread of the simulation.
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
