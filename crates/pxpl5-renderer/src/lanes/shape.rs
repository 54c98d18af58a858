//! Arrangements of a vector's pixels in the array.

use super::columns::Values;
use crate::simd::SimdVector;

/// An arrangement of a vector's pixels, relative to the first pixel.
pub(super) trait Shape {
    fn load<V: SimdVector>(column: &Values, at: usize) -> V;
    /// Overwrites the pixels where the mask is true; `old` is their current content.
    fn store<V: SimdVector>(new: V, mask: V::Mask, old: V, column: &mut Values, at: usize);
}

/// Pixels of a vector side by side in one row.
pub(super) struct SingleRow;

impl Shape for SingleRow {
    #[inline(always)]
    fn load<V: SimdVector>(column: &Values, at: usize) -> V {
        V::load(&column.0[at..])
    }

    #[inline(always)]
    fn store<V: SimdVector>(new: V, mask: V::Mask, old: V, column: &mut Values, at: usize) {
        new.store(mask, old, &mut column.0[at..]);
    }
}

/// Pixels of a vector in groups of four: each group lies below the previous one.
pub(super) struct QuadRows;

impl Shape for QuadRows {
    #[inline(always)]
    fn load<V: SimdVector>(column: &Values, at: usize) -> V {
        V::load_fours(&column.0[at..])
    }

    #[inline(always)]
    fn store<V: SimdVector>(new: V, mask: V::Mask, old: V, column: &mut Values, at: usize) {
        new.store_fours(mask, old, &mut column.0[at..]);
    }
}
