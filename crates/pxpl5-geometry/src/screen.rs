//! Screen triangles: the result of the transform and the input of the set-up.

use crate::newton::ROUND_DOUBLE;
use crate::outline::{Outline, SUBPIXELS, extent};
use crate::plane::Planes;
use crate::stats::SetupStats;
use crate::view::Viewport;
use pxpl5_wire::{Linear, format};

/// Largest distance of a screen triangle's vertex from pixel (0, 0), in pixels, along x and along y.
///
/// Twice the area of a triangle inside the square of side 2 x 4096 px is at most `(2^17)^2 = 2^34` in units of 1/256
/// square px. So an edge expression (in units of 1/16) is at most 2^30 at any pixel inside the square, and no sum
/// exceeds 32 bits.
pub const GUARD_PIXELS: i32 = 4096;

/// Depth of the near plane, 8 units of pixel depth, with [`format::Z_FRACTION_BITS`] fraction bits.
///
/// The margin at both ends is larger than the rounding error of a plane on a [`crate::MAX_PICTURE`] picture (below
/// 1,026), so a depth never wraps from near to far.
pub const DEPTH_NEAR: u32 = 8 * DEPTH_ONE;

/// Depth of the far plane, in the units of [`DEPTH_NEAR`].
pub const DEPTH_FAR: u32 = u32::MAX - 8 * DEPTH_ONE;

/// One unit of pixel depth in the units of [`DEPTH_NEAR`].
pub(crate) const DEPTH_ONE: u32 = 1 << format::Z_FRACTION_BITS;

/// 1.5 * 2^23. A number below 2^22 in absolute value that is added to it is rounded to an integer, ties to even.
const ROUND: f32 = 12_582_912.0;

/// Returns the nearest integer of a number below 2^22 in absolute value.
#[inline(always)]
pub(crate) fn rounded(value: f32) -> i32 {
    ((value + ROUND).to_bits() as i32).wrapping_sub(ROUND.to_bits() as i32)
}

/// Returns the integer nearest to the sum of a number and an integer below 2^20, with a single rounding.
#[inline(always)]
pub(crate) fn rounded_sum(value: f32, whole: f32) -> i32 {
    ((value + (whole + ROUND)).to_bits() as i32).wrapping_sub(ROUND.to_bits() as i32)
}

/// Rounds a component of a lit colour, 0 to 255 * 256, to an integer in 1/256 of a colour unit.
#[inline(always)]
pub(crate) fn colour_fixed(colour: f32) -> u16 {
    rounded(colour) as u16
}

/// Rounds a component of a normal to units of 1/[`NORMAL_UNIT`].
#[inline(always)]
pub(crate) fn normal_fixed(component: f32) -> i16 {
    rounded(component * f32::from(NORMAL_UNIT)) as i16
}

/// Factor from the reciprocal of w to depths: the range of depths, rounded to single precision.
pub(crate) const DEPTH_SCALE: f32 = (DEPTH_FAR - DEPTH_NEAR) as f32;

/// Converts a depth, in units beyond the near plane, to fixed point.
///
/// The depth is rounded to the nearest unit, ties to even, and clamped to the range from near to far. NaN becomes near.
#[allow(clippy::manual_clamp, reason = "`clamp` would leave a NaN, which is to be near")]
#[inline(always)]
pub(crate) fn depth_fixed(beyond_near: f64) -> u32 {
    const RANGE: f64 = (DEPTH_FAR - DEPTH_NEAR) as f64;
    let scaled = beyond_near.max(0.0).min(RANGE);
    (scaled + (ROUND_DOUBLE + DEPTH_NEAR as f64)).to_bits() as u32
}

/// A triangle on the screen with surface values `A` for its corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScreenTriangle<A> {
    /// Corners, depths and touched regions.
    pub outline: Outline,
    /// Colours or normals of the corners, in the outline's order.
    pub surface: A,
}

