//! Pixel error: where each pixel's content is seen, against where it should be at the moment when it lights.

use crate::raster::RasterOffsets;
use crate::screen::Screen;
use glam::{DVec2, DVec3};
use pxpl5_display::{Display, Surface};
use pxpl5_run::{HeadViews, Outcome, Raster, Source};
use pxpl5_sim::Time;
use serde::Serialize;
use std::collections::BTreeMap;
use tracking::Pose;
use tracking::view::{HmdView, PixelError, dual_list};

/// Mean and percentiles of some numbers, all zero for none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Percentiles {
    /// Mean.
    pub mean: f64,
    /// Median.
    pub p50: f64,
    /// 90 of 100 are at most this.
    pub p90: f64,
    /// 99 of 100 are at most this.
    pub p99: f64,
    /// Greatest.
    pub max: f64,
}

impl Percentiles {
    /// Of some numbers, none of them NaN. A percentile is the smallest number that so many do not exceed.
    #[must_use]
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.collect();
        values.sort_by(f64::total_cmp);
        let Some(max) = values.last().copied() else { return Self::default() };
        let at = |percent: usize| values[(values.len() * percent).div_ceil(100).max(1) - 1];
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        Self { mean, p50: at(50), p90: at(90), p99: at(99), max }
    }
}

/// The error of one field.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FieldError {
    /// The field.
    pub field: u64,
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

/// What a pixel was drawn for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Drawn {
    Pose(Pose),
    Between {
        from: Pose,
        to: Pose,
        part: f64,
        on_screen: bool,
    },
    /// A picture that is shifted on its way to the screen.
    Shifted(Pose, DVec2),
}

/// Projects and compares.
#[derive(Debug)]
pub(crate) struct Judge<'a> {
    view: HmdView,
    head: &'a HeadViews,
    distance_m: f64,
}

impl<'a> Judge<'a> {
    pub(crate) fn new(outcome: &Outcome, head: &'a HeadViews) -> Self {
        let view = view_of(outcome.record().display());
        Self { view, head, distance_m: head.distance_m() }
    }

    /// The point in head axes that a place of the picture shows.
    fn point(&self, place: DVec2) -> DVec3 {
        let from_centre = (place - self.view.centre_px()) / self.view.focal_px();
        DVec3::new(from_centre.x, -from_centre.y, -1.0) * self.distance_m
    }

    fn world(&self, pose: &Pose, place: DVec2) -> DVec3 {
        pose.position + pose.orientation * self.point(place)
    }

    /// The world point that stands at a place of what was drawn.
    fn content(&self, drawn: &Drawn, place: DVec2) -> DVec3 {
        match *drawn {
            Drawn::Pose(pose) => self.world(&pose, place),
            Drawn::Shifted(pose, shift) => self.world(&pose, place - shift),
            Drawn::Between { from, to, part, on_screen } => {
                let between = from.interpolate(&to, part);
                let drawn_at = |world: DVec3| {
                    let (a, b) = (from.view_of(world), to.view_of(world));
                    let interpolate = if on_screen { dual_list::screen_space } else { dual_list::view_space };
                    interpolate(&self.view, a, b, part)
                };
                let mut guess = place;
                // Each step leaves the square of a per cent or two.
                for _ in 0..4 {
                    guess += drawn_at(self.world(&between, guess)).map_or(DVec2::ZERO, |at| place - at);
                }
                self.world(&between, guess)
            }
        }
    }

    /// The error of a place of the picture that lights at `at`; `None` if its content should be behind the eye.
    pub(crate) fn error(&self, place: DVec2, drawn: &Drawn, at: Time) -> Option<PixelError> {
        let seen = self.head.truth(at).view_of(self.content(drawn, place));
        let shown = self.point(place);
        let offset_px = place - self.view.project(seen)?;
        let degrees = angle_between(shown, seen).to_degrees();
        Some(PixelError { offset_px, pixels: offset_px.length(), degrees })
    }
}

