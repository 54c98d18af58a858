//! Moves pictures to a new pose of the head: computes the source of each pixel, and copies the pixels.

use crate::rows::Rows;
use glam::{DQuat, DVec2, DVec3};
use image::{Rgb, RgbImage};
use pxpl5_run::Warp;
use std::ops::Range;
use tracking::Pose;
use tracking::view::{Hmd, RasterOffset};

pub(crate) fn direction(view: &Hmd, place: DVec2) -> DVec3 {
    let from_centre = (place - view.centre_px()) / view.focal_px();
    DVec3::new(from_centre.x, -from_centre.y, -1.0)
}

/// The mapping from positions on the screen to positions in a picture that was drawn for an earlier pose. Depth is
/// ignored.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Move {
    Shift(DVec2),
    /// The view is rotated. The rotation converts directions from the head's newest axes to the head's axes for which
    /// the picture was drawn.
    Turn(DQuat),
}

impl Move {
    /// Returns the mapping from the pose for which a picture was drawn to the newest pose.
    ///
    /// This mapping ignores depth, so [`Warp::Depth`] gives only the rotation. Callers that have depths must correct
    /// for depth separately.
    pub(crate) fn between(by: Warp, view: &Hmd, drawn_for: &Pose, now: &Pose) -> Self {
        match by {
            Warp::Shift => Self::Shift(RasterOffset::between(drawn_for, now, 0).shift_px(view, 0)),
            Warp::Rotation | Warp::Depth => Self::Turn(drawn_for.orientation.conjugate() * now.orientation),
        }
    }

    /// Returns the position in the drawn picture that is seen at the screen position `place`. Returns `None` if the
    /// position lies behind the eye for which the picture was drawn.
    pub(crate) fn source(&self, view: &Hmd, place: DVec2) -> Option<DVec2> {
        match self {
            Self::Shift(shift) => Some(place - *shift),
            Self::Turn(turn) => view.project(*turn * direction(view, place)),
        }
    }
}

/// Writes some pixels of a row. Each pixel is copied from the position that `place` returns, in the source picture.
///
/// Pixels without a source become black. Returns the number of these pixels.
pub(crate) fn fill_row(
    source: &RgbImage,
    rows: Rows,
    (y, xs): (u32, Range<u32>),
    place: impl Fn(u32) -> Option<DVec2>,
    out: &mut RgbImage,
) -> u64 {
    let [width, height] = [f64::from(source.width()), f64::from(source.height())];
    let pixels = source.as_raw();
    let begin = (y as usize * source.width() as usize + xs.start as usize) * 3;
    let out: &mut [u8] = out;
    let targets = out[begin..].chunks_exact_mut(3).zip(xs);
    let mut empty = 0;
    for (target, x) in targets {
        let from = place(x).filter(|from| (0.0..width).contains(&from.x) && (0.0..height).contains(&from.y));
        let Some(from) = from else {
            target.fill(0);
            empty += 1;
            continue;
        };
        // An interlaced picture has only the rows of its field. Take the nearest of these rows.
        let row = if rows == Rows::ALL { from.y as u32 } else { rows.nearest(from.y, source.height()) };
        let at = (row as usize * source.width() as usize + from.x as usize) * 3;
        target.copy_from_slice(&pixels[at..at + 3]);
    }
    empty
}

pub(crate) fn move_row(
    source: &RgbImage,
    rows: Rows,
    (y, xs): (u32, Range<u32>),
    (view, moved): (&Hmd, &Move),
    out: &mut RgbImage,
) -> u64 {
    let begin = DVec2::new(0.5, f64::from(y) + 0.5);
    match moved {
        Move::Shift(shift) => {
            let from = begin - *shift;
            fill_row(source, rows, (y, xs), |x| Some(DVec2::new(from.x + f64::from(x), from.y)), out)
        }
        Move::Turn(turn) => {
            // Along a row, the direction changes by a constant step, so each pixel costs only one division.
            let ray = *turn * direction(view, begin);
            let step = *turn * (DVec3::X / view.focal_px());
            let (centre, focal) = (view.centre_px(), view.focal_px());
            let place = |x: u32| {
                let at = ray + step * f64::from(x);
                let scale = focal / -at.z;
                (at.z < 0.0).then(|| DVec2::new(centre.x + at.x * scale, centre.y - at.y * scale))
            };
            fill_row(source, rows, (y, xs), place, out)
        }
    }
}

