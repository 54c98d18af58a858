//! Raster offset of Breglia's display VDRT: the display shifts the picture during scan-out. The shift corrects the
//! error of the head pose for which the picture was drawn.

use crate::picture_mover::PictureMover;
use crate::rows::Rows;
use crate::shown::{Drawn, Shown};
use glam::DVec2;
use image::{Rgb, RgbImage};
use pxpl5_run::{Estimator, FinalResults, Outcome, Raster, hmd_on};
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use pxpl5_wire::display::Display;
use std::rc::Rc;
use tracking::view::{Hmd, RasterOffset};
use tracking::{Pose, rotation};

/// Returns the raster offset of a field whose picture was drawn for a pose. The offset comes from a prediction, which
/// uses the tracker reports that have arrived at the field's start.
pub(crate) fn offset(
    estimator: &mut Estimator,
    display: &dyn Display,
    field: PeriodNumber,
    drawn_for: &Pose,
) -> RasterOffset {
    // Only reports known at the retrace count.
    let reports_until = display.tick(field);
    let first = display.first_light(0, field).unwrap_or(reports_until);
    let field_span = display.tick(field.next()).since(reports_until);
    // Predict the pose at the first line and one field later, to get the rates.
    let [begin, end] = [first, first + field_span].map(|at| estimator.pose(reports_until, at));
    let seconds = field_span.as_ms() * 1e-3;
    let rate = rotation::difference(begin.orientation, end.orientation) / seconds;
    RasterOffset::between(drawn_for, &begin, first.0).with_rates(&begin, rate)
}

/// The corrections that a display applies to the pictures of a run.
///
/// The corrections are a raster offset for every field, or a device that moves pictures to the newest pose.
#[derive(Clone, Debug)]
pub struct RasterOffsets<'a> {
    display: &'a dyn Display,
    view: Hmd,
    moved_by: MovedBy<'a>,
}

#[derive(Clone, Debug)]
enum MovedBy<'a> {
    Offsets(Vec<Option<RasterOffset>>),
    Device(Rc<PictureMover<'a>>),
}

impl<'a> RasterOffsets<'a> {
    /// Returns the corrections for a run's pictures, or `None` if the head's display shows pictures as drawn.
    ///
    /// If the display shifts the raster (VDRT), some fields have no offset: fields without a picture, and fields whose
    /// picture was drawn for several poses.
    pub fn of(outcome: &'a Outcome) -> Option<Self> {
        let head = outcome.head()?;
        let run = outcome.final_results();
        let display = outcome.record().display();
        let view = hmd_on(display, &run.hmd);
        match head.head().raster {
            Raster::Plain => return None,
            Raster::Reprojected(setting) => {
                let moved_by = MovedBy::Device(Rc::new(PictureMover::new(run, head, setting)));
                return Some(Self { display, view, moved_by });
            }
            Raster::Vdrt => {}
        }
        // VDRT computes the offset of each field from the pose for which its picture was drawn.
        let shown = Shown::of_run(&run, head);
        let mut estimator = Estimator::new(head, None);
        let offsets = PeriodNumber::FIRST.until(run.until).map(|field| {
            let pose = pose_of_field(&run, &shown, field)?;
            Some(offset(&mut estimator, display, field, &pose))
        });
        Some(Self { display, view, moved_by: MovedBy::Offsets(offsets.collect()) })
    }

    /// Returns the raster offset in one display period.
    ///
    /// Returns `None` if nothing is shown, or if the picture was not drawn for a single pose. Also returns `None` if a
    /// device moves pictures to the newest pose instead.
    pub fn field(&self, field: PeriodNumber) -> Option<&RasterOffset> {
        let MovedBy::Offsets(offsets) = &self.moved_by else { return None };
        offsets.get(usize::try_from(field.0).ok()?)?.as_ref()
    }

    /// Copies the rows that a field lights from `screen` to `shifted`, moved by the field's offset in whole pixels.
    ///
    /// Pixels beyond the edge of the moved rows become black. A field without an offset is copied unchanged.
    pub fn shift_rows(&self, screen: &RgbImage, field: PeriodNumber, shifted: &mut RgbImage) {
        if let MovedBy::Device(mover) = &self.moved_by {
            mover.move_rows(screen, field, shifted);
            return;
        }
        let offset = self.field(field);
        for y in Rows::lit(self.display, field).of(screen.height()) {
            for x in 0..screen.width() {
                let pixel = match offset {
                    Some(offset) => self.shifted_pixel(screen, offset, field, [x, y]),
                    None => *screen.get_pixel(x, y),
                };
                shifted.put_pixel(x, y, pixel);
            }
        }
    }

    /// Returns the pixel of the drawn picture that the shift moves to the position (`x`, `y`). The pixel comes from a
    /// row of the same field.
    fn shifted_pixel(
        &self,
        screen: &RgbImage,
        offset: &RasterOffset,
        field: PeriodNumber,
        [x, y]: [u32; 2],
    ) -> Rgb<u8> {
        let rows = Rows::lit(self.display, field);
        // The shift depends on the time at which the beam lights the pixel.
        let at = self.display.lights(0, x, y, field).unwrap_or(Time::ZERO);
        let shift = offset.shift_px(&self.view, at.0);
        // Stay within the rows of this field.
        let from = DVec2::new(f64::from(x) - shift.x, rows.number_at(f64::from(y) + 0.5 - shift.y)).round();
        let inside = from.x >= 0.0 && from.y >= 0.0;
        let place = [from.x as u32, rows.row(from.y as u32)];
        let pixel = inside.then(|| screen.get_pixel_checked(place[0], place[1])).flatten();
        pixel.copied().unwrap_or(Rgb([0; 3]))
    }
}

/// Returns the pose for which a whole field was drawn, or `None` if different poses were used.
pub(crate) fn pose_of_field(run: &FinalResults<'_>, shown: &Shown, field: PeriodNumber) -> Option<Pose> {
    let display = run.record.display();
    let x = display.surfaces().first()?.width / 2;
    let y = Rows::lit(display, field).first;
    match shown.drawn(run, [x, y], field, display.lights(0, x, y, field)?)? {
        Drawn::View(moment) => Some(moment.pose),
        Drawn::Between { .. } | Drawn::ShiftedRaster(..) | Drawn::Faces(_) => None,
    }
}
