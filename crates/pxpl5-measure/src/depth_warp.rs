//! Changes a picture with depth to a new pose of the head. The picture's pixels form a mesh in space. The cells of this
//! mesh are drawn as seen from the new pose.
//!
//! No crate for warping images is used. `imageproc` maps pictures by one homography, and supports neither depth nor the
//! rows of a field.

use crate::reproject::direction;
use crate::rows::Rows;
use glam::{DQuat, DVec2, DVec3};
use image::RgbImage;
use std::ops::Range;
use tracking::Pose;
use tracking::view::Hmd;

/// Depths of a picture's pixels, seen from the pose for which the picture was drawn.
#[derive(Clone, Debug)]
pub struct DepthPicture {
    width: u32,
    height: u32,
    /// Depth of each pixel along the axis of the view, in metres, row after row.
    depths: Vec<f32>,
    /// Smallest and largest depth of the picture's pixels in metres, except depths of 0 (rows that do not belong to the
    /// field).
    range: (f32, f32),
}

impl DepthPicture {
    /// Creates the depths of a picture. `depth` returns the depth of the pixel (x, y), in metres along the axis of the
    /// view.
    pub fn from_fn(width: u32, height: u32, depth: impl Fn(u32, u32) -> f32) -> Self {
        let depth = &depth;
        let depths: Vec<f32> = (0..height).flat_map(|y| (0..width).map(move |x| depth(x, y))).collect();
        let drawn = depths.iter().copied().filter(|depth| *depth > 0.0);
        let range = drawn.fold((f32::INFINITY, 0.0_f32), |(near, far), z| (near.min(z), far.max(z)));
        Self { width, height, depths, range }
    }

    /// Computes the depths of the rows of a field. All other rows have a depth of 0.
    pub(crate) fn of_field(size: [u32; 2], rows: Rows, depth: impl Fn(u32, u32) -> f32) -> Self {
        Self::from_fn(size[0], size[1], |x, y| if rows.beside(y) == y { depth(x, y) } else { 0.0 })
    }
}

/// Largest ratio of the depths of two neighbouring pixels that belong to the same surface of an object. At a larger
/// ratio, a near surface ends between the two pixels and hides content of a far surface.
///
/// The ratio is assumed, with a range of 1.02 to 1.2. For comparison, take a floor that is seen at an angle of 5
/// degrees. Its depth changes by a factor of 1.03 from row to row.
const SAME_SURFACE: f32 = 1.1;

/// The pixels of a row of the picture, seen from the new pose. Each list has one number for each pixel, so that vector
/// instructions can compute several pixels at once.
#[derive(Debug, Default)]
struct SeenRow {
    /// Positions on the screen, horizontally in pixels and vertically in rows of the field.
    x: Vec<f32>,
    row: Vec<f32>,
    depth: Vec<f32>,
    /// Depth of each pixel's content, seen from the old pose. Infinity if the content is behind the eye of the new
    /// pose.
    old_depth: Vec<f32>,
    /// For each pixel, the first column of the screen at or to the right of `x`. The list `next_row` has the first
    /// drawn row at or below `row`.
    next_column: Vec<i32>,
    next_row: Vec<i32>,
}

impl SeenRow {
    fn with_length(length: usize) -> Self {
        let [x, row, depth, old_depth] = std::array::from_fn(|_| vec![0.0; length]);
        let [next_column, next_row] = std::array::from_fn(|_| vec![0; length]);
        Self { x, row, depth, old_depth, next_column, next_row }
    }
}

/// Depths and new positions of two neighbouring rows of the picture, pair by pair. A pair is a pixel and the pixel
/// directly below. For each pair, the lists have the smaller and the larger depth, column and row.
#[derive(Debug, Default)]
struct Pairs {
    near: Vec<f32>,
    far: Vec<f32>,
    columns: [Vec<i32>; 2],
    rows: [Vec<i32>; 2],
}

impl Pairs {
    fn join(&mut self, above: &SeenRow, below: &SeenRow) {
        smaller(&mut self.near, &above.old_depth, &below.old_depth);
        larger(&mut self.far, &above.old_depth, &below.old_depth);
        smaller(&mut self.columns[0], &above.next_column, &below.next_column);
        larger(&mut self.columns[1], &above.next_column, &below.next_column);
        smaller(&mut self.rows[0], &above.next_row, &below.next_row);
        larger(&mut self.rows[1], &above.next_row, &below.next_row);
    }
}

