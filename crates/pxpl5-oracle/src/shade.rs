//! Colours at pixels: planes of colour, or normals that are lit when all is drawn.

use pxpl5_renderer::Shade;
use pxpl5_wire::Linear;
use pxpl5_wire::format::{COLOUR_FRACTION_BITS, NORMAL_BITS, NORMAL_FRACTION_BITS};

/// What a primitive leaves at a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Paint {
    /// What is seen: red, green, blue.
    Lit([u8; 3]),
    /// What is lit when all is drawn.
    Surface(Surface),
}

/// A piece of a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    /// x, y, z of the normal, each in 12 bits.
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

/// Largest cosine: 10 bits, of which 1024 would be 1.0.
const COSINE_MAX: i32 = 1023;

/// How often the cosine of a highlight is squared.
const SQUARINGS: usize = 5;

/// A colour component of a plane, as bits leave it.
pub(crate) fn component(plane: &Linear, x: i32, y: i32) -> u8 {
    (plane.at(x, y) >> COLOUR_FRACTION_BITS) as u8
}

/// A component of a normal, as bits leave it.
pub(crate) fn normal(plane: &Linear, x: i32, y: i32) -> i32 {
    two_s_complement(plane.at(x, y) >> NORMAL_FRACTION_BITS, NORMAL_BITS)
}

/// The low bits of a number, with their sign.
pub(crate) fn two_s_complement(value: i32, bits: u32) -> i32 {
    value << (32 - bits) >> (32 - bits)
}

impl Surface {
    /// Its colour under a light, as the renderer's formula has it.
    fn lit(&self, shade: &Shade) -> [u8; 3] {
        let diffuse = self.cosine(shade.light);
        let highlight = (0..SQUARINGS).fold(self.cosine(shade.half), |cosine, _| (cosine * cosine) >> 10);
        let full = diffuse * i32::from(shade.diffuse) + (i32::from(shade.ambient) << 10);
        let intensity = (full >> 10).min(255);
        let white = (highlight * i32::from(shade.specular)) >> 10;
        self.colour.map(|component| (((i32::from(component) * intensity) >> 8) + white).min(255) as u8)
    }

    /// Cosine between the normal and a vector, 0 where they are turned from each other. A normal of zero counts as turned
    /// to it.
    fn cosine(&self, vector: [i16; 3]) -> i32 {
        let square: i32 = self.normal.iter().map(|n| n * n).sum();
        let length = square.isqrt();
        let products = self.normal.iter().zip(vector).map(|(n, v)| n * two_s_complement(v.into(), NORMAL_BITS));
        let along = two_s_complement(products.sum(), 2 * NORMAL_BITS).max(0);
        along.checked_div(length).map_or(COSINE_MAX, |quotient| quotient.min(COSINE_MAX))
    }
}
