//! Binning: finds the regions that a screen triangle touches.
//!
//! Renderers evaluate a triangle at pixel centres. The *pixel-centre box* of a region is the smallest rectangle that
//! contains the centres of the region's pixels. A region is *touched* if two conditions hold:
//!
//! - The triangle's bounding box contains the centre of a pixel column and the centre of a pixel row of the region.
//! - For each edge of the triangle, some point of the pixel-centre box is on the inner side. Points on right and bottom
//!   edges do not count.
//!
//! If both conditions hold, the triangle overlaps the pixel-centre box, because the conditions test all sides of the
//! Minkowski sum of triangle and box. Every region with a covered pixel is touched. A touched region can have no
//! covered pixel, if the triangle passes between the pixel centres. A triangle between two adjacent columns or rows of
//! pixel centres touches no region.

use crate::outline::{Outline, extent};
use crate::regions::RegionMask;
use crate::view::Viewport;
use pxpl5_wire::Linear;

/// The first and the last pixel along x or y. If `first > last`, the range is empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Range {
    pub(crate) first: i32,
    pub(crate) last: i32,
}

impl Range {
    pub(crate) const fn is_empty(self) -> bool {
        self.first > self.last
    }

    /// Returns the pixels with centres from `low` to below `high`, both in subpixels. A pixel with its centre at `high`
    /// is not drawn.
    #[inline(always)]
    pub(crate) const fn of_centres(low: i32, high: i32) -> Self {
        Self { first: (low + 7) >> 4, last: (high - 9) >> 4 }
    }

    #[inline(always)]
    pub(crate) fn within(self, size: i32) -> Self {
        Self { first: self.first.max(0), last: self.last.min(size - 1) }
    }
}

/// The division of a picture into regions, with reciprocals that replace divisions by the region's size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Binner {
    pub(crate) width: i32,
    pub(crate) height: i32,
    columns: i32,
    pub(crate) column_reciprocal: u32,
    pub(crate) row_reciprocal: u32,
    region_width: i32,
    region_height: i32,
    line_shift: u32,
    first_line: i32,
}

/// Returns a reciprocal such that `n / size == n * reciprocal(size) >> 20`, for n below 2^13 and sizes up to 128.
///
/// The reciprocal divided by 2^20 exceeds `1 / size` by less than 2^-20, and n times this excess is below `1 / size`.
const fn reciprocal(size: u32) -> u32 {
    (1_u32 << 20).div_ceil(size)
}

#[inline(always)]
pub(crate) const fn quotient(n: i32, reciprocal: u32) -> i32 {
    ((n as u64 * reciprocal as u64) >> 20) as i32
}

impl Binner {
    pub(crate) fn new(viewport: &Viewport) -> Self {
        let grid = viewport.grid();
        Self {
            width: grid.width as i32,
            height: grid.height as i32,
            columns: grid.columns() as i32,
            column_reciprocal: reciprocal(grid.region_width),
            row_reciprocal: reciprocal(grid.region_height),
            region_width: grid.region_width as i32,
            region_height: grid.region_height as i32,
            line_shift: viewport.line_step() - 1,
            first_line: viewport.first_line() as i32,
        }
    }

    pub(crate) const fn columns_of_regions(&self) -> i32 {
        self.columns
    }

    /// Returns the rows of the picture that lie on the lines `lines` of the video frame. A field has only every second
    /// line of its video frame.
    #[inline(always)]
    pub(crate) fn rows_of_lines(&self, lines: Range) -> Range {
        let round_up = (1 << self.line_shift) - 1;
        Range {
            first: (lines.first - self.first_line + round_up) >> self.line_shift,
            last: (lines.last - self.first_line) >> self.line_shift,
        }
    }

    pub(crate) fn rectangle(&self, x: Range, lines: Range) -> RegionMask {
        let x = x.within(self.width);
        let y = self.rows_of_lines(lines).within(self.height);
        if x.is_empty() || y.is_empty() {
            return RegionMask::EMPTY;
        }
        self.cells(x, y, |_, _| true)
    }

