//! Pixel error: the distance between a pixel and the correct position of its content at the time when the pixel is lit.

use crate::percentiles::Percentiles;
use crate::rows::Rows;
use pxpl5_run::{Raster, Reprojection, number_or_nan};
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use pxpl5_wire::display::Display;
use serde::{Deserialize, Serialize};

/// Pixel errors of one field (one display period).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FieldMisregistration {
    /// Number of the display period in which the errors were evaluated.
    pub field: PeriodNumber,
    /// Start of the period in simulated time, in seconds.
    pub time_s: f64,
    /// Mean error over the grid of evaluated pixels, in pixels.
    #[serde(deserialize_with = "number_or_nan")]
    pub mean_px: f64,
    /// Error of the pixel in the middle of the picture, in pixels.
    #[serde(deserialize_with = "number_or_nan")]
    pub centre_px: f64,
}

/// Errors over a grid of pixels and all fields of the result window.
///
/// Only pixels of pictures that were complete, in time and shown within the result window are evaluated. The members
/// `behind`, `empty`, `incomplete` and `before` count the remaining pixels. Statistics of no pixels are NaN (null in
/// JSON).
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PixelErrors {
    /// Distance of the evaluated pixels from their correct position, in pixels.
    pub pixels: Percentiles,
    /// Angle between the displayed and the correct direction of the evaluated pixels, in degrees.
    pub degrees: Percentiles,
    /// Error of the pixel in the middle of the picture, in pixels.
    pub centre_px: Percentiles,
    /// Error of the pixel in the middle of the picture, in degrees.
    pub centre_deg: Percentiles,
    /// Number of evaluated pixels, summed over all fields of the result window.
    pub evaluated: u64,
    /// Number of pixels whose content lies behind the eye at the time when the pixels are lit.
    pub behind: u64,
    /// Number of pixels that were lit before any picture was shown.
    pub empty: u64,
    /// Number of pixels from pictures that were not complete in time.
    pub incomplete: u64,
    /// Number of pixels that still showed a picture from before the result window, for example from the warm-up.
    pub before: u64,
    /// Errors of each field, in the order of time.
    ///
    /// If a run keeps only statistics, the list has only its first [`KEPT_SAMPLES`](pxpl5_run::KEPT_SAMPLES) fields.
    #[serde(skip)]
    pub by_field: Vec<FieldMisregistration>,
    /// Error of each evaluated pixel, in pixels.
    ///
    /// If a run keeps only statistics, the list has only the pixels of its first 20,971 fields. Percentiles of longer
    /// runs have a relative error of at most 1/2048.
    #[serde(skip)]
    pub all_px: Vec<f64>,
}

/// Number of columns, and of rows, of the grid of evaluated pixels. The number is odd, so that one pixel lies in the
/// middle.
const GRID: u32 = 5;

pub(crate) const CENTRE: usize = (GRID * GRID / 2) as usize;

/// Returns the evaluated pixels of a display period in the order of the scan, with the times at which the pixels are
/// lit.
pub(crate) fn grid(display: &dyn Display, period: PeriodNumber) -> Vec<(u32, u32, Time)> {
    let mut pixels = spread(display, period, (GRID, GRID));
    // Some scans do not begin at the top. The middle pixel stays in the middle of the list.
    pixels.sort_by_key(|(_, _, at)| *at);
    pixels
}

/// Numbers of columns and rows of the screen positions that are checked for content beyond the edge of the picture.
const LATTICE: (u32, u32) = (16, 12);

pub(crate) fn lattice(display: &dyn Display, period: PeriodNumber) -> Vec<(u32, u32, Time)> {
    spread(display, period, LATTICE)
}

/// Returns pixels that are spread evenly over columns and rows of a picture, with the times at which the pixels are
/// lit.
fn spread(display: &dyn Display, period: PeriodNumber, (columns, rows): (u32, u32)) -> Vec<(u32, u32, Time)> {
    let Some(surface) = display.surfaces().first() else { return Vec::new() };
    let lit = Rows::lit(display, period);
    let place = |i: u32, of: u32, size: u32| (2 * i + 1) * size / (2 * of);
    // Move each row to a row that this period lights.
    let rows = (0..rows).map(|j| lit.beside(place(j, rows, surface.height)));
    let places = rows.flat_map(|y| (0..columns).map(move |i| (place(i, columns, surface.width), y)));
    places.filter_map(|(x, y)| Some((x, y, display.lights(0, x, y, period)?))).collect()
}

/// The way in which a display shows the pictures of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Showing {
    /// Each picture is shown as drawn, without any correction.
    Plain,
    /// The raster is shifted during scan-out (VDRT).
    RasterOffset,
    /// An ideal display without pictures, for comparison. Each pixel shows the view that is predicted for the instant
    /// at which the pixel is lit.
    ///
    /// The prediction uses all tracker reports that the host has at that time. The pixels are computed after the run
    /// and cost no simulated time.
    Ideal,
    /// A device moves each picture to the newest pose.
    Reprojected(Reprojection),
    /// Pictures are shown as drawn, in front of a video of the real world that has the same delay (I3D95, 2.1).
    ///
    /// Pictures and video show the instant at which the head's pose was measured, so only the tracker's error remains.
    /// The delay lasts from this measurement until the pixels are lit.
    DelayedVideo,
}

impl From<Raster> for Showing {
    fn from(raster: Raster) -> Self {
        match raster {
            Raster::Plain => Self::Plain,
            Raster::Vdrt => Self::RasterOffset,
            Raster::Reprojected(setting) => Self::Reprojected(setting),
        }
    }
}
