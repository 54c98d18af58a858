//! Evaluation of the pipeline's expressions at pixels, in the renderer's formats.

use super::{HEIGHT, WIDTH};
use pxpl5_geometry::{
    GouraudTriangle, Light, RegionMask, ScreenTriangle, SetupStats, Transform, Triangle, VertexColours, Viewport,
};
use pxpl5_wire::{RegionGrid, RegionId, format};
use std::ops::Range;

/// Returns the number of the region that contains a pixel of the frame.
pub fn region_of(x: i32, y: i32) -> RegionId {
    let grid = RegionGrid::FRAME;
    let column = x as u32 / grid.region_width;
    let row = y as u32 / grid.region_height;
    RegionId((row * grid.columns() + column) as u16)
}

/// A screen triangle with its expressions on the whole frame.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    pub screen: ScreenTriangle<VertexColours>,
    pub planes: GouraudTriangle,
}

impl Piece {
    pub fn new(screen: ScreenTriangle<VertexColours>, stats: &mut SetupStats) -> Self {
        let planes = screen.gouraud(&Viewport::FRAME, stats);
        Self { screen, planes }
    }

    /// Returns the pieces of a triangle.
    pub fn of(transform: &Transform, triangle: &Triangle, stats: &mut SetupStats) -> Vec<Self> {
        let mut pieces = Vec::new();
        if transform.is_single() {
            transform.single_precision(triangle, stats, |screen, planes| pieces.push(Self { screen, planes }));
            return pieces;
        }
        let mut screen = Vec::new();
        transform.gouraud(triangle, &Light::NONE, stats, |t| screen.push(t));
        screen.into_iter().map(|t| Self::new(t, stats)).collect()
    }

    pub fn regions(&self) -> RegionMask {
        self.screen.outline.regions
    }

    pub fn inside_edges(&self, x: i32, y: i32) -> bool {
        self.planes.edges.iter().all(|e| e.at(x, y) >= 0)
    }

    /// Calls `draw` for each covered pixel of a touched region. The function tests all pixels of the bounding box.
    pub fn pixels(&self, mut draw: impl FnMut(i32, i32)) {
        let outline = &self.screen.outline;
        for y in pixels_between(&outline.y, HEIGHT) {
            for x in pixels_between(&outline.x, WIDTH) {
                if self.inside_edges(x, y) && self.regions().contains(region_of(x, y)) {
                    draw(x, y);
                }
            }
        }
    }

    /// Returns the stride between covered pixels at which errors are measured. All pixels of small triangles are
    /// measured, and about 2,000 pixels of large triangles.
    pub fn stride(&self) -> u64 {
        // Twice the area in 1/256 square px. A part of the triangle can be off the screen.
        let (_, twice_area) = self.exact_plane([0; 3], 0, 0);
        let pixels = (twice_area / 512).min(i128::from(WIDTH * HEIGHT));
        1 + pixels as u64 / 2000
    }

    /// Returns the depth that the renderer stores.
    pub fn depth(&self, x: i32, y: i32) -> u32 {
        self.planes.z.at(x, y) as u32 >> format::Z_FRACTION_BITS
    }

    /// Returns the colour component that the renderer stores.
    pub fn colour(&self, component: usize, x: i32, y: i32) -> u8 {
        (self.planes.rgb[component].at(x, y) >> format::COLOUR_FRACTION_BITS) as u8
    }

    /// Returns the exact value, as numerator and denominator, of the plane through three values at the corners in
    /// subpixels.
    pub fn exact_plane(&self, corners: [i128; 3], x: i32, y: i32) -> (i128, i128) {
        let outline = &self.screen.outline;
        let pixel = [16 * i128::from(x) + 8, 16 * i128::from(y) + 8];
        let [p, q, r] = [0, 1, 2].map(|i| [i128::from(outline.x[i]), i128::from(outline.y[i])]);
        let weights = [twice_area(q, r, pixel), twice_area(r, p, pixel), twice_area(p, q, pixel)];
        let sum = weights.iter().zip(corners).map(|(w, v)| w * v).sum();
        (sum, twice_area(p, q, r))
    }

    /// Returns the value of [`Self::exact_plane`] as a floating-point number.
    pub fn plane_value(&self, corners: [i128; 3], x: i32, y: i32) -> f64 {
        let (sum, area) = self.exact_plane(corners, x, y);
        sum as f64 / area as f64
    }

    pub fn depth_corners(&self) -> [i128; 3] {
        self.screen.outline.z.map(i128::from)
    }

    pub fn colour_corners(&self, component: usize) -> [i128; 3] {
        self.screen.surface.0.map(|c| i128::from(c[component]))
    }
}

/// Returns the pixels of a picture that a box around three corners can contain along one axis. Corners are in
/// subpixels.
fn pixels_between(corners: &[i32; 3], size: i32) -> Range<i32> {
    let first = corners.iter().min().map_or(0, |v| v >> 4);
    let last = corners.iter().max().map_or(0, |v| (v >> 4) + 1);
    first.max(0)..last.min(size)
}

fn twice_area(a: [i128; 2], b: [i128; 2], c: [i128; 2]) -> i128 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}
