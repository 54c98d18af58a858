//! The evaluation of pixel errors: rays into the scene give the content of a pixel, and a projection gives its right
//! place.

use crate::content::{Content, Contents};
use crate::reproject::direction;
use crate::shown::{Drawn, FacesSeen, Moment, Seen, Shown};
use glam::{DVec2, DVec3};
use pxpl5_run::{FinalResults, HeadViews, Outcome, hmd_on};
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use std::sync::Arc;
use tracking::Pose;
use tracking::view::{Hmd, Misregistration, dual_list};

/// An evaluator of pixel errors, which casts rays into the scene and projects the hit points onto the screen.
#[derive(Debug)]
pub(crate) struct Evaluator {
    pub(crate) view: Hmd,
    head: Arc<HeadViews>,
    /// The scene's primitives. Empty if the experiment evaluates errors at a fixed distance.
    contents: Contents,
    /// Distance, in metres, at which a ray that hits nothing is assumed to meet content.
    distance_m: f64,
}

impl Evaluator {
    pub(crate) fn new(run: &FinalResults<'_>, head: &Arc<HeadViews>) -> Self {
        let view = hmd_on(run.record.display(), &run.hmd);
        let at_content = head.head().evaluate_at_m.is_none();
        let contents = if at_content { Contents::of(head.scene()) } else { Contents::default() };
        Self { view, head: Arc::clone(head), contents, distance_m: head.distance_m() }
    }

    fn direction(&self, place: DVec2) -> DVec3 {
        direction(&self.view, place)
    }

    /// Returns the scene point visible at a picture position of a view. A ray that hits nothing gets a point at
    /// `distance_m`.
    fn met(&self, moment: &Moment, place: DVec2) -> Content {
        let Pose { position, orientation } = moment.pose;
        let direction = orientation * self.direction(place);
        let met = self.contents.met(position, direction, moment.objects_at);
        met.unwrap_or_else(|| Content::fixed(position + direction * self.distance_m))
    }

    /// Returns the nearest scene point at a picture position over several display memories. If two memories have
    /// content at the same distance, the memory with the lower index is used.
    ///
    /// If no memory has content at `place`, the result is a point at the distance `distance_m`.
    fn nearest(&self, faces: &FacesSeen, place: DVec2) -> Content {
        let direction = self.direction(place);
        let met = faces.memories.iter().filter_map(|(moment, structures)| {
            let Pose { position, orientation } = moment.pose;
            self.contents.hit_among(position, orientation * direction, moment.objects_at, structures)
        });
        let nearest = met.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, content)| content);
        nearest.unwrap_or_else(|| {
            let Pose { position, orientation } = faces.memories[0].0.pose;
            Content::fixed(position + orientation * direction * self.distance_m)
        })
    }

    pub(crate) fn content(&self, drawn: &Drawn, place: DVec2) -> Content {
        match drawn {
            Drawn::View(moment) => self.met(moment, place),
            Drawn::Faces(faces) => self.nearest(faces, place),
            Drawn::ShiftedRaster(moment, shift) => self.met(moment, place - *shift),
            // Find by iteration the content that interpolation moves to this position.
            Drawn::Between { from, to, part, on_screen } => {
                let between = between(from, to, *part);
                let mut guess = place;
                // Each step squares the remaining relative error, which starts at one or two per cent.
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

    /// Returns the error of the content that is displayed at the position `place`. The correct position is the position
    /// at the time `at`, when the pixel is lit.
    pub(crate) fn error(&self, place: DVec2, drawn: &Drawn, at: Time) -> Evaluated {
        self.error_of(place, &self.content(drawn, place), at)
    }

    /// Returns the error of `content`, which is displayed at the position `place` at the time `at`.
    pub(crate) fn error_of(&self, place: DVec2, content: &Content, at: Time) -> Evaluated {
        self.error_between(place, content, at, at)
    }

    /// Returns the error of `content`, which is displayed at the position `place`. The correct position is seen from the
    /// head at the time `head_at`, with moving objects at the time `objects_at`.
    pub(crate) fn error_between(&self, place: DVec2, content: &Content, head_at: Time, objects_at: Time) -> Evaluated {
        let content = self.contents.place(content, objects_at);
        let seen = self.head.truth(head_at).view_of(content);
        let degrees = angle_between(self.direction(place), seen).to_degrees();
        let diagonal = self.view.centre_px().length() * 2.0;
        let projected = self.view.project(seen);
        // Content behind the eye lies beyond the edge of the picture, on the side to which it is nearer.
        let offset_px = match projected {
            Some(right) => (place - right).clamp_length_max(diagonal),
            None => DVec2::new(-seen.x, seen.y).try_normalize().unwrap_or(DVec2::X) * diagonal,
        };
        let is_outside = !projected.is_some_and(|right| self.view.contains(right));
        let error = Misregistration { offset_px, pixels: offset_px.length(), degrees };
        Evaluated { error, is_outside, is_behind: projected.is_none() }
    }

    /// Returns true if a primitive of the scene is drawn at a position of a view. `None` if errors are evaluated at a
    /// fixed distance, or if the whole scene moves with the head.
    pub(crate) fn is_covered(&self, drawn: &Drawn, place: DVec2) -> Option<bool> {
        if self.contents.is_empty() {
            return None;
        }
        let hits = |moment: &Moment, place: DVec2| {
            let Pose { position, orientation } = moment.pose;
            self.contents.met(position, orientation * self.direction(place), moment.objects_at).is_some()
        };
        Some(match drawn {
            Drawn::ShiftedRaster(moment, shift) => hits(moment, place - *shift),
            Drawn::Faces(faces) => faces.memories.iter().any(|(moment, _)| hits(moment, place)),
            Drawn::View(_) | Drawn::Between { .. } => hits(&self.moment(drawn), place),
        })
    }
}

/// The error of a pixel, and the place of its content.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Evaluated {
    pub(crate) error: Misregistration,
    /// True if the content has left the picture, or lies behind the eye.
    pub(crate) is_outside: bool,
    pub(crate) is_behind: bool,
}

/// Reason why the last picture does not have the content of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lost {
    /// The content lies beyond the edge of the last picture.
    Beyond,
    /// Another object hid the content in the last picture.
    Hidden,
}

