//! Pixel error: where each pixel's content is seen, against where it should be at the moment when it lights.

use crate::percentiles::Percentiles;
use pxpl5_display::Display;
use pxpl5_run::Raster;
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use serde::Serialize;

/// The error of one field.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FieldError {
    /// The period of the display that was judged.
    pub field: PeriodNumber,
    /// When it begins, seconds.
    pub time_s: f64,
    /// Mean over the grid, pixels.
    pub mean_px: f64,
    /// In the middle, pixels.
    pub centre_px: f64,
}

/// Errors over a grid of pixels and all fields of the window, where a picture is seen that was shown in the window, complete and in
/// time: others have no error. What was not evaluated is no number (NaN; null in JSON).
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PixelErrors {
    /// Distance from where it should be, over the grid, pixels.
    pub pixels: Percentiles,
    /// The same as an angle, degrees.
    pub degrees: Percentiles,
    /// In the middle of the picture, pixels.
    pub centre_px: Percentiles,
    /// In the middle of the picture, degrees.
    pub centre_deg: Percentiles,
    /// Pixels that have an error, over the grid and all fields.
    pub judged: u64,
    /// Pixels whose content should not be before the eye at all.
    pub behind: u64,
    /// Pixels that showed nothing yet.
    pub empty: u64,
    /// Pixels that showed a part of a picture that was not complete in time.
    pub incomplete: u64,
    /// Pixels that still showed a picture from before the window, such as one of start-up.
    pub before: u64,
    /// The same field by field, in the order of time; of a run that keeps statistics only the first
    /// [`KEPT_SAMPLES`](pxpl5_run::KEPT_SAMPLES) fields.
    #[serde(skip)]
    pub by_field: Vec<FieldError>,
    /// Every judged pixel's, pixels; of a run that keeps statistics only those of the first 20,971 fields, behind which percentiles are
    /// told to a 2048th.
    #[serde(skip)]
    pub all_px: Vec<f64>,
}

/// Columns and rows of the grid; odd, so that the middle is one of its pixels.
const GRID: u32 = 5;

/// The pixel of the grid in its middle.
pub(crate) const CENTRE: usize = (GRID * GRID / 2) as usize;

/// The pixels of a period at which it is judged, in the order of the beam, and when each lights.
pub(crate) fn grid(display: &dyn Display, period: PeriodNumber) -> Vec<(u32, u32, Time)> {
    let Some(surface) = display.surfaces().first() else { return Vec::new() };
    let (first_row, row_distance) = display.rows_lit(period);
    let place = |i: u32, size: u32| (2 * i + 1) * size / (2 * GRID);
    let mut pixels = Vec::new();
    for j in 0..GRID {
        let y = place(j, surface.height) / row_distance * row_distance + first_row;
        for x in (0..GRID).map(|i| place(i, surface.width)) {
            pixels.extend(display.lights(0, x, y, period).map(|at| (x, y, at)));
        }
    }
    pixels
}

/// How a run's pictures come before the eyes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Showing {
    /// As they were drawn.
    Plain,
    /// On a raster that is shifted while it is scanned.
    RasterOffset,
    /// Not at all: the view is evaluated at every pixel's own moment, from all reports that the host has by then. The reference,
    /// computed and not timed.
    Ideal,
}

impl From<Raster> for Showing {
    fn from(raster: Raster) -> Self {
        match raster {
            Raster::Plain => Self::Plain,
            Raster::Vdrt => Self::RasterOffset,
        }
    }
}
