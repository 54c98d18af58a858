//! The work that a scene causes, as numbers of triangles, spheres and bin entries.

use pphigs::{Picture, PrimitiveCounts, RegionBinning, Shading, Share, TransformCost};
use pxpl5_geometry::Viewport;
use pxpl5_renderer::Layout;
use pxpl5_run::{Experiment, ExperimentError, SceneViews, ViewSource, display_list};
use pxpl5_sim::Time;
use pxpl5_wire::{RegionId, ViewNumber};
use std::sync::Arc;

/// The work for one eye's picture: primitives and bins.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Load {
    /// Number of triangles, summed over all graphics processors.
    pub triangles: f64,
    /// Number of spheres, summed over all graphics processors.
    pub spheres: f64,
    /// Number of triangles that the clipper cuts.
    pub clipped: f64,
    /// Number of structures in the display list.
    pub structures: f64,
    /// Number of structures that contain spheres.
    pub sphere_views: f64,
    /// Numbers of triangles and of spheres in the bin of each region.
    pub bins: Vec<[f64; 2]>,
}

impl Load {
    /// Returns the work for one structure whose triangles touch every region and are never clipped.
    pub fn full_screen(triangles: u32, regions: usize) -> Self {
        let triangles = f64::from(triangles);
        Self { triangles, structures: 1.0, bins: vec![[triangles, 0.0]; regions], ..Self::default() }
    }

    /// Returns the number of entries in all bins together.
    pub fn entries(&self) -> f64 {
        self.bins.iter().map(|[triangles, spheres]| triangles + spheres).sum()
    }

    pub(crate) fn primitives_in(&self, region: usize) -> f64 {
        let [triangles, spheres] = self.bins[region];
        triangles + spheres
    }

    /// Returns the work for both eyes at each time in `times` (in picoseconds). The head moves as the scene defines.
    ///
    /// # Errors
    ///
    /// Returns [`ExperimentError::Scene`] if the scene has no primitives.
    ///
    /// # Panics
    ///
    /// Never panics, because an experiment has a valid head-mounted display.
    pub fn of_views(
        experiment: &Experiment,
        viewport: Viewport,
        binning: RegionBinning,
        times: &[u64],
    ) -> Result<Vec<Self>, ExperimentError> {
        // All GPs together hold the whole scene, so a single share suffices.
        let list = Arc::new(display_list(experiment.scene())?);
        let views = SceneViews::new(experiment.scene(), experiment.seed, experiment.hmd, 2);
        let share = Share::new(list, 0, 1);
        let layout = Layout::rendering_control_phong();
        let picture = Picture { viewport, shading: Shading::Phong, binning, layout, pixels: false };
        let mut loads = Vec::with_capacity(2 * times.len());
        for (number, time) in ViewNumber::FIRST.onwards().zip(times) {
            let view = views.newest(number, Time(*time));
            loads.extend([0, 1].map(|eye| Self::of_pass(&share, &share.transform(&view, eye, picture))));
        }
        Ok(loads)
    }

    fn of_pass(share: &Share, pass: &pphigs::Pass) -> Self {
        let held = share.counts();
        let begin = TransformCost::beginning(&share.list().structures);
        let regions = (0..pass.picture().viewport.grid().regions() as u16).map(RegionId);
        Self {
            triangles: f64::from(held.triangles),
            spheres: f64::from(held.spheres),
            clipped: pass.stats().clipped as f64,
            structures: begin.structures as f64,
            sphere_views: begin.sphere_views as f64,
            bins: regions.map(|region| bin(pass.counts(region))).collect(),
        }
    }
}

fn bin(counts: PrimitiveCounts) -> [f64; 2] {
    [f64::from(counts.triangles), f64::from(counts.spheres)]
}
