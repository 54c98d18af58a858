//! Vectors of x86-64.
//!
//! SAFETY of every `unsafe` block in this file: values of these types exist only inside [`super::avx2`] and
//! [`super::avx512`]. These functions run only on processors with the required features. Loads and stores go through
//! slices whose length is checked.

use super::{FOUR, ROW, SimdVector};
use std::arch::x86_64::*;

#[derive(Clone, Copy)]
pub(super) struct Avx2(__m256i);

impl SimdVector for Avx2 {
    const LANES: usize = 8;
    type Mask = __m256i;

    #[inline(always)]
    fn splat(value: i32) -> Self {
        Self(unsafe { _mm256_set1_epi32(value) })
    }

    #[inline(always)]
    fn ramp(first: i32, step: i32) -> Self {
        unsafe {
            let lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
            let steps = _mm256_mullo_epi32(lanes, _mm256_set1_epi32(step));
            Self(_mm256_add_epi32(_mm256_set1_epi32(first), steps))
        }
    }

    #[inline(always)]
    fn ramp_of_fours(first: i32, step: i32, down: i32) -> Self {
        unsafe {
            let columns = _mm256_setr_epi32(0, 1, 2, 3, 0, 1, 2, 3);
            let steps = _mm256_mullo_epi32(columns, _mm256_set1_epi32(step));
            let below = _mm_set1_epi32(first.wrapping_add(down));
            let rows = _mm256_setr_m128i(_mm_set1_epi32(first), below);
            Self(_mm256_add_epi32(rows, steps))
        }
    }

    #[inline(always)]
    fn load(from: &[u32]) -> Self {
        let from: &[u32; 8] = from.first_chunk().expect("a whole vector");
        Self(unsafe { _mm256_loadu_si256(from.as_ptr().cast()) })
    }

    #[inline(always)]
    fn load_fours(from: &[u32]) -> Self {
        let from: &[u32; ROW + FOUR] = from.first_chunk().expect("whole rows");
        unsafe {
            let upper = _mm_loadu_si128(from[..FOUR].as_ptr().cast());
            let lower = _mm_loadu_si128(from[ROW..][..FOUR].as_ptr().cast());
            Self(_mm256_setr_m128i(upper, lower))
        }
    }

    #[inline(always)]
    fn load_words(from: &[u64]) -> Self {
        let from: &[u64; 4] = from.first_chunk().expect("a whole vector");
        Self(unsafe { _mm256_loadu_si256(from.as_ptr().cast()) })
    }

