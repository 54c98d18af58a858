//! Comparison of the pipeline with exact geometry, for each case.

use super::cases::Case;
use super::exact::ExactTriangle;
use super::native::Piece;
use super::snapped::Snapped;
use super::{HEIGHT, WIDTH};
use pxpl5_geometry::{Culling, DEPTH_FAR, DEPTH_NEAR, SetupStats, Transform, Viewport};
use std::ops::RangeInclusive;

/// Finer and coarser grids with which the formats are tested, in bits of subpixels.
pub const SUBPIXEL_BITS: [u32; 6] = [0, 2, 4, 6, 8, 12];

#[derive(Clone, Debug, Default)]
pub struct Row {
    /// Number of pixels that the exact geometry covers, summed over all triangles.
    pub exact: u64,
    /// Number of pixels that only the pipeline or only the exact geometry covers.
    pub wrong: u64,
    /// Largest depth error in units of pixel depth, of all steps together.
    pub depth: f64,
    pub depth_plane: f64,
    /// Largest colour error in colour units, of all steps together.
    pub colour: f64,
    pub colour_plane: f64,
    /// For tilings: number of uncovered pixels inside the exact tiling.
    pub holes: Option<u64>,
    pub overlaps: Option<u64>,
    /// Numbers of wrong pixels if exact vertices are rounded to a grid, for each grid of [`SUBPIXEL_BITS`]. The next
    /// field, `grid_exact`, is the number of exact pixels of the same triangles.
    pub grids: [u64; SUBPIXEL_BITS.len()],
    pub grid_exact: u64,
    /// Bits, including the sign, of the largest coefficients: edges a and b, edges c, depth slopes, colour slopes.
    pub bits: [u32; 4],
    pub stats: SetupStats,
}

impl Row {
    /// Returns wrong pixels per million of all exact or wrong pixels.
    pub fn per_million(wrong: u64, exact: u64) -> f64 {
        if wrong == 0 { 0.0 } else { wrong as f64 * 1e6 / exact.max(wrong) as f64 }
    }
}

/// A counter for each pixel of the frame.
struct Counts(Vec<u8>);

impl Counts {
    fn new() -> Self {
        Self(vec![0; (WIDTH * HEIGHT) as usize])
    }

    fn add(&mut self, x: i32, y: i32) {
        let cell = &mut self.0[(y * WIDTH + x) as usize];
        *cell = cell.saturating_add(1);
    }

    fn clear(&mut self, x: i32, y: i32) {
        self.0[(y * WIDTH + x) as usize] = 0;
    }

    fn get(&self, x: i32, y: i32) -> u8 {
        self.0[(y * WIDTH + x) as usize]
    }

    /// Returns true if the pixel and all its neighbours are covered.
    fn is_interior(&self, x: i32, y: i32) -> bool {
        neighbours(y, HEIGHT).all(|y| neighbours(x, WIDTH).all(|x| self.get(x, y) > 0))
    }
}

fn neighbours(pixel: i32, size: i32) -> RangeInclusive<i32> {
    (pixel - 1).max(0)..=(pixel + 1).min(size - 1)
}

fn pixels() -> impl Iterator<Item = (i32, i32)> {
    (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y)))
}

/// Draws a case with the pipeline and with exact geometry, and counts the differences. `single` selects the program of
/// Slats.
pub fn measure(case: &Case, single: bool) -> Row {
    let new = if single { Transform::in_single_precision } else { Transform::new };
    let transform = new(&case.view, Viewport::FRAME, Culling::None).expect("finite views");
    let mut row = Row::default();
    let [mut drawn, mut wanted, mut own] = [Counts::new(), Counts::new(), Counts::new()];
    for triangle in &case.triangles {
        let pieces = Piece::of(&transform, triangle, &mut row.stats);
        let exact = ExactTriangle::new(&case.view, triangle);
        row.compare(&pieces, exact.as_ref(), [&mut drawn, &mut wanted, &mut own]);
    }
    if case.tiling {
        row.tiling(&drawn, &wanted);
    }
    row
}

