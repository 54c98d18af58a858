//! How far a pixel's content is from where it should be at the moment when it lights.

use crate::shown::{Drawn, Shown, view_of};
use glam::{DVec2, DVec3};
use pxpl5_run::{HeadViews, Outcome};
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use tracking::Pose;
use tracking::view::{HmdView, PixelError, dual_list};

/// Projects and compares.
#[derive(Debug)]
pub(crate) struct Judge<'a> {
    pub(crate) view: HmdView,
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
    pub fn at(&self, x: u32, y: u32, field: PeriodNumber) -> Option<PixelError> {
        let at = self.shown.outcome.record().display().lights(0, x, y, field)?;
        let drawn = self.shown.drawn(x, y, field, at)?;
        self.judge.error(middle(x, y), &drawn.drawn, at)
    }
}

/// The middle of a pixel.
pub(crate) fn middle(x: u32, y: u32) -> DVec2 {
    DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)
}
