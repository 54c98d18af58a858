//! Screen triangles: what is kept between transform and set-up.

use crate::newton::ROUND_DOUBLE;
use crate::outline::{Outline, SUBPIXELS, extent};
use crate::plane::Planes;
use crate::stats::SetupStats;
use crate::view::Viewport;
use pxpl5_wire::{Linear, format};

/// Vertices of a screen triangle lie at most this many pixels from pixel (0, 0), along x and along y.
///
/// Twice the area of a triangle inside the square of side 2 x 4096 px is at most `(2^17)^2 = 2^34` in units of
/// 1/256 px, so an edge expression (in 1/16 of that) is at most 2^30 at any pixel inside the square, and no
/// sum leaves 32 bits.
pub const GUARD_PIXELS: i32 = 4096;

/// Depth of the near plane in pixel depth with [`format::Z_FRACTION_BITS`] fraction bits: 8 units of pixel depth.
///
/// The margin at both ends is larger than the rounding error of a plane on a [`crate::MAX_PICTURE`] picture
/// (below 1,026), so that a depth never wraps from near to far.
pub const DEPTH_NEAR: u32 = 8 * DEPTH_ONE;

/// Depth of the far plane in the same units.
pub const DEPTH_FAR: u32 = u32::MAX - 8 * DEPTH_ONE;

/// One unit of pixel depth in fractions.
pub(crate) const DEPTH_ONE: u32 = 1 << format::Z_FRACTION_BITS;

/// 1.5 * 2^23: adding it rounds to an integer, to even, for absolute values below 2^22.
const ROUND: f32 = 12_582_912.0;

/// Nearest integer of a value below 2^22 in absolute value.
#[inline(always)]
pub(crate) fn rounded(value: f32) -> i32 {
    ((value + ROUND).to_bits() as i32).wrapping_sub(ROUND.to_bits() as i32)
}

/// Integer nearest to a value and a whole number below 2^20, rounded once.
#[inline(always)]
pub(crate) fn rounded_sum(value: f32, whole: f32) -> i32 {
    ((value + (whole + ROUND)).to_bits() as i32).wrapping_sub(ROUND.to_bits() as i32)
}

/// A lit colour of 0 to 255 * 256 in whole 1/256 of a unit.
#[inline(always)]
pub(crate) fn colour_fixed(colour: f32) -> u16 {
    rounded(colour) as u16
}

/// A component of a normal in 1/[`NORMAL_UNIT`].
#[inline(always)]
pub(crate) fn normal_fixed(component: f32) -> i16 {
    rounded(component * f32::from(NORMAL_UNIT)) as i16
}

/// What the reciprocal of w is multiplied by for depths: the range of depths, rounded to a single.
pub(crate) const DEPTH_SCALE: f32 = (DEPTH_FAR - DEPTH_NEAR) as f32;

/// Depth in fixed point from units beyond near, to the nearest unit, to even between two; what lies outside near and far is
/// clamped, NaN is near.
#[allow(clippy::manual_clamp, reason = "`clamp` would leave a NaN, which is to be near")]
#[inline(always)]
pub(crate) fn depth_fixed(beyond_near: f64) -> u32 {
    const RANGE: f64 = (DEPTH_FAR - DEPTH_NEAR) as f64;
    let scaled = beyond_near.max(0.0).min(RANGE);
    (scaled + (ROUND_DOUBLE + DEPTH_NEAR as f64)).to_bits() as u32
}

/// A triangle on the screen with what its surface needs, `A` for each corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScreenTriangle<A> {
    /// Corners, depths and the regions touched.
    pub outline: Outline,
    /// Colours or normals of the corners, in the outline's order.
    pub surface: A,
}

/// Lit colours of the corners for Gouraud shading: red, green, blue in 1/256 of a colour unit, 0 to 255 * 256.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LitColours(pub [[u16; 3]; 3]);

/// Normals of the corners in eye coordinates for Phong shading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceNormals {
    /// x, y, z of each corner's normal in 1/2^14.
    pub normals: [[i16; 3]; 3],
    /// Red, green, blue of the whole triangle: its first corner's colour.
    pub colour: [u8; 3],
}

/// A value of 1.0 in [`SurfaceNormals::normals`].
pub const NORMAL_UNIT: i16 = 1 << 14;

/// The expressions of a Gouraud triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GouraudTriangle {
    /// A pixel is covered where all three are at least 0.
    pub edges: [Linear; 3],
    /// Depth with [`format::Z_FRACTION_BITS`] fraction bits.
    pub z: Linear,
    /// Red, green and blue with [`format::COLOUR_FRACTION_BITS`] fraction bits.
    pub rgb: [Linear; 3],
}

