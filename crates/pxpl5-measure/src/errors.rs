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
/// Each pixel of a picture that was complete, in time and shown within the result window has an error. It has two
/// measures: the angle between the displayed and the correct direction, and the distance on the screen. The distance is
/// at most the picture's diagonal, because content that has left the picture, or lies behind the eye, has no place on the
/// screen. The members `empty`, `incomplete` and `before` count the pixels without an error. Statistics of no pixels are
/// NaN (null in JSON).
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PixelErrors {
    /// Distance of the evaluated pixels from their correct position, in pixels, at most the picture's diagonal.
    pub pixels: Percentiles,
    /// Angle between the displayed and the correct direction of the evaluated pixels, in degrees.
    pub degrees: Percentiles,
    /// Error of the pixel in the middle of the picture, in pixels.
    pub centre_px: Percentiles,
    /// Error of the pixel in the middle of the picture, in degrees.
    pub centre_deg: Percentiles,
    /// Number of evaluated pixels, summed over all fields of the result window.
    pub evaluated: u64,
    /// Number of evaluated pixels whose content has left the picture at the time when the pixels are lit. Content behind
    /// the eye is included.
    pub outside: u64,
    /// Number of evaluated pixels whose content lies behind the eye at the time when the pixels are lit.
    pub behind: u64,
    /// Number of evaluated pixels that a device leaves empty, because no content moves there. They have the error of the
    /// picture without the device.
    pub unfilled: u64,
    /// Number of pixels that were lit before any picture was shown.
    pub empty: u64,
    /// Number of pixels from pictures that were not complete in time.
    pub incomplete: u64,
    /// Number of pixels that still showed a picture from before the result window, for example from the warm-up.
    pub before: u64,
    /// Share of the picture, 0 to 1, that the scene covers, as a mean over the evaluated fields. `None` if errors are
    /// evaluated at a fixed distance, or if the whole scene moves with the head.
    pub covered_share: Option<f64>,
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
    let mut pixels = spread(display, period, (GRID, GRID), |_| (0.5, 0.5));
    // Some scans do not begin at the top. The middle pixel stays in the middle of the list.
    pixels.sort_by_key(|(_, _, at)| *at);
    pixels
}

/// Numbers of columns and rows of the screen positions at which empty and covered parts of the picture are counted.
const LATTICE: (u32, u32) = (16, 12);

/// Steps of the lattice from row to row and from one display period to the next, relative to the distance of two
/// positions: the golden ratio and the plastic number. All parts of the picture, edges included, are met equally often.
const LATTICE_STEP: (f64, f64) = (0.618_033_988_749_895, 0.754_877_666_246_693);

/// Returns evenly spread pixels that move from period to period, with the times at which the pixels are lit.
pub(crate) fn lattice(display: &dyn Display, period: PeriodNumber) -> Vec<(u32, u32, Time)> {
    let down = (0.5 + period.0 as f64 * LATTICE_STEP.1).fract();
    let rows = period.0 * u64::from(LATTICE.1);
    spread(display, period, LATTICE, |row| ((0.5 + (rows + u64::from(row)) as f64 * LATTICE_STEP.0).fract(), down))
}

/// Returns pixels that are spread evenly over columns and rows of a picture, with the times at which the pixels are
/// lit. `part` gives the place of a row's pixels between two columns and between two rows, each from 0 to 1.
fn spread(
    display: &dyn Display,
    period: PeriodNumber,
    (columns, rows): (u32, u32),
    part: impl Fn(u32) -> (f64, f64),
) -> Vec<(u32, u32, Time)> {
    let Some(surface) = display.surfaces().first() else { return Vec::new() };
    let lit = Rows::lit(display, period);
    let place =
        |i: u32, part: f64, of: u32, size: u32| ((f64::from(i) + part) * f64::from(size) / f64::from(of)) as u32;
    let places = (0..rows).flat_map(|j| {
        let (along, down) = part(j);
        // Move each row to a row that this period lights.
        let y = lit.beside(place(j, down, rows, surface.height));
        (0..columns).map(move |i| (place(i, along, columns, surface.width), y))
    });
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
