//! Pictures of a run: what stands before a viewer at the end, both eyes side by side.
//!
//! | picture | size (NTSC) |
//! |---|---|
//! | [`Display::seen`] | 640 x 480, a field and the one before it |
//! | [`Display::seen_at`] | 640 x 480, as the beam is at an instant |
//! | [`Display::shown`] | 640 x 480, the buffer that is shown |
//! | [`side_by_side`] | twice as wide: left eye left |

use crate::raster::RasterOffsets;
use image::{GenericImage, RgbImage};
use pxpl5_display::Display;
use pxpl5_machine::Record;
use pxpl5_run::{Outcome, Pixels};
use pxpl5_wire::{PeriodNumber, SurfaceId};

/// Two pictures next to each other, the left eye's left; the height is that of the higher one.
#[must_use]
pub fn side_by_side(left: &RgbImage, right: &RgbImage) -> RgbImage {
    let mut both = RgbImage::new(left.width() + right.width(), left.height().max(right.height()));
    // Both fit by construction.
    let _ = both.copy_from(left, 0, 0);
    let _ = both.copy_from(right, left.width(), 0);
    both
}

/// What the viewer of a surface sees at the end of a run; `None` without pixels, or before anything was shown.
#[must_use]
pub fn picture(outcome: &Outcome, surface: impl Into<SurfaceId>) -> Option<RgbImage> {
    let surface = surface.into();
    if outcome.experiment().pixels_wanted() == Pixels::Off {
        return None;
    }
    match RasterOffsets::of(outcome) {
        Some(offsets) => {
            let display = outcome.record().display();
            Some(screen(outcome.record(), surface, display.last_seen()?, Some(&offsets)))
        }
        None => outcome.pipeline().picture(outcome.record(), surface),
    }
}

/// What stands before a viewer at the end of a period, shifted as his raster does; black for a surface that is not there.
#[must_use]
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
    if let Some(before) = period.before(1) {
        offsets.shift_rows(&seen, before, &mut shifted);
    }
    offsets.shift_rows(&seen, period, &mut shifted);
    shifted
}

/// A black picture of a display's size.
fn blank(display: &dyn Display) -> RgbImage {
    display.surfaces().first().map_or_else(RgbImage::default, |surface| RgbImage::new(surface.width, surface.height))
}