    #[inline(always)]
    pub(crate) fn triangle(&self, outline: &Outline) -> RegionMask {
        let [low_x, high_x] = extent(&outline.x);
        let [low_y, high_y] = extent(&outline.y);
        let x = Range::of_centres(low_x, high_x).within(self.width);
        let y = self.rows_of_lines(Range::of_centres(low_y, high_y)).within(self.height);
        if x.is_empty() || y.is_empty() {
            return RegionMask::EMPTY;
        }
        // Fast path: a triangle inside the pixel-centre box of one region touches no other region.
        let column = quotient(x.first, self.column_reciprocal);
        let row = quotient(y.first, self.row_reciprocal);
        let (left, right) = self.column_box(column);
        let (top, bottom) = self.row_box(row);
        let inside =
            low_x >= left * 16 + 8 && high_x <= right * 16 + 8 && low_y >= top * 16 + 8 && high_y <= bottom * 16 + 8;
        if inside {
            return RegionMask::with_bits(1 << (row * self.columns + column));
        }
        self.test_edges(outline.x, outline.y, x, y)
    }

    /// Returns the regions that a triangle touches, among the regions with pixels in the columns `x` and rows `y`.
    ///
    /// The arguments have no depths, because a search for regions does not need them.
    #[inline(never)]
    pub(crate) fn test_edges(&self, corners_x: [i32; 3], corners_y: [i32; 3], x: Range, y: Range) -> RegionMask {
        let outline = Outline { x: corners_x, y: corners_y, z: [0; 3], regions: RegionMask::EMPTY };
        let edges = outline.edges();
        self.cells(x, y, |column, row| {
            let across = self.column_box(column);
            let down = self.row_box(row);
            edges.iter().all(|e| greatest(e, across, down) >= 0)
        })
    }

    /// Returns the regions with pixels in the columns `x` and rows `y` for which `test` returns true. `test` receives
    /// the region's column and row in the grid of regions.
    fn cells(&self, x: Range, y: Range, test: impl Fn(i32, i32) -> bool) -> RegionMask {
        let columns = [x.first, x.last].map(|n| quotient(n, self.column_reciprocal));
        let rows = [y.first, y.last].map(|n| quotient(n, self.row_reciprocal));
        let mut mask = 0;
        for row in rows[0]..=rows[1] {
            for column in columns[0]..=columns[1] {
                mask |= u128::from(test(column, row)) << (row * self.columns + column);
            }
        }
        RegionMask::with_bits(mask)
    }

    /// Returns the first and the last pixel column of the grid's column `column`.
    #[inline(always)]
    pub(crate) fn column_box(&self, column: i32) -> (i32, i32) {
        let left = column * self.region_width;
        (left, (left + self.region_width).min(self.width) - 1)
    }

    /// Returns the first and the last line, in the video frame, of the grid's row `row`.
    #[inline(always)]
    pub(crate) fn row_box(&self, row: i32) -> (i32, i32) {
        let top = row * self.region_height;
        let bottom = (top + self.region_height).min(self.height) - 1;
        (self.line_of_row(top), self.line_of_row(bottom))
    }

    #[inline(always)]
    const fn line_of_row(&self, row: i32) -> i32 {
        (row << self.line_shift) + self.first_line
    }
}

impl Outline {
    /// Returns true if the triangle touches the box around the pixel centres of a rectangle of the screen. The test is
    /// the same as for regions.
    ///
    /// `across` has the first and the last pixel column of the rectangle, and `lines` its first and last line in the
    /// video frame.
    pub fn meets(&self, across: [i32; 2], lines: [i32; 2]) -> bool {
        let x = pixels_between(&self.x);
        let y = pixels_between(&self.y);
        let [left, right] = across;
        let [top, bottom] = lines;
        let apart = x.first > right || x.last < left || y.first > bottom || y.last < top;
        !apart && self.edges().iter().all(|e| greatest(e, (left, right), (top, bottom)) >= 0)
    }
}

fn pixels_between(corners: &[i32; 3]) -> Range {
    let [low, high] = extent(corners);
    Range::of_centres(low, high)
}

/// Returns the largest value of an edge expression over a rectangle of pixels. [`crate::GUARD_PIXELS`] prevents an
/// overflow.
fn greatest(edge: &Linear, (left, right): (i32, i32), (top, bottom): (i32, i32)) -> i32 {
    let x = if edge.a > 0 { right } else { left };
    let y = if edge.b > 0 { bottom } else { top };
    edge.at(x, y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_by_reciprocal_are_exact_for_every_pixel_and_region_size() {
        for size in 1..=pxpl5_wire::REGION_SIZE {
            for n in 0..crate::MAX_PICTURE {
                assert_eq!(quotient(n as i32, reciprocal(size)), (n / size) as i32, "{n} / {size}");
            }
        }
    }
}
