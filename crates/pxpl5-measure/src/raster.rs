//! The raster offset of VDRT: the picture is moved, as it is scanned out, by what its pose was wrong.

use crate::shown::{Drawn, Shown, view_of};
use glam::DVec2;
use image::{Rgb, RgbImage};
use pxpl5_display::Display;
use pxpl5_run::{Estimator, Outcome, Raster, Settled};
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use tracking::view::{HmdView, RasterOffset};
use tracking::{Pose, rotation};

/// A raster that is shifted while it is scanned (Breglia 1981).
///
/// At the retrace the newest tracking data are used to predict the head for the field's first line; the picture is
/// shifted by the yaw and the pitch between the pose that it was drawn for and this one, and during the field by their
/// predicted rates. Roll and translation remain. A flat raster is shifted, not turned, so the edges keep an error.
pub struct Vdrt<'a> {
    estimator: Estimator,
    display: &'a dyn Display,
}

impl std::fmt::Debug for Vdrt<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Vdrt").finish_non_exhaustive()
    }
}

impl<'a> Vdrt<'a> {
    /// A display behind what the host knows of a head.
    #[must_use]
    pub const fn new(estimator: Estimator, display: &'a dyn Display) -> Self {
        Self { estimator, display }
    }

    /// The offset of a field whose picture was drawn for a pose. Fields must be asked for in rising order.
    pub fn offset(&mut self, field: PeriodNumber, drawn_for: &Pose) -> RasterOffset {
        offset(&mut self.estimator, self.display, field, drawn_for)
    }
}

/// The offset of a field whose picture was drawn for a pose, by what is known when it begins.
pub(crate) fn offset(
    estimator: &mut Estimator,
    display: &dyn Display,
    field: PeriodNumber,
    drawn_for: &Pose,
) -> RasterOffset {
    let known = display.tick(field);
    let first = display.first_light(0, field).unwrap_or(known);
    let field_span = display.tick(field.next()).since(known);
    let [begin, end] = [first, first + field_span].map(|at| estimator.pose(known, at));
    let seconds = field_span.as_ms() * 1e-3;
    let rate = rotation::difference(begin.orientation, end.orientation) / seconds;
    RasterOffset::between(drawn_for, &begin, first.0).with_rates(&begin, rate)
}

/// The offset of every field of a run.
#[derive(Clone, Debug)]
pub struct RasterOffsets<'a> {
    display: &'a dyn Display,
    view: HmdView,
    offsets: Vec<Option<RasterOffset>>,
}

impl<'a> RasterOffsets<'a> {
    /// As a run's head has them; `None` unless it looks at a raster that is shifted. A field of which nothing is drawn, or not for one pose,
    /// has none.
    #[must_use]
    pub fn of(outcome: &'a Outcome) -> Option<Self> {
        let head = outcome.head().filter(|head| head.head().raster() == Raster::Vdrt)?;
        let run = outcome.settled();
        let shown = Shown::of_run(&run, head);
        let display = outcome.record().display();
        let mut vdrt = Vdrt::new(Estimator::new(head, None), display);
        let offsets = PeriodNumber::FIRST.until(run.until).map(|field| {
            let pose = pose_of_field(&run, &shown, field)?;
            Some(vdrt.offset(field, &pose))
        });
        Some(Self { display, view: view_of(display), offsets: offsets.collect() })
    }

    /// The offset in one period of the display; `None` where nothing is drawn, or not for one pose.
    #[must_use]
    pub fn field(&self, field: PeriodNumber) -> Option<&RasterOffset> {
        self.offsets.get(usize::try_from(field.0).ok()?)?.as_ref()
    }

    /// A screen, the rows that are lit in a field shifted to whole pixels; black where nothing comes in, and where the
    /// field has no offset the rows as they are.
    pub fn shift_rows(&self, screen: &RgbImage, field: PeriodNumber, shifted: &mut RgbImage) {
        let offset = self.field(field);
        let (first_row, row_distance) = self.display.rows_lit(field);
        for y in (first_row..screen.height()).step_by(row_distance as usize) {
            for x in 0..screen.width() {
                let pixel = match offset {
                    Some(offset) => self.shifted_pixel(screen, offset, field, [x, y]),
                    None => *screen.get_pixel(x, y),
                };
                shifted.put_pixel(x, y, pixel);
            }
        }
    }

    /// The pixel that a shift brings to a place, from a row of the same field.
    fn shifted_pixel(
        &self,
        screen: &RgbImage,
        offset: &RasterOffset,
        field: PeriodNumber,
        [x, y]: [u32; 2],
    ) -> Rgb<u8> {
        let (first_row, row_distance) = self.display.rows_lit(field);
        let at = self.display.lights(0, x, y, field).unwrap_or(Time::ZERO);
        let shift = offset.shift_px(&self.view, at.0);
        let row = (y - first_row) / row_distance;
        let from = DVec2::new(f64::from(x) - shift.x, f64::from(row) - shift.y / f64::from(row_distance)).round();
        let inside = from.x >= 0.0 && from.y >= 0.0;
        let place = [from.x as u32, from.y as u32 * row_distance + first_row];
        let pixel = inside.then(|| screen.get_pixel_checked(place[0], place[1])).flatten();
        pixel.copied().unwrap_or(Rgb([0; 3]))
    }
}

/// The one pose that all of a field was drawn for.
pub(crate) fn pose_of_field(run: &Settled<'_>, shown: &Shown, field: PeriodNumber) -> Option<Pose> {
    let display = run.record.display();
    let x = display.surfaces().first()?.width / 2;
    let (y, _) = display.rows_lit(field);
    match shown.drawn(run, [x, y], field, display.lights(0, x, y, field)?)? {
        Drawn::View(moment) => Some(moment.pose),
        Drawn::Between { .. } | Drawn::Shifted(..) | Drawn::Faces(_) => None,
    }
}
