//! Fast drawing of triangles of at most four columns. In a dense scene, most triangles have at most four columns.
//!
//! A vector covers four columns of several rows, so one vector is sufficient for nearly every slim triangle. For all
//! triangles of a batch together, the code computes the values of the edge expressions at each triangle's first pixel.

use super::bounds::{Boxes, Edges, PerTriangle};
use super::painter::{PaintTriangle, TrianglePainter, Walk};
use super::shape::{QuadRows, Shape};

use crate::simd::{FOUR, SimdVector};
use pxpl5_wire::{LANES, LinearLanes, TriangleBatch};

const WIDTH: i32 = 128;

pub(super) struct SlimTriangles {
    /// First column of each triangle's vectors. It is left of the triangle if the vectors would otherwise end outside
    /// the array.
    x: PerTriangle<i32>,
    y: PerTriangle<i32>,
    /// Number of vectors, one below the other, that cover each triangle. It is 0 for a triangle without pixels, and -1
    /// for a triangle of more than four columns.
    vectors: PerTriangle<i32>,
    /// Values of each triangle's edge expressions at the first pixel of its first vector.
    edges: [PerTriangle<i32>; 3],
    planes: [PerTriangle<i32>; 4],
}

impl SlimTriangles {
    /// Finds the triangles of a batch that are at most four columns wide.
    ///
    /// The origin of the edge expressions is the upper left pixel of the array. The origin of the planes is the upper
    /// left pixel of the picture. `left` and `top` are the coordinates of the array's upper left pixel in the picture.
    #[inline(always)]
    pub(super) fn among<V: SimdVector>(
        boxes: &Boxes,
        edges: &Edges,
        planes: &[LinearLanes; 4],
        [left, top]: [i32; 2],
    ) -> Self {
        let places = Self::places::<V>(boxes);
        let own = [&places.x, &places.y];
        let picture = [&moved(own[0], left), &moved(own[1], top)];
        let [p, q, r] = &edges.0;
        let [depth, red, green, blue] = planes;
        Self {
            edges: [values(p, own), values(q, own), values(r, own)],
            planes: [values(depth, picture), values(red, picture), values(green, picture), values(blue, picture)],
            ..places
        }
    }

    #[inline(always)]
    fn places<V: SimdVector>(boxes: &Boxes) -> Self {
        let tall = (V::LANES / FOUR) as i32;
        let none = [0; LANES];
        let mut all = Self { x: none, y: none, vectors: none, edges: [none; 3], planes: [none; 4] };
        for i in 0..LANES {
            let columns = boxes.x[1][i] - boxes.x[0][i] + 1;
            let rows = (boxes.y[1][i] - boxes.y[0][i] + 1).max(0);
            let vectors = (rows + tall - 1) / tall;
            // If a vector would end outside the array, begin it further left or further up.
            all.x[i] = boxes.x[0][i].min(WIDTH - FOUR as i32);
            all.y[i] = boxes.y[0][i].min(WIDTH - tall * vectors);
            let held = if columns > 0 { vectors } else { 0 };
            all.vectors[i] = if columns <= FOUR as i32 { held } else { -1 };
        }
        // Compilers can vectorize two separate loops, but not one loop with both steps.
        for i in 0..LANES {
            all.vectors[i] = if boxes.closed[i] { all.vectors[i] } else { -1 };
        }
        all
    }

    #[inline(always)]
    pub(super) const fn has(&self, i: usize) -> bool {
        self.vectors[i] >= 0
    }

    #[inline(always)]
    pub(super) fn draw<V: SimdVector, P: PaintTriangle>(
        &self,
        painter: &mut TrianglePainter<'_, P>,
        batch: &TriangleBatch<'_>,
        edges: &Edges,
        i: usize,
    ) {
        if let Some(colours) = &batch.colours {
            painter.paint.begin(colours[i]);
        }
        let [p, q, r] = &edges.0;
        let [depth, ..] = batch.planes;
        let tall = V::LANES / FOUR;
        // Each vector covers `tall` rows of four columns.
        for down in (0..self.vectors[i] as usize).map(|vector| vector * tall) {
            let at = (self.y[i] as usize + down) * WIDTH as usize + self.x[i] as usize;
            let first = walk::<V>(p, self.edges[0][i], i, down);
            let second = walk::<V>(q, self.edges[1][i], i, down);
            let third = walk::<V>(r, self.edges[2][i], i, down);
            let tested =
                painter.test::<V, QuadRows>(at, [first, second, third], walk(depth, self.planes[0][i], i, down));
            if V::any_of(tested.mask, tested.mask) {
                QuadRows::store(tested.new, tested.mask, tested.old, painter.z, at);
                painter.paint.store::<V, QuadRows>(&self.components(batch, i, down), at, tested.mask);
            }
        }
    }

    #[inline(always)]
    fn components<V: SimdVector>(&self, batch: &TriangleBatch<'_>, i: usize, down: usize) -> [Walk<V>; 3] {
        let [_, p, q, r] = batch.planes;
        let [_, first, second, third] = &self.planes;
        [walk(p, first[i], i, down), walk(q, second[i], i, down), walk(r, third[i], i, down)]
    }
}

/// Evaluates an expression of each triangle of a batch at a pixel (x, y) of this triangle. The result is a new array,
/// so that the compiler can assume that the inputs do not change.
#[inline(always)]
fn values(e: &LinearLanes, [x, y]: [&PerTriangle<i32>; 2]) -> PerTriangle<i32> {
    let mut all = [0; LANES];
    for i in 0..LANES {
        all[i] = e.c[i].wrapping_add(e.a[i].wrapping_mul(x[i])).wrapping_add(e.b[i].wrapping_mul(y[i]));
    }
    all
}

#[inline(always)]
fn moved(places: &PerTriangle<i32>, by: i32) -> PerTriangle<i32> {
    let mut all = [0; LANES];
    for i in 0..LANES {
        all[i] = places[i] + by;
    }
    all
}

/// Returns the values of triangle `i`'s expression for a vector that begins `down` rows below a pixel. `first` is the
/// value at this pixel.
#[inline(always)]
fn walk<V: SimdVector>(e: &LinearLanes, first: i32, i: usize, down: usize) -> Walk<V> {
    Walk::fours(first.wrapping_add(e.b[i].wrapping_mul(down as i32)), e.a[i], e.b[i])
}
