//! Connected rasterization, which is **beyond the SpatialGL paper**. This method draws adjacent pixels along the curve
//! in which a triangle intersects the plane of the slice.

use super::SliceWork;
use super::assemble::SliceTransform;
use super::setup::Place;
use crate::command::Shape;
use crate::curve::plane_curve;
use crate::image::SliceImage;

#[derive(Clone, Copy)]
struct CurvePoint {
    at: [f64; 2],
    colour: [f64; 3],
}

/// Draws the pixels that sampling missed along the curve in which each triangle intersects the slice. Returns the
/// number of pixels added.
pub(super) fn draw(work: SliceWork<'_>, transform: &SliceTransform, image: &mut SliceImage) -> u64 {
    let mut added = 0;
    for primitive in work.bin.primitives().iter().map(|i| &work.commands.primitives[*i as usize]) {
        if primitive.shape != Shape::Triangle {
            continue;
        }
        let local = primitive.vertices.map(|i| transform.local(work.commands.positions[i as usize]));
        let colours = primitive.vertices.map(|i| work.commands.colours[i as usize]);
        // Only triangles that cross the slice have a curve.
        let Some((ends, weights)) = plane_curve(local) else { continue };
        let point = |i: usize| {
            let Place { x, y, w, .. } = transform.place(ends[i]);
            let colour = [0, 1, 2].map(|c| (0..3).map(|corner| weights[i][corner] * colours[corner][c]).sum());
            CurvePoint { at: [x / w, y / w], colour }
        };
        added += line(point(0), point(1), image);
    }
    added
}

/// Draws a line of pixels between two points, except pixels on which a fragment was drawn before. There is one pixel
/// for each step along the axis (x or y) on which the two points are farther apart. Returns the number of pixels drawn.
fn line(from: CurvePoint, to: CurvePoint, image: &mut SliceImage) -> u64 {
    let Some([begin, end]) = inside(from.at, to.at, image.size()) else { return 0 };
    let mix = |a: f64, b: f64, t: f64| a * (1.0 - t) + b * t;
    let span = |axis: usize| ((to.at[axis] - from.at[axis]) * (end - begin)).abs();
    let steps = span(0).max(span(1)).ceil().max(1.0);
    let mut added = 0;
    for i in 0..=steps as u32 {
        // Positions and colours are interpolated linearly along the line.
        let t = mix(begin, end, f64::from(i) / steps);
        let x = mix(from.at[0], to.at[0], t).floor();
        let y = mix(from.at[1], to.at[1], t).floor();
        let colour = [0, 1, 2].map(|c| (mix(from.colour[c], to.colour[c], t) + 0.5) as u8);
        added += u64::from(image.fill_gap(x, y, colour));
    }
    added
}

/// Returns the part of a line that lies inside the image, as a range of positions on the line: 0 is the point `from`,
/// and 1 is the point `to`.
fn inside(from: [f64; 2], to: [f64; 2], size: [u32; 2]) -> Option<[f64; 2]> {
    let mut range = [0.0f64, 1.0f64];
    for axis in 0..2 {
        let step = to[axis] - from[axis];
        // Distances to both borders of the image along this axis.
        let limits = [-from[axis], f64::from(size[axis]) - from[axis]];
        if step == 0.0 {
            if limits[0] > 0.0 || limits[1] < 0.0 {
                return None;
            }
            continue;
        }
        let crossings = limits.map(|limit| limit / step);
        range[0] = range[0].max(crossings[0].min(crossings[1]));
        range[1] = range[1].min(crossings[0].max(crossings[1]));
    }
    (range[0] <= range[1]).then_some(range)
}