fn smaller<T: PartialOrd + Copy>(out: &mut Vec<T>, a: &[T], b: &[T]) {
    out.clear();
    out.extend(a.iter().zip(b).map(|(a, b)| if a < b { *a } else { *b }));
}

fn larger<T: PartialOrd + Copy>(out: &mut Vec<T>, a: &[T], b: &[T]) {
    out.clear();
    out.extend(a.iter().zip(b).map(|(a, b)| if a > b { *a } else { *b }));
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawing<'a> {
    pub(crate) picture: &'a RgbImage,
    pub(crate) depths: &'a DepthPicture,
    pub(crate) view: &'a Hmd,
    /// Rows of the screen that the picture contains: all rows, or the rows of one field.
    pub(crate) rows: Rows,
    pub(crate) drawn_for: &'a Pose,
}

impl Drawing<'_> {
    /// Writes the rows `targets` of the field, as seen from the pose `now`. Rows are counted within the field.
    ///
    /// Pixels without content become black. Returns the number of these pixels.
    pub(crate) fn move_rows(&self, now: &Pose, targets: Range<u32>, out: &mut RgbImage) -> u64 {
        let sources = self.source_rows(now, &targets);
        let moved = self.moved_view(now);
        let mut target = Target::new(self.picture.width(), targets);
        let [mut above, mut below] = std::array::from_fn(|_| SeenRow::with_length(target.width as usize));
        let mut pairs = Pairs::default();
        for row in sources.clone() {
            self.see_row(&moved, row, &target, &mut below);
            if row > sources.start {
                pairs.join(&above, &below);
                target.draw_cells(&moved, row - 1, [&above, &below], &pairs);
            } else {
                // The upper half of the first row belongs to no cell.
                target.draw_edge(&moved, row, &below);
            }
            std::mem::swap(&mut above, &mut below);
        }
        if let Some(last) = sources.last() {
            target.draw_edge(&moved, last, &above);
        }
        target.copy(self, out)
    }

    fn depth_row(&self, row: u32) -> &[f32] {
        let begin = self.rows.row(row) as usize * self.picture.width() as usize;
        &self.depths.depths[begin..begin + self.picture.width() as usize]
    }

    fn moved_view(&self, now: &Pose) -> MovedView<'_> {
        let to_new = now.orientation.conjugate();
        let turn = to_new * self.drawn_for.orientation;
        MovedView { view: self.view, rows: self.rows, turn, from: to_new * (self.drawn_for.position - now.position) }
    }

    fn see_row(&self, moved: &MovedView<'_>, row: u32, target: &Target, out: &mut SeenRow) {
        let begin = DVec2::new(0.5, f64::from(self.rows.row(row)) + 0.5);
        // Along a row the direction changes by a constant step.
        let ray = (moved.turn * direction(self.view, begin)).as_vec3();
        let step = (moved.turn * (DVec3::X / self.view.focal_px())).as_vec3();
        let from = moved.from.as_vec3();
        let (centre, focal) = (self.view.centre_px().as_vec2(), self.view.focal_px() as f32);
        let [first, distance] = [self.rows.first as f32, self.rows.distance as f32];
        let right = target.width as f32;
        let [top, bottom] = [target.rows.start as f32, target.rows.end as f32];
        let depths = self.depth_row(row);
        // Slices of one length let the compiler drop the checks of indices.
        let count = depths.len();
        let [xs, rows, new] = [&mut out.x[..count], &mut out.row[..count], &mut out.depth[..count]];
        let old = &mut out.old_depth[..count];
        let [columns, lines] = [&mut out.next_column[..count], &mut out.next_row[..count]];
        for i in 0..count {
            let [along, depth] = [i as i32 as f32, depths[i]];
            let x = (ray.x + step.x * along) * depth + from.x;
            let y = (ray.y + step.y * along) * depth + from.y;
            let z = -((ray.z + step.z * along) * depth + from.z);
            let is_ahead = z > NEAREST_M;
            let scale = focal / if is_ahead { z } else { NEAREST_M };
            xs[i] = centre.x + x * scale - 0.5;
            rows[i] = (centre.y - y * scale - 0.5 - first) / distance;
            new[i] = z;
            old[i] = if is_ahead { depth } else { f32::INFINITY };
            columns[i] = next(xs[i], 0.0, right);
            lines[i] = next(rows[i], top, bottom);
        }
    }

    /// Returns the rows of the picture whose pixels can appear in the rows `targets`, as seen from the pose `now`. Rows
    /// are counted within the field.
    ///
    /// The four corners of the target rows are projected into the picture, at the smallest and at the largest depth.
    /// All sources lie between these projections, because projections keep lines straight.
    fn source_rows(&self, now: &Pose, targets: &Range<u32>) -> Range<u32> {
        let all = 0..self.rows.count(self.picture.height());
        if *targets == all {
            return all;
        }
        // The depths are seen from the old pose. Depths that are seen from the new pose differ by the step and the turn
        // of the head. A turn by an angle changes the depth in a corner of the view by a factor of up to 1 + angle * (1
        // + tangent).
        let step = now.position.distance(self.drawn_for.position);
        let tangent = self.view.centre_px().length() / self.view.focal_px();
        let factor = 1.0 + now.orientation.angle_between(self.drawn_for.orientation) * (1.0 + tangent);
        let (near, far) = self.depths.range;
        let range = [((f64::from(near) - step) / factor).max(1e-3), (f64::from(far) + step) * factor];
        let width = f64::from(self.picture.width());
        let mut bounds = (f64::INFINITY, f64::NEG_INFINITY);
        for row in [f64::from(targets.start) - 1.0, f64::from(targets.end)] {
            let y = f64::from(self.rows.first) + row * f64::from(self.rows.distance) + 0.5;
            for x in [0.0, width] {
                let ahead = direction(self.view, DVec2::new(x, y));
                for depth in range {
                    let world = now.position + now.orientation * ahead * depth;
                    let Some(at) = self.view.project(self.drawn_for.view_of(world)) else { return all };
                    let row = self.rows.number_at(at.y);
                    bounds = (bounds.0.min(row), bounds.1.max(row));
                }
            }
        }
        let inside = |row: f64| row.clamp(0.0, f64::from(all.end)) as u32;
        inside(bounds.0.floor() - 1.0)..inside(bounds.1.ceil() + 2.0)
    }
}