    #[inline(always)]
    fn store_words(self, to: &mut [u64]) {
        let to: &mut [u64; 4] = to.first_chunk_mut().expect("a whole vector");
        unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), self.0) };
    }

    #[inline(always)]
    fn spread(bits: u64) -> Self {
        unsafe {
            let lanes = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            let bits = _mm256_and_si256(_mm256_set1_epi32(bits as i32), lanes);
            Self(_mm256_cmpeq_epi32(bits, lanes))
        }
    }

    #[inline(always)]
    fn bit(self, t: u32) -> Self {
        unsafe {
            let signs = _mm256_sll_epi32(self.0, _mm_cvtsi32_si128(31 - t as i32));
            Self(_mm256_srai_epi32::<31>(signs))
        }
    }

    #[inline(always)]
    fn signs(self) -> u32 {
        unsafe { _mm256_movemask_ps(_mm256_castsi256_ps(self.0)) as u32 }
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(unsafe { _mm256_add_epi32(self.0, other.0) })
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Self(unsafe { _mm256_or_si256(self.0, other.0) })
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Self(unsafe { _mm256_and_si256(self.0, other.0) })
    }

    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        Self(unsafe { _mm256_xor_si256(self.0, other.0) })
    }

    #[inline(always)]
    fn shift_right(self, by: u32) -> Self {
        Self(unsafe { _mm256_srl_epi32(self.0, _mm_cvtsi32_si128(by as i32)) })
    }

    #[inline(always)]
    fn shift_left(self, by: u32) -> Self {
        Self(unsafe { _mm256_sll_epi32(self.0, _mm_cvtsi32_si128(by as i32)) })
    }

    #[inline(always)]
    fn passes(self, new: Self, old: Self) -> __m256i {
        unsafe {
            let nearer = _mm256_cmpgt_epi32(old.0, new.0);
            _mm256_andnot_si256(_mm256_srai_epi32::<31>(self.0), nearer)
        }
    }

    #[inline(always)]
    fn any_of(a: __m256i, b: __m256i) -> bool {
        unsafe {
            let either = _mm256_or_si256(a, b);
            _mm256_testz_si256(either, either) == 0
        }
    }

    #[inline(always)]
    fn store(self, mask: __m256i, old: Self, to: &mut [u32]) {
        let to: &mut [u32; 8] = to.first_chunk_mut().expect("a whole vector");
        unsafe {
            let blended = _mm256_blendv_epi8(old.0, self.0, mask);
            _mm256_storeu_si256(to.as_mut_ptr().cast(), blended);
        }
    }

    #[inline(always)]
    fn store_fours(self, mask: __m256i, old: Self, to: &mut [u32]) {
        let to: &mut [u32; ROW + FOUR] = to.first_chunk_mut().expect("whole rows");
        unsafe {
            let blended = _mm256_blendv_epi8(old.0, self.0, mask);
            _mm_storeu_si128(to[..FOUR].as_mut_ptr().cast(), _mm256_castsi256_si128(blended));
            _mm_storeu_si128(to[ROW..][..FOUR].as_mut_ptr().cast(), _mm256_extracti128_si256::<1>(blended));
        }
    }

    #[inline(always)]
    fn store_mask(mask: __m256i, to: &mut [u8]) {
        let bits = unsafe { _mm256_movemask_ps(_mm256_castsi256_ps(mask)) };
        for (k, to) in to[..8].iter_mut().enumerate() {
            *to = 0_u8.wrapping_sub((bits >> k & 1) as u8);
        }
    }
}

#[derive(Clone, Copy)]
pub(super) struct Avx512(__m512i);

impl SimdVector for Avx512 {
    const LANES: usize = 16;
    type Mask = __mmask16;

    #[inline(always)]
    fn splat(value: i32) -> Self {
        Self(unsafe { _mm512_set1_epi32(value) })
    }

    #[inline(always)]
    fn ramp(first: i32, step: i32) -> Self {
        unsafe {
            let lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
            let steps = _mm512_mullo_epi32(lanes, _mm512_set1_epi32(step));
            Self(_mm512_add_epi32(_mm512_set1_epi32(first), steps))
        }
    }

    #[inline(always)]
    fn ramp_of_fours(first: i32, step: i32, down: i32) -> Self {
        unsafe {
            let columns = _mm512_setr_epi32(0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3);
            let rows = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
            let steps = _mm512_mullo_epi32(columns, _mm512_set1_epi32(step));
            let downs = _mm512_mullo_epi32(rows, _mm512_set1_epi32(down));
            Self(_mm512_add_epi32(_mm512_set1_epi32(first), _mm512_add_epi32(steps, downs)))
        }
    }

    #[inline(always)]
    fn load(from: &[u32]) -> Self {
        let from: &[u32; 16] = from.first_chunk().expect("a whole vector");
        Self(unsafe { _mm512_loadu_si512(from.as_ptr().cast()) })
    }

    #[inline(always)]
    fn load_fours(from: &[u32]) -> Self {
        let from: &[u32; 3 * ROW + FOUR] = from.first_chunk().expect("whole rows");
        let [upper, lower] = [&from[..ROW + FOUR], &from[2 * ROW..]];
        unsafe {
            Self(_mm512_inserti64x4::<1>(_mm512_castsi256_si512(Avx2::load_fours(upper).0), Avx2::load_fours(lower).0))
        }
    }

