//! Set-up of several triangles together, with one triangle in each lane of a vector register.
//!
//! Every lane has the same bits as the computation for one triangle ([`crate::ScreenTriangle`], [`crate::plane`]).
//! Products of two coordinate differences need up to 34 bits, and double precision represents them exactly. The loops
//! are plain Rust, compiled once for each kind of vector unit (see [`mod@multiversion`]).

use crate::newton;
use crate::outline::SUBPIXELS;
use crate::plane::{self, MAX_SLOPE};
use crate::screen;
use crate::vertex::SurfaceVertex;
use crate::{GouraudTriangle, PhongTriangle, SetupStats, Transform, Viewport};
use multiversion::multiversion;
pub use pxpl5_wire::LANES;
use pxpl5_wire::{Linear, LinearLanes, TriangleBatch, format};

pub(crate) type EachLane<T> = [T; LANES];

/// Up to [`LANES`] triangles that need no clipping, with colours or normals at their corners.
#[derive(Clone, Debug)]
pub struct TriangleLanes<'a> {
    len: usize,
    /// Vertices, indexed by corner and then by triangle.
    corners: [EachLane<&'a SurfaceVertex>; 3],
}

/// A vertex for unused lanes. Triangles of this vertex have no area.
static NOWHERE: SurfaceVertex = SurfaceVertex::NOWHERE;

impl Default for TriangleLanes<'_> {
    fn default() -> Self {
        Self { len: 0, corners: [[&NOWHERE; LANES]; 3] }
    }
}

impl<'a> TriangleLanes<'a> {
    pub const fn len(&self) -> usize {
        self.len
    }

    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    pub const fn clear(&mut self) {
        self.len = 0;
    }

    /// Adds a triangle and returns true. Returns false and adds nothing if the triangle needs clipping.
    ///
    /// All corners must come from the same view.
    ///
    /// # Panics
    /// Panics if [`LANES`] triangles have already been added.
    #[inline(always)]
    pub fn push(&mut self, [a, b, c]: [&'a SurfaceVertex; 3]) -> bool {
        let inside = a.screen.is_inside() & b.screen.is_inside() & c.screen.is_inside();
        if inside {
            self.corners[0][self.len] = a;
            self.corners[1][self.len] = b;
            self.corners[2][self.len] = c;
            self.len += 1;
        }
        inside
    }

    /// Adds a triangle without area, which covers no pixel.
    ///
    /// # Panics
    /// Panics if [`LANES`] triangles have already been added.
    pub fn push_nothing(&mut self) {
        for corner in &mut self.corners {
            corner[self.len] = &NOWHERE;
        }
        self.len += 1;
    }
}

/// Values at the corners of several triangles, indexed by corner and then by triangle.
struct CornerValues {
    x: [EachLane<i32>; 3],
    y: [EachLane<i32>; 3],
    z: [EachLane<f64>; 3],
    facing: [EachLane<f32>; 3],
    /// Components of the colours or normals, indexed by component, corner and triangle.
    surface: [[EachLane<f32>; 3]; 3],
}

impl CornerValues {
    #[inline(always)]
    fn of(triangles: &TriangleLanes<'_>) -> Self {
        let integers = [[0; LANES]; 3];
        let reals = [[0.0; LANES]; 3];
        let mut all = Self { x: integers, y: integers, z: [[0.0; LANES]; 3], facing: reals, surface: [reals; 3] };
        // Gather the corners from the vertices into lanes.
        for corner in 0..3 {
            for i in 0..LANES {
                let vertex = triangles.corners[corner][i];
                all.x[corner][i] = vertex.screen.0.x;
                all.y[corner][i] = vertex.screen.0.y;
                all.z[corner][i] = f64::from(vertex.screen.0.z);
                all.facing[corner][i] = vertex.facing;
                all.surface[0][corner][i] = vertex.values[0];
                all.surface[1][corner][i] = vertex.values[1];
                all.surface[2][corner][i] = vertex.values[2];
            }
        }
        all
    }
}

/// Replaces each expression whose element of `there` is 0 by `constant`. In all other elements of `there`, all bits
/// must be 1.
#[inline(always)]
fn or_constant(mut all: LinearLanes, constant: i32, there: &EachLane<i32>) -> LinearLanes {
    for (i, there) in there.iter().enumerate() {
        all.a[i] &= there;
        all.b[i] &= there;
        all.c[i] = all.c[i] & there | constant & !there;
    }
    all
}

#[derive(Clone, Debug)]
struct Expressions {
    edges: [LinearLanes; 3],
    /// Planes of depth and of three components of colour or normal, in this order.
    planes: [LinearLanes; 4],
    /// Number of planes of each triangle that were too steep for the format and were made constant.
    flattened: EachLane<u8>,
}

/// Expressions of one triangle: three edges, depth, and three components of colour or normal.
type OneTriangle = ([Linear; 3], Linear, [Linear; 3]);

impl Expressions {
    #[inline(always)]
    const fn get(&self, lane: usize) -> OneTriangle {
        let [e, f, g] = &self.edges;
        let [z, p, q, r] = &self.planes;
        let edges = [e.get(lane), f.get(lane), g.get(lane)];
        (edges, z.get(lane), [p.get(lane), q.get(lane), r.get(lane)])
    }
}

/// Expressions of up to [`LANES`] Gouraud triangles. The edge expressions of a triangle without area exclude every
/// pixel.
#[derive(Clone, Debug)]
pub struct GouraudLanes(Expressions);

impl GouraudLanes {
    /// Returns the first `len` triangles in the form that renderers evaluate.
    pub const fn batch(&self, len: usize) -> TriangleBatch<'_> {
        TriangleBatch { len, edges: &self.0.edges, planes: &self.0.planes, colours: None }
    }

