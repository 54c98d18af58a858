//! How far a pixel's content is from where it should be at the moment when it lights.

use crate::content::{Content, Contents};
use crate::shown::{Drawn, FacesSeen, Moment, Seen, Shown, view_of};
use glam::{DVec2, DVec3};
use pxpl5_run::{HeadViews, Outcome, Settled};
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use std::sync::Arc;
use tracking::Pose;
use tracking::view::{HmdView, PixelError, dual_list};

/// Projects and compares.
#[derive(Debug)]
pub(crate) struct Judge {
    pub(crate) view: HmdView,
    head: Arc<HeadViews>,
    /// What rays meet; nothing where errors are judged at a distance that was said.
    contents: Contents,
    /// Where rays end that meet nothing.
    distance_m: f64,
}

impl Judge {
    pub(crate) fn new(run: &Settled<'_>, head: &Arc<HeadViews>) -> Self {
        let view = view_of(run.record.display());
        let at_content = head.head().judge_at_m().is_none();
        let contents = if at_content { Contents::of(head.scene()) } else { Contents::default() };
        Self { view, head: Arc::clone(head), contents, distance_m: head.distance_m() }
    }

    /// The direction in head axes that a place of the picture shows, 1 m deep.
    fn direction(&self, place: DVec2) -> DVec3 {
        let from_centre = (place - self.view.centre_px()) / self.view.focal_px();
        DVec3::new(from_centre.x, -from_centre.y, -1.0)
    }

    /// What stands at a place of a view: the scene's content there, or a point at the distance of what has none.
    fn met(&self, moment: &Moment, place: DVec2) -> Content {
        let Pose { position, orientation } = moment.pose;
        let direction = orientation * self.direction(place);
        let met = self.contents.met(position, direction, moment.objects_at);
        met.unwrap_or_else(|| Content::fixed(position + direction * self.distance_m))
    }

    /// The nearest of what stands at a place of several memories, of the lowest where they are alike; a point at the distance of what
    /// has none where all are empty.
    fn nearest(&self, faces: &FacesSeen, place: DVec2) -> Content {
        let direction = self.direction(place);
        let met = faces.memories.iter().filter_map(|(moment, structures)| {
            let Pose { position, orientation } = moment.pose;
            self.contents.met_of(position, orientation * direction, moment.objects_at, structures)
        });
        let nearest = met.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, content)| content);
        nearest.unwrap_or_else(|| {
            let Pose { position, orientation } = faces.memories[0].0.pose;
            Content::fixed(position + orientation * direction * self.distance_m)
        })
    }

    /// What stands at a place of what was drawn.
    fn content(&self, drawn: &Drawn, place: DVec2) -> Content {
        match drawn {
            Drawn::View(moment) => self.met(moment, place),
            Drawn::Faces(faces) => self.nearest(faces, place),
            Drawn::Shifted(moment, shift) => self.met(moment, place - *shift),
            Drawn::Between { from, to, part, on_screen } => {
                let between = between(from, to, *part);
                let mut guess = place;
                // Each step leaves the square of a per cent or two.
                for _ in 0..4 {
                    let content = self.met(&between, guess);
                    let [a, b] = [from, to].map(|end| end.pose.view_of(self.contents.place(&content, end.objects_at)));
                    let interpolate = if *on_screen { dual_list::screen_space } else { dual_list::view_space };
                    guess += interpolate(&self.view, a, b, *part).map_or(DVec2::ZERO, |at| place - at);
                }
                self.met(&between, guess)
            }
        }
    }

    /// The error of a place of the picture that lights at `at`, against where its content is then; `None` if that is behind
    /// the eye.
    pub(crate) fn error(&self, place: DVec2, drawn: &Drawn, at: Time) -> Option<PixelError> {
        let content = self.contents.place(&self.content(drawn, place), at);
        let seen = self.head.truth(at).view_of(content);
        let offset_px = place - self.view.project(seen)?;
        let degrees = angle_between(self.direction(place), seen).to_degrees();
        Some(PixelError { offset_px, pixels: offset_px.length(), degrees })
    }
}

/// A part of the way from one moment to another.
fn between(from: &Moment, to: &Moment, part: f64) -> Moment {
    let begin = from.objects_at.0 as f64;
    let end = to.objects_at.0 as f64;
    Moment { pose: from.pose.interpolate(&to.pose, part), objects_at: Time((begin + (end - begin) * part) as u64) }
}

/// Angle between two vectors, exact for small ones too.
fn angle_between(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// Judges single pixels of a run.
#[derive(Debug)]
pub struct Registration<'a> {
    run: Settled<'a>,
    judge: Judge,
    shown: Shown,
}

impl<'a> Registration<'a> {
    /// Of a run, as far as it is kept; `None` when it had no head.
    #[must_use]
    pub fn of(outcome: &'a Outcome) -> Option<Self> {
        let run = outcome.settled();
        let head = run.head?;
        Some(Self { judge: Judge::new(&run, head), shown: Shown::of_run(&run, head), run })
    }

    /// The error of a pixel in a field that scans its line; `None` where no picture is shown that was complete in time, or where
    /// its content should be behind the eye.
    #[must_use]
    pub fn at(&self, x: u32, y: u32, field: PeriodNumber) -> Option<PixelError> {
        let at = self.run.record.display().lights(0, x, y, field)?;
        let Seen::Complete(drawn) = self.shown.seen(&self.run, [x, y], field, at) else { return None };
        self.judge.error(middle(x, y), &drawn, at)
    }
}

/// The middle of a pixel.
pub(crate) fn middle(x: u32, y: u32) -> DVec2 {
    DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_a_pixel_is_half_a_pixel_beyond_its_corner() {
        assert_eq!(middle(0, 7), DVec2::new(0.5, 7.5));
    }

    /// Objects stand where they are after the same part of the time as the head of its way.
    #[test]
    fn between_two_moments_objects_and_head_are_the_same_part_of_the_way() {
        let moment = |at: u64| Moment { pose: Pose::at(DVec3::X * at as f64), objects_at: Time(at) };
        for (part, expected) in [(0.0, 1_000), (0.25, 1_500), (1.0, 3_000)] {
            let Moment { pose, objects_at } = between(&moment(1_000), &moment(3_000), part);
            assert_eq!(objects_at, Time(expected), "{part}");
            assert!((pose.position.x - expected as f64).abs() < 1e-9, "{part}");
        }
    }
}