/// Smallest relative difference in depth at which near content hides far content.
const NEARER: f64 = 1e-4;

impl Evaluator {
    /// Returns the content at the screen position `place`, after each pixel of a picture was moved by its depth to the
    /// pose `now`.
    pub(crate) fn warped(&self, drawn: &Moment, now: &Pose, place: DVec2) -> Result<(Content, DVec2), Lost> {
        let ahead = now.orientation * self.direction(place);
        let met = self.contents.met(now.position, ahead, drawn.objects_at);
        let content = met.or_else(|| self.on_background(drawn, now, ahead)).ok_or(Lost::Beyond)?;
        let point = drawn.pose.view_of(self.contents.place(&content, drawn.objects_at));
        let source = self.view.project(point).filter(|source| self.view.contains(*source)).ok_or(Lost::Beyond)?;
        let before = self.contents.place(&self.met(drawn, source), drawn.objects_at);
        let is_hidden = -drawn.pose.view_of(before).z < -point.z * (1.0 - NEARER);
        if is_hidden { Err(Lost::Hidden) } else { Ok((content, source)) }
    }

    /// Returns the depth of the content at a position of a picture, in metres along the axis of the view.
    pub(crate) fn depth(&self, drawn: &Moment, place: DVec2) -> f64 {
        let content = self.contents.place(&self.met(drawn, place), drawn.objects_at);
        -drawn.pose.view_of(content).z
    }

    /// Returns the point at which a ray from the pose `now` meets the background of a picture. The background is a
    /// plane at the distance `distance_m` from the pose of the picture.
    fn on_background(&self, drawn: &Moment, now: &Pose, ahead: DVec3) -> Option<Content> {
        let axis = drawn.pose.orientation * DVec3::NEG_Z;
        let begin = (now.position - drawn.pose.position).dot(axis);
        let way = (self.distance_m - begin) / ahead.dot(axis);
        (way.is_finite() && way > 0.0).then(|| Content::fixed(now.position + ahead * way))
    }

    /// Returns the pose and time for which a pixel was drawn. A pixel that is interpolated between two views gets a
    /// pose and a time between theirs.
    pub(crate) fn moment(&self, drawn: &Drawn) -> Moment {
        match drawn {
            Drawn::View(moment) | Drawn::ShiftedRaster(moment, _) => *moment,
            Drawn::Between { from, to, part, .. } => between(from, to, *part),
            Drawn::Faces(faces) => faces.memories[0].0,
        }
    }