    /// Returns the expressions of triangle `i`, in the order of [`TriangleLanes::push`].
    ///
    /// # Panics
    /// Panics if `i` is not below [`LANES`].
    #[inline(always)]
    pub const fn get(&self, i: usize) -> GouraudTriangle {
        let (edges, z, rgb) = self.0.get(i);
        GouraudTriangle { edges, z, rgb }
    }
}

/// Expressions of up to [`LANES`] Phong triangles. The edge expressions of a triangle without area exclude every pixel.
#[derive(Clone, Debug)]
pub struct PhongLanes(Expressions);

impl PhongLanes {
    /// Returns the first `len` triangles in the form that renderers evaluate. `colours` are 0x00RRGGBB.
    pub const fn batch(&self, len: usize, colours: [u32; LANES]) -> TriangleBatch<'_> {
        TriangleBatch { len, edges: &self.0.edges, planes: &self.0.planes, colours: Some(colours) }
    }

    /// Returns the expressions of triangle `i`. `colour` is the colour of the whole triangle.
    ///
    /// # Panics
    /// Panics if `i` is not below [`LANES`].
    #[inline(always)]
    pub const fn get(&self, i: usize, colour: [u8; 3]) -> PhongTriangle {
        let (edges, z, normal) = self.0.get(i);
        PhongTriangle { edges, z, normal, colour }
    }
}

impl Transform {
    /// Computes edges and planes like [`Self::gouraud`], but for several triangles and without touched regions.
    pub fn gouraud_lanes(&self, triangles: &TriangleLanes<'_>, stats: &mut SetupStats) -> GouraudLanes {
        GouraudLanes(self.set_up_lanes(triangles, 0.0, stats))
    }

    /// Computes edges and planes like [`Self::phong`], but for several triangles and without touched regions.
    pub fn phong_lanes(&self, triangles: &TriangleLanes<'_>, stats: &mut SetupStats) -> PhongLanes {
        PhongLanes(self.set_up_lanes(triangles, screen::NORMAL_HALF, stats))
    }

    fn set_up_lanes(&self, triangles: &TriangleLanes<'_>, half: f32, stats: &mut SetupStats) -> Expressions {
        let out = set_up(triangles, half, PictureRows::of_picture(&self.viewport));
        if out.flattened != [0; LANES] {
            stats.flattened_planes += out.flattened[..triangles.len].iter().map(|n| u64::from(*n)).sum::<u64>();
        }
        out
    }
}

const fn last_subpixel(pixels: u32) -> i32 {
    pixels as i32 * SUBPIXELS - 1
}

#[derive(Clone, Copy)]
struct PictureRows {
    line_step: i32,
    first_line: i32,
    /// The last subpixel of the video frame along x and along y.
    last: [i32; 2],
}

impl PictureRows {
    fn of_picture(viewport: &Viewport) -> Self {
        Self {
            line_step: viewport.line_step() as i32,
            first_line: viewport.first_line() as i32,
            last: [last_subpixel(viewport.grid().width), last_subpixel(viewport.frame_lines())],
        }
    }

    /// Converts expressions over the lines of a video frame to expressions over the rows of a picture, like
    /// [`screen::for_rows`].
    #[inline(always)]
    fn restate(&self, frame: LinearLanes) -> LinearLanes {
        let mut all = frame;
        for i in 0..LANES {
            all.c[i] = frame.c[i].wrapping_add(frame.b[i].wrapping_mul(self.first_line));
        }
        for i in 0..LANES {
            all.b[i] = frame.b[i].wrapping_mul(self.line_step);
        }
        all
    }
}

