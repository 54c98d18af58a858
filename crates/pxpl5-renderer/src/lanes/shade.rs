//! Fast execution of the shading command, row by row.
//!
//! The code follows the program of [`crate::Shade`] instruction by instruction. The scratch bit fields therefore have
//! the same values at the end as after the program.

use super::columns::Values;
use super::roots::{divide_10, square_root_24};
use crate::array::PIXELS;
use crate::command::{SPECULAR_SQUARINGS, Shade};
use crate::simd::{SimdVector, VectorKernel};

const WIDTH: usize = 128;

/// Number of bit fields that shading changes: the colour, and the scratch bit fields a, b, c, root, diffuse and
/// specular.
const RESULTS: usize = 7;

/// Shades all pixels whose depth differs from the depth of the far plane.
pub(super) struct ShadeAll<'a> {
    pub(super) shade: Shade,
    pub(super) far: u32,
    pub(super) z: &'a Values,
    pub(super) normal: [&'a Values; 3],
    pub(super) results: [&'a mut Values; RESULTS],
    /// Enable register, which receives the pixels that a primitive covers. `None` if no later instruction reads Enable.
    pub(super) enable: Option<&'a mut [u8; PIXELS]>,
}

impl VectorKernel for ShadeAll<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: SimdVector>(mut self) {
        for at in (0..PIXELS).step_by(WIDTH) {
            let mut covered = [0; WIDTH];
            for (covered, z) in covered.iter_mut().zip(&self.z.0[at..at + WIDTH]) {
                *covered = 0_u32.wrapping_sub(u32::from(*z != self.far));
            }
            if let Some(enable) = &mut self.enable {
                for (enable, covered) in enable[at..at + WIDTH].iter_mut().zip(&covered) {
                    *enable = *covered as u8;
                }
            }
            if covered.iter().any(|c| *c != 0) {
                self.row(at, &covered);
            }
        }
    }
}

impl ShadeAll<'_> {
    #[inline(always)]
    fn row(&mut self, at: usize, covered: &[u32; WIDTH]) {
        let mut out = [[0; WIDTH]; RESULTS];
        let [x, y, z] = [self.row_of(0, at), self.row_of(1, at), self.row_of(2, at)];
        let mut colour = [0; WIDTH];
        colour.copy_from_slice(&self.results[0].0[at..at + WIDTH]);
        // Shade all pixels of the row, covered or not, because only a loop without branches is vectorized.
        for i in 0..WIDTH {
            let pixel = shade_pixel(&self.shade, [x[i], y[i], z[i]], colour[i]);
            out[0][i] = pixel[0];
            out[1][i] = pixel[1];
            out[2][i] = pixel[2];
            out[3][i] = pixel[3];
            out[4][i] = pixel[4];
            out[5][i] = pixel[5];
            out[6][i] = pixel[6];
        }
        // Store only the covered pixels.
        for (column, new) in self.results.iter_mut().zip(&out) {
            let old = &mut column.0[at..at + WIDTH];
            for i in 0..WIDTH {
                old[i] = new[i] & covered[i] | old[i] & !covered[i];
            }
        }
    }

    /// Returns x, y or z (`component` 0, 1 or 2) of the normals of one row, whose first pixel has the index `at`.
    #[inline(always)]
    fn row_of(&self, component: usize, at: usize) -> [i32; WIDTH] {
        let mut out = [0; WIDTH];
        for (out, bits) in out.iter_mut().zip(&self.normal[component].0[at..at + WIDTH]) {
            *out = (*bits as i32) << 20 >> 20;
        }
        out
    }
}

#[inline(always)]
const fn twelve(v: i16) -> i32 {
    (v as i32) << 20 >> 20
}

#[inline(always)]
const fn insert(old: u32, low: u32, width: u32) -> u32 {
    let mask = (1 << width) - 1;
    old & !mask | low & mask
}

#[inline(always)]
fn shade_pixel(shade: &Shade, n: [i32; 3], colour: u32) -> [u32; RESULTS] {
    let square = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) as u32 & 0xff_ffff;
    let root = square_root_24(square);
    let (diffuse, _) = cosine(shade.light, n, root);
    let (specular, c) = cosine(shade.half, n, root);
    // The remainder of the root stays in `a`. A product of the cosines stays in `b`.
    let mut a = square - root * root;
    let mut b = (n[2] * twelve(shade.half[2])) as u32 & 0xff_ffff;
    let mut highlight = specular;
    // The squares go alternately to `a` and `b`, and replace only their low bits.
    for i in 0..SPECULAR_SQUARINGS {
        let square = highlight * highlight;
        highlight = square >> 10;
        if i.is_multiple_of(2) {
            a = insert(a, square, 20);
        } else {
            b = insert(b, square, 20);
        }
    }
    // Brightness of the object's colour.
    let light = diffuse * u32::from(shade.diffuse) + (u32::from(shade.ambient) << 10);
    b = insert(b, light, 19);
    let light = (light >> 10).min(255);
    // Brightness of the white highlight.
    let shine = highlight * u32::from(shade.specular);
    let c = insert(c, shine, 18);
    let mut rgb = 0;
    let mut shift = 16;
    for _ in 0..3 {
        let product = (colour >> shift & 255) * light;
        let sum = (product >> 8) + (shine >> 10);
        a = insert(a, product, 16);
        b = insert(b, sum, 9);
        rgb = rgb << 8 | sum.min(255);
        shift -= 8_u32.min(shift);
    }
    [rgb, a, b, c, root, insert(diffuse, light, 8), specular]
}

/// Returns the cosine and the final content of the bit field `c`. The cosine is 0 for surfaces that face away from
/// `vector`. The bit field holds the remainder of the division, and the sign of the product in bit 23.
#[inline(always)]
fn cosine(vector: [i16; 3], n: [i32; 3], root: u32) -> (u32, u32) {
    let dot = n[0] * twelve(vector[0]) + n[1] * twelve(vector[1]) + n[2] * twelve(vector[2]);
    let dot = dot << 8 >> 8;
    let (quotient, rest) = divide_10(dot.max(0) as u32, root);
    (quotient, rest | dot as u32 & 1 << 23)
}
