//! Pictures that a viewer sees at the end of a run, and both eyes side by side.
//!
//! | picture | size (NTSC) |
//! |---|---|
//! | [`Display::seen`] | 640 x 480, a field and the preceding field |
//! | [`Display::seen_at`] | 640 x 480, as seen at an instant during the scan of a field |
//! | [`Display::shown`] | 640 x 480, the buffer that is shown |
//! | [`side_by_side`] | twice as wide, left eye on the left |

use crate::raster::RasterOffsets;
use image::{GenericImage, RgbImage};
use pxpl5_machine::Record;
use pxpl5_run::{Outcome, Pixels};
use pxpl5_wire::display::Display;
use pxpl5_wire::{PeriodNumber, SurfaceId};

/// Returns two pictures next to each other, the left eye on the left.
///
/// The result is as high as the taller picture.
pub fn side_by_side(left: &RgbImage, right: &RgbImage) -> RgbImage {
    let mut both = RgbImage::new(left.width() + right.width(), left.height().max(right.height()));
    // Both copies fit, so the result can be ignored.
    let _ = both.copy_from(left, 0, 0);
    let _ = both.copy_from(right, left.width(), 0);
    both
}

/// Returns the picture that the viewer of a surface sees at the end of a run.
///
/// Returns `None` if the experiment computes no pixels, or before anything was shown.
pub fn picture(outcome: &Outcome, surface: impl Into<SurfaceId>) -> Option<RgbImage> {
    let surface = surface.into();
    if outcome.experiment().pixels == Pixels::Off {
        return None;
    }
    // A shifted raster needs the offsets of the fields that are visible.
    match RasterOffsets::of(outcome) {
        Some(offsets) => {
            let display = outcome.record().display();
            Some(screen(outcome.record(), surface, display.last_seen()?, Some(&offsets)))
        }
        None => outcome.pipeline().picture(outcome.record(), surface),
    }
}

/// Returns the picture that a viewer sees at the end of a display period.
///
/// If `offsets` is set, the rows are shifted by these offsets.
///
/// Returns a black picture for a surface that does not exist.
pub fn screen(
    record: &Record,
    surface: SurfaceId,
    period: PeriodNumber,
    offsets: Option<&RasterOffsets<'_>>,
) -> RgbImage {
    let display = record.display();
    let Some(seen) = display.seen(surface.index(), period) else { return blank(display) };
    let Some(offsets) = offsets else { return seen };
    let mut shifted = RgbImage::new(seen.width(), seen.height());
    // An interlaced screen still shows the lines of the previous period.
    if let Some(before) = period.before(1).filter(|before| display.rows_lit(*before) != display.rows_lit(period)) {
        offsets.shift_rows(&seen, before, &mut shifted);
    }
    offsets.shift_rows(&seen, period, &mut shifted);
    shifted
}

fn blank(display: &dyn Display) -> RgbImage {
    display.surfaces().first().map_or_else(RgbImage::default, |surface| RgbImage::new(surface.width, surface.height))
}
