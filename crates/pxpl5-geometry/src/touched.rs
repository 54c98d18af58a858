//! The regions that the triangles of a mesh touch, found once for all who hold some of them.

use crate::bin::{Binner, Range, quotient};
use crate::lanes::{EachLane, LANES};
use crate::touch::Touch;
use crate::transform::Turn;
use crate::{RegionMask, ScreenVertex, Transform};
use multiversion::multiversion;
use pxpl5_wire::RegionId;

/// What binning finds of the triangles of a mesh, four bytes each.
#[derive(Clone, Debug, Default)]
pub struct Touched {
    /// A region, one of the codes below, or [`SEVERAL`] and a place in `several`.
    codes: Vec<u32>,
    several: Vec<RegionMask>,
}

const SEVERAL: u32 = 1 << 31;
const NEEDS_CLIPPING: u32 = RegionMask::CAPACITY;
const DEGENERATE: u32 = NEEDS_CLIPPING + 1;
const BACK_FACING: u32 = NEEDS_CLIPPING + 2;
const UNTOUCHED: u32 = NEEDS_CLIPPING + 3;

impl Touched {
    /// What was found of triangle `i`.
    ///
    /// # Panics
    /// If there are not as many triangles.
    #[inline(always)]
    #[must_use]
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

    fn push(&mut self, touch: Touch) {
        self.codes.push(match touch {
            Touch::NeedsClipping => NEEDS_CLIPPING,
            Touch::Degenerate => DEGENERATE,
            Touch::BackFacing => BACK_FACING,
            Touch::Untouched => UNTOUCHED,
            Touch::Region(region) => region.0.into(),
            Touch::Regions(regions) => {
                self.several.push(regions);
                SEVERAL + (self.several.len() - 1) as u32
            }
        });
    }
}

impl Transform {
    /// What [`Self::bin`] finds of triangles, given as places of their corners among vertices that this view sees.
    ///
    /// # Panics
    /// If there is no vertex at such a place.
    #[must_use]
    pub fn touched(&self, vertices: &[ScreenVertex], mut triangles: impl Iterator<Item = [usize; 3]>) -> Touched {
        let mut all = Touched { codes: Vec::with_capacity(triangles.size_hint().0), several: Vec::new() };
        let mut some = CornerLanes::default();
        while some.take(vertices, &mut triangles) > 0 {
            let found = touch_lanes(&some, &self.binner, self.dropped);
            for lane in 0..some.len {
                match found.codes[lane] {
                    _ if some.outside[lane] => all.codes.push(NEEDS_CLIPPING),
                    SEVERAL => all.push(self.touch_several(&some, &found, lane)),
                    known => all.codes.push(known),
                }
            }
        }
        all
    }

    /// A triangle whose box lies in more than one region.
    fn touch_several(&self, corners: &CornerLanes, found: &LaneTouches, lane: usize) -> Touch {
        let [x, y] = corners.clockwise(lane);
        Touch::from_mask(self.binner.test_edges(x, y, range_in(lane, &found.x), range_in(lane, &found.y)))
    }
}

fn range_in(lane: usize, [first, last]: &[EachLane<i32>; 2]) -> Range {
    Range { first: first[lane], last: last[lane] }
}

/// Corners of some triangles.
#[derive(Debug, Default)]
struct CornerLanes {
    len: usize,
    x: [EachLane<i32>; 3],
    y: [EachLane<i32>; 3],
    /// Some corner is not inside the guard band.
    outside: EachLane<bool>,
}

impl CornerLanes {
    /// Takes the next triangles; gives their number.
    #[inline(always)]
    fn take(&mut self, vertices: &[ScreenVertex], triangles: &mut impl Iterator<Item = [usize; 3]>) -> usize {
        self.len = 0;
        // The range comes first, so that no triangle is taken that has no lane.
        for (lane, at) in (0..LANES).zip(triangles) {
            let corners = [&vertices[at[0]], &vertices[at[1]], &vertices[at[2]]];
            for (corner, vertex) in corners.iter().enumerate() {
                self.x[corner][lane] = vertex.snapped.x;
                self.y[corner][lane] = vertex.snapped.y;
            }
            self.outside[lane] = !(corners[0].inside & corners[1].inside & corners[2].inside);
            self.len = lane + 1;
        }
        self.len
    }

    /// x and y of a triangle's corners in clockwise order.
    fn clockwise(&self, lane: usize) -> [[i32; 3]; 2] {
        let [a, b, c] = self.x.map(|x| x[lane]);
        let [d, e, f] = self.y.map(|y| y[lane]);
        let counterclockwise = i64::from(b - a) * i64::from(f - d) < i64::from(e - d) * i64::from(c - a);
        if counterclockwise { [[a, c, b], [d, f, e]] } else { [[a, b, c], [d, e, f]] }
    }
}

/// What is found of some triangles at once.
struct LaneTouches {
    /// As in [`Touched`]; [`SEVERAL`] alone where the edges decide between several regions.
    codes: EachLane<u32>,
    /// First and last column and row of pixels.
    x: [EachLane<i32>; 2],
    y: [EachLane<i32>; 2],
}

#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn touch_lanes(corners: &CornerLanes, binner: &Binner, dropped: Option<Turn>) -> LaneTouches {
    let x = extent(&corners.x);
    let y = extent(&corners.y);
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
    let areas = areas(corners);
    let clockwise = dropped == Some(Turn::Clockwise);
    let counterclockwise = dropped == Some(Turn::Counterclockwise);
    let mut codes = [0; LANES];
    for i in 0..LANES {
        let one = in_column[i] + in_row[i] * binner.columns_of_regions();
        let code = if (in_column[i] | in_row[i]) < 0 { SEVERAL } else { one as u32 };
        let empty = (columns[0][i] > columns[1][i]) | (rows[0][i] > rows[1][i]);
        let code = if empty { UNTOUCHED } else { code };
        let is_dropped = (clockwise & (areas[i] > 0.0)) | (counterclockwise & (areas[i] < 0.0));
        let code = if is_dropped { BACK_FACING } else { code };
        codes[i] = if areas[i] == 0.0 { DEGENERATE } else { code };
    }
    LaneTouches { codes, x: columns, y: rows }
}

/// Twice the areas, exact: products of two differences of corners need 35 bits.
#[inline(always)]
fn areas(CornerLanes { x: [a, b, c], y: [d, e, f], .. }: &CornerLanes) -> EachLane<f64> {
    let mut out = [0.0; LANES];
    for i in 0..LANES {
        let first = f64::from(b[i] - a[i]) * f64::from(f[i] - d[i]);
        out[i] = first - f64::from(e[i] - d[i]) * f64::from(c[i] - a[i]);
    }
    out
}

/// Smallest and largest of the corners.
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

/// First and last pixel between the smallest and the largest of the corners, as far as the picture goes.
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

/// The column or row of regions whose pixel-centre box holds all corners, -1 where none does; `of` gives that of a pixel
/// and its first and last pixel or line.
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
