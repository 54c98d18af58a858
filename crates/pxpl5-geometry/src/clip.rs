//! Clipping in homogeneous coordinates, before the division by w.
//!
//! Triangles are clipped only as far as the number formats require. The clip planes are the near plane (z = 0), the far
//! plane (z = w), and the four planes of a guard band. The guard band extends about 4,000 px beyond the picture. A
//! triangle outside the picture but inside the guard band needs no clipping.
//!
//! If two triangles share an edge, both triangles are cut at exactly the same point of this edge, bit for bit, and no
//! gap opens. For this, the cut is always computed from the same end of the edge, independent of the winding of the
//! triangle.
//!
//! Cuts are computed in double precision. Close to the eye, the small coordinates of a long edge are differences of
//! large numbers. In single precision, their error could reach several pixels, and the pieces of a triangle could
//! overlap.

use crate::newton;
use std::cmp::Ordering;

/// Largest absolute value of a clip coordinate. Triangles with larger coordinates, infinities or NaN are not drawn, so
/// that no computation overflows.
pub const MAX_CLIP: f32 = 1e30;

/// Smallest w by which coordinates are divided, so that no quotient is infinite.
pub(crate) const MIN_W: f32 = 1e-30;

/// Largest number of corners of a triangle after clipping against six planes.
const MAX_CORNERS: usize = 9;

/// A vertex in clip coordinates, with `N` values (such as colours) that vary linearly over the triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ClipVertex<const N: usize> {
    pub(crate) clip: [f32; 4],
    pub(crate) extra: [f32; N],
}

/// The volume within which triangles are not clipped: all points with |x| at most `self.x * w` and |y| at most `self.y
/// * w`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Guard {
    pub(crate) x: f32,
    pub(crate) y: f32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corner<const N: usize> {
    pub(crate) clip: [f64; 4],
    pub(crate) extra: [f64; N],
    /// True if clipping has made this corner. False if the corner is a vertex of the triangle.
    pub(crate) cut: bool,
}

impl<const N: usize> Corner<N> {
    fn at_vertex(vertex: &ClipVertex<N>) -> Self {
        Self { clip: vertex.clip.map(f64::from), extra: vertex.extra.map(f64::from), cut: false }
    }
}

/// A clipped triangle: a convex polygon of at most nine corners.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Polygon<const N: usize> {
    corners: [Corner<N>; MAX_CORNERS],
    len: usize,
}

impl<const N: usize> Polygon<N> {
    fn empty() -> Self {
        let nowhere = Corner { clip: [0.0; 4], extra: [0.0; N], cut: false };
        Self { corners: [nowhere; MAX_CORNERS], len: 0 }
    }

    pub(crate) fn corners(&self) -> &[Corner<N>] {
        &self.corners[..self.len]
    }

    /// Adds a corner, if the polygon has fewer than nine corners. Because of rounding, a polygon can be slightly
    /// concave and get more than nine corners. The additional corners are left out.
    fn push(&mut self, corner: Corner<N>) {
        if let Some(slot) = self.corners.get_mut(self.len) {
            *slot = corner;
            self.len += 1;
        }
    }
}

impl Guard {
    /// Returns a number that is negative if the point is outside plane 0 to 5: near, far, right, left, top or bottom.
    fn distance(self, plane: usize, [x, y, z, w]: [f64; 4]) -> f64 {
        let [right, top] = [self.x, self.y].map(f64::from);
        match plane {
            0 => z,
            1 => w - z,
            2 => right * w - x,
            3 => right * w + x,
            4 => top * w - y,
            _ => top * w + y,
        }
    }

    #[inline(always)]
    pub(crate) fn contains(self, [x, y, z, w]: [f32; 4]) -> bool {
        let across = (x.abs() <= self.x * w) & (y.abs() <= self.y * w);
        let depth = (z >= 0.0) & (z <= w);
        across & depth & (MIN_W..=MAX_CLIP).contains(&w)
    }

    pub(crate) fn clip<const N: usize>(self, triangle: &[ClipVertex<N>; 3]) -> Polygon<N> {
        let mut polygon = Polygon::empty();
        triangle.iter().for_each(|v| polygon.push(Corner::at_vertex(v)));
        // Most triangles cross few planes. Clip only against planes that have a corner outside.
        for plane in 0..6 {
            if polygon.corners().iter().any(|corner| self.distance(plane, corner.clip) < 0.0) {
                polygon = self.cut(plane, &polygon);
            }
        }
        polygon
    }

