//! Choice of the vector instructions (such as AVX2) at run time, with the vectors of `fearless_simd`.
//!
//! The gain is measured by the benchmark groups `lanes/Portable` and `lanes/Avx2` (`cargo bench -p pxpl5-benches --bench
//! pixels`).
#![allow(unsafe_code)] // One macro makes vectors without a check, because `PresentVectors` has checked their unit.

use fearless_simd::{Simd, i32x8, mask32x8, prelude::*, u32x8, u64x4};
#[cfg(target_arch = "x86_64")]
use fearless_simd::{i32x16, mask32x16, u32x16, u64x8};
use pxpl5_wire::REGION_SIZE;
use std::sync::atomic::{AtomicU8, Ordering};

/// Distance, in words of memory, from a pixel to the pixel below it.
const ROW: usize = REGION_SIZE as usize;

/// Number of adjacent pixels in each row, for a vector that covers several rows.
pub(crate) const FOUR: usize = 4;

static MOST: AtomicU8 = AtomicU8::new(Vectors::Avx512 as u8);

/// A set of vector instructions for which the loops of this crate are compiled. All sets give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Vectors {
    /// Only the instructions that every processor of the compiler's target has: SSE2 on x86-64, and simd128 on
    /// WebAssembly if the compiler may use it.
    Portable,
    /// x86-64 with AVX2: vectors of eight 32-bit numbers.
    Avx2,
    /// x86-64 with AVX-512 as in Ice Lake: vectors of sixteen 32-bit numbers.
    Avx512,
}

impl Vectors {
    /// All vector units, from the slowest to the fastest. The discriminant of each unit is its index in this array.
    const ALL: [Self; 3] = [Self::Portable, Self::Avx2, Self::Avx512];

    /// Returns all vector units that the running computer has, from the slowest to the fastest.
    pub fn available() -> Vec<Self> {
        Self::ALL.into_iter().filter(|vectors| vectors.present()).collect()
    }

    /// Returns the fastest vector unit that the running computer has, up to the limit of [`Vectors::at_most`].
    pub fn best() -> Self {
        let most = MOST.load(Ordering::Relaxed) as usize;
        Self::ALL[..=most].iter().rev().copied().find(|vectors| vectors.present()).unwrap_or(Self::Portable)
    }

    /// Makes this vector unit the fastest unit that new pixel arrays of this process choose by default. Existing arrays
    /// do not change.
    ///
    /// The tests in `tests/hashes.rs` use this limit to run whole experiments on each unit.
    pub fn at_most(self) {
        MOST.store(self as u8, Ordering::Relaxed);
    }

    #[cfg(target_arch = "x86_64")]
    fn present(self) -> bool {
        match self {
            Self::Portable => true,
            Self::Avx2 => fearless_simd::Level::new().as_avx2().is_some(),
            Self::Avx512 => fearless_simd::Level::new().as_avx512().is_some(),
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn present(self) -> bool {
        self == Self::Portable
    }
}

/// A vector unit that the running computer certainly has, because a constructor has checked this.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PresentVectors(Vectors);

/// The instructions that every processor of the compiler's target has.
#[cfg(target_arch = "x86_64")]
pub(crate) type Baseline = fearless_simd::Sse2;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
pub(crate) type Baseline = fearless_simd::WasmSimd128;
#[cfg(not(any(target_arch = "x86_64", all(target_arch = "wasm32", target_feature = "simd128"))))]
pub(crate) type Baseline = fearless_simd::Fallback;

impl PresentVectors {
    /// Returns the vector unit `wanted` if the running computer has it, otherwise [`Vectors::Portable`].
    pub(crate) fn or_portable(wanted: Vectors) -> Self {
        Self(if wanted.present() { wanted } else { Vectors::Portable })
    }

    #[inline]
    pub(crate) fn run<K: VectorKernel>(self, kernel: K) -> K::Output {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Vectors::Avx512 => run_on::<fearless_simd::Avx512, Sixteen<fearless_simd::Avx512>, K>(kernel),
            #[cfg(target_arch = "x86_64")]
            Vectors::Avx2 => run_on::<fearless_simd::Avx2, Eight<fearless_simd::Avx2>, K>(kernel),
            _ => run_on::<Baseline, Eight<Baseline>, K>(kernel),
        }
    }
}

/// Runs a loop in a function that is compiled for one vector unit, which must be present.
#[inline(always)]
fn run_on<S: Unit, V: SimdVector, K: VectorKernel>(kernel: K) -> K::Output {
    S::here().vectorize(
        #[inline(always)]
        || kernel.run::<V>(),
    )
}

/// A vector unit of the running computer. Vectors carry no proof that it is present: [`PresentVectors`] has tested it.
pub(crate) trait Unit: Simd {
    fn here() -> Self;
}

#[cfg(target_arch = "x86_64")]
macro_rules! units {
    ($($unit:ident),*) => { $(
        impl Unit for fearless_simd::$unit {
            #[inline(always)]
            fn here() -> Self {
                // SAFETY: vectors are made only below `PresentVectors::run`, which chooses a unit that is present.
                unsafe { Self::assume_supported() }
            }
        }
    )* };
}

#[cfg(target_arch = "x86_64")]
units!(Sse2, Avx2, Avx512);

#[cfg(not(target_arch = "x86_64"))]
impl Unit for Baseline {
    #[inline(always)]
    fn here() -> Self {
        #[cfg(target_feature = "simd128")]
        return Self::assume_supported();
        #[cfg(not(target_feature = "simd128"))]
        return Self::new();
    }
}

/// A loop that is compiled once for each vector unit. Its method `run` must be `#[inline(always)]`. Otherwise, the
/// compiler does not use the instructions of the unit.
pub(crate) trait VectorKernel {
    type Output;
    fn run<V: SimdVector>(self) -> Self::Output;
}

/// A vector of 32-bit integers. The loops use vectors explicitly, because compilers do not vectorize short loops.
pub(crate) trait SimdVector: Copy {
    /// Number of integers in a vector, a divisor of 128.
    const LANES: usize;
    type Mask: Copy;

