//! Fast drawing of spheres, row by row.

use super::columns::Values;
use super::ellipse::{Ellipse, along_row};
use super::roots::square_root_24;
use crate::array::PIXELS;
use crate::command::SphereBody;
use crate::isa::QUADRATIC_BITS;
use crate::simd::{SimdVector, VectorKernel};
use pxpl5_wire::Linear;
use pxpl5_wire::format::{COLOUR_FRACTION_BITS, NORMAL_BITS, NORMAL_FRACTION_BITS};

const WIDTH: usize = 128;

/// A sphere to draw. Its expressions have the upper left pixel of the array as origin of coordinates.
pub(super) struct DrawSphere<'a, P> {
    /// Silhouette and depth of the sphere. The two shifts are adapted to the number of bits of square roots in the
    /// layout.
    pub(super) body: SphereBody,
    pub(super) root_bits: u8,
    pub(super) z_shift: u8,
    pub(super) z: &'a mut Values,
    /// Scratch bit field for the square root, in all pixels. Its final content must equal its content after the
    /// command's program.
    pub(super) root: &'a mut Values,
    pub(super) temporary: &'a mut Values,
    pub(super) paint: P,
    /// Enable register, in which all pixels are disabled at the start. `None` if no later instruction reads Enable.
    pub(super) enable: Option<&'a mut [u8; PIXELS]>,
}

/// A way to store surface values (colour or normal) in the pixels of a sphere that pass the depth test.
pub(super) trait PaintSphere {
    /// Stores colours or normals in the pixels of row `y`, from column `left` on, for which `pass` is all ones.
    ///
    /// At the start, `temporary` holds the new depths. At the end, it must hold the same content as after the command's
    /// program.
    fn store(&mut self, left: usize, y: usize, roots: &[u32], pass: &[u32], temporary: &mut [u32]);
}

impl<P: PaintSphere> VectorKernel for DrawSphere<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run<V: SimdVector>(mut self) {
        let ellipse = Ellipse::where_positive(&self.body.silhouette);
        for y in ellipse.rows() {
            let columns = ellipse.columns(y);
            if !columns.is_empty() {
                self.row(y, columns.start, columns.len());
            }
        }
    }
}

impl<P: PaintSphere> DrawSphere<'_, P> {
    #[inline(always)]
    fn row(&mut self, y: usize, left: usize, n: usize) {
        let inside = &mut [0; WIDTH][..n];
        let roots = &mut [0; WIDTH][..n];
        self.roots(y, left, inside, roots);
        let at = y * WIDTH + left;
        let new = &mut [0; WIDTH][..n];
        let pass = &mut [0; WIDTH][..n];
        // Depth test. The new depth is the depth of the plane minus the root.
        let first = self.body.depth.at(left as i32, y as i32);
        let z = &mut self.z.0[at..at + n];
        for i in 0..n {
            let depth = first.wrapping_add(self.body.depth.a.wrapping_mul(i as i32)) as u32;
            new[i] = depth.wrapping_sub(roots[i] << self.body.depth_shift) >> self.z_shift;
            pass[i] = inside[i] & 0_u32.wrapping_sub(u32::from(new[i] < z[i]));
            z[i] = select(pass[i], new[i], z[i]);
        }
        self.paint.store(left, y, roots, pass, new);
        blend(&mut self.root.0[at..at + n], roots, inside);
        blend(&mut self.temporary.0[at..at + n], new, inside);
        if let Some(enable) = &mut self.enable {
            for (enable, pass) in enable[at..at + n].iter_mut().zip(pass.iter()) {
                *enable = *pass as u8;
            }
        }
    }

    /// Computes a mask of the pixels inside the silhouette, and the square root at each pixel. The radicand is the
    /// silhouette expression without its lowest `root_shift` bits.
    #[inline(always)]
    fn roots(&self, y: usize, left: usize, inside: &mut [u32], roots: &mut [u32]) {
        let (x, one) = along_row(&self.body.silhouette, y);
        let mask = (1_u32 << (2 * self.root_bits)) - 1;
        for (i, (inside, root)) in inside.iter_mut().zip(roots).enumerate() {
            let at = (left + i) as i64;
            let q = self.body.silhouette.xx.wrapping_mul(at).wrapping_add(x).wrapping_mul(at).wrapping_add(one);
            *inside = !((q << (64 - QUADRATIC_BITS) >> 63) as u32);
            *root = square_root_24((q >> self.body.root_shift) as u32 & mask);
        }
    }
}

