//! Choice of the vector instructions (such as AVX2) at run time.
//!
//! All `unsafe` code of this crate is here, in `simd/x86.rs` and in `simd/wasm.rs`. It checks that the processor has a
//! vector unit before it calls functions that are compiled for this unit. WebAssembly has one unit for a whole module,
//! chosen at compile time. The gain is measured by the benchmark groups `lanes/Portable` and `lanes/Avx2` (`cargo bench
//! -p pxpl5-renderer`).
#![allow(unsafe_code)] // The compiler cannot check the features of the processor.

#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod wasm;
#[cfg(target_arch = "x86_64")]
mod x86;

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
    /// Only the instructions that every processor of the compiler's target has.
    Portable,
    /// WebAssembly with simd128: two vectors of four 32-bit numbers.
    Simd128,
    /// x86-64 with AVX2: vectors of eight 32-bit numbers.
    Avx2,
    /// x86-64 with AVX-512 (F, BW, DQ and VL): vectors of sixteen 32-bit numbers.
    Avx512,
}

impl Vectors {
    /// All vector units, from the slowest to the fastest. The discriminant of each unit is its index in this array.
    const ALL: [Self; 4] = [Self::Portable, Self::Simd128, Self::Avx2, Self::Avx512];

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
            Self::Simd128 => false,
            Self::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("bmi2"),
            Self::Avx512 => {
                Self::Avx2.present()
                    && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512bw")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512vl")
            }
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn present(self) -> bool {
        self == Self::Portable || self == Self::Simd128 && cfg!(target_feature = "simd128")
    }
}

/// A vector unit that the running computer certainly has, because a constructor has checked this.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PresentVectors(Vectors);

impl PresentVectors {
    /// Returns the vector unit `wanted` if the running computer has it, otherwise [`Vectors::Portable`].
    pub(crate) fn or_portable(wanted: Vectors) -> Self {
        Self(if wanted.present() { wanted } else { Vectors::Portable })
    }

    #[inline]
    pub(crate) fn run<K: VectorKernel>(self, kernel: K) -> K::Output {
        match self.0 {
            // SAFETY: a `PresentVectors` exists only if the processor reports these features.
            #[cfg(target_arch = "x86_64")]
            Vectors::Avx512 => unsafe { avx512(kernel) },
            // SAFETY: a `PresentVectors` exists only if the processor reports this feature.
            #[cfg(target_arch = "x86_64")]
            Vectors::Avx2 => unsafe { avx2(kernel) },
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Vectors::Simd128 => kernel.run::<wasm::Simd128>(),
            _ => kernel.run::<PortableVector>(),
        }
    }
}