    /// Returns the distance that a content moves across the screen between two times (its smear), in pixels.
    ///
    /// Returns `None` if the content is behind the eye.
    pub(crate) fn way_px(&self, content: &Content, from: Time, to: Time) -> Option<f64> {
        let place = |at: Time| {
            let point = self.contents.place(content, at);
            self.view.project(self.head.truth(at).view_of(point))
        };
        Some(place(from)?.distance(place(to)?))
    }
}

/// Interpolates between the poses and times `from` and `to`. `part` is 0 at `from` and 1 at `to`.
fn between(from: &Moment, to: &Moment, part: f64) -> Moment {
    let begin = from.objects_at.0 as f64;
    let end = to.objects_at.0 as f64;
    let measured_at = from.measured_at.zip(to.measured_at).map(|(from, to)| {
        let [begin, end] = [from, to].map(|at| at.0 as f64);
        Time((begin + (end - begin) * part) as u64)
    });
    let objects_at = Time((begin + (end - begin) * part) as u64);
    Moment { pose: from.pose.interpolate(&to.pose, part), objects_at, measured_at }
}

/// Returns the angle between two vectors in radians. The formula is accurate for small angles too.
fn angle_between(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// An evaluator that computes the pixel error of any single pixel of a run.
#[derive(Debug)]
pub struct Registration<'a> {
    run: FinalResults<'a>,
    evaluator: Evaluator,
    shown: Shown,
}

impl<'a> Registration<'a> {
    /// Prepares the evaluation of a run from the records that remain in memory. Returns `None` for a run without a
    /// head.
    pub fn of(outcome: &'a Outcome) -> Option<Self> {
        Self::so_far(outcome.final_results())
    }

    /// Prepares the evaluation of a run that goes on, from the records that remain in memory. Returns `None` for a run
    /// without a head.
    pub fn so_far(run: FinalResults<'a>) -> Option<Self> {
        let head = run.head?;
        Some(Self { evaluator: Evaluator::new(&run, head), shown: Shown::of_run(&run, head), run })
    }

    /// Returns the error of the pixel (`x`, `y`). The field `field` must scan the line of the pixel.
    ///
    /// Returns `None` if the picture shown was not complete in time. The error in pixels is at most the picture's diagonal
    /// ([`PixelErrors`](crate::PixelErrors)).
    pub fn at(&self, x: u32, y: u32, field: PeriodNumber) -> Option<Misregistration> {
        let at = self.run.record.display().lights(0, x, y, field)?;
        let Seen::Complete(drawn) = self.shown.seen(&self.run, [x, y], field, at) else { return None };
        Some(self.evaluator.error(middle(x, y), &drawn, at).error)
    }

    /// Returns the error in the middle of the first surface, in the last field that ended at or before `now`.
    ///
    /// Returns `None` if no field has ended, or if the picture shown was not complete in time.
    pub fn in_the_middle(&self, now: Time) -> Option<Misregistration> {
        let display = self.run.record.display();
        let field = display.period_at(now).before(1)?;
        let surface = display.surfaces().first()?;
        // A field of an interlaced display scans one of these two lines.
        let lines = [surface.height / 2, surface.height / 2 + 1];
        lines.into_iter().find_map(|line| self.at(surface.width / 2, line, field))
    }
}

pub(crate) fn middle(x: u32, y: u32) -> DVec2 {
    DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_centre_of_a_pixel_is_half_a_pixel_beyond_its_corner() {
        assert_eq!(middle(0, 7), DVec2::new(0.5, 7.5));
    }

    #[test]
    fn between_two_poses_head_and_objects_are_interpolated_at_the_same_instant() {
        let moment = |at: u64| Moment { pose: Pose::at(DVec3::X * at as f64), objects_at: Time(at), measured_at: None };
        for (part, expected) in [(0.0, 1_000), (0.25, 1_500), (1.0, 3_000)] {
            let Moment { pose, objects_at, .. } = between(&moment(1_000), &moment(3_000), part);
            assert_eq!(objects_at, Time(expected), "{part}");
            assert!((pose.position.x - expected as f64).abs() < 1e-9, "{part}");
        }
    }
}