/// The way from a place of the picture to a place of the screen.
#[derive(Clone, Copy, Debug)]
struct MovedView<'a> {
    view: &'a Hmd,
    rows: Rows,
    /// Rotation from the axes of the old pose to the axes of the new pose.
    turn: DQuat,
    /// Position of the old pose in the axes of the new pose.
    from: DVec3,
}

impl MovedView<'_> {
    /// Returns column and row on the screen of a column and row of the picture, at a depth. A place behind the eye
    /// returns itself.
    fn place(&self, at: [f32; 2], depth: f32) -> [f32; 2] {
        let from = self.middle(at);
        let point = self.turn * direction(self.view, from) * f64::from(depth) + self.from;
        self.column_and_row(self.view.project(point).unwrap_or(from))
    }

    /// Returns column and row in the picture of a column and row of the screen whose content has a depth in the picture.
    fn source(&self, at: [f32; 2], depth: f32) -> [f32; 2] {
        let back = self.turn.conjugate();
        let (ahead, from) = (back * direction(self.view, self.middle(at)), back * self.from);
        let point = ahead * ((from.z - f64::from(depth)) / ahead.z) - from;
        self.column_and_row(self.view.project(point).unwrap_or(DVec2::INFINITY))
    }

    fn middle(&self, [x, row]: [f32; 2]) -> DVec2 {
        let [first, distance] = [f64::from(self.rows.first), f64::from(self.rows.distance)];
        DVec2::new(f64::from(x) + 0.5, first + f64::from(row) * distance + 0.5)
    }

    fn column_and_row(&self, at: DVec2) -> [f32; 2] {
        let [first, distance] = [f64::from(self.rows.first), f64::from(self.rows.distance)];
        [(at.x - 0.5) as f32, ((at.y - 0.5 - first) / distance) as f32]
    }
}

/// Nearest content found so far for each pixel of the rows that are drawn.
struct Target {
    width: u32,
    rows: Range<u32>,
    depths: Vec<f32>,
    /// Source of the nearest content found so far, for each pixel: the source's column plus width times its row of the
    /// field.
    sources: Vec<u32>,
}

