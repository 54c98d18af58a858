//! Cutting of polygons into triangles. Triangles that share one corner cover a convex polygon. A concave polygon needs
//! ear cutting.

use earcut::Earcut;
use glam::{DVec2, DVec3};

/// Greatest number of corners of a concave polygon that is cut correctly. Derived: ear cutting needs about 136 bytes
/// per corner, so the memory stays near [`crate::config::MEMORY_FLOOR_BYTES`].
pub(super) const MAX_CORNERS: usize = 1 << 15;

/// Two successive edges count as one line if the sine of the angle between them is at most this number. Assumed, 1e-7
/// to 1e-4. In single precision, points of a straight line deviate by up to 6e-8.
const STRAIGHT: f64 = 1e-6;

pub(super) enum Cut {
    /// The polygon is convex. The triangles that all share its first corner cover exactly the polygon.
    Fan,
    /// The polygon is concave. These triangles cover exactly the polygon and have the same orientation.
    Ears(Vec<[u32; 3]>),
    /// The polygon is concave and has more than [`MAX_CORNERS`] corners, so it is not cut correctly.
    TooLong,
}

/// Cuts a polygon into triangles that do not extend beyond the polygon. `fan` has triangles that all share the first
/// corner, and `place` returns the position of a corner.
pub(super) fn cut(fan: &[[u32; 3]], place: impl Fn(u32) -> DVec3) -> Cut {
    // A triangle is always convex.
    if fan.len() < 2 {
        return Cut::Fan;
    }
    let Some(flat) = Projection::of(fan, &place) else { return Cut::Fan };
    let flat = |corner| flat.point(place(corner));
    if is_convex(fan, flat) {
        return Cut::Fan;
    }
    // Successive corners at one position add no area. Leaving them out makes the search shorter.
    let mut ring: Vec<u32> = Vec::new();
    for corner in corners(fan) {
        if ring.last().is_none_or(|&before| flat(before) != flat(corner)) {
            ring.push(corner);
        }
        if ring.len() > MAX_CORNERS {
            return Cut::TooLong;
        }
    }
    ears(&ring, flat)
}

/// Returns the corners of a polygon, given as triangles that all share its first corner.
fn corners(fan: &[[u32; 3]]) -> impl Iterator<Item = u32> + Clone {
    let first = fan.iter().take(1).flat_map(|triangle| [triangle[0], triangle[1]]);
    first.chain(fan.iter().map(|triangle| triangle[2]))
}

fn ears(ring: &[u32], flat: impl Fn(u32) -> DVec2) -> Cut {
    let places: Vec<[f64; 2]> = ring.iter().map(|&corner| flat(corner).to_array()).collect();
    let mut indices: Vec<u32> = Vec::new();
    Earcut::new().earcut_slice(&places, &[], &mut indices);
    // The polygon is anticlockwise in the projection, so its triangles must also be anticlockwise.
    let turned = |[a, b, c]: [u32; 3]| {
        let (a2, b2, c2) = (flat(a), flat(b), flat(c));
        if (b2 - a2).perp_dot(c2 - a2) < 0.0 { [a, c, b] } else { [a, b, c] }
    };
    let triangles = indices.chunks_exact(3);
    let triangles: Vec<_> = triangles.map(|t| turned([t[0], t[1], t[2]].map(|index| ring[index as usize]))).collect();
    if triangles.is_empty() { Cut::Fan } else { Cut::Ears(triangles) }
}

/// Returns true if the polygon is convex: no corner turns clockwise, and no edge runs back over the previous edge.
fn is_convex(fan: &[[u32; 3]], flat: impl Fn(u32) -> DVec2) -> bool {
    // The first two corners are repeated at the end, so that the turns at the last and the first corner are tested too.
    let again = corners(fan).take(2);
    let mut points = corners(fan).chain(again).map(flat);
    let Some(mut before) = points.next() else { return true };
    let mut edge = DVec2::ZERO;
    for point in points {
        let next = (point - before).normalize_or_zero();
        if next == DVec2::ZERO {
            continue;
        }
        let turn = edge.perp_dot(next);
        if turn < -STRAIGHT || turn < STRAIGHT && edge.dot(next) < 0.0 {
            return false;
        }
        before = point;
        edge = next;
    }
    true
}

