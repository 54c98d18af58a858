//! Rasterization of a triangle on a face, row by row. Colours and depths of covered texels are computed for several
//! texels at a time.

use crate::cube_faces::edges::{Columns, Crossing, Linear};
use address_recalculation::{CubeFace, DEPTH_FARTHEST, FaceSet, TexelAddress};
use multiversion::multiversion;

/// Largest number of texels that are computed before they are written.
const RUN: usize = 64;

/// Number of doubles in a vector register. Texels are computed in multiples of this number.
const LANES: usize = 4;

pub(crate) enum Shade {
    Flat(u32),
    /// Red, green and blue as functions over the face, each divided by w, the distance along the face's axis.
    Smooth([Linear; 3]),
}

pub(crate) struct OnFace {
    pub(crate) face: CubeFace,
    pub(crate) columns: Columns,
    pub(crate) texels: i64,
    pub(crate) crossings: [Crossing; 3],
    /// 1/w as a function over the face, where w is the distance along the face's axis.
    pub(crate) reciprocal: Linear,
    /// Coefficients (a, b) of the depth a + b/w, where w is the distance along the face's axis. The depth of a drawn
    /// texel is between 0 and 1.
    pub(crate) depth: [f64; 2],
    pub(crate) shade: Shade,
}

struct Run {
    colours: [u32; RUN],
    depths: [u32; RUN],
}

/// Draws a triangle in a range of rows, and returns the number of texels that it covers.
#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub(crate) fn draw(triangle: &OnFace, rows: [i64; 2], faces: &mut FaceSet) -> u64 {
    let mut run = Run { colours: [0; RUN], depths: [0; RUN] };
    let mut texels = 0;
    for row in rows[0]..rows[1] {
        let y = triangle.columns.middle(row);
        // Find the columns inside all three edges.
        let mut range = [0, triangle.texels];
        for crossing in &triangle.crossings {
            crossing.narrow(crossing.edge.row(y), triangle.columns, &mut range);
            if range[0] >= range[1] {
                break;
            }
        }
        // Compute and write the texels in runs.
        let mut first = range[0];
        while first < range[1] {
            let count = ((range[1] - first) as usize).min(RUN);
            compute(triangle, y, first, count, &mut run);
            let address = TexelAddress { face: triangle.face, column: first as u32, row: row as u32 };
            faces.keep_nearer(address, &run.colours[..count], &run.depths[..count]);
            first += count as i64;
            texels += count as u64;
        }
    }
    texels
}

/// Computes colours and depths of `count` texels from column `first` on. The number of computed texels is rounded up to
/// a multiple of [`LANES`].
#[inline(always)]
fn compute(triangle: &OnFace, y: f64, first: i64, count: usize, run: &mut Run) {
    let whole = count.next_multiple_of(LANES).min(RUN);
    let mut places = [0.0; RUN];
    // Positions of the texel middles.
    for (i, place) in places[..whole].iter_mut().enumerate() {
        *place = triangle.columns.first + (first as i32 + i as i32) as f64 * triangle.columns.step;
    }
    // 1/w and the depth are linear along a row.
    let along = [triangle.reciprocal.x, triangle.reciprocal.row(y)];
    let [near, scale] = triangle.depth;
    let depth = [along[0] * scale, near + along[1] * scale];
    for (word, x) in run.depths[..whole].iter_mut().zip(&places[..whole]) {
        *word = depth_word(depth[0] * x + depth[1]);
    }
    match &triangle.shade {
        Shade::Flat(colour) => run.colours[..whole].fill(*colour),
        Shade::Smooth(parts) => {
            let rows = parts.map(|part| part.row(y));
            for (colour, x) in run.colours[..whole].iter_mut().zip(&places[..whole]) {
                // Divide the interpolated colours by the interpolated 1/w.
                let distance = 1.0 / (along[0] * x + along[1]);
                let red = byte((parts[0].x * x + rows[0]) * distance);
                let green = byte((parts[1].x * x + rows[1]) * distance);
                let blue = byte((parts[2].x * x + rows[2]) * distance);
                *colour = red << 16 | green << 8 | blue;
            }
        }
    }
}

/// Returns the integer part of a number from 0 to 2^32.
///
/// The addition of 2^52 moves the integer into the lowest bits of the double. A cast would be slower, because it tests
/// each number separately.
#[inline(always)]
fn whole_part(number: f64) -> u32 {
    (number.floor() + 4_503_599_627_370_496.0).to_bits() as u32
}

/// Converts a depth from 0 to 1 to 24 bits. Any other depth becomes the farthest depth, with which no texel is drawn.
#[inline(always)]
fn depth_word(depth: f64) -> u32 {
    let word = whole_part(depth * f64::from(DEPTH_FARTHEST));
    if (0.0..1.0).contains(&depth) { word } else { DEPTH_FARTHEST }
}

/// Returns a colour component, limited to 0 to 255 and rounded to the nearest integer.
#[inline(always)]
fn byte(part: f64) -> u32 {
    let part = if part > 0.0 { part } else { 0.0 };
    whole_part(if part < 255.0 { part } else { 255.0 } + 0.5)
}