const NOTHING: u32 = u32::MAX;

/// Share of a pixel by which squares that touch may overlap, so that rounding leaves no gap between them.
const ROUNDING: f32 = 1e-3;

/// Least depth of a point in front of the eye, in metres.
const NEAREST_M: f32 = 1e-3;

impl Target {
    fn new(width: u32, rows: Range<u32>) -> Self {
        let size = width as usize * rows.len();
        Self { width, rows, depths: vec![f32::INFINITY; size], sources: vec![NOTHING; size] }
    }

    fn draw_cells(&mut self, moved: &MovedView<'_>, upper_row: u32, rows: [&SeenRow; 2], pairs: &Pairs) {
        let count = pairs.near.len();
        let first = upper_row * self.width;
        let [left, right] = [&pairs.columns[0][..count], &pairs.columns[1][..count]];
        let [top, bottom] = [&pairs.rows[0][..count], &pairs.rows[1][..count]];
        let [near, far] = [&pairs.near[..count], &pairs.far[..count]];
        for x in 1..count {
            // Corners behind the eye have no finite depth and belong to no surface.
            let farthest = far[x - 1].max(far[x]);
            let is_surface = farthest < f32::INFINITY && farthest <= near[x - 1].min(near[x]) * SAME_SURFACE;
            if !is_surface {
                // The surface ends between these pixels. So each pixel ends at the edge of its own square.
                for (seen, row) in rows.iter().zip([upper_row, upper_row + 1]) {
                    self.draw_pixel(moved, seen, row, x - 1);
                    self.draw_pixel(moved, seen, row, x);
                }
                continue;
            }
            // The cell is the box around its corners. This is exact enough, because views of one head a few
            // milliseconds apart roll by small angles only. The cell covers pixels from its left and upper sides up to
            // its right and lower sides, without the latter sides.
            let columns = left[x - 1].min(left[x])..right[x - 1].max(right[x]);
            for row in top[x - 1].min(top[x])..bottom[x - 1].max(bottom[x]) {
                for column in columns.clone() {
                    self.draw_covered([column, row], rows, x, first);
                }
            }
        }
        // Half a pixel at both ends of the rows belongs to no cell.
        for x in [0, count - 1] {
            self.draw_pixel(moved, rows[0], upper_row, x);
        }
    }

    /// Draws a pixel that a cell of the mesh covers. The pixel gets the content of the nearest corner of the cell, as
    /// in a device without filters.
    #[inline]
    fn draw_covered(&mut self, [column, row]: [i32; 2], [above, below]: [&SeenRow; 2], x: usize, first: u32) {
        let [at_column, at_row] = [column as f32, row as f32];
        let is_right = at_column - above.x[x - 1] > above.x[x] - at_column;
        let is_lower = at_row - above.row[x - 1] > below.row[x - 1] - at_row;
        let corner = if is_right { x } else { x - 1 };
        let (depth, source) = match is_lower {
            true => (below.depth[corner], first + self.width),
            false => (above.depth[corner], first),
        };
        self.put(column as u32, row as u32, depth, source + corner as u32);
    }

    fn draw_edge(&mut self, moved: &MovedView<'_>, row: u32, seen: &SeenRow) {
        for x in 0..seen.x.len() {
            self.draw_pixel(moved, seen, row, x);
        }
    }

    /// Draws a pixel of the picture, in column `x` and row `row`, at its new position on the screen. The pixel covers the
    /// pixels of the screen whose middles lie in its square, at its depth.
    fn draw_pixel(&mut self, moved: &MovedView<'_>, seen: &SeenRow, row: u32, x: usize) {
        let depth = seen.old_depth[x];
        if depth == f32::INFINITY {
            return;
        }
        let own = [x as f32, row as f32];
        let corners = [[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]];
        let corners = corners.map(|[right, down]| moved.place([own[0] + right, own[1] + down], depth));
        let within = |axis: usize, least: f32, greatest: f32| {
            let sides = corners.map(|corner| corner[axis]);
            let begin = sides.into_iter().fold(f32::INFINITY, f32::min);
            let end = sides.into_iter().fold(f32::NEG_INFINITY, f32::max);
            next(begin - ROUNDING, least, greatest)..next(end + ROUNDING, least, greatest)
        };
        let columns = within(0, 0.0, self.width as f32);
        for line in within(1, self.rows.start as f32, self.rows.end as f32) {
            for column in columns.clone() {
                let source = moved.source([column as f32, line as f32], depth);
                if source.iter().zip(own).all(|(at, own)| (at - own).abs() <= 0.5 + ROUNDING) {
                    self.put(column as u32, line as u32, seen.depth[x], row * self.width + x as u32);
                }
            }
        }
    }

