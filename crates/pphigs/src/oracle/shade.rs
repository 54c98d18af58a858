//! Colours of pixels. With Phong shading, each pixel first stores the normal and the unlit colour of the visible
//! primitive. The lit colour is computed after all primitives are drawn.

use pxpl5_renderer::Shade;
use pxpl5_wire::Linear;
use pxpl5_wire::format::{COLOUR_FRACTION_BITS, NORMAL_BITS, NORMAL_FRACTION_BITS};

#[derive(Clone, Copy, Debug)]
pub(crate) enum Paint {
    /// The final colour: red, green and blue.
    Lit([u8; 3]),
    Surface(Surface),
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    /// x, y and z of the normal, each in 12 bits.
    pub(crate) normal: [i32; 3],
    pub(crate) colour: [u8; 3],
}

impl Paint {
    pub(crate) fn colour(self, shade: &Shade) -> [u8; 3] {
        match self {
            Self::Lit(colour) => colour,
            Self::Surface(surface) => surface.lit(shade),
        }
    }
}

/// Largest cosine, a number of 10 bits. The value 1024 would stand for 1.0.
const COSINE_MAX: i32 = 1023;

/// Number of times that the cosine of a highlight is squared, which makes the highlight small.
const SQUARINGS: usize = 5;

pub(crate) fn component(plane: &Linear, x: i32, y: i32) -> u8 {
    (plane.at(x, y) >> COLOUR_FRACTION_BITS) as u8
}

pub(crate) fn normal(plane: &Linear, x: i32, y: i32) -> i32 {
    two_s_complement(plane.at(x, y) >> NORMAL_FRACTION_BITS, NORMAL_BITS)
}

/// Returns the lowest `bits` bits of a number as a signed number.
pub(crate) fn two_s_complement(value: i32, bits: u32) -> i32 {
    value << (32 - bits) >> (32 - bits)
}

impl Surface {
    fn lit(&self, shade: &Shade) -> [u8; 3] {
        let diffuse = self.cosine(shade.light);
        let highlight = (0..SQUARINGS).fold(self.cosine(shade.half), |cosine, _| (cosine * cosine) >> 10);
        let full = diffuse * i32::from(shade.diffuse) + (i32::from(shade.ambient) << 10);
        let intensity = (full >> 10).min(255);
        let white = (highlight * i32::from(shade.specular)) >> 10;
        self.colour.map(|component| (((i32::from(component) * intensity) >> 8) + white).min(255) as u8)
    }

    /// Returns the cosine of the angle between the normal and a vector, in units of 1/1024. Returns 0 for an obtuse
    /// angle, and the largest cosine for a zero normal.
    fn cosine(&self, vector: [i16; 3]) -> i32 {
        let square: i32 = self.normal.iter().map(|n| n * n).sum();
        let length = square.isqrt();
        let products = self.normal.iter().zip(vector).map(|(n, v)| n * two_s_complement(v.into(), NORMAL_BITS));
        let along = two_s_complement(products.sum(), 2 * NORMAL_BITS).max(0);
        along.checked_div(length).map_or(COSINE_MAX, |quotient| quotient.min(COSINE_MAX))
    }
}