/// A loop that is compiled once for each vector unit. Its method `run` must be `#[inline(always)]`. Otherwise, the
/// compiler does not use the instructions of the unit.
pub(crate) trait VectorKernel {
    type Output;
    fn run<V: SimdVector>(self) -> Self::Output;
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi2")]
fn avx2<K: VectorKernel>(kernel: K) -> K::Output {
    kernel.run::<x86::Avx2>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi2,avx512f,avx512bw,avx512dq,avx512vl")]
fn avx512<K: VectorKernel>(kernel: K) -> K::Output {
    kernel.run::<x86::Avx512>()
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

/// Eight integers in an array, for processors without a supported vector unit.
#[derive(Clone, Copy)]
pub(crate) struct PortableVector([i32; 8]);

/// Masks for four lanes, indexed by a number of four bits. Lane i is all ones if bit i of the number is set. Processors
/// without AVX2 need this table, because they cannot shift each lane by its own count.
const FOUR_LANES: [[i32; 4]; 16] = {
    let mut out = [[0; 4]; 16];
    let mut bits = 0;
    while bits < 16 {
        let mut k = 0;
        while k < 4 {
            out[bits][k] = -((bits >> k & 1) as i32);
            k += 1;
        }
        bits += 1;
    }
    out
};

impl PortableVector {
    #[inline(always)]
    fn map(self, f: impl Fn(i32) -> i32) -> Self {
        Self(self.0.map(f))
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(i32, i32) -> i32) -> Self {
        Self(std::array::from_fn(|k| f(self.0[k], other.0[k])))
    }
}

impl SimdVector for PortableVector {
    const LANES: usize = 8;
    type Mask = Self;

    #[inline(always)]
    fn splat(value: i32) -> Self {
        Self([value; 8])
    }

    #[inline(always)]
    fn ramp(first: i32, step: i32) -> Self {
        Self(std::array::from_fn(|k| first.wrapping_add(step.wrapping_mul(k as i32))))
    }

    #[inline(always)]
    fn ramp_of_fours(first: i32, step: i32, down: i32) -> Self {
        let at = |k: usize| step.wrapping_mul((k % FOUR) as i32).wrapping_add(down.wrapping_mul((k / FOUR) as i32));
        Self(std::array::from_fn(|k| first.wrapping_add(at(k))))
    }

    #[inline(always)]
    fn load(from: &[u32]) -> Self {
        let from: &[u32; 8] = from.first_chunk().expect("a whole vector");
        Self(from.map(|v| v as i32))
    }

    #[inline(always)]
    fn load_fours(from: &[u32]) -> Self {
        let from: &[u32; ROW + FOUR] = from.first_chunk().expect("whole rows");
        Self(std::array::from_fn(|k| from[k / FOUR * ROW + k % FOUR] as i32))
    }

    #[inline(always)]
    fn load_words(from: &[u64]) -> Self {
        let from: &[u64; 4] = from.first_chunk().expect("a whole vector");
        Self(std::array::from_fn(|k| (from[k / 2] >> (32 * (k % 2))) as i32))
    }

    #[inline(always)]
    fn store_words(self, to: &mut [u64]) {
        let to: &mut [u64; 4] = to.first_chunk_mut().expect("a whole vector");
        *to = std::array::from_fn(|k| self.0[2 * k] as u32 as u64 | (self.0[2 * k + 1] as u64) << 32);
    }

    #[inline(always)]
    fn spread(bits: u64) -> Self {
        let [a, b, c, d] = FOUR_LANES[bits as usize & 15];
        let [e, f, g, h] = FOUR_LANES[(bits >> 4) as usize & 15];
        Self([a, b, c, d, e, f, g, h])
    }

    #[inline(always)]
    fn bit(self, t: u32) -> Self {
        self.map(|v| v << (31 - t) >> 31)
    }

    #[inline(always)]
    fn signs(self) -> u32 {
        (0..8).fold(0, |signs, k| signs | (self.0[k] as u32 >> 31) << k)
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, i32::wrapping_add)
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self.zip(other, |a, b| a | b)
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self.zip(other, |a, b| a & b)
    }

    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        self.zip(other, |a, b| a ^ b)
    }

    #[inline(always)]
    fn shift_right(self, by: u32) -> Self {
        // A scalar shift of the processor uses the count modulo 32. A shift of a vector unit uses the whole count.
        if by < 32 { self.map(|v| (v as u32 >> by) as i32) } else { Self::splat(0) }
    }

    #[inline(always)]
    fn shift_left(self, by: u32) -> Self {
        if by < 32 { self.map(|v| v << by) } else { Self::splat(0) }
    }

    #[inline(always)]
    fn passes(self, new: Self, old: Self) -> Self {
        let nearer = new.zip(old, |new, old| -i32::from(new < old));
        self.zip(nearer, |edges, nearer| nearer & !(edges >> 31))
    }

    #[inline(always)]
    fn any_of(a: Self, b: Self) -> bool {
        a.or(b).0.iter().fold(0, |any, m| any | m) != 0
    }

    #[inline(always)]
    fn store(self, mask: Self, old: Self, to: &mut [u32]) {
        let to: &mut [u32; 8] = to.first_chunk_mut().expect("a whole vector");
        *to = std::array::from_fn(|k| (self.0[k] & mask.0[k] | old.0[k] & !mask.0[k]) as u32);
    }

    #[inline(always)]
    fn store_fours(self, mask: Self, old: Self, to: &mut [u32]) {
        let to: &mut [u32; ROW + FOUR] = to.first_chunk_mut().expect("whole rows");
        for k in 0..8 {
            to[k / FOUR * ROW + k % FOUR] = (self.0[k] & mask.0[k] | old.0[k] & !mask.0[k]) as u32;
        }
    }

    #[inline(always)]
    fn store_mask(mask: Self, to: &mut [u8]) {
        to[..8].copy_from_slice(&mask.0.map(|m| m as u8));
    }
}

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
        assert!(cfg!(target_arch = "wasm32") || !available.contains(&Vectors::Simd128));
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
