//! Studies of volumes: scenes as the slices of a spinning volumetric display.

use crate::error::StudyError;
use crate::estimate::{BASE, BUSY, Estimate, PRIMITIVE};
use crate::study::{Study, check};
use pxpl5_scene::Scene;
use pxpl5_sim::Watcher;
use pxpl5_volume::compare::{ComparePoint, VolumeComparison, compare, variant_count};
use pxpl5_volume::figures::{VolumeFigures, all};
use pxpl5_volume::spatialgl::{Threads, Workers};
use pxpl5_volume::{Counted, RendererKind, Volume, VolumeSettings};
use std::sync::Arc;

/// A volume.
#[derive(Clone, Debug)]
pub struct VolumeQuery {
    /// Settings of the volume.
    pub settings: VolumeSettings,
    /// The scene.
    pub scene: Arc<Scene>,
    /// Threads that draw slices.
    pub threads: Threads,
}

/// Bytes for a drawn pixel of a slice in the buffers of one sample.
const TARGET: f64 = 3.125;
/// Bytes and seconds for one pixel that a triangle or sphere covers.
const COVERED: (f64, f64) = (12.0, 100e-9);
/// Seconds to process one primitive for one slice.
const SLICE_S: f64 = 30e-9;
/// Factor on the time, and additional bytes, if simulated renderers of Pixel-Planes 5 draw the volume.
const PLANES: (f64, f64) = (15.0, 60e6);

impl Study for VolumeQuery {
    type Report = Volume;

    fn estimate(&self, _: usize) -> Estimate {
        let VolumeSettings { display, tile, draw, renderer, .. } = &self.settings;
        let threads = self.threads.count() as u64;
        // One thread draws a batch of slices, so threads beyond the number of batches are idle.
        let targets = (threads * tile.batch).min(display.slices) as f64;
        let [slices, width, height] = [display.slices, display.width, display.height].map(|number| number as f64);
        let [samples, primitives] = [draw.samples, self.scene.primitives() as u64].map(|number| number as f64);
        // Primitives touch about two pixels in each column of a slice, and two slices in all.
        let (area, covered) = (width * height, 2.0 * slices * width + 2.0 * width * height);
        let (times, more_bytes) = if *renderer == RendererKind::PixelPlanes { PLANES } else { (1.0, 0.0) };
        let bytes = BASE + slices * area / 2.0 + COVERED.0 * covered + targets * area * TARGET * samples;
        let seconds = times * samples * (SLICE_S * slices * primitives + COVERED.1 * covered);
        Estimate { bytes: bytes + PRIMITIVE * primitives + more_bytes, seconds: BUSY * seconds / threads.max(1) as f64 }
    }

    /// Draws the volume.
    fn run(&self, watcher: &mut dyn Watcher) -> Result<Volume, StudyError> {
        let stop = watcher.stop();
        let volume = Volume::draw(&self.settings, &self.scene, &Counted::new(&self.threads, watcher));
        // The slices after a stop are missing.
        check(&stop)?;
        Ok(volume?)
    }
}

/// Volumes with each clip and each projection.
#[derive(Clone, Debug)]
pub struct VolumeComparisonQuery {
    /// Settings that all volumes share, scene and threads.
    pub volume: VolumeQuery,
    /// Viewpoint of the pictures of the volumes, if they are drawn.
    pub viewpoint: Option<ComparePoint>,
}

impl Study for VolumeComparisonQuery {
    type Report = VolumeComparison;

    fn estimate(&self, threads: usize) -> Estimate {
        let one = self.volume.estimate(threads);
        Estimate { seconds: variant_count() as f64 * one.seconds, ..one }
    }

    fn run(&self, watcher: &mut dyn Watcher) -> Result<VolumeComparison, StudyError> {
        let VolumeQuery { settings, scene, threads } = &self.volume;
        Ok(compare(settings, scene, self.viewpoint, threads, watcher)?)
    }
}

/// The figures of the paper on the volumetric display.
#[derive(Clone, Debug)]
pub struct VolumeFigureQuery {
    /// Scenes of the figures that depend on the scene.
    pub scenes: Vec<Arc<Scene>>,
}

impl Study for VolumeFigureQuery {
    type Report = VolumeFigures;

    fn run(&self, watcher: &mut dyn Watcher) -> Result<VolumeFigures, StudyError> {
        let stop = watcher.stop();
        let figures = all(&self.scenes, &Threads::all(), watcher)?;
        check(&stop)?;
        Ok(figures)
    }
}
