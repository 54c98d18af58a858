//! Transformation of world vertices to the window of a slice, and conversion of points and lines to triangles.

use super::setup::{Corner, Place, along};
use crate::command::{CommandBuffer, Primitive, Shape};
use crate::slice_volume::SliceVolume;
use crate::view::SliceView;

const CAP_TRIANGLES: usize = 12;

#[derive(Clone, Debug)]
pub(super) struct SliceTransform {
    pub(super) rows: [[f64; 4]; 3],
    window: [[f64; 4]; 4],
    pub(super) volume: SliceVolume,
    magnification: f64,
}

impl SliceTransform {
    pub(super) fn new(view: &SliceView) -> Self {
        let rows = view.view.transpose();
        let rows = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| row.to_array());
        Self { rows, window: view.window, volume: view.volume, magnification: view.magnification }
    }

    #[inline(always)]
    pub(super) fn local(&self, world: [f64; 3]) -> [f64; 3] {
        [along(&self.rows[0], world), along(&self.rows[1], world), along(&self.rows[2], world)]
    }

    #[inline(always)]
    pub(super) fn corner(&self, world: [f64; 3], colour: [f64; 3]) -> Corner {
        self.corner_at(world, self.local(world), colour)
    }

    #[inline(always)]
    fn corner_at(&self, world: [f64; 3], local: [f64; 3], colour: [f64; 3]) -> Corner {
        let [p, q] = self.volume.attributes(world, local[0], local[2]);
        Corner { place: self.place(local), p, q, colour }
    }

    #[inline(always)]
    pub(super) fn place(&self, local: [f64; 3]) -> Place {
        let [x, y, z, w] = &self.window;
        Place { x: along(x, local), y: along(y, local), z: along(z, local), w: along(w, local) }
    }

    pub(super) fn triangles(
        &self,
        commands: &CommandBuffer,
        primitive: &Primitive,
        draw: &mut dyn FnMut(&[Corner; 3]),
    ) {
        let world = |i: u32| commands.positions[i as usize];
        let colour = |i: u32| commands.colours[i as usize];
        let [a, b, c] = primitive.vertices;
        match primitive.shape {
            Shape::Triangle => draw(&[a, b, c].map(|i| self.corner(world(i), colour(i)))),
            Shape::Point(size) => self.square(world(a), size / 2.0, colour(a), draw),
            Shape::Line(width) => {
                // A line needs the position at which it crosses the slice.
                let off = [a, b].map(|i| self.local(world(i))[2]);
                let ends = [a, b].map(|i| self.corner(world(i), colour(i)));
                line(&ends[0], &ends[1], crossing(off), width / 2.0 * self.magnification, draw);
            }
        }
    }

    /// Draws a square for a point. The square is parallel to the slice, at the same distance from the slice as the
    /// point.
    fn square(&self, world: [f64; 3], half: f64, colour: [f64; 3], draw: &mut dyn FnMut(&[Corner; 3])) {
        let local = self.local(world);
        let corner = |du: f64, dv: f64| {
            let moved = [local[0] + du, local[1] + dv, local[2]];
            let [right, up, _] = &self.rows;
            let at = [0, 1, 2].map(|i| world[i] + du * right[i] + dv * up[i]);
            self.corner_at(at, moved, colour)
        };
        let corners = [corner(-half, -half), corner(half, -half), corner(half, half), corner(-half, half)];
        draw(&[corners[0], corners[1], corners[2]]);
        draw(&[corners[0], corners[2], corners[3]]);
    }
}

/// Returns the position at which a line crosses the slice, as a fraction of the line's length. The arguments are the
/// distances of the line's two ends from the slice. Returns `None` if the line does not cross the slice.
fn crossing([from, to]: [f64; 2]) -> Option<f64> {
    (from * to < 0.0).then(|| from / (from - to))
}

/// Draws a line. The part between the near and far planes becomes a quad of the line's width. Each end of the line
/// between these planes gets a round cap. One more cap is drawn where the line crosses the slice, so that a line
/// perpendicular to the slice is visible.
fn line(from: &Corner, to: &Corner, crossing: Option<f64>, half: f64, draw: &mut dyn FnMut(&[Corner; 3])) {
    // Cut the line at the near and far planes.
    let Some([begin, end]) = between_planes(from, to) else { return };
    let first = from.mixed(to, begin);
    let last = from.mixed(to, end);
    let begin_place = &first.place;
    let end_place = &last.place;
    if begin_place.w <= 0.0 || end_place.w <= 0.0 {
        return;
    }
    // The direction of the line in the window gives the sides of the quad.
    let across = [
        end_place.x / end_place.w - begin_place.x / begin_place.w,
        end_place.y / end_place.w - begin_place.y / begin_place.w,
    ];
    let length = libm::hypot(across[0], across[1]);
    if length > 0.0 {
        let side = [-across[1] / length * half, across[0] / length * half];
        let back = [-side[0], -side[1]];
        let quad = [first.moved(side), last.moved(side), last.moved(back), first.moved(back)];
        draw(&[quad[0], quad[1], quad[2]]);
        draw(&[quad[0], quad[2], quad[3]]);
    }
    let ends = [(begin == 0.0).then_some(0.0), (end == 1.0).then_some(1.0)];
    for t in ends.into_iter().chain([crossing]).flatten() {
        cap(&from.mixed(to, t), half, draw);
    }
}

/// Returns the part of a line between the near and far planes, as a range of positions on the line. Position 0 is the
/// corner `from`, and 1 is the corner `to`. Returns `None` if no part lies between these planes.
fn between_planes(from: &Corner, to: &Corner) -> Option<[f64; 2]> {
    let mut range = [0.0f64, 1.0f64];
    let from = &from.place;
    let to = &to.place;
    for [a, b] in [[from.z, to.z], [from.w - from.z, to.w - to.z]] {
        // Distances from a plane are negative beyond the plane.
        if a < 0.0 && b < 0.0 {
            return None;
        }
        if a < 0.0 {
            range[0] = range[0].max(a / (a - b));
        }
        if b < 0.0 {
            range[1] = range[1].min(a / (a - b));
        }
    }
    (range[0] <= range[1]).then_some(range)
}

/// Draws a disc around a point of a line, as a round end. The whole disc has the depth of the point.
fn cap(centre: &Corner, radius: f64, draw: &mut dyn FnMut(&[Corner; 3])) {
    let rim: Vec<Corner> = (0..CAP_TRIANGLES)
        .map(|i| {
            let (sin, cos) = crate::angle::sin_cos_of_turn(i as i64, CAP_TRIANGLES as u32);
            centre.moved([radius * cos, radius * sin])
        })
        .collect();
    for i in 0..CAP_TRIANGLES {
        draw(&[*centre, rim[i], rim[(i + 1) % CAP_TRIANGLES]]);
    }
}
