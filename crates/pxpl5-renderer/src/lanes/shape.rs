//! Arrangements of the pixels of one vector in the array.

use super::columns::Values;
use crate::simd::SimdVector;

pub(super) trait Shape {
    fn load<V: SimdVector>(column: &Values, at: usize) -> V;
    /// Stores the values `new` in the pixels for which `mask` is true. `old` must hold the current values of the
    /// pixels.
    fn store<V: SimdVector>(new: V, mask: V::Mask, old: V, column: &mut Values, at: usize);
}

/// Arrangement of the pixels side by side in one row.
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

/// Arrangement of the pixels in groups of four adjacent pixels, one group below the other.
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