    #[inline]
    fn put(&mut self, column: u32, row: u32, depth: f32, source: u32) {
        let at = (row - self.rows.start) as usize * self.width as usize + column as usize;
        if depth < self.depths[at] {
            self.depths[at] = depth;
            self.sources[at] = source;
        }
    }

    /// Copies the colour of each pixel's source to the moved picture. Returns the number of pixels that have no source.
    fn copy(&self, drawing: &Drawing<'_>, out: &mut RgbImage) -> u64 {
        let width = self.width as usize;
        let pixels = drawing.picture.as_raw();
        let out: &mut [u8] = out;
        let mut empty = 0;
        for (row, sources) in self.rows.clone().zip(self.sources.chunks_exact(width)) {
            let begin = drawing.rows.row(row) as usize * width * 3;
            for (pixel, source) in out[begin..begin + width * 3].chunks_exact_mut(3).zip(sources) {
                if *source == NOTHING {
                    pixel.fill(0);
                    empty += 1;
                    continue;
                }
                let [column, row] = [*source % self.width, *source / self.width];
                let at = (drawing.rows.row(row) as usize * width + column as usize) * 3;
                pixel.copy_from_slice(&pixels[at..at + 3]);
            }
        }
        empty
    }
}

/// Returns the smallest whole number that is at least `position`, clamped to the range from `least` to `greatest`.
/// Neither limit is negative.
///
/// The function `ceil` of the standard library is not used, because `ceil` is a function call on processors without SSE
/// 4.1.
#[inline]
fn next(position: f32, least: f32, greatest: f32) -> i32 {
    let inside = if position > least { position } else { least };
    let inside = if inside < greatest { inside } else { greatest };
    let before = inside as i32;
    before + i32::from((before as f32) < inside)
}

