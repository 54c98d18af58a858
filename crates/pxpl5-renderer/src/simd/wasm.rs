//! Vectors of WebAssembly. A pair of 128-bit vectors has eight lanes, like an AVX2 vector.
//!
//! SAFETY of every `unsafe` block in this file: loads and stores go through slices whose length is checked. WebAssembly
//! allows any alignment.

use super::{FOUR, ROW, SimdVector};
use std::arch::wasm32::*;

/// Eight lanes of 32 bits. The first vector holds the first four lanes.
#[derive(Clone, Copy)]
pub(super) struct Simd128([v128; 2]);

impl Simd128 {
    #[inline(always)]
    fn map(self, f: impl Fn(v128) -> v128) -> Self {
        Self(self.0.map(f))
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(v128, v128) -> v128) -> Self {
        Self([f(self.0[0], other.0[0]), f(self.0[1], other.0[1])])
    }
}

impl SimdVector for Simd128 {
    const LANES: usize = 8;
    type Mask = Self;

    #[inline(always)]
    fn splat(value: i32) -> Self {
        Self([i32x4_splat(value); 2])
    }

    #[inline(always)]
    fn ramp(first: i32, step: i32) -> Self {
        let (first, step) = (i32x4_splat(first), i32x4_splat(step));
        Self([i32x4(0, 1, 2, 3), i32x4(4, 5, 6, 7)].map(|lanes| i32x4_add(first, i32x4_mul(lanes, step))))
    }

    #[inline(always)]
    fn ramp_of_fours(first: i32, step: i32, down: i32) -> Self {
        let steps = i32x4_mul(i32x4(0, 1, 2, 3), i32x4_splat(step));
        Self([first, first.wrapping_add(down)].map(|begin| i32x4_add(i32x4_splat(begin), steps)))
    }

    #[inline(always)]
    fn load(from: &[u32]) -> Self {
        let from: &[u32; 8] = from.first_chunk().expect("a whole vector");
        Self([0, 4].map(|lane| unsafe { v128_load(from[lane..].as_ptr().cast()) }))
    }

    #[inline(always)]
    fn load_fours(from: &[u32]) -> Self {
        let from: &[u32; ROW + FOUR] = from.first_chunk().expect("whole rows");
        Self([0, ROW].map(|row| unsafe { v128_load(from[row..][..FOUR].as_ptr().cast()) }))
    }

    #[inline(always)]
    fn load_words(from: &[u64]) -> Self {
        let from: &[u64; 4] = from.first_chunk().expect("a whole vector");
        Self([0, 2].map(|word| unsafe { v128_load(from[word..].as_ptr().cast()) }))
    }

    #[inline(always)]
    fn store_words(self, to: &mut [u64]) {
        let to: &mut [u64; 4] = to.first_chunk_mut().expect("a whole vector");
        for half in 0..2 {
            unsafe { v128_store(to[2 * half..].as_mut_ptr().cast(), self.0[half]) };
        }
    }

    #[inline(always)]
    fn spread(bits: u64) -> Self {
        let bits = i32x4_splat(bits as i32);
        Self([i32x4(1, 2, 4, 8), i32x4(16, 32, 64, 128)].map(|lanes| i32x4_eq(v128_and(bits, lanes), lanes)))
    }

    #[inline(always)]
    fn bit(self, t: u32) -> Self {
        self.map(|v| i32x4_shr(i32x4_shl(v, 31 - t), 31))
    }

    #[inline(always)]
    fn signs(self) -> u32 {
        let [low, high] = self.0.map(|v| u32::from(i32x4_bitmask(v)));
        low | high << 4
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| i32x4_add(a, b))
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self.zip(other, |a, b| v128_or(a, b))
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self.zip(other, |a, b| v128_and(a, b))
    }

    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        self.zip(other, |a, b| v128_xor(a, b))
    }

    #[inline(always)]
    fn shift_right(self, by: u32) -> Self {
        // The shift of the vector unit uses the count modulo 32.
        if by < 32 { self.map(|v| u32x4_shr(v, by)) } else { Self::splat(0) }
    }

    #[inline(always)]
    fn shift_left(self, by: u32) -> Self {
        if by < 32 { self.map(|v| i32x4_shl(v, by)) } else { Self::splat(0) }
    }

    #[inline(always)]
    fn passes(self, new: Self, old: Self) -> Self {
        let nearer = new.zip(old, |new, old| i32x4_lt(new, old));
        self.zip(nearer, |edges, nearer| v128_andnot(nearer, i32x4_shr(edges, 31)))
    }

    #[inline(always)]
    fn any_of(a: Self, b: Self) -> bool {
        let [low, high] = a.or(b).0;
        v128_any_true(v128_or(low, high))
    }

    #[inline(always)]
    fn store(self, mask: Self, old: Self, to: &mut [u32]) {
        let to: &mut [u32; 8] = to.first_chunk_mut().expect("a whole vector");
        for half in 0..2 {
            let blended = v128_bitselect(self.0[half], old.0[half], mask.0[half]);
            unsafe { v128_store(to[4 * half..].as_mut_ptr().cast(), blended) };
        }
    }

    #[inline(always)]
    fn store_fours(self, mask: Self, old: Self, to: &mut [u32]) {
        let to: &mut [u32; ROW + FOUR] = to.first_chunk_mut().expect("whole rows");
        for half in 0..2 {
            let blended = v128_bitselect(self.0[half], old.0[half], mask.0[half]);
            unsafe { v128_store(to[half * ROW..][..FOUR].as_mut_ptr().cast(), blended) };
        }
    }

    #[inline(always)]
    fn store_mask(mask: Self, to: &mut [u8]) {
        let bits = mask.signs();
        for (k, to) in to[..8].iter_mut().enumerate() {
            *to = 0_u8.wrapping_sub((bits >> k & 1) as u8);
        }
    }
}