#[inline(always)]
const fn select(mask: u32, new: u32, old: u32) -> u32 {
    new & mask | old & !mask
}

#[inline(always)]
fn blend(old: &mut [u32], new: &[u32], mask: &[u32]) {
    for ((old, new), mask) in old.iter_mut().zip(new).zip(mask) {
        *old = select(*mask, *new, *old);
    }
}

/// A painter of interpolated colours. The colour is the sum of a linear expression and a multiple of the square root.
pub(super) struct PaintGouraudSphere<'a> {
    pub(super) components: [Linear; 3],
    pub(super) factors: [i16; 3],
    pub(super) root_bits: u8,
    pub(super) colour: &'a mut Values,
}

impl PaintSphere for PaintGouraudSphere<'_> {
    #[inline(always)]
    fn store(&mut self, left: usize, y: usize, roots: &[u32], pass: &[u32], temporary: &mut [u32]) {
        let n = pass.len();
        let mut rgb = [0_u32; WIDTH];
        let mut product = [0; WIDTH];
        for (linear, factor) in self.components.iter().zip(self.factors) {
            let first = linear.at(left as i32, y as i32);
            for i in 0..n {
                // Multiply the root's upper bits by the factor, and keep the same bits as the multiplication of the
                // program.
                let upper = (roots[i] >> (self.root_bits - 8)) as i32;
                let low = upper * i32::from(factor);
                let plane = first.wrapping_add(linear.a.wrapping_mul(i as i32)) >> COLOUR_FRACTION_BITS;
                let sum = (low >> 8).wrapping_add(plane) << 22 >> 22;
                rgb[i] = rgb[i] << 8 | sum.clamp(0, 255) as u32;
                product[i] = (sum << 8 | low & 255) as u32 & 0x3_ffff;
            }
        }
        let at = y * WIDTH + left;
        // Store the colours. Then store the product, which replaces the low bits of the new depth in the scratch
        // memory.
        blend(&mut self.colour.0[at..at + n], &rgb[..n], pass);
        for i in 0..n {
            let after = temporary[i] & !0x3_ffff | product[i];
            temporary[i] = select(pass[i], after, temporary[i]);
        }
    }
}

/// A painter of the object's colour and of interpolated normals. Two linear expressions give x and y of the normal, and
/// the square root gives z.
pub(super) struct PaintPhongSphere<'a> {
    pub(super) components: [Linear; 2],
    pub(super) root_bits: u8,
    pub(super) normal: [&'a mut Values; 3],
    pub(super) constant: u32,
    pub(super) colour: &'a mut Values,
}

impl PaintSphere for PaintPhongSphere<'_> {
    #[inline(always)]
    fn store(&mut self, left: usize, y: usize, roots: &[u32], pass: &[u32], _: &mut [u32]) {
        let at = y * WIDTH + left;
        let n = pass.len();
        // x and y are linear on the screen.
        for (linear, column) in self.components.iter().zip(self.normal.iter_mut()) {
            let first = linear.at(left as i32, y as i32);
            let old = &mut column.0[at..at + n];
            for i in 0..n {
                let value = first.wrapping_add(linear.a.wrapping_mul(i as i32)) as u32;
                let bits = value >> NORMAL_FRACTION_BITS & ((1 << NORMAL_BITS) - 1);
                old[i] = select(pass[i], bits, old[i]);
            }
        }
        let z = &mut self.normal[2].0[at..at + n];
        let colour = &mut self.colour.0[at..at + n];
        // z consists of the upper bits of the root.
        for i in 0..n {
            z[i] = select(pass[i], roots[i] >> (self.root_bits - 10), z[i]);
        }
        for i in 0..n {
            colour[i] = select(pass[i], self.constant, colour[i]);
        }
    }
}