/// Moves a whole picture from the pose `drawn_for` to the pose `now`, by a shift or a rotation.
///
/// Each pixel of the result is the nearest pixel of the picture. Pixels without a source are black. Returns the result
/// and the number of these black pixels, or `None` if the picture and the view differ in size. [`Warp::Depth`] is
/// treated as a rotation, because the function receives no depths.
pub fn reproject(picture: &RgbImage, view: &Hmd, by: Warp, drawn_for: &Pose, now: &Pose) -> Option<(RgbImage, u64)> {
    let size = DVec2::new(f64::from(picture.width()), f64::from(picture.height()));
    if size / 2.0 != view.centre_px() {
        return None;
    }
    let moved = Move::between(by, view, drawn_for, now);
    let mut out = RgbImage::from_pixel(picture.width(), picture.height(), Rgb([0; 3]));
    let rows = 0..picture.height();
    let empty = rows.map(|y| move_row(picture, Rows::ALL, (y, 0..picture.width()), (view, &moved), &mut out)).sum();
    Some((out, empty))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracking::rotation;

    /// Returns a picture in which each pixel's colour contains the pixel's column and row.
    fn places(width: u32, height: u32) -> RgbImage {
        RgbImage::from_fn(width, height, |x, y| Rgb([(x >> 8) as u8 + 1, x as u8, y as u8]))
    }

    #[test]
    fn a_picture_of_another_size_than_the_view_is_not_moved() {
        let pose = Pose::IDENTITY;
        assert_eq!(reproject(&places(320, 480), &Hmd::unc(), Warp::Rotation, &pose, &pose), None);
    }

    #[test]
    fn without_movement_every_pixel_stays_and_none_is_empty() {
        let picture = places(640, 480);
        for by in [Warp::Shift, Warp::Rotation] {
            let pose = Pose::facing(rotation::from_yaw_pitch_roll(0.4, -0.2, 0.1));
            assert_eq!(reproject(&picture, &Hmd::unc(), by, &pose, &pose), Some((picture.clone(), 0)));
        }
    }

    /// Tests a head that turns to the left by the angle a. Column x then shows the old column f tan(atan(x / f) - a).
    /// Columns are counted from the middle, and f is the focal length in pixels.
    #[test]
    fn a_rotation_of_the_head_moves_each_column_according_to_its_tangent() {
        let view = Hmd::unc();
        let (f, angle) = (view.focal_px(), 0.05_f64);
        let now = Pose::facing(rotation::about_y(angle));
        let moved = reproject(&places(640, 480), &view, Warp::Rotation, &Pose::IDENTITY, &now);
        let (moved, empty) = moved.expect("the size of the view");
        let from = |x: u32| f * (((f64::from(x) + 0.5 - 320.0) / f).atan() - angle).tan() + 320.0;
        let mut counted = 0;
        for x in 0..640 {
            let from = from(x);
            let pixel = moved.get_pixel(x, 239).0;
            if (0.0..640.0).contains(&from) {
                assert_eq!(u32::from(pixel[0] - 1) * 256 + u32::from(pixel[1]), from as u32, "{x}");
            } else {
                assert_eq!(pixel, [0; 3], "{x}");
                counted += 1;
            }
        }
        // The middle row has as many empty columns as the tangents leave out. All other rows have at least as many.
        assert!(counted > 20 && empty >= counted * 480, "{counted} {empty}");
    }
}
