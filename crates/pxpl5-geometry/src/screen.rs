//! Triangles on the screen: the result of the transform, from which linear expressions are computed.

use crate::newton::ROUND_DOUBLE;
use crate::outline::{Outline, SUBPIXELS, extent};
use crate::plane::Planes;
use crate::stats::SetupStats;
use crate::view::Viewport;
use pxpl5_wire::{Linear, format};

/// Largest distance of a screen triangle's vertex from pixel (0, 0), in pixels, along x and along y.
///
/// For a triangle inside the square of side 2 x 4096 px, twice the area is at most `(2^17)^2 = 2^34` in units of 1/256
/// square px. Edge expressions are in units of 1/16 square px. The values of edge expressions at any pixel inside the
/// square are therefore at most 2^30, and no sum exceeds 32 bits.
pub const GUARD_PIXELS: i32 = 4096;

/// Depth of the near plane, with [`format::Z_FRACTION_BITS`] fraction bits: 8 units of the pixels' 24-bit depth.
///
/// At both ends of the range, 8 units are unused. This margin is larger than the rounding error of a plane on a picture
/// of [`crate::MAX_PICTURE`]. A depth therefore never wraps around from near to far.
pub const DEPTH_NEAR: u32 = 8 * DEPTH_ONE;

/// Depth of the far plane, in the units of [`DEPTH_NEAR`].
pub const DEPTH_FAR: u32 = u32::MAX - 8 * DEPTH_ONE;

pub(crate) const DEPTH_ONE: u32 = 1 << format::Z_FRACTION_BITS;

/// The constant 1.5 * 2^23. The addition of this constant rounds a number below 2^22 to an integer, ties to even.
const ROUND: f32 = 12_582_912.0;

#[inline(always)]
pub(crate) fn rounded(value: f32) -> i32 {
    ((value + ROUND).to_bits() as i32).wrapping_sub(ROUND.to_bits() as i32)
}

/// Returns the integer nearest to `value + whole`, with only one rounding. `whole` must be an integer below 2^20.
#[inline(always)]
pub(crate) fn rounded_sum(value: f32, whole: f32) -> i32 {
    ((value + (whole + ROUND)).to_bits() as i32).wrapping_sub(ROUND.to_bits() as i32)
}

/// Rounds a component of a lit colour, 0 to 255 * 256, to an integer.
#[inline(always)]
pub(crate) fn colour_fixed(colour: f32) -> u16 {
    rounded(colour) as u16
}

/// Rounds a component of a normal to an integer, in units of 1/[`NORMAL_UNIT`].
#[inline(always)]
pub(crate) fn normal_fixed(component: f32) -> i16 {
    rounded(component * f32::from(NORMAL_UNIT)) as i16
}

pub(crate) const DEPTH_SCALE: f32 = (DEPTH_FAR - DEPTH_NEAR) as f32;

/// Converts a depth to fixed point. `beyond_near` is the distance from the near plane in fixed-point units.
///
/// The depth is rounded to the nearest unit, ties to even, and limited to the range from near to far. NaN gives the
/// near plane.
#[allow(clippy::manual_clamp, reason = "`clamp` would leave a NaN, which is to be near")]
#[inline(always)]
pub(crate) fn depth_fixed(beyond_near: f64) -> u32 {
    const RANGE: f64 = (DEPTH_FAR - DEPTH_NEAR) as f64;
    let scaled = beyond_near.max(0.0).min(RANGE);
    (scaled + (ROUND_DOUBLE + DEPTH_NEAR as f64)).to_bits() as u32
}

/// A triangle on the screen, with colours or normals of type `A` for its corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScreenTriangle<A> {
    /// Corners and depths of the triangle, and the regions that the triangle touches.
    pub outline: Outline,
    /// Colours or normals of the corners, in the order of the outline's corners.
    pub surface: A,
}

/// Lit colours of three corners for Gouraud shading: red, green and blue, 0 to 255 * 256 each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VertexColours(pub [[u16; 3]; 3]);

/// Normals of three corners in eye coordinates, for Phong shading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceNormals {
    /// x, y and z of each corner's normal, in units of 1/2^14.
    pub normals: [[i16; 3]; 3],
    /// Red, green and blue of the whole triangle, from its first corner.
    pub colour: [u8; 3],
}

/// The length 1.0 in the units of [`SurfaceNormals::normals`].
pub const NORMAL_UNIT: i16 = 1 << 14;

/// The linear expressions of a Gouraud triangle, over the columns and rows of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GouraudTriangle {
    /// Edge expressions. A pixel is covered if all three values are at least 0.
    pub edges: [Linear; 3],
    /// Depth with [`format::Z_FRACTION_BITS`] fraction bits.
    pub z: Linear,
    /// Red, green and blue with [`format::COLOUR_FRACTION_BITS`] fraction bits.
    pub rgb: [Linear; 3],
}

