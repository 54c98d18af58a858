//! Pixel error: where each pixel's content is seen, against where it should be at the moment when it lights.

use crate::percentiles::Percentiles;
use crate::raster::RasterOffsets;
use crate::registration::{Judge, middle};
use crate::shown::{Drawn, Moment, Seen, Shown};
use pxpl5_display::Display;
use pxpl5_run::{Cause, Estimator, HeadViews, Outcome, Raster};
use pxpl5_sim::Time;
use pxpl5_wire::{PeriodNumber, ViewNumber};
use serde::Serialize;
use std::collections::BTreeSet;
use tracking::view::{HmdView, PixelError};

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

/// Errors over a grid of pixels and all fields, where pictures are shown that were complete in time: of others there is no
/// error. What was not judged is no number (NaN; null in JSON).
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
    /// The same field by field, in the order of time.
    #[serde(skip)]
    pub by_field: Vec<FieldError>,
    /// Every judged pixel's, pixels.
    #[serde(skip)]
    pub all_px: Vec<f64>,
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
    /// Whether a pixel is judged at the instant that it was drawn for, and not when it lights.
    at_one_instant: bool,
    grid: Vec<PixelError>,
    centre: Vec<PixelError>,
    errors: PixelErrors,
}

impl Collected {
    /// Judges one field; `seen` says what each pixel shows.
    fn field(
        &mut self,
        judge: &Judge<'_>,
        display: &dyn Display,
        field: PeriodNumber,
        mut seen: impl FnMut(u32, u32, Time) -> Seen,
    ) {
        let begin = self.grid.len();
        let mut centre = None;
        for (i, (x, y, at)) in grid(display, field).into_iter().enumerate() {
            let Some(error) = self.judged(judge, (x, y), at, seen(x, y, at)) else { continue };
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

    /// The error of a pixel, or why there is none.
    fn judged(&mut self, judge: &Judge<'_>, (x, y): (u32, u32), at: Time, seen: Seen) -> Option<PixelError> {
        let (error, unjudged) = match seen {
            Seen::Nothing => (None, &mut self.errors.empty),
            Seen::Incomplete => (None, &mut self.errors.incomplete),
            Seen::Complete(drawn) => {
                let judged_at = if self.at_one_instant { drawn.instant(at) } else { at };
                (judge.error(middle(x, y), &drawn, judged_at), &mut self.errors.behind)
            }
        };
        *unjudged += u64::from(error.is_none());
        error
    }

    fn finish(self) -> PixelErrors {
        let of = |errors: &[PixelError], value: fn(&PixelError) -> f64| Percentiles::of(errors.iter().map(value));
        PixelErrors {
            judged: self.grid.len() as u64,
            pixels: of(&self.grid, |e| e.pixels),
            degrees: of(&self.grid, |e| e.degrees),
            centre_px: of(&self.centre, |e| e.pixels),
            centre_deg: of(&self.centre, |e| e.degrees),
            all_px: self.grid.iter().map(|error| error.pixels).collect(),
            ..self.errors
        }
    }
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

impl PixelErrors {
    /// Of a run with a head, its pictures as they were drawn; empty without one.
    #[must_use]
    pub fn of(outcome: &Outcome) -> Self {
        Self::shown(outcome, Showing::Plain)
    }

    /// The same with its pictures shown so.
    #[must_use]
    pub fn shown(outcome: &Outcome, showing: Showing) -> Self {
        let Some(head) = outcome.head() else { return Self::default() };
        let shown = Shown::of_run(outcome, head);
        Self::judged(outcome, head, showing, &shown, None)
    }

    /// The same without one cause of error: with the reports and poses that the run would have had, its times being as they are.
    #[must_use]
    pub fn without(outcome: &Outcome, showing: Showing, cause: Cause) -> Self {
        let Some(head) = outcome.head() else { return Self::default() };
        let shown = Shown::of_run(outcome, head);
        let seen = views_seen(outcome, &shown);
        let shown = shown.with_poses(head, &seen, cause);
        Self::judged(outcome, head, showing, &shown, Some(cause))
    }

    fn judged(
        outcome: &Outcome,
        head: &HeadViews,
        showing: Showing,
        shown: &Shown<'_>,
        without: Option<Cause>,
    ) -> Self {
        let judge = Judge::new(outcome, head);
        let display = outcome.record().display();
        let estimator = Estimator::new(head, without);
        let mut content = Content::new(outcome, showing, shown, estimator);
        let mut collected = Collected { at_one_instant: without == Some(Cause::ScanOut), ..Collected::default() };
        for field in fields_judged(outcome) {
            collected.field(&judge, display, field, |x, y, at| content.seen(&judge.view, [x, y], field, at));
        }
        collected.finish()
    }
}

/// What the pixels of a run show, as it is shown.
enum Content<'a, 's> {
    Plain(&'a Shown<'s>),
    Shifted(&'a Shown<'s>, RasterOffsets<'a>),
    Ideal(Estimator<'a>),
}

impl<'a, 's> Content<'a, 's> {
    fn new(outcome: &'a Outcome, showing: Showing, shown: &'a Shown<'s>, estimator: Estimator<'a>) -> Self {
        match showing {
            Showing::Plain => Self::Plain(shown),
            Showing::RasterOffset => Self::Shifted(shown, RasterOffsets::of_run(outcome, shown, estimator)),
            Showing::Ideal => Self::Ideal(estimator),
        }
    }

    fn seen(&mut self, view: &HmdView, [x, y]: [u32; 2], field: PeriodNumber, at: Time) -> Seen {
        match self {
            Self::Plain(shown) => shown.seen(x, y, field, at),
            Self::Shifted(shown, offsets) => match shown.seen(x, y, field, at) {
                Seen::Complete(Drawn::View(moment)) => {
                    let offset = offsets.field(field);
                    let shift = offset.map(|offset| offset.shift_px(view, at.0));
                    shift.map_or(Seen::Nothing, |shift| Seen::Complete(Drawn::Shifted(moment, shift)))
                }
                Seen::Complete(_) => Seen::Nothing,
                other => other,
            },
            Self::Ideal(estimator) => {
                Seen::Complete(Drawn::View(Moment { pose: estimator.pose(at, at), objects_at: at }))
            }
        }
    }
}

/// The fields that are judged: not the first, nor one that the run may not have ended.
fn fields_judged(outcome: &Outcome) -> impl Iterator<Item = PeriodNumber> {
    let end = PeriodNumber(outcome.fields().saturating_sub(1));
    PeriodNumber(UNJUDGED_FIELDS).until(end)
}

/// The views that the judged pixels show.
fn views_seen(outcome: &Outcome, shown: &Shown<'_>) -> BTreeSet<ViewNumber> {
    let display = outcome.record().display();
    let pixels =
        fields_judged(outcome).flat_map(|field| grid(display, field).into_iter().map(move |pixel| (field, pixel)));
    pixels.flat_map(|(field, (x, y, at))| shown.views_at(x, y, field, at)).collect()
}

/// Pixel errors on the raster before the eyes; `None` of a run without a head.
#[must_use]
pub fn pixel_errors(outcome: &Outcome) -> Option<PixelErrors> {
    Some(PixelErrors::shown(outcome, outcome.head()?.head().raster().into()))
}