/// Changes a whole picture from the pose for which it was drawn to the pose `now`, by the depths of the picture's
/// pixels.
///
/// Each pixel of the result shows the nearest content that falls on this pixel. A pixel is black if its content lies
/// beyond the edge of the picture, or was hidden by nearer objects. Returns the result and the number of black pixels,
/// or `None` if the picture, the depths and the view differ in size.
pub fn reproject_with_depth(
    picture: &RgbImage,
    depths: &DepthPicture,
    view: &Hmd,
    drawn_for: &Pose,
    now: &Pose,
) -> Option<(RgbImage, u64)> {
    let size = DVec2::new(f64::from(picture.width()), f64::from(picture.height()));
    if size / 2.0 != view.centre_px() || picture.dimensions() != (depths.width, depths.height) {
        return None;
    }
    let mut out = RgbImage::new(picture.width(), picture.height());
    let drawing = Drawing { picture, depths, view, rows: Rows::ALL, drawn_for };
    let empty = drawing.move_rows(now, 0..picture.height(), &mut out);
    Some((out, empty))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproject::reproject;
    use image::Rgb;
    use pxpl5_run::Warp;
    use tracking::rotation;

    const SIZE: [u32; 2] = [640, 480];

    /// Returns a picture in which each pixel's colour contains the pixel's column and row.
    fn places() -> RgbImage {
        RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| Rgb([(x >> 8) as u8 + 1 + 8 * (y >> 8) as u8, x as u8, y as u8]))
    }

    fn place(pixel: &Rgb<u8>) -> Option<[u32; 2]> {
        let [high, x, y] = pixel.0.map(u32::from);
        (high > 0).then(|| [(high - 1) % 8 * 256 + x, (high - 1) / 8 * 256 + y])
    }

    fn moved(depth: impl Fn(u32, u32) -> f32, now: &Pose) -> (RgbImage, u64) {
        let depths = DepthPicture::from_fn(SIZE[0], SIZE[1], depth);
        reproject_with_depth(&places(), &depths, &Hmd::unc(), &Pose::IDENTITY, now).expect("the size of the view")
    }

    /// Tests a head that has moved 3 m ahead, past a wall at 2 m.
    #[test]
    fn a_wall_behind_the_eye_is_not_seen() {
        let now = Pose { position: DVec3::new(0.0, 0.0, -3.0), ..Pose::IDENTITY };
        assert_eq!(moved(|_, _| 2.0, &now).1, 640 * 480);
    }

    #[test]
    fn the_next_integer_is_at_or_after_a_position_within_the_limits() {
        for (position, expected) in
            [(3.0, 3), (3.001, 4), (-7.5, 2), (2.0, 2), (9.5, 9), (1e30, 9), (f32::NEG_INFINITY, 2), (f32::NAN, 2)]
        {
            assert_eq!(next(position, 2.0, 9.0), expected, "{position}");
        }
    }

    #[test]
    fn pictures_depths_and_views_must_have_equal_sizes() {
        let depths = DepthPicture::from_fn(640, 479, |_, _| 1.0);
        let [pose, view] = [Pose::IDENTITY, Pose::IDENTITY];
        assert!(reproject_with_depth(&places(), &depths, &Hmd::unc(), &pose, &view).is_none());
        let depths = DepthPicture::from_fn(320, 480, |_, _| 1.0);
        assert!(reproject_with_depth(&RgbImage::new(320, 480), &depths, &Hmd::unc(), &pose, &view).is_none());
    }

    #[test]
    fn without_movement_every_pixel_stays_at_any_depth() {
        let (picture, empty) = moved(|x, y| 0.5 + (x * 7 + y * 13) as f32 % 10.0, &Pose::IDENTITY);
        assert_eq!(empty, 0);
        assert_eq!(picture, places());
    }

    /// Tests that a rotation of the head moves a picture as the homography does, for any depth. Pixels may differ by
    /// one column or row.
    #[test]
    fn a_rotation_gives_the_picture_of_the_homography() {
        let now = Pose::facing(rotation::from_yaw_pitch_roll(0.05, -0.02, 0.01));
        let (expected, beyond) =
            reproject(&places(), &Hmd::unc(), Warp::Rotation, &Pose::IDENTITY, &now).expect("the size");
        for depth in [0.5, 2.0, 50.0] {
            let (found, empty) = moved(|_, _| depth, &now);
            assert!(empty.abs_diff(beyond) <= 2 * (640 + 480), "{depth}: {empty} {beyond}");
            let mut compared = 0;
            for (a, b) in found.pixels().zip(expected.pixels()) {
                let (Some(a), Some(b)) = (place(a), place(b)) else { continue };
                assert!(a[0].abs_diff(b[0]) <= 1 && a[1].abs_diff(b[1]) <= 1, "{depth}: {a:?} {b:?}");
                compared += 1;
            }
            assert!(compared > 270_000, "{compared}");
        }
    }

    /// Tests the pixels that a pure turn leaves empty, on a wall and on squares of different depths. They are those whose
    /// source lies beyond the edge of the picture, except a few that lie within a thousandth of a pixel of this edge. A
    /// column of the picture has 480 pixels.
    #[test]
    fn a_turn_leaves_the_same_pixels_empty_with_depth_as_with_rotation() {
        let squares = |x: u32, y: u32| if (x / 50 + y / 60).is_multiple_of(2) { 1.0 } else { 3.0 };
        for (yaw, pitch) in [(0.02, 0.0), (-0.05, 0.0), (0.2, 0.0), (0.0, 0.1), (0.0, -0.03), (0.1, 0.05)] {
            let now = Pose::facing(rotation::from_yaw_pitch_roll(yaw, pitch, 0.0));
            let turned = reproject(&places(), &Hmd::unc(), Warp::Rotation, &Pose::IDENTITY, &now);
            let (expected, _) = turned.expect("the size");
            for (found, _) in [moved(|_, _| 2.0, &now), moved(squares, &now)] {
                let both = found.pixels().zip(expected.pixels());
                let differ = both.filter(|(a, b)| place(a).is_some() != place(b).is_some()).count();
                assert!(differ < 100, "{yaw} {pitch}: {differ} pixels");
            }
        }
    }

    /// Tests a head that moves t metres to the right. A plane at the depth z moves f t / z pixels to the left, where f
    /// is the focal length in pixels. To the right of a near plane, f t (1 / near - 1 / far) columns stay empty. The
    /// near plane hid this part of the far plane.
    #[test]
    fn a_translation_moves_a_plane_by_f_t_over_z_pixels_and_leaves_a_gap_beside_a_near_plane() {
        let focal = Hmd::unc().focal_px();
        let (near, far) = (1.0_f32, 4.0_f32);
        for step in [0.004_f64, 0.01, 0.03] {
            let is_near = |x: u32, y: u32| (200..400).contains(&x) && (100..300).contains(&y);
            let (found, empty) = moved(|x, y| if is_near(x, y) { near } else { far }, &Pose::at(DVec3::X * step));
            let shift = |z: f32| focal * step / f64::from(z);
            for (x, y, pixel) in found.enumerate_pixels() {
                let Some(from) = place(pixel) else { continue };
                let expected = f64::from(x) + shift(if is_near(from[0], from[1]) { near } else { far });
                assert!((f64::from(from[0]) - expected).abs() <= 1.0 && from[1] == y, "{step}: {x} {y} {from:?}");
            }
            // The empty columns lie to the right of the near plane, and at the right edge of the picture.
            let expected = (shift(near) - shift(far)) * 200.0 + shift(far) * 480.0;
            let rounding = f64::from(200 + 480);
            assert!((empty as f64 - expected).abs() <= rounding, "{step}: {empty} for {expected}");
        }
    }

    /// Tests a picture that grows as the head moves ahead, and a floor that slants away from the eye. No pixel inside
    /// the picture may stay empty.
    #[test]
    fn surfaces_that_come_nearer_or_slant_have_no_empty_pixels_inside() {
        let floor = |_: u32, y: u32| 1.6 * Hmd::unc().focal_px() as f32 / (y as f32 + 60.0);
        for now in [Pose::at(DVec3::NEG_Z * 0.1), Pose::at(DVec3::new(0.0, 0.03, -0.05))] {
            let (found, _) = moved(floor, &now);
            let inner = found.enumerate_pixels().filter(|(x, y, _)| (40..600).contains(x) && (60..420).contains(y));
            assert_eq!(inner.filter(|(_, _, pixel)| place(pixel).is_none()).count(), 0, "{now:?}");
        }
        let (found, _) = moved(|_, _| 1.0, &Pose::at(DVec3::NEG_Z * 0.4));
        assert!(found.pixels().all(|pixel| place(pixel).is_some()), "magnified by 1.67");
    }

    /// Tests that strips with equal poses together give the same picture as one move of the whole picture.
    #[test]
    fn strips_with_equal_poses_give_the_same_picture_as_one_move_of_the_whole_picture() {
        let now = Pose {
            position: DVec3::new(0.02, -0.03, -0.04),
            orientation: rotation::from_yaw_pitch_roll(0.03, 0.04, -0.05),
        };
        let view = Hmd::unc();
        let picture = places();
        for rows in [Rows::ALL, Rows { first: 0, distance: 2 }, Rows { first: 1, distance: 2 }] {
            let depths =
                DepthPicture::of_field(SIZE, rows, |x, y| if (x / 50 + y / 60).is_multiple_of(2) { 1.0 } else { 3.0 });
            let drawing = Drawing { picture: &picture, depths: &depths, view: &view, rows, drawn_for: &Pose::IDENTITY };
            let count = rows.count(SIZE[1]);
            let mut whole = RgbImage::new(SIZE[0], SIZE[1]);
            let empty = drawing.move_rows(&now, 0..count, &mut whole);
            for step in [1, 64] {
                let mut parts = RgbImage::new(SIZE[0], SIZE[1]);
                let strips = (0..count).step_by(step as usize).map(|row| row..(row + step).min(count));
                let of_parts: u64 = strips.map(|strip| drawing.move_rows(&now, strip, &mut parts)).sum();
                assert_eq!(of_parts, empty, "{rows:?} {step}");
                assert!(parts == whole, "{rows:?} {step}");
            }
            // Rows of the other field stay black.
            let lit = |y: u32| rows.beside(y) == y;
            assert!(whole.enumerate_pixels().all(|(_, y, pixel)| lit(y) || pixel.0 == [0; 3]));
        }
    }
}
