//! The regions that the triangles of a mesh touch, computed once for all processors that hold a part of the mesh.

use crate::bin::{Binner, Range, quotient};
use crate::lanes::{EachLane, LANES};
use crate::touch::Touch;
use crate::transform::{Snapped, Turn};
use crate::vertex::OUTSIDE;
use crate::{RegionMask, ScreenVertex, Transform};
use multiversion::multiversion;
use pxpl5_wire::RegionId;

/// The regions of all triangles of a mesh, four bytes for each triangle.
#[derive(Clone, Debug, Default)]
pub struct Touched {
    /// The index of the triangle's only region, or [`SEVERAL`] plus an index into `several`, or a code for the reason
    /// why there is no region.
    codes: Vec<u32>,
    several: Vec<RegionMask>,
}

const SEVERAL: u32 = 1 << 31;
const NEEDS_CLIPPING: u32 = RegionMask::CAPACITY;
const DEGENERATE: u32 = NEEDS_CLIPPING + 1;
const BACK_FACING: u32 = NEEDS_CLIPPING + 2;
const UNTOUCHED: u32 = NEEDS_CLIPPING + 3;

impl Touched {
    /// Returns the regions that triangle `i` touches, or the reason why the triangle is not drawn.
    ///
    /// # Panics
    /// Panics if `i` is not the index of a triangle.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Touch {
        match self.codes[i] {
            NEEDS_CLIPPING => Touch::NeedsClipping,
            DEGENERATE => Touch::Degenerate,
            BACK_FACING => Touch::BackFacing,
            UNTOUCHED => Touch::Untouched,
            one if one < SEVERAL => Touch::Region(RegionId(one as u16)),
            several => Touch::Regions(self.several[(several - SEVERAL) as usize]),
        }
    }

    /// Returns the region of triangle `i` if the triangle touches exactly one region, otherwise `None`.
    ///
    /// # Panics
    /// Panics if `i` is not the index of a triangle.
    #[inline(always)]
    pub fn only_region(&self, i: usize) -> Option<RegionId> {
        let code = self.codes[i];
        (code < RegionMask::CAPACITY).then_some(RegionId(code as u16))
    }

    fn code(&mut self, touch: Touch) -> u32 {
        match touch {
            Touch::NeedsClipping => NEEDS_CLIPPING,
            Touch::Degenerate => DEGENERATE,
            Touch::BackFacing => BACK_FACING,
            Touch::Untouched => UNTOUCHED,
            Touch::Region(region) => region.0.into(),
            Touch::Regions(regions) => {
                self.several.push(regions);
                SEVERAL + (self.several.len() - 1) as u32
            }
        }
    }
}

impl Transform {
    /// Finds the regions that each triangle touches, with the same results as [`Self::bin`].
    ///
    /// `triangles` has the indices of the corners of each triangle. `vertices` begins with the vertex of index `first`.
    /// The vertices must come from this view.
    ///
    /// # Panics
    /// Panics if a corner's index is not in `vertices`.
    pub fn touched(&self, vertices: &[ScreenVertex], first: u32, triangles: &[[u32; 3]]) -> Touched {
        let mut all = Touched { codes: Vec::with_capacity(triangles.len()), several: Vec::new() };
        let (chunks, rest) = triangles.as_chunks();
        for some in chunks {
            self.append_touched(&CornerLanes::of(vertices, first, some), LANES, &mut all);
        }
        if let [.., last] = rest {
            let mut some = [*last; LANES];
            some[..rest.len()].copy_from_slice(rest);
            self.append_touched(&CornerLanes::of(vertices, first, &some), rest.len(), &mut all);
        }
        all
    }

    #[inline(always)]
    fn append_touched(&self, corners: &CornerLanes, len: usize, all: &mut Touched) {
        let mut found = touch_lanes(corners, &self.binner, self.dropped);
        if found.any_several {
            for lane in 0..len {
                if found.codes[lane] == SEVERAL {
                    found.codes[lane] = all.code(self.touch_several(corners, &found, lane));
                }
            }
        }
        all.codes.extend_from_slice(&found.codes[..len]);
    }

    fn touch_several(&self, corners: &CornerLanes, found: &LaneTouches, lane: usize) -> Touch {
        let [x, y] = corners.clockwise(lane);
        Touch::from_mask(self.binner.test_edges(x, y, range_in(lane, &found.x), range_in(lane, &found.y)))
    }
}

fn range_in(lane: usize, [first, last]: &[EachLane<i32>; 2]) -> Range {
    Range { first: first[lane], last: last[lane] }
}

#[derive(Debug)]
struct CornerLanes([EachLane<[i32; 2]>; 3]);

impl CornerLanes {
    #[inline(always)]
    fn of(vertices: &[ScreenVertex], first: u32, triangles: &EachLane<[u32; 3]>) -> Self {
        let mut all = [[[0; 2]; LANES]; 3];
        for lane in 0..LANES {
            for corner in 0..3 {
                let ScreenVertex(Snapped { x, y, .. }) = vertices[triangles[lane][corner].wrapping_sub(first) as usize];
                all[corner][lane] = [x, y];
            }
        }
        Self(all)
    }