    fn cut<const N: usize>(self, plane: usize, polygon: &Polygon<N>) -> Polygon<N> {
        let corners = polygon.corners();
        let mut out = Polygon::empty();
        for (i, from) in corners.iter().enumerate() {
            let to = &corners[(i + 1) % corners.len()];
            let inside = self.distance(plane, from.clip) >= 0.0;
            if inside {
                out.push(*from);
            }
            if inside != (self.distance(plane, to.clip) >= 0.0) {
                out.push(self.crossing(plane, from, to));
            }
        }
        out
    }

    /// Returns the point where an edge crosses a plane. The ends are sorted first, so that both triangles at a shared
    /// edge get the same point.
    fn crossing<const N: usize>(self, plane: usize, one: &Corner<N>, other: &Corner<N>) -> Corner<N> {
        let (from, to) = match order(&one.clip, &other.clip) {
            Ordering::Greater => (other, one),
            _ => (one, other),
        };
        let near = self.distance(plane, from.clip);
        let far = self.distance(plane, to.clip);
        let t = near * newton::reciprocal_double(near - far);
        Corner {
            clip: std::array::from_fn(|i| interpolate(from.clip[i], to.clip[i], t)),
            extra: std::array::from_fn(|i| interpolate(from.extra[i], to.extra[i], t)),
            cut: true,
        }
    }
}

fn interpolate(from: f64, to: f64, t: f64) -> f64 {
    from + (to - from) * t
}

/// Compares two points by their clip coordinates, so that the ends of an edge have a fixed order.
fn order(a: &[f64; 4], b: &[f64; 4]) -> Ordering {
    a.iter().zip(b).map(|(a, b)| a.total_cmp(b)).find(|o| o.is_ne()).unwrap_or(Ordering::Equal)
}

/// Returns true if all three corners are outside the same plane of the visible volume. The triangle is then invisible.
pub(crate) fn all_outside(corners: &[[f32; 4]; 3]) -> bool {
    let beyond_a_side: [fn(&[f32; 4]) -> bool; 6] = [
        |[x, _, _, w]| x > w,
        |[x, _, _, w]| -x > *w,
        |[_, y, _, w]| y > w,
        |[_, y, _, w]| -y > *w,
        |[_, _, z, _]| *z < 0.0,
        |[_, _, z, w]| z > w,
    ];
    beyond_a_side.iter().any(|beyond| corners.iter().all(beyond))
}

/// Returns true if no coordinate exceeds [`MAX_CLIP`] in absolute value. Returns false for NaN.
pub(crate) fn representable(corners: &[[f32; 4]; 3]) -> bool {
    corners.iter().flatten().all(|v| v.abs() <= MAX_CLIP)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GUARD: Guard = Guard { x: 10.0, y: 10.0 };

    fn vertex(clip: [f32; 4], extra: f32) -> ClipVertex<1> {
        ClipVertex { clip, extra: [extra] }
    }

    fn corners_on_the_near_plane(polygon: &Polygon<1>) -> Vec<Corner<1>> {
        polygon.corners().iter().filter(|corner| corner.clip[2].abs() < 1e-6).copied().collect()
    }

    #[test]
    fn a_shared_edge_is_cut_at_the_same_point_from_both_sides() {
        let a = vertex([0.3, -0.7, -1.3, 0.9], 1.0);
        let b = vertex([-2.1, 0.2, 1.7, 3.1], 7.0);
        let c = vertex([5.0, 5.0, 1.0, 3.0], 0.0);
        let d = vertex([-5.0, -5.0, 1.0, 3.0], 0.0);
        let one = corners_on_the_near_plane(&GUARD.clip(&[a, b, c]));
        let other = corners_on_the_near_plane(&GUARD.clip(&[b, a, d]));
        assert!(one.iter().any(|v| other.contains(v)), "{one:?} {other:?}");
    }

    #[test]
    fn clipping_one_corner_at_the_near_plane_leaves_a_quadrilateral() {
        let polygon = GUARD.clip(&[
            vertex([0.0, 0.0, -1.0, 1.0], 0.0),
            vertex([1.0, 0.0, 1.0, 2.0], 2.0),
            vertex([0.0, 1.0, 1.0, 2.0], 4.0),
        ]);
        let extras: Vec<f64> = polygon.corners().iter().map(|v| v.extra[0]).collect();
        assert_eq!(extras, [1.0, 2.0, 4.0, 2.0]);
    }

    #[test]
    fn vertices_behind_the_eye_are_never_inside_the_guard_band() {
        for clip in [[0.0, 0.0, -1.0, -1.0], [0.0, 0.0, 0.5, -1.0], [f32::NAN, 0.0, 0.0, 1.0]] {
            assert!(!GUARD.contains(clip), "{clip:?}");
        }
    }
}