    fn splat(value: i32) -> Self;
    /// Returns the numbers first, first + step, first + 2 step and so on, modulo 2^32.
    fn ramp(first: i32, step: i32) -> Self;
    /// Returns groups of [four](FOUR) numbers: n, n + step, n + 2 step and n + 3 step. n is `first` in the first group,
    /// and grows by `down` from group to group.
    fn ramp_of_fours(first: i32, step: i32, down: i32) -> Self;
    /// Loads the first [`Self::LANES`] integers of `from`, which must not be shorter.
    fn load(from: &[u32]) -> Self;
    /// Loads groups of [four](FOUR) pixels, one group from each row. `from` begins with the first group.
    fn load_fours(from: &[u32]) -> Self;
    /// Loads 64-bit words. The low half of each word fills one lane, and the high half fills the next lane.
    fn load_words(from: &[u64]) -> Self;
    /// Stores the vector as 64-bit words, in the format of [`SimdVector::load_words`].
    fn store_words(self, to: &mut [u64]);
    /// Sets lane i to all ones if bit i of `bits` is set, else to zero.
    fn spread(bits: u64) -> Self;
    /// Sets each lane to all ones if its bit `t` (0 to 31) is set, else to zero.
    fn bit(self, t: u32) -> Self;
    /// Returns the signs of all lanes. Bit i of the result is the sign bit of lane i.
    fn signs(self) -> u32;
    fn add(self, other: Self) -> Self;
    fn or(self, other: Self) -> Self;
    fn and(self, other: Self) -> Self;
    fn xor(self, other: Self) -> Self;
    /// Shifts each lane right and fills the upper bits with zeros. A shift by 32 or more gives 0.
    fn shift_right(self, by: u32) -> Self;
    /// Shifts each lane left and fills the lower bits with zeros. A shift by 32 or more gives 0.
    fn shift_left(self, by: u32) -> Self;
    /// Returns a mask that is true in the lanes where `self` >= 0 and `new` < `old`. All numbers are signed.
    fn passes(self, new: Self, old: Self) -> Self::Mask;
    fn any_of(a: Self::Mask, b: Self::Mask) -> bool;
    /// Overwrites the words of `to` in the lanes where the mask is true. `old` must equal the current words of `to`.
    fn store(self, mask: Self::Mask, old: Self, to: &mut [u32]);
    /// Overwrites the pixels that [`SimdVector::load_fours`] reads, in the lanes where the mask is true. `old` must
    /// equal the current pixels.
    fn store_fours(self, mask: Self::Mask, old: Self, to: &mut [u32]);
    /// Stores one byte for each lane: 255 if the mask is true in this lane, else 0.
    fn store_mask(mask: Self::Mask, to: &mut [u8]);
}

macro_rules! vector {
    ($name:ident, $lanes:literal, $u32s:ident, $i32s:ident, $u64s:ident, $mask:ident, [$($four:literal),*]) => {
        #[derive(Clone, Copy)]
        pub(crate) struct $name<S: Simd>($u32s<S>);

        impl<S: Unit> $name<S> {
            #[inline(always)]
            fn signed(self) -> $i32s<S> {
                self.0.bitcast()
            }

            #[inline(always)]
            fn blended(self, mask: $mask<S>, old: Self) -> [u32; $lanes] {
                mask.select(self.0, old.0).to_array()
            }
        }

        impl<S: Unit> SimdVector for $name<S> {
            const LANES: usize = $lanes;
            type Mask = $mask<S>;

            #[inline(always)]
            fn splat(value: i32) -> Self {
                Self($u32s::splat(S::here(), value as u32))
            }

            #[inline(always)]
            fn ramp(first: i32, step: i32) -> Self {
                Self($u32s::from_fn(S::here(), |k| k as u32) * step as u32 + first as u32)
            }

            #[inline(always)]
            fn ramp_of_fours(first: i32, step: i32, down: i32) -> Self {
                let [columns, rows] = [|k| (k % FOUR) as u32, |k| (k / FOUR) as u32].map(|f| $u32s::from_fn(S::here(), f));
                Self(columns * step as u32 + (rows * down as u32 + first as u32))
            }

            #[inline(always)]
            fn load(from: &[u32]) -> Self {
                Self((*from.first_chunk().expect("a whole vector")).simd_into(S::here()))
            }

            #[inline(always)]
            fn load_fours(from: &[u32]) -> Self {
                let from: &[u32; ROW * ($lanes / FOUR - 1) + FOUR] = from.first_chunk().expect("whole rows");
                let mut lanes = [0; $lanes];
                $(lanes[FOUR * $four..][..FOUR].copy_from_slice(&from[ROW * $four..][..FOUR]);)*
                Self(lanes.simd_into(S::here()))
            }

            #[inline(always)]
            fn load_words(from: &[u64]) -> Self {
                let words: $u64s<S> = (*from.first_chunk().expect("a whole vector")).simd_into(S::here());
                Self(words.bitcast())
            }

            #[inline(always)]
            fn store_words(self, to: &mut [u64]) {
                let words: $u64s<S> = self.0.bitcast();
                *to.first_chunk_mut().expect("a whole vector") = words.to_array();
            }

            #[inline(always)]
            fn spread(bits: u64) -> Self {
                Self($mask::from_bitmask(S::here(), bits).to_vector().bitcast())
            }

            #[inline(always)]
            fn bit(self, t: u32) -> Self {
                Self((Self(self.0 << (31 - t)).signed() >> 31).bitcast())
            }

            #[inline(always)]
            fn signs(self) -> u32 {
                self.signed().simd_lt(0).to_bitmask() as u32
            }

            #[inline(always)]
            fn add(self, other: Self) -> Self {
                Self(self.0 + other.0)
            }

            #[inline(always)]
            fn or(self, other: Self) -> Self {
                Self(self.0 | other.0)
            }

            #[inline(always)]
            fn and(self, other: Self) -> Self {
                Self(self.0 & other.0)
            }

            #[inline(always)]
            fn xor(self, other: Self) -> Self {
                Self(self.0 ^ other.0)
            }

            #[inline(always)]
            fn shift_right(self, by: u32) -> Self {
                if by < 32 { Self(self.0 >> by) } else { Self::splat(0) }
            }

            #[inline(always)]
            fn shift_left(self, by: u32) -> Self {
                if by < 32 { Self(self.0 << by) } else { Self::splat(0) }
            }

            #[inline(always)]
            fn passes(self, new: Self, old: Self) -> $mask<S> {
                self.signed().simd_ge(0) & new.signed().simd_lt(old.signed())
            }

            #[inline(always)]
            fn any_of(a: $mask<S>, b: $mask<S>) -> bool {
                (a | b).any_true()
            }

            #[inline(always)]
            fn store(self, mask: $mask<S>, old: Self, to: &mut [u32]) {
                *to.first_chunk_mut().expect("a whole vector") = self.blended(mask, old);
            }

            #[inline(always)]
            fn store_fours(self, mask: $mask<S>, old: Self, to: &mut [u32]) {
                let to: &mut [u32; ROW * ($lanes / FOUR - 1) + FOUR] = to.first_chunk_mut().expect("whole rows");
                let blended = self.blended(mask, old);
                $(to[ROW * $four..][..FOUR].copy_from_slice(&blended[FOUR * $four..][..FOUR]);)*
            }

            #[inline(always)]
            fn store_mask(mask: $mask<S>, to: &mut [u8]) {
                let bits = mask.to_bitmask();
                for (k, to) in to[..Self::LANES].iter_mut().enumerate() {
                    *to = 0_u8.wrapping_sub((bits >> k & 1) as u8);
                }
            }
        }
    };
}

vector!(Eight, 8, u32x8, i32x8, u64x4, mask32x8, [0, 1]);
#[cfg(target_arch = "x86_64")]
vector!(Sixteen, 16, u32x16, i32x16, u64x8, mask32x16, [0, 1, 2, 3]);

#[cfg(test)]
mod tests {
    use super::*;

