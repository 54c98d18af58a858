//! How the pixels of a vector lie in the array.

use super::columns::Values;
use crate::simd::SimdVector;

/// An arrangement of a vector's pixels from a first one on.
pub(super) trait Shape {
    fn load<V: SimdVector>(column: &Values, at: usize) -> V;
    /// Overwrites where the mask is true; `old` is what pixels hold.
    fn store<V: SimdVector>(new: V, mask: V::Mask, old: V, column: &mut Values, at: usize);
}

/// In one row.
pub(super) struct InRow;

impl Shape for InRow {
    #[inline(always)]
    fn load<V: SimdVector>(column: &Values, at: usize) -> V {
        V::load(&column.0[at..])
    }

    #[inline(always)]
    fn store<V: SimdVector>(new: V, mask: V::Mask, old: V, column: &mut Values, at: usize) {
        new.store(mask, old, &mut column.0[at..]);
    }
}

/// Four in a row, the next ones below.
pub(super) struct InFours;

impl Shape for InFours {
    #[inline(always)]
    fn load<V: SimdVector>(column: &Values, at: usize) -> V {
        V::load_fours(&column.0[at..])
    }

    #[inline(always)]
    fn store<V: SimdVector>(new: V, mask: V::Mask, old: V, column: &mut Values, at: usize) {
        new.store_fours(mask, old, &mut column.0[at..]);
    }
}
