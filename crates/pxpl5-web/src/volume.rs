//! The spinning volumetric display: the slices of a scene, and the view of an eye beside the display.

use crate::pictures::rgba;
use image::{Rgb, RgbImage};
use pxpl5_scene::Scene;
use spatialgl::perspecta::{Camera, PerspectaConfig, ViewOptions, view_planes};
use spatialgl::{HostRenderer, Jitter, OneThread, Projection, SliceClip, VolumeConfig, VolumeFrame};
use spatialgl::{record_scene, render_volume};

/// Fraction of the lit pixels of a view that must be darker than white. This fraction determines the exposure of the
/// view.
const BELOW_WHITE: f64 = 0.98;

/// A scene drawn for the volumetric display of the SpatialGL paper, with hyperbolic clipping and jittered projections.
#[derive(Debug)]
pub(crate) struct Volume {
    frame: VolumeFrame,
    radius: f64,
}

impl Volume {
    pub(crate) fn draw(scene: &Scene) -> Result<Self, String> {
        let config = PerspectaConfig::PAPERS;
        let clip = SliceClip::Hyperbolic(spatialgl::DEFAULT_HYPERBOLIC_BIAS_PX2);
        let display = config.swept(clip, Projection::Jittered(Jitter::new(1))).map_err(|error| error.to_string())?;
        let radius = config.width as f64 / 2.0;
        let commands = record_scene(scene, radius, true).map_err(|error| error.to_string())?;
        let frame = render_volume(&display, &commands, &VolumeConfig::paper(), &HostRenderer, &OneThread);
        Ok(Self { frame: frame.map_err(|error| error.to_string())?, radius })
    }

    pub(crate) fn size(&self) -> [u32; 3] {
        let [width, height] = self.frame.planes.size();
        [self.frame.planes.slices(), width, height]
    }

    /// Returns the slice with index `number` as bytes. The value of each colour of a pixel is 0 or 255, because the
    /// display has one bit for each colour. A slice that does not exist is black.
    pub(crate) fn slice(&self, number: u32) -> Vec<u8> {
        let [slices, width, height] = self.size();
        let lit = |x, y| if number < slices { self.frame.planes.pixel(number, x, y) } else { 0 };
        rgba(&RgbImage::from_fn(width, height, |x, y| Rgb([0, 1, 2].map(|channel| 255 * (lit(x, y) >> channel & 1)))))
    }

    /// Returns the view of an eye during one turn of the display, from a distance of four radii of the display. The
    /// picture is `side` pixels wide and high.
    pub(crate) fn seen(&self, azimuth_deg: f64, elevation_deg: f64, side: u32) -> Result<Vec<u8>, String> {
        let camera = Camera::around(self.radius, azimuth_deg, elevation_deg, side);
        let light = view_planes(&self.frame.planes, &camera, ViewOptions::default(), &OneThread);
        let light = light.map_err(|error| error.to_string())?;
        Ok(rgba(&light.picture(light.exposure(BELOW_WHITE))))
    }
}