    /// Test code that shifts all integers of a vector to the right and to the left by `by` bits.
    struct Shifts {
        values: [u32; 16],
        by: u32,
    }

    impl VectorKernel for Shifts {
        type Output = [[u32; 8]; 2];

        #[inline(always)]
        fn run<V: SimdVector>(self) -> Self::Output {
            let vector = V::load(&self.values);
            [vector.shift_right(self.by), vector.shift_left(self.by)].map(|shifted| {
                let mut words = [0; 8];
                shifted.store_words(&mut words[..V::LANES / 2]);
                std::array::from_fn(|k| (words[k / 2] >> (32 * (k % 2))) as u32)
            })
        }
    }

    #[test]
    fn every_vector_unit_shifts_by_every_count_and_counts_from_32_on_give_zero() {
        let values: [u32; 16] = std::array::from_fn(|k| 0x9E37_79B9_u32.wrapping_mul(k as u32 * 2 + 1) | 0x8000_0001);
        // The counts are all values of a byte, and larger counts whose lowest bits are small.
        for by in (0..=255).chain([256, 1 << 16, 1 << 31, (1 << 31) + 1, u32::MAX]) {
            let right = |value: u32| (u64::from(value) << 32).checked_shr(by).map_or(0, |wide| (wide >> 32) as u32);
            let left = |value: u32| u64::from(value).checked_shl(by).unwrap_or(0) as u32;
            let expected = [std::array::from_fn(|k| right(values[k])), std::array::from_fn(|k| left(values[k]))];
            for vectors in Vectors::available() {
                assert_eq!(
                    PresentVectors::or_portable(vectors).run(Shifts { values, by }),
                    expected,
                    "{vectors:?} {by}"
                );
            }
        }
    }