#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn set_up(triangles: &TriangleLanes<'_>, half: f32, rows: PictureRows) -> Expressions {
    let corners = CornerValues::of(triangles);
    let planes = LanePlanes::through_corners(&corners, rows);
    let away = away(&corners.facing);
    let mut flattened = [0; LANES];
    // A triangle without area gets edges of constant -1, which exclude every pixel.
    let there = with_area(&planes.twice_area);
    let swapped = counterclockwise(&planes.twice_area);
    let x = clockwise(&corners.x, &swapped);
    let y = clockwise(&corners.y, &swapped);
    let edges = [
        or_constant(rows.restate(edge([&x[0], &x[1]], [&y[0], &y[1]])), -1, &there),
        or_constant(rows.restate(edge([&x[1], &x[2]], [&y[1], &y[2]])), -1, &there),
        or_constant(rows.restate(edge([&x[2], &x[0]], [&y[2], &y[0]])), -1, &there),
    ];
    let [p, q, r] = &corners.surface;
    let planes_through = [
        or_constant(rows.restate(planes.through(&corners.z, &mut flattened)), 0, &there),
        or_constant(rows.restate(planes.through(&component(p, &away, half), &mut flattened)), 0, &there),
        or_constant(rows.restate(planes.through(&component(q, &away, half), &mut flattened)), 0, &there),
        or_constant(rows.restate(planes.through(&component(r, &away, half), &mut flattened)), 0, &there),
    ];
    for i in 0..LANES {
        flattened[i] &= there[i] as u8;
    }
    Expressions { edges, planes: planes_through, flattened }
}

/// Returns true for each triangle whose normals face away from the eye on average, as in [`crate::light::turned`].
#[inline(always)]
fn away([p, q, r]: &[EachLane<f32>; 3]) -> EachLane<bool> {
    let mut away = [false; LANES];
    for i in 0..LANES {
        away[i] = (p[i] + q[i]) + r[i] < 0.0;
    }
    away
}

/// Returns one component of the normals at the corners of all triangles, plus `half` for rounding. The normals of
/// triangles that face away from the eye are reversed.
#[inline(always)]
fn component([p, q, r]: &[EachLane<f32>; 3], away: &EachLane<bool>, half: f32) -> [EachLane<f64>; 3] {
    [values(p, away, half), values(q, away, half), values(r, away, half)]
}

#[inline(always)]
fn values(corner: &EachLane<f32>, away: &EachLane<bool>, half: f32) -> EachLane<f64> {
    let mut out = [0.0; LANES];
    for i in 0..LANES {
        let value = if away[i] { -corner[i] } else { corner[i] };
        out[i] = f64::from(value + half);
    }
    out
}

/// Returns all ones for each triangle with an area, otherwise 0.
#[inline(always)]
fn with_area(twice_area: &EachLane<f64>) -> EachLane<i32> {
    let mut out = [0; LANES];
    for i in 0..LANES {
        out[i] = -i32::from(twice_area[i] != 0.0);
    }
    out
}

#[inline(always)]
fn counterclockwise(twice_area: &EachLane<f64>) -> EachLane<i32> {
    let mut out = [0; LANES];
    for i in 0..LANES {
        out[i] = -i32::from(twice_area[i] < 0.0);
    }
    out
}

/// Returns the corners in clockwise order. Where `swapped` is all ones, two corners are exchanged.
///
/// The exchange uses masks, which are faster than a conditional expression.
#[inline(always)]
fn clockwise([p, q, r]: &[EachLane<i32>; 3], swapped: &EachLane<i32>) -> [EachLane<i32>; 3] {
    let mut second = [0; LANES];
    let mut third = [0; LANES];
    for i in 0..LANES {
        let change = (q[i] ^ r[i]) & swapped[i];
        second[i] = q[i] ^ change;
        third[i] = r[i] ^ change;
    }
    [*p, second, third]
}

#[inline(always)]
fn edge([x, to_x]: [&EachLane<i32>; 2], [y, to_y]: [&EachLane<i32>; 2]) -> LinearLanes {
    let mut out = LinearLanes::default();
    for i in 0..LANES {
        let dx = to_x[i] - x[i];
        let dy = to_y[i] - y[i];
        let top_left = (dy < 0) | ((dy == 0) & (dx > 0));
        let across = f64::from(dx) * f64::from(SUBPIXELS / 2 - y[i]);
        let down = f64::from(dy) * f64::from(SUBPIXELS / 2 - x[i]);
        let k = (across - down) - if top_left { 0.0 } else { 1.0 };
        out.a[i] = -dy;
        out.b[i] = dx;
        out.c[i] = sixteenth(k);
    }
    out
}

/// Divides an integer below 2^34 by 16 and rounds down. To round down, the function subtracts 15/32 from the quotient
/// and rounds to the nearest integer.
#[inline(always)]
fn sixteenth(k: f64) -> i32 {
    const _: () = assert!(1 << format::SUBPIXEL_BITS == 16);
    plane::rounded(k * (1.0 / 16.0) - 15.0 / 32.0)
}

