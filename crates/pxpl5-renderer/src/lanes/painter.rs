//! Steps for triangles of all widths: the values of expressions for a vector of pixels, the depth test, and the stores.

use super::columns::Values;
use super::enable::Enable;
use super::shape::Shape;
use crate::simd::SimdVector;
use pxpl5_wire::{Linear, Word};

/// Values of a linear expression at a vector of adjacent pixels. `step` is the increase of each value from this vector
/// to the next vector on the right.
#[derive(Clone, Copy)]
pub(super) struct Walk<V> {
    pub(super) value: V,
    pub(super) step: V,
}

impl<V: SimdVector> Walk<V> {
    #[inline(always)]
    pub(super) fn start(e: &Linear, x: i32, y: i32) -> Self {
        Self { value: V::ramp(e.at(x, y), e.a), step: V::splat(e.a.wrapping_mul(V::LANES as i32)) }
    }

    /// Returns the values for a vector that covers [four](crate::simd::FOUR) adjacent pixels in each of several rows.
    /// The value is `first` at the first pixel, and grows by `a` for each column and by `b` for each row.
    ///
    /// `step` is 0, because such a vector is at least as wide as the triangle.
    #[inline(always)]
    pub(super) fn fours(first: i32, a: i32, b: i32) -> Self {
        Self { value: V::ramp_of_fours(first, a, b), step: V::splat(0) }
    }

    /// Returns the values at the same columns some rows below. `b` is the increase of the expression over these rows.
    #[inline(always)]
    pub(super) fn below(&self, b: i32) -> Self {
        Self { value: self.value.add(V::splat(b)), step: self.step }
    }

    #[inline(always)]
    pub(super) fn advance(&mut self) {
        self.value = self.value.add(self.step);
    }
}

/// A way to store surface values (colour or normal) in the pixels that pass the depth test.
pub(super) trait PaintTriangle {
    /// Sets the colour of the next triangle. Has no effect if colours are interpolated.
    fn begin(&mut self, colour: Word);
    /// Stores the values of `walks` in the pixels of a vector for which `mask` is true. `at` is the index of the
    /// vector's first pixel.
    fn store<V: SimdVector, S: Shape>(&mut self, walks: &[Walk<V>; 3], at: usize, mask: V::Mask);
}

pub(super) struct TrianglePainter<'a, P> {
    /// Column and row of the array's upper left pixel in the picture.
    pub(super) origin: [i32; 2],
    pub(super) z_shift: u8,
    pub(super) z: &'a mut Values,
    pub(super) paint: P,
    pub(super) enable: &'a mut Enable,
}

pub(super) struct DepthTest<V: SimdVector> {
    pub(super) old: V,
    pub(super) new: V,
    pub(super) mask: V::Mask,
}

impl<P: PaintTriangle> TrianglePainter<'_, P> {
    /// Tests the pixels of a vector. A pixel passes if no edge expression is negative, and the triangle is nearer than
    /// the stored depth.
    #[inline(always)]
    pub(super) fn test<V: SimdVector, S: Shape>(
        &self,
        at: usize,
        [p, q, r]: [Walk<V>; 3],
        depth: Walk<V>,
    ) -> DepthTest<V> {
        let old = S::load::<V>(self.z, at);
        let new = depth.value.shift_right(self.z_shift.into());
        DepthTest { old, new, mask: p.value.or(q.value).or(r.value).passes(new, old) }
    }
}