    #[inline(always)]
    fn coordinate(&self, axis: usize) -> [EachLane<i32>; 3] {
        let mut all = [[0; LANES]; 3];
        for (corner, places) in all.iter_mut().zip(&self.0) {
            for (coordinate, place) in corner.iter_mut().zip(places) {
                *coordinate = place[axis];
            }
        }
        all
    }

    fn clockwise(&self, lane: usize) -> [[i32; 3]; 2] {
        let [[a, d], [b, e], [c, f]] = [self.0[0][lane], self.0[1][lane], self.0[2][lane]];
        let counterclockwise = i64::from(b - a) * i64::from(f - d) < i64::from(e - d) * i64::from(c - a);
        if counterclockwise { [[a, c, b], [d, f, e]] } else { [[a, b, c], [d, e, f]] }
    }
}

/// Results of a first search, which compares only the bounding boxes of the triangles with the regions.
struct LaneTouches {
    /// Codes of the triangles, as in [`Touched`]. The code [`SEVERAL`] without an index marks a triangle whose bounding
    /// box overlaps several regions. The edges of this triangle must still be tested.
    codes: EachLane<u32>,
    any_several: bool,
    x: [EachLane<i32>; 2],
    y: [EachLane<i32>; 2],
}

#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn touch_lanes(corners: &CornerLanes, binner: &Binner, dropped: Option<Turn>) -> LaneTouches {
    let corners = [corners.coordinate(0), corners.coordinate(1)];
    let x = extent(&corners[0]);
    let y = extent(&corners[1]);
    let columns = ranges(&x, |range| range.within(binner.width));
    let rows = ranges(&y, |range| binner.rows_of_lines(range).within(binner.height));
    let in_column = cells(&x, &columns[0], |pixel| {
        let column = quotient(pixel, binner.column_reciprocal);
        (column, binner.column_box(column))
    });
    let in_row = cells(&y, &rows[0], |pixel| {
        let row = quotient(pixel, binner.row_reciprocal);
        (row, binner.row_box(row))
    });
    let areas = areas(&corners);
    // Sign by which the area is multiplied. The product is positive for a triangle that must be dropped.
    let dropped = match dropped {
        None => 0.0,
        Some(Turn::Clockwise) => 1.0,
        Some(Turn::Counterclockwise) => -1.0,
    };
    // Later tests override earlier tests, so their order matters.
    let mut codes = [0; LANES];
    let mut n_several = 0;
    for i in 0..LANES {
        let one = in_column[i] + in_row[i] * binner.columns_of_regions();
        let code = if (in_column[i] | in_row[i]) < 0 { SEVERAL } else { one as u32 };
        let empty = (columns[0][i] > columns[1][i]) | (rows[0][i] > rows[1][i]);
        let code = if empty { UNTOUCHED } else { code };
        let code = if areas[i] * dropped > 0.0 { BACK_FACING } else { code };
        let code = if areas[i] == 0.0 { DEGENERATE } else { code };
        codes[i] = if x[1][i] == OUTSIDE { NEEDS_CLIPPING } else { code };
        n_several += u32::from(codes[i] == SEVERAL);
    }
    LaneTouches { codes, any_several: n_several > 0, x: columns, y: rows }
}

/// Returns twice the area of each triangle, in 1/256 square px, exactly.
#[inline(always)]
fn areas([[a, b, c], [d, e, f]]: &[[EachLane<i32>; 3]; 2]) -> EachLane<f64> {
    let mut out = [0.0; LANES];
    for i in 0..LANES {
        let first = f64::from(b[i] - a[i]) * f64::from(f[i] - d[i]);
        out[i] = first - f64::from(e[i] - d[i]) * f64::from(c[i] - a[i]);
    }
    out
}

#[inline(always)]
fn extent([p, q, r]: &[EachLane<i32>; 3]) -> [EachLane<i32>; 2] {
    let mut low = [0; LANES];
    let mut high = [0; LANES];
    for i in 0..LANES {
        low[i] = p[i].min(q[i]).min(r[i]);
        high[i] = p[i].max(q[i]).max(r[i]);
    }
    [low, high]
}

/// Returns the first and the last pixel whose centres lie between the corners. `within` limits the pixels to the
/// picture.
#[inline(always)]
fn ranges([low, high]: &[EachLane<i32>; 2], within: impl Fn(Range) -> Range) -> [EachLane<i32>; 2] {
    let mut first = [0; LANES];
    let mut last = [0; LANES];
    for i in 0..LANES {
        let range = within(Range::of_centres(low[i], high[i]));
        first[i] = range.first;
        last[i] = range.last;
    }
    [first, last]
}

/// Returns for each triangle the column (or row) of regions that contains all corners, or -1 if there is none.
///
/// For a pixel, `of` returns the column (or row) of regions with this pixel, and the first and last pixel of this
/// column (or row).
#[inline(always)]
fn cells(
    [low, high]: &[EachLane<i32>; 2],
    first: &EachLane<i32>,
    of: impl Fn(i32) -> (i32, (i32, i32)),
) -> EachLane<i32> {
    let mut out = [0; LANES];
    for i in 0..LANES {
        let (cell, (begin, end)) = of(first[i]);
        out[i] = if (low[i] >= begin * 16 + 8) & (high[i] <= end * 16 + 8) { cell } else { -1 };
    }
    out
}