/// Angle between two vectors, exact for small ones too.
fn angle_between(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

/// Judges single pixels of a run.
#[derive(Debug)]
pub struct Registration<'a> {
    judge: Judge<'a>,
    shown: Shown<'a>,
}

impl<'a> Registration<'a> {
    /// Of a run; `None` when it had no head.
    #[must_use]
    pub fn of(outcome: &'a Outcome) -> Option<Self> {
        let head = outcome.head()?;
        Some(Self { judge: Judge::new(outcome, head), shown: Shown::of_run(outcome, head) })
    }

    /// The error of a pixel in a field that scans its line; `None` where nothing is shown yet, or where its content
    /// should be behind the eye.
    #[must_use]
    pub fn at(&self, x: u32, y: u32, field: u64) -> Option<PixelError> {
        let at = self.shown.outcome.record().display().lights(0, x, y, field)?;
        let drawn = self.shown.drawn(x, y, field, at)?;
        self.judge.error(middle(x, y), &drawn, at)
    }
}

/// The middle of a pixel.
fn middle(x: u32, y: u32) -> DVec2 {
    DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)
}

/// Everything that is known of a run's views.
#[derive(Debug)]
pub(crate) struct Shown<'a> {
    outcome: &'a Outcome,
    screen: Screen,
    views: BTreeMap<u64, u64>,
    poses: BTreeMap<u64, Pose>,
}

impl<'a> Shown<'a> {
    pub(crate) fn of_run(outcome: &'a Outcome, head: &HeadViews) -> Self {
        Self {
            outcome,
            screen: Screen::of_record(outcome.record()),
            views: outcome.pictures().iter().map(|times| (times.picture, times.view)).collect(),
            poses: head.sampled().into_iter().map(|sampled| (sampled.number, sampled.pose)).collect(),
        }
    }

    /// What a pixel that lights at `at` shows; `None` before anything came.
    pub(crate) fn drawn(&self, x: u32, y: u32, field: u64, at: Time) -> Option<Drawn> {
        let target = self.screen.shown(x, y, field, at)?;
        let pose = |number: u64| self.poses.get(&number).copied();
        Some(match self.outcome.pipeline().source(self.outcome.record(), &target, &self.views)? {
            Source::View(number) => Drawn::Pose(pose(number)?),
            Source::Between { from, to, part, on_screen } => {
                Drawn::Between { from: pose(from)?, to: pose(to)?, part, on_screen }
            }
        })
    }
}

/// The picture of the head-mounted display on the first surface of a display.
pub(crate) fn view_of(display: &dyn Display) -> HmdView {
    let ntsc = HmdView::ntsc();
    let sized = |surface: &Surface| HmdView::new(surface.width, surface.height, ntsc.horizontal_deg());
    display.surfaces().first().and_then(|surface| sized(surface).ok()).unwrap_or(ntsc)
}

/// The pixels of a period at which it is judged, in the order of the beam, and when each lights.
fn grid(display: &dyn Display, period: u64) -> Vec<(u32, u32, Time)> {
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
        field: u64,
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
        mut drawn: impl FnMut(&Shown<'_>, &HmdView, (u32, u32, u64, Time)) -> Option<Drawn>,
    ) -> Self {
        let Some(head) = outcome.head() else { return Self::default() };
        let judge = Judge::new(outcome, head);
        let shown = Shown::of_run(outcome, head);
        let display = outcome.record().display();
        let mut collected = Collected::default();
        for field in UNJUDGED_FIELDS..outcome.fields().saturating_sub(1) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_of_one_to_a_hundred() {
        let p = Percentiles::of((1..=100).rev().map(f64::from));
        assert_eq!((p.mean, p.p50, p.p90, p.p99, p.max), (50.5, 50.0, 90.0, 99.0, 100.0));
        assert_eq!(Percentiles::of(std::iter::empty()), Percentiles::default());
    }
}