/// Lit colours of the corners for Gouraud shading: red, green, blue in 1/256 of a colour unit, 0 to 255 * 256.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VertexColours(pub [[u16; 3]; 3]);

/// Normals of the corners in eye coordinates, for Phong shading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceNormals {
    /// x, y and z of each corner's normal, in units of 1/2^14.
    pub normals: [[i16; 3]; 3],
    /// Red, green and blue of the whole triangle, from its first corner.
    pub colour: [u8; 3],
}

/// The value 1.0 in the units of [`SurfaceNormals::normals`].
pub const NORMAL_UNIT: i16 = 1 << 14;

/// The expressions of a Gouraud triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GouraudTriangle {
    /// Edge expressions; a pixel is covered where all three are at least 0.
    pub edges: [Linear; 3],
    /// Depth with [`format::Z_FRACTION_BITS`] fraction bits.
    pub z: Linear,
    /// Red, green and blue with [`format::COLOUR_FRACTION_BITS`] fraction bits.
    pub rgb: [Linear; 3],
}

/// The expressions of a Phong triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PhongTriangle {
    /// Edge expressions; a pixel is covered where all three are at least 0.
    pub edges: [Linear; 3],
    /// Depth with [`format::Z_FRACTION_BITS`] fraction bits.
    pub z: Linear,
    /// x, y and z of the normal in eye coordinates, with [`format::NORMAL_FRACTION_BITS`] fraction bits; 1.0 has
    /// [`format::NORMAL_ONE_BITS`] bits.
    pub normal: [Linear; 3],
    /// Red, green and blue of the whole triangle, 0 to 255 each.
    pub colour: [u8; 3],
}

impl Outline {
    /// Returns the expressions of a triangle with these colours at its corners, in the expressions' units.
    #[inline(always)]
    pub(crate) fn gouraud(
        &self,
        colours: [[f32; 3]; 3],
        viewport: &Viewport,
        stats: &mut SetupStats,
    ) -> GouraudTriangle {
        let [z, red, green, blue] = self.planes(colours, viewport, stats);
        GouraudTriangle { edges: self.picture_edges(viewport), z, rgb: [red, green, blue] }
    }

    /// Returns the expressions of a triangle with these normals at its corners, in the expressions' units.
    #[inline(always)]
    pub(crate) fn phong(
        &self,
        normals: [[f32; 3]; 3],
        colour: [u8; 3],
        viewport: &Viewport,
        stats: &mut SetupStats,
    ) -> PhongTriangle {
        let [z, nx, ny, nz] = self.planes(normals, viewport, stats);
        PhongTriangle { edges: self.picture_edges(viewport), z, normal: [nx, ny, nz], colour }
    }

    /// Returns the edges as expressions over the pixels of the picture.
    #[inline(always)]
    fn picture_edges(&self, viewport: &Viewport) -> [Linear; 3] {
        let [a, b, c] = self.edges();
        [for_rows(a, viewport), for_rows(b, viewport), for_rows(c, viewport)]
    }

    /// Returns the planes through the corners' depths and through three more values of each corner, over the picture's
    /// pixels.
    #[inline(always)]
    fn planes(&self, corners: [[f32; 3]; 3], viewport: &Viewport, stats: &mut SetupStats) -> [Linear; 4] {
        let planes = Planes::for_outline(self, self.middle(viewport));
        let [za, zb, zc] = self.z;
        let depths = [f64::from(za), f64::from(zb), f64::from(zc)];
        [
            for_rows(planes.through(depths, stats), viewport),
            for_rows(planes.through(component(&corners, 0), stats), viewport),
            for_rows(planes.through(component(&corners, 1), stats), viewport),
            for_rows(planes.through(component(&corners, 2), stats), viewport),
        ]
    }