/// The linear expressions of a Phong triangle, over the columns and rows of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PhongTriangle {
    /// Edge expressions. A pixel is covered if all three values are at least 0.
    pub edges: [Linear; 3],
    /// Depth with [`format::Z_FRACTION_BITS`] fraction bits.
    pub z: Linear,
    /// x, y and z of the normal in eye coordinates, with [`format::NORMAL_FRACTION_BITS`] fraction bits. A normal of
    /// length 1 has the integer part 2^[`format::NORMAL_ONE_BITS`].
    pub normal: [Linear; 3],
    /// Red, green and blue of the whole triangle, 0 to 255 each.
    pub colour: [u8; 3],
}

impl Outline {
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

    #[inline(always)]
    fn picture_edges(&self, viewport: &Viewport) -> [Linear; 3] {
        let [a, b, c] = self.edges();
        [for_rows(a, viewport), for_rows(b, viewport), for_rows(c, viewport)]
    }

    /// Returns the planes of the triangle: first depth, then three components of the colours or normals.
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

    /// Returns the pixel in the middle of the visible part of the triangle, at which planes are most exact. The y of
    /// this pixel counts lines of the video frame.
    #[inline(always)]
    fn middle(&self, viewport: &Viewport) -> [i32; 2] {
        [middle_pixel(&self.x, viewport.grid().width), middle_pixel(&self.y, viewport.frame_lines())]
    }
}

#[inline(always)]
fn component([a, b, c]: &[[f32; 3]; 3], number: usize) -> [f64; 3] {
    [f64::from(a[number]), f64::from(b[number]), f64::from(c[number])]
}

#[inline(always)]
fn middle_pixel(corners: &[i32; 3], size: u32) -> i32 {
    let [low, high] = extent(corners);
    let last = size as i32 * SUBPIXELS - 1;
    (low.clamp(0, last) + high.clamp(0, last)) / (2 * SUBPIXELS)
}

/// Converts an expression in lines of the video frame (the whole screen) to an expression in rows of the picture. The
/// picture of a field has only every second line. The value at each pixel stays the same.
#[inline(always)]
pub(crate) fn for_rows(frame: Linear, viewport: &Viewport) -> Linear {
    Linear {
        a: frame.a,
        b: frame.b.wrapping_mul(viewport.line_step() as i32),
        c: frame.c.wrapping_add(frame.b.wrapping_mul(viewport.first_line() as i32)),
    }
}

impl<A> ScreenTriangle<A> {
    /// Returns the expressions of the three edges over the columns and rows of the picture.
    pub fn edges(&self, viewport: &Viewport) -> [Linear; 3] {
        self.outline.picture_edges(viewport)
    }
}

impl ScreenTriangle<VertexColours> {
    /// Computes the linear expressions of the triangle. `viewport` must be the viewport of the
    /// [`Transform`](crate::Transform) that made the triangle.
    pub fn gouraud(&self, viewport: &Viewport, stats: &mut SetupStats) -> GouraudTriangle {
        let [a, b, c] = &self.surface.0;
        let colours = [values(a, colour_value), values(b, colour_value), values(c, colour_value)];
        self.outline.gouraud(colours, viewport, stats)
    }
}

impl ScreenTriangle<SurfaceNormals> {
    /// Computes the linear expressions of the triangle. `viewport` must be the viewport of the
    /// [`Transform`](crate::Transform) that made the triangle.
    pub fn phong(&self, viewport: &Viewport, stats: &mut SetupStats) -> PhongTriangle {
        let [a, b, c] = &self.surface.normals;
        let normals = [values(a, normal_value), values(b, normal_value), values(c, normal_value)];
        self.outline.phong(normals, self.surface.colour, viewport, stats)
    }
}

/// Applies `value` to three numbers. The function makes three calls instead of mapping an array, because compilers do
/// not always inline the mapping.
#[inline(always)]
fn values<T: Copy>([a, b, c]: &[T; 3], value: impl Fn(T) -> f32) -> [f32; 3] {
    [value(*a), value(*b), value(*c)]
}

/// Converts a component of a colour to the fixed-point units of its plane.
///
/// The function adds half a unit, because the renderer truncates. The values of 0 and 255 are then half a unit away
/// from an overflow. The rounding error of a plane is much smaller.
#[inline(always)]
pub(crate) fn colour_value(colour: u16) -> f32 {
    const SCALE: u32 = 1 << (format::COLOUR_FRACTION_BITS - 8);
    const HALF: u32 = 1 << (format::COLOUR_FRACTION_BITS - 1);
    (u32::from(colour) * SCALE + HALF) as f32
}

/// Converts a component of a normal to the fixed-point units of its plane, with half a unit added for rounding.
#[inline(always)]
pub(crate) fn normal_value(component: i16) -> f32 {
    const SCALE: i32 = (1 << (format::NORMAL_ONE_BITS + format::NORMAL_FRACTION_BITS)) / NORMAL_UNIT as i32;
    (i32::from(component) * SCALE) as f32 + NORMAL_HALF
}

/// Half a unit of a normal's component. Truncation after the addition of this number rounds to the nearest unit.
pub(crate) const NORMAL_HALF: f32 = (1 << (format::NORMAL_FRACTION_BITS - 1)) as f32;