    /// Results of the operations of a vector unit, each with the operation's name.
    type Done = Vec<(&'static str, Vec<u32>)>;

    /// Test code that applies every operation of a vector unit to integers and to rows of pixels.
    struct Everything {
        a: [u32; 16],
        b: [u32; 16],
        c: [u32; 16],
        rows: [u32; 4 * ROW],
    }

    const FIRST: i32 = i32::MAX - 5;
    const STEP: i32 = 70_001;
    const DOWN: i32 = -900_000_001;
    const BITS: u64 = 0xFEDC_BA98_7654_B2D1;

    impl VectorKernel for &Everything {
        type Output = (usize, Done);

        #[inline(always)]
        fn run<V: SimdVector>(self) -> Self::Output {
            let numbers = |v: V| -> Vec<u32> {
                let mut words = [0; 8];
                v.store_words(&mut words[..V::LANES / 2]);
                (0..V::LANES).map(|k| (words[k / 2] >> (32 * (k % 2))) as u32).collect()
            };
            let [a, b, c] = [V::load(&self.a), V::load(&self.b), V::load(&self.c)];
            let words: [u64; 8] =
                std::array::from_fn(|k| u64::from(self.b[2 * k + 1]) << 32 | u64::from(self.b[2 * k]));
            // The pixels can end after the last group of four.
            let fours = ROW * (V::LANES / FOUR - 1) + FOUR;
            let [passes, nowhere] = [a.passes(b, c), V::splat(-1).passes(b, c)];
            let mut stored = self.b;
            a.store(passes, c, &mut stored);
            let mut stored_fours = self.rows;
            a.store_fours(passes, c, &mut stored_fours[..fours]);
            let mut mask = [7; 16];
            V::store_mask(passes, &mut mask);
            let any = [(passes, nowhere), (nowhere, passes), (nowhere, nowhere)].map(|(p, q)| V::any_of(p, q).into());
            let mut done = vec![
                ("splat", numbers(V::splat(-7))),
                ("ramp", numbers(V::ramp(FIRST, STEP))),
                ("ramp of fours", numbers(V::ramp_of_fours(FIRST, STEP, DOWN))),
                ("load", numbers(a)),
                ("load fours", numbers(V::load_fours(&self.rows[..fours]))),
                ("load words", numbers(V::load_words(&words))),
                ("spread", numbers(V::spread(BITS))),
                ("signs", vec![a.signs()]),
                ("add", numbers(a.add(b))),
                ("or", numbers(a.or(b))),
                ("and", numbers(a.and(b))),
                ("xor", numbers(a.xor(b))),
                ("any of", any.to_vec()),
                ("store", stored.to_vec()),
                ("store fours", stored_fours.to_vec()),
                ("store mask", mask.map(u32::from).to_vec()),
            ];
            done.extend((0..32).map(|t| ("bit", numbers(a.bit(t)))));
            (V::LANES, done)
        }
    }

    impl Everything {
        /// Returns the expected results, computed for one integer after the other without a vector unit.
        fn by_numbers(&self, lanes: usize) -> Done {
            let Self { a, b, c, rows } = self;
            let each = |f: &dyn Fn(usize) -> i32| -> Vec<u32> { (0..lanes).map(|k| f(k) as u32).collect() };
            // Position of lane k in an array whose rows hold four lanes each.
            let at = |k: usize| k / FOUR * ROW + k % FOUR;
            let ones = |truth: bool| -i32::from(truth);
            let passes = |k: usize| k < lanes && a[k] as i32 >= 0 && (b[k] as i32) < c[k] as i32;
            let any = (0..lanes).any(passes);
            let mut stored = *b;
            let mut stored_fours = *rows;
            let mut mask = [7; 16];
            // Stores change only the lanes that pass the test.
            for k in 0..lanes {
                stored[k] = if passes(k) { a[k] } else { c[k] };
                stored_fours[at(k)] = stored[k];
                mask[k] = if passes(k) { 255 } else { 0 };
            }
            let mut done = vec![
                ("splat", each(&|_| -7)),
                ("ramp", each(&|k| FIRST.wrapping_add(STEP * k as i32))),
                (
                    "ramp of fours",
                    each(&|k| {
                        FIRST.wrapping_add(STEP * (k % FOUR) as i32).wrapping_add(DOWN.wrapping_mul((k / FOUR) as i32))
                    }),
                ),
                ("load", each(&|k| a[k] as i32)),
                ("load fours", each(&|k| rows[at(k)] as i32)),
                ("load words", each(&|k| b[k] as i32)),
                ("spread", each(&|k| ones(BITS >> k & 1 == 1))),
                ("signs", vec![(0..lanes).map(|k| (a[k] >> 31) << k).sum()]),
                ("add", each(&|k| (a[k] as i32).wrapping_add(b[k] as i32))),
                ("or", each(&|k| (a[k] | b[k]) as i32)),
                ("and", each(&|k| (a[k] & b[k]) as i32)),
                ("xor", each(&|k| (a[k] ^ b[k]) as i32)),
                ("any of", vec![any.into(), any.into(), 0]),
                ("store", stored.to_vec()),
                ("store fours", stored_fours.to_vec()),
                ("store mask", mask.to_vec()),
            ];
            done.extend((0..32).map(|t| ("bit", each(&|k| ones(a[k] >> t & 1 == 1)))));
            done
        }
    }

    #[test]
    fn every_vector_unit_equals_scalar_arithmetic() {
        let mut random = crate::conformance::Random::new(40);
        for round in 0..200 {
            // Some numbers are equal or small.
            let bits = [1, 4, 32][round % 3];
            let [a, b, c] = [(); 3].map(|()| [(); 16].map(|()| random.signed(bits) as u32));
            let rows = [(); 4 * ROW].map(|()| random.next() as u32);
            let everything = Everything { a, b, c, rows };
            for vectors in Vectors::available() {
                let (lanes, done) = PresentVectors::or_portable(vectors).run(&everything);
                assert_eq!(lanes, if vectors == Vectors::Avx512 { 16 } else { 8 });
                for (found, expected) in done.into_iter().zip(everything.by_numbers(lanes)) {
                    assert_eq!(found, expected, "{vectors:?} {a:x?} {b:x?} {c:x?}");
                }
            }
        }
    }

    #[test]
    fn an_absent_vector_unit_is_replaced_by_portable_code_and_the_best_allowed_unit_is_chosen() {
        let available = Vectors::available();
        assert_eq!(available.first(), Some(&Vectors::Portable));
        for wanted in Vectors::ALL {
            let expected = if available.contains(&wanted) { wanted } else { Vectors::Portable };
            assert_eq!(PresentVectors::or_portable(wanted), PresentVectors(expected));
        }
        for most in available {
            most.at_most();
            assert_eq!(Vectors::best(), most);
        }
    }
}