    #[inline(always)]
    fn load_words(from: &[u64]) -> Self {
        let from: &[u64; 8] = from.first_chunk().expect("a whole vector");
        Self(unsafe { _mm512_loadu_si512(from.as_ptr().cast()) })
    }

    #[inline(always)]
    fn store_words(self, to: &mut [u64]) {
        let to: &mut [u64; 8] = to.first_chunk_mut().expect("a whole vector");
        unsafe { _mm512_storeu_si512(to.as_mut_ptr().cast(), self.0) };
    }

    #[inline(always)]
    fn spread(bits: u64) -> Self {
        Self(unsafe { _mm512_movm_epi32(bits as __mmask16) })
    }

    #[inline(always)]
    fn bit(self, t: u32) -> Self {
        unsafe {
            let signs = _mm512_sll_epi32(self.0, _mm_cvtsi32_si128(31 - t as i32));
            Self(_mm512_srai_epi32::<31>(signs))
        }
    }

    #[inline(always)]
    fn signs(self) -> u32 {
        unsafe { u32::from(_mm512_movepi32_mask(self.0)) }
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(unsafe { _mm512_add_epi32(self.0, other.0) })
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Self(unsafe { _mm512_or_si512(self.0, other.0) })
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Self(unsafe { _mm512_and_si512(self.0, other.0) })
    }

    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        Self(unsafe { _mm512_xor_si512(self.0, other.0) })
    }

    #[inline(always)]
    fn shift_right(self, by: u32) -> Self {
        Self(unsafe { _mm512_srl_epi32(self.0, _mm_cvtsi32_si128(by as i32)) })
    }

    #[inline(always)]
    fn shift_left(self, by: u32) -> Self {
        Self(unsafe { _mm512_sll_epi32(self.0, _mm_cvtsi32_si128(by as i32)) })
    }

    #[inline(always)]
    fn passes(self, new: Self, old: Self) -> __mmask16 {
        unsafe {
            let inside = _mm512_cmpge_epi32_mask(self.0, _mm512_setzero_si512());
            _mm512_mask_cmplt_epi32_mask(inside, new.0, old.0)
        }
    }

    #[inline(always)]
    fn any_of(a: __mmask16, b: __mmask16) -> bool {
        a | b != 0
    }

    #[inline(always)]
    fn store(self, mask: __mmask16, old: Self, to: &mut [u32]) {
        let to: &mut [u32; 16] = to.first_chunk_mut().expect("a whole vector");
        unsafe {
            let blended = _mm512_mask_blend_epi32(mask, old.0, self.0);
            _mm512_storeu_si512(to.as_mut_ptr().cast(), blended);
        }
    }

    #[inline(always)]
    fn store_fours(self, mask: __mmask16, old: Self, to: &mut [u32]) {
        let to: &mut [u32; 3 * ROW + FOUR] = to.first_chunk_mut().expect("whole rows");
        unsafe {
            let blended = _mm512_mask_blend_epi32(mask, old.0, self.0);
            _mm_storeu_si128(to[..FOUR].as_mut_ptr().cast(), _mm512_castsi512_si128(blended));
            _mm_storeu_si128(to[ROW..][..FOUR].as_mut_ptr().cast(), _mm512_extracti32x4_epi32::<1>(blended));
            _mm_storeu_si128(to[2 * ROW..][..FOUR].as_mut_ptr().cast(), _mm512_extracti32x4_epi32::<2>(blended));
            _mm_storeu_si128(to[3 * ROW..][..FOUR].as_mut_ptr().cast(), _mm512_extracti32x4_epi32::<3>(blended));
        }
    }

    #[inline(always)]
    fn store_mask(mask: __mmask16, to: &mut [u8]) {
        let to: &mut [u8; 16] = to.first_chunk_mut().expect("a whole vector");
        unsafe { _mm_storeu_si128(to.as_mut_ptr().cast(), _mm_movm_epi8(mask)) };
    }
}
