//! Geometry with only the error of the vertex format. Exact vertices are rounded to a number of subpixel bits, and all
//! later steps use exact integers.

use super::exact::ExactTriangle;
use super::{HEIGHT, WIDTH};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::ToPrimitive;

/// Corners in subpixels of `2^-bits` px.
#[derive(Clone, Copy, Debug)]
pub struct Snapped {
    x: [i128; 3],
    y: [i128; 3],
    bits: u32,
}

/// Returns the grid position nearest to numerator / 2w, ties up. Returns `None` if the position is far away.
fn snap(numerator: BigInt, w: &BigInt, bits: u32) -> Option<i128> {
    // Computes floor(n / 2w + 1/2) on the finer grid.
    let twice: BigInt = (numerator << bits) + w;
    twice.div_floor(&(w * 2)).to_i128().filter(|v| v.abs() < 1 << 50)
}

impl Snapped {
    /// Creates the snapped corners. Returns `None` if a corner is behind the near plane, or so far away that products
    /// would overflow.
    pub fn new(triangle: &ExactTriangle, bits: u32) -> Option<Self> {
        if !triangle.whole {
            return None;
        }
        let mut corners = Self { x: [0; 3], y: [0; 3], bits };
        for (i, [x, y, _, w]) in triangle.corners.iter().enumerate() {
            corners.x[i] = snap((w + x) * WIDTH, w, bits)?;
            corners.y[i] = snap((w - y) * HEIGHT, w, bits)?;
        }
        Some(corners)
    }

    /// Returns the area of (from, to, centre of pixel [x, y]), and the change of this area from pixel to pixel. The area
    /// is positive inside. For edges whose ties are outside, the result is the area minus 1.
    fn edge(&self, from: usize, to: usize, turn: i128, [x, y]: [i32; 2]) -> [i128; 2] {
        let dx = (self.x[to] - self.x[from]) * turn;
        let dy = (self.y[to] - self.y[from]) * turn;
        let [centre_x, centre_y] = [x, y].map(|pixel| (2 * i128::from(pixel) + 1) << self.bits >> 1);
        let top_left = dy < 0 || (dy == 0 && dx > 0);
        let area = dx * (centre_y - self.y[from]) - dy * (centre_x - self.x[from]) - i128::from(!top_left);
        [area, -(dy << self.bits)]
    }

    fn turn(&self) -> i128 {
        let x = &self.x;
        let y = &self.y;
        ((x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0])).signum()
    }

    /// Returns for each pixel of a row, beginning with the column `left`, whether it is covered. Areas are integers, so
    /// sums of changes are exact.
    pub fn covered_from(&self, left: i32, y: i32) -> impl Iterator<Item = bool> {
        let turn = self.turn();
        let mut edges = [(0, 1), (1, 2), (2, 0)].map(|(from, to)| self.edge(from, to, turn, [left, y]));
        std::iter::repeat_with(move || {
            let is_inside = turn != 0 && edges.iter().all(|[area, _]| *area >= 0);
            edges.iter_mut().for_each(|[area, change]| *area += *change);
            is_inside
        })
    }

    /// Returns the first and last row that can be covered.
    pub fn rows(&self) -> [i32; 2] {
        self.pixels_between(&self.y, HEIGHT)
    }

    /// Returns the first and last column that can be covered.
    pub fn columns(&self) -> [i32; 2] {
        self.pixels_between(&self.x, WIDTH)
    }

    /// Returns the first and last pixel that the corners' box can contain along one axis of a picture.
    fn pixels_between(&self, corners: &[i128; 3], size: i32) -> [i32; 2] {
        let low = *corners.iter().min().unwrap_or(&0) - (1 << self.bits);
        let high = *corners.iter().max().unwrap_or(&0);
        [low, high].map(|v| (v >> self.bits).clamp(0, i128::from(size - 1)) as i32)
    }
}