/// The expressions of a Phong triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PhongTriangle {
    /// A pixel is covered where all three are at least 0.
    pub edges: [Linear; 3],
    /// Depth with [`format::Z_FRACTION_BITS`] fraction bits.
    pub z: Linear,
    /// x, y, z of the normal in eye coordinates with [`format::NORMAL_FRACTION_BITS`] fraction bits below
    /// [`format::NORMAL_ONE_BITS`].
    pub normal: [Linear; 3],
    /// Red, green and blue of the whole triangle, 0 to 255 each.
    pub colour: [u8; 3],
}

impl Outline {
    /// The expressions of a triangle with these colours at its corners, in the expressions' units.
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

    /// The expressions of a triangle with these normals at its corners, in the expressions' units.
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

    /// The edges at the pixels of the picture.
    #[inline(always)]
    fn picture_edges(&self, viewport: &Viewport) -> [Linear; 3] {
        let [a, b, c] = self.edges();
        [for_rows(a, viewport), for_rows(b, viewport), for_rows(c, viewport)]
    }

    /// The planes through the corners' depths and three more integers of each, at the picture's pixels.
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

    /// The picture's pixel, in frame lines, nearest to the middle of the bounding box: planes are most exact there.
    #[inline(always)]
    fn middle(&self, viewport: &Viewport) -> [i32; 2] {
        [middle_pixel(&self.x, viewport.grid().width), middle_pixel(&self.y, viewport.frame_lines())]
    }
}

/// One of the three numbers that each corner has.
#[inline(always)]
fn component([a, b, c]: &[[f32; 3]; 3], number: usize) -> [f64; 3] {
    [f64::from(a[number]), f64::from(b[number]), f64::from(c[number])]
}

/// The pixel in the middle of what a picture of `size` pixels shows between the outermost corners, along one axis.
#[inline(always)]
fn middle_pixel(corners: &[i32; 3], size: u32) -> i32 {
    let [low, high] = extent(corners);
    let last = size as i32 * SUBPIXELS - 1;
    (low.clamp(0, last) + high.clamp(0, last)) / (2 * SUBPIXELS)
}

/// An expression over the frame's pixels, restated for the rows of the picture: exactly the same values.
#[inline(always)]
pub(crate) fn for_rows(frame: Linear, viewport: &Viewport) -> Linear {
    Linear {
        a: frame.a,
        b: frame.b.wrapping_mul(viewport.line_step() as i32),
        c: frame.c.wrapping_add(frame.b.wrapping_mul(viewport.first_line() as i32)),
    }
}

impl<A> ScreenTriangle<A> {
    /// The edge expressions alone, at the picture's pixels.
    #[must_use]
    pub fn edges(&self, viewport: &Viewport) -> [Linear; 3] {
        self.outline.picture_edges(viewport)
    }
}

impl ScreenTriangle<LitColours> {
    /// Computes the expressions for the picture that the triangle was transformed for.
    #[must_use]
    pub fn gouraud(&self, viewport: &Viewport, stats: &mut SetupStats) -> GouraudTriangle {
        let [a, b, c] = &self.surface.0;
        let colours = [values(a, colour_value), values(b, colour_value), values(c, colour_value)];
        self.outline.gouraud(colours, viewport, stats)
    }
}

impl ScreenTriangle<SurfaceNormals> {
    /// Computes the expressions for the picture that the triangle was transformed for.
    #[must_use]
    pub fn phong(&self, viewport: &Viewport, stats: &mut SetupStats) -> PhongTriangle {
        let [a, b, c] = &self.surface.normals;
        let normals = [values(a, normal_value), values(b, normal_value), values(c, normal_value)];
        self.outline.phong(normals, self.surface.colour, viewport, stats)
    }
}

/// Written out, because a closure over an array is not always inlined.
#[inline(always)]
fn values<T: Copy>([a, b, c]: &[T; 3], value: impl Fn(T) -> f32) -> [f32; 3] {
    [value(*a), value(*b), value(*c)]
}

/// A colour in the expression's units, exact. The half unit rounds when the renderer cuts the fraction off, and keeps
/// 0 and 255 half a unit away from wrapping, far more than a plane's rounding error.
#[inline(always)]
pub(crate) fn colour_value(colour: u16) -> f32 {
    const SCALE: u32 = 1 << (format::COLOUR_FRACTION_BITS - 8);
    const HALF: u32 = 1 << (format::COLOUR_FRACTION_BITS - 1);
    (u32::from(colour) * SCALE + HALF) as f32
}

/// A component of a normal in the expression's units, exact, with half a unit for rounding.
#[inline(always)]
pub(crate) fn normal_value(component: i16) -> f32 {
    const SCALE: i32 = (1 << (format::NORMAL_ONE_BITS + format::NORMAL_FRACTION_BITS)) / NORMAL_UNIT as i32;
    (i32::from(component) * SCALE) as f32 + NORMAL_HALF
}

/// Half a unit of a normal's component.
pub(crate) const NORMAL_HALF: f32 = (1 << (format::NORMAL_FRACTION_BITS - 1)) as f32;
