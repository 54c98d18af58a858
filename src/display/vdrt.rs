//! The raster offset of VDRT: the picture is moved, as it is scanned out, by what its pose was wrong.

use super::Display;
use crate::compare::{Drawn, Shown};
use crate::experiment::Outcome;
use crate::head_to_light::{Follower, HeadViews};
use glam::DVec2;
use image::{Rgb, RgbImage};
use pxpl5_framebuffer::Video;
use pxpl5_sim::Time;
use pxpl5_wire::FieldParity;
use tracking::view::{HmdView, RasterOffset};
use tracking::{Pose, rotation};

/// A raster that is shifted while it is scanned (Breglia 1981).
///
/// At the retrace the newest tracking data are used to predict the head for the field's first line; the picture is
/// shifted by the yaw and the pitch between the pose that it was drawn for and this one, and during the field by their
/// predicted rates. Roll and translation remain. A flat raster is shifted, not turned, so the edges keep an error.
pub struct Vdrt<'a> {
    head: &'a HeadViews,
    follower: Follower,
    video: Video,
}

impl std::fmt::Debug for Vdrt<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Vdrt").field("head", &self.head).finish_non_exhaustive()
    }
}

impl<'a> Vdrt<'a> {
    /// A display behind a head's tracker.
    #[must_use]
    pub fn new(head: &'a HeadViews, video: Video) -> Self {
        Self { head, follower: head.follower(), video }
    }

    /// The offset of a field whose picture was drawn for a pose. Fields must be asked for in rising order.
    pub fn offset(&mut self, field: u64, drawn_for: &Pose) -> RasterOffset {
        let known = self.video.retrace(field);
        let first = self.video.when(0, FieldParity::of_field(field).first_line(), field).unwrap_or(known);
        let field_span = self.video.retrace(field + 1).since(known);
        let [begin, end] = [first, first + field_span].map(|at| self.head.follow(&mut self.follower, known, at));
        let seconds = field_span.as_ms() * 1e-3;
        let rate = rotation::difference(begin.orientation, end.orientation) / seconds;
        RasterOffset::between(drawn_for, &begin, first.0).with_rates(&begin, rate)
    }
}

/// The offset of every field of a run.
#[derive(Clone, Debug)]
pub struct RasterOffsets {
    video: Video,
    offsets: Vec<Option<RasterOffset>>,
}

impl RasterOffsets {
    /// As a run's head has them; `None` unless it looks at a raster that is shifted.
    #[must_use]
    pub fn of(outcome: &Outcome) -> Option<Self> {
        outcome.head().filter(|head| head.head().shown_on() == Display::Vdrt).map(|head| Self::on(outcome, head))
    }

    /// As they would be on such a raster. A field of which nothing is drawn, or not for one pose, has none.
    pub(crate) fn on(outcome: &Outcome, head: &HeadViews) -> Self {
        let (video, shown) = (*outcome.machine().video(), Shown::of(outcome, head));
        let mut vdrt = Vdrt::new(head, video);
        let mut offset = |field: u64| {
            let (x, y) = (video.width() / 2, FieldParity::of_field(field).first_line());
            match shown.drawn(x, y, field, video.when(x, y, field)?)? {
                Drawn::Pose(pose) => Some(vdrt.offset(field, &pose)),
                Drawn::Between { .. } | Drawn::Shifted(..) => None,
            }
        };
        let offsets = (0..outcome.fields()).map(&mut offset).collect();
        Self { video, offsets }
    }

    /// Of a field.
    #[must_use]
    pub fn field(&self, field: u64) -> Option<&RasterOffset> {
        self.offsets.get(usize::try_from(field).ok()?)?.as_ref()
    }

    /// A field's picture (a row for each of its lines), shifted to whole pixels; black where nothing comes in.
    #[must_use]
    pub fn shifted(&self, picture: RgbImage, field: u64) -> RgbImage {
        let Some(offset) = self.field(field) else { return picture };
        let (view, parity) = (HmdView::ntsc(), FieldParity::of_field(field).first_line());
        RgbImage::from_fn(picture.width(), picture.height(), |x, row| {
            let at = self.video.when(x, 2 * row + parity, field).unwrap_or(Time::ZERO);
            let shift = offset.shift_px(&view, at.0);
            let from = DVec2::new(f64::from(x) - shift.x, f64::from(row) - shift.y / 2.0).round();
            let inside = from.x >= 0.0 && from.y >= 0.0;
            let pixel = inside.then(|| picture.get_pixel_checked(from.x as u32, from.y as u32)).flatten();
            pixel.copied().unwrap_or(Rgb([0; 3]))
        })
    }
}
