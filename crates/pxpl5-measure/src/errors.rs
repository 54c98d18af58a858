//! Pixel error: where each pixel's content is seen, against where it should be at the moment when it lights.

use crate::percentiles::Percentiles;
use crate::raster::RasterOffsets;
use crate::registration::{Judge, middle};
use crate::shown::{Drawn, Shown};
use pxpl5_display::Display;
use pxpl5_run::{Outcome, Raster};
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use serde::Serialize;
use tracking::view::{HmdView, PixelError};

/// The error of one field.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FieldError {
    /// The field.
    pub field: PeriodNumber,
    /// When it begins, seconds.
    pub time_s: f64,
    /// Mean over the grid, pixels.
    pub mean_px: f64,
    /// In the middle, pixels.
    pub centre_px: f64,
}

/// Errors over a grid of pixels and all fields.
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
    /// Pixels judged.
    pub judged: u64,
    /// Pixels whose content should not be before the eye at all.
    pub behind: u64,
    /// Pixels that showed nothing yet.
    pub empty: u64,
    /// Over time.
    #[serde(skip)]
    pub by_field: Vec<FieldError>,
}

/// Fields at the start that are not judged: pipelines fill, and the tracker's first reports arrive.
pub const UNJUDGED_FIELDS: u64 = 15;

/// Columns and rows of the grid; odd, so that the middle is one of its pixels.
const GRID: u32 = 5;

/// The pixels of a period at which it is judged, in the order of the beam, and when each lights.
fn grid(display: &dyn Display, period: PeriodNumber) -> Vec<(u32, u32, Time)> {
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

/// Errors as they are collected.
#[derive(Default)]
struct Collected {
    grid: Vec<PixelError>,
    centre: Vec<PixelError>,
    errors: PixelErrors,
}

impl Collected {
    /// Judges one field; `drawn` says what each pixel shows.
    fn field(
        &mut self,
        judge: &Judge<'_>,
        display: &dyn Display,
        field: PeriodNumber,
        mut drawn: impl FnMut(u32, u32, Time) -> Option<Drawn>,
    ) {
        let begin = self.grid.len();
        let mut centre = None;
        for (i, (x, y, at)) in grid(display, field).into_iter().enumerate() {
            let Some(drawn) = drawn(x, y, at) else {
                self.errors.empty += 1;
                continue;
            };
            let Some(error) = judge.error(middle(x, y), &drawn, at) else {
                self.errors.behind += 1;
                continue;
            };
            self.grid.push(error);
            if i == (GRID * GRID / 2) as usize {
                centre = Some(error);
            }
        }
        let of_field = &self.grid[begin..];
        if let Some(centre) = centre {
            self.centre.push(centre);
            let mean_px = of_field.iter().map(|error| error.pixels).sum::<f64>() / of_field.len() as f64;
            let time_s = display.tick(field).since(Time::ZERO).as_ms() * 1e-3;
            self.errors.by_field.push(FieldError { field, time_s, mean_px, centre_px: centre.pixels });
        }
    }

    fn finish(self) -> PixelErrors {
        let of = |errors: &[PixelError], value: fn(&PixelError) -> f64| Percentiles::of(errors.iter().map(value));
        PixelErrors {
            judged: self.grid.len() as u64,
            pixels: of(&self.grid, |e| e.pixels),
            degrees: of(&self.grid, |e| e.degrees),
            centre_px: of(&self.centre, |e| e.pixels),
            centre_deg: of(&self.centre, |e| e.degrees),
            ..self.errors
        }
    }
}

impl PixelErrors {
    /// Of a run with a head; empty without one.
    #[must_use]
    pub fn of(outcome: &Outcome) -> Self {
        Self::collect(outcome, |shown, _, (x, y, field, at)| shown.drawn(x, y, field, at))
    }

    /// The same with the raster shifted as it is scanned.
    #[must_use]
    pub fn with_raster_offset(outcome: &Outcome) -> Self {
        let Some(head) = outcome.head() else { return Self::default() };
        let offsets = RasterOffsets::of_run(outcome, head);
        Self::collect(outcome, |shown, view, (x, y, field, at)| {
            let Some(Drawn::Pose(pose)) = shown.drawn(x, y, field, at) else { return None };
            Some(Drawn::Shifted(pose, offsets.field(field)?.shift_px(view, at.0)))
        })
    }

    /// The reference: the view is evaluated at every pixel's own moment, from all reports that the host has by then.
    /// Computed, not timed.
    #[must_use]
    pub fn ideal(outcome: &Outcome) -> Self {
        let Some(head) = outcome.head() else { return Self::default() };
        let mut follower = head.follower();
        Self::collect(outcome, |_, _, (_, _, _, at)| Some(Drawn::Pose(head.follow(&mut follower, at, at))))
    }

    fn collect(
        outcome: &Outcome,
        mut drawn: impl FnMut(&Shown<'_>, &HmdView, (u32, u32, PeriodNumber, Time)) -> Option<Drawn>,
    ) -> Self {
        let Some(head) = outcome.head() else { return Self::default() };
        let judge = Judge::new(outcome, head);
        let shown = Shown::of_run(outcome, head);
        let display = outcome.record().display();
        let mut collected = Collected::default();
        let end = PeriodNumber(outcome.fields().saturating_sub(1));
        for field in PeriodNumber(UNJUDGED_FIELDS).until(end) {
            collected.field(&judge, display, field, |x, y, at| drawn(&shown, &judge.view, (x, y, field, at)));
        }
        collected.finish()
    }
}

/// Pixel errors on the raster before the eyes; `None` of a run without a head.
#[must_use]
pub fn pixel_errors(outcome: &Outcome) -> Option<PixelErrors> {
    Some(match outcome.head()?.head().raster() {
        Raster::Plain => PixelErrors::of(outcome),
        Raster::Vdrt => PixelErrors::with_raster_offset(outcome),
    })
}