/// A projection of a polygon along one of the three coordinate axes: the axis with the smallest angle to the polygon's
/// normal. In the projection, the corners run anticlockwise.
struct Projection {
    origin: DVec3,
    /// Factor that brings the farthest corner near a distance of 1. Otherwise squares of very small or large numbers
    /// would leave the range of f64.
    scale: f64,
    /// Indices of the two coordinate axes of the projection's plane.
    axes: [usize; 2],
}

impl Projection {
    fn of(fan: &[[u32; 3]], place: impl Fn(u32) -> DVec3) -> Option<Self> {
        let (origin, scale) = near_one(fan, &place)?;
        let area = area(fan, |corner| (place(corner) - origin) * scale);
        if area.abs().max_element() < 1e-12 {
            return None;
        }
        let axis = (0..3).max_by(|&a, &b| area[a].abs().total_cmp(&area[b].abs()))?;
        let axes = [(axis + 1) % 3, (axis + 2) % 3];
        Some(Self { origin, scale, axes: if area[axis] > 0.0 { axes } else { [axes[1], axes[0]] } })
    }

    fn point(&self, place: DVec3) -> DVec2 {
        let v = (place - self.origin) * self.scale;
        DVec2::new(v[self.axes[0]], v[self.axes[1]])
    }
}

/// Returns the power of two by which a length must be multiplied to be near 1, or `None` for the length 0.
fn scale_to_one(length: f64) -> Option<f64> {
    let (_, exponent) = libm::frexp(length);
    // The smallest numbers would need a power of two above the range of f64. The largest f64 power brings them near
    // enough to 1.
    (length > 0.0).then(|| libm::ldexp(1.0, -exponent.max(-1022)))
}

/// Returns the polygon's first corner and a scale factor, or `None` if all corners coincide. After multiplication by
/// the factor, the largest coordinate difference from the first corner is near 1.
fn near_one(fan: &[[u32; 3]], place: impl Fn(u32) -> DVec3) -> Option<(DVec3, f64)> {
    let origin = place(fan.first()?[0]);
    let farthest = corners(fan).map(|corner| (place(corner) - origin).abs().max_element()).fold(0.0, f64::max);
    Some((origin, scale_to_one(farthest)?))
}

/// Returns the area vector of a polygon. The vector has the direction of the normal, and twice the polygon's area as
/// its length. `from_first` returns the position of a corner relative to the first corner.
fn area(fan: &[[u32; 3]], from_first: impl Fn(u32) -> DVec3) -> DVec3 {
    fan.iter().map(|&[_, b, c]| from_first(b).cross(from_first(c))).sum()
}

/// Returns a vector of any length along the normal of a polygon, or zero for a polygon without area.
pub(super) fn normal(fan: &[[u32; 3]], place: impl Fn(u32) -> DVec3) -> DVec3 {
    match near_one(fan, &place) {
        Some((origin, scale)) => area(fan, |corner| (place(corner) - origin) * scale),
        None => DVec3::ZERO,
    }
}

/// Returns true if a triangle is not too flat: its height is more than `least` times its longest edge.
pub(super) fn has_area([a, b, c]: [DVec3; 3], least: f64) -> bool {
    let edges = [b - a, c - a];
    let longest = [edges[0], edges[1], c - b].map(|edge| edge.abs().max_element()).into_iter().fold(0.0, f64::max);
    scale_to_one(longest).is_some_and(|scale| (edges[0] * scale).cross(edges[1] * scale).length() > least)
}
