//! An outcome's measurements as methods of it.

use crate::Report;
use crate::errors::PixelErrors;
use crate::latency::{SurfaceStatistics, latency_by_surface, latency_parts};
use crate::of_outcome::pixel_errors;
use crate::pictures::picture;
use image::RgbImage;
use pxpl5_run::{LatencyParts, Outcome};
use pxpl5_wire::SurfaceId;

/// What is most often asked of an [`Outcome`].
pub trait Measured {
    /// Everything as numbers.
    fn report(&self) -> Report;

    /// The parts of the latency of every complete picture in the window.
    fn latency_parts(&self) -> Vec<LatencyParts>;

    /// Latencies of both eyes and of the pair; empty where eyes have no TRANSFORM of their own.
    fn latency_by_surface(&self) -> Vec<SurfaceStatistics>;

    /// Pixel errors on the raster before the eyes; `None` of a run without a head.
    fn pixel_errors(&self) -> Option<PixelErrors>;

    /// What the viewer of a surface, such as an eye, sees at the end; `None` without pixels, or before anything was shown.
    fn picture(&self, surface: impl Into<SurfaceId>) -> Option<RgbImage>;
}

impl Measured for Outcome {
    fn report(&self) -> Report {
        Report::of(self)
    }

    fn latency_parts(&self) -> Vec<LatencyParts> {
        latency_parts(self)
    }

    fn latency_by_surface(&self) -> Vec<SurfaceStatistics> {
        latency_by_surface(self)
    }

    fn pixel_errors(&self) -> Option<PixelErrors> {
        pixel_errors(self)
    }

    fn picture(&self, surface: impl Into<SurfaceId>) -> Option<RgbImage> {
        picture(self, surface)
    }
}