    /// Returns the picture's pixel, in frame lines, nearest to the middle of the bounding box. Planes are most exact
    /// there.
    #[inline(always)]
    fn middle(&self, viewport: &Viewport) -> [i32; 2] {
        [middle_pixel(&self.x, viewport.grid().width), middle_pixel(&self.y, viewport.frame_lines())]
    }
}

/// Returns one of the three values of each corner.
#[inline(always)]
fn component([a, b, c]: &[[f32; 3]; 3], number: usize) -> [f64; 3] {
    [f64::from(a[number]), f64::from(b[number]), f64::from(c[number])]
}

/// Returns the middle pixel, along one axis, of the part of the corners' range inside a picture of `size` pixels.
#[inline(always)]
fn middle_pixel(corners: &[i32; 3], size: u32) -> i32 {
    let [low, high] = extent(corners);
    let last = size as i32 * SUBPIXELS - 1;
    (low.clamp(0, last) + high.clamp(0, last)) / (2 * SUBPIXELS)
}

/// Converts an expression from frame lines to the rows of the picture. The values at the pixels stay exactly the same.
#[inline(always)]
pub(crate) fn for_rows(frame: Linear, viewport: &Viewport) -> Linear {
    Linear {
        a: frame.a,
        b: frame.b.wrapping_mul(viewport.line_step() as i32),
        c: frame.c.wrapping_add(frame.b.wrapping_mul(viewport.first_line() as i32)),
    }
}

impl<A> ScreenTriangle<A> {
    /// Returns the edge expressions over the picture's pixels.
    #[must_use]
    pub fn edges(&self, viewport: &Viewport) -> [Linear; 3] {
        self.outline.picture_edges(viewport)
    }
}

impl ScreenTriangle<VertexColours> {
    /// Computes the expressions for `viewport`, which must be the picture of the transform.
    #[must_use]
    pub fn gouraud(&self, viewport: &Viewport, stats: &mut SetupStats) -> GouraudTriangle {
        let [a, b, c] = &self.surface.0;
        let colours = [values(a, colour_value), values(b, colour_value), values(c, colour_value)];
        self.outline.gouraud(colours, viewport, stats)
    }
}

impl ScreenTriangle<SurfaceNormals> {
    /// Computes the expressions for `viewport`, which must be the picture of the transform.
    #[must_use]
    pub fn phong(&self, viewport: &Viewport, stats: &mut SetupStats) -> PhongTriangle {
        let [a, b, c] = &self.surface.normals;
        let normals = [values(a, normal_value), values(b, normal_value), values(c, normal_value)];
        self.outline.phong(normals, self.surface.colour, viewport, stats)
    }
}

/// Applies `value` to three numbers. Written out, since a closure over an array is not always inlined.
#[inline(always)]
fn values<T: Copy>([a, b, c]: &[T; 3], value: impl Fn(T) -> f32) -> [f32; 3] {
    [value(*a), value(*b), value(*c)]
}

/// Converts a colour exactly to the expression's units.
///
/// The added half unit makes the renderer's truncation a rounding. It also keeps 0 and 255 half a unit away from
/// wrapping, far more than a plane's rounding error.
#[inline(always)]
pub(crate) fn colour_value(colour: u16) -> f32 {
    const SCALE: u32 = 1 << (format::COLOUR_FRACTION_BITS - 8);
    const HALF: u32 = 1 << (format::COLOUR_FRACTION_BITS - 1);
    (u32::from(colour) * SCALE + HALF) as f32
}

/// Converts a component of a normal exactly to the expression's units, with half a unit added for rounding.
#[inline(always)]
pub(crate) fn normal_value(component: i16) -> f32 {
    const SCALE: i32 = (1 << (format::NORMAL_ONE_BITS + format::NORMAL_FRACTION_BITS)) / NORMAL_UNIT as i32;
    (i32::from(component) * SCALE) as f32 + NORMAL_HALF
}

/// Half a unit of a normal's component.
pub(crate) const NORMAL_HALF: f32 = (1 << (format::NORMAL_FRACTION_BITS - 1)) as f32;