impl Row {
    /// Compares one triangle. The counter `own` is zero before and after the call.
    fn compare(&mut self, pieces: &[Piece], exact: Option<&ExactTriangle>, counts: [&mut Counts; 3]) {
        let [drawn, wanted, own] = counts;
        let spans: Vec<[i32; 2]> = (0..HEIGHT).map(|y| exact.map_or([0, -1], |e| e.span(y))).collect();
        let mut reach = vec![[WIDTH, -1]; HEIGHT as usize];
        for piece in pieces {
            self.bits(piece);
            let mut number = 0;
            let stride = piece.stride();
            piece.pixels(|x, y| {
                own.add(x, y);
                drawn.add(x, y);
                let [first, last] = &mut reach[y as usize];
                *first = (*first).min(x);
                *last = (*last).max(x);
                number += 1;
                if number % stride == 0 {
                    self.plane_errors(piece, x, y);
                    self.errors(piece, exact, spans[y as usize], x, y);
                }
            });
        }
        for (y, (span, native)) in (0..).zip(spans.iter().zip(reach)) {
            for x in span[0].min(native[0])..=span[1].max(native[1]) {
                let inside = (span[0]..=span[1]).contains(&x);
                if inside {
                    self.exact += 1;
                    wanted.add(x, y);
                }
                // A pixel drawn twice by pieces of one triangle is also wrong.
                self.wrong += u64::from(own.get(x, y) != u8::from(inside));
                own.clear(x, y);
            }
        }
        if let Some(exact) = exact {
            self.grids(exact, &spans);
        }
    }

    /// Compares the planes with exact planes through the same corners in subpixels.
    fn plane_errors(&mut self, piece: &Piece, x: i32, y: i32) {
        let depth = piece.plane_value(piece.depth_corners(), x, y) / 256.0;
        self.depth_plane = self.depth_plane.max((f64::from(piece.depth(x, y)) + 0.5 - depth).abs());
        for i in 0..3 {
            let colour = piece.plane_value(piece.colour_corners(i), x, y) / 256.0;
            self.colour_plane = self.colour_plane.max((f64::from(piece.colour(i, x, y)) - colour).abs());
        }
    }

    /// Compares a pixel with exact geometry, if exact geometry covers the pixel as well.
    fn errors(&mut self, piece: &Piece, exact: Option<&ExactTriangle>, [first, last]: [i32; 2], x: i32, y: i32) {
        let Some(exact) = exact else { return };
        if !(first..=last).contains(&x) {
            return;
        }
        let range = f64::from(DEPTH_FAR - DEPTH_NEAR);
        let depth = (f64::from(DEPTH_NEAR) + exact.depth(x, y) * range) / 256.0;
        self.depth = self.depth.max((f64::from(piece.depth(x, y)) + 0.5 - depth).abs());
        if exact.whole {
            for i in 0..3 {
                let off = (f64::from(piece.colour(i, x, y)) - exact.colour(i, x, y)).abs();
                self.colour = self.colour.max(off);
            }
        }
    }

    fn grids(&mut self, exact: &ExactTriangle, spans: &[[i32; 2]]) {
        for (i, bits) in SUBPIXEL_BITS.into_iter().enumerate() {
            let Some(snapped) = Snapped::new(exact, bits) else { return };
            let [left, right] = snapped.columns();
            let [top, bottom] = snapped.rows();
            for y in top..=bottom {
                let [first, last] = spans[y as usize];
                let range = if first > last { left..=right } else { left.min(first)..=right.max(last) };
                let covered = snapped.covered_from(*range.start(), y);
                self.grids[i] += range.zip(covered).filter(|(x, is)| *is != (first..=last).contains(x)).count() as u64;
            }
        }
        self.grid_exact += spans.iter().map(|[first, last]| (last - first + 1).max(0) as u64).sum::<u64>();
    }

    fn bits(&mut self, piece: &Piece) {
        for e in piece.screen.edges(&Viewport::FRAME) {
            self.keep_bits(0, e.a.into());
            self.keep_bits(0, e.b.into());
            self.keep_bits(1, e.c.into());
        }
        self.slope_bits(2, piece, piece.depth_corners());
        for component in 0..3 {
            // Colours at the corners have 8 fraction bits, and the expression has 12.
            self.slope_bits(3, piece, piece.colour_corners(component).map(|c| c * 16));
        }
    }

    /// Records the bits of the slopes of the plane through three values at the corners.
    fn slope_bits(&mut self, place: usize, piece: &Piece, corners: [i128; 3]) {
        let (origin, area) = piece.exact_plane(corners, 0, 0);
        for (x, y) in [(1, 0), (0, 1)] {
            self.keep_bits(place, (piece.exact_plane(corners, x, y).0 - origin) / area.max(1));
        }
    }

    /// Keeps the larger of the recorded bits and the bits of `value`, including the sign.
    fn keep_bits(&mut self, place: usize, value: i128) {
        self.bits[place] = self.bits[place].max(129 - value.unsigned_abs().leading_zeros());
    }

    fn tiling(&mut self, drawn: &Counts, wanted: &Counts) {
        let holes = pixels().filter(|&(x, y)| drawn.get(x, y) == 0 && wanted.is_interior(x, y)).count();
        let overlaps = pixels().filter(|&(x, y)| drawn.get(x, y) > 1).count();
        self.holes = Some(holes as u64);
        self.overlaps = Some(overlaps as u64);
    }
}
