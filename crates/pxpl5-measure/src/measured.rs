//! Measurements of a run, as methods of the run's outcome.

use crate::Report;
use crate::errors::PixelErrors;
use crate::head_results::pixel_errors;
use crate::latency::{SurfaceStatistics, latency_by_surface};
use crate::pictures::picture;
use crate::quantity::Measure;
use image::RgbImage;
use pxpl5_run::Outcome;
use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::SurfaceId;

/// Common measurements of an [`Outcome`].
pub trait Measured {
    /// Returns the report of the run, which has all results as numbers with units.
    fn report(&self) -> Report;

    /// Returns the value of the quantity with the name `name`, one of [`QUANTITIES`](crate::QUANTITIES). Returns `None`
    /// if the run has no value for the quantity.
    ///
    /// Some quantities need the whole report. To read several quantities, create [`Results`](crate::Results) once.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] with the most similar name if no quantity is called `name`.
    fn quantity(&self, name: &str) -> Result<Option<f64>, SettingError>;

    /// Returns the latencies of each eye and of the pair of eyes. The result is empty if the eyes share one TRANSFORM.
    fn latency_by_surface(&self) -> Vec<SurfaceStatistics>;

    /// Returns the pixel errors in the display mode of the head's display, or `None` for a run without a head.
    fn pixel_errors(&self) -> Option<PixelErrors>;

    /// Returns the picture that the viewer of a surface sees at the end of the run.
    ///
    /// Returns `None` if the experiment computes no pixels, or before anything was shown.
    fn picture(&self, surface: impl Into<SurfaceId>) -> Option<RgbImage>;
}

impl Measured for Outcome {
    fn report(&self) -> Report {
        Report::of(self)
    }

    fn quantity(&self, name: &str) -> Result<Option<f64>, SettingError> {
        Ok(Measure::named(name)?.of_outcome(self))
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