/// For each triangle, the values that all planes of the triangle share (see [`plane::Planes`]).
struct LanePlanes {
    twice_area: EachLane<f64>,
    x: [EachLane<f64>; 2],
    y: [EachLane<f64>; 2],
    per_pixel: EachLane<f64>,
    to_reference: [EachLane<f64>; 2],
    reference: [EachLane<i32>; 2],
}

impl LanePlanes {
    /// Computes the values that all planes of a triangle share. The result does not depend on the winding, which
    /// changes the signs of both the cross products and the area.
    #[inline(always)]
    fn through_corners(corners: &CornerValues, rows: PictureRows) -> Self {
        let [p, q, r] = &corners.x;
        let [s, t, u] = &corners.y;
        let x = [side(p, q), side(p, r)];
        let y = [side(s, t), side(s, u)];
        let mut twice_area = [0.0; LANES];
        let mut per_pixel = [0.0; LANES];
        for i in 0..LANES {
            twice_area[i] = x[0][i] * y[1][i] - y[0][i] * x[1][i];
            per_pixel[i] = 16.0 * newton::reciprocal_double(twice_area[i]);
        }
        let reference = [middle(&corners.x, rows.last[0]), middle(&corners.y, rows.last[1])];
        let to_reference = [pixels(&corners.x[0], &reference[0]), pixels(&corners.y[0], &reference[1])];
        Self { twice_area, x, y, per_pixel, to_reference, reference }
    }

    /// Returns the plane of each triangle through the values at the triangle's corners. Planes that are steeper than
    /// `MAX_SLOPE` become constant and are counted in `flattened`.
    #[inline(always)]
    fn through(&self, [p, q, r]: &[EachLane<f64>; 3], flattened: &mut EachLane<u8>) -> LinearLanes {
        let mut out = LinearLanes::default();
        let mut flat = [false; LANES];
        for i in 0..LANES {
            // Compute slopes from cross products, then the value at the reference pixel.
            let d1 = q[i] - p[i];
            let d2 = r[i] - p[i];
            let slope_x = (d1 * self.y[1][i] - d2 * self.y[0][i]) * self.per_pixel[i];
            let slope_y = (d2 * self.x[0][i] - d1 * self.x[1][i]) * self.per_pixel[i];
            flat[i] = (slope_x.abs() > MAX_SLOPE) | (slope_y.abs() > MAX_SLOPE);
            let there = (p[i] + slope_x * self.to_reference[0][i]) + slope_y * self.to_reference[1][i];
            let a = plane::rounded(slope_x);
            let b = plane::rounded(slope_y);
            // Convert to the value at pixel (0, 0), modulo 2^32.
            let back = a.wrapping_mul(self.reference[0][i]).wrapping_add(b.wrapping_mul(self.reference[1][i]));
            out.a[i] = a;
            out.b[i] = b;
            out.c[i] = plane::rounded(there).wrapping_sub(back);
        }
        // Steep planes are rare, so the code replaces them after the loop.
        if flat.iter().fold(false, |any, flat| any | flat) {
            flatten([p, q, r], &flat, &mut out, flattened);
        }
        out
    }
}

#[cold]
fn flatten(v: [&EachLane<f64>; 3], flat: &EachLane<bool>, out: &mut LinearLanes, flattened: &mut EachLane<u8>) {
    for i in (0..LANES).filter(|i| flat[*i]) {
        let Linear { a, b, c } = plane::flat(v.map(|v| v[i]));
        out.a[i] = a;
        out.b[i] = b;
        out.c[i] = c;
        flattened[i] += 1;
    }
}

#[inline(always)]
fn side(from: &EachLane<i32>, to: &EachLane<i32>) -> EachLane<f64> {
    let mut out = [0.0; LANES];
    for i in 0..LANES {
        out[i] = f64::from(to[i] - from[i]);
    }
    out
}

/// Returns the pixel in the middle of the triangle's visible part along one axis.
#[inline(always)]
fn middle([p, q, r]: &[EachLane<i32>; 3], last: i32) -> EachLane<i32> {
    let mut out = [0; LANES];
    for i in 0..LANES {
        let low = p[i].min(q[i]).min(r[i]).clamp(0, last);
        let high = p[i].max(q[i]).max(r[i]).clamp(0, last);
        out[i] = (low + high) / (2 * SUBPIXELS);
    }
    out
}

#[inline(always)]
fn pixels(from: &EachLane<i32>, pixel: &EachLane<i32>) -> EachLane<f64> {
    let mut out = [0.0; LANES];
    for i in 0..LANES {
        out[i] = f64::from(SUBPIXELS * pixel[i] + SUBPIXELS / 2 - from[i]) * (1.0 / f64::from(SUBPIXELS));
    }
    out
}
